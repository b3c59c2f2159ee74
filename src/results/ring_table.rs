//! `rings.csv`: section forces of every ray of every pipe wall at every frame.

use super::csv;
use super::lines::Lines;
use super::ring::Ring;
use crate::Result;
use crate::model::resolve::Model;
use crate::number::{decimal, degrees};
use crate::solve::system::{State, System};
use std::fmt::Write as _;
use std::path::Path;

/// Only the header if no body is a ring.
pub struct RingTable {
    lines: Lines,
    rings: Vec<Ring>,
}

pub const HEADER: &str = "t,body,angle_deg,N,Q,M,hoop_inner,hoop_outer,u_r,u_t,sigma_n,tau\n";

impl RingTable {
    pub fn create(path: &Path, rings: Vec<Ring>) -> Result<RingTable> {
        Ok(RingTable { lines: Lines::create(path, HEADER.into())?, rings })
    }

    /// `origin`: the unknowns that displacements are counted from.
    pub fn record(&mut self, model: &Model, system: &System, state: &State, origin: &[f64]) -> Result<()> {
        let lines = &mut self.lines.waiting;
        let time = decimal(state.time);
        for ring in &self.rings {
            let body = csv::cell(&ring.body);
            for s in ring.sections(model, system, state, origin) {
                let forces = [s.normal_force, s.shear_force, s.moment];
                let numbers = forces.iter().chain(&s.hoop).chain(&s.displacement).chain(&s.traction);
                // writing to memory does not fail
                let _ = write!(lines, "{time},{body},{}", degrees(s.angle));
                numbers.for_each(|x| _ = write!(lines, ",{x:e}"));
                lines.push('\n');
            }
        }
        self.lines.flush()
    }
}
