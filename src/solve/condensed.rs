//! A system with contact at the price of a linear one: everything but the joints is linear, so its matrix is factored once,
//! with the jumps last. Solving takes one forward sweep, Newton on the jumps, one backward sweep.

use super::contact::{Contact, JointDamping, Problem, Unsettled};
use super::interface::JointState;
use super::system::System;
use crate::model::case::Newton;
use crate::sparse::{Factor, NotPositiveDefinite, Symbolic};
use sprs::CsMat;
use std::sync::Arc;

/// A x + r(j) = b with x the unknowns, j the jumps at their end, r the joint forces.
pub struct Condensed {
    factor: Arc<Factor>,
    contact: Contact,
}

/// What else than A the factored matrix holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reference {
    /// nothing: A is positive definite by itself
    Bodies,
    /// every joint closed and sticking, because bodies that hang on joints alone make A singular
    ClosedJoints,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Settled {
    pub joints: Vec<JointState>,
    pub iterations: usize,
    /// the paper's test (19), on the jumps
    pub displacement_test: f64,
}

impl Condensed {
    /// Factors `matrix`, which is A plus what `reference` says; S = L_cc L_cc' is the Schur complement of the jumps.
    pub fn new(
        system: &System,
        symbolic: &Symbolic,
        matrix: &CsMat<f64>,
        reference: Reference,
        options: Newton,
    ) -> Result<Condensed, NotPositiveDefinite> {
        let factor = symbolic.factor(matrix)?;
        let trailing = factor.trailing(system.interface.count);
        let mut schur = &trailing * trailing.transpose();
        let contact = match reference {
            Reference::Bodies => Contact::new(schur, options),
            Reference::ClosedJoints => {
                for point in &system.interface.points {
                    let closed = point.law.closed_stiffness();
                    system.interface.tangent(point, &closed, |i, j, value| schur[(i, j)] -= value);
                }
                Contact::new(schur, options).stabilised()
            }
        };
        Ok(Condensed { factor: factor.into(), contact })
    }

    /// For another system of the same matrix, whose joints have a history of their own.
    pub fn sharing_factor(&self) -> Condensed {
        Condensed { factor: self.factor.clone(), contact: self.contact.sharing_matrix() }
    }

    /// A x + r(j) = b.
    pub fn solve(
        &mut self,
        system: &System,
        b: Vec<f64>,
        guess: &[f64],
        old: &[JointState],
        damping: Option<JointDamping>,
    ) -> Result<(Vec<f64>, Settled), Unsettled> {
        let mut x = b;
        self.factor.condense(&mut x);
        let jumps = &mut x[system.unknowns.first_jump..];
        let settled = self.settle(system, jumps, [guess, guess], old, damping)?;
        self.factor.expand(&mut x);
        Ok((x, settled))
    }

    pub fn factor(&self) -> &Factor {
        &self.factor
    }

    /// Between the sweeps: from the condensed right-hand side `x` to the jumps that satisfy the joints, put in its place. The joints move on from `old`; the `last` jumps and the `expected` ones start Newton.
    pub fn settle(
        &mut self,
        system: &System,
        x: &mut [f64],
        [last, expected]: [&[f64]; 2],
        old: &[JointState],
        damping: Option<JointDamping>,
    ) -> Result<Settled, Unsettled> {
        let problem = Problem { interface: &system.interface, right_hand_side: x, old, damping };
        let solution = self.contact.solve(&problem, last, expected)?;
        x.copy_from_slice(&solution.jumps);
        Ok(Settled {
            joints: solution.responses.iter().map(JointState::from).collect(),
            iterations: solution.iterations,
            displacement_test: solution.displacement_test,
        })
    }
}
