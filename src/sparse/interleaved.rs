//! Symmetric matrices on one pattern, interleaved so that one reading of their upper triangles serves all that is to be
//! known of them: stiffness A, mass B, and damping C = alpha B + beta A + E.

use super::widest::{Kernel, on_widest};
use sprs::CsMat;
use std::ops::Range;

/// A and B in 2 x 2 blocks of neighbouring unknowns: most unknowns are two at a node, with the same neighbours, and the
/// same mass along both axes.
///
/// An unknown that has no partner stands in a block of two whose second one has zeros only.
#[derive(Debug, Clone, PartialEq)]
pub struct Interleaved {
    unknowns: usize,
    alpha: f64,
    beta: f64,
    /// first unknown of each block row, the last rows first
    rows: Vec<u32>,
    /// where the blocks of each row begin; the first is the diagonal one
    start: Vec<usize>,
    /// first unknown of each block's columns
    columns: Vec<u32>,
    blocks: Vec<Block>,
    /// what the blocks do not hold
    rest: Vec<Rest>,
}

/// On the diagonal half of itself: it is read as right of itself, and as below itself.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Block {
    /// (a_00, a_10, a_01, a_11)
    a: [f64; 4],
    /// b_00 = b_11, and b_01 = b_10 = 0
    b: f64,
}

/// An entry of the upper triangle: B without its blocks, and E.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Rest {
    row: u32,
    column: u32,
    b: f64,
    e: f64,
}

/// What the matrices are multiplied by in one unknown, for each of K cases: [`U`], [`V`], [`W`] of the forms u'A u,
/// v'B v, w'C w, and [`X`], [`Y`] of the sum B x + C y. Bare numbers, so that one room serves any number of cases.
pub type Factors<const K: usize> = [[f64; K]; 5];

pub const U: usize = 0;
pub const V: usize = 1;
pub const W: usize = 2;
pub const X: usize = 3;
pub const Y: usize = 4;

/// What a reading has found.
#[derive(Debug, Clone, PartialEq)]
pub struct Found<const K: usize> {
    /// u'A u, v'B v, w'C w
    pub forms: [[f64; K]; 3],
    /// B x + C y
    pub sum: Vec<[f64; K]>,
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

/// Forms and sum in the making: the last unknowns' rows are read first, so that it makes no difference where the
/// reading pauses.
pub struct Reading<'a, const K: usize> {
    matrices: &'a Interleaved,
    /// block rows that are read
    done: usize,
    found: Found<K>,
}

impl<const K: usize> Reading<'_, K> {
    pub fn new(matrices: &Interleaved) -> Reading<'_, K> {
        let found = Found { forms: [[0.; K]; 3], sum: vec![[0.; K]; matrices.unknowns + 1] };
        Reading { matrices, done: 0, found }
    }

    /// Reads the rows from unknown `first` on that are still to be read: of these and of all behind them the factors
    /// are known.
    ///
    /// # Panics
    /// If there are not factors for each unknown and one more. These should be finite: they are multiplied by zeros.
    pub fn down_to(&mut self, first: usize, factors: &[Factors<K>]) {
        assert_eq!(factors.len(), self.matrices.unknowns + 1, "factors for each unknown and one more");
        let rows = self.done..self.matrices.rows.partition_point(|&row| row as usize >= first);
        self.done = rows.end;
        on_widest(Rows { matrices: self.matrices, rows, factors, found: &mut self.found });
    }

    /// When all rows are read.
    ///
    /// # Panics
    /// If they are not.
    pub fn found(mut self, factors: &[Factors<K>]) -> Found<K> {
        assert_eq!(self.done, self.matrices.rows.len(), "all rows are read");
        for entry in &self.matrices.rest {
            entry.add_to(&mut self.found, factors, self.matrices.alpha);
        }
        self.found.sum.pop();
        self.found
    }
}

/// Some block rows.
struct Rows<'a, const K: usize> {
    matrices: &'a Interleaved,
    rows: Range<usize>,
    factors: &'a [Factors<K>],
    found: &'a mut Found<K>,
}

