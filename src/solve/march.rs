//! The march through time: equal steps, cut in half where the joints do not settle, always back on the grid.

use super::contact::Unsettled;
use super::step::{Scheme, Step, Stepper};
use super::system::{State, System};
use crate::model::case::Newton;
use crate::sparse::{NotPositiveDefinite, Symbolic};

/// A step may be halved this often.
const MAX_CUTS: usize = 5;

pub struct March<'a> {
    system: &'a System,
    symbolic: &'a Symbolic,
    scheme: Scheme,
    options: Newton,
    /// for dt, dt/2, dt/4, ...; each made when first needed
    levels: Vec<Stepper>,
    dt: f64,
}

impl<'a> March<'a> {
    pub fn new(
        system: &'a System,
        symbolic: &'a Symbolic,
        scheme: Scheme,
        dt: f64,
        options: Newton,
    ) -> Result<March<'a>, NotPositiveDefinite> {
        let whole = Stepper::new(system, symbolic, scheme, dt, options)?;
        Ok(March { system, symbolic, scheme, options, levels: vec![whole], dt })
    }

    /// The state one whole step later, with the states between where it had to be cut.
    ///
    /// Error: the joints do not settle even in the shortest step; nothing unconverged is ever returned.
    pub fn advance(&mut self, old: &State) -> Result<Vec<Step>, Unsettled> {
        let mut steps = self.advance_at(0, old)?;
        if let Some(last) = steps.last_mut() {
            // Sums of steps drift from the grid by round-off.
            last.state.time = ((old.time / self.dt).round() + 1.) * self.dt;
        }
        Ok(steps)
    }

    fn advance_at(&mut self, level: usize, old: &State) -> Result<Vec<Step>, Unsettled> {
        if level == self.levels.len() {
            let dt = self.dt / f64::powi(2., level as i32);
            let shorter = Stepper::new(self.system, self.symbolic, self.scheme, dt, self.options)
                // it adds mass to a matrix that was positive definite: only a number too large can spoil it
                .map_err(|_| Unsettled { points: vec![] })?;
            self.levels.push(shorter);
        }
        let finite = |step: Step| if step.state.is_finite() { Ok(step) } else { Err(Unsettled { points: vec![] }) };
        match self.levels[level].step(self.system, old).and_then(finite) {
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
