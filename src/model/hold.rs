//! Whether supports hold every part of the mesh: without inertia what is loose has no equilibrium, and with inertia it
//! flies.

use super::case::Analysis;
use super::resolve::Model;
use crate::number::place;
use crate::{Error, Result};
use std::collections::{BTreeMap, BTreeSet};

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
    match parts(model, true).iter().find_map(|part| part.loose(model)) {
        None => Ok(()),
        Some(loose) => Err(Error::input(format!(
            "{loose}: a steady load needs supports (or an interface to what is held) in x, in y and against turning"
        ))),
    }
}

/// In a dynamic calculation: a sentence for each part that nothing holds beside others that are held. A part that is
/// given a velocity is meant to fly.
pub fn unheld_parts(model: &Model) -> Vec<String> {
    if model.analysis == Analysis::Static || model.gravity != 0. {
        return vec![];
    }
    let held = &model.held();
    let parts = parts(held, true);
    if parts.iter().all(|part| part.loose(held).is_some()) {
        return vec![];
    }
    let rests = |part: &&Part| part.nodes.iter().all(|&n| model.initial.velocity[n] == [0.; 2]);
    let sentence = |how: String| {
        format!(
            "{how}: it moves as a rigid body, with natural frequencies of 0 Hz, and goes through what it meets; supports or an \
             interface to what is held would hold it"
        )
    };
    parts.iter().filter(rests).filter_map(|part| part.loose(held)).map(sentence).collect()
}

/// Parts that the supports leave a rigid motion as long as no joint presses them: they are held by joints, or by nothing.
pub fn held_by_joints(model: &Model) -> Vec<Part> {
    parts(model, false).into_iter().filter(|part| free_motion(model, &part.nodes).is_some()).collect()
}

/// Faces that share nodes, or that joints press together.
pub struct Part {
    /// ascending
    pub nodes: Vec<usize>,
    /// names of the materials
    surfaces: BTreeSet<String>,
}

impl Part {
    /// `"a", "b"`: its surfaces.
    pub fn name(&self) -> String {
        self.surfaces.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ")
    }

    /// `nothing holds "a" round (0, 0) m in x`, if so, with the cause where it lies on another part.
    fn loose(&self, model: &Model) -> Option<String> {
        let how = free_motion(model, &self.nodes)?;
        let mean =
            |i: usize| self.nodes.iter().map(|&n| model.mesh.points[n][i]).sum::<f64>() / self.nodes.len() as f64;
        let cause = self.slit(model).map_or(String::new(), |at| {
            format!(", since it shares no nodes with the part that it touches along a slit at {}", place(at))
        });
        Some(format!("nothing holds {} round {} {how}{cause}", self.name(), place([0, 1].map(mean))))
    }

    /// A place where it touches another part along a slit of the case.
    fn slit(&self, model: &Model) -> Option<[f64; 2]> {
        let is_own = |face: usize| self.nodes.binary_search(&model.mesh.cells[face].nodes[0]).is_ok();
        let slit = model.slits.iter().find(|slit| is_own(slit.faces[0]) != is_own(slit.faces[1]))?;
        Some([0, 1].map(|i| (slit.ends[0][i] + slit.ends[1][i]) / 2.))
    }
}

/// In the order of their first nodes; with joints, what they press together is one part.
fn parts(model: &Model, with_joints: bool) -> Vec<Part> {
    let numbers = part_numbers(model, with_joints);
    let mut parts: BTreeMap<usize, Part> = BTreeMap::new();
    for (node, &number) in numbers.iter().enumerate() {
        let part = parts.entry(number).or_insert(Part { nodes: vec![], surfaces: BTreeSet::new() });
        part.nodes.push(node);
    }
    for (cell, _) in model.faces() {
        let number = numbers[model.mesh.cells[cell].nodes[0]];
        let name = model.material_of[cell].map(|m| model.materials[m].0.as_str());
        if let (Some(part), Some(name)) = (parts.get_mut(&number), name)
            && !part.surfaces.contains(name)
        {
            part.surfaces.insert(name.into());
        }
    }
    // nodes of no face are no part of the solid
    parts.into_values().filter(|part| !part.surfaces.is_empty()).collect()
}

/// For each node the number of its part.
fn part_numbers(model: &Model, with_joints: bool) -> Vec<usize> {
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
    if with_joints {
        model.pairs.iter().for_each(|pair| join(pair.ground, pair.body));
    }
    (0..leader.len()).map(|n| lead(&mut leader, n)).collect()
}

/// How these nodes can move as a rigid body, u = (a - c y, b + c x), with u = 0 where they are held; none if they
/// cannot.
fn free_motion(model: &Model, nodes: &[usize]) -> Option<&'static str> {
    let is_held = |axis: usize| nodes.iter().any(|&n| model.fixed[n][axis]);
    match (is_held(0), is_held(1)) {
        (false, false) => Some("in x and y"),
        (false, true) => Some("in x"),
        (true, false) => Some("in y"),
        (true, true) => pivot(model, nodes).map(|_| "against turning"),
    }
}

/// The point about which these nodes can turn as a rigid body, if supports leave them a turn: x of those held in y, y
/// of those held in x, else the middle.
pub fn pivot(model: &Model, nodes: &[usize]) -> Option<[f64; 2]> {
    let all = [0, 1].map(|i| Range::of(nodes.iter().map(|&n| model.mesh.points[n][i])));
    let held = |axis: usize| nodes.iter().filter(move |&&n| model.fixed[n][axis]).map(|&n| model.mesh.points[n]);
    // The rows (1, 0, -y) and (0, 1, x) leave a turn if all y held in x are equal and all x held in y are.
    let places = [Range::of(held(1).map(|p| p[0])), Range::of(held(0).map(|p| p[1]))];
    let least = ROTATION * all[0].length().max(all[1].length());
    let turns = places.iter().all(|place| place.length() <= least);
    turns.then(|| [0, 1].map(|i| if places[i].is_empty() { all[i].middle() } else { places[i].middle() }))
}

/// From the least to the greatest of some coordinates [m].
struct Range([f64; 2]);

impl Range {
    fn of(values: impl Iterator<Item = f64>) -> Range {
        Range(values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)]))
    }

    fn is_empty(&self) -> bool {
        self.0[0] > self.0[1]
    }

    /// Negative of none.
    fn length(&self) -> f64 {
        self.0[1] - self.0[0]
    }

    fn middle(&self) -> f64 {
        (self.0[0] + self.0[1]) / 2.
    }
}
