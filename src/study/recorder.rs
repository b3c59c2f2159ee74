//! Watches a run and writes what it sees: histories, rings, frames, the status file, at the end the summary.

use super::equilibria::Equilibria;
use super::prepare::Prepared;
use crate::Result;
use crate::model::case::Analysis;
use crate::number::short_to;
use crate::results::folder::{Folder, STATUS};
use crate::results::grid::Grid;
use crate::results::histories::Histories;
use crate::results::lines::Lines;
use crate::results::snapshots::{Photographer, Snapshots};
use crate::results::summary::{
    ContactRecord, Counts, EnergyRecord, Inputs, ProbePlace, Summary, Timing, open_and_slipping,
};
use crate::solve::energy::{AGAINST_CHATTER, Ledger};
use crate::solve::march::Accepted;
use crate::solve::system::State;
use std::fmt::Write as _;
use std::sync::Arc;
use std::time::Instant;

pub struct Recorder<'a> {
    prepared: &'a Prepared,
    folder: &'a Folder,
    /// the unknowns in equilibrium under gravity, which displacements are counted from
    origin: Vec<f64>,
    histories: Histories,
    photographer: Photographer,
    status: Lines,
    ledger: Ledger,
    contact: ContactRecord,
    /// where states have no inertia
    equilibria: Option<Equilibria>,
    /// computed, those of cut steps counted too
    steps: usize,
    /// of the time grid
    whole_steps: usize,
    iterations: usize,
    started: Instant,
}

/// Status lines [bytes] that may wait for the next frame, however long that takes.
const LONGEST_WAIT: usize = 65536;

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    Done,
    NoConvergence,
    Interrupted,
}

