//! The march through time: equal steps, cut in half where the joints do not settle, always back on the grid.

use super::energy::{joint_gain, mechanical};
use super::law::Scheme;
use super::step::{Step, Stepper, step_together};
use super::system::{State, System};
use super::unsettled::{Place, Unsettled};
use crate::model::case::Newton;
use crate::sparse::{NotPositiveDefinite, Symbolic};

/// A step may be halved this often.
pub const MAX_CUTS: usize = 5;

pub struct March<'a> {
    system: &'a System,
    symbolic: &'a Symbolic,
    scheme: Scheme,
    options: Newton,
    /// for dt, dt/2, dt/4, ...; each made when first needed
    levels: Vec<Stepper>,
    dt: f64,
    budget: Option<Budget>,
}

/// How much energy joints that open and close within steps may make.
struct Budget {
    /// of the largest stored energy, per time [1/s]
    rate: f64,
    /// the largest stored energy so far [J]
    peak: f64,
}

impl Budget {
    /// Newmark's force within a step is a straight line, a joint's is not where it opens or closes: the step then gains
    /// about kappa v^2 dt^2, a quarter of it after halving the step.
    fn allows(&mut self, system: &System, old: &State, step: &Step) -> bool {
        let new = step.state();
        self.peak = self.peak.max(mechanical(system, new, step.forms));
        joint_gain(system, old, new) <= self.rate * (new.time - old.time) * self.peak
    }
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
        Ok(March { system, symbolic, scheme, options, levels: vec![whole], dt, budget: None })
    }

    /// Cuts steps also where joints make more energy than `rate` [1/s] times the step times the largest stored energy.
    pub fn with_energy_budget(self, rate: Option<f64>) -> March<'a> {
        March { budget: rate.map(|rate| Budget { rate, peak: 0. }), ..self }
    }

    /// The march of another system that differs in loads and friction only, over the same factor.
    pub fn sharing_factor(&self, system: &'a System) -> March<'a> {
        March {
            system,
            levels: vec![self.levels[0].sharing_factor()],
            budget: self.budget.as_ref().map(|b| Budget { peak: 0., ..*b }),
            ..*self
        }
    }

    /// The state one whole step later, with the states between where it had to be cut.
    ///
    /// Error: the joints do not settle even in the shortest step; nothing unconverged is ever returned.
    pub fn advance(&mut self, old: &Step) -> Result<Vec<Step>, Unsettled> {
        let whole = self.levels[0].step(self.system, old);
        self.on_the_grid(whole, old)
    }

    /// [`March::advance`] of up to [`MOST_TOGETHER`](super::step::MOST_TOGETHER) marches over the same factor.
    pub fn advance_together(marches: &mut [&mut March], old: &[&Step]) -> Vec<Result<Vec<Step>, Unsettled>> {
        let systems: Vec<&System> = marches.iter().map(|march| march.system).collect();
        let mut steppers: Vec<&mut Stepper> = marches.iter_mut().map(|march| &mut march.levels[0]).collect();
        let whole = step_together(&mut steppers, &systems, old);
        marches.iter_mut().zip(whole).zip(old).map(|((march, whole), old)| march.on_the_grid(whole, old)).collect()
    }

    fn on_the_grid(&mut self, whole: Result<Step, Unsettled>, old: &Step) -> Result<Vec<Step>, Unsettled> {
        let mut steps = self.or_in_halves(0, whole, old)?;
        // Sums of steps drift from the grid by round-off.
        let time = ((old.state().time / self.dt).round() + 1.) * self.dt;
        let last = steps.pop().map(|last| last.at(time));
        steps.extend(last);
        Ok(steps)
    }

    fn advance_at(&mut self, level: usize, old: &Step) -> Result<Vec<Step>, Unsettled> {
        if level == self.levels.len() {
            let dt = self.dt / f64::powi(2., level as i32);
            let shorter = Stepper::new(self.system, self.symbolic, self.scheme, dt, self.options)
                // it adds mass to a matrix that was positive definite: only a number too large can spoil it
                .map_err(|_| Unsettled::Overflow(Place::Matrix))?;
            self.levels.push(shorter);
        }
        let whole = self.levels[level].step(self.system, old);
        self.or_in_halves(level, whole, old)
    }

    fn or_in_halves(
        &mut self,
        level: usize,
        whole: Result<Step, Unsettled>,
        old: &Step,
    ) -> Result<Vec<Step>, Unsettled> {
        let system = self.system;
        match whole {
            tried if level == MAX_CUTS => Ok(vec![tried?]),
            Ok(step) if self.budget.as_mut().is_none_or(|b| b.allows(system, old.state(), &step)) => Ok(vec![step]),
            _ => {
                let mut steps = self.advance_at(level + 1, old)?;
                let half_way = steps.last().expect("an advance has at least one step");
                let rest = self.advance_at(level + 1, half_way)?;
                steps.extend(rest);
                Ok(steps)
            }
        }
    }
}
