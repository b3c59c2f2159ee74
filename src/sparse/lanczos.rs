//! Lowest eigenpairs of K phi = lambda M phi: Lanczos on (K + shift M)^-1 M, whose eigenvalues are
//! theta = 1 / (lambda + shift), in the M inner product.

use faer::{Mat, Side};
use sprs::CsMat;

use super::vector::{add, dot};
use super::{Factor, multiply};
use crate::{Error, Result};

/// An eigenpair of K phi = lambda M phi.
#[derive(Debug, Clone)]
pub struct Mode {
    pub lambda: f64,
    /// phi, with phi^T M phi = 1 and its largest component positive.
    pub shape: Vec<f64>,
}

/// Error of lambda, relative to it, that the residual of a converged pair allows.
const TOLERANCE: f64 = 1e-10;
/// An eigenvalue is known to this part of the shift at best: rigid bodies have lambda = 0.
const FLOOR: f64 = 1e-3;
/// A vector that shrinks to this part of the largest theta when made orthogonal is round-off.
const ROUND_OFF: f64 = 1e-13;
/// Largest residual of a mode, relative to theta, when taken once more at the end; 1e-10 or less in sound arithmetic.
const SANITY: f64 = 1e-6;
const RESTARTS: usize = 20;

/// The `count` lowest eigenpairs of K phi = lambda M phi, ascending; fewer if there are fewer unknowns.
/// `factor` is that of K + shift M, and M is positive definite.
///
/// One Krylov space holds one vector of a multiple eigenvalue only. Further ones are searched in the complement of all
/// that was found, from another start, until nothing below the last wanted eigenvalue turns up there; unless
/// `are_lowest` knows of the eigenvalues found that none below the last one is missing.
///
/// # Errors
/// If the pairs do not converge: M is not positive definite, or K + shift M almost singular.
///
/// # Panics
/// If `m` and `factor` differ in size.
pub fn smallest_modes(
    factor: &Factor,
    shift: f64,
    m: &CsMat<f64>,
    count: usize,
    mut are_lowest: impl FnMut(&[f64]) -> bool,
) -> Result<Vec<Mode>> {
    assert_eq!(factor.len(), m.rows(), "unknowns of the factor and of M");
    let pencil = Pencil { factor, shift, m };
    let count = count.min(m.rows());
    let mut found: Vec<Mode> = Vec::new();
    while count > 0 && found.len() < m.rows() {
        let last = found.get(count - 1).map(|mode| mode.lambda);
        let wanted = count.saturating_sub(found.len()).max(1);
        let new = pencil.lowest_in_complement(&found, wanted)?;
        let nothing_below = last.is_some_and(|l| new[0].lambda >= l - TOLERANCE * pencil.scale(l));
        found.extend(new);
        found.sort_by(|a, b| a.lambda.total_cmp(&b.lambda));
        let lambdas: Vec<f64> = found.iter().map(|mode| mode.lambda).collect();
        if nothing_below || lambdas.get(..count).is_some_and(&mut are_lowest) {
            break;
        }
    }
    found.truncate(count);
    Ok(found)
}

struct Pencil<'a> {
    factor: &'a Factor,
    shift: f64,
    m: &'a CsMat<f64>,
}

