//! Newton's method on the jumps: S j + r(j) = b, S the Schur complement of everything linear, r the joint forces.
//!
//! r is piecewise linear: a step whose points stay on their branches ends at the solution, and only the points that
//! changed their status cost more than that.

use super::interface::{Interface, JointPoint, JointState};
use super::inverse::{Inverse, dense_times};
use super::newmark::Constants;
use crate::model::case::Newton;
use crate::physics::joint::{Friction, JointLaw, Response, Status};
use crate::sparse::vector::norm;
use faer::Mat;
use nalgebra::{Matrix2, Vector2};
use std::sync::Arc;

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

/// Why no step could be accepted.
#[derive(Debug, Clone, PartialEq)]
pub enum Unsettled {
    /// no statuses were found that agree with their jumps: the joint points that kept changing, and how all stood last
    Statuses { changing: Vec<usize>, last: Vec<Status> },
    /// the statuses stand, but the residual does not fall: what it stays at, and the joint point where it is largest
    Residual { relative: f64, largest: Option<usize>, last: Vec<Status> },
    /// numbers beyond floating point
    Overflow(Place),
}

/// Where numbers first go beyond floating point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    JointPoint(usize),
    Node(usize),
    /// in the matrix of a step
    Matrix,
}

pub struct Contact {
    pub(super) schur: Arc<Mat<f64>>,
    /// the tolerance is on |S j + r - b| / max(|b|, |S j|, |r|)
    pub(super) options: Newton,
    /// part of the closed stiffness that every tangent keeps, so that what slips freely has one
    stabilisation: f64,
    inverse: Inverse,
    /// the jumps of the last solution and S times them, where the next step begins
    last: Option<(Vec<f64>, Vec<f64>)>,
}

impl Contact {
    pub fn new(schur: Mat<f64>, options: Newton) -> Self {
        Contact { schur: schur.into(), options, stabilisation: 0., inverse: Inverse::default(), last: None }
    }

    /// For equilibrium without inertia, where a body that slips all round can turn without resistance. Only the way to
    /// the solution changes, not the solution: the residual knows nothing of it.
    pub fn stabilised(self) -> Self {
        Contact { stabilisation: 1e-9, ..self }
    }

    /// For other joints on the same bodies.
    pub fn sharing_matrix(&self) -> Self {
        Contact { schur: self.schur.clone(), inverse: Inverse::default(), last: None, ..*self }
    }

    /// Newton with the statuses inside the loop; where they run in a circle, the fixed point on Tresca's bound.
    ///
    /// It starts from the jumps `last` of the last state, on the branches of r that `expected` jumps lie on: a point that
    /// slips stands just on the edge of slip, and only where it is going tells that it goes on.
    pub fn solve(&mut self, problem: &Problem, last: &[f64], expected: &[f64]) -> Result<Solution, Unsettled> {
        self.newton(problem, last, expected).or_else(|unsettled| {
            let near = self.fixed_point(problem, last).ok_or(unsettled)?;
            // From so near Newton ends at round-off, unless it circles again.
            let polished = self.newton(problem, &near.jumps, &near.jumps);
            Ok(polished.map_or(near.clone(), |s| Solution {
                iterations: near.iterations + s.iterations,
                displacement_test: near.displacement_test,
                ..s
            }))
        })
    }

    fn newton(&mut self, problem: &Problem, last: &[f64], expected: &[f64]) -> Result<Solution, Unsettled> {
        let mut jumps = last.to_vec();
        let mut branches = self.branches(problem, expected);
        let mut residual = self.on_branches(problem, &jumps, &branches);
        let mut seen: Vec<Vec<Status>> = Vec::new();
        let mut correction = 0.;
        for iterations in 0..=self.options.max_iterations {
            let settled = seen.last() == Some(&branches.statuses);
            if residual.predicted && (settled || residual.relative() <= ROUND_OFF) {
                if branches.at != jumps {
                    branches = self.branches(problem, &jumps);
                }
                residual = self.residual(problem, &jumps, &branches.responses);
            }
            if !residual.predicted && residual.relative() <= if settled { self.options.tolerance } else { ROUND_OFF } {
                let displacement_test = ratio(correction, distance(&jumps, last));
                self.last = Some((jumps.clone(), residual.linear));
                return Ok(Solution { jumps, responses: branches.responses, iterations, displacement_test });
            }
            let mut turns_in_a_circle = !settled && seen.contains(&branches.statuses);
            if turns_in_a_circle && self.inverse.is_corrected() {
                // Corrections may have worn the inverse: once more with a fresh one, from what the residual really is.
                self.inverse.forget();
                residual = self.on_branches(problem, &jumps, &branches);
                seen.clear();
                turns_in_a_circle = false;
            }
            if turns_in_a_circle || iterations == self.options.max_iterations {
                return Err(self.unsettled(problem, &residual, seen.last(), branches.statuses));
            }
            if settled {
                // The tangent was right and yet the step missed: corrections have worn the inverse.
                self.inverse.forget();
            }
            let step = self.inverse.solve(&self.schur, problem.interface, &branches.tangents, &residual.force);
            jumps.iter_mut().zip(&step).for_each(|(j, d)| *j -= d);
            let next = self.branches(problem, &jumps);
            residual = self.predicted(problem, &branches, &next, &residual);
            correction = norm(&step);
            seen.push(std::mem::replace(&mut branches, next).statuses);
        }
        unreachable!("the last iteration returns")
    }

