//! The fixed point on Tresca's bound, for contact problems in which Newton's statuses run in a circle.

use super::contact::{Contact, Problem, Solution, distance, ratio};
use crate::physics::joint::Response;
use crate::sparse::vector::dot;
use faer::Mat;
use faer::linalg::solvers::{PartialPivLu, Solve};

/// Relative imbalance that the sweeps' round-off may leave in b, where stiff closed joints make S of small differences.
const SWEEPS: f64 = 1e-9;

impl Contact {
    /// Outer loop on the bound f p; the inner problem with a fixed bound is convex and always solved.
    pub(super) fn fixed_point(&self, problem: &Problem, guess: &[f64]) -> Option<Solution> {
        let mut jumps = guess.to_vec();
        let mut bounds = problem.bounds(&jumps);
        for iterations in 1..=10 * self.options.max_iterations {
            let next = self.minimise(problem, &jumps, &bounds)?;
            let correction = distance(&next, &jumps);
            jumps = next;
            let responses = problem.respond(&jumps, None);
            if self.residual(problem, &jumps, &responses).relative() <= self.options.tolerance {
                let displacement_test = ratio(correction, distance(&jumps, guess));
                return Some(Solution { jumps, responses, iterations, displacement_test });
            }
            bounds = problem.bounds(&jumps);
        }
        None
    }

    /// Minimises 1/2 j'S j - b'j + sum area psi(j), convex and piecewise quadratic for fixed bounds: Newton with an exact
    /// line search, also beyond the full step: along what slips freely the tangent has nothing but its stabilisation, which
    /// says the direction and not the length.
    fn minimise(&self, problem: &Problem, start: &[f64], bounds: &[f64]) -> Option<Vec<f64>> {
        let mut jumps = start.to_vec();
        for _ in 0..10 * self.options.max_iterations {
            let responses = problem.respond(&jumps, Some(bounds));
            let residual = self.residual(problem, &jumps, &responses);
            let relative = residual.relative();
            if relative <= self.options.tolerance / 10. {
                return Some(jumps);
            }
            let step = solve_dense(&self.tangent(problem, &responses).partial_piv_lu(), residual.force);
            let moved = |alpha: f64| -> Vec<f64> { jumps.iter().zip(&step).map(|(j, d)| j - alpha * d).collect() };
            let slope = |alpha: f64| {
                let j = moved(alpha);
                -dot(&self.residual(problem, &j, &problem.respond(&j, Some(bounds))).force, &step)
            };
            match crossing(slope) {
                Some(alpha) => jumps = moved(alpha),
                // Nothing resists, as the rotation of a round body with bounds of 0: the imbalance is the sweeps' round-off.
                None => return (relative < SWEEPS).then_some(jumps),
            }
        }
        None
    }

    fn tangent(&self, problem: &Problem, responses: &[Response]) -> Mat<f64> {
        let mut tangent = Mat::clone(&self.schur);
        for (point, d) in problem.interface.points.iter().zip(self.tangents(problem, responses)) {
            problem.interface.tangent(point, &d, |i, j, value| tangent[(i, j)] += value);
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

/// Where a slope that is negative at 0 and never falls goes through zero; 1 where most of it is gone there, none where it
/// stays.
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
