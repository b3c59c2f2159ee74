//! Where the entries of L stand: supernode by supernode, packed in the order in which each sweep reads them.

use std::ops::Range;

use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;

/// Supernodes: neighbouring columns of L that have the same rows below their triangle.
pub(super) struct Panels {
    /// First column of each supernode, and the number of unknowns at the end.
    columns: Vec<usize>,
    /// Where the rows of each supernode begin and end in `rows`.
    start: Vec<usize>,
    /// The rows of each supernode, ascending: its own columns, then those below.
    rows: Vec<usize>,
    /// Number of entries before each supernode, and of all at the end.
    entries: Vec<usize>,
    /// Where each supernode finds itself in faer's values.
    places: Vec<Place>,
    /// The supernode that begins at the border between leading and trailing unknowns.
    pub border: usize,
}

/// A dense part of faer's values, column by column, upper triangle included.
struct Place {
    /// of its first diagonal entry
    first: usize,
    /// from an entry to the one on its right
    stride: usize,
}

/// The values of one supernode.
pub(super) struct Panel<'a> {
    values: &'a [f64],
    stride: usize,
    height: usize,
}

impl<'a> Panel<'a> {
    pub fn column(&self, j: usize) -> &'a [f64] {
        &self.values[j * self.stride..][..self.height]
    }
}

impl Panels {
    /// A supernode that reaches over `border` becomes two.
    pub fn new(supernodes: &SymbolicSupernodalCholesky<usize>, border: usize) -> Self {
        let n = supernodes.nrows();
        let ends = supernodes.supernode_begin().iter().skip(1).copied().chain([n]);
        let mut panels =
            Panels { columns: vec![], start: vec![0], rows: vec![], entries: vec![0], places: vec![], border: 0 };
        for (s, (&begin, end)) in supernodes.supernode_begin().iter().zip(ends).enumerate() {
            let pattern = supernodes.supernode(s).pattern();
            let (values, stride) = (supernodes.col_ptr_for_val()[s], end - begin + pattern.len());
            let cut = if (begin + 1..end).contains(&border) { border } else { end };
            for (from, to) in [(begin, cut), (cut, end)].into_iter().filter(|(from, to)| from < to) {
                panels.border += usize::from(to <= border);
                panels.columns.push(from);
                panels.rows.extend(from..end);
                panels.rows.extend_from_slice(pattern);
                panels.start.push(panels.rows.len());
                panels.places.push(Place { first: values + (from - begin) * (stride + 1), stride });
            }
        }
        panels.columns.push(n);
        for s in 0..panels.count() {
            let (width, height) = (panels.width(s), panels.rows(s).len());
            panels.entries.push(panels.entries[s] + width * height - width * (width - 1) / 2);
        }
        panels
    }

    pub fn unknowns(&self) -> usize {
        self.columns[self.count()]
    }

    pub fn count(&self) -> usize {
        self.columns.len() - 1
    }

    /// Number of columns of supernode `s`.
    pub fn width(&self, s: usize) -> usize {
        self.columns[s + 1] - self.columns[s]
    }

    /// Rows of supernode `s`: its own columns first.
    pub fn rows(&self, s: usize) -> &[usize] {
        &self.rows[self.start[s]..self.start[s + 1]]
    }

    /// Values of supernode `s` out of faer's.
    pub fn dense<'a>(&self, s: usize, values: &'a [f64]) -> Panel<'a> {
        let Place { first, stride } = self.places[s];
        Panel { values: &values[first..], stride, height: self.rows(s).len() }
    }

    /// L out of faer's values, as the forward sweep reads it.
    pub fn pack_forward(&self, values: &[f64]) -> Vec<f64> {
        let mut packed = Vec::with_capacity(self.entries(0..self.count()));
        for s in 0..self.count() {
            let panel = self.dense(s, values);
            self.each_forward(s, |i, j| packed.push(stored(panel.column(j)[i], i == j)));
        }
        packed
    }

    /// L out of faer's values, as the backward sweep reads it.
    pub fn pack_backward(&self, values: &[f64]) -> Vec<f64> {
        let mut packed = Vec::with_capacity(self.entries(0..self.count()));
        for s in (0..self.count()).rev() {
            let panel = self.dense(s, values);
            self.each_backward(s, |i, j| packed.push(stored(panel.column(j)[i], i == j)));
        }
        packed
    }

    /// Number of entries of some supernodes.
    pub fn entries(&self, supernodes: Range<usize>) -> usize {
        self.entries[supernodes.end] - self.entries[supernodes.start]
    }

    /// Columns of some supernodes.
    pub fn columns_of(&self, supernodes: Range<usize>) -> Range<usize> {
        self.columns[supernodes.start]..self.columns[supernodes.end]
    }

    /// Visits the entries (row, column) of supernode `s` in the order of the forward copy, counted inside it.
    fn each_forward(&self, s: usize, mut visit: impl FnMut(usize, usize)) {
        let (width, height) = (self.width(s), self.rows(s).len());
        for (first, size) in blocks(0, width) {
            (0..first).for_each(|j| (first..first + size).for_each(|i| visit(i, j)));
            (first..first + size).for_each(|j| (j..first + size).for_each(|i| visit(i, j)));
        }
        for (first, size) in blocks(width, height) {
            (0..width).for_each(|j| (first..first + size).for_each(|i| visit(i, j)));
        }
    }

    /// Visits the entries (row, column) of supernode `s` in the order of the backward copy, counted inside it.
    pub fn each_backward(&self, s: usize, mut visit: impl FnMut(usize, usize)) {
        let (width, height) = (self.width(s), self.rows(s).len());
        for (first, size) in blocks(0, width).rev() {
            (first + size..height).for_each(|i| (first..first + size).for_each(|j| visit(i, j)));
            (first..first + size).rev().for_each(|j| (j..first + size).for_each(|i| visit(i, j)));
        }
    }
}

/// An entry of L as it is packed.
fn stored(l: f64, diagonal: bool) -> f64 {
    if diagonal { 1.0 / l } else { l }
}

/// Rows or columns that are summed at once: enough sums that none waits for its last addition.
pub(super) const BLOCK: usize = 8;

/// Cuts `from..to` into blocks (first, size): as many of `BLOCK` as fit, then the rest.
pub(super) fn blocks(from: usize, to: usize) -> impl DoubleEndedIterator<Item = (usize, usize)> {
    (from..to).step_by(BLOCK).map(move |first| (first, BLOCK.min(to - first)))
}
