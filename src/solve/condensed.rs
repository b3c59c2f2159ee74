//! A system with contact at the price of a linear one: everything but the joints is linear, so its matrix is factored once,
//! with the jumps last. Solving takes one forward sweep, Newton on the jumps, one backward sweep.

use super::contact::{Contact, JointDamping, Problem, Unsettled};
use super::interface::JointState;
use super::system::System;
use crate::model::case::Newton;
use crate::sparse::{Factor, NotPositiveDefinite, Symbolic};
use faer::Mat;
use sprs::CsMat;

/// A x + r(j) = b with x the unknowns, j the jumps at their end, r the joint forces.
pub struct Condensed {
    factor: Factor,
    /// L_cc, lower triangular: the last rows and columns of the factor
    trailing: Mat<f64>,
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
                let closed = system.interface.points.iter().map(|p| p.law.closed_stiffness());
                system.interface.each_tangent(closed, |i, j, value| schur[(i, j)] -= value);
                Contact::new(schur, options).stabilised()
            }
        };
        Ok(Condensed { factor, trailing, contact })
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
        self.factor.forward(&mut x);
        // Between the sweeps y_c = L_cc^-1 (...) becomes L_cc' j, with j the jumps that satisfy the joints.
        let y_c = &mut x[system.unknowns.first_jump..];
        let right_hand_side = lower_times(&self.trailing, y_c);
        let problem = Problem { interface: &system.interface, right_hand_side: &right_hand_side, old, damping };
        let solution = self.contact.solve(&problem, guess)?;
        y_c.copy_from_slice(&lower_transposed_times(&self.trailing, &solution.jumps));
        self.factor.backward(&mut x);
        Ok(Solved {
            x,
            joints: solution.responses.iter().map(JointState::from).collect(),
            iterations: solution.iterations,
            displacement_test: solution.displacement_test,
        })
    }
}

/// L x.
fn lower_times(l: &Mat<f64>, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.; x.len()];
    for (j, xj) in x.iter().enumerate() {
        let column = &l.col_as_slice(j)[j..];
        y[j..].iter_mut().zip(column).for_each(|(y, l)| *y += l * xj);
    }
    y
}

/// L' x.
fn lower_transposed_times(l: &Mat<f64>, x: &[f64]) -> Vec<f64> {
    let column = |j: usize| l.col_as_slice(j)[j..].iter().zip(&x[j..]);
    (0..x.len()).map(|j| column(j).map(|(l, x)| l * x).sum()).collect()
}
