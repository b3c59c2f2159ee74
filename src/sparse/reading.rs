//! One reading of interleaved matrices: quadratic forms and a product, of several cases at once.

use super::interleaved::{Block, Interleaved, Rest};
use super::widest::{Kernel, on_widest};
use std::ops::Range;

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
