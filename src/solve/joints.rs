//! What the joints answer to jumps in one step: r(j) is piecewise linear, and a branch is the piece that a point is on.

use super::interface::{Interface, JointPoint, JointState};
use super::newmark::Constants;
use crate::physics::joint::{Friction, JointLaw, Response, Status};
use nalgebra::{Matrix2, Vector2};

/// The joints between two states.
pub struct Joints<'a> {
    pub interface: &'a Interface,
    pub old: &'a [JointState],
    pub damping: Option<JointDamping>,
}

/// Damping of the joints, C(U) of eq. (16): beta times the stiffness of what was closed acts on the jump's rate.
#[derive(Debug, Clone)]
pub struct JointDamping {
    pub beta: f64,
    pub constants: Constants,
    /// -a1 j - a4 j' - a5 j'' of the last state: the rate is a1 j(new) plus this
    pub rate_offset: Vec<f64>,
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
                match &self.damping {
                    None => elastic,
                    Some(damping) => {
                        let offset = self.interface.local(point, &damping.rate_offset);
                        damping.add_to(elastic, &law, old.status, jump * damping.constants.a1 + offset)
                    }
                }
            })
            .collect()
    }

    /// f p at every point [Pa], p the elastic pressure.
    pub fn bounds(&self, jumps: &[f64]) -> Vec<f64> {
        let limit = |(point, old): (&JointPoint, &JointState)| match point.law.friction {
            Friction::Tresca(bound) => bound,
            Friction::Coulomb(f) => f * -point.law.respond(self.interface.local(point, jumps), old.slip).traction[1],
        };
        self.interface.points.iter().zip(self.old).map(limit).collect()
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

impl JointDamping {
    /// Adds beta D rate, D the stiffness that the last step's status left: all of it sticking, the normal part
    /// slipping, none open. The status of this step would make the force jump where a joint opens, and leave no
    /// equilibrium there.
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
