//! The fixed point on Tresca's bound, for contact problems in which Newton's statuses run in a circle.

use super::contact::{Contact, Problem};
use super::inverse::dense_times;
use super::joints::Joints;
use crate::physics::joint::Response;
use crate::sparse::vector::{distance, dot, norm, ratio};
use faer::Mat;
use faer::linalg::solvers::{PartialPivLu, Solve};

/// Relative imbalance that the sweeps' round-off may leave in b, where stiff closed joints make S of small differences.
pub(super) const SWEEPS: f64 = 1e-9;

/// A residual that is more than this of the one before falls too slowly.
const SLOW: f64 = 0.9;

/// Least share of the way to f p that the bounds go.
const LEAST_SHARE: f64 = 1. / 16.;

/// S j + r(j) = b, what is left of the equations when all but the jumps is eliminated.
struct JumpEquations<'a> {
    joints: &'a Joints<'a>,
    schur: Mat<f64>,
    b: Vec<f64>,
    /// of the run so far [N]
    largest_force: f64,
}

/// A fixed point: no statuses that agree with the jumps to the last digit, but jumps that meet the tolerance.
#[derive(Debug, Clone)]
pub struct FixedPoint {
    pub jumps: Vec<f64>,
    pub iterations: usize,
    /// the paper's test (19)
    pub displacement_test: f64,
}

impl Contact {
    /// Outer loop on the bound f p; the inner problem with a fixed bound is convex and always solved. With much friction
    /// the bounds swing to and fro: where the residual hardly falls they go half as far as before.
    pub(super) fn fixed_point(&self, problem: &Problem) -> Option<FixedPoint> {
        let equations = self.equations(problem);
        let mut jumps = problem.last.to_vec();
        let mut bounds = problem.joints.bounds(&jumps);
        let (mut share, mut left_before) = (1., f64::INFINITY);
        for iterations in 1..=10 * self.options.max_iterations {
            let next = self.minimise(&equations, &jumps, &bounds)?;
            let correction = distance(&next, &jumps);
            jumps = next;
            let left = equations.residual(&jumps, None).relative();
            if left <= self.options.tolerance {
                let displacement_test = ratio(correction, distance(&jumps, problem.last));
                return Some(FixedPoint { jumps, iterations, displacement_test });
            }
            if left > SLOW * left_before {
                share = f64::max(share / 2., LEAST_SHARE);
            }
            left_before = left;
            let next = problem.joints.bounds(&jumps);
            bounds.iter_mut().zip(next).for_each(|(bound, next)| *bound += share * (next - *bound));
        }
        None
    }

    fn equations<'a>(&self, problem: &'a Problem) -> JumpEquations<'a> {
        let mut schur = self.condensate.schur.clone();
        let b = self.condensate.forces(problem.free);
        let interface = problem.joints.interface;
        for (number, point) in interface.points.iter().enumerate() {
            interface.tangent(point, &self.reference(number), |i, j, value| schur[(i, j)] -= value);
        }
        JumpEquations { joints: problem.joints, schur, b, largest_force: problem.largest_force }
    }

    /// Minimises 1/2 j'S j - b'j + sum area psi(j), convex and piecewise quadratic for fixed bounds: Newton with an
    /// exact line search, also beyond the full step: along what slips freely the tangent has nothing but the
    /// springs of least motion, which say the direction and not the length.
    fn minimise(&self, equations: &JumpEquations, start: &[f64], bounds: &[f64]) -> Option<Vec<f64>> {
        let mut jumps = start.to_vec();
        let mut before = f64::INFINITY;
        for _ in 0..10 * self.options.max_iterations {
            let residual = equations.residual(&jumps, Some(bounds));
            let relative = residual.relative();
            let at_round_off = relative <= self.options.tolerance && relative >= before / 2.;
            if relative <= self.options.tolerance / 10. || at_round_off {
                return Some(jumps);
            }
            before = relative;
            let step = solve_dense(&equations.tangent(&residual.responses).partial_piv_lu(), residual.force);
            let moved = |alpha: f64| -> Vec<f64> { jumps.iter().zip(&step).map(|(j, d)| j - alpha * d).collect() };
            let slope = |alpha: f64| -dot(&equations.residual(&moved(alpha), Some(bounds)).force, &step);
            match crossing(slope) {
                Some(alpha) => jumps = moved(alpha),
                // Nothing resists, as the rotation of a round body with bounds of 0: the imbalance is the sweeps' round-off.
                None => return (relative < SWEEPS).then_some(jumps),
            }
        }
        None
    }
}

struct Residual {
    responses: Vec<Response>,
    /// S j + r - b [N]
    force: Vec<f64>,
    /// what it is measured against, max(|b|, |S j|, |r|) or the largest force so far [N]
    scale: f64,
}

impl Residual {
    fn relative(&self) -> f64 {
        ratio(norm(&self.force), self.scale)
    }
}

impl JumpEquations<'_> {
    fn residual(&self, jumps: &[f64], bounds: Option<&[f64]>) -> Residual {
        let responses = self.joints.respond(jumps, bounds);
        let joint = self.joints.interface.forces(responses.iter().map(|r| r.traction));
        let linear = dense_times(&self.schur, jumps);
        let force = (0..jumps.len()).map(|i| linear[i] + joint[i] - self.b[i]).collect();
        let scale = norm(&self.b).max(norm(&linear)).max(norm(&joint)).max(self.largest_force);
        Residual { responses, force, scale }
    }

    fn tangent(&self, responses: &[Response]) -> Mat<f64> {
        let mut tangent = self.schur.clone();
        for (point, r) in self.joints.interface.points.iter().zip(responses) {
            self.joints.interface.tangent(point, &r.tangent, |i, j, value| tangent[(i, j)] += value);
        }
        tangent
    }
}

fn solve_dense(lu: &PartialPivLu<f64>, force: Vec<f64>) -> Vec<f64> {
    let mut x = force;
    let rows = x.len();
    lu.solve_in_place(faer::MatMut::from_column_major_slice_mut(&mut x, rows, 1));
    x
}

/// Where a slope that is negative at 0 and never falls goes through zero; 1 where most of it is gone there, none where
/// it stays.
fn crossing(slope: impl Fn(f64) -> f64) -> Option<f64> {
    let (mut low, mut high) = (0., 1.);
    let (start, end) = (slope(0.), slope(1.));
    if end <= 0. {
        if end >= start / 2. {
            return Some(1.);
        }
        let past = (1..60).map(|k| f64::powi(2., k)).find(|&alpha| slope(alpha) > 0.);
        high = past?;
        low = high / 2.;
    }
    for _ in 0..50 {
        let middle = (low + high) / 2.;
        if slope(middle) > 0. { high = middle } else { low = middle }
    }
    Some((low + high) / 2.)
}
