//! `coralpipe domain`: how large the ground must be. The paper's iteration on B0 and H0: grow, compute again, compare.
//!
//! First the width grows until what was asked for changes by less than the tolerance, then the height, then both at
//! once.

mod alike;
mod bound;
mod report;

use super::cost::Cost;
use super::history::{Change, History};
use super::quantity::Quantity;
use super::run::{self, Loaded, Request};
use super::screen::{Screen, show_copy};
use super::series::{self, Member, Series, Variant};
use crate::model::arrival::{Returns, returns};
use crate::model::case::{Analysis, Case};
use crate::model::moving_front::MovingFront;
use crate::model::units::Time;
use crate::number::{seconds, short};
use crate::{Error, Result};
use std::collections::BTreeMap;

/// What the command line asks of the study.
#[derive(Debug, Clone)]
pub struct Options {
    /// quantities, none for every probe's displacement
    pub compare: Vec<String>,
    pub tolerance: String,
    /// end of the window compared, none for the case's end
    pub until: Option<String>,
    /// a size over the one before
    pub growth: f64,
    /// how often each of width, height and both may grow
    pub sizes: usize,
    /// the script's constants
    pub width: String,
    pub height: String,
    /// Rayleigh's coefficients from each size's own modes
    pub own_damping: bool,
}

/// Width and height [m, or the script's unit].
type Size = [f64; 2];

/// One size, and what growing to it changed.
struct Row {
    size: Size,
    /// the size it grew from
    from: Option<Size>,
    member: Member,
    histories: Vec<History>,
    /// for each quantity; in the whole window and until the first return in the smaller size
    changes: Vec<[Change; 2]>,
    /// first return of the boundaries that moved, in the smaller size [s]
    first_return: f64,
    /// in this size
    returns: Option<Returns>,
    /// for each load its front's time that is t = 0 [s], if it has a front
    origins: Vec<Option<f64>>,
}

struct Study<'a> {
    options: &'a Options,
    series: Series<'a>,
    quantities: Vec<Quantity>,
    tolerance: f64,
    /// [s]
    until: f64,
    start: Size,
    /// constants that keep the inner mesh, if the script has them and the user gives none
    core: BTreeMap<String, f64>,
    /// the script has such constants
    inner_mesh_is_kept: bool,
    sets: Vec<String>,
}

/// Writes `domain.csv`, `domain.json`, `domain.svg` and a folder for each size into `output/NAME/domain/`; returns the
/// table.
///
/// Errors: bad input; an interrupt or a size without convergence, with the sizes before it on disk; no size within the
/// tolerance (exit code 3), with the table on stdout all the same.
pub fn command(request: &Request, options: &Options) -> Result<String> {
    let mut study = Study::new(request, options)?;
    let mut rows = Vec::new();
    let settled = study.grow(&mut rows);
    if rows.is_empty() {
        return settled.map(|_| String::new());
    }
    let files = study.write(&rows)?;
    let table = study.table(&rows) + &files;
    let largest = rows.last().map_or(study.start, |r| r.size);
    let not_settled = |table: &str| {
        // the table is a result even where the answer is no
        show_copy(table);
        Error::NoConvergence(format!(
            "up to {} = {} and {} = {} the quantities still change by more than {} %: let it grow further by --sizes{}",
            options.width,
            largest[0],
            options.height,
            largest[1],
            short(100. * study.tolerance),
            match rows.last().and_then(|r| r.returns.as_ref()) {
                Some(_) => ", compare a shorter window by --until, or let the boundaries absorb",
                None => "",
            }
        ))
    };
    match settled {
        Ok(Some(size)) => Ok(table + &study.verdict(size)),
        Ok(None) => Err(not_settled(&table)),
        Err(error) => Err(error),
    }
}

