//! Dense symmetric matrices of which a product reads each entry once.

use super::widest::{Kernel, on_widest};
use faer::Mat;

/// Rows that are read together: each load of x and each sum of a column serve all of them.
const ROWS: usize = 4;

/// Neighbouring columns: the entries of one vector register.
const COLUMNS: usize = 8;

/// The diagonal, and what is above it in tiles of some rows and columns: those of the first rows from left to right,
/// and so on. Rows and columns are filled up with zeros.
#[derive(Debug, Clone, PartialEq)]
pub struct Symmetric {
    diagonal: Vec<f64>,
    above: Vec<[[f64; COLUMNS]; ROWS]>,
}

impl Symmetric {
    /// Of a symmetric matrix; below its diagonal it is not read.
    pub fn new(matrix: &Mat<f64>) -> Symmetric {
        let n = matrix.nrows();
        let entry = |i: usize, j: usize| if i < j && j < n { matrix[(i, j)] } else { 0. };
        let tile = |row: usize, column: usize| {
            std::array::from_fn(|r| std::array::from_fn(|c| entry(row + r, COLUMNS * column + c)))
        };
        let above = (0..n).step_by(ROWS).flat_map(|row| tiles_of(row, n).map(move |column| (row, column)));
        Symmetric {
            above: above.map(|(row, column)| tile(row, column)).collect(),
            diagonal: (0..n).map(|i| matrix[(i, i)]).collect(),
        }
    }

    /// A x.
    ///
    /// # Panics
    /// If `x` has another length.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        assert_eq!(x.len(), self.diagonal.len(), "A x: columns of A and length of x");
        on_widest(Product { matrix: self, x })
    }
}

/// Which columns, counted in tiles, some rows have above the diagonal.
fn tiles_of(row: usize, n: usize) -> std::ops::Range<usize> {
    row / COLUMNS..n.div_ceil(COLUMNS)
}

struct Product<'a> {
    matrix: &'a Symmetric,
    x: &'a [f64],
}

impl Kernel for Product<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn run(self) -> Vec<f64> {
        let Product { matrix: Symmetric { diagonal, above }, x } = self;
        let n = x.len();
        let mut padded = vec![[0.; COLUMNS]; n.div_ceil(COLUMNS)];
        padded.as_flattened_mut()[..n].copy_from_slice(x);
        let mut product = vec![[0.; COLUMNS]; padded.len()];
        let mut tiles = above.as_slice();
        for row in (0..n).step_by(ROWS) {
            let columns = tiles_of(row, n);
            let own;
            (own, tiles) = tiles.split_at(columns.len());
            let here: [f64; ROWS] = std::array::from_fn(|r| padded.as_flattened()[row + r]);
            let mut sums = [[0.; COLUMNS]; ROWS];
            for ((tile, x), below) in own.iter().zip(&padded[columns.clone()]).zip(&mut product[columns]) {
                let (x, mut sum) = (*x, *below);
                for r in 0..ROWS {
                    sums[r] = plus(sums[r], &tile[r], x);
                    sum = plus(sum, &tile[r], [here[r]; COLUMNS]);
                }
                *below = sum;
            }
            for (product, sums) in product.as_flattened_mut()[row..].iter_mut().zip(&sums) {
                *product += sum(sums);
            }
        }
        product.as_flattened().iter().zip(diagonal).zip(x).map(|((product, d), x)| product + d * x).collect()
    }
}

/// Three additions wait for each other, where one number after the other would make it eight.
#[inline(always)]
fn sum(x: &[f64; COLUMNS]) -> f64 {
    ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]))
}

/// sum + a x, entry by entry.
#[inline(always)]
fn plus(sum: [f64; COLUMNS], a: &[f64; COLUMNS], x: [f64; COLUMNS]) -> [f64; COLUMNS] {
    let mut new = [0.; COLUMNS];
    for c in 0..COLUMNS {
        new[c] = sum[c] + a[c] * x[c];
    }
    new
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sparse::testing::random;

    #[test]
    fn the_product_is_that_of_the_whole_matrix() {
        for n in [0, 1, 2, 3, 4, 5, 8, 17, 64, 101] {
            let values = random(n * n, 3);
            let matrix = Mat::from_fn(n, n, |i, j| values[n * i.min(j) + i.max(j)]);
            let x = random(n, 4);
            let product = Symmetric::new(&matrix).times(&x);
            for i in 0..n {
                let exact: f64 = (0..n).map(|j| matrix[(i, j)] * x[j]).sum();
                // A hundred products of numbers up to 1.
                assert!((product[i] - exact).abs() < 1e-13, "row {i} of {n}");
            }
        }
    }
}
