//! Cholesky factor A = L L^T: analysed once for a pattern, computed for each set of values.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::cholesky::{simplicial, supernodal};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Mat, MatMut, Par};
use sprs::CsMat;

use super::panels::Panels;
use super::pivots::{NotPositiveDefinite, UnreliablePivot};
use crate::threads::both;

/// Where the factor of a pattern has its entries. Unknowns are eliminated in the order in which they are numbered.
pub struct Symbolic {
    start: Vec<usize>,
    columns: Vec<usize>,
    supernodes: supernodal::SymbolicSupernodalCholesky<usize>,
    panels: Arc<Panels>,
}

/// L of A = L L^T, packed for the two sweeps (see `sweeps`).
pub struct Factor {
    pub(super) panels: Arc<Panels>,
    /// L by rows, supernode after supernode.
    pub(super) forward: Vec<f64>,
    /// L by columns, from the last supernode to the first.
    pub(super) backward: Vec<f64>,
}

impl Symbolic {
    /// Finds the pattern of L; the values of `pattern` are not read.
    ///
    /// # Panics
    /// If `pattern` is not square CSR.
    pub fn new(pattern: &CsMat<f64>) -> Self {
        Symbolic::bordered(pattern, pattern.rows())
    }

    /// Likewise, for a factor that can stop at unknown `border`: [`Factor::condense`] and [`Factor::expand`].
    ///
    /// # Panics
    /// If `pattern` is not square CSR.
    pub fn bordered(pattern: &CsMat<f64>, border: usize) -> Self {
        assert!(pattern.is_csr() && pattern.rows() == pattern.cols(), "a symmetric matrix is square CSR");
        let n = pattern.rows();
        let start = pattern.proper_indptr().into_owned();
        let columns = pattern.indices().to_vec();
        let a = SymbolicSparseColMatRef::new_checked(n, n, &start, None, &columns);

        let scratch = simplicial::prefactorize_symbolic_cholesky_scratch::<usize>(n, columns.len())
            .or(supernodal::factorize_supernodal_symbolic_cholesky_scratch::<usize>(n));
        let mut memory = MemBuffer::new(scratch);
        let (mut tree, mut counts) = (vec![0; n], vec![0; n]);
        let tree = simplicial::prefactorize_symbolic_cholesky(&mut tree, &mut counts, a, MemStack::new(&mut memory));
        let supernodes = supernodal::factorize_supernodal_symbolic_cholesky(
            a,
            tree,
            &counts,
            MemStack::new(&mut memory),
            Default::default(),
        )
        .expect("it fails only where memory ends, as any Vec here would");
        let panels = Arc::new(Panels::new(&supernodes, border));
        Symbolic { start, columns, supernodes, panels }
    }

    /// Bytes that a factor takes while it is made: L as faer computes it and its two packed copies, 8 an entry; the
    /// matrix that is factored and one that it was made from, 16 an entry.
    pub fn bytes(&self) -> f64 {
        let entries = self.supernodes.len_val() + 2 * self.panels.entries(0..self.panels.count());
        (8 * entries + 2 * 16 * self.columns.len()) as f64
    }

    /// A = L L^T.
    ///
    /// # Errors
    /// Names the first unknown whose pivot is not positive.
    ///
    /// # Panics
    /// If the pattern of `a` is not the analysed one.
    pub fn factor(&self, a: &CsMat<f64>) -> Result<Factor, NotPositiveDefinite> {
        let values = self.values(a)?;
        let (forward, backward) = both(|| self.panels.pack_forward(&values), || self.panels.pack_backward(&values));
        Ok(Factor { panels: self.panels.clone(), forward, backward })
    }

