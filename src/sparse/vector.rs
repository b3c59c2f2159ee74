//! Vectors as slices: the few operations that several places need.

/// x'y.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// |x|.
pub fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

/// x <- x + factor y.
pub fn add(x: &mut [f64], factor: f64, y: &[f64]) {
    x.iter_mut().zip(y).for_each(|(x, y)| *x += factor * y);
}

/// x <- x + factor y, y by its few entries (place, value).
pub fn add_at(x: &mut [f64], factor: f64, y: &[(usize, f64)]) {
    y.iter().for_each(|(i, y)| x[*i] += factor * y);
}