impl Pencil<'_> {
    /// What an error of lambda is compared with.
    fn scale(&self, lambda: f64) -> f64 {
        lambda.abs().max(FLOOR * self.shift.abs())
    }

    fn lambda(&self, theta: f64) -> f64 {
        1.0 / theta - self.shift
    }

    /// (K + shift M)^-1 M x.
    fn apply(&self, x: &[f64]) -> Vec<f64> {
        let mut y = self.mass_times(x);
        self.factor.solve(&mut y);
        y
    }

    fn mass_times(&self, x: &[f64]) -> Vec<f64> {
        multiply(self.m, x)
    }

    /// sqrt(x^T M x).
    fn norm(&self, x: &[f64]) -> f64 {
        dot(x, &self.mass_times(x)).sqrt()
    }

    /// At least one and at most `wanted` of the lowest eigenpairs that are M-orthogonal to `known`.
    fn lowest_in_complement(&self, known: &[Mode], wanted: usize) -> Result<Vec<Mode>> {
        let mut start = self.apply(&pseudo_random(self.m.rows(), known.len()));
        for _ in 0..RESTARTS {
            let space = self.krylov(known, start, wanted)?;
            if space.settled > 0 {
                return space.ritz.into_iter().take(space.settled).map(|pair| self.mode(pair)).collect();
            }
            start = vec![0.0; self.m.rows()];
            space.ritz.iter().for_each(|(_, shape)| add(&mut start, 1.0, shape));
        }
        Err(no_convergence("after all restarts, the residual is still too large"))
    }

    /// Spans the Krylov space of `start` in the complement of `known` until its `wanted` first pairs have converged,
    /// it has become invariant, or it is long enough to restart.
    fn krylov(&self, known: &[Mode], mut start: Vec<f64>, wanted: usize) -> Result<Krylov> {
        let dimension = self.m.rows() - known.len();
        let longest = dimension.min(3 * wanted + 60);
        self.orthogonalise(&mut start, known, &[]);
        let mut mass_times_start = self.mass_times(&start);
        let mut beta = dot(&start, &mass_times_start).sqrt();
        let (mut basis, mut diagonal, mut below) = (Vec::new(), Vec::new(), Vec::new());
        loop {
            if !(beta > 0.0 && beta.is_finite()) {
                return Err(no_convergence("a vector has no length in the inner product of M"));
            }
            start.iter_mut().chain(&mut mass_times_start).for_each(|x| *x /= beta);
            basis.push(start);
            start = mass_times_start;
            self.factor.solve(&mut start);
            diagonal.push(self.orthogonalise(&mut start, known, &basis));
            mass_times_start = self.mass_times(&start);
            beta = dot(&start, &mass_times_start).sqrt();
            below.push(beta);

            let length = basis.len();
            let invariant = length == dimension || beta <= ROUND_OFF * diagonal[0].abs();
            if invariant || length == longest || length % 5 == 0 {
                let pairs = tridiagonal_pairs(&diagonal, &below)?;
                let converged = pairs.iter().take(wanted).take_while(|pair| self.has_converged(pair)).count();
                let settled = if invariant { converged.max(1) } else { converged };
                if invariant || length == longest || converged == wanted {
                    let ritz = pairs.iter().take(wanted).map(|pair| (pair.theta, combine(&basis, &pair.vector)));
                    return Ok(Krylov { settled, ritz: ritz.collect() });
                }
            }
        }
    }

    /// |d lambda| = |d theta| / theta^2, and |d theta| is at most the residual.
    fn has_converged(&self, pair: &Pair) -> bool {
        pair.residual <= TOLERANCE * self.scale(self.lambda(pair.theta)) * pair.theta * pair.theta
    }

    /// Takes from `x` its part in the span of `known` and `basis`, twice is enough (Kahan, Parlett); returns its
    /// component along the last vector of `basis`.
    fn orthogonalise(&self, x: &mut [f64], known: &[Mode], basis: &[Vec<f64>]) -> f64 {
        let mut along_last = 0.0;
        for _ in 0..2 {
            let mx = self.mass_times(x);
            for q in known.iter().map(|mode| &mode.shape).chain(basis) {
                add(x, -dot(q, &mx), q);
            }
            along_last += basis.last().map_or(0.0, |q| dot(q, &mx));
        }
        along_last
    }

    /// Normalises a Ritz vector and takes its residual |(K + shift M)^-1 M phi - theta phi| / theta once more.
    fn mode(&self, (theta, mut shape): (f64, Vec<f64>)) -> Result<Mode> {
        let norm = self.norm(&shape).copysign(sign_of_largest(&shape));
        shape.iter_mut().for_each(|x| *x /= norm);
        let mut residual = self.apply(&shape);
        add(&mut residual, -theta, &shape);
        let sound = self.norm(&residual) <= SANITY * theta; // false for NaN
        if !sound {
            return Err(no_convergence("the residual of a computed mode is not small"));
        }
        Ok(Mode { lambda: self.lambda(theta), shape })
    }
}

/// What a Krylov space knows about the lowest eigenpairs: (theta, phi), theta descending.
struct Krylov {
    /// How many of the first pairs need no restart.
    settled: usize,
    ritz: Vec<(f64, Vec<f64>)>,
}

/// Eigenpair of the tridiagonal matrix, and the residual of the Ritz pair it stands for.
struct Pair {
    theta: f64,
    vector: Vec<f64>,
    residual: f64,
}

/// Eigenpairs of the symmetric tridiagonal matrix, theta descending. The last entry of `below` leads out of the space:
/// the residual is this entry times the last component.
fn tridiagonal_pairs(diagonal: &[f64], below: &[f64]) -> Result<Vec<Pair>> {
    let n = diagonal.len();
    let t = Mat::from_fn(n, n, |i, j| match i.abs_diff(j) {
        0 => diagonal[i],
        1 => below[i.min(j)],
        _ => 0.0,
    });
    let eigen = t.self_adjoint_eigen(Side::Lower).map_err(|_| no_convergence("a small matrix has no eigenvalues"))?;
    let pair = |k: usize| {
        let vector: Vec<f64> = eigen.U().col(k).iter().copied().collect();
        let residual = below[n - 1] * vector[n - 1].abs();
        Pair { theta: eigen.S()[k], vector, residual }
    };
    Ok((0..n).rev().map(pair).collect())
}

