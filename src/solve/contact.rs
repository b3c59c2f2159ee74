//! Newton's method on the jumps: S j + r(j) = b, S the Schur complement of everything linear, r the joint forces.
//!
//! r is piecewise linear, so the tangent depends on the statuses alone and is factored only when one changes.

use super::interface::{Interface, JointPoint, JointState};
use super::newmark::Constants;
use crate::model::case::Newton;
use crate::physics::joint::{Friction, JointLaw, Response, Status};
use crate::sparse::vector::{dot, norm};
use faer::Mat;
use faer::linalg::solvers::{PartialPivLu, Solve};
use nalgebra::{Matrix2, Vector2};

/// Relative residual below which a status may still flip: round-off decides it, and it carries no force.
const ROUND_OFF: f64 = 1e-13;

/// Damping of the joints, C(U) of eq. (16): beta times the stiffness of what was closed acts on the jump's rate.
#[derive(Debug, Clone)]
pub struct JointDamping {
    pub beta: f64,
    pub constants: Constants,
    /// -a1 j - a4 j' - a5 j'' of the last state: the rate is a1 j(new) plus this
    pub rate_offset: Vec<f64>,
}

/// One step's contact problem.
pub struct Problem<'a> {
    pub interface: &'a Interface,
    pub right_hand_side: &'a [f64],
    pub old: &'a [JointState],
    pub damping: Option<JointDamping>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    pub jumps: Vec<f64>,
    pub responses: Vec<Response>,
    pub iterations: usize,
    /// the paper's test (19) on the jumps: last correction over the step's increment
    pub displacement_test: f64,
}

/// No statuses were found that agree with their jumps; the joint points that kept changing.
#[derive(Debug, Clone, PartialEq)]
pub struct Unsettled {
    pub points: Vec<usize>,
}

pub struct Contact {
    schur: Mat<f64>,
    /// the tolerance is on |S j + r - b| / max(|b|, |S j|, |r|)
    options: Newton,
    /// part of the closed stiffness that every tangent keeps, so that what slips freely has one
    stabilisation: f64,
    factored: Option<(Vec<Status>, PartialPivLu<f64>)>,
}

impl Contact {
    pub fn new(schur: Mat<f64>, options: Newton) -> Self {
        Contact { schur, options, stabilisation: 0., factored: None }
    }

    /// For equilibrium without inertia, where a body that slips all round can turn without resistance. Only the way to
    /// the solution changes, not the solution: the residual knows nothing of it.
    pub fn stabilised(self) -> Self {
        Contact { stabilisation: 1e-9, ..self }
    }

    /// Newton with the statuses inside the loop; where they run in a circle, the fixed point on Tresca's bound.
    pub fn solve(&mut self, problem: &Problem, guess: &[f64]) -> Result<Solution, Unsettled> {
        self.newton(problem, guess).or_else(|unsettled| {
            let near = self.fixed_point(problem, guess, unsettled)?;
            // From so near Newton ends at round-off, unless it circles again.
            let polished = self.newton(problem, &near.jumps);
            Ok(polished.map_or(near.clone(), |s| Solution {
                iterations: near.iterations + s.iterations,
                displacement_test: near.displacement_test,
                ..s
            }))
        })
    }

    fn newton(&mut self, problem: &Problem, guess: &[f64]) -> Result<Solution, Unsettled> {
        let mut jumps = guess.to_vec();
        let mut seen: Vec<Vec<Status>> = Vec::new();
        let mut correction = 0.;
        for iterations in 0..=self.options.max_iterations {
            let responses = problem.respond(&jumps, None);
            let residual = self.residual(problem, &jumps, &responses);
            let statuses: Vec<Status> = responses.iter().map(|r| r.status).collect();
            let settled = seen.last() == Some(&statuses);
            if residual.relative <= if settled { self.options.tolerance } else { ROUND_OFF } {
                let displacement_test = ratio(correction, distance(&jumps, guess));
                return Ok(Solution { jumps, responses, iterations, displacement_test });
            }
            let turns_in_a_circle = !settled && seen.contains(&statuses);
            if turns_in_a_circle || iterations == self.options.max_iterations {
                let before = seen.last().unwrap_or(&statuses);
                return Err(Unsettled { points: differing(before, &statuses) });
            }
            let step = self.tangent_solve(problem, &responses, &statuses, residual.force);
            jumps.iter_mut().zip(&step).for_each(|(j, d)| *j -= d);
            correction = norm(&step);
            seen.push(statuses);
        }
        unreachable!("the last iteration returns")
    }

