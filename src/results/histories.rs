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

/// What a component reached over all steps: the value of largest magnitude, the largest value and the least value.
#[derive(Debug, Clone, Copy, Serialize)]
struct Extremes {
    #[serde(flatten)]
    peak: Peak,
    max: Peak,
    min: Peak,
}

impl Extremes {
    fn at(now: Peak) -> Extremes {
        Extremes { peak: now, max: now, min: now }
    }

    /// The earlier one stays where two are equal.
    fn and(self, now: Peak) -> Extremes {
        Extremes {
            peak: if now.value.abs() > self.peak.value.abs() { now } else { self.peak },
            max: if now.value > self.max.value { now } else { self.max },
            min: if now.value < self.min.value { now } else { self.min },
        }
    }
}

/// `histories.csv`.
pub struct Histories {
    lines: Lines,
    probes: Vec<NodeProbe>,
    /// none before the first step is recorded
    extremes: Vec<Option<[Extremes; 6]>>,
}

impl Histories {
    pub fn create(path: &Path, probes: &[NodeProbe]) -> Result<Histories> {
        let columns = probes.iter().flat_map(|p| COMPONENTS.map(|c| format!("{}.{c}", p.name)));
        let columns = columns.map(|name| format!(",{}", csv::cell(&name)));
        Ok(Histories {
            lines: Lines::create(path, format!("t{}\n", columns.collect::<String>()))?,
            probes: probes.to_vec(),
            extremes: vec![None; probes.len()],
        })
    }

    /// `origin`: the unknowns that displacements are counted from.
    pub fn record(&mut self, unknowns: &Unknowns, state: &State, origin: &[f64]) {
        let line = &mut self.lines.waiting;
        // writing to memory does not fail
        let _ = write!(line, "{}", decimal(state.time));
        let time = nearest_decimal(state.time);
        for (probe, extremes) in self.probes.iter().zip(&mut self.extremes) {
            let mut motion = [&state.q, &state.v, &state.a].map(|x| unknowns.at_node(x, probe.node));
            let at_origin = unknowns.at_node(origin, probe.node);
            motion[0] = [motion[0][0] - at_origin[0], motion[0][1] - at_origin[1]];
            for value in motion.as_flattened() {
                let _ = write!(line, ",{value:e}");
            }
            let now: [Peak; 6] = std::array::from_fn(|i| Peak { value: motion.as_flattened()[i] + 0., time });
            *extremes = Some(match extremes {
                None => now.map(Extremes::at),
                Some(old) => std::array::from_fn(|i| old[i].and(now[i])),
            });
        }
        line.push('\n');
    }

    pub fn flush(&mut self) -> Result<()> {
        self.lines.flush()
    }

    /// Per probe and component: `{"A": {"ux": {"value", "time", "max": {"value", "time"}, "min": {...}}, ...}, ...}`.
    pub fn peaks(&self) -> serde_json::Map<String, serde_json::Value> {
        let of_probe = |extremes: &Option<[Extremes; 6]>| -> serde_json::Map<String, serde_json::Value> {
            let extremes = extremes.unwrap_or([Extremes::at(Peak::default()); 6]);
            COMPONENTS.iter().zip(extremes).map(|(c, e)| (c.to_string(), serde_json::json!(e))).collect()
        };
        self.probes.iter().zip(&self.extremes).map(|(p, e)| (p.name.clone(), of_probe(e).into())).collect()
    }
}
