//! `coralpipe converge`: what mesh and time step leave of each peak's digits, by Richardson's extrapolation.
//!
//! The case is computed on three meshes, each finer than the one before by the same ratio, and with three time steps;
//! the two errors add up.

mod report;

use crate::model::case::Case;
use crate::model::mesh::Mesh;
use crate::model::resolve::Model;
use crate::number::short;
use crate::results::histories::Peak;
use crate::study::cost::Cost;
use crate::study::mesh;
use crate::study::quantity::Quantity;
use crate::study::richardson::Estimate;
use crate::study::run::{self, Loaded, Request};
use crate::study::screen::{Screen, show_copy};
use crate::study::script::Script;
use crate::study::series::{self, Member, Series, Variant};
use crate::{Error, Result};
use std::collections::BTreeMap;

/// What the command line asks of the study.
#[derive(Debug, Clone)]
pub struct Options {
    /// quantities, none for every probe's displacement and acceleration
    pub compare: Vec<String>,
    /// the script's constant that all element sizes are divided by
    pub refine: String,
    /// a mesh's fineness over that of the one before
    pub ratio: f64,
}

/// A time step over the next finer one: halves of a step fall on the same times.
const STEP_RATIO: f64 = 2.;

/// One of the two ways to refine, the runs from the case itself to the finest.
struct Ladder {
    name: &'static str,
    ratio: f64,
    members: Vec<Member>,
    /// for each quantity, for each member
    peaks: Vec<[Peak; 3]>,
}

/// A quantity's peak in the case itself, and what the ladders say of it.
struct Finding {
    quantity: Quantity,
    value: f64,
    estimates: [Estimate; 2],
    /// why it cannot converge, whatever the numbers look like
    hopeless: Option<&'static str>,
    /// an acceleration under a load that jumps
    only_damping_bounds_it: bool,
}

/// Share of the value from which on an error says that there is no value.
const USELESS: f64 = 0.2;

/// Writes `converge.csv`, `converge.json`, `converge.svg` and a folder for each run into `output/NAME/converge/`;
/// returns the table.
///
/// Errors: bad input; an interrupt, with the finished runs kept.
pub fn command(request: &Request, options: &Options) -> Result<String> {
    if !(options.ratio > 1. && options.ratio <= 4.) {
        return Err(Error::input(format!(
            "--ratio {}: each mesh must be finer: write a number above 1, to 4",
            options.ratio
        )));
    }
    let case = Case::read(&request.case, &request.sets)?;
    let (script, values) = series::script(&case, request, "converge")?;
    let refine = fineness(&script, &values, &options.refine)?;
    let loaded = run::load(request)?;
    let quantities = Quantity::all(&options.compare, &loaded, &["u", "a"])?;
    let frames = if quantities.iter().any(Quantity::is_ring) { case.frame_interval() } else { case.time.end.0 };
    let warning = cost(request, &loaded, options.ratio, frames)?.allowed(&request.folder(&case), request.large)?;
    warning.iter().for_each(|warning| Screen::new(request.quiet).warn(warning));
    let series = Series::new(request, request.folder(&case).join("converge"));
    let fine = |k: i32| rounded(refine * options.ratio.powi(k));
    refuse_equal_meshes(request, &case, options, [0, 1, 2].map(fine))?;
    let run = |name: String, level: f64, step: f64| {
        let sets = vec![format!("output.every={frames:e}"), format!("time.step={step:e}")];
        series.run(&Variant { name, geo: BTreeMap::from([(options.refine.clone(), level)]), sets })
    };
    let step = case.time.step.0;
    let by_mesh = |k: i32| run(format!("{}{}", options.refine, fine(k)), fine(k), step);
    let time = |k: i32| match k {
        0 => by_mesh(0),
        _ => run(format!("step_{}", STEP_RATIO.powi(k)), fine(0), step / STEP_RATIO.powi(k)),
    };
    let ladders =
        [ladder("mesh", options.ratio, &quantities, &by_mesh)?, ladder("step", STEP_RATIO, &quantities, &time)?];
    let findings = findings(quantities, &ladders, &loaded.model);
    if findings.iter().all(|f| f.value == 0.) {
        return Err(Error::input(
            "nothing that is looked at moves: look at the warnings of coralpipe check, and at time.end",
        ));
    }
    let table = report::table(&ladders, &findings) + &report::write(&series, &ladders, &findings)?;
    if findings.iter().any(Finding::converges) {
        return Ok(table);
    }
    // the table is a result even where the answer is no
    show_copy(&table);
    Err(Error::NoConvergence(
        "no peak converges on these meshes and time steps: the table says how each goes on".into(),
    ))
}