    /// The branches of r that the joints are on with these jumps.
    fn branches(&self, problem: &Problem, jumps: &[f64]) -> Branches {
        let responses = problem.respond(jumps, None);
        Branches {
            at: jumps.to_vec(),
            statuses: responses.iter().map(|r| r.status).collect(),
            tangents: self.tangents(problem, &responses),
            responses,
        }
    }

    fn unsettled(
        &self,
        problem: &Problem,
        residual: &Residual,
        before: Option<&Vec<Status>>,
        last: Vec<Status>,
    ) -> Unsettled {
        let forces =
            (0..residual.force.len()).filter_map(|i| Some((residual.force[i].abs(), problem.interface.point_of(i)?)));
        // what is not a number is the largest of all
        let largest = forces.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, point)| point);
        if !residual.relative().is_finite() {
            return Unsettled::Overflow(largest.map_or(Place::Matrix, Place::JointPoint));
        }
        match before.map(|before| differing(before, &last)) {
            Some(changing) if !changing.is_empty() => Unsettled::Statuses { changing, last },
            _ => Unsettled::Residual { relative: residual.relative(), largest, last },
        }
    }

    /// D of every point for Newton's matrix.
    pub(super) fn tangents(&self, problem: &Problem, responses: &[Response]) -> Vec<Matrix2<f64>> {
        let points = responses.iter().zip(&problem.interface.points);
        points.map(|(r, p)| r.tangent + p.law.closed_stiffness() * self.stabilisation).collect()
    }

    /// S j + r - b.
    pub(super) fn residual(&self, problem: &Problem, jumps: &[f64], responses: &[Response]) -> Residual {
        self.residual_with(problem, jumps, problem.interface.forces(responses.iter().map(|r| r.traction)))
    }

    fn residual_with(&self, problem: &Problem, jumps: &[f64], joint: Vec<f64>) -> Residual {
        let b = problem.right_hand_side;
        let linear = match &self.last {
            Some((last, product)) if last == jumps => product.clone(),
            _ => dense_times(&self.schur, jumps),
        };
        let force = (0..b.len()).map(|i| linear[i] + joint[i] - b[i]).collect();
        let scale = norm(b).max(norm(&linear)).max(norm(&joint));
        Residual { force, scale, linear, predicted: false }
    }

    /// S j + r - b with r on the straight line through a branch: r(at) + D (j - at).
    fn on_branches(&self, problem: &Problem, jumps: &[f64], branches: &Branches) -> Residual {
        if branches.at == jumps {
            return self.residual(problem, jumps, &branches.responses);
        }
        let lines = branches.lines(problem, jumps);
        Residual { predicted: true, ..self.residual_with(problem, jumps, problem.interface.forces(lines)) }
    }

    /// The residual after a Newton step without S: on the old branches it is zero, so what is left is what the new ones
    /// differ from them, which is nothing at every point that stayed on its branch.
    fn predicted(&self, problem: &Problem, old: &Branches, new: &Branches, last: &Residual) -> Residual {
        let same = |i: usize| {
            let (old, new) = (&old.responses[i], &new.responses[i]);
            self.stabilisation == 0. && old.status == new.status && old.tangent == new.tangent
        };
        let missed = |(i, on_old): (usize, Vector2<f64>)| match same(i) {
            true => Vector2::zeros(),
            false => new.responses[i].traction - on_old,
        };
        let force = problem.interface.forces(old.lines(problem, &new.at).enumerate().map(missed));
        Residual { force, scale: last.scale, linear: Vec::new(), predicted: true }
    }
}

/// What every joint point answers to some jumps, and along which line it goes on from there.
struct Branches {
    /// the jumps [m]
    at: Vec<f64>,
    statuses: Vec<Status>,
    responses: Vec<Response>,
    /// D of Newton's matrix [Pa/m]
    tangents: Vec<Matrix2<f64>>,
}

impl Branches {
    /// r(at) + D (j - at) of every point [Pa].
    fn lines<'a>(&'a self, problem: &'a Problem, jumps: &[f64]) -> impl Iterator<Item = Vector2<f64>> + 'a {
        let moved: Vec<f64> = jumps.iter().zip(&self.at).map(|(j, at)| j - at).collect();
        let points = self.responses.iter().zip(&self.tangents).zip(&problem.interface.points);
        points.map(move |((r, d), point)| r.traction + d * problem.interface.local(point, &moved))
    }
}

pub(super) struct Residual {
    /// S j + r - b [N]
    pub force: Vec<f64>,
    /// what it is measured against [N]
    scale: f64,
    /// S j [N], unless predicted
    linear: Vec<f64>,
    /// known but for round-off
    predicted: bool,
}

impl Residual {
    pub fn relative(&self) -> f64 {
        ratio(norm(&self.force), self.scale)
    }
}

impl Problem<'_> {
    /// Every point's answer; with `bounds` [Pa] under Tresca's law.
    pub(super) fn respond(&self, jumps: &[f64], bounds: Option<&[f64]>) -> Vec<Response> {
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

    /// f p at every point [Pa], p the elastic pressure.
    pub(super) fn bounds(&self, jumps: &[f64]) -> Vec<f64> {
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

fn differing(a: &[Status], b: &[Status]) -> Vec<usize> {
    (0..a.len()).filter(|&i| a[i] != b[i]).collect()
}

pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// a / b, and 0 for 0 / 0.
pub(super) fn ratio(a: f64, b: f64) -> f64 {
    if a == 0. { 0. } else { a / b }
}
