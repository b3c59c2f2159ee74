//! The march through time: equal steps, cut in half where the joints do not settle, always back on the grid.

use super::condensed::{Condensed, Step};
use super::contact::Unsettled;
use super::system::{State, System, product};
use crate::model::case::{Newmark, Newton, Start};
use crate::sparse::{Factor, NotPositiveDefinite, Symbolic};

/// A step may be halved this often.
const MAX_CUTS: usize = 5;

pub struct March<'a> {
    system: &'a System,
    symbolic: &'a Symbolic,
    newmark: Newmark,
    options: Newton,
    /// K* for dt, dt/2, dt/4, ...; each made when first needed
    levels: Vec<Condensed>,
    dt: f64,
}

impl<'a> March<'a> {
    pub fn new(
        system: &'a System,
        symbolic: &'a Symbolic,
        newmark: Newmark,
        dt: f64,
        options: Newton,
    ) -> Result<March<'a>, NotPositiveDefinite> {
        let whole = Condensed::new(system, symbolic, newmark, dt, options)?;
        Ok(March { system, symbolic, newmark, options, levels: vec![whole], dt })
    }

    /// The state one whole step later, with the states between where it had to be cut.
    ///
    /// Error: the joints do not settle even in the shortest step; nothing unconverged is ever returned.
    pub fn advance(&mut self, old: &State) -> Result<Vec<Step>, Unsettled> {
        self.advance_at(0, old)
    }

    fn advance_at(&mut self, level: usize, old: &State) -> Result<Vec<Step>, Unsettled> {
        if level == self.levels.len() {
            let dt = self.dt / f64::powi(2., level as i32);
            let shorter = Condensed::new(self.system, self.symbolic, self.newmark, dt, self.options)
                .expect("a shorter step adds mass to a matrix that was positive definite");
            self.levels.push(shorter);
        }
        match self.levels[level].step(self.system, old) {
            Ok(step) => Ok(vec![step]),
            Err(unsettled) if level == MAX_CUTS => Err(unsettled),
            Err(_) => {
                let mut steps = self.advance_at(level + 1, old)?;
                let half_way = &steps.last().expect("an advance has at least one step").state;
                let rest = self.advance_at(level + 1, &half_way.clone())?;
                steps.extend(rest);
                Ok(steps)
            }
        }
    }
}

/// The state at t = 0, with the acceleration the start asks for.
pub fn initial_state(system: &System, symbolic: &Symbolic, start: Start) -> Result<State, NotPositiveDefinite> {
    let state = State::at_rest(system);
    match start {
        Start::Rest => Ok(state),
        Start::Equilibrium => {
            let mut a = system.load(0.);
            for (matrix, x) in [(&system.damping, &state.v), (&system.stiffness, &state.q)] {
                a.iter_mut().zip(&product(matrix, x)).for_each(|(a, p)| *a -= p);
            }
            let mass: Factor = symbolic.factor(&system.mass)?;
            mass.solve(&mut a);
            Ok(State { a, ..state })
        }
    }
}
