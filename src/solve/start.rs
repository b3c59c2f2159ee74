//! The state at t = 0: equilibrium under gravity, what the case gives its groups, and the first acceleration.

use super::condensed::{Condensed, Reference};
use super::contact::Unsettled;
use super::interface::JointState;
use super::system::{State, System};
use crate::model::case::{Newton, Start};
use crate::sparse::vector::add;
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
    if system.gravity.iter().all(|&f| f == 0.) {
        return Ok(Ok(rest));
    }
    let closed = system.closed_stiffness();
    let mut condensed = Condensed::new(system, symbolic, &closed, Reference::ClosedJoints, options)?;
    let mut in_parts = |parts: usize| {
        (1..=parts).try_fold(rest.clone(), |old, part| {
            let load = system.gravity.iter().map(|f| f * part as f64 / parts as f64).collect();
            let solved = condensed.solve(system, load, system.jumps(&old.q), &old.joints, None)?;
            Ok(State { q: solved.x, joints: solved.joints, ..old })
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

/// Adds displacement and velocity of the nodes [m], [m/s]; joints answer to the displaced state.
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
    State { v: add(&state.v, velocity), joints, q, ..state }
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
    let mut a = system.load(0.);
    for (matrix, x) in [(&system.damping, &state.v), (&system.stiffness, &state.q)] {
        add(&mut a, -1., &multiply(matrix, x));
    }
    let joint_forces = system.interface.forces(state.joints.iter().map(|j| j.traction));
    a[system.unknowns.first_jump..].iter_mut().zip(joint_forces).for_each(|(a, r)| *a -= r);
    symbolic.factor(&system.mass)?.solve(&mut a);
    Ok(State { a, ..state })
}
