//! The time series for ParaView: a `.vtu` a frame and the `.pvd` that gives them their times.
//!
//! Written by a thread of its own. Each frame is renamed into place before the `.pvd` names it, so the series is valid
//! at any moment.

use super::file;
use super::frame::{Frame, Grid};
use crate::{Error, Result};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Frames that may wait while one is written: enough to smooth, few enough for memory.
const WAITING: usize = 4;

pub struct Series {
    sender: SyncSender<Frame>,
    /// none once it has told its end
    writer: Option<JoinHandle<Result<Written>>>,
}

/// What the thread did.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Written {
    pub frames: usize,
    /// time spent on stresses, compression and files
    pub busy: Duration,
}

impl Series {
    /// Starts the thread; `folder` holds NAME.pvd and frames/.
    pub fn start(folder: &Path, name: &str, grid: Grid) -> Result<Series> {
        file::create_folder(&folder.join("frames"))?;
        let target = Target { folder: folder.into(), name: name.into() };
        target.write_index("")?;
        let (sender, receiver) = sync_channel(WAITING);
        let writer =
            std::thread::Builder::new().name("frames".into()).spawn(move || target.write_all(&grid, &receiver));
        let writer = writer.map_err(|e| Error::input(format!("no thread can be started that writes frames: {e}")))?;
        Ok(Series { sender, writer: Some(writer) })
    }

    /// Hands a frame over; waits where too many wait already. Error: why an earlier frame could not be written.
    pub fn push(&mut self, frame: Frame) -> Result<()> {
        match self.sender.send(frame) {
            Ok(()) => Ok(()),
            Err(_) => end(self.writer.take()).map(|_| ()),
        }
    }

    /// Waits until all frames are on disk.
    pub fn finish(self) -> Result<Written> {
        drop(self.sender);
        end(self.writer)
    }
}

fn end(writer: Option<JoinHandle<Result<Written>>>) -> Result<Written> {
    let ended = writer.and_then(|thread| thread.join().ok());
    ended.unwrap_or_else(|| Err(Error::input("the thread that writes frames broke down")))
}

struct Target {
    folder: PathBuf,
    name: String,
}

impl Target {
    fn write_all(&self, grid: &Grid, frames: &Receiver<Frame>) -> Result<Written> {
        let mut index = String::new();
        let mut written = Written::default();
        for frame in frames {
            let start = Instant::now();
            let path = self.frame_path(written.frames);
            file::replace(&self.folder.join(&path), grid.vtu(&frame)?.as_bytes())?;
            let (time, path) = (frame.time, escaped(&path));
            index += &format!("    <DataSet timestep=\"{time:e}\" part=\"0\" file=\"{path}\"/>\n");
            self.write_index(&index)?;
            written = Written { frames: written.frames + 1, busy: written.busy + start.elapsed() };
        }
        Ok(written)
    }

    /// Seen from the `.pvd`.
    fn frame_path(&self, number: usize) -> String {
        format!("frames/{}_{number:05}.vtu", self.name)
    }

    /// `frames`: their lines.
    fn write_index(&self, frames: &str) -> Result<()> {
        let index = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  \
             <Collection>\n{frames}  </Collection>\n</VTKFile>\n"
        );
        file::replace(&self.folder.join(format!("{}.pvd", self.name)), index.as_bytes())
    }
}

/// The name of a case may hold what XML does not allow in an attribute.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}
