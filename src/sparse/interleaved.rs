//! Three symmetric matrices on one pattern, interleaved so that one reading of their upper triangles serves all that is
//! to be known of them.

use super::widest::{Kernel, on_widest};
use sprs::CsMat;

/// A and B and C, 2 x 2 blocks of neighbouring unknowns: most unknowns are two at a node, with the same neighbours.
///
/// An unknown that has no partner stands in a block of two whose second one has zeros only.
#[derive(Debug, Clone, PartialEq)]
pub struct Interleaved {
    unknowns: usize,
    /// first unknown of each block row
    rows: Vec<u32>,
    /// where the blocks of each row begin; the first is the diagonal one
    start: Vec<usize>,
    /// first unknown of each block's columns
    columns: Vec<u32>,
    blocks: Vec<[Block; 3]>,
}

/// (a_00, a_10, a_01, a_11)
type Block = [f64; 4];

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
    /// Their pattern is symmetric.
    ///
    /// # Panics
    /// If the matrices differ in their patterns, a row has no diagonal entry, or there are more unknowns than 32 bits
    /// count.
    pub fn new(matrices: [&CsMat<f64>; 3]) -> Interleaved {
        let pattern = matrices[0];
        for matrix in matrices {
            assert_eq!(
                (matrix.indptr(), matrix.indices()),
                (pattern.indptr(), pattern.indices()),
                "one pattern for all"
            );
        }
        let first = first_of_blocks(pattern);
        let mut interleaved =
            Interleaved { unknowns: pattern.rows(), rows: vec![], start: vec![0], columns: vec![], blocks: vec![] };
        let has_partner = |i: usize| first.get(i + 1) == Some(&i);
        let row = |i: usize| pattern.indptr().outer_inds_sz(i);
        for i in (0..pattern.rows()).filter(|&i| first[i] == i) {
            let before = interleaved.blocks.len();
            for (place, &j) in row(i).zip(&pattern.indices()[row(i)]).filter(|(_, j)| **j >= i && first[**j] == **j) {
                // the partner's row has the same columns, a partner's column is the next one
                let below = has_partner(i).then(|| place + row(i).len());
                let right = |place: usize| has_partner(j).then(|| place + 1);
                let places = [Some(place), below, right(place), below.and_then(right)];
                interleaved.columns.push(narrow(j));
                interleaved.blocks.push(matrices.map(|m| places.map(|place| place.map_or(0., |p| m.data()[p]))));
            }
            assert_eq!(interleaved.columns.get(before), Some(&narrow(i)), "every row has its diagonal entry");
            interleaved.rows.push(narrow(i));
            interleaved.start.push(interleaved.blocks.len());
        }
        interleaved
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
        let Reading { matrices: Interleaved { unknowns, rows, start, columns, blocks }, factors } = self;
        assert_eq!(factors.len(), unknowns + 1, "factors for each unknown and one more");
        let mut found = Found { forms: [[0.; K]; 3], sum: vec![[0.; K]; factors.len()] };
        for (r, &i) in rows.iter().enumerate() {
            let i = i as usize;
            let (own, blocks) = blocks[start[r]..start[r + 1]].split_first().expect("the diagonal one");
            let here = pair(factors, i);
            let mut sum = sum_of(own, &here);
            let [mut u, mut v, mut w] = [[[0.; K]; 2]; 3];
            for (&j, block) in columns[start[r] + 1..start[r + 1]].iter().zip(blocks) {
                let j = j as usize;
                let there = pair(factors, j);
                sum = plus(sum, sum_of(block, &there));
                u = plus(u, times(&block[0], there.map(|f| f.forms[0])));
                v = plus(v, times(&block[1], there.map(|f| f.forms[1])));
                w = plus(w, times(&block[2], there.map(|f| f.forms[2])));
                add(&mut found.sum, j, sum_of(&block.map(transposed), &here));
            }
            add(&mut found.sum, i, sum);
            for (m, right) in [u, v, w].into_iter().enumerate() {
                let here = here.map(|f| f.forms[m]);
                let diagonal = times(&own[m], here);
                // Each block off the diagonal stands for two.
                for k in 0..K {
                    found.forms[m][k] += here[0][k] * (diagonal[0][k] + 2. * right[0][k])
                        + here[1][k] * (diagonal[1][k] + 2. * right[1][k]);
                }
            }
        }
        found.sum.pop();
        found
    }
}

/// Of the two unknowns of a block.
#[inline(always)]
fn pair<const K: usize>(factors: &[Factors<K>], i: usize) -> [&Factors<K>; 2] {
    let pair: &[Factors<K>; 2] = factors[i..].first_chunk().expect("one more than there are unknowns");
    pair.each_ref()
}

/// B x + C y.
#[inline(always)]
fn sum_of<const K: usize>([_, b, c]: &[Block; 3], factors: &[&Factors<K>; 2]) -> [[f64; K]; 2] {
    plus(times(b, factors.map(|f| f.sum[0])), times(c, factors.map(|f| f.sum[1])))
}

/// A x.
#[inline(always)]
fn times<const K: usize>(a: &Block, x: [[f64; K]; 2]) -> [[f64; K]; 2] {
    let mut product = [[0.; K]; 2];
    for r in 0..2 {
        for k in 0..K {
            product[r][k] = a[r] * x[0][k] + a[2 + r] * x[1][k];
        }
    }
    product
}

#[inline(always)]
fn transposed([a, b, c, d]: Block) -> Block {
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
    use crate::sparse::multiply;
    use crate::sparse::testing::{distance, grid_matrix, random};
    use crate::sparse::vector::{add, dot};
    use sprs::TriMat;

    /// Sums of some thirty products of numbers up to 1, each exact to 1e-16.
    const ROUND_OFF: f64 = 1e-14;

    /// Two unknowns at most nodes of a grid, one at every fifth, the last among them.
    fn matrix(seed: usize) -> CsMat<f64> {
        let grid = grid_matrix(9, 5, &[3, 4]);
        let mut numbers: Vec<Vec<usize>> = Vec::new();
        let mut count = 0;
        for node in 0..grid.rows() {
            let at_node = if node % 5 == 4 { 1 } else { 2 };
            numbers.push((count..count + at_node).collect());
            count += at_node;
        }
        let values = random(count * count, seed);
        let mut matrix = TriMat::new((count, count));
        for (_, (a, b)) in grid.iter() {
            for (&i, &j) in numbers[a].iter().flat_map(|i| numbers[b].iter().map(move |j| (i, j))) {
                matrix.add_triplet(i, j, values[i.min(j) * count + i.max(j)]);
            }
        }
        matrix.to_csr()
    }

    #[test]
    fn one_reading_gives_the_products_of_the_whole_matrices() {
        let [a, b, c] = [1, 2, 3].map(matrix);
        let n = a.rows();
        let interleaved = Interleaved::new([&a, &b, &c]);
        assert!(interleaved.rows.len() < 6 * n / 10, "two unknowns at most nodes stand in one block");
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
