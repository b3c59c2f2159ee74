//! Products with several symmetric matrices on one pattern, reading each entry of their upper triangles once.

use super::widest::{Kernel, on_widest};
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

    /// A x + B y, of each unknown's (x, y), for each of K such pairs of vectors.
    pub fn sum_of_products<const K: usize>(&self, [a, b]: [&[f64]; 2], xy: &[[[f64; K]; 2]]) -> Vec<[f64; K]> {
        on_widest(SumOfProducts { pattern: self, a, b, xy })
    }

    /// x'A x, y'B y and z'C z, of each unknown's (x, y, z), for each of K such triples of vectors.
    pub fn quadratic_forms<const K: usize>(&self, matrices: [&[f64]; 3], xyz: &[[[f64; K]; 3]]) -> [[f64; K]; 3] {
        on_widest(QuadraticForms { pattern: self, matrices, xyz })
    }

    /// Where a row has its entries; the first is the diagonal one.
    #[inline(always)]
    fn row(&self, i: usize) -> std::ops::Range<usize> {
        self.start[i]..self.start[i + 1]
    }
}

/// Entries that are summed at once: one sum waits too long for its last addition.
const AT_ONCE: usize = 2;

struct SumOfProducts<'a, const K: usize> {
    pattern: &'a Upper,
    a: &'a [f64],
    b: &'a [f64],
    xy: &'a [[[f64; K]; 2]],
}

impl<const K: usize> Kernel for SumOfProducts<'_, K> {
    type Output = Vec<[f64; K]>;

    #[inline(always)]
    fn run(self) -> Vec<[f64; K]> {
        let SumOfProducts { pattern, a, b, xy } = self;
        let mut sums = vec![[0.; K]; xy.len()];
        for (i, here) in xy.iter().enumerate() {
            let row = pattern.row(i);
            let mut right = [[0.; K]; AT_ONCE];
            let (columns, last_column) = pattern.columns[row.start + 1..row.end].as_chunks::<AT_ONCE>();
            let [(a_s, last_a), (b_s, last_b)] = [a, b].map(|m| m[row.start + 1..row.end].as_chunks::<AT_ONCE>());
            for ((j, a), b) in columns.iter().zip(a_s).zip(b_s) {
                for e in 0..AT_ONCE {
                    let j = j[e] as usize;
                    add_product(&mut right[e], [a[e], b[e]], &xy[j]);
                    add_product(&mut sums[j], [a[e], b[e]], here);
                }
            }
            for ((&j, &a), &b) in last_column.iter().zip(last_a).zip(last_b) {
                add_product(&mut right[0], [a, b], &xy[j as usize]);
                add_product(&mut sums[j as usize], [a, b], here);
            }
            add_product(&mut sums[i], [a[row.start], b[row.start]], here);
            for k in 0..K {
                sums[i][k] += right[0][k] + right[1][k];
            }
        }
        sums
    }
}

struct QuadraticForms<'a, const K: usize> {
    pattern: &'a Upper,
    matrices: [&'a [f64]; 3],
    xyz: &'a [[[f64; K]; 3]],
}

impl<const K: usize> Kernel for QuadraticForms<'_, K> {
    type Output = [[f64; K]; 3];

    #[inline(always)]
    fn run(self) -> [[f64; K]; 3] {
        let QuadraticForms { pattern, matrices: [a, b, c], xyz } = self;
        let mut forms = [[0.; K]; 3];
        for (i, here) in xyz.iter().enumerate() {
            let row = pattern.row(i);
            let mut right = [[[0.; K]; 3]; AT_ONCE];
            let (columns, last_column) = pattern.columns[row.start + 1..row.end].as_chunks::<AT_ONCE>();
            let [(a_s, last_a), (b_s, last_b), (c_s, last_c)] =
                [a, b, c].map(|m| m[row.start + 1..row.end].as_chunks::<AT_ONCE>());
            for (((j, a), b), c) in columns.iter().zip(a_s).zip(b_s).zip(c_s) {
                for e in 0..AT_ONCE {
                    add_each(&mut right[e], [a[e], b[e], c[e]], &xyz[j[e] as usize]);
                }
            }
            for (((&j, &a), &b), &c) in last_column.iter().zip(last_a).zip(last_b).zip(last_c) {
                add_each(&mut right[0], [a, b, c], &xyz[j as usize]);
            }
            // Each entry off the diagonal stands for two.
            for (m, values) in [a, b, c].into_iter().enumerate() {
                for k in 0..K {
                    let of_row = values[row.start] * here[m][k] + 2. * (right[0][m][k] + right[1][m][k]);
                    forms[m][k] += here[m][k] * of_row;
                }
            }
        }
        forms
    }
}

/// sum <- sum + a x + b y. A function and not a closure, so that it is always compiled into the kernel.
#[inline(always)]
fn add_product<const K: usize>(sum: &mut [f64; K], [a, b]: [f64; 2], [x, y]: &[[f64; K]; 2]) {
    for k in 0..K {
        sum[k] += a * x[k] + b * y[k];
    }
}

/// Each of three sums <- sum + value times x.
#[inline(always)]
fn add_each<const K: usize>(sums: &mut [[f64; K]; 3], values: [f64; 3], x: &[[f64; K]; 3]) {
    for m in 0..3 {
        for k in 0..K {
            sums[m][k] += values[m] * x[m][k];
        }
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
        // The second lane holds twice the first.
        let twice = |x: f64| [x, 2. * x];
        let xy: Vec<[[f64; 2]; 2]> = (0..n).map(|i| [x[i], y[i]].map(twice)).collect();
        let products = upper.sum_of_products([&va, &vb], &xy);
        for (lane, factor) in [(0, 1.), (1, 0.5)] {
            let product: Vec<f64> = products.iter().map(|p| factor * p[lane]).collect();
            assert!(distance(&product, &sum) < ROUND_OFF);
        }

        let xyz: Vec<[[f64; 2]; 3]> = (0..n).map(|i| [x[i], y[i], z[i]].map(twice)).collect();
        let forms = upper.quadratic_forms([&va, &vb, &vc], &xyz);
        for (form, (m, v)) in forms.iter().zip([(&a, &x), (&b, &y), (&c, &z)]) {
            assert!((form[0] - dot(v, &multiply(m, v))).abs() < ROUND_OFF * dot(v, v) * 10. * 10.);
            assert_eq!(form[1], 4. * form[0]);
        }
    }
}
