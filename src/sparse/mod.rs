//! Sparse symmetric systems whose unknowns are numbered in elimination order; knows no physics.
//!
//! Matrices are `sprs` CSR with both triangles stored and sorted columns, so that rows and columns read the same.

pub mod factor;
pub mod lanczos;
pub mod ordering;
pub mod sweeps;

pub use factor::{Factor, NotPositiveDefinite, Symbolic, UnreliablePivot};
pub use lanczos::{Mode, smallest_modes};
pub use ordering::{Graph, elimination_order};

use sprs::CsMat;

/// y = A x.
///
/// # Panics
/// If the lengths of `x` and `y` are not the columns and rows of `a`.
pub fn multiply(a: &CsMat<f64>, x: &[f64], y: &mut [f64]) {
    assert_eq!((a.rows(), a.cols()), (y.len(), x.len()), "A x = y: sizes of A and of (y, x)");
    for (row, yi) in a.outer_iterator().zip(y) {
        *yi = row.iter().map(|(j, aij)| aij * x[j]).sum();
    }
}

#[cfg(test)]
mod testing;
