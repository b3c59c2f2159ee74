//! Cells that stand twice in a mesh file.

use super::mesh::Cell;

/// Finds a cell that has the same nodes as another: those that share their smallest node are chained.
pub(super) struct Duplicates {
    /// by smallest node: the last cell that has it
    last: Vec<usize>,
    /// by cell: the one before it in the chain
    before: Vec<usize>,
}

impl Duplicates {
    const NONE: usize = usize::MAX;

    pub(super) fn new(points: usize) -> Duplicates {
        Duplicates { last: vec![Self::NONE; points], before: Vec::new() }
    }

    fn smallest(cell: &Cell) -> usize {
        cell.nodes.iter().copied().min().expect("a cell has nodes")
    }

    pub(super) fn find(&self, cell: &Cell, cells: &[Cell]) -> Option<usize> {
        let mut id = self.last[Self::smallest(cell)];
        while id != Self::NONE {
            let other = &cells[id];
            if other.shape == cell.shape && cell.nodes.iter().all(|n| other.nodes.contains(n)) {
                return Some(id);
            }
            id = self.before[id];
        }
        None
    }

    /// Chains the last of `cells`.
    pub(super) fn add(&mut self, cells: &[Cell]) {
        let id = self.before.len();
        self.before.push(std::mem::replace(&mut self.last[Self::smallest(&cells[id])], id));
    }
}