fn no_convergence(reason: &str) -> Error {
    Error::NoConvergence(format!(
        "the natural frequencies could not be computed: {reason}; check that the stiffness is positive and every \
         part has mass"
    ))
}

/// Numbers in -1..1, the same at every run (splitmix64), different for each `seed`.
pub(super) fn pseudo_random(n: usize, seed: usize) -> Vec<f64> {
    let mut state = seed as u64;
    let mut next = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    (0..n).map(|_| next()).collect()
}

/// Sign of the largest component; of several that are equal to round-off, of the first.
fn sign_of_largest(x: &[f64]) -> f64 {
    let largest = x.iter().fold(0.0, |l: f64, x| l.max(x.abs()));
    x.iter().find(|x| x.abs() >= (1.0 - 1e-6) * largest).map_or(1.0, |x| x.signum())
}

fn combine(basis: &[Vec<f64>], weights: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; basis[0].len()];
    basis.iter().zip(weights).for_each(|(q, &weight)| add(&mut sum, weight, q));
    sum
}

#[cfg(test)]
mod tests {
    use nalgebra::{Cholesky, DMatrix};
    use sprs::TriMat;

    use super::*;
    use crate::sparse::Symbolic;
    use crate::sparse::testing::{dense, grid_matrix};

    /// Diagonal mass between 0.5 and 1.5, on the pattern of `k`.
    fn lumped_mass(k: &CsMat<f64>) -> CsMat<f64> {
        let random = pseudo_random(k.rows(), 99);
        let mut m = k.clone();
        let row_of: Vec<usize> = k.iter().map(|(_, (i, _))| i).collect();
        let column_of = k.indices();
        for (e, value) in m.data_mut().iter_mut().enumerate() {
            *value = if row_of[e] == column_of[e] { 1.0 + 0.5 * random[row_of[e]] } else { 0.0 };
        }
        m
    }

    /// All lambda of K phi = lambda M phi, ascending, by dense algebra.
    fn dense_lambdas(k: &CsMat<f64>, m: &CsMat<f64>) -> Vec<f64> {
        let l = Cholesky::new(dense(m)).expect("M is positive definite").l();
        let inverse: DMatrix<f64> = l.try_inverse().expect("M is positive definite");
        let mut lambdas: Vec<f64> =
            (&inverse * dense(k) * inverse.transpose()).symmetric_eigen().eigenvalues.iter().copied().collect();
        lambdas.sort_by(f64::total_cmp);
        lambdas
    }

    /// [[a, 0], [0, factor a]]
    fn twice(a: &CsMat<f64>, factor: f64) -> CsMat<f64> {
        let n = a.rows();
        let mut both = TriMat::new((2 * n, 2 * n));
        for (&aij, (i, j)) in a.iter() {
            both.add_triplet(i, j, aij);
            both.add_triplet(n + i, n + j, factor * aij);
        }
        both.to_csr()
    }

    /// Compares the `count` lowest modes with `lambdas`, and checks phi^T M phi = 1 and the residual of each.
    fn check(k: &CsMat<f64>, m: &CsMat<f64>, shift: f64, count: usize, lambdas: &[f64]) {
        let mut shifted = k.clone();
        shifted.data_mut().iter_mut().zip(m.data()).for_each(|(k, m)| *k += shift * m);
        let factor = Symbolic::new(k).factor(&shifted).expect("positive definite");
        let modes = smallest_modes(&factor, shift, m, count, |_| false).expect("converges");
        assert_eq!(modes.len(), count.min(k.rows()));
        for (i, (mode, &lambda)) in modes.iter().zip(lambdas).enumerate() {
            // The promised 1e-10, and the round-off of the dense eigenvalues.
            let error = (mode.lambda - lambda).abs();
            assert!(error < 2e-10 * lambda.abs().max(FLOOR * shift), "lambda {i}: {} for {lambda}", mode.lambda);
            for (j, other) in modes.iter().enumerate() {
                let phi_m_phi = dot(&mode.shape, &multiply(m, &other.shape));
                let exact = if i == j { 1.0 } else { 0.0 };
                // Vectors of near eigenvalues 1e-6 apart are known to 1e-10 / 1e-6.
                assert!((phi_m_phi - exact).abs() < 1e-4, "phi_{i}^T M phi_{j} = {phi_m_phi}");
            }
            let mut product = multiply(m, &mode.shape);
            product.iter_mut().for_each(|x| *x *= -(mode.lambda + shift));
            add(&mut product, 1.0, &multiply(&shifted, &mode.shape));
            // K is 1e3 times lambda at most here, M about 1.
            assert!(dot(&product, &product).sqrt() < 1e-6, "K phi - lambda M phi of mode {i}");
        }
    }

