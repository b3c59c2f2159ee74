//! `coralpipe run`: from the case to the results folder.

use super::cost::Cost;
use super::finished::finished;
use super::inputs::{made_from, replaced};
use super::mesh::{self, Meshed};
use super::prepare::Prepared;
use super::recorder::{Ending, Recorder};
use super::screen::{Screen, tell};
use super::unsettled;
use crate::escape::one_line;
use crate::model::case::{Analysis, Case};
use crate::model::hold::{refuse_loose, unheld_parts};
use crate::model::idle::{excitation, idle};
use crate::model::implausible::implausible;
use crate::model::initial::Initial;
use crate::model::locking;
use crate::model::openings::Openings;
use crate::model::resolve::Model;
use crate::model::unresolved;
use crate::number::seconds;
use crate::results::file;
use crate::results::folder::Folder;
use crate::results::grid::Grid;
use crate::results::ring;
use crate::results::summary::Timing;
use crate::solve::law::Scheme;
use crate::solve::march::{Accepted, March};
use crate::solve::start;
use crate::solve::step::{Step, Stepper};
use crate::solve::system::{State, System};
use crate::sparse::{NotPositiveDefinite, Symbolic};
use crate::threads::both;
use crate::{Error, Result};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;
use std::time::Instant;

/// What the command line asks for.
#[derive(Debug, Clone)]
pub struct Request {
    pub case: PathBuf,
    /// constants of the script
    pub geo: BTreeMap<String, f64>,
    /// PATH=VALUE changes of the case
    pub sets: Vec<String>,
    pub mesh: Option<PathBuf>,
    pub out: Option<PathBuf>,
    pub bonded: bool,
    pub quiet: bool,
    /// whatever its size
    pub large: bool,
}

impl Request {
    /// The results folder: `--out`, or `output/NAME` under the working folder.
    pub fn folder(&self, case: &Case) -> PathBuf {
        self.out.clone().unwrap_or_else(|| Path::new("output").join(case.name()))
    }
}

/// Set by Ctrl-C: the run stops after the step it is at, with all files valid.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);
/// Set while a run writes results.
static MARCHING: AtomicBool = AtomicBool::new(false);

/// What Ctrl-C does: a march stops after the step it is at; all else, and a march that is asked twice, ends at once.
pub fn interrupt() {
    if !MARCHING.load(Relaxed) || INTERRUPTED.swap(true, Relaxed) {
        tell("coralpipe: interrupted");
        std::process::exit(130);
    }
}

/// From now on Ctrl-C ends the run after a whole step.
pub(super) fn begin_to_write() {
    MARCHING.store(true, Relaxed);
}

/// Whether Ctrl-C was pressed: what stopped then was stopped by it.
pub(super) fn interrupted() -> bool {
    INTERRUPTED.load(Relaxed)
}

/// A case with its mesh and model: what most commands start from.
pub struct Loaded {
    pub case: Case,
    pub meshed: Meshed,
    pub model: Model,
}

pub fn load(request: &Request) -> Result<Loaded> {
    let Loaded { case, meshed, mut model } = load_structure(request)?;
    model.warnings.extend(excitation(&case, &model));
    Ok(Loaded { case, meshed, model })
}

/// Without a word about loads and initial motion, which natural modes do not depend on.
pub fn load_structure(request: &Request) -> Result<Loaded> {
    let case = Case::read(&request.case, &request.sets)?;
    let meshed = mesh::obtain(&case, &request.geo, request.mesh.as_deref())?;
    let model = structure(&case, &meshed, request.bonded, &Openings::default())?;
    Ok(Loaded { case, meshed, model })
}

/// With what is known of the mesh's `openings`: a single run keeps none.
pub(super) fn model(case: &Case, meshed: &Meshed, bonded: bool, openings: &Openings) -> Result<Model> {
    let mut model = structure(case, meshed, bonded, openings)?;
    model.warnings.extend(excitation(case, &model));
    Ok(model)
}

fn structure(case: &Case, meshed: &Meshed, bonded: bool, openings: &Openings) -> Result<Model> {
    let mut model = Model::opened(case, &meshed.mesh, bonded, openings)?;
    model.warnings.extend(idle(case, &model));
    model.warnings.extend(unheld_parts(&model));
    model.warnings.extend(locking::warnings(&model));
    model.warnings.extend(implausible(case, &model));
    model.warnings.extend(unresolved::warnings(&model));
    model.warnings.extend(meshed.warnings.iter().cloned());
    Ok(model)
}

