//! Newton's method on the jumps: S (j - j_0) + r(j) - D_0 j = 0, with j_0 the jumps without joint forces, S the
//! stiffness of what the joints connect, r the joint forces, and D_0 the stiffness of the joints that S already holds,
//! if any.
//!
//! r is piecewise linear: a step whose points stay on their branches is solved at once, and only the points that
//! changed their status cost more than that.

use super::condensate::Condensate;
use super::interface::{Interface, JointPoint};
use super::inverse::Inverse;
use super::joints::{Branches, Joints};
use super::tresca::FixedPoint;
use super::unsettled::Unsettled;
use crate::model::case::Newton;
use crate::physics::joint::{Response, Status};
use crate::sparse::vector::{add, distance, norm, ratio};
use nalgebra::{Matrix2, Vector2};
use std::sync::Arc;

/// Relative residual below which a status may still flip: round-off decides it, and it carries no force.
const ROUND_OFF: f64 = 1e-13;

/// One step's contact problem.
pub struct Problem<'a> {
    pub joints: &'a Joints<'a>,
    /// forces at the border, without the joints' [N]
    pub b: &'a [f64],
    /// the jumps that they make [m]
    pub free: &'a [f64],
    /// jumps of the last state [m]
    pub last: &'a [f64],
    /// where they are going [m]: a point that slips stands just on the edge of slip, and only this tells that it goes
    /// on
    pub expected: &'a [f64],
    /// the largest force of the run so far, where forces are measured against it [N]; 0 with inertia
    pub largest_force: f64,
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
    /// the largest force of the run so far, this step included [N]; 0 with inertia
    pub largest_force: f64,
}

impl Solution {
    fn new(border: Vec<f64>, branches: Branches, iterations: usize, displacement_test: f64) -> Solution {
        let Branches { at: jumps, responses } = branches;
        Solution { border, jumps, responses, iterations, displacement_test, largest_force: 0. }
    }
}

pub struct Contact {
    pub(super) condensate: Arc<Condensate>,
    /// D_0 of every joint point [Pa/m]; none where inertia lets the bodies stand by themselves
    closed: Arc<[Matrix2<f64>]>,
    pub(super) options: Newton,
    pub(super) inverse: Inverse,
}

/// Where Newton stands.
pub(super) struct Iterate {
    jumps: Vec<f64>,
    pub(super) branches: Branches,
    /// at the jumps: the joints' answers, at the start what the lines through the branches say [Pa]
    pub(super) tractions: Vec<Vector2<f64>>,
    /// S (j - j_0) + r - D_0 j [N]
    pub(super) missed: Vec<f64>,
}

impl Iterate {
    /// Whether the joints' answers are those to its jumps, and not to others on whose branches it goes on.
    fn is_answered(&self) -> bool {
        self.branches.at == self.jumps
    }
}

/// What is left to try where Newton runs in a circle or stands still.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Retry {
    /// From what these jumps really miss: stiff joints cost digits on the way from the free jumps.
    FromHere,
    /// With a fresh inverse, which corrections may have worn.
    Fresh,
    Nothing,
}

impl Contact {
    /// `closed`: D_0 of every joint point [Pa/m], or none.
    pub fn new(condensate: Arc<Condensate>, closed: Arc<[Matrix2<f64>]>, options: Newton) -> Contact {
        let inverse = Inverse::new(!closed.is_empty());
        Contact { condensate, closed, options, inverse }
    }

    /// For other joints on the same bodies.
    pub fn sharing_condensate(&self) -> Contact {
        Contact::new(self.condensate.clone(), self.closed.clone(), self.options)
    }

    /// The solution of one step; without inertia with all digits that the displacements have.
    pub fn solve(&mut self, problem: &Problem) -> Result<Solution, Unsettled> {
        let solution = self.settled(problem)?;
        if self.closed.is_empty() {
            return Ok(solution);
        }
        let refined = self.refined(problem, solution);
        let tractions: Vec<Vector2<f64>> = refined.responses.iter().map(|r| r.traction).collect();
        let largest_force = self.scale(problem, &tractions, f64::INFINITY);
        Ok(Solution { largest_force, ..refined })
    }

    /// Newton with the statuses inside the loop; where they run in a circle, the fixed point on Tresca's bound.
    fn settled(&mut self, problem: &Problem) -> Result<Solution, Unsettled> {
        self.newton(problem, problem.expected).or_else(|unsettled| {
            let Some(FixedPoint { jumps, iterations, displacement_test }) = self.fixed_point(problem) else {
                return Err(unsettled);
            };
            // From so near Newton ends at round-off, unless it circles again.
            let nearest = self.newton(problem, &jumps).or_else(|_| {
                let near = problem.joints.branches(&jumps);
                let border = self.border(problem, &near);
                let fits = self.misfit(problem, &near, &border) <= self.options.tolerance;
                if fits { Ok(Solution::new(border, near, 0, displacement_test)) } else { Err(unsettled) }
            })?;
            Ok(Solution { iterations: iterations + nearest.iterations, displacement_test, ..nearest })
        })
    }