/// Of the five runs, with a frame every `frames` [s]: the meshes grow by the square of the ratio, the steps double.
fn cost(request: &Request, loaded: &Loaded, ratio: f64, frames: f64) -> Result<Cost> {
    let sets = request.sets.iter().cloned().chain([format!("output.every={frames:e}")]);
    let case = Case::read(&request.case, &sets.collect::<Vec<_>>())?;
    let factor = 1. + ratio.powi(2) + ratio.powi(4) + STEP_RATIO + STEP_RATIO.powi(2);
    Ok(Cost::of_run(&case, &loaded.meshed.mesh, true).repeated(5, factor, 4))
}

/// Errors where the constant does not make the elements smaller by about the ratio: three alike meshes agree in
/// everything.
fn refuse_equal_meshes(request: &Request, case: &Case, options: &Options, levels: [f64; 3]) -> Result<()> {
    let size = |level: f64| {
        let mut geo = request.geo.clone();
        geo.insert(options.refine.clone(), level);
        Ok(mean_size(&mesh::obtain(case, &geo, None)?.mesh))
    };
    let sizes = levels.map(size).into_iter().collect::<Result<Vec<f64>>>()?;
    let least = 1. + (options.ratio - 1.) / 2.;
    match (1..3).find(|&k| sizes[k - 1] / sizes[k] < least) {
        None => Ok(()),
        Some(k) => Err(Error::input(format!(
            "{} = {} does not make the mesh finer by {}: its elements measure {} m on average, those of {} = {} {} m; name the \
             constant that divides all element sizes by --refine, or take a larger --ratio",
            options.refine,
            levels[k],
            options.ratio,
            short(1e-4 * (1e4 * sizes[k]).round()),
            options.refine,
            levels[k - 1],
            short(1e-4 * (1e4 * sizes[k - 1]).round())
        ))),
    }
}

/// Square root of the faces' mean area [m].
fn mean_size(mesh: &Mesh) -> f64 {
    let areas: Vec<f64> =
        mesh.cells.iter().filter(|c| c.shape.dimension() == 2).map(|c| mesh.measure(c).abs()).collect();
    (areas.iter().sum::<f64>() / areas.len() as f64).sqrt()
}

/// The constant that refines; one that is 0 cannot be made finer.
fn fineness(script: &Script, values: &BTreeMap<String, f64>, name: &str) -> Result<f64> {
    let value = series::constant(script, values, name, "--refine")?;
    match value > 0. {
        true => Ok(value),
        false => Err(Error::input(format!(
            "--refine {name}: it is {value}; element sizes are divided by it, so it must be above 0"
        ))),
    }
}

/// To six digits behind the point, for names and gmsh.
fn rounded(x: f64) -> f64 {
    (1e6 * x).round() / 1e6
}

fn ladder(
    name: &'static str,
    ratio: f64,
    quantities: &[Quantity],
    run: &dyn Fn(i32) -> Result<Member>,
) -> Result<Ladder> {
    let members = (0..3).map(run).collect::<Result<Vec<_>>>()?;
    let peaks = quantities
        .iter()
        .map(|q| {
            let peak = |k: usize| Ok(q.history(&members[k].folder)?.peak());
            Ok([peak(0)?, peak(1)?, peak(2)?])
        })
        .collect::<Result<Vec<_>>>()?;
    Ok(Ladder { name, ratio, members, peaks })
}

fn findings(quantities: Vec<Quantity>, ladders: &[Ladder; 2], model: &Model) -> Vec<Finding> {
    let undamped = ladders[0].members[0].number("rayleigh.beta") == 0.;
    let jumps = model.loads.iter().any(|load| load.pulse.jumps());
    let finding = |(i, quantity): (usize, Quantity)| {
        let estimate = |l: &Ladder| Estimate::of(l.peaks[i].map(|p| p.value), l.ratio);
        // a jump of pressure is a jump of velocity: its acceleration is a delta function, which only beta spreads
        let only_damping_bounds_it = quantity.is_acceleration() && jumps;
        let hopeless = (only_damping_bounds_it && undamped)
            .then_some("the load begins with a jump and no stiffness-proportional damping spreads the front");
        let (value, estimates) = (ladders[0].peaks[i][0].value, ladders.each_ref().map(estimate));
        Finding { quantity, value, estimates, hopeless, only_damping_bounds_it }
    };
    quantities.into_iter().enumerate().map(finding).collect()
}

impl Finding {
    /// The value of infinitely small elements and steps, and the error of the case's own value: what it is away from
    /// that, and what that may be wrong by. None where a ladder diverges.
    fn limit(&self) -> Option<(f64, f64)> {
        let [mesh, step] = self.estimates.map(|e| e.limit());
        let (mesh, step) = (mesh?, step?);
        let away = |(limit, error): (f64, f64)| (limit - self.value).abs() + error;
        let limit = mesh.0 + step.0 - self.value;
        self.hopeless.is_none().then(|| (limit, away(mesh) + away(step)))
    }

    fn converges(&self) -> bool {
        self.limit().is_some_and(|(_, error)| error <= USELESS * self.value.abs())
    }
}
