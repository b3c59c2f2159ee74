//! What runs will cost, estimated before they begin: more than is likely to be meant needs `--large`.
//!
//! A time in the wrong unit makes a run a thousand times as long, and its results would fill the disk.

use crate::model::case::Case;
use crate::model::mesh::{Group, Mesh};
use crate::number::{seconds, short_to};
use crate::{Error, Result};
use std::path::Path;

/// A hundred times the default case: waves cross the ground some ten times in a run, and a hundred steps resolve a
/// crossing. Milliseconds written as seconds make 1,000,000 steps of 1,000.
const MOST_STEPS: usize = 100_000;
/// At 30 a second such a film runs for more than five minutes. The series' index is rewritten with each frame: 80 bytes
/// for each frame before it, 4 GB for so many.
const MOST_FRAMES: usize = 10_000;
/// [bytes] About twice what a million unknowns write in 100 frames.
const MOST_BYTES: f64 = 20e9;
/// [s] A million unknowns take 36,000 steps in this time.
const MOST_SECONDS: f64 = 3600.;

/// Time of a step for each unknown [s]: 0.58 ms at 10,192 unknowns, 10.6 ms at 99,580, 85 ms at 968,492
/// (docs/performance.md).
const STEP: f64 = 1e-7;
/// Share of their time that the runs of a sweep need beside each other (docs/performance.md: 16 cases).
const TOGETHER: f64 = 0.25;

/// Bytes of a frame, measured on runs: of the XML that holds its numbers, and for each point and each cell.
const FORM: f64 = 8e3;
const PLACE: f64 = 90.;
/// of a row in `rings.csv`; each joint has one a frame
const RING: f64 = 220.;
/// of a number in `histories.csv`
const NUMBER: f64 = 22.;
/// of a line in `run.sta`
const STATUS: f64 = 190.;

/// One run, or the sum of several.
#[derive(Debug, Clone, PartialEq)]
pub struct Cost {
    runs: usize,
    /// of the longest run
    grid: Grid,
    /// of all runs
    bytes: f64,
    seconds: f64,
}

/// Steps and frames of a run.
#[derive(Debug, Clone, PartialEq)]
struct Grid {
    unknowns: usize,
    steps: usize,
    frames: usize,
    /// the keys that they follow from
    keys: String,
}

impl Cost {
    /// One run; `frames`: whether it writes them.
    pub fn of_run(case: &Case, mesh: &Mesh, frames: bool) -> Cost {
        let count = |span: f64| (span / case.time.step.0).round().max(1.);
        let steps = count(case.time.end.0);
        let moments = 1. + (steps / count(case.frame_interval())).ceil();
        let is_interface = |g: &Group| g.dimension == 1 && case.interfaces.opened.keys().any(|name| g.is_called(name));
        let joints: usize = mesh.groups.iter().filter(|g| is_interface(g)).map(|g| g.cells.len()).sum();
        let faces = mesh.cells.iter().filter(|c| c.shape.dimension() == 2).count();
        let frame = FORM + PLACE * (mesh.points.len() + faces + joints) as f64;
        let moment = RING * joints as f64 + if frames { frame } else { 0. };
        let step = STATUS + NUMBER * (1 + 6 * case.probes.len()) as f64;
        let unknowns = 2 * mesh.points.len();
        let keys = format!(
            "time.end = {}, time.step = {}, output.every = {}",
            seconds(case.time.end.0),
            seconds(case.time.step.0),
            seconds(case.frame_interval())
        );
        Cost {
            runs: 1,
            grid: Grid { unknowns, steps: steps as usize, frames: if frames { moments as usize } else { 0 }, keys },
            bytes: moments * moment + steps * step,
            seconds: STEP * steps * unknowns as f64,
        }
    }

    /// Runs of a sweep; none where there are none.
    pub fn together(runs: impl Iterator<Item = Cost>) -> Option<Cost> {
        let sum = runs.reduce(|sum, run| Cost {
            runs: sum.runs + run.runs,
            bytes: sum.bytes + run.bytes,
            seconds: sum.seconds + run.seconds,
            grid: if run.grid.steps > sum.grid.steps { run.grid } else { sum.grid },
        })?;
        let share = if sum.runs > 1 { TOGETHER } else { 1. };
        Some(Cost { seconds: share * sum.seconds, ..sum })
    }

    /// `runs` runs after each other whose unknowns times steps are `factor` times this one's in all, and whose longest has
    /// `longest` times its steps.
    pub fn repeated(self, runs: usize, factor: f64, longest: usize) -> Cost {
        let grid = Grid { steps: self.grid.steps.saturating_mul(longest), ..self.grid };
        Cost { runs, grid, bytes: factor * self.bytes, seconds: factor * self.seconds }
    }

