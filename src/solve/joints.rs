//! What the joints answer to jumps in one step: r(j) is piecewise linear, and a branch is the piece that a point is on.

use super::interface::{Interface, JointPoint, JointState};
use crate::physics::joint::{Friction, JointLaw, Response, Status};
use nalgebra::Vector2;

/// The joints between two states.
pub struct Joints<'a> {
    pub interface: &'a Interface,
    pub old: &'a [JointState],
    pub damping: Option<JointDamping<'a>>,
}

/// Damping of the joints, C(U) of eq. (16): beside each spring a dashpot of beta times its stiffness.
///
/// It carries no more than the springs left at the last state: p across the joint, f p - |tau| along it. So an open
/// joint has none, a slipping one none along it, and no status enters, which round-off decides on the edge of slip.
#[derive(Debug, Clone, Copy)]
pub struct JointDamping<'a> {
    pub beta: f64,
    /// length of the step [s]
    pub dt: f64,
    /// jumps of the last state [m]
    pub last: &'a [f64],
}

impl Joints<'_> {
    /// Every point's answer; with `bounds` [Pa] under Tresca's law.
    pub fn respond(&self, jumps: &[f64], bounds: Option<&[f64]>) -> Vec<Response> {
        let points = self.interface.points.iter().zip(self.old).enumerate();
        points
            .map(|(i, (point, old))| {
                let friction = bounds.map_or(point.law.friction, |b| Friction::Tresca(b[i]));
                let law = JointLaw { friction, ..point.law };
                let jump = self.interface.local(point, jumps);
                let elastic = law.respond(jump, old.slip);
                self.damping.map_or(elastic, |damping| {
                    let last = self.interface.local(point, damping.last);
                    damping.add_to(elastic, point, old.slip, [last, jump])
                })
            })
            .collect()
    }

    /// f p at every point [Pa], p the elastic pressure.
    pub fn bounds(&self, jumps: &[f64]) -> Vec<f64> {
        let points = self.interface.points.iter().zip(self.old);
        points.map(|(p, old)| limit(p, p.law.respond(self.interface.local(p, jumps), old.slip).traction)).collect()
    }

    /// The branches of r that the joints are on with these jumps [m].
    pub fn branches(&self, jumps: &[f64]) -> Branches {
        Branches { at: jumps.to_vec(), responses: self.respond(jumps, None) }
    }

    /// Tractions [Pa] on the straight lines that go on from the branches.
    pub fn on_lines(&self, branches: &Branches, jumps: &[f64]) -> Vec<Vector2<f64>> {
        let moved: Vec<f64> = jumps.iter().zip(&branches.at).map(|(j, at)| j - at).collect();
        let points = branches.responses.iter().zip(&self.interface.points);
        points.map(|(r, point)| r.traction + r.tangent * self.interface.local(point, &moved)).collect()
    }
}

impl JointDamping<'_> {
    /// Adds beta kappa (j - j_last) / dt, cut to what was left. The mean rate of the step is taken and not Newmark's at
    /// its end: that one keeps the speed of an impact for ever, with changing sign, and beta times a stiff joint makes
    /// a large force of it.
    fn add_to(&self, elastic: Response, point: &JointPoint, slip: f64, [last, new]: [Vector2<f64>; 2]) -> Response {
        let springs = point.law.respond(last, slip).traction;
        let left = [limit(point, springs) - springs[0].abs(), -springs[1]];
        let closed = point.law.closed_stiffness();
        let mut damped = elastic;
        for (i, left) in left.into_iter().enumerate() {
            let dashpot = self.beta / self.dt * closed[(i, i)];
            let free = dashpot * (new[i] - last[i]);
            let carries = free.abs() < left;
            damped.traction[i] += if carries { free } else { left.max(0.).copysign(free) };
            damped.tangent[(i, i)] += if carries { dashpot } else { 0. };
        }
        damped
    }
}

/// f p of a point [Pa], p the pressure of its springs' traction.
fn limit(point: &JointPoint, springs: Vector2<f64>) -> f64 {
    match point.law.friction {
        Friction::Tresca(bound) => bound,
        Friction::Coulomb(f) => f * -springs[1],
    }
}

/// What every joint point answers to some jumps, and along which line it goes on from there.
#[derive(Debug, Clone)]
pub struct Branches {
    /// the jumps [m]
    pub at: Vec<f64>,
    pub responses: Vec<Response>,
}

