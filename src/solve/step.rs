//! One step in time: Newmark's method, its variant of Hilber, Hughes and Taylor (1977), or equilibrium without inertia.
//!
//! M a + (1 + alpha)(C v + K u) - alpha (C v + K u)_t + r(j) = (1 + alpha) f - alpha f_t, everything without index at the new
//! time, joint forces too; alpha = 0 is Newmark's method. K* = a0 M + (1 + alpha)(a1 C + K).

use super::condensed::{Condensed, Reference};
use super::contact::{JointDamping, Unsettled};
use super::free_field::Column;
use super::newmark::Constants;
use super::system::{Products, State, System, combine};
use crate::model::case::{Integrator, Newton};
use crate::sparse::vector::{add, add_at};
use crate::sparse::{NotPositiveDefinite, Symbolic, multiply};

/// What a step solves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scheme {
    /// K u + r(j) = f
    Static,
    Dynamic(Integrator),
}

/// Steps of one length, their matrix factored.
pub enum Stepper {
    Static { dt: f64, condensed: Condensed },
    Dynamic(Dynamic),
}

/// K* for one length of step.
pub struct Dynamic {
    constants: Constants,
    /// alpha of Hilber, Hughes and Taylor, from -1/3 to 0
    hht: f64,
    condensed: Condensed,
    /// the same for each column beyond a free-field side
    columns: Vec<Stepper>,
}

/// An accepted step.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    pub state: State,
    pub iterations: usize,
    /// the paper's test (19), on the jumps
    pub displacement_test: f64,
}

impl Stepper {
    pub fn new(
        system: &System,
        symbolic: &Symbolic,
        scheme: Scheme,
        dt: f64,
        options: Newton,
    ) -> Result<Stepper, NotPositiveDefinite> {
        match scheme {
            Scheme::Static => {
                let closed = system.closed_stiffness();
                let condensed = Condensed::new(system, symbolic, &closed, Reference::ClosedJoints, options)?;
                Ok(Stepper::Static { dt, condensed })
            }
            Scheme::Dynamic(Integrator { newmark, hht }) => {
                let constants = Constants::new(newmark, dt);
                let effective = combine(&[
                    (1. + hht, &system.stiffness),
                    (constants.a0, &system.mass),
                    ((1. + hht) * constants.a1, &system.damping),
                ]);
                let condensed = Condensed::new(system, symbolic, &effective, Reference::Bodies, options)?;
                let column = |c: &Column| Stepper::new(&c.system, &c.symbolic, scheme, dt, options);
                let columns = system.columns.iter().map(column).collect::<Result<_, _>>()?;
                Ok(Stepper::Dynamic(Dynamic { constants, hht, condensed, columns }))
            }
        }
    }

    /// From one state to the next; the old one is not touched.
    pub fn step(&mut self, system: &System, old: &State) -> Result<Step, Unsettled> {
        match self {
            Stepper::Dynamic(dynamic) => dynamic.step(system, old),
            Stepper::Static { dt, condensed } => {
                let time = old.time + *dt;
                let solved = condensed.solve(system, system.load(time), system.jumps(&old.q), &old.joints, None)?;
                let zero = vec![0.; solved.x.len()];
                Ok(Step {
                    state: State {
                        time,
                        q: solved.x,
                        v: zero.clone(),
                        a: zero,
                        joints: solved.joints,
                        free_field: vec![],
                    },
                    iterations: solved.iterations,
                    displacement_test: solved.displacement_test,
                })
            }
        }
    }
}

impl Dynamic {
    fn step(&mut self, system: &System, old: &State) -> Result<Step, Unsettled> {
        let time = old.time + self.constants.dt;
        let free_field = self.free_field(system, old)?;
        let rhs = self.right_hand_side(system, old, time, &free_field);
        let damping = self.joint_damping(system, old);
        let solved = self.condensed.solve(system, rhs, system.jumps(&old.q), &old.joints, damping)?;

        let (q, before) = (solved.x, |i: usize| [old.q[i], old.v[i], old.a[i]]);
        let a: Vec<f64> = (0..q.len()).map(|i| self.constants.acceleration(q[i], before(i))).collect();
        let v = (0..q.len()).map(|i| self.constants.velocity(a[i], before(i))).collect();
        Ok(Step {
            state: State { time, q, v, a, joints: solved.joints, free_field },
            iterations: solved.iterations,
            displacement_test: solved.displacement_test,
        })
    }

    /// The columns beyond free-field sides, which know nothing of the model, one step later.
    fn free_field(&mut self, system: &System, old: &State) -> Result<Vec<State>, Unsettled> {
        let columns = system.columns.iter().zip(&mut self.columns).zip(&old.free_field);
        columns.map(|((column, stepper), old)| Ok(stepper.step(&column.system, old)?.state)).collect()
    }

    /// (1 + alpha) f - alpha f_t + M (a0 q + a2 v + a3 a) + (1 + alpha) C (a1 q + a4 v + a5 a) + alpha (C v + K q).
    fn right_hand_side(&self, system: &System, old: &State, time: f64, free_field: &[State]) -> Vec<f64> {
        let before = |i: usize| [old.q[i], old.v[i], old.a[i]];
        let weight = 1. + self.hht;
        let for_mass = |i: usize| self.constants.for_mass(before(i));
        let for_damping = |i: usize| weight * self.constants.for_damping(before(i)) + self.hht * old.v[i];
        let for_both: Vec<[f64; 2]> = (0..old.q.len()).map(|i| [for_mass(i), for_damping(i)]).collect();
        let Products { pattern, mass, damping, .. } = &system.products;
        let mut rhs = pattern.sum_of_products([mass, damping], &for_both);
        add(&mut rhs, 1., &system.load(time));
        add_at(&mut rhs, weight, &system.free_field_force(free_field));
        add_at(&mut rhs, 1., &system.free_field_inertia(free_field));
        if self.hht != 0. {
            let mut change = system.load(time);
            add(&mut change, -1., &system.load(old.time));
            add_at(&mut change, -1., &system.free_field_force(&old.free_field));
            add(&mut change, 1., &multiply(&system.stiffness, &old.q));
            add(&mut rhs, self.hht, &change);
        }
        rhs
    }

    fn joint_damping(&self, system: &System, old: &State) -> Option<JointDamping> {
        let [q, v, a] = [&old.q, &old.v, &old.a].map(|x| system.jumps(x));
        let offset = |i: usize| -self.constants.for_damping([q[i], v[i], a[i]]);
        system.joint_beta.map(|beta| JointDamping {
            beta,
            constants: self.constants,
            rate_offset: (0..q.len()).map(offset).collect(),
        })
    }
}
