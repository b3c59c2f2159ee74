//! The joint between body and ground: closed or open, sticking or slipping by Coulomb's law.
//!
//! Local axes (tangential s, normal n), n from the body into the ground. The jump is ground minus body, so a positive
//! normal jump opens the joint. Tractions are tension positive: pressure p = -sigma_n.

use super::material::Material;
use nalgebra::{Matrix2, Vector2};

/// What limits the shear traction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Friction {
    /// |tau| <= f p, f the coefficient [-]
    Coulomb(f64),
    /// |tau| <= bound [Pa]; the inner problem of the fixed point on f p
    Tresca(f64),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointLaw {
    /// normal stiffness kappa_n [Pa/m]
    pub normal_stiffness: f64,
    /// tangential stiffness kappa_s [Pa/m]
    pub tangential_stiffness: f64,
    pub friction: Friction,
    /// opening before any load [m]
    pub gap: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Status {
    Open,
    #[default]
    Stick,
    /// the ground slips towards +s
    SlipForward,
    /// the ground slips towards -s
    SlipBackward,
}

impl Status {
    pub fn is_open(self) -> bool {
        self == Status::Open
    }

    pub fn is_slipping(self) -> bool {
        matches!(self, Status::SlipForward | Status::SlipBackward)
    }
}

/// The law's answer to a jump.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// (tau, sigma_n) [Pa]
    pub traction: Vector2<f64>,
    /// d traction / d jump [Pa/m]; unsymmetric where it slips under Coulomb's law
    pub tangent: Matrix2<f64>,
    pub status: Status,
    /// plastic slip afterwards [m]
    pub slip: f64,
}

impl JointLaw {
    /// A layer of thickness t of the ground: kappa_n = E_oed / t, kappa_s = G / t, eq. (9) with (13).
    pub fn of_layer(ground: &Material, thickness: f64, friction: f64) -> Self {
        JointLaw {
            normal_stiffness: ground.oedometric_modulus() / thickness,
            tangential_stiffness: ground.shear_modulus() / thickness,
            friction: Friction::Coulomb(friction),
            gap: 0.,
        }
    }

    /// Implicit return mapping from the plastic slip of the last converged step.
    ///
    /// p = <-kappa_n (g_n + gap)>; trial tau = kappa_s (g_s - slip), cut to the limit, which is zero where the joint is
    /// open: so an open joint carries nothing and forgets its slip.
    pub fn respond(&self, jump: Vector2<f64>, slip: f64) -> Response {
        let opening = jump[1] + self.gap;
        let pressure = (-self.normal_stiffness * opening).max(0.);
        let (limit, limit_per_pressure) = match self.friction {
            Friction::Coulomb(f) => (f * pressure, f),
            Friction::Tresca(bound) => (bound, 0.),
        };
        let trial = self.tangential_stiffness * (jump[0] - slip);
        let closed = opening <= 0.;
        // An open joint under Coulomb's law has no limit to stick within, not even where trial = 0.
        let sticks = trial.abs() <= limit && (closed || limit > 0.);
        let tau = if sticks { trial } else { limit.copysign(trial) };
        let kn = if closed { self.normal_stiffness } else { 0. };
        let tangent = match (sticks, closed) {
            (true, _) => Matrix2::new(self.tangential_stiffness, 0., 0., kn),
            // tau = limit(p) sgn(trial), dp/dg_n = -kappa_n
            (false, _) => Matrix2::new(0., -limit_per_pressure * kn * trial.signum(), 0., kn),
        };
        let status = match (closed, sticks, trial > 0.) {
            (false, ..) => Status::Open,
            (true, true, _) => Status::Stick,
            (true, false, true) => Status::SlipForward,
            (true, false, false) => Status::SlipBackward,
        };
        Response {
            traction: Vector2::new(tau, -pressure),
            tangent,
            status,
            slip: if sticks { slip } else { jump[0] - tau / self.tangential_stiffness },
        }
    }

    /// Stiffness of a closed, sticking joint: diag(kappa_s, kappa_n) [Pa/m].
    pub fn closed_stiffness(&self) -> Matrix2<f64> {
        Matrix2::new(self.tangential_stiffness, 0., 0., self.normal_stiffness)
    }

    /// The same of a joint whose normal stiffness is `stiffest` [Pa/m] at most, the tangential one in proportion.
    pub fn closed_no_stiffer_than(&self, stiffest: f64) -> Matrix2<f64> {
        self.closed_stiffness() * (stiffest / self.normal_stiffness).min(1.)
    }

