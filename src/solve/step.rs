//! One step in time: Newmark's method, its variant of Hilber, Hughes and Taylor (1977), or equilibrium without inertia.
//!
//! M a + (1 + alpha)(C v + K u) - alpha (C v + K u)_t + r(j) = (1 + alpha) f - alpha f_t, everything without index at the new
//! time, joint forces too; alpha = 0 is Newmark's method. K* = a0 M + (1 + alpha)(a1 C + K).

use super::condensed::{Condensed, Reference, Settled};
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
pub struct Stepper {
    law: Law,
    condensed: Condensed,
    /// the same for each column beyond a free-field side
    columns: Vec<Stepper>,
}

/// How a state follows from the last one.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Law {
    Static {
        /// [s]
        dt: f64,
    },
    Dynamic(Dynamic),
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Dynamic {
    constants: Constants,
    /// alpha of Hilber, Hughes and Taylor, from -1/3 to 0
    hht: f64,
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
                Ok(Stepper { law: Law::Static { dt }, condensed, columns: vec![] })
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
                Ok(Stepper { law: Law::Dynamic(Dynamic { constants, hht }), condensed, columns })
            }
        }
    }

    /// For a system that differs in loads and friction only: the factor is the same.
    pub fn sharing_factor(&self) -> Stepper {
        Stepper {
            law: self.law,
            condensed: self.condensed.sharing_factor(),
            columns: self.columns.iter().map(Stepper::sharing_factor).collect(),
        }
    }

    /// From one state to the next; the old one is not touched.
    pub fn step(&mut self, system: &System, old: &State) -> Result<Step, Unsettled> {
        let Prepared { mut x, free_field } = self.prepare(system, old)?;
        self.condensed.factor().condense(&mut x);
        let settled = self.settle(system, &mut x, old)?;
        self.condensed.factor().expand(&mut x);
        Ok(self.complete(x, free_field, settled, old))
    }

    /// What is solved for, before the forward sweep.
    fn prepare(&mut self, system: &System, old: &State) -> Result<Prepared, Unsettled> {
        let free_field = self.free_field(system, old)?;
        let x = match self.law {
            Law::Static { dt } => system.load(old.time + dt),
            Law::Dynamic(dynamic) => dynamic.right_hand_side(system, old, &free_field),
        };
        Ok(Prepared { x, free_field })
    }

    /// Between the sweeps.
    fn settle(&mut self, system: &System, x: &mut [f64], old: &State) -> Result<Settled, Unsettled> {
        let damping = match self.law {
            Law::Static { .. } => None,
            Law::Dynamic(dynamic) => dynamic.joint_damping(system, old),
        };
        self.condensed.settle(system, x, system.jumps(&old.q), &old.joints, damping)
    }

    /// After the backward sweep.
    fn complete(&self, q: Vec<f64>, free_field: Vec<State>, settled: Settled, old: &State) -> Step {
        let Settled { joints, iterations, displacement_test } = settled;
        let state = match self.law {
            Law::Static { dt } => {
                let zero = vec![0.; q.len()];
                State { time: old.time + dt, q, v: zero.clone(), a: zero, joints, free_field }
            }
            Law::Dynamic(Dynamic { constants, .. }) => {
                let before = |i: usize| [old.q[i], old.v[i], old.a[i]];
                let a: Vec<f64> = (0..q.len()).map(|i| constants.acceleration(q[i], before(i))).collect();
                let v = (0..q.len()).map(|i| constants.velocity(a[i], before(i))).collect();
                State { time: old.time + constants.dt, q, v, a, joints, free_field }
            }
        };
        Step { state, iterations, displacement_test }
    }

    /// The columns beyond free-field sides, which know nothing of the model, one step later.
    fn free_field(&mut self, system: &System, old: &State) -> Result<Vec<State>, Unsettled> {
        let columns = system.columns.iter().zip(&mut self.columns).zip(&old.free_field);
        columns.map(|((column, stepper), old)| Ok(stepper.step(&column.system, old)?.state)).collect()
    }
}

/// A right-hand side, and the states of the columns that it took.
struct Prepared {
    x: Vec<f64>,
    free_field: Vec<State>,
}

impl Dynamic {
    /// (1 + alpha) f - alpha f_t + M (a0 q + a2 v + a3 a) + (1 + alpha) C (a1 q + a4 v + a5 a) + alpha (C v + K q).
    fn right_hand_side(&self, system: &System, old: &State, free_field: &[State]) -> Vec<f64> {
        let time = old.time + self.constants.dt;
        let before = |i: usize| [old.q[i], old.v[i], old.a[i]];
        let weight = 1. + self.hht;
        let for_mass = |i: usize| self.constants.for_mass(before(i));
        let for_damping = |i: usize| weight * self.constants.for_damping(before(i)) + self.hht * old.v[i];
        let for_both: Vec<[f64; 2]> = (0..old.q.len()).map(|i| [for_mass(i), for_damping(i)]).collect();
        let Products { pattern, mass, damping, .. } = &*system.products;
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

/// A step of several systems that share one factor: L is read once for all of them, and each gets the digits that it
/// gets alone.
///
/// # Panics
/// If there are not as many steppers, systems and old states.
pub fn step_together(
    steppers: &mut [&mut Stepper],
    systems: &[&System],
    old: &[&State],
) -> Vec<Result<Step, Unsettled>> {
    match steppers.len() {
        0 => vec![],
        1 => vec![steppers[0].step(systems[0], old[0])],
        2 => lanes::<2>(steppers, systems, old),
        3 | 4 => lanes::<4>(steppers, systems, old),
        _ => lanes::<8>(steppers, systems, old),
    }
}

/// Most systems that [`step_together`] takes at once.
pub const MOST_TOGETHER: usize = 8;

fn lanes<const K: usize>(
    steppers: &mut [&mut Stepper],
    systems: &[&System],
    old: &[&State],
) -> Vec<Result<Step, Unsettled>> {
    let cases = steppers.len();
    assert!(cases == systems.len() && cases == old.len() && cases <= K, "a stepper, a system and a state each");
    let mut lanes = vec![[0.; K]; systems[0].unknowns.count];
    let prepared: Vec<_> = (0..cases).map(|k| steppers[k].prepare(systems[k], old[k])).collect();
    for (k, prepared) in prepared.iter().enumerate() {
        if let Ok(prepared) = prepared {
            lanes.iter_mut().zip(&prepared.x).for_each(|(lane, x)| lane[k] = *x);
        }
    }
    steppers[0].condensed.factor().condense_lanes(&mut lanes);
    let first = systems[0].unknowns.first_jump;
    let settled: Vec<_> = prepared
        .into_iter()
        .enumerate()
        .map(|(k, prepared)| {
            let Prepared { mut x, free_field } = prepared?;
            lanes[first..].iter().zip(&mut x[first..]).for_each(|(lane, x)| *x = lane[k]);
            let settled = steppers[k].settle(systems[k], &mut x, old[k])?;
            lanes[first..].iter_mut().zip(&x[first..]).for_each(|(lane, x)| lane[k] = *x);
            Ok((x, free_field, settled))
        })
        .collect();
    steppers[0].condensed.factor().expand_lanes(&mut lanes);
    let complete = |(k, settled): (usize, Result<_, Unsettled>)| {
        let (mut x, free_field, settled): (Vec<f64>, _, _) = settled?;
        lanes.iter().zip(&mut x).for_each(|(lane, x)| *x = lane[k]);
        Ok(steppers[k].complete(x, free_field, settled, old[k]))
    };
    settled.into_iter().enumerate().map(complete).collect()
}
