//! The two sweeps of a solve, x <- L^-1 x and x <- L^-T x, over L packed in the order in which each reads it.
//!
//! A sweep costs the reading of L and little else, so every value is read once, in ascending order of memory: the
//! forward copy holds blocks of rows, the backward copy blocks of columns from the last to the first. Read backwards
//! from one copy, L comes several times slower. A block of `W` rows (or columns) is interleaved, so that `W` sums run
//! at once. Diagonal entries are stored inverted. Several right-hand sides share the reading: `K` lanes side by side.

use std::ops::Range;

use super::panels::{BLOCK, Panels, blocks};
use super::widest::{Kernel, on_widest};
use super::{Factor, Lanes};

/// Calls a function of the block size that is known when compiling.
macro_rules! of_size {
    ($size:expr, $f:ident($($argument:expr),*)) => {
        match $size {
            1 => $f::<1, K>($($argument),*),
            2 => $f::<2, K>($($argument),*),
            3 => $f::<3, K>($($argument),*),
            4 => $f::<4, K>($($argument),*),
            5 => $f::<5, K>($($argument),*),
            6 => $f::<6, K>($($argument),*),
            7 => $f::<7, K>($($argument),*),
            _ => $f::<BLOCK, K>($($argument),*),
        }
    };
}

impl Factor {
    /// x <- L^-1 x.
    ///
    /// # Panics
    /// If `x` has not one entry for each unknown; likewise the functions below.
    pub fn forward(&self, x: &mut [f64]) {
        self.sweep_forward(0..self.panels.count(), one_lane(x));
    }

    /// x <- L^-T x.
    pub fn backward(&self, x: &mut [f64]) {
        self.sweep_backward(0..self.panels.count(), one_lane(x));
    }

    /// x <- A^-1 x.
    pub fn solve(&self, x: &mut [f64]) {
        self.forward(x);
        self.backward(x);
    }

    /// Eliminates the unknowns before the border i: x_i <- L_ii^-1 x_i, x_c <- x_c - A_ci A_ii^-1 x_i. What is left for
    /// the others is S x_c, S the Schur complement.
    pub fn condense(&self, x: &mut [f64]) {
        self.condense_lanes(one_lane(x));
    }

    /// Back from the solution x_c of the unknowns behind the border to that of all: x_i <- L_ii^-T (x_i - L_ci^T x_c).
    pub fn expand(&self, x: &mut [f64]) {
        self.sweep_backward(0..self.panels.border, one_lane(x));
    }

    /// [`Factor::condense`] for several vectors, reading L once.
    pub fn condense_lanes<const K: usize>(&self, x: &mut Lanes<K>) {
        self.sweep_forward(0..self.panels.border, x);
    }

    /// [`Factor::expand`] for several vectors in one of the [`Factor::parts`], all parts before it done, reading its L
    /// once.
    pub fn expand_part<const K: usize>(&self, part: &Part, x: &mut Lanes<K>) {
        self.sweep_backward(part.supernodes.clone(), x);
    }

    /// The unknowns before the border cut in parts of `size` or little more, the last ones first: what is done with one
    /// part right after another finds its numbers in the cache.
    pub fn parts(&self, size: usize) -> impl Iterator<Item = Part> {
        let mut end = self.panels.border;
        std::iter::from_fn(move || {
            let columns = |first: usize| self.panels.columns_of(first..end);
            let first = (0..end).rev().find(|&first| first == 0 || columns(first).len() >= size)?;
            let part = Part { supernodes: first..end, unknowns: columns(first) };
            end = first;
            Some(part)
        })
    }

    fn sweep_forward<const K: usize>(&self, supernodes: Range<usize>, x: &mut Lanes<K>) {
        assert_eq!(x.len(), self.len(), "one entry of x for each unknown");
        on_widest(Sweep { direction: Direction::Forward, panels: &self.panels, l: &self.forward, supernodes, x });
    }

    fn sweep_backward<const K: usize>(&self, supernodes: Range<usize>, x: &mut Lanes<K>) {
        assert_eq!(x.len(), self.len(), "one entry of x for each unknown");
        let behind = self.panels.entries(supernodes.end..self.panels.count());
        let l = &self.backward[behind..];
        on_widest(Sweep { direction: Direction::Backward, panels: &self.panels, l, supernodes, x });
    }
}

