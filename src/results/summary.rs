//! `summary.json`: what went in, what came out, what it cost.

use crate::number::readable;
use crate::solve::energy::{Energies, Ledger};
use crate::solve::interface::{Interface, JointPoint};
use crate::solve::system::{Rayleigh, State};
use serde::Serialize;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

#[derive(Debug, Clone, Serialize)]
pub struct Summary {
    /// "done", "no_convergence" or "interrupted"
    pub status: &'static str,
    pub title: String,
    pub inputs: Inputs,
    pub counts: Counts,
    pub frequencies_hz: Vec<f64>,
    pub rayleigh: Rayleigh,
    /// computed steps, those of cut steps counted too
    pub steps: usize,
    /// Newton iterations of all steps
    pub iterations: usize,
    pub frames: usize,
    pub contact: ContactRecord,
    pub probes: Vec<ProbePlace>,
    pub peaks: Map<String, Value>,
    pub energy: EnergyRecord,
    pub timing: Timing,
    /// the tables and the series written, with their sizes [bytes]
    pub files: BTreeMap<String, u64>,
    pub warnings: Vec<String>,
}

#[derive(Debug, Clone, Serialize)]
pub struct Inputs {
    pub case: String,
    /// of `effective_case`
    pub case_sha256: String,
    /// the case after `--set`, with the tables of its loads
    pub effective_case: Value,
    /// `--set` and `--geo` of the command line
    pub set: Vec<String>,
    pub geo: BTreeMap<String, f64>,
    pub mesh: String,
    pub mesh_sha256: String,
    /// of the mesh's coordinates: `mm`
    pub mesh_unit: String,
    pub bonded: bool,
    pub coralpipe: &'static str,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Counts {
    pub nodes: usize,
    pub elements: usize,
    pub joints: usize,
    pub unknowns: usize,
}

impl Summary {
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("numbers, strings and lists are always JSON") + "\n"
    }

    /// For the screen: frequencies, peaks, contact, energy, cost.
    pub fn table(&self) -> String {
        let frequencies: Vec<String> = self.frequencies_hz.iter().map(|f| format!("{f:.3}")).collect();
        let mut text = match frequencies.is_empty() {
            true => String::new(),
            false => format!("frequencies       {} Hz\n", frequencies.join("  ")),
        };
        for (probe, peaks) in &self.peaks {
            let peak = |component: &str, scale: f64, unit: &str| {
                let of = |key: &str| peaks[component][key].as_f64().unwrap_or(f64::NAN);
                format!("{component} {} {unit} at {:6.2} ms", readable(scale * of("value")), 1e3 * of("time"))
            };
            let [x, y] = [peak("ux", 1e3, "mm"), peak("uy", 1e3, "mm")];
            // a line break in a name would break the line of the table
            let probe = if probe.contains(char::is_control) { &format!("{probe:?}") } else { probe };
            text += &format!("peak {probe:<12} {x}   {y}   {}\n", peak("ay", 1., "m/s2"));
        }
        let c = &self.contact;
        text += &format!(
            "contact           gap {} mm, slip {} mm, at most {} points open and {} slipping\n",
            readable(1e3 * c.max_open).trim_start(),
            readable(1e3 * c.max_slip).trim_start(),
            c.max_open_points,
            c.max_slipping_points
        );
        text += &format!("energy error      {:.1e} of the peak\n", self.energy.max_relative_error);
        let t = &self.timing;
        text + &format!(
            "{} steps, {} iterations in {:.2} s (mesh {:.2}, set-up {:.2}, factor and modes {:.2}; all {:.2} s, {:.2} of \
             frames beside them)\n",
            self.steps, self.iterations, t.steps_s, t.mesh_s, t.setup_s, t.factor_s, t.total_s, t.output_s
        )
    }
}

/// Where a probe is, and its row in the frames.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ProbePlace {
    pub name: String,
    pub node: usize,
    /// [m]
    pub x: f64,
    pub y: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EnergyRecord {
    /// largest |residual| over the largest stored energy
    pub max_relative_error: f64,
    /// largest stored energy [J/m]
    pub peak: f64,
    /// energy of the initial motion plus work of the free field and of the loads that come and go, the largest so far [J/m]
    pub supplied: f64,
    /// energy that joints made by opening, closing and first slip within steps [J/m]
    pub made: f64,
    /// the ledger's last line [J/m]
    pub last: Energies,
}

