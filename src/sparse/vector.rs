//! Vectors as slices: the few operations that several places need.

/// x'y, in several sums at once: one waits too long for its last addition.
///
/// # Panics
/// If they differ in length.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    assert_eq!(x.len(), y.len(), "x'y of vectors of one length");
    let ((x_s, last_x), (y_s, last_y)) = (x.as_chunks::<8>(), y.as_chunks::<8>());
    let mut sums = [0.; 8];
    for (x, y) in x_s.iter().zip(y_s) {
        (0..8).for_each(|i| sums[i] += x[i] * y[i]);
    }
    sums.iter().sum::<f64>() + last_x.iter().zip(last_y).map(|(x, y)| x * y).sum::<f64>()
}

/// |x|.
pub fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

/// |x - y|.
pub fn distance(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| (x - y).powi(2)).sum::<f64>().sqrt()
}

/// a / b, and 0 for 0 / 0.
pub fn ratio(a: f64, b: f64) -> f64 {
    if a == 0. { 0. } else { a / b }
}

/// x <- x + factor y.
pub fn add(x: &mut [f64], factor: f64, y: &[f64]) {
    x.iter_mut().zip(y).for_each(|(x, y)| *x += factor * y);
}

/// x <- x + factor y, y by its few entries (place, value).
pub fn add_at(x: &mut [f64], factor: f64, y: &[(usize, f64)]) {
    y.iter().for_each(|(i, y)| x[*i] += factor * y);
}
