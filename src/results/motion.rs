//! How far a motion goes beyond what small displacements mean: equilibrium is that of the shape before, pairs stay pairs.

use crate::model::mesh::Mesh;
use crate::model::resolve::Model;
use crate::solve::system::{State, System};

/// Where turns, strains and jumps are larger than this [-], equations for small ones are off by about as much.
const LARGE: f64 = 0.1;

/// The largest of a kind so far, where and when.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Largest {
    pub value: f64,
    /// [m]
    pub at: [f64; 2],
    /// [s]
    pub time: f64,
}

/// Displacements against the size of the elements, the largest so far.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// |u_b - u_a| over the length of a side a-b: a turn [rad] or a strain
    pub turn: Largest,
    /// jump between the sides of a joint over its length
    pub jump: Largest,
}

impl Motion {
    /// With one more state.
    pub fn after(self, model: &Model, system: &System, state: &State) -> Motion {
        let u = system.unknowns.at_nodes(&state.q);
        let mesh = &model.mesh;
        let turns = model.faces().flat_map(|(cell, _)| {
            let nodes = &mesh.cells[cell].nodes;
            mesh.cells[cell].shape.sides().into_iter().map(|side| [nodes[side[0]], nodes[side[1]]])
        });
        let turns = turns.map(|[a, b]| Largest {
            value: distance(u[a], u[b]) / distance(mesh.points[a], mesh.points[b]),
            at: mesh.points[a],
            time: state.time,
        });
        let jumps =
            model.joints.iter().flat_map(|joint| joint.pairs.iter().map(move |&pair| (joint, model.pairs[pair])));
        let jumps = jumps.map(|(joint, pair)| Largest {
            value: distance(u[pair.ground], u[pair.body])
                / length(mesh, joint.pairs.iter().map(|&p| model.pairs[p].ground)),
            at: mesh.points[pair.ground],
            time: state.time,
        });
        Motion { turn: turns.fold(self.turn, larger), jump: jumps.fold(self.jump, larger) }
    }

    /// Says so where the equations hold no longer.
    pub fn warnings(&self) -> Vec<String> {
        let place = |l: &Largest| format!("at ({:.4}, {:.4}) m, t = {:.3e} s", l.at[0], l.at[1], l.time);
        let mut warnings = Vec::new();
        if self.jump.value > LARGE {
            warnings.push(format!(
                "a gap or slip grows to {:.0} % of the joint's length {}: node pairs stay pairs however far they part, so \
                 contact there is no longer where it should be; take the results as far as jumps are small",
                100. * self.jump.value,
                place(&self.jump)
            ));
        }
        if self.turn.value > LARGE {
            warnings.push(format!(
                "an element turns or strains by {:.2} {}: displacements are taken as small, which is wrong by about as much; \
                 take the results as far as turns are small",
                self.turn.value,
                place(&self.turn)
            ));
        }
        warnings
    }
}

fn larger(a: Largest, b: Largest) -> Largest {
    if b.value > a.value { b } else { a }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// Between a line's first two nodes, its ends.
fn length(mesh: &Mesh, mut nodes: impl Iterator<Item = usize>) -> f64 {
    let ends = [nodes.next(), nodes.next()].map(|n| n.map_or([0.; 2], |n| mesh.points[n]));
    distance(ends[0], ends[1])
}
