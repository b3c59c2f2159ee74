//! The time series for ParaView: a `.vtu` a frame and the `.pvd` that gives them their times.
//!
//! Each frame is renamed into place before the `.pvd` names it, so the series is valid at any moment.

use super::file;
use super::frame::Frame;
use super::grid::Grid;
use super::xml_text::escaped;
use crate::Result;
use crate::number::decimal;
use std::path::{Path, PathBuf};

pub struct Series {
    folder: PathBuf,
    name: String,
    /// the `.pvd`'s lines of the frames so far
    index: String,
    count: usize,
}

/// Of every `.pvd`.
pub const BEGINNING: &str =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n";

impl Series {
    /// `folder` holds NAME.pvd and frames/.
    pub fn start(folder: &Path, name: &str) -> Result<Series> {
        file::create_folder_within(&folder.join("frames"))?;
        let series = Series { folder: folder.into(), name: name.into(), index: String::new(), count: 0 };
        series.write_index()?;
        Ok(series)
    }

    /// Frames so far.
    pub fn count(&self) -> usize {
        self.count
    }

    /// `origin`: the unknowns that displacements are counted from.
    pub fn write(&mut self, grid: &Grid, frame: &Frame, origin: &[f64]) -> Result<()> {
        let path = self.frame_path(self.count);
        file::replace(&self.folder.join(&path), &grid.vtu(frame, origin)?)?;
        let (time, path) = (decimal(frame.time), escaped(&path));
        self.index += &format!("    <DataSet timestep=\"{time}\" part=\"0\" file=\"{path}\"/>\n");
        self.count += 1;
        self.write_index()
    }

    /// Error: a frame that the `.pvd` names, or the `.pvd` itself, was removed since it was written.
    pub fn refuse_lost(&self) -> Result<()> {
        let frames = (0..self.count).map(|number| self.folder.join(self.frame_path(number)));
        let lost = frames.chain([self.index_path()]).find(|path| !path.exists());
        lost.map_or(Ok(()), |path| Err(file::lost(&path)))
    }

    fn index_path(&self) -> PathBuf {
        self.folder.join(format!("{}.pvd", self.name))
    }

    /// Seen from the `.pvd`.
    fn frame_path(&self, number: usize) -> String {
        format!("frames/{}_{number:05}.vtu", self.name)
    }

    fn write_index(&self) -> Result<()> {
        let frames = &self.index;
        let index = format!("{BEGINNING}  <Collection>\n{frames}  </Collection>\n</VTKFile>\n");
        file::replace(&self.index_path(), index.as_bytes())
    }
}
