//! Symmetric matrices on one pattern, interleaved so that one reading of their upper triangles serves all that is to be
//! known of them: stiffness A, mass B, and damping C = alpha B + beta A + E.

use super::reading::{Factors, Found, Reading};
use sprs::CsMat;

/// A and B in 2 x 2 blocks of neighbouring unknowns: most unknowns are two at a node, with the same neighbours, and the
/// same mass along both axes.
///
/// An unknown that has no partner stands in a block of two whose second one has zeros only.
#[derive(Debug, Clone, PartialEq)]
pub struct Interleaved {
    pub(super) unknowns: usize,
    pub(super) alpha: f64,
    pub(super) beta: f64,
    /// first unknown of each block row, the last rows first
    pub(super) rows: Vec<u32>,
    /// where the blocks of each row begin; the first is the diagonal one
    pub(super) start: Vec<usize>,
    /// first unknown of each block's columns
    pub(super) columns: Vec<u32>,
    pub(super) blocks: Vec<Block>,
    /// what the blocks do not hold
    pub(super) rest: Vec<Rest>,
}

/// On the diagonal half of itself: it is read as right of itself, and as below itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Block {
    /// (a_00, a_10, a_01, a_11)
    pub(super) a: [f64; 4],
    /// b_00 = b_11, and b_01 = b_10 = 0
    pub(super) b: f64,
}

/// An entry of the upper triangle: B without its blocks, and E.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rest {
    pub(super) row: u32,
    pub(super) column: u32,
    pub(super) b: f64,
    pub(super) e: f64,
}

impl Interleaved {
    /// All matrices are symmetric.
    ///
    /// # Panics
    /// If A and B differ in their patterns, a row has no diagonal entry, or there are more unknowns than 32 bits count.
    pub fn new([a, b]: [&CsMat<f64>; 2], [alpha, beta]: [f64; 2], e: Option<&CsMat<f64>>) -> Interleaved {
        assert_eq!((a.indptr(), a.indices()), (b.indptr(), b.indices()), "one pattern for both");
        let first = first_of_blocks(a);
        let has_partner = |i: usize| first.get(i + 1) == Some(&i);
        let row = |i: usize| a.indptr().outer_inds_sz(i);
        let (mut rows, mut start, mut columns, mut blocks) = (vec![], vec![0], vec![], vec![]);
        let mut rest = Vec::new();
        for i in (0..a.rows()).rev().filter(|&i| first[i] == i) {
            let before = columns.len();
            for (place, &j) in row(i).zip(&a.indices()[row(i)]).filter(|(_, j)| **j >= i && first[**j] == **j) {
                // the partner's row has the same columns, a partner's column is the next one
                let below = has_partner(i).then(|| place + row(i).len());
                let right = |place: usize| has_partner(j).then(|| place + 1);
                let places = [Some(place), below, right(place), below.and_then(right)];
                let [a, b] = [a, b].map(|matrix| places.map(|place| place.map_or(0., |p| matrix.data()[p])));
                // Only two partners both have an equal part of it.
                let in_block = if has_partner(i) && has_partner(j) { b[0] } else { 0. };
                rest.extend(rest_of(i, j, [b[0] - in_block, b[1], b[2], b[3] - in_block]));
                if i == j || (a, in_block) != ([0.; 4], 0.) {
                    let part = if i == j { 0.5 } else { 1. };
                    columns.push(narrow(j));
                    blocks.push(Block { a: a.map(|a| part * a), b: part * in_block });
                }
            }
            assert_eq!(columns.get(before), Some(&narrow(i)), "every row has its diagonal entry");
            rows.push(narrow(i));
            start.push(blocks.len());
        }
        let upper = e.into_iter().flatten().filter(|(_, (row, column))| row <= column);
        rest.extend(upper.map(|(&e, (row, column))| Rest { row: narrow(row), column: narrow(column), b: 0., e }));
        Interleaved { unknowns: a.rows(), alpha, beta, rows, start, columns, blocks, rest }
    }

    /// u'A u, v'B v and w'C w of one case, from each unknown's (u, v, w).
    pub fn forms(&self, of_unknown: impl Fn(usize) -> [f64; 3]) -> [f64; 3] {
        let factors = |i: usize| {
            let [u, v, w] = of_unknown(i);
            [u, v, w, 0., 0.]
        };
        self.read_alone(factors).forms.map(|[form]| form)
    }

    /// B x + C y of one case, from each unknown's (x, y).
    pub fn sum(&self, of_unknown: impl Fn(usize) -> [f64; 2]) -> Vec<f64> {
        let factors = |i: usize| {
            let [x, y] = of_unknown(i);
            [0., 0., 0., x, y]
        };
        self.read_alone(factors).sum.into_flattened()
    }

    fn read_alone(&self, of_unknown: impl Fn(usize) -> [f64; 5]) -> Found<1> {
        let factors: Vec<Factors<1>> =
            (0..self.unknowns).map(|i| of_unknown(i).map(|x| [x])).chain([[[0.]; 5]]).collect();
        let mut reading = Reading::new(self);
        reading.down_to(0, &factors);
        reading.found(&factors)
    }
}

/// What a block at (i, j) leaves of B = (b_00, b_10, b_01, b_11), zeros left out.
fn rest_of(i: usize, j: usize, b: [f64; 4]) -> impl Iterator<Item = Rest> {
    let places = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)];
    let upper = places.into_iter().zip(b).filter(|((row, column), b)| row <= column && *b != 0.);
    upper.map(|((row, column), b)| Rest { row: narrow(row), column: narrow(column), b, e: 0. })
}

