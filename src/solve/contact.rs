//! Newton's method on the jumps: S (j - j_0) + r(j) - D_0 j = 0, with j_0 the jumps without joint forces, S the stiffness
//! of what the joints connect, r the joint forces, and D_0 the stiffness of the joints that S already holds, if any.
//!
//! r is piecewise linear: a step whose points stay on their branches is solved at once, and only the points that changed
//! their status cost more than that.

use super::border::Border;
use super::interface::JointPoint;
use super::inverse::Inverse;
use super::joints::{Branches, Joints};
use super::tresca::FixedPoint;
use super::unsettled::{Place, Unsettled};
use crate::model::case::Newton;
use crate::physics::joint::{JointLaw, Response, Status};
use crate::sparse::vector::{add, norm};
use nalgebra::{Matrix2, Vector2};
use std::sync::Arc;

/// Relative residual below which a status may still flip: round-off decides it, and it carries no force.
const ROUND_OFF: f64 = 1e-13;

/// What of the joints the border holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reference {
    /// nothing, D_0 = 0: the bodies stand by themselves
    Bodies,
    /// every joint closed and sticking, because some bodies hang on joints alone
    ClosedJoints,
}

/// One step's contact problem.
pub struct Problem<'a> {
    pub joints: Joints<'a>,
    /// forces at the border, without the joints' [N]
    pub b: &'a [f64],
    /// the jumps that they make [m]
    pub free: &'a [f64],
    /// jumps of the last state [m]
    pub last: &'a [f64],
    /// where they are going [m]: a point that slips stands just on the edge of slip, and only this tells that it goes on
    pub expected: &'a [f64],
}

#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// displacements of the border [m]
    pub border: Vec<f64>,
    pub jumps: Vec<f64>,
    pub responses: Vec<Response>,
    pub iterations: usize,
    /// the paper's test (19) on the jumps: last correction over the step's increment
    pub displacement_test: f64,
}

pub struct Contact {
    pub(super) border: Arc<Border>,
    reference: Reference,
    pub(super) options: Newton,
    inverse: Inverse,
}

/// Where Newton stands.
struct Iterate {
    jumps: Vec<f64>,
    branches: Branches,
    /// at the jumps, on the lines that the last step was solved with [Pa]
    tractions: Vec<Vector2<f64>>,
    /// S (j - j_0) + r - D_0 j [N]
    missed: Vec<f64>,
}

impl Iterate {
    /// Whether the joints' answers are those to its jumps, and not to others on whose branches it goes on.
    fn is_answered(&self) -> bool {
        self.branches.at == self.jumps
    }
}

impl Contact {
    pub fn new(border: Arc<Border>, reference: Reference, options: Newton) -> Contact {
        Contact { border, reference, options, inverse: Inverse::default() }
    }

    /// For other joints on the same bodies.
    pub fn sharing_border(&self) -> Contact {
        Contact { border: self.border.clone(), inverse: Inverse::default(), ..*self }
    }

    /// Newton with the statuses inside the loop; where they run in a circle, the fixed point on Tresca's bound.
    pub fn solve(&mut self, problem: &Problem) -> Result<Solution, Unsettled> {
        self.newton(problem, problem.expected).or_else(|unsettled| {
            let FixedPoint { jumps, iterations, displacement_test } = self.fixed_point(problem).ok_or(unsettled)?;
            // From so near Newton ends at round-off, unless it circles again.
            let polished = self.newton(problem, &jumps);
            let near = |_| self.solution(problem, &problem.joints.branches(&jumps), 0, displacement_test);
            let nearest = polished.unwrap_or_else(near);
            Ok(Solution { iterations: iterations + nearest.iterations, displacement_test, ..nearest })
        })
    }

    /// From the free jumps, on the branches of r that the `expected` ones lie on.
    fn newton(&mut self, problem: &Problem, expected: &[f64]) -> Result<Solution, Unsettled> {
        let mut iterate = self.start(problem, problem.free, problem.joints.branches(expected));
        let mut scale = self.scale(problem, &iterate);
        let mut seen: Vec<Vec<Status>> = Vec::new();
        let (mut correction, mut again) = (0., false);
        for iterations in 0..=self.options.max_iterations {
            let statuses = iterate.branches.statuses();
            let settled = seen.last() == Some(&statuses);
            let tolerance = if settled { self.options.tolerance } else { ROUND_OFF };
            if iterate.is_answered() && norm(&iterate.missed) <= tolerance * scale {
                let displacement_test = ratio(correction, distance(&iterate.jumps, problem.last));
                let solution = self.solution(problem, &iterate.branches, iterations, displacement_test);
                if self.fits(problem, &solution) {
                    return Ok(solution);
                }
            }
            let circles = !settled && seen.contains(&statuses);
            if (circles || settled) && (!again || self.inverse.is_corrected()) {
                // Corrections may have worn the inverse, and stiff joints cost digits on the way from the free jumps: once
                // more with a fresh one, from what these jumps really miss.
                self.inverse.forget();
                iterate = self.start(problem, &iterate.jumps, iterate.branches);
                seen.clear();
                again = true;
            } else if circles {
                break;
            }
            let tangents = self.tangents(&problem.joints, &iterate.branches.responses);
            let step = self.inverse.solve(&self.border.schur, problem.joints.interface, &tangents, &iterate.missed);
            iterate = self.after(&problem.joints, &iterate, &tangents, &step);
            scale = scale.max(norm(&iterate.missed));
            correction = if iterations == 0 { distance(&iterate.jumps, problem.last) } else { norm(&step) };
            seen.push(statuses);
        }
        Err(self.unsettled(problem, &iterate, scale, seen.last()))
    }