    /// From the free jumps, on the branches of r that the `expected` ones lie on.
    fn newton(&mut self, problem: &Problem, expected: &[f64]) -> Result<Solution, Unsettled> {
        let mut iterate = self.start(problem, problem.free, problem.joints.branches(expected));
        let mut seen: Vec<Vec<Status>> = Vec::new();
        let (mut correction, mut missed_before) = (0., f64::INFINITY);
        let mut retry = Retry::FromHere;
        for iterations in 0..=self.options.max_iterations {
            let (statuses, missed) = (iterate.branches.statuses(), norm(&iterate.missed));
            let settled = seen.last() == Some(&statuses);
            // Statuses that have run in a circle once stand on the edge between two, and the law's own residual decides.
            let by_residual = settled || retry != Retry::FromHere;
            let tolerance = if by_residual { self.options.tolerance } else { ROUND_OFF };
            let least = missed / tolerance;
            if iterate.is_answered() && (missed == 0. || least <= self.scale(problem, &iterate.tractions, least)) {
                let border = self.border(problem, &iterate.branches);
                if self.misfit(problem, &iterate.branches, &border) <= self.options.tolerance {
                    let displacement_test = ratio(correction, distance(&iterate.jumps, problem.last));
                    return Ok(Solution::new(border, iterate.branches, iterations, displacement_test));
                }
            }
            let stands_still = settled && missed >= missed_before / 2.;
            if stands_still || !settled && seen.contains(&statuses) {
                retry = match retry {
                    Retry::FromHere => Retry::Fresh,
                    Retry::Fresh if self.inverse.is_corrected() => {
                        self.inverse.forget();
                        Retry::Nothing
                    }
                    _ => break,
                };
                iterate = self.start(problem, &iterate.jumps, iterate.branches);
                seen.clear();
            }
            missed_before = missed;
            let tangents = self.tangents(&iterate.branches.responses);
            let step = self.inverse.solve(&self.condensate.schur, problem.joints.interface, &tangents, &iterate.missed);
            let next = self.after(problem.joints, &iterate, &tangents, &step);
            correction = distance(&next.jumps, if iterations == 0 { problem.last } else { &iterate.jumps });
            iterate = next;
            seen.push(statuses);
        }
        Err(self.unsettled(problem, &iterate, seen.last()))
    }

    /// At some jumps, on the lines through some branches.
    fn start(&self, problem: &Problem, jumps: &[f64], branches: Branches) -> Iterate {
        let Problem { joints, free, .. } = problem;
        let tractions = joints.on_lines(&branches, jumps);
        let mut missed = self.forces_beyond(joints.interface, &tractions, jumps);
        if jumps != *free {
            let from_free: Vec<f64> = jumps.iter().zip(*free).map(|(j, free)| j - free).collect();
            add(&mut missed, 1., &self.condensate.forces(&from_free));
        }
        Iterate { jumps: jumps.to_vec(), missed, branches, tractions }
    }

    /// What forces are measured against [N]: the largest so far, the joints' own or, where these are not `enough`, those
    /// that would close the free jumps, if they are larger.
    pub(super) fn scale(&self, problem: &Problem, tractions: &[Vector2<f64>], enough: f64) -> f64 {
        let own = norm(&problem.joints.interface.forces(tractions.iter().copied())).max(problem.largest_force);
        if own >= enough { own } else { own.max(norm(&self.condensate.forces(problem.free))) }
    }

    /// After a step of Newton's, which goes where the lines that it was solved with miss nothing: so what is missed is
    /// how far the joints' answer lies off these lines, and that is nothing at every point that stayed on its branch.
    fn after(&self, joints: &Joints, before: &Iterate, tangents: &[Matrix2<f64>], step: &[f64]) -> Iterate {
        let jumps: Vec<f64> = before.jumps.iter().zip(step).map(|(j, d)| j - d).collect();
        let branches = joints.branches(&jumps);
        let on_its_line = |i: usize| {
            let (old, new) = (&before.branches.responses[i], &branches.responses[i]);
            // two branches of a dashpot have one tangent: where it is cut either way
            joints.damping.is_none() && old.status == new.status && old.tangent == new.tangent
        };
        let off_its_line = |(i, point): (usize, &JointPoint)| {
            let slope = tangents[i] + self.reference(i);
            let on_line = before.tractions[i] - slope * joints.interface.local(point, step);
            (i, branches.responses[i].traction - on_line)
        };
        let elsewhere = joints.interface.points.iter().enumerate().filter(|(i, _)| !on_its_line(*i));
        let missed = joints.interface.forces_at(elsewhere.map(off_its_line));
        Iterate { missed, tractions: branches.responses.iter().map(|r| r.traction).collect(), jumps, branches }
    }

