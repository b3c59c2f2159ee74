//! Symmetric matrices on one pattern, interleaved so that one reading of their upper triangles serves all that is to be
//! known of them: stiffness A, mass B, and damping C = alpha B + beta A + E.

use super::widest::{Kernel, on_widest};
use sprs::CsMat;

/// A and B in 2 x 2 blocks of neighbouring unknowns: most unknowns are two at a node, with the same neighbours, and the
/// same mass along both axes.
///
/// An unknown that has no partner stands in a block of two whose second one has zeros only.
#[derive(Debug, Clone, PartialEq)]
pub struct Interleaved {
    unknowns: usize,
    alpha: f64,
    beta: f64,
    /// first unknown of each block row
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

/// What the matrices are multiplied by in one unknown, for each of K cases.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Factors<const K: usize> {
    /// u, v, w of the forms u'A u, v'B v, w'C w
    pub forms: [[f64; K]; 3],
    /// x, y of the sum B x + C y
    pub sum: [[f64; K]; 2],
}

impl<const K: usize> Factors<K> {
    pub const ZERO: Factors<K> = Factors { forms: [[0.; K]; 3], sum: [[0.; K]; 2] };
}

/// What one reading has found.
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
        for i in (0..a.rows()).filter(|&i| first[i] == i) {
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
        let factors = |i: usize| Factors { forms: of_unknown(i).map(|x| [x]), ..Factors::ZERO };
        self.read(&self.for_each_unknown(factors)).forms.map(|[form]| form)
    }

    /// B x + C y of one case, from each unknown's (x, y).
    pub fn sum(&self, of_unknown: impl Fn(usize) -> [f64; 2]) -> Vec<f64> {
        let factors = |i: usize| Factors { sum: of_unknown(i).map(|x| [x]), ..Factors::ZERO };
        self.read(&self.for_each_unknown(factors)).sum.into_iter().map(|[f]| f).collect()
    }

    fn for_each_unknown(&self, factors: impl Fn(usize) -> Factors<1>) -> Vec<Factors<1>> {
        (0..self.unknowns).map(factors).chain([Factors::ZERO]).collect()
    }

    /// Forms and sum of each unknown's factors.
    ///
    /// # Panics
    /// If there is not one set of factors for each unknown and one more, whose numbers are not used.
    pub fn read<const K: usize>(&self, factors: &[Factors<K>]) -> Found<K> {
        on_widest(Reading { matrices: self, factors })
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

struct Reading<'a, const K: usize> {
    matrices: &'a Interleaved,
    factors: &'a [Factors<K>],
}

impl<const K: usize> Kernel for Reading<'_, K> {
    type Output = Found<K>;

    #[inline(always)]
    fn run(self) -> Found<K> {
        let Reading { matrices, factors } = self;
        let Interleaved { unknowns, alpha, beta, rows, start, columns, blocks, rest } = matrices;
        assert_eq!(factors.len(), unknowns + 1, "factors for each unknown and one more");
        let mut found = Found { forms: [[0.; K]; 3], sum: vec![[0.; K]; factors.len()] };
        for (r, &i) in rows.iter().enumerate() {
            let (columns, blocks) = (&columns[start[r]..start[r + 1]], &blocks[start[r]..start[r + 1]]);
            let here = pair(factors, i as usize);
            let [mut u, mut v, mut w, mut sum] = [[[0.; K]; 2]; 4];
            for (&j, block) in columns.iter().zip(blocks) {
                let there = pair(factors, j as usize);
                let c = block.damping(*alpha, *beta);
                u = plus(u, times(&block.a, there.map(|f| f.forms[0])));
                v = plus(v, scaled(block.b, there.map(|f| f.forms[1])));
                w = plus(w, times(&c, there.map(|f| f.forms[2])));
                sum = plus(sum, plus(scaled(block.b, there.map(|f| f.sum[0])), times(&c, there.map(|f| f.sum[1]))));
                let c = transposed(c);
                let below = plus(scaled(block.b, here.map(|f| f.sum[0])), times(&c, here.map(|f| f.sum[1])));
                add(&mut found.sum, j as usize, below);
            }
            add(&mut found.sum, i as usize, sum);
            for (m, right) in [u, v, w].into_iter().enumerate() {
                let here = here.map(|f| f.forms[m]);
                for k in 0..K {
                    // Each block stands for two, the diagonal one is half of itself.
                    found.forms[m][k] += 2. * (here[0][k] * right[0][k] + here[1][k] * right[1][k]);
                }
            }
        }
        for entry in rest {
            entry.add_to(&mut found, factors, *alpha);
        }
        found.sum.pop();
        found
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
            found.forms[1][k] += twice * b * here.forms[1][k] * there.forms[1][k];
            found.forms[2][k] += twice * c * here.forms[2][k] * there.forms[2][k];
            found.sum[i][k] += b * there.sum[0][k] + c * there.sum[1][k];
            if i != j {
                found.sum[j][k] += b * here.sum[0][k] + c * here.sum[1][k];
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
        let of_unknown = |i: usize| Factors { forms: [u[i], v[i], w[i]].map(twice), sum: [x[i], y[i]].map(twice) };
        let factors: Vec<Factors<2>> = (0..n).map(of_unknown).chain([Factors::ZERO]).collect();
        let found = interleaved.read(&factors);

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