impl Branches {
    pub fn statuses(&self) -> Vec<Status> {
        self.responses.iter().map(|r| r.status).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::interface::testing::{LAW, along};
    use super::*;

    /// kappa_n = 50, kappa_s = 20 Pa/m, f = 0.3
    const DAMPING: f64 = 0.4;
    const DT: f64 = 0.1;

    /// What the first point of a joint along x answers, the body above it: jumps (tangential, normal) there.
    fn answer(slip: f64, last: [f64; 2], new: [f64; 2]) -> Response {
        let interface = along(&[[0., 0.], [1., 0.]], &[LAW]);
        let global = |[s, n]: [f64; 2]| {
            let rotation = interface.points[0].rotation();
            let jump = rotation.transpose() * Vector2::new(s, n);
            [jump[0], jump[1], jump[0], jump[1]]
        };
        let [last, new] = [last, new].map(global);
        let damping = JointDamping { beta: DAMPING, dt: DT, last: &last };
        let old = [JointState { slip, ..JointState::default() }; 2];
        Joints { interface: &interface, old: &old, damping: Some(damping) }.respond(&new, None)[0]
    }

    /// p = 50 Pa, tau = 2 Pa: 50 Pa and 13 Pa are left; beta / dt = 4, so that the dashpots have 200 and 80 Pa s/m
    /// over dt.
    #[test]
    fn a_dashpot_carries_beta_kappa_times_the_mean_rate_but_no_more_than_the_springs_left() {
        let added = |new: [f64; 2]| {
            let springs = LAW.respond(Vector2::from(new), 0.).traction;
            answer(0., [0.1, -1.], new).traction - springs
        };
        let cases = [
            ([0.15, -1.1], [4., -20.]),
            ([0.2, -0.8], [8., 40.]),
            ([0.9, -0.5], [13., 50.]),
            ([-0.9, -1.5], [-13., -50.]),
            ([0.9, 0.5], [13., 50.]),
        ];
        for (new, expected) in cases {
            // round-off of numbers below 100
            assert!((added(new) - Vector2::from(expected)).norm() < 1e-12, "{new:?}: {}", added(new));
        }
    }

    #[test]
    fn a_joint_that_was_open_has_no_dashpot_and_one_that_slipped_none_along_it() {
        let new = [0.3, -0.9];
        let springs = LAW.respond(Vector2::from(new), -0.2).traction;
        assert_eq!(answer(-0.2, [0.1, 0.2], new).traction, springs);
        let slipped = answer(-0.2, [0.6, -1.], new).traction - springs;
        // 15 Pa of friction less 16 of the spring, and 200 Pa/m times 0.1 m
        assert!(slipped[0] == 0. && (slipped[1] - 20.).abs() < 1e-12, "{slipped}");
    }

    /// The last state moved by round-off, 1e-12, about the edges of slip and of opening: the traction follows by the
    /// stiffest dashpot, 200 Pa/m and as much again through the springs, times that. A dashpot that follows the status
    /// jumps there by 80 Pa/m times 0.5 m.
    #[test]
    fn no_traction_jumps_where_the_last_state_goes_over_an_edge() {
        for edge in [[0.75, -1.], [-0.75, -1.], [0., 0.]] {
            for sideways in [-1e-12, 0., 1e-12] {
                for across in [-1e-12, 0., 1e-12] {
                    let moved = [edge[0] + sideways, edge[1] + across];
                    let new = [edge[0] - 0.5, edge[1] - 0.2];
                    let difference = answer(0., moved, new).traction - answer(0., edge, new).traction;
                    assert!(difference.norm() < 1e-9, "{edge:?} {moved:?}: {difference}");
                }
            }
        }
    }

    /// Each piece is linear, so a one-sided quotient is exact to round-off over the step: 1e-14 / 1e-7.
    #[test]
    fn the_tangent_with_damping_meets_its_difference_quotient_on_every_piece() {
        let h = 1e-7;
        for new in [[0.15, -1.1], [0.3, -0.9], [0.9, -0.5], [-0.9, -1.5], [0.9, 0.5], [0.1, 0.01]] {
            let here = answer(0., [0.1, -1.], new);
            for k in 0..2 {
                let mut moved = new;
                moved[k] += h;
                let quotient = (answer(0., [0.1, -1.], moved).traction - here.traction) / h;
                assert!((quotient - here.tangent.column(k)).norm() < 1e-5, "{new:?} {quotient} {}", here.tangent);
            }
        }
    }
}