    /// x <- A^-1 x, for a matrix that is solved with once: packing its factor would take longer than it saves.
    ///
    /// # Errors
    /// Names the first unknown whose pivot is not positive.
    ///
    /// # Panics
    /// If the pattern of `a` is not the analysed one, or `x` has another length.
    pub fn solve_once(&self, a: &CsMat<f64>, x: &mut [f64]) -> Result<(), NotPositiveDefinite> {
        let values = self.values(a)?;
        let scratch = self.supernodes.solve_in_place_scratch::<f64>(1, Par::Seq);
        supernodal::SupernodalLltRef::new(&self.supernodes, &values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(x, self.start.len() - 1, 1),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
        Ok(())
    }

    /// L of A = L L^T as faer stores it.
    fn values(&self, a: &CsMat<f64>) -> Result<Vec<f64>, NotPositiveDefinite> {
        let scratch = supernodal::factorize_supernodal_numeric_llt_scratch::<usize, f64>(
            &self.supernodes,
            Par::Seq,
            Default::default(),
        );
        let mut values = vec![0.0; self.supernodes.len_val()];
        supernodal::factorize_supernodal_numeric_llt(
            &mut values,
            self.matrix(a),
            Default::default(),
            &self.supernodes,
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
            Default::default(),
        )
        .map_err(|faer::linalg::cholesky::llt::factor::LltError::NonPositivePivot { index }| {
            NotPositiveDefinite { unknown: index }
        })?;
        Ok(values)
    }

    /// Number of negative eigenvalues of A, counted on D of A = L D L^T (Sylvester). For A = K - sigma M it is the
    /// number of eigenvalues of K phi = lambda M phi below sigma.
    ///
    /// # Errors
    /// L D L^T takes no pivots out of turn, so a small one can spoil the rest: it is named, and another shift helps.
    ///
    /// # Panics
    /// If the pattern of `a` is not the analysed one.
    pub fn negative_pivots(&self, a: &CsMat<f64>) -> Result<usize, UnreliablePivot> {
        let scratch = supernodal::factorize_supernodal_numeric_ldlt_scratch::<usize, f64>(
            &self.supernodes,
            Par::Seq,
            Default::default(),
        );
        let mut values = vec![0.0; self.supernodes.len_val()];
        supernodal::factorize_supernodal_numeric_ldlt(
            &mut values,
            self.matrix(a),
            Default::default(),
            &self.supernodes,
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
            Default::default(),
        )
        .map_err(|faer::linalg::cholesky::ldlt::factor::LdltError::ZeroPivot { index }| UnreliablePivot {
            unknown: index,
        })?;
        self.reliable_signs(&values, a)
    }

    /// `a` as faer reads it: symmetric, so its rows are its columns.
    fn matrix<'a>(&'a self, a: &'a CsMat<f64>) -> SparseColMatRef<'a, usize, f64> {
        assert!(
            a.is_csr() && *a.proper_indptr() == self.start[..] && a.indices() == self.columns,
            "the pattern of the matrix is not the analysed one"
        );
        let n = self.start.len() - 1;
        SparseColMatRef::new(SymbolicSparseColMatRef::new_checked(n, n, &self.start, None, &self.columns), a.data())
    }

    /// Counts negative pivots in the values of L D L^T (L has a unit diagonal, D stands in its place), if they can be
    /// trusted. The computed factor belongs to A + E with |E_ij| of the order eps sqrt(g_i g_j), g_i = sum_j l_ij^2
    /// |d_j|.
    fn reliable_signs(&self, values: &[f64], a: &CsMat<f64>) -> Result<usize, UnreliablePivot> {
        let mut growth = vec![0.0; a.rows()];
        let mut negative = 0;
        for s in 0..self.panels.count() {
            let (rows, panel) = (self.panels.rows(s), self.panels.dense(s, values));
            for j in 0..self.panels.width(s) {
                let column = panel.column(j);
                let d = column[j];
                negative += usize::from(d < 0.0);
                growth[rows[j]] += d.abs();
                for (&i, l) in rows.iter().zip(column).skip(j + 1) {
                    growth[i] += l * l * d.abs();
                }
            }
        }
        for (unknown, row) in a.outer_iterator().enumerate() {
            let scale = row.data().iter().fold(0.0, |largest: f64, aij| largest.max(aij.abs()));
            let sound = growth[unknown] <= MAX_GROWTH * scale; // false for NaN
            if !sound {
                return Err(UnreliablePivot { unknown });
            }
        }
        Ok(negative)
    }
}

/// With pivots that let entries grow by this factor, eigenvalues are counted for A + E, |E| <= 1e-12 |A|.
const MAX_GROWTH: f64 = 1e4;

impl Factor {
    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.panels.unknowns()
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The first of the unknowns that [`Factor::condense`] leaves.
    pub fn border(&self) -> usize {
        self.panels.columns_of(0..self.panels.border).end
    }

