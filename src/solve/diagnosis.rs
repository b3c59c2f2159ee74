//! Why Newton's method on the jumps ended without a solution.

use super::contact::{Contact, Iterate, Problem};
use super::unsettled::{Place, Unsettled};
use crate::physics::joint::Status;
use crate::sparse::vector::{norm, ratio};

impl Contact {
    /// Why Newton ends where it stands, `before` that with these statuses.
    pub(super) fn unsettled(&self, problem: &Problem, iterate: &Iterate, before: Option<&Vec<Status>>) -> Unsettled {
        let Iterate { missed, branches, tractions, .. } = iterate;
        let interface = problem.joints.interface;
        let forces = (0..missed.len()).filter_map(|i| Some((missed[i].abs(), interface.point_of(i)?)));
        // what is not a number is the largest of all
        let largest = forces.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, point)| point);
        let left = ratio(norm(missed), self.scale(problem, tractions, f64::INFINITY));
        if !left.is_finite() {
            return Unsettled::Overflow(largest.map_or(Place::Matrix, Place::JointPoint));
        }
        let relative = left.max(self.misfit(problem, branches, &self.border(problem, branches)));
        let last = branches.statuses();
        match before.map(|before| differing(before, &last)) {
            Some(changing) if !changing.is_empty() => Unsettled::Statuses { changing, last },
            _ => Unsettled::Residual { relative, largest, last },
        }
    }
}

fn differing(a: &[Status], b: &[Status]) -> Vec<usize> {
    (0..a.len()).filter(|&i| a[i] != b[i]).collect()
}
