//! Sums of columns of a dense matrix.

use super::widest::{Kernel, on_widest};
use faer::Mat;

/// Columns that are added at once: each load and store of y serves all of them.
const AT_ONCE: usize = 4;

/// y <- y + A x, x by its entries (place, value) that are not zero.
///
/// # Panics
/// If A has another number of rows than y, or no such column.
pub fn add_columns(y: &mut [f64], a: &Mat<f64>, x: &[(usize, f64)]) {
    assert_eq!(y.len(), a.nrows(), "y + A x: rows of A and length of y");
    on_widest(Sum { y, a, x });
}

struct Sum<'a> {
    y: &'a mut [f64],
    a: &'a Mat<f64>,
    x: &'a [(usize, f64)],
}

impl Kernel for Sum<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Sum { y, a, x } = self;
        let (together, rest) = x.as_chunks::<AT_ONCE>();
        for x in together {
            let [p, q, r, s] = x.map(|(j, _)| a.col_as_slice(j));
            let [x_p, x_q, x_r, x_s] = x.map(|(_, x_j)| x_j);
            for ((((y, p), q), r), s) in y.iter_mut().zip(p).zip(q).zip(r).zip(s) {
                *y += (x_p * p + x_q * q) + (x_r * r + x_s * s);
            }
        }
        for &(j, x_j) in rest {
            y.iter_mut().zip(a.col_as_slice(j)).for_each(|(y, a)| *y += x_j * a);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sparse::testing::random;

    #[test]
    fn sums_of_columns_are_products() {
        let values = random(35 * 20, 1);
        let a = Mat::from_fn(35, 20, |i, j| values[20 * i + j]);
        for count in [0, 1, 4, 11, 20] {
            let x: Vec<(usize, f64)> = random(count, 2).into_iter().enumerate().map(|(k, x)| (19 - k, x)).collect();
            let mut y = random(35, 3);
            add_columns(&mut y, &a, &x);
            for (i, (y, before)) in y.iter().zip(random(35, 3)).enumerate() {
                let exact = before + x.iter().map(|&(j, x)| a[(i, j)] * x).sum::<f64>();
                // Twenty products of numbers up to 1.
                assert!((y - exact).abs() < 1e-14, "row {i}, {count} columns");
            }
        }
    }
}
