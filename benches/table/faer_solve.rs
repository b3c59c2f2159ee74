//! faer's own supernodal Cholesky solve, in the same order of elimination.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};
use sprs::CsMat;

pub struct FaerSolve {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
    memory: MemBuffer,
}

impl FaerSolve {
    /// `a`: symmetric, positive definite, its unknowns numbered in elimination order.
    pub fn new(a: &CsMat<f64>) -> FaerSolve {
        let n = a.rows();
        let start = a.proper_indptr().into_owned();
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &start, None, a.indices());
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let symbolic = factorize_symbolic_cholesky(pattern, Side::Lower, SymmetricOrdering::Identity, parameters)
            .expect("memory suffices");
        let mut values = vec![0.; symbolic.len_val()];
        let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        symbolic
            .factorize_numeric_llt(
                &mut values,
                SparseColMatRef::new(pattern, a.data()),
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut MemBuffer::new(scratch)),
                Default::default(),
            )
            .expect("K* is positive definite");
        let memory = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        FaerSolve { symbolic, values, memory }
    }

    /// x <- A^-1 x, one thread.
    pub fn solve(&mut self, x: &mut [f64]) {
        let n = x.len();
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(x, n, 1),
            Par::Seq,
            MemStack::new(&mut self.memory),
        );
    }
}