impl<const K: usize> Kernel for Rows<'_, K> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Rows { matrices, rows, factors, found } = self;
        let Interleaved { alpha, beta, rows: first_of, start, columns, blocks, .. } = matrices;
        for r in rows {
            let i = first_of[r] as usize;
            let (columns, blocks) = (&columns[start[r]..start[r + 1]], &blocks[start[r]..start[r + 1]]);
            let here = pair(factors, i);
            let [mut u, mut v, mut w, mut sum] = [[[0.; K]; 2]; 4];
            for (&j, block) in columns.iter().zip(blocks) {
                let there = pair(factors, j as usize);
                let c = block.damping(*alpha, *beta);
                u = plus(u, times(&block.a, there.map(|f| f[U])));
                v = plus(v, scaled(block.b, there.map(|f| f[V])));
                w = plus(w, times(&c, there.map(|f| f[W])));
                sum = plus(sum, plus(scaled(block.b, there.map(|f| f[X])), times(&c, there.map(|f| f[Y]))));
                let c = transposed(c);
                let below = plus(scaled(block.b, here.map(|f| f[X])), times(&c, here.map(|f| f[Y])));
                add(&mut found.sum, j as usize, below);
            }
            add(&mut found.sum, i, sum);
            for (form, (row, right)) in [(U, u), (V, v), (W, w)].into_iter().enumerate() {
                let here = here.map(|f| f[row]);
                for k in 0..K {
                    // Each block stands for two, the diagonal one is half of itself.
                    found.forms[form][k] += 2. * (here[0][k] * right[0][k] + here[1][k] * right[1][k]);
                }
            }
        }
    }
}

impl Block {
    /// alpha B + beta A: (c_00, c_10, c_01, c_11).
    #[inline(always)]
    fn damping(&self, alpha: f64, beta: f64) -> [f64; 4] {
        let [a_00, a_10, a_01, a_11] = self.a;
        let of_mass = alpha * self.b;
        [of_mass + beta * a_00, beta * a_10, beta * a_01, of_mass + beta * a_11]
    }
}

impl Rest {
    #[inline(always)]
    fn add_to<const K: usize>(&self, found: &mut Found<K>, factors: &[Factors<K>], alpha: f64) {
        let Rest { row, column, b, e } = *self;
        let (i, j, c) = (row as usize, column as usize, alpha * b + e);
        let (here, there) = (&factors[i], &factors[j]);
        let twice = if i == j { 1. } else { 2. };
        for k in 0..K {
            found.forms[1][k] += twice * b * here[V][k] * there[V][k];
            found.forms[2][k] += twice * c * here[W][k] * there[W][k];
            found.sum[i][k] += b * there[X][k] + c * there[Y][k];
            if i != j {
                found.sum[j][k] += b * here[X][k] + c * here[Y][k];
            }
        }
    }
}

/// Of the two unknowns of a block.
#[inline(always)]
fn pair<const K: usize>(factors: &[Factors<K>], i: usize) -> [&Factors<K>; 2] {
    let pair: &[Factors<K>; 2] = factors[i..].first_chunk().expect("one more than there are unknowns");
    pair.each_ref()
}

/// A x.
#[inline(always)]
fn times<const K: usize>(a: &[f64; 4], x: [[f64; K]; 2]) -> [[f64; K]; 2] {
    let mut product = [[0.; K]; 2];
    for r in 0..2 {
        for k in 0..K {
            product[r][k] = a[r] * x[0][k] + a[2 + r] * x[1][k];
        }
    }
    product
}

/// b x.
#[inline(always)]
fn scaled<const K: usize>(b: f64, x: [[f64; K]; 2]) -> [[f64; K]; 2] {
    let mut product = [[0.; K]; 2];
    for r in 0..2 {
        for k in 0..K {
            product[r][k] = b * x[r][k];
        }
    }
    product
}

#[inline(always)]
fn transposed([a, b, c, d]: [f64; 4]) -> [f64; 4] {
    [a, c, b, d]
}

#[inline(always)]
fn plus<const K: usize>(x: [[f64; K]; 2], y: [[f64; K]; 2]) -> [[f64; K]; 2] {
    let mut sum = [[0.; K]; 2];
    for r in 0..2 {
        for k in 0..K {
            sum[r][k] = x[r][k] + y[r][k];
        }
    }
    sum
}

/// sums of unknowns i and i + 1 <- those + x.
#[inline(always)]
fn add<const K: usize>(sums: &mut [[f64; K]], i: usize, x: [[f64; K]; 2]) {
    let sums: &mut [[f64; K]; 2] = sums[i..].first_chunk_mut().expect("one more than there are unknowns");
    *sums = plus(*sums, x);
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
