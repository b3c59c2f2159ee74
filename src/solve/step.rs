//! One step in time: Newmark's method, its variant of Hilber, Hughes and Taylor (1977), or equilibrium without inertia.
//!
//! M a + (1 + alpha)(C v + K u) - alpha (C v + K u)_t + r(j) = (1 + alpha) f - alpha f_t, everything without index at the new
//! time, joint forces too; alpha = 0 is Newmark's method. K* = a0 M + (1 + alpha)(a1 C + K).

use super::condensed::Condensed;
use super::contact::Solution;
use super::energy::Forms;
use super::free_field::Column;
use super::interface::JointState;
use super::joints::{JointDamping, Joints};
use super::newmark::Constants;
use super::system::{Products, State, System, combine};
use super::unknowns::Unknowns;
use super::unsettled::Unsettled;
use crate::model::case::{Integrator, Newton};
use crate::sparse::vector::{add, add_at};
use crate::sparse::{MOST_LANES, NotPositiveDefinite, Symbolic, multiply, with_lanes_for};

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
    /// what its energies are made of
    pub forms: Forms,
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
                let condensed = Condensed::hanging(system, symbolic, options)?;
                Ok(Stepper { law: Law::Static { dt }, condensed, columns: vec![] })
            }
            Scheme::Dynamic(Integrator { newmark, hht }) => {
                let constants = Constants::new(newmark, dt);
                let effective = combine(&[
                    (1. + hht, &system.stiffness),
                    (constants.a0, &system.mass),
                    ((1. + hht) * constants.a1, &system.damping),
                ]);
                let condensed = Condensed::new(system, symbolic, &effective, options)?;
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
        step_together(&mut [self], &[system], &[old]).swap_remove(0)
    }

    /// Between the sweeps: from the condensed right-hand side at the border to the displacements there.
    fn settle(&mut self, system: &System, border: &[f64], old: &State) -> Result<Solution, Unsettled> {
        let last = system.jumps(&old.q);
        let (expected, damping) = match self.law {
            Law::Static { .. } => (last.to_vec(), None),
            Law::Dynamic(dynamic) => (dynamic.expected_jumps(system, old), dynamic.joint_damping(system, old)),
        };
        let joints = Joints { interface: &system.interface, old: &old.joints, damping };
        self.condensed.settle(border, joints, last, &expected)
    }

    /// After the backward sweep.
    fn complete(
        &self,
        unknowns: &Unknowns,
        q: Vec<f64>,
        free_field: Vec<State>,
        joints: Vec<JointState>,
        old: &State,
    ) -> State {
        match self.law {
            Law::Static { dt } => {
                let zero = vec![0.; q.len()];
                State { time: old.time + dt, q, v: zero.clone(), a: zero, joints, free_field }
            }
            Law::Dynamic(Dynamic { constants, .. }) => {
                let before = |i: usize| [old.q[i], old.v[i], old.a[i]];
                // Jumps that went on by themselves would drift off by the round-off of every step.
                let a = unknowns.vector(|i| constants.acceleration(q[i], before(i)));
                let v = unknowns.vector(|i| constants.velocity(a[i], before(i)));
                State { time: old.time + constants.dt, q, v, a, joints, free_field }
            }
        }
    }

    /// The columns beyond free-field sides, which know nothing of the model, one step later.
    fn free_field(&mut self, system: &System, old: &State) -> Result<Vec<State>, Unsettled> {
        let columns = system.columns.iter().zip(&mut self.columns).zip(&old.free_field);
        columns.map(|((column, stepper), old)| Ok(stepper.step(&column.system, old)?.state)).collect()
    }
}

impl Dynamic {
    /// What M and C are multiplied by in unknown i: a0 q + a2 v + a3 a and (1 + alpha)(a1 q + a4 v + a5 a) + alpha v.
    fn inertial(&self, old: &State, i: usize) -> [f64; 2] {
        let before = [old.q[i], old.v[i], old.a[i]];
        let for_damping = (1. + self.hht) * self.constants.for_damping(before) + self.hht * old.v[i];
        [self.constants.for_mass(before), for_damping]
    }

    /// (1 + alpha) f - alpha f_t + alpha K q, the free field's forces among f.
    fn forces(&self, system: &System, old: &State, free_field: &[State]) -> Vec<f64> {
        let mut f = system.load(old.time + self.constants.dt);
        let weight = 1. + self.hht;
        if self.hht != 0. {
            let mut change = f.clone();
            add(&mut change, -1., &system.load(old.time));
            add_at(&mut change, -1., &system.free_field_force(&old.free_field));
            add(&mut change, 1., &multiply(&system.stiffness, system.displacements(&old.q)));
            add(&mut f, self.hht, &change);
        }
        add_at(&mut f, weight, &system.free_field_force(free_field));
        add_at(&mut f, 1., &system.free_field_inertia(free_field));
        f
    }