    /// Number of stored entries of L, zeros inside supernodes counted.
    pub fn entries(&self) -> usize {
        self.forward.len()
    }

    /// L_cc, the last `m` rows and columns of L: S = L_cc L_cc^T is the Schur complement of the last `m` unknowns,
    /// which is what is left of A when all others are eliminated. Above its diagonal it is zero.
    ///
    /// # Panics
    /// If there are fewer than `m` unknowns.
    pub fn trailing(&self, m: usize) -> Mat<f64> {
        let first = self.len().checked_sub(m).expect("no more trailing unknowns than unknowns");
        let mut block = Mat::zeros(m, m);
        let mut values = self.backward.iter();
        for s in (0..self.panels.count()).rev() {
            let rows = self.panels.rows(s);
            if rows[0] + self.panels.width(s) <= first {
                break;
            }
            self.panels.each_backward(s, |i, j| {
                let value = *values.next().expect("the packing visits the same entries");
                if rows[j] >= first {
                    block[(rows[i] - first, rows[j] - first)] = if i == j { 1.0 / value } else { value };
                }
            });
        }
        block
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::sparse::testing::{dense, distance, grid_matrix, random};

    fn factor(a: &CsMat<f64>) -> Factor {
        Symbolic::new(a).factor(a).expect("positive definite")
    }

    fn as_nalgebra(a: &Mat<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)])
    }

    /// Round-off of a well conditioned matrix.
    #[test]
    fn solving_once_gives_what_the_packed_factor_gives() {
        let a = grid_matrix(12, 9, &[3, 40]);
        let symbolic = Symbolic::bordered(&a, a.rows() - 4);
        let (mut once, mut packed) = (random(a.rows(), 5), random(a.rows(), 5));
        symbolic.solve_once(&a, &mut once).expect("positive definite");
        symbolic.factor(&a).expect("positive definite").solve(&mut packed);
        assert!(distance(&once, &packed) < 1e-13);
        let indefinite = a.map(|v| -v);
        assert_eq!(symbolic.solve_once(&indefinite, &mut once), Err(NotPositiveDefinite { unknown: 0 }));
    }

    /// Of those bytes the packed copies are what the factor keeps; faer's own has the upper triangles of supernodes,
    /// too.
    #[test]
    fn a_factor_takes_the_bytes_that_are_told_before() {
        let a = grid_matrix(40, 30, &[]);
        let symbolic = Symbolic::new(&a);
        let Factor { forward, backward, .. } = symbolic.factor(&a).expect("positive definite");
        let kept = 8 * (forward.len() + backward.len()) + 32 * a.nnz();
        let computed = symbolic.bytes() as usize - kept;
        assert!((8 * forward.len()..16 * forward.len()).contains(&computed), "{computed} beside {}", 8 * forward.len());
    }

    /// a - sigma
    fn shifted(a: &CsMat<f64>, sigma: f64) -> CsMat<f64> {
        let diagonal: Vec<bool> = a.iter().map(|(_, (i, j))| i == j).collect();
        let mut b = a.clone();
        b.data_mut().iter_mut().zip(diagonal).filter(|(_, d)| *d).for_each(|(b, _)| *b -= sigma);
        b
    }

    #[test]
    fn l_times_its_transpose_is_the_matrix() {
        for a in [grid_matrix(1, 1, &[]), grid_matrix(7, 5, &[8, 9, 10]), grid_matrix(15, 12, &[])] {
            let l = as_nalgebra(&factor(&a).trailing(a.rows()));
            // Entries are about 10; round-off of sums of some hundred products.
            assert!((&l * l.transpose() - dense(&a)).amax() < 1e-12);
            assert!(l.upper_triangle().lower_triangle() == DMatrix::from_diagonal(&l.diagonal()));
        }
    }

    #[test]
    fn trailing_block_is_the_factor_of_the_schur_complement() {
        let last: Vec<usize> = (30..42).collect();
        let a = grid_matrix(12, 9, &last);
        let factor = factor(&a);
        let (n, full) = (a.rows(), dense(&a));
        // All m from 0 on: the border falls on supernodes and inside them.
        for m in 0..80 {
            let i = n - m;
            let a_cc = full.view((i, i), (m, m)).into_owned();
            let a_ci = full.view((i, 0), (m, i));
            let a_ii = full.view((0, 0), (i, i)).into_owned().cholesky().expect("positive definite");
            let schur = a_cc - a_ci * a_ii.solve(&a_ci.transpose());
            let l = as_nalgebra(&factor.trailing(m));
            assert!((&l * l.transpose() - schur).abs().sum() <= 1e-12 * (m * m) as f64, "last {m} unknowns");
        }
    }

    #[test]
    fn condensed_solution_is_the_full_one() {
        let a = grid_matrix(12, 9, &[30, 31, 32]);
        let b = random(a.rows(), 3);
        let mut full = b.clone();
        factor(&a).solve(&mut full);

        // All borders, so that some fall inside a supernode.
        for border in 0..a.rows() {
            let m = a.rows() - border;
            let factor = Symbolic::bordered(&a, border).factor(&a).expect("positive definite");
            let l = as_nalgebra(&factor.trailing(m));
            let mut x = b.clone();
            factor.condense(&mut x);
            let x_c = nalgebra::DVector::from_column_slice(&x[border..]);
            let solution = (&l * l.transpose()).lu().solve(&x_c).expect("regular");
            x[border..].copy_from_slice(solution.as_slice());
            factor.expand(&mut x);
            // Round-off of some hundred unknowns, the largest of which are about 1.
            assert!(distance(&x, &full) < 1e-13, "border {border}");
        }
    }

    #[test]
    fn negative_pivots_count_the_eigenvalues_below_a_shift() {
        let a = grid_matrix(8, 6, &[]);
        let symbolic = Symbolic::new(&a);
        let eigenvalues = dense(&a).symmetric_eigenvalues();
        let mut reliable = 0;
        for k in 0..60 {
            let sigma = 0.9 + 0.5 * k as f64;
            let below = eigenvalues.iter().filter(|l| **l < sigma).count();
            if let Ok(count) = symbolic.negative_pivots(&shifted(&a, sigma)) {
                assert_eq!(count, below, "below {sigma}");
                reliable += 1;
            }
        }
        assert!(reliable >= 55, "{reliable} of 60 shifts");
    }

    #[test]
    fn the_unknown_without_a_positive_pivot_is_named() {
        let a = grid_matrix(9, 7, &[]);
        let symbolic = Symbolic::new(&a);
        for unknown in [0, 1, 37, 100, a.rows() - 1] {
            for pivot in [-1.0, f64::NAN] {
                let mut bad = a.clone();
                *bad.get_mut(unknown, unknown).expect("the diagonal is stored") = pivot;
                assert_eq!(symbolic.factor(&bad).err(), Some(NotPositiveDefinite { unknown }));
            }
        }
    }

    #[test]
    fn zero_pivots_and_not_a_number_make_the_count_unreliable() {
        let a = grid_matrix(3, 2, &[]);
        let symbolic = Symbolic::new(&a);
        for first in [0.0, 1e-9, f64::NAN] {
            let mut bad = a.clone();
            *bad.get_mut(0, 0).expect("the diagonal is stored") = first;
            assert!(symbolic.negative_pivots(&bad).is_err(), "a_00 = {first}");
        }
    }

    #[test]
    fn nothing_and_one_unknown_can_be_solved() {
        let empty = CsMat::zero((0, 0));
        factor(&empty).solve(&mut []);
        assert_eq!(factor(&empty).trailing(0).nrows(), 0);
        let one = CsMat::new((1, 1), vec![0, 1], vec![0], vec![4.0]);
        let mut x = [2.0];
        factor(&one).solve(&mut x);
        assert_eq!((x, factor(&one).trailing(1)[(0, 0)]), ([0.5], 2.0));
    }
}
