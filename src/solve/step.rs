//! One step in time, of one system or of several that share their factor.

use super::condensed::{Condensed, Previous};
use super::contact::Solution;
use super::energy::Forms;
use super::free_field::Column;
use super::interface::JointState;
use super::joints::Joints;
use super::law::{Law, Scheme};
use super::motion::{Motion, Motions};
use super::system::{State, System};
use super::unsettled::Unsettled;
use crate::model::case::Newton;
use crate::sparse::lanes::{Lane, side_by_side};
use crate::sparse::{
    Factor, Factors, Found, Interleaved, Lanes, MOST_LANES, NotPositiveDefinite, Reading, Symbolic, with_lanes_for,
};
use std::ops::Range;

/// Steps of one length, their matrix factored.
pub struct Stepper {
    law: Law,
    condensed: Condensed,
    /// the same for each column beyond a free-field side
    columns: Vec<Stepper>,
    /// for the [`Factors`] of a step, which are too large to be made anew each time
    room: Vec<f64>,
}

/// An accepted step, or where the first one starts.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// read only: `forms` and `onward` belong to it
    state: State,
    pub iterations: usize,
    /// the paper's test (19), on the jumps
    pub displacement_test: f64,
    /// what the energies of the step are made of; zero at a start
    pub forms: Forms,
    onward: Option<Onward>,
}

/// What the next step's right-hand side has from the state alone.
#[derive(Debug, Clone, PartialEq)]
struct Onward {
    /// of the step, and so of its length
    law: Law,
    /// M x + C y, x and y as [`Law::onward`] says [N]
    forces: Lane,
}

impl Step {
    pub fn start(state: State) -> Step {
        Step { state, iterations: 0, displacement_test: 0., forms: Forms::default(), onward: None }
    }

    pub fn state(&self) -> &State {
        &self.state
    }

    pub fn into_state(self) -> State {
        self.state
    }

    /// The same at a time that round-off has moved [s].
    pub(super) fn at(self, time: f64) -> Step {
        Step { state: State { time, ..self.state }, ..self }
    }
}

impl Stepper {
    pub fn new(
        system: &System,
        symbolic: &Symbolic,
        scheme: Scheme,
        dt: f64,
        options: Newton,
    ) -> Result<Stepper, NotPositiveDefinite> {
        let law = Law::new(scheme, dt);
        let Law::Dynamic(dynamic) = law else {
            let condensed = Condensed::hanging(system, symbolic, options)?;
            return Ok(Stepper { law, condensed, columns: vec![], room: vec![] });
        };
        let condensed = Condensed::new(system, symbolic, &dynamic.matrix(system), options)?;
        let column = |c: &Column| Stepper::new(&c.system, &c.symbolic, scheme, dt, options);
        let columns = system.columns.iter().map(column).collect::<Result<_, _>>()?;
        Ok(Stepper { law, condensed, columns, room: vec![] })
    }

    /// For a system that differs in loads and friction only: the factor is the same.
    pub fn sharing_factor(&self) -> Stepper {
        Stepper {
            law: self.law,
            condensed: self.condensed.sharing_factor(),
            columns: self.columns.iter().map(Stepper::sharing_factor).collect(),
            room: vec![],
        }
    }

    /// From one step of this system, or a start, to the next; the old one is not touched.
    pub fn step(&mut self, system: &System, old: &Step) -> Result<Step, Unsettled> {
        step_together(&mut [self], &[system], &[old]).swap_remove(0)
    }

    /// Between the sweeps: from the condensed right-hand side at the border to the displacements there.
    fn settle(&mut self, system: &System, border: &[f64], old: &State) -> Result<Solution, Unsettled> {
        let joints =
            Joints { interface: &system.interface, old: &old.joints, damping: self.law.joint_damping(system, old) };
        let expected = self.law.expected_jumps(system, old);
        // gravity's forces are no measure of those that have inertia
        let largest_force = if let Law::Static { .. } = self.law { old.largest_force } else { 0. };
        let previous = Previous { largest_force, ..Previous::of(system, old) };
        self.condensed.settle(system, border, joints, &previous, &expected)
    }

