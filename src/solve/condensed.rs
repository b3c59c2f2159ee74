//! A system with contact at the price of a linear one: everything but the joints is linear, so its matrix is factored
//! once, with the nodes of the interfaces last. Solving takes one forward sweep up to them, Newton on the jumps between
//! them, one backward sweep.

use super::condensate::Condensate;
use super::contact::{Contact, Problem, Solution};
use super::interface::JointState;
use super::joints::Joints;
use super::system::System;
use super::unsettled::Unsettled;
use crate::model::case::Newton;
use crate::sparse::{Factor, NotPositiveDefinite, Symbolic};
use sprs::CsMat;
use std::sync::Arc;

/// A x + r(j) = b with x the unknowns, j the jumps between some of them, r the joint forces.
pub struct Condensed {
    factor: Arc<Factor>,
    contact: Contact,
}

impl Condensed {
    /// A is positive definite by itself.
    pub fn new(
        system: &System,
        symbolic: &Symbolic,
        a: &CsMat<f64>,
        options: Newton,
    ) -> Result<Condensed, NotPositiveDefinite> {
        Condensed::with_reference(system, symbolic, a, 0., options)
    }

    /// A = K of bodies that may hang on joints alone. Closed joints are put in, whose forces Newton takes off again,
    /// none stiffer than the bodies are on average: stiffer ones would cost digits.
    pub fn hanging(system: &System, symbolic: &Symbolic, options: Newton) -> Result<Condensed, NotPositiveDefinite> {
        let stiffest = system.stiffness_at_joints();
        Condensed::with_reference(system, symbolic, &system.with_closed_joints(stiffest), stiffest, options)
    }

    /// `matrix`: A with joints in it, closed and at most as stiff as `stiffest` [Pa/m].
    fn with_reference(
        system: &System,
        symbolic: &Symbolic,
        matrix: &CsMat<f64>,
        stiffest: f64,
        options: Newton,
    ) -> Result<Condensed, NotPositiveDefinite> {
        let factor: Arc<Factor> = symbolic.factor(matrix)?.into();
        let condensate = Condensate::new(&factor, &system.unknowns, stiffest > 0.);
        Ok(Condensed { factor, contact: Contact::new(condensate.into(), stiffest, options) })
    }

    /// For another system of the same matrix, whose joints have a history of their own.
    pub fn sharing_factor(&self) -> Condensed {
        Condensed { factor: self.factor.clone(), contact: self.contact.sharing_condensate() }
    }

    /// A x + r(j) = b; x, the jumps behind it, and how the joints settled. They move on from the jumps `last` and the
    /// states `old`.
    pub fn solve(
        &mut self,
        system: &System,
        b: Vec<f64>,
        last: &[f64],
        old: &[JointState],
    ) -> Result<(Vec<f64>, Solution), Unsettled> {
        let mut x = b;
        self.factor.condense(&mut x);
        let joints = Joints { interface: &system.interface, old, damping: None };
        let at_border = &mut x[system.unknowns.border..];
        let solution = self.settle(at_border, joints, last, last)?;
        at_border.copy_from_slice(&solution.border);
        self.factor.expand(&mut x);
        x.extend(&solution.jumps);
        Ok((x, solution))
    }

    pub fn factor(&self) -> &Factor {
        &self.factor
    }

    /// Between the sweeps: from the condensed right-hand side at the border to the displacements there that satisfy the
    /// joints, which move on from the jumps `last` towards the `expected` ones.
    pub fn settle(&mut self, b: &[f64], joints: Joints, last: &[f64], expected: &[f64]) -> Result<Solution, Unsettled> {
        let condensate = &self.contact.condensate;
        let free = condensate.jumps(&condensate.displacements(b));
        self.contact.solve(&Problem { joints, b, free: &free, last, expected })
    }
}
