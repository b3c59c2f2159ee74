//! The last digits of a step without inertia.

use super::contact::{Contact, Problem, Solution};
use crate::sparse::vector::norm;

/// Most of Newton's steps for the last digits; two do unless the first jumps were larger than the last by 1e10.
const REFINEMENTS: usize = 5;

impl Contact {
    /// Newton's steps on j - N c, the jumps less those of the displacements, as long as each halves it. Where weak
    /// springs alone resist a motion, a residual below the tolerance leaves the body far from where they hold it.
    pub(super) fn refined(&mut self, problem: &Problem, solution: Solution) -> Solution {
        let mut best = solution;
        let mut apart = self.apart(&best.jumps, &best.border);
        for _ in 0..REFINEMENTS {
            if norm(&apart) == 0. {
                break;
            }
            let missed = self.condensate.forces(&apart);
            let tangents = self.tangents(&best.responses);
            let step = self.inverse.solve(&self.condensate.schur, problem.joints.interface, &tangents, &missed);
            let jumps: Vec<f64> = best.jumps.iter().zip(&step).map(|(j, d)| j - d).collect();
            let branches = problem.joints.branches(&jumps);
            let border = self.border(problem, &branches);
            let still_apart = self.apart(&jumps, &border);
            // what is not a number halves nothing
            let halved = norm(&still_apart) <= norm(&apart) / 2.;
            if !halved {
                break;
            }
            apart = still_apart;
            best = Solution { border, jumps, responses: branches.responses, ..best };
        }
        best
    }

    /// j - N c [m].
    pub(super) fn apart(&self, jumps: &[f64], border: &[f64]) -> Vec<f64> {
        jumps.iter().zip(self.condensate.jumps(border)).map(|(jump, made)| jump - made).collect()
    }
}