    /// The columns beyond free-field sides, which know nothing of the model, one step later.
    fn free_field(&mut self, system: &System, old: &State) -> Result<Vec<State>, Unsettled> {
        let columns = system.columns.iter().zip(&mut self.columns).zip(&old.free_field);
        columns
            .map(|((column, stepper), old)| {
                let step = stepper.step(&column.system, &Step::start(old.clone()));
                step.map(Step::into_state).map_err(|why| column.on_side(why))
            })
            .collect()
    }
}

/// A step of several systems that share one factor: L, K (but for the elastic forces of Hilber, Hughes and Taylor) and
/// the masses are read once for all of them, and each gets the digits that it gets alone.
///
/// # Panics
/// If there are not as many steppers, systems and old states, from one to [`MOST_TOGETHER`], or the steppers differ in
/// their scheme or length of step.
pub fn step_together(
    steppers: &mut [&mut Stepper],
    systems: &[&System],
    old: &[&Step],
) -> Vec<Result<Step, Unsettled>> {
    assert!(!old.is_empty(), "at least one system");
    assert!(steppers.len() == systems.len() && systems.len() == old.len(), "a stepper, a system and a state each");
    assert!(steppers.iter().all(|stepper| stepper.law == steppers[0].law), "one scheme and one length of step");
    with_lanes_for!(steppers.len(), step_lanes(steppers, systems, old))
}

/// Most systems that [`step_together`] takes at once.
pub const MOST_TOGETHER: usize = MOST_LANES;

fn step_lanes<const K: usize>(
    steppers: &mut [&mut Stepper],
    systems: &[&System],
    old: &[&Step],
) -> Vec<Result<Step, Unsettled>> {
    let cases = 0..old.len();
    let law = steppers[0].law;
    let free_fields: Vec<_> = cases.clone().map(|k| steppers[k].free_field(systems[k], &old[k].state)).collect();
    let mut x = right_hand_sides::<K>(law, systems, old, &free_fields);
    steppers[0].condensed.factor().condense_lanes(&mut x);
    let border = systems[0].unknowns.border;
    let settled: Vec<_> = cases
        .clone()
        .map(|k| {
            if let Err(why) = &free_fields[k] {
                return Err(why.clone());
            }
            let at_border: Vec<f64> = x[border..].iter().map(|x| x[k]).collect();
            let settled = steppers[k].settle(systems[k], &at_border, &old[k].state)?;
            x[border..].iter_mut().zip(&settled.border).for_each(|(x, displacement)| x[k] = *displacement);
            Ok(settled)
        })
        .collect();
    let states: Vec<&State> = old.iter().map(|old| &old.state).collect();
    let motions = Motions::new(law, &states, x.len(), systems[0].unknowns.with_jumps());
    let Stepper { condensed, room, .. } = &mut *steppers[0];
    let (motions, found) = go_back(condensed.factor(), systems[0].interleaved(), motions, &mut x, room, PART / K);
    let [strain, kinetic, drained] = found.forms;
    let onward = Lane::each(found.sum, old.len());
    let stepped = cases.zip(settled).zip(free_fields).zip(motions).zip(onward);
    stepped
        .map(|((((k, settled), free_field), motion), forces)| {
            let Solution { jumps, responses, iterations, displacement_test, largest_force, .. } = settled?;
            let [q, v, a] = motion.with_jumps(systems[k], &jumps)?;
            let joints = responses.iter().map(JointState::from).collect();
            Ok(Step {
                state: State {
                    time: old[k].state.time + law.dt(),
                    q,
                    v,
                    a,
                    joints,
                    free_field: free_field?,
                    largest_force,
                },
                iterations,
                displacement_test,
                forms: Forms { strain: strain[k], kinetic: kinetic[k], drained: drained[k] },
                onward: Some(Onward { law, forces }),
            })
        })
        .collect()
}