    /// The displacements of the border that the joints' forces make [m].
    pub(super) fn border(
        &self,
        Problem { joints, b, .. }: &Problem,
        Branches { at, responses }: &Branches,
    ) -> Vec<f64> {
        let tractions: Vec<Vector2<f64>> = responses.iter().map(|r| r.traction).collect();
        let forces = self.forces_beyond(joints.interface, &tractions, at);
        self.condensate.displacements(&self.condensate.pulled(b, &forces))
    }

    /// r - D_0 j [N] of the joints' tractions.
    fn forces_beyond(&self, interface: &Interface, tractions: &[Vector2<f64>], jumps: &[f64]) -> Vec<f64> {
        if self.closed.is_empty() {
            return interface.forces(tractions.iter().copied());
        }
        let points = interface.points.iter().zip(tractions).zip(self.closed.iter());
        interface.forces(points.map(|((p, traction), d_0)| traction - d_0 * interface.local(p, jumps)))
    }

    /// How far the jumps are from those of the displacements that the joints' forces make, as the force that would
    /// bring them there over the largest force; 0 where round-off leaves them no more digits.
    pub(super) fn misfit(&self, problem: &Problem, Branches { at, responses }: &Branches, border: &[f64]) -> f64 {
        let apart = self.apart(at, border);
        if norm(&apart) <= ROUND_OFF * norm(border) {
            return 0.;
        }
        let tractions: Vec<Vector2<f64>> = responses.iter().map(|r| r.traction).collect();
        let at_most = self.condensate.norm * norm(&apart);
        let scale = self.scale(problem, &tractions, at_most / self.options.tolerance);
        let least = at_most / scale;
        if least <= self.options.tolerance { least } else { norm(&self.condensate.forces(&apart)) / scale }
    }

    /// D - D_0 of every point for Newton's matrix [Pa/m].
    pub(super) fn tangents(&self, responses: &[Response]) -> Vec<Matrix2<f64>> {
        responses.iter().enumerate().map(|(i, r)| r.tangent - self.reference(i)).collect()
    }

