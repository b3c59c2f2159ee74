//! A system with contact at the price of a linear one: everything but the joints is linear, so its matrix is factored once,
//! with the jumps last. Solving takes one forward sweep, Newton on the jumps, one backward sweep.

use super::contact::{Contact, JointDamping, Problem, Unsettled};
use super::interface::JointState;
use super::system::System;
use crate::model::case::Newton;
use crate::sparse::{Factor, NotPositiveDefinite, Symbolic};
use sprs::CsMat;

/// A x + r(j) = b with x the unknowns, j the jumps at their end, r the joint forces.
pub struct Condensed {
    factor: Factor,
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
pub struct Solved {
    pub x: Vec<f64>,
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
        Ok(Condensed { factor, contact })
    }

    /// Solves for `right_hand_side`, the joints moving on from `old`; `guess` of the jumps starts Newton.
    pub fn solve(
        &mut self,
        system: &System,
        right_hand_side: Vec<f64>,
        guess: &[f64],
        old: &[JointState],
        damping: Option<JointDamping>,
    ) -> Result<Solved, Unsettled> {
        let mut x = right_hand_side;
        self.factor.condense(&mut x);
        let right_hand_side = system.jumps(&x).to_vec();
        let problem = Problem { interface: &system.interface, right_hand_side: &right_hand_side, old, damping };
        let solution = self.contact.solve(&problem, guess)?;
        x[system.unknowns.first_jump..].copy_from_slice(&solution.jumps);
        self.factor.expand(&mut x);
        Ok(Solved {
            x,
            joints: solution.responses.iter().map(JointState::from).collect(),
            iterations: solution.iterations,
            displacement_test: solution.displacement_test,
        })
    }
}