fn one_lane(x: &mut [f64]) -> &mut Lanes<1> {
    x.as_chunks_mut().0
}

/// Unknowns that a sweep back finds one after the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    supernodes: Range<usize>,
    pub unknowns: Range<usize>,
}

enum Direction {
    Forward,
    Backward,
}

/// Over some supernodes.
struct Sweep<'a, const K: usize> {
    direction: Direction,
    panels: &'a Panels,
    l: &'a [f64],
    supernodes: Range<usize>,
    x: &'a mut Lanes<K>,
}

impl<const K: usize> Kernel for Sweep<'_, K> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        match self.direction {
            Direction::Forward => forward(self.panels, self.l, self.supernodes, self.x),
            Direction::Backward => backward(self.panels, self.l, self.supernodes, self.x),
        }
    }
}

#[inline(always)]
fn forward<const K: usize>(panels: &Panels, l: &[f64], supernodes: Range<usize>, x: &mut Lanes<K>) {
    let mut l = l;
    for s in supernodes {
        let (width, rows) = (panels.width(s), panels.rows(s));
        for (first, size) in blocks(0, width) {
            of_size!(size, solve_rows(&mut l, &mut x[rows[0]..], first));
        }
        for (first, size) in blocks(width, rows.len()) {
            of_size!(size, subtract_rows(&mut l, x, &rows[..width], &rows[first..]));
        }
    }
}

#[inline(always)]
fn backward<const K: usize>(panels: &Panels, l: &[f64], supernodes: Range<usize>, x: &mut Lanes<K>) {
    let mut l = l;
    for s in supernodes.rev() {
        let (width, rows) = (panels.width(s), panels.rows(s));
        for (first, size) in blocks(0, width).rev() {
            of_size!(size, solve_columns(&mut l, x, &rows[first..]));
        }
    }
}

/// x_i <- (x_i - sum_j l_ij x_j) / l_ii for the rows i = first..first + W of a triangle, all j < i.
#[inline(always)]
fn solve_rows<const W: usize, const K: usize>(l: &mut &[f64], x: &mut Lanes<K>, first: usize) {
    let (known, x) = x.split_at_mut(first);
    let sums = interleaved_sums::<W, K>(take(l, W * first), known.iter().copied());
    let mut block: [[f64; K]; W] = std::array::from_fn(|i| minus(x[i], 1., sums[i]));
    for j in 0..W {
        let column = take(l, W - j);
        block[j] = block[j].map(|x| x * column[0]);
        for i in j + 1..W {
            block[i] = minus(block[i], column[i - j], block[j]);
        }
    }
    x[..W].copy_from_slice(&block);
}

/// x_i <- x_i - sum_j l_ij x_j for the first W of the rows i, all columns j.
#[inline(always)]
fn subtract_rows<const W: usize, const K: usize>(l: &mut &[f64], x: &mut Lanes<K>, columns: &[usize], rows: &[usize]) {
    let known = &x[columns[0]..][..columns.len()];
    let sums = interleaved_sums::<W, K>(take(l, W * known.len()), known.iter().copied());
    for (&i, sum) in rows.iter().zip(sums) {
        x[i] = minus(x[i], 1., sum);
    }
}

/// x_j <- (x_j - sum_i l_ij x_i) / l_jj for the columns j that are the first W of the rows i, all i > j.
#[inline(always)]
fn solve_columns<const W: usize, const K: usize>(l: &mut &[f64], x: &mut Lanes<K>, rows: &[usize]) {
    let (columns, below) = rows.split_at(W);
    let sums = interleaved_sums::<W, K>(take(l, W * below.len()), below.iter().map(|&i| x[i]));
    let x = &mut x[columns[0]..][..W];
    let mut block: [[f64; K]; W] = std::array::from_fn(|j| minus(x[j], 1., sums[j]));
    for j in (0..W).rev() {
        let column = take(l, W - j);
        for i in j + 1..W {
            block[j] = minus(block[j], column[i - j], block[i]);
        }
        block[j] = block[j].map(|x| x * column[0]);
    }
    x.copy_from_slice(&block);
}