    /// D_0 of a point [Pa/m].
    pub(super) fn reference(&self, point: usize) -> Matrix2<f64> {
        self.closed.get(point).copied().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::case::Integration;
    use crate::model::mesh::{Mesh, Shape};
    use crate::model::split::{Joint, Pair};
    use crate::physics::joint::{Friction, JointLaw};
    use crate::solve::interface::JointState;
    use crate::solve::unknowns::Unknowns;
    use crate::sparse::{Orders, Symbolic};
    use sprs::TriMat;

    /// Stiffness of each node of ground and body [N/m], and forces on them [N].
    const GROUND: f64 = 3.;
    const BODY: f64 = 2.;
    /// the two springs in a row
    const BOTH: f64 = GROUND * BODY / (GROUND + BODY);
    const TOLERANCE: Newton = Newton { tolerance: 1e-8, max_iterations: 30 };

    fn law(normal_stiffness: f64, friction: f64) -> JointLaw {
        let friction = Friction::Coulomb(friction);
        JointLaw { normal_stiffness, tangential_stiffness: normal_stiffness / 2., friction, gap: 0. }
    }

    /// A joint of length 2 along the x axis, ground below and body above, each end between two nodes on springs; the
    /// bodies' nodes carry `force`. Returns what its first end does, solved for again and again; before that the inverse
    /// may be `worn` by a factor.
    fn settled_with<const N: usize>(
        law: JointLaw,
        force: [f64; 2],
        worn: [Option<f64>; N],
    ) -> [(Vector2<f64>, Response); N] {
        let mesh = Mesh { points: vec![[0., 0.], [2., 0.], [0., 0.], [2., 0.]], ..Mesh::default() };
        let pairs = [0, 1].map(|n| Pair { ground: n, body: 2 + n });
        // anticlockwise round the body above
        let joint = Joint { seam: 0, shape: Shape::Line2, pairs: vec![0, 1], ground_cell: 0, body_cell: 0 };
        let unknowns = Unknowns::new(&mesh, &[[false; 2]; 4], &pairs, &Orders::default()).expect("a small graph");
        let interface = Interface::new(&mesh, &pairs, &[joint], &[(law, Integration::Lobatto)], &unknowns.jumps);
        let mut springs = TriMat::new((unknowns.count, unknowns.count));
        let mut b = vec![0.; unknowns.count];
        for i in 0..unknowns.count {
            let on_body = unknowns.node_of(i) >= 2;
            springs.add_triplet(i, i, if on_body { BODY } else { GROUND });
            let axis = usize::from(unknowns.of(unknowns.node_of(i), 1) == Some(i));
            b[i] = if on_body { force[axis] } else { 0. };
        }
        let springs = springs.to_csr();
        let factor = Symbolic::new(&springs).factor(&springs).expect("springs are positive");
        let condensate = Arc::new(Condensate::new(&factor, &unknowns, false));
        let old = [JointState::default(); 2];
        let joints = Joints { interface: &interface, old: &old, damping: None };
        let (free, still) = (condensate.jumps(&condensate.displacements(&b)), [0.; 4]);
        let problem =
            Problem { joints: &joints, b: &b, free: &free, last: &still, expected: &still, largest_force: 0. };
        let mut contact = Contact::new(condensate, [].into(), TOLERANCE);
        worn.map(|worn| {
            worn.into_iter().for_each(|by| contact.inverse.wear(by));
            let solution = contact.newton(&problem, &still).expect("no statuses run in a circle here");
            let jump = interface.local(&interface.points[0], &solution.jumps);
            let in_place = [0, 1]
                .map(|axis| unknowns.jumps[0][axis].iter().map(|&(place, s)| s * solution.jumps[place]).sum::<f64>());
            let ends = [0, 2].map(|node| unknowns.at_node(&solution.border, node));
            let apart = (0..2).map(|axis| ends[0][axis] - ends[1][axis] - in_place[axis]);
            assert!(apart.into_iter().all(|apart| apart.abs() < 1e-14), "jump of the ends");
            (jump, solution.responses[0])
        })
    }

    fn settled(law: JointLaw, force: [f64; 2]) -> (Vector2<f64>, Response) {
        let [once] = settled_with(law, force, [None]);
        once
    }

    /// Each of its steps goes nine tenths of the way, and says that nothing is missed; only the displacements of both
    /// sides show that it is.
    #[test]
    fn an_inverse_that_is_worn_is_made_again() {
        let [fresh, worn] = settled_with(law(5., 0.9), [0.1, -1.], [None, Some(0.9)]);
        // round-off, as above; with the worn one a thousandth of the way would be left after all retries
        assert!((fresh.0 - worn.0).norm() < 1e-15 && (fresh.1.traction - worn.1.traction).norm() < 1e-14);
    }

    /// Pressed on with 1 N and pushed by .1 N: springs in a row, kappa (area 1 m2) beside both others' S, j_0 = -F /
    /// k_body.
    #[test]
    fn a_sticking_joint_is_a_spring_between_two() {
        let (jump, response) = settled(law(5., 0.9), [0.1, -1.]);
        assert_eq!(response.status, Status::Stick);
        let free = -1. / BODY;
        let exact = BOTH * free / (BOTH + 5.);
        // round-off of a few operations on numbers about 1
        assert!((jump[1] - exact).abs() < 1e-15 && (response.traction[1] - 5. * exact).abs() < 1e-15, "{jump} {exact}");
        let sideways = BOTH * (0.1 / BODY) / (BOTH + 2.5);
        assert!((jump[0].abs() - sideways).abs() < 1e-15, "{jump} {sideways}");
    }

    #[test]
    fn a_slipping_joint_carries_friction_times_pressure() {
        let (jump, response) = settled(law(5., 0.3), [1., -1.]);
        assert!(response.status.is_slipping());
        let pressure = 5. * BOTH * (1. / BODY) / (BOTH + 5.);
        assert!((response.traction[1] + pressure).abs() < 1e-15);
        assert!((response.traction[0].abs() - 0.3 * pressure).abs() < 1e-15);
        // what the springs let it slip: S (j_0 - j) is the friction
        assert!((jump[0].abs() - (1. / BODY - 0.3 * pressure / BOTH)).abs() < 1e-15);
    }

    #[test]
    fn an_open_joint_leaves_both_sides_alone() {
        let (jump, response) = settled(law(5., 0.3), [1., 1.]);
        assert_eq!(response.status, Status::Open);
        assert_eq!(response.traction, Vector2::zeros());
        assert!((jump[1] - 1. / BODY).abs() < 1e-15 && (jump[0].abs() - 1. / BODY).abs() < 1e-15);
    }

    /// On the way from the free jumps 12 digits cancel: only the second start, from near the solution, has them.
    #[test]
    fn a_joint_stiff_as_glue_has_the_traction_of_glue() {
        let (_, response) = settled(law(1e12, 0.9), [0.1, -1.]);
        assert_eq!(response.status, Status::Stick);
        let glued = BOTH / BODY;
        // S / kappa = 1e-12 softer than glue, and the round-off of S (j - j_0)
        assert!((response.traction[1] + glued).abs() < 1e-11, "{}", response.traction[1] + glued);
        assert!((response.traction[0].abs() - 0.1 * glued).abs() < 1e-11);
    }
}