    /// At some jumps, on the lines through some branches.
    fn start(&self, problem: &Problem, jumps: &[f64], branches: Branches) -> Iterate {
        let Problem { joints, free, .. } = problem;
        let tractions = joints.on_lines(&branches, jumps);
        let points = joints.interface.points.iter().zip(&tractions);
        let beyond = points.map(|(p, traction)| traction - self.held(&p.law) * joints.interface.local(p, jumps));
        let mut missed = joints.interface.forces(beyond);
        if jumps != *free {
            let from_free: Vec<f64> = jumps.iter().zip(*free).map(|(j, free)| j - free).collect();
            add(&mut missed, 1., &self.border.forces(&from_free));
        }
        Iterate { jumps: jumps.to_vec(), missed, branches, tractions }
    }

    /// What forces are measured against [N].
    fn scale(&self, problem: &Problem, iterate: &Iterate) -> f64 {
        norm(&iterate.missed).max(norm(&problem.joints.interface.forces(iterate.tractions.iter().copied())))
    }

    /// After a step of Newton's, which goes where the lines that it was solved with miss nothing: so what is missed is how
    /// far the joints' answer lies off these lines, and that is nothing at every point that stayed on its branch.
    fn after(&self, joints: &Joints, before: &Iterate, tangents: &[Matrix2<f64>], step: &[f64]) -> Iterate {
        let jumps: Vec<f64> = before.jumps.iter().zip(step).map(|(j, d)| j - d).collect();
        let branches = joints.branches(&jumps);
        let off_its_line = |(i, point): (usize, &JointPoint)| {
            let (old, new) = (&before.branches.responses[i], &branches.responses[i]);
            if self.stabilisation() == 0. && old.status == new.status && old.tangent == new.tangent {
                return Vector2::zeros();
            }
            let slope = tangents[i] + self.held(&point.law);
            new.traction - before.tractions[i] + slope * joints.interface.local(point, step)
        };
        let missed = joints.interface.forces(joints.interface.points.iter().enumerate().map(off_its_line));
        Iterate { missed, tractions: branches.responses.iter().map(|r| r.traction).collect(), jumps, branches }
    }

    /// The displacements that the joints' forces make.
    fn solution(
        &self,
        Problem { joints, b, .. }: &Problem,
        Branches { at, responses }: &Branches,
        iterations: usize,
        displacement_test: f64,
    ) -> Solution {
        let interface = joints.interface;
        let points = interface.points.iter().zip(responses);
        let beyond = points.map(|(p, r)| r.traction - self.held(&p.law) * interface.local(p, at));
        let border = self.border.displacements(&self.border.pulled(b, &interface.forces(beyond)));
        Solution { border, jumps: at.clone(), responses: responses.clone(), iterations, displacement_test }
    }

    /// Whether the jumps are those of the displacements that the joints' forces make, to the tolerance or to what
    /// round-off leaves of their digits.
    fn fits(&self, problem: &Problem, solution: &Solution) -> bool {
        let difference = distance(&self.border.jumps(&solution.border), &solution.jumps);
        let jumps = norm(&solution.jumps).max(norm(problem.free));
        difference <= (self.options.tolerance * jumps).max(ROUND_OFF * norm(&solution.border))
    }

    fn unsettled(&self, problem: &Problem, iterate: &Iterate, scale: f64, before: Option<&Vec<Status>>) -> Unsettled {
        let Iterate { missed, branches, .. } = iterate;
        let interface = problem.joints.interface;
        let forces = (0..missed.len()).filter_map(|i| Some((missed[i].abs(), interface.point_of(i)?)));
        // what is not a number is the largest of all
        let largest = forces.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, point)| point);
        let relative = ratio(norm(missed), scale);
        if !relative.is_finite() {
            return Unsettled::Overflow(largest.map_or(Place::Matrix, Place::JointPoint));
        }
        let last = branches.statuses();
        match before.map(|before| differing(before, &last)) {
            Some(changing) if !changing.is_empty() => Unsettled::Statuses { changing, last },
            _ => Unsettled::Residual { relative, largest, last },
        }
    }

    /// D - D_0 of every point for Newton's matrix [Pa/m].
    fn tangents(&self, joints: &Joints, responses: &[Response]) -> Vec<Matrix2<f64>> {
        let points = responses.iter().zip(&joints.interface.points);
        points.map(|(r, p)| r.tangent + p.law.closed_stiffness() * self.stabilisation() - self.held(&p.law)).collect()
    }

    /// D_0 of a point [Pa/m].
    pub(super) fn held(&self, law: &JointLaw) -> Matrix2<f64> {
        match self.reference {
            Reference::Bodies => Matrix2::zeros(),
            Reference::ClosedJoints => law.closed_stiffness(),
        }
    }

    /// Part of the closed stiffness that every tangent keeps. Without inertia a body that slips all round can turn without
    /// resistance. Only the way to the solution changes, not the solution: what is missed knows nothing of it.
    pub(super) fn stabilisation(&self) -> f64 {
        match self.reference {
            Reference::Bodies => 0.,
            Reference::ClosedJoints => 1e-9,
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
