//! Sparse symmetric systems whose unknowns are numbered in elimination order; knows no physics.
//!
//! Matrices are `sprs` CSR with both triangles stored and sorted columns, so that rows and columns read the same.

pub mod factor;
pub mod lanczos;
pub mod ordering;
pub mod orders;
mod panels;
pub mod pivots;
pub mod sweeps;
pub mod symmetric;
pub mod upper;
pub mod vector;
mod widest;

pub use factor::{Factor, Symbolic};
pub use lanczos::{Mode, smallest_modes};
pub use ordering::{Graph, elimination_order};
pub use orders::Orders;
pub use pivots::{NotPositiveDefinite, UnreliablePivot};
pub use symmetric::Symmetric;
pub use upper::Upper;

use sprs::CsMat;

/// Several vectors at once: row i holds the entries of unknown i.
pub type Lanes<const K: usize> = [[f64; K]];

/// Calls a function of the number of lanes that is known when compiling, enough for `count` vectors.
///
/// # Panics
/// If there are more than [`MOST_LANES`].
macro_rules! with_lanes_for {
    ($count:expr, $f:ident($($argument:expr),*)) => {
        match $count {
            1 => $f::<1>($($argument),*),
            2 => $f::<2>($($argument),*),
            3 | 4 => $f::<4>($($argument),*),
            count => {
                assert!(count <= $crate::sparse::MOST_LANES, "{count} vectors are too many for one call");
                $f::<{ $crate::sparse::MOST_LANES }>($($argument),*)
            }
        }
    };
}
pub(crate) use with_lanes_for;

pub const MOST_LANES: usize = 8;

/// A x.
///
/// # Panics
/// If `x` is not as long as `a` has columns.
pub fn multiply(a: &CsMat<f64>, x: &[f64]) -> Vec<f64> {
    assert_eq!(a.cols(), x.len(), "A x: columns of A and length of x");
    a.outer_iterator().map(|row| row.iter().map(|(j, aij)| aij * x[j]).sum()).collect()
}

#[cfg(test)]
mod testing;