    /// j + dt j' + dt^2 j'' / 2.
    fn expected_jumps(&self, system: &System, old: &State) -> Vec<f64> {
        let dt = self.constants.dt;
        let [q, v, a] = [&old.q, &old.v, &old.a].map(|x| system.jumps(x));
        (0..q.len()).map(|i| q[i] + dt * v[i] + dt * dt / 2. * a[i]).collect()
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

/// A step of several systems that share one factor: L, M, C and K are read once for all of them, and each gets the digits
/// that it gets alone.
///
/// # Panics
/// If there are not as many steppers, systems and old states, from one to [`MOST_TOGETHER`].
pub fn step_together(
    steppers: &mut [&mut Stepper],
    systems: &[&System],
    old: &[&State],
) -> Vec<Result<Step, Unsettled>> {
    assert!(!old.is_empty(), "at least one system");
    assert!(steppers.len() == systems.len() && systems.len() == old.len(), "a stepper, a system and a state each");
    with_lanes_for!(steppers.len(), step_lanes(steppers, systems, old))
}

/// Most systems that [`step_together`] takes at once.
pub const MOST_TOGETHER: usize = MOST_LANES;

fn step_lanes<const K: usize>(
    steppers: &mut [&mut Stepper],
    systems: &[&System],
    old: &[&State],
) -> Vec<Result<Step, Unsettled>> {
    let free_fields: Vec<_> = (0..old.len()).map(|k| steppers[k].free_field(systems[k], old[k])).collect();
    let mut x = right_hand_sides::<K>(steppers, systems, old, &free_fields);
    steppers[0].condensed.factor().condense_lanes(&mut x);
    let border = systems[0].unknowns.border;
    let settled: Vec<_> = (0..old.len())
        .map(|k| {
            if let Err(why) = &free_fields[k] {
                return Err(why.clone());
            }
            let at_border: Vec<f64> = x[border..].iter().map(|x| x[k]).collect();
            let settled = steppers[k].settle(systems[k], &at_border, old[k])?;
            x[border..].iter_mut().zip(&settled.border).for_each(|(x, displacement)| x[k] = *displacement);
            Ok(settled)
        })
        .collect();
    steppers[0].condensed.factor().expand_lanes(&mut x);
    let completed: Vec<_> = settled
        .into_iter()
        .zip(free_fields)
        .enumerate()
        .map(|(k, (settled, free_field))| {
            let Solution { jumps, responses, iterations, displacement_test, .. } = settled?;
            let q = x.iter().map(|x| x[k]).chain(jumps).collect();
            let joints = responses.iter().map(JointState::from).collect();
            let state = steppers[k].complete(&systems[k].unknowns, q, free_field?, joints, old[k]);
            Ok(Step { state, iterations, displacement_test, forms: Forms::default() })
        })
        .collect();
    with_forms::<K>(systems[0], old, completed)
}

/// Row i: what unknown i has on the right-hand side of each system. One whose columns did not settle gets none.
fn right_hand_sides<const K: usize>(
    steppers: &[&mut Stepper],
    systems: &[&System],
    old: &[&State],
    free_fields: &[Result<Vec<State>, Unsettled>],
) -> Vec<[f64; K]> {
    let mut x = match steppers[0].law {
        Law::Static { .. } => vec![[0.; K]; systems[0].unknowns.count],
        Law::Dynamic(dynamic) => {
            let of_all = |i: usize| {
                let mut motion = [[0.; K]; 2];
                for (k, old) in old.iter().enumerate() {
                    [motion[0][k], motion[1][k]] = dynamic.inertial(old, i);
                }
                motion
            };
            let motion: Vec<[[f64; K]; 2]> = (0..systems[0].unknowns.count).map(of_all).collect();
            let Products { pattern, mass, damping, .. } = &*systems[0].products;
            pattern.sum_of_products([mass, damping], &motion)
        }
    };
    for (k, free_field) in free_fields.iter().enumerate() {
        let forces = match (steppers[k].law, free_field) {
            (Law::Static { dt }, _) => systems[k].load(old[k].time + dt),
            (Law::Dynamic(dynamic), Ok(free_field)) => dynamic.forces(systems[k], old[k], free_field),
            (Law::Dynamic(_), Err(_)) => continue,
        };
        x.iter_mut().zip(&forces).for_each(|(x, force)| x[k] += force);
    }
    x
}

fn with_forms<const K: usize>(
    system: &System,
    old: &[&State],
    steps: Vec<Result<Step, Unsettled>>,
) -> Vec<Result<Step, Unsettled>> {
    let pairs: Vec<Option<(&State, &State)>> =
        steps.iter().zip(old).map(|(step, old)| step.as_ref().ok().map(|step| (*old, &step.state))).collect();
    let forms = Forms::of_all::<K>(system, &pairs);
    steps.into_iter().zip(forms).map(|(step, forms)| Ok(Step { forms, ..step? })).collect()
}