    /// Energy stored per area by a jump with plastic slip: kappa_n <-g_n>^2 / 2 + kappa_s (g_s - slip)^2 / 2 [J/m^2].
    pub fn stored_energy(&self, jump: Vector2<f64>, slip: f64) -> f64 {
        let closing = (jump[1] + self.gap).min(0.);
        (self.normal_stiffness * closing.powi(2) + self.tangential_stiffness * (jump[0] - slip).powi(2)) / 2.
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: JointLaw =
        JointLaw { normal_stiffness: 10., tangential_stiffness: 4., friction: Friction::Coulomb(0.3), gap: 0. };

    /// One jump in each status: open, stick, slip either way.
    const JUMPS: [([f64; 2], Status); 4] = [
        ([0.5, 0.2], Status::Open),
        ([0.1, -1.], Status::Stick),
        ([2., -1.], Status::SlipForward),
        ([-2., -1.], Status::SlipBackward),
    ];

    #[test]
    fn tractions_are_those_of_coulombs_law() {
        let tractions = [[0., 0.], [0.4, -10.], [3., -10.], [-3., -10.]];
        for ((jump, status), traction) in JUMPS.iter().zip(tractions) {
            let response = LAW.respond(Vector2::from(*jump), 0.);
            assert_eq!(response.status, *status);
            assert!((response.traction - Vector2::from(traction)).norm() < 1e-14);
        }
    }

    /// Each branch is linear, so a one-sided quotient is exact to round-off over the step: 1e-16 / 1e-7.
    #[test]
    fn the_tangent_meets_its_difference_quotient_in_every_status() {
        let h = 1e-7;
        for law in [LAW, JointLaw { friction: Friction::Tresca(1.), ..LAW }] {
            for (jump, _) in JUMPS {
                let jump = Vector2::from(jump);
                let here = law.respond(jump, 0.05);
                for k in 0..2 {
                    let mut moved = jump;
                    moved[k] += h;
                    let quotient = (law.respond(moved, 0.05).traction - here.traction) / h;
                    assert!((quotient - here.tangent.column(k)).norm() < 1e-6, "{:?}", here.status);
                }
            }
        }
    }

    #[test]
    fn an_open_joint_forgets_its_slip_and_remembers_its_gap() {
        let open = LAW.respond(Vector2::new(0.5, 0.2), 0.);
        assert_eq!(open.slip, 0.5);
        assert_eq!(LAW.respond(Vector2::new(0.5, 0.2), 0.5).tangent, Matrix2::zeros());
        assert_eq!(LAW.respond(Vector2::new(0.5, -0.1), open.slip).traction, Vector2::new(0., -1.));
        let apart = JointLaw { gap: 0.2, ..LAW };
        assert_eq!(apart.respond(Vector2::new(0., -0.1), 0.).status, Status::Open);
        assert!((apart.respond(Vector2::new(0., -0.3), 0.).traction[1] + 1.).abs() < 1e-14);
    }

    #[test]
    fn slip_keeps_the_elastic_part_that_carries_the_limit() {
        let slipped = LAW.respond(Vector2::new(2., -1.), 0.);
        assert!((slipped.slip - (2. - 3. / 4.)).abs() < 1e-14);
        let back = LAW.respond(Vector2::new(2., -1.), slipped.slip);
        assert_eq!(back.status, Status::Stick);
    }

    /// From jump to jump in a straight line, cut into equal steps.
    fn walked(from: [f64; 2], to: [f64; 2], slip: f64, steps: usize) -> Response {
        let [from, to] = [from, to].map(Vector2::from);
        let at = |k: usize| from + (to - from) * (k as f64 / steps as f64);
        (1..=steps).fold(LAW.respond(from, slip), |before, k| LAW.respond(at(k), before.slip))
    }

    /// The states within |tau| <= f p are convex: a straight line leaves them once, and then slips on to its end. So
    /// one step is exact while the joint stays closed, and where it opens. Round-off of 1000 sums.
    #[test]
    fn one_step_is_as_good_as_a_thousand_where_the_joint_was_closed() {
        let paths = [
            ([0., -1.], [2., -1.5]),   // sticks, then slips while the pressure grows
            ([0.7, -1.], [0.8, -0.2]), // slips because the pressure falls
            ([2., -1.], [1.2, -0.5]),  // slipped, goes back while the pressure falls
            ([2., -1.], [-2., -2.]),   // slips to the other side
            ([2., -1.], [2.5, 0.3]),   // slips, then opens
        ];
        for (from, to) in paths {
            let start = LAW.respond(Vector2::from(from), 0.).slip;
            let [once, often] = [1, 1000].map(|steps| walked(from, to, start, steps));
            assert_eq!(once.status, often.status);
            assert!((once.traction - often.traction).norm() < 1e-11, "{from:?} {to:?}");
            assert!((once.slip - often.slip).abs() < 1e-11, "{from:?} {to:?}");
        }
    }

    /// A joint that closes remembers where it stood at the last step and not where it touched: where it then sticks,
    /// what it moved along before it touched, theta of the step, is in its shear.
    #[test]
    fn a_joint_that_closes_counts_what_it_moved_before_it_touched() {
        let (from, to) = ([0., 0.25], [0.1, -0.75]);
        let theta = 0.25;
        let [once, often] = [1, 1000].map(|steps| walked(from, to, 0., steps));
        // the thousandth of a step in which it touches
        let of_a_substep = 0.1 / 1000.;
        assert_eq!([once.status, often.status], [Status::Stick; 2]);
        assert!((often.slip - once.slip - theta * 0.1).abs() < of_a_substep);
        assert!((once.traction[0] - often.traction[0] - 4. * theta * 0.1).abs() < 4. * of_a_substep);
        // one that slips from there on is on f p whatever it remembers
        let [once, often] = [1, 1000].map(|steps| walked(from, [2., -0.75], 0., steps));
        assert!((once.traction - often.traction).norm() < 1e-12 && (once.slip - often.slip).abs() < 1e-12);
    }

    /// The law is positively homogeneous of degree one: no scale of its own but the gap.
    #[test]
    fn tractions_scale_with_the_jump() {
        for (jump, _) in JUMPS {
            let jump = Vector2::from(jump);
            let difference = LAW.respond(jump * 8., 0.4).traction - LAW.respond(jump, 0.05).traction * 8.;
            assert!(difference.norm() < 1e-13);
        }
    }
}