impl<'a> Study<'a> {
    fn new(request: &'a Request, options: &'a Options) -> Result<Study<'a>> {
        let tolerance = series::share(&options.tolerance, "--tolerance")?;
        if !(options.growth > 1. && options.growth <= 10.) {
            let growth = options.growth;
            return Err(Error::input(format!(
                "--growth {growth}: each size must be larger: write a number above 1, to 10"
            )));
        }
        if options.sizes == 0 {
            return Err(Error::input("--sizes 0: let width and height grow at least once"));
        }
        let case = Case::read(&request.case, &request.sets)?;
        let (script, values) = series::script(&case, request, "domain")?;
        let start = [
            series::constant(&script, &values, &options.width, "--width")?,
            series::constant(&script, &values, &options.height, "--height")?,
        ];
        if options.width == options.height {
            let width = &options.width;
            return Err(Error::input(format!(
                "--width and --height both name \"{width}\": they must be two constants"
            )));
        }
        let until = window(&case, options.until.as_deref())?;
        let loaded = run::load(request)?;
        let quantities = Quantity::all(&options.compare, &loaded, &["u"])?;
        // frames cost time and disk; only rings need them
        let frames = if quantities.iter().any(Quantity::is_ring) { case.frame_interval() } else { case.time.end.0 };
        let sets = vec![format!("output.every={frames:e}")];
        let warning = cost(request, &loaded, options.growth, &sets)?.allowed(&request.folder(&case), request.large)?;
        warning.iter().for_each(|warning| Screen::new(request.quiet).warn(warning));
        Ok(Study {
            options,
            series: Series::new(request, request.folder(&case).join("domain")),
            quantities,
            tolerance,
            until,
            start,
            core: alike::core(&script, options, start, &alike::given(&case, request)),
            inner_mesh_is_kept: alike::core_names(options)
                .iter()
                .all(|name| script.constants.iter().any(|c| c.name == *name)),
            sets,
        })
    }

    /// Appends a row for each size; the size that is large enough, if one was found.
    fn grow(&mut self, rows: &mut Vec<Row>) -> Result<Option<Size>> {
        rows.push(self.row(self.start, None)?);
        if rows[0].histories.iter().all(|h| h.peak().value == 0.) {
            return Err(Error::input(
                "nothing that is compared moves in the window: look at the warnings of coralpipe check, and at --until",
            ));
        }
        self.keep_damping(&rows[0].member)?;
        let mut now = 0;
        for axes in [[true, false], [false, true], [true, true]] {
            let mut settled = false;
            for _ in 0..self.options.sizes {
                let size = [0, 1].map(|i| if axes[i] { self.grown(rows[now].size[i]) } else { rows[now].size[i] });
                let row = self.row(size, Some((&rows[now], axes)))?;
                settled = row.changes.iter().all(|[whole, _]| whole.history <= self.tolerance);
                rows.push(row);
                self.write(rows)?;
                if settled {
                    break;
                }
                now = rows.len() - 1;
            }
            if !settled {
                return Ok(None);
            }
        }
        Ok(Some(rows[now].size))
    }

    /// To the centimetre, so that names and tables stay short.
    fn grown(&self, length: f64) -> f64 {
        (100. * length * self.options.growth).round() / 100.
    }

    /// Computes a size and compares it with the one it grew from.
    fn row(&self, size: Size, from: Option<(&Row, [bool; 2])>) -> Result<Row> {
        let Options { width, height, .. } = self.options;
        let [w, h] = size;
        let mut geo = self.core.clone();
        geo.extend([(width.clone(), w), (height.clone(), h)]);
        let variant = Variant { name: format!("{width}{w}_{height}{h}"), geo, sets: self.sets.clone() };
        let mut request = self.series.request.clone();
        request.geo.extend(variant.geo.clone());
        let model = run::load(&request)?.model;
        let origins = model.loads.iter().map(|l| l.front.as_ref().map(MovingFront::origin)).collect();
        if let Some((row, _)) = from {
            alike::refuse_shift(&row.origins, &origins, &model, size)?;
        }
        let member = self.series.run(&variant)?;
        let history = |q: &Quantity| Ok(q.history(&member.folder)?.until(self.until));
        let histories: Vec<History> = self.quantities.iter().map(history).collect::<Result<_>>()?;
        let first_return =
            from.map_or(f64::NAN, |(row, moved)| bound::first(row.returns.as_ref(), moved, &self.quantities));
        let pairs = from.iter().flat_map(|(row, _)| row.histories.iter().zip(&histories));
        let ends = [self.until, first_return.min(self.until)];
        let changes = pairs.map(|(old, new)| ends.map(|end| old.until(end).change_to(&new.until(end)))).collect();
        // statics has no waves
        let returns = if model.analysis == Analysis::Dynamic { returns(&model) } else { None };
        let from = from.map(|(row, _)| row.size);
        Ok(Row { size, from, histories, changes, first_return, returns, origins, member })
    }

    /// alpha and beta of the first size for all: the modes of a larger one are lower, and would change the material
    /// too.
    fn keep_damping(&mut self, first: &Member) -> Result<()> {
        let case = Case::read(&self.series.request.case, &self.series.request.sets)?;
        if let Some(damping) = case.damping.filter(|_| !self.options.own_damping) {
            self.sets.push(format!(
                "damping={{\"alpha\": {:e}, \"beta\": {:e}, \"interfaces\": {}}}",
                first.number("rayleigh.alpha"),
                first.number("rayleigh.beta"),
                damping.interfaces
            ));
        }
        Ok(())
    }

    fn write(&self, rows: &[Row]) -> Result<String> {
        let write = |name: &str, content: String| self.series.write(name, &content);
        let names = [
            write("domain.csv", self.csv(rows))?,
            write("domain.json", self.json(rows))?,
            write("domain.svg", self.svg(rows)?)?,
        ];
        Ok(format!("written: {}\n", names.join(", ")))
    }
}

/// Of the four runs that are the least: the case itself, wider, higher, and both at once.
fn cost(request: &Request, loaded: &Loaded, growth: f64, sets: &[String]) -> Result<Cost> {
    let case = Case::read(&request.case, &[&request.sets, sets].concat())?;
    Ok(Cost::of_run(&case, &loaded.meshed.mesh, true).repeated(4, (1. + growth).powi(2), 1))
}

/// End of the window that is compared [s].
fn window(case: &Case, until: Option<&str>) -> Result<f64> {
    let end = case.time.end.0;
    let Some(text) = until else { return Ok(end) };
    let until = Time::parse(text).map_err(|e| Error::input(format!("--until {text}: {e}")))?.0;
    if !(until >= case.time.step.0 && until <= end * (1. + 1e-9)) {
        return Err(Error::input(format!(
            "--until {text}: the window must end between the first step, {}, and time.end = {}",
            seconds(case.time.step.0),
            seconds(end)
        )));
    }
    Ok(until)
}
