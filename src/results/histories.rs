//! Motion of the probes at every step, as CSV, and their peaks.

use super::csv;
use super::lines::Lines;
use crate::Result;
use crate::model::probes::NodeProbe;
use crate::number::{decimal, nearest_decimal};
use crate::solve::system::State;
use crate::solve::unknowns::Unknowns;
use serde::Serialize;
use std::fmt::Write as _;
use std::path::Path;

/// Columns of a probe, in this order: displacement [m], velocity [m/s], acceleration [m/s^2].
const COMPONENTS: [&str; 6] = ["ux", "uy", "vx", "vy", "ax", "ay"];

/// With which every table begins that has a probe.
pub const FIRST_COLUMN: &str = "t,";

/// The value of largest magnitude and when it was.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Peak {
    pub value: f64,
    pub time: f64,
}

/// `histories.csv`.
pub struct Histories {
    lines: Lines,
    probes: Vec<NodeProbe>,
    peaks: Vec<[Peak; 6]>,
}

impl Histories {
    pub fn create(path: &Path, probes: &[NodeProbe]) -> Result<Histories> {
        let columns = probes.iter().flat_map(|p| COMPONENTS.map(|c| format!("{}.{c}", p.name)));
        let columns = columns.map(|name| format!(",{}", csv::cell(&name)));
        Ok(Histories {
            lines: Lines::create(path, format!("t{}\n", columns.collect::<String>()))?,
            probes: probes.to_vec(),
            peaks: vec![[Peak::default(); 6]; probes.len()],
        })
    }

    /// `origin`: the unknowns that displacements are counted from.
    pub fn record(&mut self, unknowns: &Unknowns, state: &State, origin: &[f64]) {
        let line = &mut self.lines.waiting;
        // writing to memory does not fail
        let _ = write!(line, "{}", decimal(state.time));
        for (probe, peaks) in self.probes.iter().zip(&mut self.peaks) {
            let mut motion = [&state.q, &state.v, &state.a].map(|x| unknowns.at_node(x, probe.node));
            let at_origin = unknowns.at_node(origin, probe.node);
            motion[0] = [motion[0][0] - at_origin[0], motion[0][1] - at_origin[1]];
            for (value, peak) in motion.as_flattened().iter().zip(peaks) {
                let _ = write!(line, ",{value:e}");
                if value.abs() > peak.value.abs() {
                    *peak = Peak { value: *value, time: nearest_decimal(state.time) };
                }
            }
        }
        line.push('\n');
    }

    pub fn flush(&mut self) -> Result<()> {
        self.lines.flush()
    }

    /// Per probe and component: `{"A": {"ux": {"value", "time"}, ...}, ...}`.
    pub fn peaks(&self) -> serde_json::Map<String, serde_json::Value> {
        let of_probe = |peaks: &[Peak; 6]| -> serde_json::Map<String, serde_json::Value> {
            COMPONENTS.iter().zip(peaks).map(|(c, p)| (c.to_string(), serde_json::json!(p))).collect()
        };
        self.probes.iter().zip(&self.peaks).map(|(p, peaks)| (p.name.clone(), of_probe(peaks).into())).collect()
    }
}