/// `coralpipe run`: solves the case and returns the table of what came out; the files are in the results folder.
///
/// Errors: bad input (nothing of an earlier run is touched), no convergence or an interrupt (all until then is on
/// disk).
pub fn command(request: &Request) -> Result<String> {
    let started = Instant::now();
    solve(request, load(request)?, started)
}

/// `coralpipe run --unless-done`: as [`command`], but nothing is computed where the folder has the results of this very
/// case and mesh by this program.
pub fn unless_done(request: &Request) -> Result<String> {
    let started = Instant::now();
    let loaded = load(request)?;
    let folder = request.folder(&loaded.case);
    match finished(&folder, &made_from(&loaded.case, &loaded.meshed, request), true) {
        Some(_) => Ok(format!("results in {} are those of this case and mesh\n", folder.display())),
        None => solve(request, loaded, started),
    }
}

fn solve(request: &Request, loaded: Loaded, started: Instant) -> Result<String> {
    let screen = Screen::new(request.quiet);
    let Loaded { case, meshed, mut model } = loaded;
    refuse_loose(&model)?;
    let cost = Cost::of_run(&case, &meshed.mesh, true);
    model.warnings.extend(cost.allowed(&request.folder(&case), request.large)?);
    model.warnings.extend(ring::uncut(&model));
    screen.say(&meshed.told);
    model.warnings.iter().for_each(|w| screen.warn(w));
    let told = model.warnings.len();
    let mut prepared = Prepared::beside(&meshed.path, model)?;
    prepared.model.warnings[told..].iter().for_each(|w| screen.warn(w));
    screen.say(&format!("{} unknowns, {} joints", prepared.system.unknowns.count, prepared.model.joints.len()));

    let factoring = Instant::now();
    let rest = under_gravity(&mut prepared)?;
    let prepared = prepared;
    let (state, origin, mut march) = ready_to_march(&prepared, rest)?;
    let timing = Timing {
        mesh_s: meshed.took.as_secs_f64(),
        setup_s: prepared.setup.as_secs_f64(),
        factor_s: (prepared.factor + factoring.elapsed()).as_secs_f64(),
        ..Timing::default()
    };
    let inputs = made_from(&case, &meshed, request);
    begin_to_write();
    let path = request.folder(&case);
    let replaced = replaced(&path, &inputs);
    file::create_folder(&path)?;
    let folder = Folder::prepare(&path, &case.name())?;
    replaced.iter().for_each(|sentence| screen.say(sentence));
    let start = Accepted::start(&prepared.system, state, &origin);
    let march_and_write = || {
        let grid = Grid::new(&prepared.model, &prepared.system);
        let mut recorder = Recorder::start(&prepared, &folder, &start, origin, Some(grid.into()))?;
        let (ending, error) = march_to_end(&prepared, &mut march, &mut recorder, start, &screen)?;
        let mut summary = recorder.finish(ending, inputs, &case.title, timing)?;
        summary.timing.total_s = started.elapsed().as_secs_f64();
        folder.write_summary(&summary.to_json())?;
        summary.warnings.iter().for_each(|w| screen.warn(w)); // those of the beginning are not repeated
        error.map_or(Ok(summary), Err)
    };
    let summary = march_and_write().map_err(|error| with_what_is_left(error, &folder))?;
    folder.remove_previous()?;
    Ok(summary.table() + &one_line(&format!("results in {}", folder.path().display())) + "\n")
}

/// The state at t = 0, the one that displacements are counted from, and the march from there.
fn ready_to_march(prepared: &Prepared, rest: State) -> Result<(State, State, March<'_>)> {
    let (start, march) = both(|| at_start(prepared, rest), || new_march(prepared));
    let (state, origin) = start?;
    Ok((state, origin, march?))
}

/// The march of a case, its matrix factored.
pub(super) fn new_march(prepared: &Prepared) -> Result<March<'_>> {
    let Prepared { model, system, symbolic, .. } = prepared;
    let scheme = match model.analysis {
        Analysis::Static => Scheme::Static,
        Analysis::Dynamic => Scheme::Dynamic(model.integrator),
    };
    let tolerance = (model.analysis == Analysis::Dynamic).then_some(model.time.energy);
    let march = March::new(system, symbolic, scheme, model.time.step, model.newton);
    Ok(march.map_err(|e| prepared.not_definite(e))?.with_energy_tolerance(tolerance))
}

