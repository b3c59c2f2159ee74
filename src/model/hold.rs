//! Whether supports hold every part of the mesh: without inertia what is loose has no equilibrium.

use super::case::Analysis;
use super::resolve::Model;
use crate::number::place;
use crate::{Error, Result};
use std::collections::BTreeSet;

/// A part's rotation counts as held if the supports' rows have this share of their size left when its shifts are gone.
const ROTATION: f64 = 1e-9;

/// Elements that share nodes, and bodies that joints press together, move as one part; each needs a support in x, one
/// in y, and something against turning: two held in x at different heights, or in y side by side.
///
/// Error: a part that can shift or turn under a static load or gravity, with its surfaces, place and direction.
pub fn refuse_loose(model: &Model) -> Result<()> {
    if model.analysis == Analysis::Dynamic && model.gravity == 0. {
        return Ok(());
    }
    let model = &model.held();
    let part = parts(model);
    for number in part.iter().copied().collect::<BTreeSet<_>>() {
        let nodes: Vec<usize> = (0..part.len()).filter(|&n| part[n] == number).collect();
        let surfaces: BTreeSet<&str> = model
            .faces()
            .filter(|(cell, _)| part[model.mesh.cells[*cell].nodes[0]] == number)
            .filter_map(|(cell, _)| model.material_of[cell].map(|m| model.materials[m].0.as_str()))
            .collect();
        // nodes of no face are no part of the solid
        if let (false, Some(how)) = (surfaces.is_empty(), free_motion(model, &nodes)) {
            let names: Vec<String> = surfaces.iter().map(|name| format!("\"{name}\"")).collect();
            let mean = |i: usize| nodes.iter().map(|&n| model.mesh.points[n][i]).sum::<f64>() / nodes.len() as f64;
            return Err(Error::input(format!(
                "nothing holds {} round {} {how}: a steady load needs supports (or an interface to what is \
                 held) in x, in y and against turning",
                names.join(", "),
                place([0, 1].map(mean))
            )));
        }
    }
    Ok(())
}

/// For each node the number of its part.
fn parts(model: &Model) -> Vec<usize> {
    let mut leader: Vec<usize> = (0..model.mesh.points.len()).collect();
    fn lead(leader: &mut [usize], mut node: usize) -> usize {
        while leader[node] != node {
            leader[node] = leader[leader[node]];
            node = leader[node];
        }
        node
    }
    let mut join = |a: usize, b: usize| {
        let (a, b) = (lead(&mut leader, a), lead(&mut leader, b));
        leader[a.max(b)] = a.min(b);
    };
    for (cell, _) in model.faces() {
        let nodes = &model.mesh.cells[cell].nodes;
        nodes[1..].iter().for_each(|&n| join(nodes[0], n));
    }
    model.pairs.iter().for_each(|pair| join(pair.ground, pair.body));
    (0..leader.len()).map(|n| lead(&mut leader, n)).collect()
}

/// How these nodes can move as a rigid body, u = (a - c y, b + c x), with u = 0 where they are held; none if they
/// cannot.
fn free_motion(model: &Model, nodes: &[usize]) -> Option<&'static str> {
    let held = |axis: usize| nodes.iter().filter(move |&&n| model.fixed[n][axis]).map(|&n| model.mesh.points[n]);
    let (in_x, in_y): (Vec<_>, Vec<_>) = (held(0).collect(), held(1).collect());
    if in_x.is_empty() || in_y.is_empty() {
        return Some(match (in_x.is_empty(), in_y.is_empty()) {
            (true, true) => "in x and y",
            (true, false) => "in x",
            _ => "in y",
        });
    }
    // The rows (1, 0, -y) and (0, 1, x) have rank 3 unless all y held in x are equal and all x held in y are.
    let spread = |values: Vec<f64>| {
        let ends = values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(*v), high.max(*v)]);
        ends[1] - ends[0]
    };
    let size = [0, 1].map(|i| spread(nodes.iter().map(|&n| model.mesh.points[n][i]).collect()));
    let arm = spread(in_x.iter().map(|p| p[1]).collect()).max(spread(in_y.iter().map(|p| p[0]).collect()));
    (arm <= ROTATION * size[0].max(size[1])).then_some("against turning")
}