fn narrow(unknown: usize) -> u32 {
    u32::try_from(unknown).expect("fewer unknowns than 2^32")
}

/// For each unknown the first of its block: a partner is the next unknown with the same neighbours.
fn first_of_blocks(pattern: &CsMat<f64>) -> Vec<usize> {
    let neighbours = |i: usize| &pattern.indices()[pattern.indptr().outer_inds_sz(i)];
    let mut first: Vec<usize> = Vec::with_capacity(pattern.rows());
    for i in 0..pattern.rows() {
        let partner = i.checked_sub(1).filter(|&p| first[p] == p && neighbours(p) == neighbours(i));
        first.push(partner.unwrap_or(i));
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sparse::testing::{distance, grid_matrix, random};
    use crate::sparse::vector::{add, dot};
    use crate::sparse::{multiply, without_zeros};
    use sprs::TriMat;

    /// Sums of some thirty products of numbers up to 1, each exact to 1e-16.
    const ROUND_OFF: f64 = 1e-14;

    /// Two unknowns at most nodes of a grid, one at every fifth, the last among them; the value of two nodes' unknowns.
    fn matrix(of: impl Fn([usize; 2], [usize; 2]) -> f64) -> CsMat<f64> {
        let grid = grid_matrix(9, 5, &[3, 4]);
        let mut numbers: Vec<Vec<usize>> = Vec::new();
        let mut count = 0;
        for node in 0..grid.rows() {
            let at_node = if node % 5 == 4 { 1 } else { 2 };
            numbers.push((count..count + at_node).collect());
            count += at_node;
        }
        let mut matrix = TriMat::new((count, count));
        for (_, (p, q)) in grid.iter() {
            for (axis, &i) in numbers[p].iter().enumerate() {
                for (other_axis, &j) in numbers[q].iter().enumerate() {
                    let value = if i <= j { of([p, axis], [q, other_axis]) } else { of([q, other_axis], [p, axis]) };
                    matrix.add_triplet(i, j, value);
                }
            }
        }
        matrix.to_csr()
    }

    /// The first node holds something else than mass, at one of its axes.
    #[test]
    fn one_reading_gives_the_products_of_the_whole_matrices() {
        const NODES: usize = 120;
        let values = random(4 * NODES * NODES, 1);
        let value = |[p, axis]: [usize; 2], [q, other_axis]: [usize; 2]| {
            values[2 * NODES * (2 * p + axis) + 2 * q + other_axis]
        };
        // Two nodes that only mass couples.
        let a = matrix(|p, q| if [p[0], q[0]] == [0, 1] { 0. } else { value(p, q) });
        let b = matrix(|p, q| match (p[1] == q[1], p, q) {
            (true, ..) => value([p[0], 0], [q[0], 0]) + if (p, q) == ([0, 1], [0, 1]) { 0.7 } else { 0. },
            (false, [0, _], [0, _]) => 0.3,
            _ => 0.,
        });
        let e = matrix(|p, q| if p[0] < 2 && q[0] < 2 { value(q, p) } else { 0. });
        let (alpha, beta) = (0.3, 0.02);
        let c = &(&a.map(|a| beta * a) + &b.map(|b| alpha * b)) + &e;
        let n = a.rows();
        let interleaved = Interleaved::new([&a, &b], [alpha, beta], Some(&without_zeros(&e)));
        assert!(interleaved.rows.len() < 6 * n / 10, "two unknowns at most nodes stand in one block");
        // what nodes with one unknown have in common with their neighbours, and the first node's two and E
        let rest = |e: bool| interleaved.rest.iter().filter(|entry| (entry.e != 0.) == e).count();
        let upper = (b.nnz() + n) / 2;
        assert!(rest(false) < upper / 4 && rest(true) == 10, "{} of {upper}, {}", rest(false), rest(true));

        let [u, v, w, x, y] = [4, 5, 6, 7, 8].map(|seed| random(n, seed));
        // The second case has twice the first's.
        let twice = |x: f64| [x, 2. * x];
        let of_unknown = |i: usize| [u[i], v[i], w[i], x[i], y[i]].map(twice);
        let factors: Vec<Factors<2>> = (0..n).map(of_unknown).chain([[[0.; 2]; 5]]).collect();
        // Row by row those of the last unknowns, with one cut inside a block, then all that are left; what is before
        // them is not known yet.
        let mut reading = Reading::new(&interleaved);
        for first in [n - 1, n - 2, n - 8, n - 9, 0] {
            let mut known = factors.clone();
            known[..first].fill([[f64::NAN; 2]; 5]);
            reading.down_to(first, &known);
        }
        let found = reading.found(&factors);

        let mut sum = multiply(&b, &x);
        add(&mut sum, 1., &multiply(&c, &y));
        for (case, factor) in [(0, 1.), (1, 0.5)] {
            let own: Vec<f64> = found.sum.iter().map(|s| factor * s[case]).collect();
            let apart = distance(&own, &sum);
            assert!(apart < ROUND_OFF, "{apart:e}");
        }
        for (form, (m, v)) in found.forms.iter().zip([(&a, &u), (&b, &v), (&c, &w)]) {
            assert!((form[0] - dot(v, &multiply(m, v))).abs() < ROUND_OFF * dot(v, v) * 10.);
            assert_eq!(form[1], 4. * form[0]);
        }
    }
}
