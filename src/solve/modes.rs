//! Natural frequencies with the interfaces closed and sticking, and Rayleigh's alpha and beta from two of them.

use super::system::{Rayleigh, System, combine};
use crate::sparse::{Symbolic, UnreliablePivot, smallest_modes};
use crate::{Error, Result};
use sprs::CsMat;
use std::f64::consts::PI;

/// A natural mode: K phi = omega^2 M phi, phi'M phi = 1.
#[derive(Debug, Clone, PartialEq)]
pub struct NaturalMode {
    /// [Hz]
    pub frequency: f64,
    /// shape over the unknowns, then the jumps [1/sqrt(kg)]
    pub shape: Vec<f64>,
}

/// The lowest `count` modes, in rising order.
///
/// None is skipped: those below sigma, just below the last one, are counted by the negative pivots of K - sigma M
/// (Sylvester). Where pivots vanish sigma lies up to 10 % below the last, and the count says nothing of those between.
pub fn natural_modes(system: &System, symbolic: &Symbolic, count: usize) -> Result<Vec<NaturalMode>> {
    let stiffness = system.with_joints(&system.closed_joints());
    let shift = rigid_shift(&stiffness, &system.mass);
    let factor = symbolic
        .factor(&combine(&[(1., &stiffness), (shift, &system.mass)]))
        .map_err(|e| Error::input(format!("the stiffness matrix is not positive definite at unknown {}", e.unknown)))?;
    let below = |sigma: f64| symbolic.negative_pivots(&combine(&[(1., &stiffness), (-sigma, &system.mass)]));
    let mut complete = false;
    let modes = smallest_modes(&factor, shift, &system.mass, count, |lambdas| {
        complete = are_complete(below, lambdas, shift);
        complete
    })?;
    drop(factor);
    if !complete {
        refuse_gaps(below, &modes.iter().map(|m| m.lambda).collect::<Vec<_>>(), shift)?;
    }
    // Below that an eigenvalue is the round-off of a rigid motion's zero.
    let frequency = |lambda: f64| if lambda < 1e-3 * shift { 0. } else { lambda.sqrt() / (2. * PI) };
    let shape = |of_unknowns: &[f64]| system.unknowns.vector(|i| of_unknowns[i]);
    Ok(modes.into_iter().map(|m| NaturalMode { frequency: frequency(m.lambda), shape: shape(&m.shape) }).collect())
}

/// How many eigenvalues lie below sigma, of which `lambdas` are some.
type Below = std::result::Result<usize, UnreliablePivot>;

/// Whether none is missing but perhaps a second one within [`NEAREST`] of the last; false if that cannot be told.
fn are_complete(below: impl Fn(f64) -> Below, lambdas: &[f64], shift: f64) -> bool {
    let Some(&last) = lambdas.last().filter(|&&l| l > shift) else { return false };
    let sigma = last * (1. - NEAREST);
    below(sigma).is_ok_and(|count| count == found_below(lambdas, sigma))
}

fn found_below(lambdas: &[f64], sigma: f64) -> usize {
    lambdas.iter().filter(|&&l| l < sigma).count()
}

/// Compares the found eigenvalues below the last one with their true number, the negative pivots of K - sigma M.
fn refuse_gaps(below: impl Fn(f64) -> Below, lambdas: &[f64], shift: f64) -> Result<()> {
    let Some(&last) = lambdas.last().filter(|&&l| l > shift) else { return Ok(()) };
    // sigma just below the last eigenvalue. Pivots vanish where a part that is eliminated early has the eigenvalue too, as
    // half of a free column has, held in the middle; and in a slender body round-off may move the last one itself below
    // sigma. In both cases sigma goes further below.
    let mut mismatch = None;
    for distance in [NEAREST, 5e-8, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 3e-2, 1e-1] {
        if distance > ROUND_OFF && mismatch.is_some() {
            break;
        }
        let sigma = last * (1. - distance);
        if let Ok(count) = below(sigma) {
            let found = found_below(lambdas, sigma);
            if count == found {
                return Ok(());
            }
            mismatch = Some(format!(
                "{count} natural modes lie below {:.6} Hz, but {found} were found",
                last.sqrt() / (2. * PI)
            ));
        }
    }
    let uncounted = "the number of natural modes could not be counted: every shift meets a zero pivot";
    Err(Error::NoConvergence(mismatch.unwrap_or_else(|| uncounted.into())))
}

/// Distance of sigma from the last eigenvalue, relative to it, where it is taken first.
const NEAREST: f64 = 1e-8;

/// Share of an eigenvalue that round-off may take from it: 1e-16 times the ratio of K's largest to it, for slender
/// bodies.
const ROUND_OFF: f64 = 1e-5;

/// Parts that nothing holds move at 0 Hz; this shift [1/s^2] far below the mesh's own frequencies keeps K definite.
fn rigid_shift(stiffness: &CsMat<f64>, mass: &CsMat<f64>) -> f64 {
    let trace = |a: &CsMat<f64>| a.diag().data().iter().sum::<f64>();
    1e-9 * trace(stiffness) / trace(mass)
}

/// alpha and beta that give modes of the frequencies f_1, f_2 [Hz] the damping ratio xi:
/// beta = 2 xi / (omega_1 + omega_2), alpha = omega_1 omega_2 beta.
pub fn rayleigh(ratio: f64, [f_1, f_2]: [f64; 2]) -> Rayleigh {
    let (omega_1, omega_2) = (2. * PI * f_1, 2. * PI * f_2);
    let beta = 2. * ratio / (omega_1 + omega_2);
    Rayleigh { alpha: omega_1 * omega_2 * beta, beta }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// xi = 5 % at 5 and 15 Hz, to the digits of the textbook's result.
    #[test]
    fn rayleigh_damping_has_its_ratio_at_both_frequencies() {
        let Rayleigh { alpha, beta } = rayleigh(0.05, [5., 15.]);
        assert!((alpha - 2.356194).abs() < 5e-7 && (beta - 7.957747e-4).abs() < 5e-11);
        let xi = |f: f64| alpha / (4. * PI * f) + beta * PI * f;
        assert!((xi(5.) - 0.05).abs() < 1e-15 && (xi(15.) - 0.05).abs() < 1e-15);
        assert!((xi(50.) - 0.129).abs() < 5e-4);
    }
}
