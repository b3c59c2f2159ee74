//! How a state follows from the last one: Newmark's method, its variant of Hilber, Hughes and Taylor (1977), or
//! equilibrium without inertia.
//!
//! M a + (1 + alpha)(C v + K u) - alpha (C v + K u)_t + r(j) = (1 + alpha) f - alpha f_t, everything without index at
//! the new time, joint forces too; alpha = 0 is Newmark's method. K* = a0 M + (1 + alpha)(a1 C + K).

use super::joints::JointDamping;
use super::newmark::Constants;
use super::system::{State, System, combine};
use crate::model::case::Integrator;
use crate::sparse::multiply;
use sprs::CsMat;

/// What a step solves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scheme {
    /// K u + r(j) = f
    Static,
    Dynamic(Integrator),
}

/// A scheme with a length of step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    Static {
        /// [s]
        dt: f64,
    },
    Dynamic(Dynamic),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dynamic {
    constants: Constants,
    /// alpha of Hilber, Hughes and Taylor, from -1/3 to 0
    hht: f64,
}

impl Law {
    pub fn new(scheme: Scheme, dt: f64) -> Law {
        match scheme {
            Scheme::Static => Law::Static { dt },
            Scheme::Dynamic(Integrator { newmark, hht }) => {
                Law::Dynamic(Dynamic { constants: Constants::new(newmark, dt), hht })
            }
        }
    }

    /// [s]
    pub fn dt(&self) -> f64 {
        match self {
            Law::Static { dt } => *dt,
            Law::Dynamic(dynamic) => dynamic.constants.dt,
        }
    }

    /// (u [m], v [m/s], a [m/s^2]) of an unknown from its new displacement and what they were before.
    #[inline(always)]
    pub fn follow(&self, u: f64, before: [f64; 3]) -> [f64; 3] {
        match self {
            Law::Static { .. } => [u, 0., 0.],
            Law::Dynamic(Dynamic { constants, .. }) => {
                let a = constants.acceleration(u, before);
                [u, constants.velocity(a, before), a]
            }
        }
    }

    /// What M and C are multiplied by in an unknown for the next right-hand side: a0 u + a2 v + a3 a, and
    /// (1 + alpha)(a1 u + a4 v + a5 a) + alpha v.
    #[inline(always)]
    pub fn onward(&self, motion: [f64; 3]) -> [f64; 2] {
        match self {
            Law::Static { .. } => [0.; 2],
            Law::Dynamic(Dynamic { constants, hht }) => {
                [constants.for_mass(motion), (1. + hht) * constants.for_damping(motion) + hht * motion[1]]
            }
        }
    }

    /// What else stands on the right-hand side, (unknown, force [N]), but for what acts at all times:
    /// (1 + alpha) f - alpha f_t + alpha K u, the free field's forces among f.
    pub fn forces(&self, system: &System, old: &State, free_field: &[State]) -> Vec<(usize, f64)> {
        let new_time = old.time + self.dt();
        let Law::Dynamic(Dynamic { hht, .. }) = *self else { return system.passing_load(new_time) };
        let at_new_time = system.passing_load(new_time).into_iter().chain(system.free_field_force(free_field));
        let mut forces: Vec<(usize, f64)> = weighted(1. + hht, at_new_time).collect();
        forces.extend(system.free_field_inertia(free_field));
        if hht != 0. {
            forces.extend(weighted(-hht, system.passing_load(old.time)));
            forces.extend(weighted(-hht, system.free_field_force(&old.free_field)));
            let elastic = multiply(&system.stiffness, system.displacements(&old.q));
            forces.extend(weighted(hht, elastic.into_iter().enumerate()));
        }
        forces
    }

    /// Where the jumps are going: j + dt j'; without inertia where they are. The acceleration of a point that has just
    /// changed its status changes its sign from step to step: it would foresee changes that do not come.
    pub fn expected_jumps(&self, system: &System, old: &State) -> Vec<f64> {
        let [q, v] = [&old.q, &old.v].map(|x| system.jumps(x));
        match self {
            Law::Static { .. } => q.to_vec(),
            Law::Dynamic(dynamic) => q.iter().zip(v).map(|(q, v)| q + dynamic.constants.dt * v).collect(),
        }
    }

    /// The joints' own damping in a step from the old state, where the case asks for it.
    pub fn joint_damping<'a>(&self, system: &System, old: &'a State) -> Option<JointDamping<'a>> {
        match self {
            Law::Static { .. } => None,
            Law::Dynamic(_) => {
                Some(JointDamping { beta: system.joint_beta?, dt: self.dt(), last: system.jumps(&old.q) })
            }
        }
    }
}

fn weighted(weight: f64, forces: impl IntoIterator<Item = (usize, f64)>) -> impl Iterator<Item = (usize, f64)> {
    forces.into_iter().map(move |(i, f)| (i, weight * f))
}

impl Dynamic {
    /// K* [N/m].
    pub fn matrix(&self, system: &System) -> CsMat<f64> {
        let Dynamic { constants, hht } = self;
        combine(&[
            (1. + hht, &system.stiffness),
            (constants.a0, &system.mass),
            ((1. + hht) * constants.a1, &system.damping),
        ])
    }
}