impl<'a> Recorder<'a> {
    /// Opens the files and records the state at t = 0; displacements are counted from `origin`, the equilibrium under
    /// gravity. Frames are written where there is a `grid` for them.
    pub fn start(
        prepared: &'a Prepared,
        folder: &'a Folder,
        start: &Accepted,
        origin: State,
        grid: Option<Arc<Grid>>,
    ) -> Result<Recorder<'a>> {
        let Prepared { model, system, .. } = prepared;
        // The first file of all: it marks the others as those of a run, whatever stops this one.
        let status = Lines::create(&folder.file(STATUS), STATUS_HEADER.into())?;
        // With inertia the case may have moved the bodies since.
        let without_inertia = if model.analysis == Analysis::Static { start.state() } else { &origin };
        let equilibria =
            Equilibria::new(model, system).map(|e| e.after(system, &State::at_rest(system), without_inertia));
        let origin = origin.q;
        let snapshots =
            Snapshots::new(model.clone(), system.clone(), origin.clone(), folder.path(), folder.name(), grid)?;
        let mut recorder = Recorder {
            histories: Histories::create(&folder.file("histories.csv"), &prepared.model.probes)?,
            photographer: Photographer::new(snapshots)?,
            status,
            ledger: start.ledger.clone(),
            contact: ContactRecord::default(),
            equilibria,
            steps: 0,
            whole_steps: 0,
            iterations: 0,
            started: Instant::now(),
            prepared,
            folder,
            origin,
        };
        recorder.histories.record(&prepared.system.unknowns, start.state(), &recorder.origin);
        recorder.write_frame(start.state())?;
        Ok(recorder)
    }

    /// One whole step of the grid, given as the steps it was made of; returns the last of them.
    pub fn record(&mut self, number: usize, old: Accepted, steps: Vec<Accepted>) -> Result<Accepted> {
        let system = &self.prepared.system;
        self.whole_steps += 1;
        self.contact.cut_steps += usize::from(steps.len() > 1);
        let mut last = old;
        for step in steps {
            let (old, new) = (last.state(), step.state());
            let points = open_and_slipping(&system.interface, new, system.jumps(&new.q));
            self.contact = self.contact.after(&system.interface, old, new, system.jumps(&new.q), points);
            if self.prepared.model.analysis == Analysis::Static {
                self.equilibria = self.equilibria.take().map(|e| e.after(system, old, new));
            }
            self.iterations += step.step.iterations;
            self.steps += 1;
            self.write_status(number, old, &step, points);
            last = step;
        }
        self.ledger = last.ledger.clone();
        self.histories.record(&system.unknowns, last.state(), &self.origin);
        let time = &self.prepared.model.time;
        if number.is_multiple_of(time.steps_per_frame) || number == time.steps {
            self.write_frame(last.state())?;
        } else if self.status.waiting.len() > LONGEST_WAIT {
            self.flush()?;
        }
        Ok(last)
    }

    fn write_frame(&mut self, state: &State) -> Result<()> {
        self.flush()?;
        self.photographer.take(state)
    }

    fn flush(&mut self) -> Result<()> {
        self.folder.refuse_lost(&[])?;
        self.histories.flush()?;
        self.status.flush()
    }

    fn write_status(&mut self, number: usize, old: &State, reached: &Accepted, (open, slipping): (usize, usize)) {
        let Accepted { step, ledger, .. } = reached;
        let e = &ledger.now;
        let left =
            self.started.elapsed().as_secs_f64() / number as f64 * (self.prepared.model.time.steps - number) as f64;
        let _ = writeln!(
            self.status.waiting,
            "{number:7} {:>12} {:>9} {:4} {:9.2e} {open:5} {slipping:5} {:11.4e} {:11.4e} {:11.4e} {:11.4e} \
             {:11.4e} {:11.4e} {:11.4e} {:11.4e} {:11.4e} {:11.4e} {left:8.1}",
            short_to(7, step.state().time),
            short_to(3, step.state().time - old.time),
            step.iterations,
            step.displacement_test,
            e.work,
            e.free_field,
            e.kinetic,
            e.strain,
            e.joint,
            e.damping,
            e.boundary,
            e.friction,
            e.contact,
            e.residual,
        );
    }

    /// Closes the files and writes the summary, the last of all.
    pub fn finish(mut self, ending: Ending, inputs: Inputs, title: &str, timing: Timing) -> Result<Summary> {
        self.flush()?;
        let steps_s = self.started.elapsed().as_secs_f64();
        let snapshots = self.photographer.finish()?;
        self.folder.refuse_lost(&[STATUS, "histories.csv", "rings.csv"])?;
        snapshots.refuse_lost()?;
        let model = &self.prepared.model;
        Ok(Summary {
            status: match ending {
                Ending::Done => "done",
                Ending::NoConvergence => "no_convergence",
                Ending::Interrupted => "interrupted",
            },
            title: title.into(),
            inputs,
            counts: Counts {
                nodes: model.mesh.points.len(),
                elements: model.faces().count(),
                joints: model.joints.len(),
                unknowns: self.prepared.system.unknowns.count,
            },
            frequencies_hz: self.prepared.frequencies(),
            rayleigh: self.prepared.rayleigh,
            steps: self.steps,
            iterations: self.iterations,
            frames: snapshots.frame_count(),
            contact: self.contact,
            probes: probe_places(self.prepared),
            peaks: self.histories.peaks(),
            energy: EnergyRecord::from(&self.ledger),
            timing: Timing { steps_s, output_s: snapshots.busy.as_secs_f64(), ..timing },
            files: self.folder.sizes(),
            warnings: model
                .warnings
                .iter()
                .cloned()
                .chain(self.ledger.warning(model.analysis))
                .chain(self.ledger.unclosed().filter(|_| model.closes_its_ledger()))
                .chain(self.equilibria.iter().flat_map(Equilibria::warnings))
                .chain(snapshots.motion.warnings())
                .chain(cut_often(self.steps, self.whole_steps))
                .collect(),
        })
    }
}

/// A sentence where steps were cut so often that the run took twice as many.
fn cut_often(steps: usize, whole_steps: usize) -> Option<String> {
    (whole_steps > 0 && steps >= 2 * whole_steps).then(|| {
        format!("{whole_steps} time steps were cut into {steps}, since joints opened and closed within them: {AGAINST_CHATTER}")
    })
}

const STATUS_HEADER: &str = "#  step       t [s]    dt [s] iter  eq.(19)   open  slip   work [J/m]  free field     kinetic      strain       \
                             joint     damping    boundary    friction     contact    residual left [s]\n";

fn probe_places(prepared: &Prepared) -> Vec<ProbePlace> {
    let place = |p: &crate::model::probes::NodeProbe| {
        let [x, y] = prepared.model.mesh.points[p.node];
        ProbePlace { name: p.name.clone(), node: p.node, x, y }
    };
    prepared.model.probes.iter().map(place).collect()
}
