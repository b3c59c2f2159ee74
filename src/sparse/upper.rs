//! Products with several symmetric matrices on one pattern, reading each entry of their upper triangles once.

use sprs::CsMat;

/// The upper triangle of a pattern, row by row, the diagonal first.
#[derive(Debug, Clone, PartialEq)]
pub struct Upper {
    start: Vec<usize>,
    columns: Vec<u32>,
}

impl Upper {
    /// # Panics
    /// If a row has no diagonal entry, or there are more unknowns than 32 bits count.
    pub fn new(pattern: &CsMat<f64>) -> Upper {
        let (mut start, mut columns) = (vec![0], Vec::with_capacity(pattern.nnz() / 2 + pattern.rows()));
        for (i, row) in pattern.outer_iterator().enumerate() {
            let right = row.indices().iter().filter(|&&j| j >= i);
            columns.extend(right.map(|&j| u32::try_from(j).expect("fewer unknowns than 2^32")));
            assert_eq!(columns.get(start[i]), Some(&(i as u32)), "every row has its diagonal entry");
            start.push(columns.len());
        }
        Upper { start, columns }
    }

    /// The upper triangle's values of a matrix with this pattern.
    pub fn values(&self, matrix: &CsMat<f64>) -> Vec<f64> {
        let rows = matrix.outer_iterator().enumerate();
        rows.flat_map(|(i, row)| row.iter().filter(|(j, _)| *j >= i).map(|(_, &a)| a).collect::<Vec<_>>()).collect()
    }

    /// A x + B y, of each unknown's pair (x, y).
    pub fn sum_of_products(&self, [a, b]: [&[f64]; 2], xy: &[[f64; 2]]) -> Vec<f64> {
        let mut sums = vec![0.; xy.len()];
        for (i, &[x_i, y_i]) in xy.iter().enumerate() {
            let row = self.start[i]..self.start[i + 1];
            let entries = self.columns[row.clone()].iter().zip(&a[row.clone()]).zip(&b[row.clone()]);
            let mut sum = a[row.start] * x_i + b[row.start] * y_i;
            for ((&j, a), b) in entries.skip(1) {
                let [x_j, y_j] = xy[j as usize];
                sum += a * x_j + b * y_j;
                sums[j as usize] += a * x_i + b * y_i;
            }
            sums[i] += sum;
        }
        sums
    }

    /// x'A x, y'B y and z'C z, of each unknown's (x, y, z).
    pub fn quadratic_forms(&self, [a, b, c]: [&[f64]; 3], xyz: &[[f64; 3]]) -> [f64; 3] {
        let mut forms = [0.; 3];
        for (i, here) in xyz.iter().enumerate() {
            let row = self.start[i]..self.start[i + 1];
            let entries =
                self.columns[row.clone()].iter().zip(&a[row.clone()]).zip(&b[row.clone()]).zip(&c[row.clone()]);
            let mut right = [0.; 3];
            for (((&j, a), b), c) in entries.skip(1) {
                let there = xyz[j as usize];
                right[0] += a * there[0];
                right[1] += b * there[1];
                right[2] += c * there[2];
            }
            // Each entry off the diagonal stands for two.
            for (k, values) in [a, b, c].into_iter().enumerate() {
                forms[k] += here[k] * (values[row.start] * here[k] + 2. * right[k]);
            }
        }
        forms
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sparse::multiply;
    use crate::sparse::testing::{distance, grid_matrix, random};
    use crate::sparse::vector::{add, dot};

    /// Sums of some ten products of numbers up to 10: round-off is 1e-15 of them.
    const ROUND_OFF: f64 = 1e-14;

    #[test]
    fn products_of_the_upper_triangle_are_those_of_the_whole_matrix() {
        let a = grid_matrix(14, 9, &[3, 4]);
        let n = a.rows();
        let b = a.map(|v| v.sin());
        let c = a.map(|v| v * v - 2.);
        let (upper, [x, y, z]) = (Upper::new(&a), [1, 2, 3].map(|seed| random(n, seed)));
        let [va, vb, vc] = [&a, &b, &c].map(|m| upper.values(m));

        let mut sum = multiply(&a, &x);
        add(&mut sum, 1., &multiply(&b, &y));
        let xy: Vec<[f64; 2]> = (0..n).map(|i| [x[i], y[i]]).collect();
        assert!(distance(&upper.sum_of_products([&va, &vb], &xy), &sum) < ROUND_OFF);

        let xyz: Vec<[f64; 3]> = (0..n).map(|i| [x[i], y[i], z[i]]).collect();
        let forms = upper.quadratic_forms([&va, &vb, &vc], &xyz);
        for (form, (m, v)) in forms.iter().zip([(&a, &x), (&b, &y), (&c, &z)]) {
            assert!((form - dot(v, &multiply(m, v))).abs() < ROUND_OFF * dot(v, v) * 10. * 10.);
        }
    }
}