    /// What is too much, with what it follows from; none where nothing is. The results go to `folder`.
    pub fn excess(&self, folder: &Path) -> Option<String> {
        let free = free_bytes(folder);
        let Grid { unknowns, steps, frames, keys } = &self.grid;
        let limits = [
            (*steps > MOST_STEPS, format!("{MOST_STEPS} steps")),
            (*frames > MOST_FRAMES, format!("{MOST_FRAMES} frames")),
            (self.bytes > MOST_BYTES, size(MOST_BYTES)),
            (free.is_some_and(|free| self.bytes > free), "is free on that disk (--out DIR chooses another)".into()),
            (self.seconds > MOST_SECONDS, "an hour".into()),
        ];
        let passed: Vec<String> =
            limits.into_iter().filter_map(|(is_passed, limit)| is_passed.then_some(limit)).collect();
        let runs = if self.runs > 1 { format!("{} runs, the longest of ", self.runs) } else { String::new() };
        let frames = if *frames > 0 { format!(" and {frames} frames") } else { String::new() };
        (!passed.is_empty()).then(|| {
            format!(
                "{runs}{steps} steps of about {} unknowns{frames} ({keys}) write about {} into {}{}, and take about {}: more than {}",
                short_to(2, *unknowns as f64),
                size(self.bytes),
                folder.display(),
                free.map_or(String::new(), |free| format!(", where {} are free", size(free))),
                duration(self.seconds),
                passed.join(", more than ")
            )
        })
    }

    /// What to do where a limit is passed. Too many steps or frames often come from a time in the wrong unit.
    pub fn remedy(&self) -> String {
        match self.grid.steps > MOST_STEPS || self.grid.frames > MOST_FRAMES {
            true => format!("a number without a unit is in seconds, so \"100 ms\" is 0.1: {REMEDY}"),
            false => REMEDY.into(),
        }
    }

    /// The warning where a limit is passed and `large` allows it.
    ///
    /// Errors: a limit is passed, and it does not.
    pub fn allowed(&self, folder: &Path, large: bool) -> Result<Option<String>> {
        match self.excess(folder) {
            Some(excess) if !large => Err(Error::input(format!("{excess}; {}", self.remedy()))),
            excess => Ok(excess),
        }
    }
}

/// What to do where a limit is passed.
const REMEDY: &str = "change time.end, time.step or output.every, or let it run by --large if that is meant";

/// Bytes that the disk of a folder has left, where the system says so; the folder need not exist yet.
fn free_bytes(folder: &Path) -> Option<f64> {
    let absolute = std::path::absolute(folder).ok()?;
    let existing = absolute.ancestors().find(|path| path.exists())?;
    let disk = nix::sys::statvfs::statvfs(existing).ok()?;
    // the types differ from system to system
    Some(disk.blocks_available() as f64 * disk.fragment_size() as f64)
}

fn size(bytes: f64) -> String {
    let units = [(1e9, "GB"), (1e6, "MB"), (1e3, "kB")];
    let (unit, name) = units.into_iter().find(|(unit, _)| bytes >= *unit).unwrap_or((1., "bytes"));
    format!("{} {name}", short_to(2, bytes / unit))
}

/// In seconds, minutes, hours or days.
fn duration(seconds: f64) -> String {
    let units = [(86400., "days"), (3600., "h"), (60., "min")];
    let (unit, name) = units.into_iter().find(|(unit, _)| seconds >= 1.5 * unit).unwrap_or((1., "s"));
    format!("{} {name}", short_to(2, seconds / unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cost(steps: usize, frames: usize, bytes: f64, seconds: f64) -> Cost {
        Cost { runs: 1, grid: Grid { unknowns: 10_000, steps, frames, keys: "time.end = 1 s".into() }, bytes, seconds }
    }

    /// At a limit nothing is said, just above it the limit is named.
    #[test]
    fn each_limit_is_named_where_it_is_passed_and_only_there() {
        let folder = Path::new("not/yet/there");
        assert_eq!(cost(100_000, 10_000, 1e6, 3600.).excess(folder), None);
        for (cost, words) in [
            (cost(100_001, 2, 1e6, 1.), "more than 100000 steps"),
            (cost(1000, 10_001, 1e6, 1.), "more than 10000 frames"),
            (cost(1000, 101, 20.1e9, 1.), "more than 20 GB"),
            (cost(1000, 101, 1e6, 3601.), "more than an hour"),
            (cost(1000, 101, 1e30, 1.), "more than is free on that disk"),
        ] {
            let excess = cost.excess(folder).unwrap();
            assert!(excess.contains(words) && excess.contains("time.end = 1 s"), "{words}: {excess}");
            let refused = cost.allowed(folder, false).unwrap_err();
            assert!(refused.exit_code() == 1 && refused.to_string().contains("--large"), "{refused}");
            assert_eq!(cost.allowed(folder, true).unwrap(), Some(excess));
        }
    }

    /// Four runs of half an hour each, 30 GB in all.
    #[test]
    fn the_limits_hold_for_the_sum_of_all_runs() {
        let folder = Path::new(".");
        let one = cost(1000, 101, 7.5e9, 1800.);
        assert_eq!(one.excess(folder).filter(|excess| !excess.contains("free on that disk")), None);
        let sweep = Cost::together((0..4).map(|_| one.clone())).unwrap();
        let excess = sweep.excess(folder).unwrap();
        assert!(
            excess.contains("4 runs, the longest of 1000 steps") && excess.contains("write about 30 GB"),
            "{excess}"
        );
        assert!(excess.contains("take about 30 min") && !excess.contains("an hour"), "{excess}");
        let excess = one.repeated(4, 4., 2).excess(folder).unwrap();
        assert!(excess.contains("2000 steps") && excess.contains("more than an hour"), "{excess}");
        assert_eq!(Cost::together([].into_iter()), None);
    }
}
