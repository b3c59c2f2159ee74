//! What pivots can be wrong with.

use std::fmt;

/// The matrix has no Cholesky factor: the pivot of `unknown` is not a positive number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotPositiveDefinite {
    pub unknown: usize,
}

impl fmt::Display for NotPositiveDefinite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the matrix is not positive definite: the pivot of unknown {} is not positive", self.unknown)
    }
}

impl std::error::Error for NotPositiveDefinite {}

/// A pivot that is too small to divide by has spoilt the row of `unknown`: the signs of the pivots prove nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UnreliablePivot {
    pub unknown: usize,
}

impl fmt::Display for UnreliablePivot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "a pivot is too near to zero to count eigenvalues (noticed at unknown {}); move the shift",
            self.unknown
        )
    }
}

impl std::error::Error for UnreliablePivot {}
