//! `rings.csv`: section forces of every ray of every pipe wall at every frame.

use super::file;
use super::ring::Ring;
use crate::Result;
use crate::model::resolve::Model;
use crate::solve::system::{State, System};
use std::fmt::Write as _;
use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// Written in whole lines, so that a kill leaves a table that reads. Only the header if no body is a ring.
pub struct RingTable {
    path: PathBuf,
    file: File,
    waiting: String,
    rings: Vec<Ring>,
}

impl RingTable {
    pub fn create(path: &Path, rings: Vec<Ring>) -> Result<RingTable> {
        let file = File::create(path).map_err(|e| file::not_written(path, &e))?;
        let header = "t,body,angle_deg,N,Q,M,hoop_inner,hoop_outer,u_r,u_t,sigma_n,tau\n";
        Ok(RingTable { path: path.into(), file, waiting: header.into(), rings })
    }

    /// `origin`: the unknowns that displacements are counted from.
    pub fn record(&mut self, model: &Model, system: &System, state: &State, origin: &[f64]) -> Result<()> {
        for ring in &self.rings {
            for s in ring.sections(model, system, state, origin) {
                let forces = [s.normal_force, s.shear_force, s.moment];
                let numbers = forces.iter().chain(&s.hoop).chain(&s.displacement).chain(&s.traction);
                // writing to memory does not fail
                let _ = write!(self.waiting, "{:e},{},{}", state.time, ring.body, s.angle.to_degrees());
                numbers.for_each(|x| _ = write!(self.waiting, ",{x:e}"));
                self.waiting.push('\n');
            }
        }
        let lines = std::mem::take(&mut self.waiting);
        self.file.write_all(lines.as_bytes()).map_err(|e| file::not_written(&self.path, &e))
    }
}