impl From<&Ledger> for EnergyRecord {
    fn from(ledger: &Ledger) -> Self {
        EnergyRecord {
            max_relative_error: ledger.max_relative_error(),
            peak: ledger.peak,
            supplied: ledger.supplied,
            made: ledger.made,
            last: ledger.now,
        }
    }
}

/// Wall times [s].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Timing {
    pub mesh_s: f64,
    pub setup_s: f64,
    pub factor_s: f64,
    pub steps_s: f64,
    /// time of the thread that writes frames, most of it beside the steps
    pub output_s: f64,
    pub total_s: f64,
}

/// What the joints went through.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct ContactRecord {
    /// widest gap [m]
    pub max_open: f64,
    /// largest plastic slip of a closed joint [m]
    pub max_slip: f64,
    /// joint points whose status changed from one step to the next, summed
    pub status_changes: usize,
    /// most joint points open, and slipping, at one time
    pub max_open_points: usize,
    pub max_slipping_points: usize,
    /// steps that had to be cut
    pub cut_steps: usize,
}

/// Gaps and slips below the size of an atom [m] are round-off, as before a wave arrives.
const ATOM: f64 = 1e-10;

/// How many joint points are open, and how many slip, by more than an atom.
pub fn open_and_slipping(interface: &Interface, state: &State, jumps: &[f64]) -> (usize, usize) {
    let points = interface.points.iter().zip(&state.joints);
    let gap = |p: &JointPoint| interface.local(p, jumps)[1] + p.law.gap;
    points.fold((0, 0), |(open, slipping), (p, j)| {
        let opens = j.status.is_open() && gap(p) > ATOM;
        let slips = j.status.is_slipping() && j.slip.abs() > ATOM;
        (open + usize::from(opens) * p.parts.len(), slipping + usize::from(slips) * p.parts.len())
    })
}

impl ContactRecord {
    /// After a step to a `new` state with these jumps, where [`open_and_slipping`] finds so many points.
    pub fn after(
        self,
        interface: &Interface,
        old: &State,
        new: &State,
        jumps: &[f64],
        (open, slipping): (usize, usize),
    ) -> ContactRecord {
        let points = interface.points.iter().zip(&new.joints);
        let gaps = points.clone().map(|(p, _)| interface.local(p, jumps)[1] + p.law.gap);
        let slips = points.filter(|(_, j)| !j.status.is_open()).map(|(_, j)| j.slip.abs());
        let changed =
            old.joints.iter().zip(&new.joints).zip(&interface.points).filter(|((o, n), _)| o.status != n.status);
        let changes: usize = changed.map(|(_, p)| p.parts.len()).sum();
        ContactRecord {
            max_open: gaps.fold(self.max_open, f64::max),
            max_slip: slips.fold(self.max_slip, f64::max),
            status_changes: self.status_changes + changes,
            max_open_points: self.max_open_points.max(open),
            max_slipping_points: self.max_slipping_points.max(slipping),
            cut_steps: self.cut_steps,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::joint::Status;
    use crate::solve::interface::JointState;
    use crate::solve::interface::testing::{LAW, along};

    /// Four points of two elements, the middle two of them one: it opens and then slips, and counts for two.
    #[test]
    fn points_are_counted_by_element() {
        let interface = along(&[[0., 0.], [1., 0.], [4., 0.]], &[LAW, LAW]);
        let state = |statuses: [Status; 3]| State {
            time: 0.,
            q: vec![],
            v: vec![],
            a: vec![],
            joints: statuses.map(|status| JointState { slip: -1e-3, status, ..JointState::default() }).to_vec(),
            free_field: vec![],
            largest_force: 0.,
        };
        let stuck = state([Status::Stick; 3]);
        let opened = state([Status::Stick, Status::Open, Status::Stick]);
        let slipping = state([Status::Open, Status::SlipBackward, Status::Stick]);
        // normals point down; the first point's gap is an atom's tenth
        let jumps = [0., -1e-11, 0., -2e-3, 0., 0.];
        let mut record = ContactRecord::default();
        for (old, new, points) in [(&stuck, &opened, (2, 0)), (&opened, &slipping, (0, 2))] {
            assert_eq!(open_and_slipping(&interface, new, &jumps), points);
            record = record.after(&interface, old, new, &jumps, points);
        }
        assert_eq!((record.status_changes, record.max_open_points, record.max_slipping_points), (2 + 3, 2, 2));
        assert_eq!((record.max_open, record.max_slip), (2e-3, 1e-3));
    }
}