/// From the displacements of the border among x to all motions, and what the matrices make of them. Each part of the
/// unknowns, about `size` of them, goes through all of it while its numbers are in the cache.
fn go_back<const K: usize>(
    factor: &Factor,
    matrices: &Interleaved,
    mut motions: Motions<K>,
    x: &mut Lanes<K>,
    room: &mut Vec<f64>,
    size: usize,
) -> (Vec<Motion>, Found<K>) {
    let factors = factors_in(room, x.len());
    let mut reading = Reading::new(matrices);
    let mut follow = |part: Range<usize>, x: &Lanes<K>| {
        motions.follow(part.clone(), x, factors);
        reading.down_to(part.start, factors);
    };
    follow(factor.border()..x.len(), x);
    for part in factor.parts(size) {
        factor.expand_part(&part, x);
        follow(part.unknowns, x);
    }
    (motions.done(), reading.found(factors))
}

/// Unknowns times cases that go through it together: thirteen numbers each, which the processor's own cache should
/// hold.
const PART: usize = 8192;

/// For each unknown, whatever was there before, and a last one that stands for nothing.
fn factors_in<const K: usize>(room: &mut Vec<f64>, unknowns: usize) -> &mut [Factors<K>] {
    room.resize(5 * K * (unknowns + 1), 0.);
    let factors: &mut [Factors<K>] = room.as_chunks_mut().0.as_chunks_mut().0;
    factors[unknowns] = [[0.; K]; 5];
    factors
}

/// Row i: what unknown i has on the right-hand side of each system. One whose columns did not settle lacks their
/// forces; nobody asks for its step.
fn right_hand_sides<const K: usize>(
    law: Law,
    systems: &[&System],
    old: &[&Step],
    free_fields: &[Result<Vec<State>, Unsettled>],
) -> Vec<[f64; K]> {
    let onward = |k: usize| match &old[k].onward {
        Some(onward) if onward.law == law => None,
        _ => Some(onward_of(systems[k], law, &old[k].state)),
    };
    let made_now: Vec<Option<Onward>> = (0..old.len()).map(onward).collect();
    let known = |k: usize| made_now[k].as_ref().or(old[k].onward.as_ref()).expect("one of them");
    let mut x = side_by_side(&(0..old.len()).map(|k| &known(k).forces).collect::<Vec<_>>());
    for (k, free_field) in free_fields.iter().enumerate() {
        for lasting in systems[k].lasting_loads() {
            x.iter_mut().zip(lasting).for_each(|(x, f)| x[k] += f);
        }
        let free_field = free_field.as_deref().unwrap_or_default();
        law.forces(systems[k], &old[k].state, free_field).into_iter().for_each(|(i, f)| x[i][k] += f);
    }
    x
}

fn onward_of(system: &System, law: Law, State { q, v, a, .. }: &State) -> Onward {
    Onward { law, forces: Lane::alone(system.interleaved().sum(|i| law.onward([q[i], v[i], a[i]]))) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::case::Integrator;
    use crate::solve::system::State;
    use crate::sparse::testing::{grid_matrix, random};

    /// The room keeps what a step of other cases left there, and what stands for nothing is multiplied by zeros.
    #[test]
    fn the_row_that_stands_for_nothing_is_zero_whatever_was_in_its_place() {
        let mut room = vec![];
        factors_in::<2>(&mut room, 3).fill([[f64::NAN; 2]; 5]);
        assert_eq!(factors_in::<1>(&mut room, 3)[3], [[0.]; 5]);
    }

    #[test]
    fn it_makes_no_difference_in_what_parts_a_step_goes_back() {
        let a = grid_matrix(40, 33, &[]);
        let n = a.rows();
        let factor = Symbolic::bordered(&a, n - 5).factor(&a).expect("positive definite");
        let matrices = Interleaved::new([&a, &a], [0.3, 0.02], None);
        let [q, v, a] = [1, 2, 3].map(|seed| random(n, seed));
        let state = State { time: 0., q, v, a, joints: vec![], free_field: vec![], largest_force: 0. };
        let law = Law::new(Scheme::Dynamic(Integrator::default()), 0.1);
        let gone_back = |size: usize| {
            let mut x: Vec<[f64; 1]> = random(n, 4).into_iter().map(|x| [x]).collect();
            let old = [&state];
            go_back(&factor, &matrices, Motions::new(law, &old, n, n), &mut x, &mut vec![], size)
        };
        let whole = gone_back(n);
        assert!([1, 100].into_iter().all(|size| gone_back(size) == whole));
    }
}
