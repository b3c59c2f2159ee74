//! A system with contact at the price of a linear one: everything but the joints is linear, so its matrix is factored
//! once, with the nodes of the interfaces last. Solving takes one forward sweep up to them, Newton on the jumps between
//! them, one backward sweep.

use super::condensate::Condensate;
use super::contact::{Contact, Problem, Solution};
use super::joints::Joints;
use super::least_motion::Springs;
use super::system::{State, System};
use super::tresca::SWEEPS;
use super::unsettled::Unsettled;
use crate::model::case::Newton;
use crate::sparse::vector::{add, distance, norm, ratio};
use crate::sparse::{Factor, NotPositiveDefinite, Symbolic};
use sprs::CsMat;
use std::sync::Arc;

/// A x + r(j) = b with x the unknowns, j the jumps between some of them, r the joint forces.
pub struct Condensed {
    factor: Arc<Factor>,
    contact: Contact,
    /// part of A, where joints alone hold a body
    springs: Option<Springs>,
    /// the largest displacement that is accepted [m]
    reach: f64,
}

/// Where a step comes from.
pub struct Previous<'a> {
    /// displacements of the border [m]
    pub border: &'a [f64],
    pub jumps: &'a [f64],
    /// of the run so far [N]; 0 with inertia
    pub largest_force: f64,
}

impl<'a> Previous<'a> {
    pub fn of(system: &System, state: &'a State) -> Previous<'a> {
        let (displacements, jumps) = state.q.split_at(system.unknowns.count);
        Previous { border: &displacements[system.unknowns.border..], jumps, largest_force: state.largest_force }
    }
}

/// A body that has not come to rest after so many rounds slides or falls. While it falls freely each round takes it
/// twice as far as the one before.
const ROUNDS: usize = 50;

/// Without inertia, times the size of the model that no displacement may exceed: it is round-off of a matrix that is nearly
/// singular, or nonsense.
pub const FAR: f64 = 1e6;

/// Of `newton.tolerance`, for what the springs of least motion may carry of the largest force.
const CARRIED: f64 = 1e-3;

impl Condensed {
    /// A is positive definite by itself.
    pub fn new(
        system: &System,
        symbolic: &Symbolic,
        a: &CsMat<f64>,
        options: Newton,
    ) -> Result<Condensed, NotPositiveDefinite> {
        let factor: Arc<Factor> = symbolic.factor(a)?.into();
        let condensate = Condensate::new(&factor, &system.unknowns, false);
        Ok(Condensed {
            factor,
            contact: Contact::new(condensate.into(), [].into(), options),
            springs: None,
            reach: f64::INFINITY,
        })
    }

    /// A = K of bodies that may hang on joints alone, and the springs of least motion. Closed joints are put in, whose
    /// forces Newton takes off again, none stiffer than the bodies beside it: stiffer ones would cost digits.
    pub fn hanging(system: &System, symbolic: &Symbolic, options: Newton) -> Result<Condensed, NotPositiveDefinite> {
        let closed = system.closed_joints_as_stiff_as_bodies();
        let springs = Springs::new(system, &closed);
        let mut matrix = system.with_joints(&closed);
        for (unknown, stiffness) in springs.iter().flat_map(Springs::on_diagonal) {
            *matrix.get_mut(unknown, unknown).expect("every diagonal entry is in the pattern") += stiffness;
        }
        let factor: Arc<Factor> = symbolic.factor(&matrix)?.into();
        let condensate = Condensate::new(&factor, &system.unknowns, true);
        Ok(Condensed {
            factor,
            contact: Contact::new(condensate.into(), closed.into(), options),
            springs,
            reach: FAR * system.size,
        })
    }

    /// For another system of the same matrix, whose joints have a history of their own.
    pub fn sharing_factor(&self) -> Condensed {
        Condensed {
            factor: self.factor.clone(),
            contact: self.contact.sharing_condensate(),
            springs: self.springs.clone(),
            reach: self.reach,
        }
    }

