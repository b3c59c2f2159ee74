//! The time series for ParaView: a `.vtu` a frame and the `.pvd` that gives them their times.
//!
//! Each frame is renamed into place before the `.pvd` names it, so the series is valid at any moment.

use super::file;
use super::frame::{Frame, Grid};
use crate::Result;
use std::path::{Path, PathBuf};

pub struct Series {
    folder: PathBuf,
    name: String,
    /// the `.pvd`'s lines of the frames so far
    index: String,
    count: usize,
}

impl Series {
    /// `folder` holds NAME.pvd and frames/.
    pub fn start(folder: &Path, name: &str) -> Result<Series> {
        file::create_folder(&folder.join("frames"))?;
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
        let (time, path) = (frame.time, escaped(&path));
        self.index += &format!("    <DataSet timestep=\"{time:e}\" part=\"0\" file=\"{path}\"/>\n");
        self.count += 1;
        self.write_index()
    }

    /// Seen from the `.pvd`.
    fn frame_path(&self, number: usize) -> String {
        format!("frames/{}_{number:05}.vtu", self.name)
    }

    fn write_index(&self) -> Result<()> {
        let frames = &self.index;
        let index = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  \
             <Collection>\n{frames}  </Collection>\n</VTKFile>\n"
        );
        file::replace(&self.folder.join(format!("{}.pvd", self.name)), index.as_bytes())
    }
}

/// The name of a case may hold what XML does not allow in an attribute, or would make a blank of.
fn escaped(text: &str) -> String {
    let named = text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
    named.replace('\t', "&#9;").replace('\n', "&#10;").replace('\r', "&#13;")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// XML 1.0, 2.4 and 3.3.3.
    #[test]
    fn an_attribute_holds_any_name() {
        assert_eq!(escaped("a&b<c\"d\te\nf\rg ü'>"), "a&amp;b&lt;c&quot;d&#9;e&#10;f&#13;g ü'>");
    }
}