    /// (S + dr/dj)^-1 f, the factor kept while no status changes.
    fn tangent_solve(
        &mut self,
        problem: &Problem,
        responses: &[Response],
        statuses: &[Status],
        force: Vec<f64>,
    ) -> Vec<f64> {
        let key = problem.tangent_key(statuses);
        if self.factored.as_ref().is_none_or(|(of, _)| *of != key) {
            self.factored = Some((key, self.tangent(problem, responses).partial_piv_lu()));
        }
        let (_, lu) = self.factored.as_ref().expect("set above");
        solve_dense(lu, force)
    }

    fn tangent(&self, problem: &Problem, responses: &[Response]) -> Mat<f64> {
        let mut tangent = self.schur.clone();
        let points = problem.interface.points.iter();
        let per_point =
            responses.iter().zip(points).map(|(r, p)| r.tangent + p.law.closed_stiffness() * self.stabilisation);
        problem.interface.each_tangent(per_point, |i, j, value| tangent[(i, j)] += value);
        tangent
    }

    /// Outer loop on the bound f p; the inner problem with a fixed bound is convex and always solved.
    fn fixed_point(&self, problem: &Problem, guess: &[f64], unsettled: Unsettled) -> Result<Solution, Unsettled> {
        let mut jumps = guess.to_vec();
        let mut bounds = problem.bounds(&jumps);
        for iterations in 1..=10 * self.options.max_iterations {
            let Some(next) = self.minimise(problem, &jumps, &bounds) else { break };
            let correction = distance(&next, &jumps);
            jumps = next;
            let responses = problem.respond(&jumps, None);
            if self.residual(problem, &jumps, &responses).relative <= self.options.tolerance {
                let displacement_test = ratio(correction, distance(&jumps, guess));
                return Ok(Solution { jumps, responses, iterations, displacement_test });
            }
            bounds = problem.bounds(&jumps);
        }
        Err(unsettled)
    }

    /// Minimises 1/2 j'S j - b'j + sum area psi(j), convex and piecewise quadratic for fixed bounds: Newton with an exact
    /// line search.
    fn minimise(&self, problem: &Problem, start: &[f64], bounds: &[f64]) -> Option<Vec<f64>> {
        let mut jumps = start.to_vec();
        for _ in 0..10 * self.options.max_iterations {
            let responses = problem.respond(&jumps, Some(bounds));
            let residual = self.residual(problem, &jumps, &responses);
            if residual.relative <= self.options.tolerance / 10. {
                return Some(jumps);
            }
            let step = solve_dense(&self.tangent(problem, &responses).partial_piv_lu(), residual.force);
            let moved = |alpha: f64| -> Vec<f64> { jumps.iter().zip(&step).map(|(j, d)| j - alpha * d).collect() };
            let uphill = |alpha: f64| {
                let j = moved(alpha);
                let force = self.residual(problem, &j, &problem.respond(&j, Some(bounds))).force;
                -dot(&force, &step) > 0.
            };
            jumps = moved(if uphill(1.) { bisect(uphill) } else { 1. });
        }
        None
    }

