//! One Newmark step with contact at the price of a linear one: everything but the joints is linear, so
//! K* = a0 M + a1 C + K is factored once, with the jumps last.
//!
//! A step is one forward sweep, Newton on the jumps with their Schur complement S = L_cc L_cc', one backward sweep.

use super::contact::{Contact, JointDamping, Problem, Unsettled};
use super::interface::JointState;
use super::newmark::Constants;
use super::system::{State, System, combine, product};
use crate::model::case::{Newmark, Newton};
use crate::sparse::{Factor, NotPositiveDefinite, Symbolic};
use faer::Mat;

/// K* factored for one length of step.
pub struct Condensed {
    pub constants: Constants,
    factor: Factor,
    /// L_cc, lower triangular: the last rows and columns of L
    trailing: Mat<f64>,
    contact: Contact,
}

/// An accepted step.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    pub state: State,
    pub iterations: usize,
    /// the paper's test (19), on the jumps
    pub displacement_test: f64,
}

impl Condensed {
    pub fn new(
        system: &System,
        symbolic: &Symbolic,
        newmark: Newmark,
        dt: f64,
        options: Newton,
    ) -> Result<Condensed, NotPositiveDefinite> {
        let constants = Constants::new(newmark, dt);
        let effective =
            combine(&[(1., &system.stiffness), (constants.a0, &system.mass), (constants.a1, &system.damping)]);
        let factor = symbolic.factor(&effective)?;
        let trailing = factor.trailing(system.interface.count);
        let contact = Contact::new(&trailing * trailing.transpose(), options);
        Ok(Condensed { constants, factor, trailing, contact })
    }

    /// From one state to the next, `constants.dt` later; the old one is not touched.
    pub fn step(&mut self, system: &System, old: &State) -> Result<Step, Unsettled> {
        let time = old.time + self.constants.dt;
        let mut q = self.right_hand_side(system, old, time);
        self.factor.forward(&mut q);
        let (joints, iterations, displacement_test) = self.solve_jumps(system, old, &mut q)?;
        self.factor.backward(&mut q);

        let before = |i: usize| [old.q[i], old.v[i], old.a[i]];
        let a: Vec<f64> = (0..q.len()).map(|i| self.constants.acceleration(q[i], before(i))).collect();
        let v = (0..q.len()).map(|i| self.constants.velocity(a[i], before(i))).collect();
        Ok(Step { state: State { time, q, v, a, joints }, iterations, displacement_test })
    }

    /// f(t) + M (a0 q + a2 v + a3 a) + C (a1 q + a4 v + a5 a).
    fn right_hand_side(&self, system: &System, old: &State, time: f64) -> Vec<f64> {
        let before = |i: usize| [old.q[i], old.v[i], old.a[i]];
        let n = old.q.len();
        let for_mass: Vec<f64> = (0..n).map(|i| self.constants.for_mass(before(i))).collect();
        let for_damping: Vec<f64> = (0..n).map(|i| self.constants.for_damping(before(i))).collect();
        let mut rhs = system.load(time);
        for (matrix, x) in [(&system.mass, &for_mass), (&system.damping, &for_damping)] {
            let product = product(matrix, x);
            rhs.iter_mut().zip(&product).for_each(|(r, p)| *r += p);
        }
        rhs
    }

    /// Between the sweeps: y_c = L_cc^-1 (...) becomes L_cc' j with j the jumps that satisfy the joints.
    fn solve_jumps(
        &mut self,
        system: &System,
        old: &State,
        y: &mut [f64],
    ) -> Result<(Vec<JointState>, usize, f64), Unsettled> {
        if system.interface.count == 0 {
            return Ok((vec![], 0, 0.));
        }
        let y_c = &mut y[system.unknowns.first_jump..];
        let problem = Problem {
            interface: &system.interface,
            right_hand_side: &lower_times(&self.trailing, y_c),
            old: &old.joints,
            damping: self.joint_damping(system, old),
        };
        let solution = self.contact.solve(&problem, system.jumps(&old.q))?;
        y_c.copy_from_slice(&lower_transposed_times(&self.trailing, &solution.jumps));
        let joints = solution.responses.iter().map(JointState::from).collect();
        Ok((joints, solution.iterations, solution.displacement_test))
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