    /// A x + r(j) = b; x, the jumps behind it, and how the joints settled. They move on from an `old` state.
    pub fn solve(&mut self, system: &System, b: Vec<f64>, old: &State) -> Result<(Vec<f64>, Solution), Unsettled> {
        let mut x = b;
        self.factor.condense(&mut x);
        let joints = Joints { interface: &system.interface, old: &old.joints, damping: None };
        let at_border = &mut x[system.unknowns.border..];
        let solution = self.settle(system, at_border, joints, &Previous::of(system, old), system.jumps(&old.q))?;
        at_border.copy_from_slice(&solution.border);
        self.factor.expand(&mut x);
        x.extend(&solution.jumps);
        Ok((x, solution))
    }

    pub fn factor(&self) -> &Factor {
        &self.factor
    }

    /// Between the sweeps: from the condensed right-hand side at the border to the displacements there that satisfy the
    /// joints, which move on towards the `expected` jumps.
    pub fn settle(
        &mut self,
        system: &System,
        b: &[f64],
        joints: Joints,
        previous: &Previous,
        expected: &[f64],
    ) -> Result<Solution, Unsettled> {
        let solution = match self.springs.clone() {
            None => self.settle_once(b, &joints, previous, expected),
            Some(springs) => self.settle_with_least_motion(system, &springs, b, &joints, previous),
        }?;
        match solution.border.iter().position(|u| u.abs() > self.reach) {
            Some(i) => Err(Unsettled::Far { node: system.unknowns.node_of(system.unknowns.border + i) }),
            None => Ok(solution),
        }
    }

    /// K u + r(j) + W (u - u_0) = f with u_0 from before, then from the solution, until W (u - u_0) is nothing. Between
    /// rounds u_0 is moved beyond the solution, as [`Springs::further`] says.
    fn settle_with_least_motion(
        &mut self,
        system: &System,
        springs: &Springs,
        b: &[f64],
        joints: &Joints,
        previous: &Previous,
    ) -> Result<Solution, Unsettled> {
        let tolerance = self.contact.options.tolerance;
        let (mut anchor, mut expected) = (previous.border.to_vec(), previous.jumps.to_vec());
        let (mut iterations, mut forces_before) = (0, None::<Vec<f64>>);
        let mut further = springs.no_further();
        for round in 1.. {
            let mut pulled = b.to_vec();
            add(&mut pulled, 1., &springs.forces(&anchor));
            let found = self.settle_once(&pulled, joints, previous, &expected)?;
            iterations += found.iterations;
            let displacement_test = match round {
                1 => found.displacement_test,
                _ => ratio(distance(&found.jumps, &expected), distance(&found.jumps, previous.jumps)),
            };
            let moved: Vec<f64> = found.border.iter().zip(&anchor).map(|(u, u_0)| u - u_0).collect();
            let forces = springs.forces(&moved);
            let carried = norm(&forces);
            let round_off = SWEEPS.max(tolerance) * found.largest_force;
            let falls = forces_before.as_ref().is_none_or(|before| carried <= norm(before) / 2.);
            let at_round_off = !falls && carried <= round_off;
            if carried <= CARRIED * tolerance * found.largest_force || at_round_off {
                return Ok(Solution { iterations, displacement_test, ..found });
            }
            if let Some(before) = forces_before {
                further = springs.further(&further, &forces, &before, round_off);
            }
            let gone = springs.travel(previous.border, &found.border) > system.size && further.iter().any(|&f| f >= 1.);
            if gone || round > ROUNDS {
                let last = found.responses.iter().map(|r| r.status).collect();
                return Err(Unsettled::Loose { body: springs.most_pulled(&forces), last });
            }
            anchor = found.border;
            springs.add_to_groups(&mut anchor, &further, &moved);
            (expected, forces_before) = (found.jumps, Some(forces));
        }
        unreachable!("the rounds are counted")
    }

    fn settle_once(
        &mut self,
        b: &[f64],
        joints: &Joints,
        previous: &Previous,
        expected: &[f64],
    ) -> Result<Solution, Unsettled> {
        let condensate = &self.contact.condensate;
        let free = condensate.jumps(&condensate.displacements(b));
        let (last, largest_force) = (previous.jumps, previous.largest_force);
        self.contact.solve(&Problem { joints, b, free: &free, last, expected, largest_force })
    }
}