    fn residual(&self, problem: &Problem, jumps: &[f64], responses: &[Response]) -> Residual {
        let joint = problem.interface.forces(responses.iter().map(|r| r.traction));
        let b = problem.right_hand_side;
        let linear = multiply_symmetric(&self.schur, jumps);
        let force: Vec<f64> = (0..b.len()).map(|i| linear[i] + joint[i] - b[i]).collect();
        let scale = norm(b).max(norm(&linear)).max(norm(&joint));
        Residual { relative: ratio(norm(&force), scale), force }
    }
}

struct Residual {
    /// S j + r - b [N]
    force: Vec<f64>,
    relative: f64,
}

impl Problem<'_> {
    /// Every point's answer; with `bounds` [Pa] under Tresca's law.
    fn respond(&self, jumps: &[f64], bounds: Option<&[f64]>) -> Vec<Response> {
        let points = self.interface.points.iter().zip(self.old).enumerate();
        points
            .map(|(i, (point, old))| {
                let friction = bounds.map_or(point.law.friction, |b| Friction::Tresca(b[i]));
                let law = JointLaw { friction, ..point.law };
                let elastic = law.respond(self.interface.local(point, jumps), old.slip);
                match &self.damping {
                    None => elastic,
                    Some(damping) => {
                        let offset = self.interface.local(point, &damping.rate_offset);
                        let jump = self.interface.local(point, jumps);
                        damping.add_to(elastic, &law, old.status, jump * damping.constants.a1 + offset)
                    }
                }
            })
            .collect()
    }

    /// What the tangent depends on: the statuses, and with damping those of the last step.
    fn tangent_key(&self, statuses: &[Status]) -> Vec<Status> {
        let last = self.old.iter().filter(|_| self.damping.is_some()).map(|o| o.status);
        statuses.iter().copied().chain(last).collect()
    }

    /// f p at every point [Pa], p the elastic pressure.
    fn bounds(&self, jumps: &[f64]) -> Vec<f64> {
        let limit = |(point, old): (&JointPoint, &JointState)| match point.law.friction {
            Friction::Tresca(bound) => bound,
            Friction::Coulomb(f) => f * -point.law.respond(self.interface.local(point, jumps), old.slip).traction[1],
        };
        self.interface.points.iter().zip(self.old).map(limit).collect()
    }
}

impl JointDamping {
    /// Adds beta D rate, D the stiffness that the last step's status left: all of it sticking, the normal part slipping,
    /// none open. The status of this step would make the force jump where a joint opens, and leave no equilibrium there.
    fn add_to(&self, elastic: Response, law: &JointLaw, last: Status, rate: Vector2<f64>) -> Response {
        let d = match last {
            Status::Open => Matrix2::zeros(),
            Status::Stick => law.closed_stiffness(),
            Status::SlipForward | Status::SlipBackward => Matrix2::new(0., 0., 0., law.normal_stiffness),
        };
        Response {
            traction: elastic.traction + d * rate * self.beta,
            tangent: elastic.tangent + d * (self.beta * self.constants.a1),
            ..elastic
        }
    }
}

fn solve_dense(lu: &PartialPivLu<f64>, force: Vec<f64>) -> Vec<f64> {
    let mut x = force;
    let rows = x.len();
    lu.solve_in_place(faer::MatMut::from_column_major_slice_mut(&mut x, rows, 1));
    x
}

/// A x of a full symmetric matrix, by its columns.
fn multiply_symmetric(a: &Mat<f64>, x: &[f64]) -> Vec<f64> {
    (0..a.ncols()).map(|j| dot(a.col_as_slice(j), x)).collect()
}

/// The crossing of a sign that is false at 0 and true at 1.
fn bisect(is_past: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0., 1.);
    for _ in 0..50 {
        let middle = (low + high) / 2.;
        if is_past(middle) { high = middle } else { low = middle }
    }
    (low + high) / 2.
}

fn differing(a: &[Status], b: &[Status]) -> Vec<usize> {
    (0..a.len()).filter(|&i| a[i] != b[i]).collect()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// a / b, and 0 for 0 / 0.
fn ratio(a: f64, b: f64) -> f64 {
    if a == 0. { 0. } else { a / b }
}