/// sum_k l[W k + i] x_k for i = 0..W.
#[inline(always)]
fn interleaved_sums<const W: usize, const K: usize>(l: &[f64], x: impl Iterator<Item = [f64; K]>) -> [[f64; K]; W] {
    let mut sums = [[0.0; K]; W];
    for (l, x) in l.chunks_exact(W).zip(x) {
        for i in 0..W {
            for k in 0..K {
                sums[i][k] += l[i] * x[k];
            }
        }
    }
    sums
}

/// x - factor y.
#[inline(always)]
fn minus<const K: usize>(x: [f64; K], factor: f64, y: [f64; K]) -> [f64; K] {
    std::array::from_fn(|k| x[k] - factor * y[k])
}

/// Cuts the first `n` values off.
#[inline(always)]
fn take<'a>(l: &mut &'a [f64], n: usize) -> &'a [f64] {
    let (taken, rest) = l.split_at(n);
    *l = rest;
    taken
}

#[cfg(test)]
mod tests {
    use crate::sparse::testing::{dense, distance, grid_matrix, random};
    use crate::sparse::{Symbolic, multiply};

    #[test]
    fn solve_gives_back_the_solution() {
        for (nx, ny) in [(1, 1), (3, 2), (12, 7), (40, 33)] {
            let a = grid_matrix(nx, ny, &[]);
            let factor = Symbolic::new(&a).factor(&a).expect("positive definite");
            let exact = random(a.rows(), 7);
            let mut x = multiply(&a, &exact);
            factor.solve(&mut x);
            // The smallest eigenvalue is 1 or more, the largest some tens.
            assert!(distance(&x, &exact) < 1e-13, "{nx} x {ny}");
        }
    }

    #[test]
    fn each_sweep_is_that_of_the_dense_factor() {
        let a = grid_matrix(14, 11, &[0, 1, 2]);
        let factor = Symbolic::new(&a).factor(&a).expect("positive definite");
        let l = dense(&a).cholesky().expect("positive definite").l();
        let x = random(a.rows(), 1);
        let lx = &l * nalgebra::DVector::from_column_slice(&x);
        let ltx = l.transpose() * nalgebra::DVector::from_column_slice(&x);
        let (mut forward, mut backward) = (lx.as_slice().to_vec(), ltx.as_slice().to_vec());
        factor.forward(&mut forward);
        factor.backward(&mut backward);
        assert!(distance(&forward, &x) < 1e-13);
        assert!(distance(&backward, &x) < 1e-13);
    }

    #[test]
    fn parts_cover_all_unknowns_before_the_border_and_give_the_whole_sweep() {
        let a = grid_matrix(40, 33, &[]);
        let border = a.rows() - 5;
        let factor = Symbolic::bordered(&a, border).factor(&a).expect("positive definite");
        assert_eq!(factor.border(), border);
        let mut whole = random(a.rows(), 3);
        let before = whole.clone();
        factor.expand(&mut whole);
        for size in [1, 100, a.rows()] {
            let mut x: Vec<[f64; 1]> = before.iter().map(|&x| [x]).collect();
            let mut end = border;
            for part in factor.parts(size) {
                assert!(part.unknowns.end == end && (part.unknowns.start == 0 || part.unknowns.len() >= size));
                end = part.unknowns.start;
                factor.expand_part(&part, &mut x);
                assert!(part.unknowns.clone().all(|i| x[i] == [whole[i]]), "{:?}", part.unknowns);
            }
            assert_eq!(end, 0);
        }
    }

    /// To the last digit: a run among others gives what it gives alone.
    #[test]
    fn lanes_do_not_change_each_others_digits() {
        let a = grid_matrix(40, 33, &[]);
        let border = a.rows() - 5;
        let factor = Symbolic::bordered(&a, border).factor(&a).expect("positive definite");
        let vectors = [1, 2, 3, 4].map(|seed| random(a.rows(), seed));
        let mut lanes: Vec<[f64; 4]> = (0..a.rows()).map(|i| std::array::from_fn(|k| vectors[k][i])).collect();
        factor.condense_lanes(&mut lanes);
        factor.parts(300).for_each(|part| factor.expand_part(&part, &mut lanes));
        for (k, mut alone) in vectors.into_iter().enumerate() {
            factor.condense(&mut alone);
            factor.expand(&mut alone);
            assert!(lanes.iter().zip(&alone).all(|(lane, alone)| lane[k] == *alone), "lane {k}");
        }
    }
}
