//! The state at t = 0: equilibrium under gravity, what the case gives its groups, and the first acceleration.

use super::condensed::Condensed;
use super::interface::JointState;
use super::system::{State, System};
use super::unsettled::Unsettled;
use crate::model::case::{Newton, Start};
use crate::sparse::vector::{add, add_at};
use crate::sparse::{NotPositiveDefinite, Symbolic, multiply};

/// Gravity may be put on in this many parts.
const PARTS: [usize; 4] = [1, 4, 16, 64];

/// K u + r(j) = gravity, tractions and slips of the joints included.
///
/// Outer error: the bodies' stiffness with closed joints is singular. Inner: no equilibrium was found.
pub fn under_gravity(
    system: &System,
    symbolic: &Symbolic,
    options: Newton,
) -> Result<Result<State, Unsettled>, NotPositiveDefinite> {
    let rest = State::at_rest(system);
    let Some(gravity) = &system.gravity else { return Ok(Ok(rest)) };
    let mut condensed = Condensed::hanging(system, symbolic, options)?;
    let mut in_parts = |parts: usize| {
        (1..=parts).try_fold(rest.clone(), |old, part| {
            let load = gravity.iter().map(|f| f * part as f64 / parts as f64).collect();
            let (q, settled) = condensed.solve(system, load, &old)?;
            let joints = settled.responses.iter().map(JointState::from).collect();
            Ok(State { q, joints, largest_force: settled.largest_force, ..old })
        })
    };
    let mut found = in_parts(PARTS[0]);
    for parts in &PARTS[1..] {
        if found.is_ok() {
            break;
        }
        found = in_parts(*parts);
    }
    Ok(found)
}

/// The static state of the `held` system in the unknowns of the one that is let go, and the reactions
/// K u + r(j) - gravity [N] of what only held the former: they go on as forces, about which the ground then moves.
pub fn released(system: &System, held: &System, state: &State) -> (State, Vec<f64>) {
    let q = system.unknowns.from_others(&held.unknowns, &state.q);
    let mut unbalanced = multiply(&system.stiffness, system.displacements(&q));
    system.gravity.iter().for_each(|gravity| add(&mut unbalanced, -1., gravity));
    let joint_forces = system.interface.forces(state.joints.iter().map(|j| j.traction));
    system.unknowns.sides.add_forces(&mut unbalanced, 1., &joint_forces);
    // Elsewhere only the boundaries' springs, which were not there, are to be balanced; the rest is what Newton left.
    let mut reactions = system.boundary_springs(&q);
    for i in system.unknowns.freed_from(&held.unknowns) {
        reactions[i] = unbalanced[i];
    }
    let largest_force = state.largest_force;
    (State { q, joints: state.joints.clone(), largest_force, ..State::at_rest(system) }, reactions)
}

/// Adds displacement and velocity of the nodes [m], [m/s]; joints answer to the displaced state, columns beyond the
/// sides take part.
pub fn with_motion(system: &System, state: State, displacement: &[[f64; 2]], velocity: &[[f64; 2]]) -> State {
    let add = |x: &[f64], nodal: &[[f64; 2]]| -> Vec<f64> {
        x.iter().zip(system.unknowns.from_nodes(nodal)).map(|(x, n)| x + n).collect()
    };
    let q = add(&state.q, displacement);
    let jumps = system.jumps(&q);
    let points = system.interface.points.iter().zip(&state.joints);
    let joints = points
        .map(|(point, old)| JointState::from(&point.law.respond(system.interface.local(point, jumps), old.slip)))
        .collect();
    let columns = system.columns.iter().zip(state.free_field);
    let free_field =
        columns.map(|(c, state)| with_motion(&c.system, state, &c.own(displacement), &c.own(velocity))).collect();
    State { v: add(&state.v, velocity), joints, q, free_field, ..state }
}

/// M a = f(0) - C v - K u - r(j), or a = 0: a blast has p(0) != 0.
pub fn with_acceleration(
    system: &System,
    symbolic: &Symbolic,
    state: State,
    start: Start,
) -> Result<State, NotPositiveDefinite> {
    if start == Start::Rest {
        return Ok(state);
    }
    let columns = system.columns.iter().zip(state.free_field);
    let free_field = columns.map(|(c, state)| with_acceleration(&c.system, &c.symbolic, state, start));
    let free_field = free_field.collect::<Result<Vec<_>, _>>()?;
    let mut a = system.load(0.);
    add_at(&mut a, 1., &system.free_field_force(&free_field));
    add_at(&mut a, 1., &system.free_field_inertia(&free_field));
    for (matrix, x) in [(&system.damping, &state.v), (&system.stiffness, &state.q)] {
        add(&mut a, -1., &multiply(matrix, system.displacements(x)));
    }
    let joint_forces = system.interface.forces(state.joints.iter().map(|j| j.traction));
    system.unknowns.sides.add_forces(&mut a, -1., &joint_forces);
    symbolic.solve_once(&system.mass, &mut a)?;
    Ok(State { a: system.unknowns.vector(|i| a[i]), free_field, ..state })
}