/// The state at t = 0 from equilibrium under gravity, and the one that displacements are counted from.
pub(super) fn at_start(prepared: &Prepared, rest: State) -> Result<(State, State)> {
    let Prepared { model, system, symbolic, .. } = prepared;
    let (state, origin) = match model.analysis {
        Analysis::Static => {
            let mut at_once = Stepper::new(system, symbolic, Scheme::Static, 0., model.newton).map_err(not_held)?;
            let start = at_once.step(system, &Step::start(rest)).map_err(|why| unsettled::at_start(prepared, &why))?;
            (start.into_state(), State::at_rest(system))
        }
        Analysis::Dynamic => {
            let Initial { displacement, velocity } = &model.initial;
            let origin = rest.clone();
            let moving = start::with_motion(system, rest, displacement, velocity);
            let state = start::with_acceleration(system, symbolic, moving, model.start);
            (state.map_err(|e| prepared.not_definite(e))?, origin)
        }
    };
    if !state.is_finite() {
        return Err(Error::input(
            "the state at t = 0 has numbers too large for a computer: check loads, gravity, densities and the initial motion",
        ));
    }
    Ok((state, origin))
}

/// Equilibrium under gravity. Boundaries that let waves out hold the ground in it, and go on to push as they did.
pub(super) fn under_gravity(prepared: &mut Prepared) -> Result<State> {
    let settle = |prepared: &Prepared, system: &System, symbolic: &Symbolic| {
        let found = start::under_gravity(system, symbolic, prepared.model.newton).map_err(not_held)?;
        found.map_err(|why| unsettled::at_start(prepared, &why))
    };
    if prepared.model.gravity == 0. || prepared.model.absorbers.is_empty() {
        return settle(prepared, &prepared.system, &prepared.symbolic);
    }
    let held = System::ordered(&prepared.model.held(), &prepared.orders)?;
    let rest = settle(prepared, &held, &held.symbolic())?;
    let (state, reactions) = start::released(&prepared.system, &held, &rest);
    Arc::get_mut(&mut prepared.system).expect("nobody has taken a share of it yet").reactions = Some(reactions);
    Ok(state)
}

/// Statics without inertia: the only way to be singular is not to be held.
fn not_held(_: NotPositiveDefinite) -> Error {
    Error::input("nothing holds the mesh, or a part of it, against a steady load: add a support in x and in y")
}

fn march_to_end(
    prepared: &Prepared,
    march: &mut March,
    recorder: &mut Recorder,
    start: Accepted,
    screen: &Screen,
) -> Result<(Ending, Option<Error>)> {
    let time = prepared.model.time;
    let progress = screen.progress(time.steps);
    let mut last = start;
    for number in 1..=time.steps {
        let now = last.state().time;
        if interrupted() {
            let sentence = format!("interrupted at t = {}, after step {} of {}", seconds(now), number - 1, time.steps);
            return Ok((Ending::Interrupted, Some(Error::Interrupted(sentence))));
        }
        last = match march.advance(&last) {
            Ok(steps) => recorder.record(number, last, steps)?,
            Err(why) => {
                let error = unsettled::in_step(prepared, &why, now, number);
                return Ok((Ending::NoConvergence, Some(error)));
            }
        };
        progress.step(number);
    }
    Ok(match march.may_end_at(&last) {
        Ok(()) => (Ending::Done, None),
        Err(why) => (Ending::NoConvergence, Some(unsettled::at_end(prepared, &why))),
    })
}

fn with_what_is_left(error: Error, folder: &Folder) -> Error {
    let path = folder.path().display();
    let kept = match folder.has_previous() {
        true => format!("; the results of an earlier run are in {path}/previous"),
        false => String::new(),
    };
    let whole = |sentence: String| format!("{sentence}; what was computed until then is in {path}{kept}");
    match error {
        Error::NoConvergence(s) => Error::NoConvergence(whole(s)),
        Error::Interrupted(s) => Error::Interrupted(whole(s)),
        Error::Input(s) => Error::Input(s + &kept),
    }
}
