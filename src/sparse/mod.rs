//! Sparse symmetric systems whose unknowns are numbered in elimination order; knows no physics.
//!
//! Matrices are `sprs` CSR with both triangles stored and sorted columns, so that rows and columns read the same.

pub mod columns;
pub mod factor;
pub mod interleaved;
pub mod lanczos;
pub mod lanes;
pub mod ordering;
pub mod orders;
mod panels;
pub mod pivots;
pub mod reading;
pub mod sweeps;
pub mod symmetric;
pub mod vector;
pub(crate) mod widest;

pub use factor::{Factor, Symbolic};
pub use interleaved::Interleaved;
pub use lanczos::{Mode, smallest_modes};
pub(crate) use lanes::with_lanes_for;
pub use lanes::{Lanes, MOST_LANES};
pub use ordering::{Graph, elimination_order};
pub use orders::Orders;
pub use pivots::{NotPositiveDefinite, UnreliablePivot};
pub use reading::{Factors, Found, Reading};
pub use symmetric::Symmetric;

use sprs::{CsMat, TriMat};

/// A x.
///
/// # Panics
/// If `x` is not as long as `a` has columns.
pub fn multiply(a: &CsMat<f64>, x: &[f64]) -> Vec<f64> {
    assert_eq!(a.cols(), x.len(), "A x: columns of A and length of x");
    a.outer_iterator().map(|row| row.iter().map(|(j, aij)| aij * x[j]).sum()).collect()
}

/// The same matrix without the entries that are zero.
pub fn without_zeros(matrix: &CsMat<f64>) -> CsMat<f64> {
    let mut sparse = TriMat::new(matrix.shape());
    matrix.iter().filter(|(value, _)| **value != 0.).for_each(|(&value, (i, j))| sparse.add_triplet(i, j, value));
    sparse.to_csr()
}

#[cfg(test)]
pub(crate) mod testing;
