//! The march through time: equal steps, cut in half where the joints do not settle or make energy, always back on the
//! grid.

use super::energy::Ledger;
use super::law::Scheme;
use super::step::{Step, Stepper, step_together};
use super::system::{State, System};
use super::unsettled::{Place, Unsettled};
use crate::model::case::Newton;
use crate::model::resolve::EnergyTolerance;
use crate::sparse::{NotPositiveDefinite, Symbolic};

/// A step may be halved this often.
pub const MAX_CUTS: usize = 5;

/// Whole steps in a row at whose end joints may have made more energy than is tolerated. Soon after a load begins the
/// energy supplied is small beside what one first slip makes.
pub const PATIENCE: usize = 20;

/// An accepted step with the energies up to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Accepted {
    pub step: Step,
    pub ledger: Ledger,
    /// whole steps in a row at whose end joints had made more energy than is tolerated
    excessive: usize,
}

impl Accepted {
    /// The state at t = 0, with `origin` the equilibrium under gravity.
    pub fn start(system: &System, state: State, origin: &State) -> Accepted {
        Accepted { ledger: Ledger::start(system, &state, origin), step: Step::start(state), excessive: 0 }
    }

    pub fn state(&self) -> &State {
        self.step.state()
    }

    fn then(&self, system: &System, step: Step) -> Accepted {
        let ledger = self.ledger.after(system, self.state(), step.state(), step.forms);
        Accepted { ledger, step, excessive: self.excessive }
    }
}

pub struct March<'a> {
    system: &'a System,
    symbolic: &'a Symbolic,
    scheme: Scheme,
    options: Newton,
    /// for dt, dt/2, dt/4, ...; each made when first needed
    levels: Vec<Stepper>,
    dt: f64,
    /// none: joints may make any energy
    tolerance: Option<EnergyTolerance>,
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
        Ok(March { system, symbolic, scheme, options, levels: vec![whole], dt, tolerance: None })
    }

    /// Cuts steps also where joints make energy, and ends where they have made more than is tolerated.
    pub fn with_energy_tolerance(self, tolerance: Option<EnergyTolerance>) -> March<'a> {
        March { tolerance, ..self }
    }

    /// The march of another system that differs in loads and friction only, over the same factor.
    pub fn sharing_factor(&self, system: &'a System) -> March<'a> {
        March { system, levels: vec![self.levels[0].sharing_factor()], ..*self }
    }

    /// The state one whole step later, with the states between where it had to be cut.
    ///
    /// Errors: the joints do not settle even in the shortest step, or have made too much energy for too long; nothing
    /// unconverged is ever returned.
    pub fn advance(&mut self, old: &Accepted) -> Result<Vec<Accepted>, Unsettled> {
        let whole = self.levels[0].step(self.system, &old.step);
        self.on_the_grid(whole, old)
    }

    /// [`March::advance`] of up to [`MOST_TOGETHER`](super::step::MOST_TOGETHER) marches over the same factor.
    pub fn advance_together(marches: &mut [&mut March], old: &[&Accepted]) -> Vec<Result<Vec<Accepted>, Unsettled>> {
        let systems: Vec<&System> = marches.iter().map(|march| march.system).collect();
        let steps: Vec<&Step> = old.iter().map(|old| &old.step).collect();
        let mut steppers: Vec<&mut Stepper> = marches.iter_mut().map(|march| &mut march.levels[0]).collect();
        let whole = step_together(&mut steppers, &systems, &steps);
        marches.iter_mut().zip(whole).zip(old).map(|((march, whole), old)| march.on_the_grid(whole, old)).collect()
    }

    /// Whether joints had made more energy than is tolerated when the march ended.
    ///
    /// Error: they had.
    pub fn may_end_at(&self, last: &Accepted) -> Result<(), Unsettled> {
        if last.excessive == 0 { Ok(()) } else { Err(too_much_energy(&last.ledger)) }
    }

    fn on_the_grid(&mut self, whole: Result<Step, Unsettled>, old: &Accepted) -> Result<Vec<Accepted>, Unsettled> {
        let mut accepted = self.or_in_halves(0, whole, old)?;
        // Sums of steps drift from the grid by round-off.
        let time = ((old.state().time / self.dt).round() + 1.) * self.dt;
        let last = accepted.pop().expect("an advance has at least one step");
        let is_excessive = self.tolerance.is_some_and(|tolerance| last.ledger.has_made_more_than(tolerance.share));
        let excessive = if is_excessive { old.excessive + 1 } else { 0 };
        if excessive > PATIENCE {
            return Err(too_much_energy(&last.ledger));
        }
        accepted.push(Accepted { step: last.step.at(time), excessive, ..last });
        Ok(accepted)
    }

    fn advance_at(&mut self, level: usize, old: &Accepted) -> Result<Vec<Accepted>, Unsettled> {
        if level == self.levels.len() {
            let dt = self.dt / f64::powi(2., level as i32);
            let shorter = Stepper::new(self.system, self.symbolic, self.scheme, dt, self.options)
                // it adds mass to a matrix that was positive definite: only a number too large can spoil it
                .map_err(|_| Unsettled::Overflow(Place::Matrix))?;
            self.levels.push(shorter);
        }
        let whole = self.levels[level].step(self.system, &old.step);
        self.or_in_halves(level, whole, old)
    }

    fn or_in_halves(
        &mut self,
        level: usize,
        whole: Result<Step, Unsettled>,
        old: &Accepted,
    ) -> Result<Vec<Accepted>, Unsettled> {
        let whole = whole.map(|step| old.then(self.system, step));
        match whole {
            tried if level == MAX_CUTS => Ok(vec![tried?]),
            Ok(new) if self.tolerates(old, &new) => Ok(vec![new]),
            _ => {
                let mut accepted = self.advance_at(level + 1, old)?;
                let half_way = accepted.last().expect("an advance has at least one step");
                let rest = self.advance_at(level + 1, half_way)?;
                accepted.extend(rest);
                Ok(accepted)
            }
        }
    }

    /// Newmark's force within a step is a straight line, a joint's is not where it opens or closes: the step then gains
    /// about kappa v^2 dt^2, a quarter of it after halving the step.
    fn tolerates(&self, old: &Accepted, new: &Accepted) -> bool {
        let Some(EnergyTolerance { free, rate, .. }) = self.tolerance else { return true };
        let gain = old.ledger.now.contact - new.ledger.now.contact;
        let dt = new.state().time - old.state().time;
        gain <= rate * dt * new.ledger.supplied || !new.ledger.has_made_more_than(free)
    }
}

fn too_much_energy(ledger: &Ledger) -> Unsettled {
    Unsettled::Energy { made: ledger.made, supplied: ledger.supplied }
}