    #[test]
    fn lowest_modes_are_those_of_dense_algebra() {
        let k = grid_matrix(9, 6, &[3, 4]);
        let m = lumped_mass(&k);
        let lambdas = dense_lambdas(&k, &m);
        for (shift, count) in [(0.0, 1), (0.0, 2), (0.0, 12), (2.5, 6), (0.0, 0)] {
            check(&k, &m, shift, count, &lambdas);
        }
    }

    #[test]
    fn exactly_double_eigenvalues_are_both_found() {
        let k = grid_matrix(7, 5, &[]);
        let m = lumped_mass(&k);
        let (k, m) = (twice(&k, 1.0), twice(&m, 1.0));
        let lambdas = dense_lambdas(&k, &m);
        (1..=7).for_each(|count| check(&k, &m, 0.0, count, &lambdas));
    }

    #[test]
    fn pairs_a_millionth_apart_are_both_found() {
        let k = grid_matrix(7, 5, &[]);
        let m = lumped_mass(&k);
        let once = dense_lambdas(&k, &m);
        let (k, m) = (twice(&k, 1.0 + 1e-6), twice(&m, 1.0));
        let lambdas: Vec<f64> = once.iter().flat_map(|l| [*l, l * (1.0 + 1e-6)]).collect();
        (1..=6).for_each(|count| check(&k, &m, 0.0, count, &lambdas));
    }

    #[test]
    fn an_eigenvalue_of_any_multiplicity_is_found_as_often() {
        let lambdas = [1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 3.0];
        let mut k = TriMat::new((7, 7));
        lambdas.iter().enumerate().for_each(|(i, &lambda)| k.add_triplet(i, i, lambda));
        let k: CsMat<f64> = k.to_csr();
        let mut m = k.clone();
        m.data_mut().fill(1.0);
        (1..=8).for_each(|count| check(&k, &m, 0.0, count, &lambdas));
    }

    #[test]
    fn further_vectors_of_an_eigenvalue_are_searched_unless_none_is_known_to_be_missing() {
        let mut k = TriMat::new((5, 5));
        [1.0, 1.0, 2.0, 3.0, 4.0].iter().enumerate().for_each(|(i, &lambda)| k.add_triplet(i, i, lambda));
        let k: CsMat<f64> = k.to_csr();
        let mut m = k.clone();
        m.data_mut().fill(1.0);
        let factor = Symbolic::new(&k).factor(&k).expect("positive definite");
        let lambdas = |known: bool| -> Vec<f64> {
            let modes = smallest_modes(&factor, 0.0, &m, 3, |_| known).expect("converges");
            modes.iter().map(|mode| (mode.lambda * 1e6).round() / 1e6).collect()
        };
        assert_eq!((lambdas(true), lambdas(false)), (vec![1.0, 2.0, 3.0], vec![1.0, 1.0, 2.0]));
    }

    /// A chain of n equal masses and springs, free at both ends: lambda_j = 4 sin^2(pi j / 2n), rigid motion included.
    #[test]
    fn free_chain_has_its_rigid_motion_with_a_shift() {
        let n = 60;
        let mut k = TriMat::new((n, n));
        for i in 0..n - 1 {
            for (a, b, value) in [(i, i, 1.0), (i + 1, i + 1, 1.0), (i, i + 1, -1.0), (i + 1, i, -1.0)] {
                k.add_triplet(a, b, value);
            }
        }
        let k: CsMat<f64> = k.to_csr();
        let mut m = k.clone();
        m.data_mut().iter_mut().for_each(|value| *value = if *value > 0.0 { 1.0 } else { 0.0 });
        let lambdas: Vec<f64> =
            (0..n).map(|j| 4.0 * (std::f64::consts::PI * j as f64 / (2 * n) as f64).sin().powi(2)).collect();
        check(&k, &m, 0.01, 5, &lambdas);
    }

    #[test]
    fn a_mass_that_is_not_a_number_is_an_error_not_a_panic() {
        let k = grid_matrix(4, 3, &[]);
        let factor = Symbolic::new(&k).factor(&k).expect("positive definite");
        let mut m = lumped_mass(&k);
        m.data_mut().iter_mut().for_each(|value| *value *= f64::NAN);
        assert!(matches!(smallest_modes(&factor, 0.0, &m, 2, |_| false), Err(Error::NoConvergence(_))));
    }
}
