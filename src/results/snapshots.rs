//! What is made of a state now and then: a row a ray in `rings.csv`, the check of small motions, a frame.
//!
//! A thread of its own does it where there are frames, so that the solver does not wait.

use super::frame::Frame;
use super::grid::Grid;
use super::motion::{Motion, Spans};
use super::ring::rings;
use super::ring_table::RingTable;
use super::series::Series;
use crate::model::resolve::Model;
use crate::solve::system::{State, System};
use crate::{Error, Result};
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

pub struct Snapshots {
    model: Arc<Model>,
    system: Arc<System>,
    /// the unknowns in equilibrium under gravity, which displacements are counted from
    origin: Vec<f64>,
    rings: RingTable,
    spans: Spans,
    /// the largest so far
    pub motion: Motion,
    /// none where no frames are asked for
    frames: Option<(Arc<Grid>, Series)>,
    /// time spent on all of it
    pub busy: Duration,
}

impl Snapshots {
    /// Into `folder`: rings.csv, and on a `grid` frames, NAME.pvd and frames/.
    pub fn new(
        model: Arc<Model>,
        system: Arc<System>,
        origin: Vec<f64>,
        folder: &Path,
        name: &str,
        grid: Option<Arc<Grid>>,
    ) -> Result<Snapshots> {
        let series = |grid| Ok::<_, Error>((grid, Series::start(folder, name)?));
        Ok(Snapshots {
            rings: RingTable::create(&folder.join("rings.csv"), rings(&model, &system, system.rayleigh))?,
            spans: Spans::new(&model),
            motion: Motion::default(),
            frames: grid.map(series).transpose()?,
            busy: Duration::ZERO,
            model,
            system,
            origin,
        })
    }

    pub fn take(&mut self, state: &State) -> Result<()> {
        let start = Instant::now();
        self.motion = self.motion.after(&self.spans, &self.model.mesh, &self.system, state);
        self.rings.record(&self.model, &self.system, state, &self.origin)?;
        if let Some((grid, series)) = &mut self.frames {
            series.write(grid, &Frame::of(&self.model, &self.system, state), &self.origin)?;
        }
        self.busy += start.elapsed();
        Ok(())
    }

    /// Frames written.
    pub fn frame_count(&self) -> usize {
        self.frames.as_ref().map_or(0, |(_, series)| series.count())
    }

    /// Errors: those of [`Series::refuse_lost`].
    pub fn refuse_lost(&self) -> Result<()> {
        self.frames.as_ref().map_or(Ok(()), |(_, series)| series.refuse_lost())
    }

    fn take_all(mut self, states: &Receiver<State>) -> Result<Snapshots> {
        states.iter().try_for_each(|state| self.take(&state))?;
        Ok(self)
    }
}

/// States that may wait while one is written: enough to smooth, few enough for memory.
const WAITING: usize = 4;

/// Where snapshots are taken.
pub enum Photographer {
    /// in the caller's own thread
    Here(Box<Snapshots>),
    /// in one of its own, which is none any more once it has told its end
    Beside { states: SyncSender<State>, thread: Option<JoinHandle<Result<Snapshots>>> },
}

impl Photographer {
    /// In a thread of its own where there are frames: they take the most time.
    pub fn new(snapshots: Snapshots) -> Result<Photographer> {
        if snapshots.frames.is_none() {
            return Ok(Photographer::Here(snapshots.into()));
        }
        let (sender, receiver) = sync_channel(WAITING);
        let thread = std::thread::Builder::new().name("frames".into()).spawn(move || snapshots.take_all(&receiver));
        let thread = thread.map_err(|e| Error::input(format!("no thread can be started that writes frames: {e}")))?;
        Ok(Photographer::Beside { states: sender, thread: Some(thread) })
    }

    /// Waits where too many states wait already. Error: why this one or an earlier one could not be written.
    pub fn take(&mut self, state: &State) -> Result<()> {
        match self {
            Photographer::Here(snapshots) => snapshots.take(state),
            Photographer::Beside { states, thread } => match states.send(state.clone()) {
                Ok(()) => Ok(()),
                Err(_) => end(thread.take()).map(|_| ()),
            },
        }
    }

    /// Waits until all is on disk.
    pub fn finish(self) -> Result<Snapshots> {
        match self {
            Photographer::Here(snapshots) => Ok(*snapshots),
            Photographer::Beside { states, thread } => {
                drop(states);
                end(thread)
            }
        }
    }
}

fn end(thread: Option<JoinHandle<Result<Snapshots>>>) -> Result<Snapshots> {
    let ended = thread.and_then(|thread| thread.join().ok());
    ended.unwrap_or_else(|| Err(Error::input("the thread that writes frames broke down")))
}
