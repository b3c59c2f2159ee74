//! From a model to a system that is ready to march: matrices, natural modes, damping.

use super::damping;
use super::memory::refuse_too_large;
use super::orders;
use crate::model::case::{Analysis, Rayleigh as Damping};
use crate::model::resolve::Model;
use crate::number::place;
use crate::solve::modes::{NaturalMode, natural_modes, rayleigh};
use crate::solve::system::{Rayleigh, System};
use crate::sparse::{NotPositiveDefinite, Orders, Symbolic};
use crate::{Error, Result};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Modes told in every summary; near-equal ones follow the first two of the paper's case.
const MODES: usize = 4;

pub struct Prepared {
    pub model: Arc<Model>,
    pub system: Arc<System>,
    pub symbolic: Arc<Symbolic>,
    pub modes: Arc<[NaturalMode]>,
    pub rayleigh: Rayleigh,
    pub orders: Arc<Orders>,
    /// assembly and ordering
    pub setup: Duration,
    /// factor and modes
    pub factor: Duration,
}

impl Prepared {
    /// With the elimination orders that are kept beside the mesh; those that are found are left there.
    pub fn beside(mesh: &Path, mut model: Model) -> Result<Prepared> {
        model.warnings.extend(orders::in_the_way(mesh));
        let prepared = Prepared::ordered(model, orders::beside(mesh))?;
        orders::keep(mesh, &prepared.orders);
        Ok(prepared)
    }

    pub fn new(model: Model) -> Result<Prepared> {
        Prepared::ordered(model, Orders::default())
    }

    fn ordered(mut model: Model, orders: Orders) -> Result<Prepared> {
        let start = Instant::now();
        let system = System::ordered(&model, &orders)?;
        if system.unknowns.count == 0 {
            return Err(Error::input("nothing can move: supports hold every node of the mesh"));
        }
        let symbolic = Arc::new(system.symbolic());
        refuse_too_large(system.unknowns.count, &symbolic)?;
        let setup = start.elapsed();

        let start = Instant::now();
        // Statics has neither inertia nor damping, so no modes to take them from.
        let moves = model.analysis == Analysis::Dynamic;
        let damping = model.damping.filter(|_| moves).map(|d| d.rayleigh);
        refuse_high_modes(damping, system.unknowns.count)?;
        let modes = if moves { modes_of(&model, &system, &symbolic, &orders, needed_modes(damping))? } else { vec![] };
        let rayleigh = coefficients(damping, &modes)?;
        model.warnings.extend(damping::warnings(&model, rayleigh));
        let joints = model.damping.is_some_and(|d| d.interfaces);
        let system = system.with_damping(rayleigh, joints);
        Ok(Prepared {
            model: model.into(),
            system: system.into(),
            symbolic,
            modes: modes.into(),
            rayleigh,
            orders: orders.into(),
            setup,
            factor: start.elapsed(),
        })
    }

    /// Likewise for a model that differs in loads and friction only: nothing is assembled, ordered or solved again.
    pub fn with_loads_of(&self, mut model: Model) -> Result<Prepared> {
        model.warnings.extend(damping::warnings(&model, self.rayleigh));
        Ok(Prepared {
            system: self.system.with_loads_of(&model)?.into(),
            model: model.into(),
            symbolic: self.symbolic.clone(),
            modes: self.modes.clone(),
            rayleigh: self.rayleigh,
            orders: self.orders.clone(),
            setup: self.setup,
            factor: self.factor,
        })
    }

    /// The lowest `count` natural modes.
    pub fn natural_modes(&self, count: usize) -> Result<Vec<NaturalMode>> {
        modes_of(&self.model, &self.system, &self.symbolic, &self.orders, count)
    }

    /// Where a matrix stopped being positive definite, in the user's words.
    pub fn not_definite(&self, error: NotPositiveDefinite) -> Error {
        let place = place(self.model.mesh.points[self.system.unknowns.node_of(error.unknown)]);
        Error::input(format!(
            "the equations have no unique solution near {place}: is an element folded, or its mass zero?"
        ))
    }

    pub fn frequencies(&self) -> Vec<f64> {
        self.modes.iter().map(|m| m.frequency).collect()
    }
}

/// What lets waves out has no modes of its own: they are those of the model as its boundaries hold it in a static
/// stage.
fn modes_of(
    model: &Model,
    system: &System,
    symbolic: &Symbolic,
    orders: &Orders,
    count: usize,
) -> Result<Vec<NaturalMode>> {
    if model.absorbers.is_empty() {
        return natural_modes(system, symbolic, count);
    }
    let held = System::ordered(&model.held(), orders)?;
    if held.unknowns.count == 0 {
        return Ok(vec![]);
    }
    let modes = natural_modes(&held, &held.symbolic(), count)?;
    let released = |m: NaturalMode| NaturalMode {
        shape: system.unknowns.from_nodes(&held.unknowns.at_nodes(&m.shape)),
        frequency: m.frequency,
    };
    Ok(modes.into_iter().map(released).collect())
}

/// The highest mode that damping may be fitted at: finding more takes minutes, and no load of a blast lives there.
const HIGHEST_MODE: usize = 200;

fn refuse_high_modes(damping: Option<Damping>, unknowns: usize) -> Result<()> {
    match (damping, needed_modes(damping)) {
        (Some(Damping::Ratio { .. }), needed) if needed > HIGHEST_MODE && unknowns > HIGHEST_MODE => {
            Err(Error::input(format!(
                "damping.modes asks for mode {needed} of {unknowns} at most; choose among the first {HIGHEST_MODE}, since to find more \
                 takes minutes, or fit a higher frequency by alpha and beta"
            )))
        }
        _ => Ok(()),
    }
}

fn needed_modes(damping: Option<Damping>) -> usize {
    match damping {
        Some(Damping::Ratio { modes: [i, j], .. }) => MODES.max(i).max(j),
        _ => MODES,
    }
}

fn coefficients(damping: Option<Damping>, modes: &[NaturalMode]) -> Result<Rayleigh> {
    match damping {
        None => Ok(Rayleigh::default()),
        Some(Damping::Coefficients { alpha, beta }) => Ok(Rayleigh { alpha, beta }),
        Some(Damping::Ratio { ratio, modes: numbers }) => {
            let frequency = |i: usize| {
                modes.get(i - 1).map(|m| m.frequency).ok_or_else(|| {
                    Error::input(format!(
                        "damping.modes asks for mode {i}; this mesh has only {} modes of its own",
                        modes.len()
                    ))
                })
            };
            let [f_1, f_2] = [frequency(numbers[0])?, frequency(numbers[1])?];
            if f_1 == 0. || f_2 == 0. {
                return Err(Error::input(
                    "damping.modes: a mode at 0 Hz is a rigid motion, which Rayleigh's ratio cannot damp; choose modes above it, hold \
                     the mesh by supports, or give alpha and beta",
                ));
            }
            Ok(rayleigh(ratio, [f_1, f_2]))
        }
    }
}
