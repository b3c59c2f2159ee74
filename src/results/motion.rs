//! How far a motion goes beyond what small displacements mean: equilibrium is that of the shape before, pairs stay
//! pairs.

use crate::model::mesh::Mesh;
use crate::model::resolve::Model;
use crate::number::{self, seconds};
use crate::solve::system::{State, System};
use std::collections::HashSet;

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

/// The distances between nodes that should stay small.
pub struct Spans {
    /// each side of an element over its length
    sides: Vec<Span>,
    /// each pair of a joint over the joint's length
    pairs: Vec<Span>,
}

impl Spans {
    pub fn new(model: &Model) -> Spans {
        let mesh = &model.mesh;
        let mut once = HashSet::new();
        let sides = model.faces().flat_map(|(cell, _)| {
            let nodes = &mesh.cells[cell].nodes;
            mesh.cells[cell].shape.sides().into_iter().map(|side| [nodes[side[0]], nodes[side[1]]])
        });
        let sides = sides.filter(|&[a, b]| once.insert([a.min(b), a.max(b)]));
        let pairs = model.joints.iter().flat_map(|joint| {
            // the first two nodes of a line are its ends
            let ends = [joint.pairs[0], joint.pairs[1]].map(|pair| model.pairs[pair].ground);
            let between = |&pair: &usize| [model.pairs[pair].ground, model.pairs[pair].body];
            joint.pairs.iter().map(move |pair| Span::new(mesh, between(pair), ends))
        });
        Spans { sides: sides.map(|ends| Span::new(mesh, ends, ends)).collect(), pairs: pairs.collect() }
    }
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
    /// With one more state; `spans`: those of `mesh`.
    pub fn after(self, spans: &Spans, mesh: &Mesh, system: &System, state: &State) -> Motion {
        let u = system.unknowns.at_nodes(&state.q);
        let with = |before: Largest, spans: &[Span]| {
            let now = spans.iter().map(|span| span.square(&u)).enumerate().fold((0., 0), larger);
            let value = now.0.sqrt();
            match value > before.value {
                true => Largest { value, at: mesh.points[spans[now.1].nodes[0]], time: state.time },
                false => before,
            }
        };
        Motion { turn: with(self.turn, &spans.sides), jump: with(self.jump, &spans.pairs) }
    }

    /// Says so where the equations hold no longer.
    pub fn warnings(&self) -> Vec<String> {
        let Motion { turn, jump } = self;
        let place = |l: &Largest| format!("at {}, t = {}", number::place(l.at), seconds(l.time));
        let mut warnings = Vec::new();
        if jump.value > LARGE {
            warnings.push(format!(
                "a gap or slip grows to {:.0} % of the joint's length {}: node pairs stay pairs however far they part, so \
                 contact there is no longer where it should be; take the results as far as jumps are small",
                100. * jump.value,
                place(jump)
            ));
        }
        if turn.value > LARGE {
            warnings.push(format!(
                "an element turns or strains by {:.2} {}: displacements are taken as small, which is wrong by about as much; \
                 take the results as far as turns are small",
                turn.value,
                place(turn)
            ));
        }
        warnings
    }
}

fn larger(most: (f64, usize), (i, square): (usize, f64)) -> (f64, usize) {
    if square > most.0 { (square, i) } else { most }
}

/// How far two nodes part, over a length.
struct Span {
    nodes: [usize; 2],
    /// length^-2 [1/m^2]
    scale: f64,
}

impl Span {
    /// `ends`: the nodes whose distance is the length.
    fn new(mesh: &Mesh, nodes: [usize; 2], ends: [usize; 2]) -> Span {
        Span { nodes, scale: 1. / square_of_distance(ends.map(|node| mesh.points[node])) }
    }

    /// (|u_b - u_a| / length)^2: the largest has the largest root.
    fn square(&self, u: &[[f64; 2]]) -> f64 {
        self.scale * square_of_distance(self.nodes.map(|node| u[node]))
    }
}

fn square_of_distance([a, b]: [[f64; 2]; 2]) -> f64 {
    (b[0] - a[0]).powi(2) + (b[1] - a[1]).powi(2)
}
