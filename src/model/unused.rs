//! Groups of the mesh that the case does not use.

use super::case::Case;
use super::mesh::{Group, Mesh};
use super::sides::{Edge, Sides, edge, solid_sides};
use crate::escape;
use crate::{Error, Result};
use std::collections::{BTreeMap, BTreeSet};

/// Groups of curves and surfaces that the case does not use.
pub fn groups(case: &Case, mesh: &Mesh) -> Option<String> {
    let unused = mesh.groups.iter().filter(|g| g.dimension > 0 && !g.is_a_side() && !is_used(g, case, mesh));
    let names: Vec<_> = unused.map(|g| escape::name(&g.name)).collect();
    (!names.is_empty()).then(|| format!("groups of {} that the case does not use: {}", mesh.name, names.join(", ")))
}

fn is_used(group: &Group, case: &Case, mesh: &Mesh) -> bool {
    let of_dimension = |dimension: usize, name: &str| group.dimension == dimension && group.is_called(name);
    let of_any = |name: &str| group.is_called(name) && mesh.group(name).is_ok_and(|meant| meant == group);
    let bodies = case.interfaces.opened.values().map(|interface| &interface.body);
    case.materials.keys().chain(bodies).any(|name| of_dimension(2, name))
        || case
            .interfaces
            .opened
            .keys()
            .chain(&case.interfaces.bonded)
            .chain(case.boundaries.keys())
            .chain(&case.slits)
            .any(|name| of_dimension(1, name))
        || case.loads.iter().any(|(name, load)| of_dimension(load.dimension(), name))
        || case.supports.keys().chain(case.initial.keys()).any(|name| of_any(name))
}

/// Error: a curve closes round a body and the case does not mention it, so that the body would be bonded to the ground
/// unnoticed.
pub fn refuse_closed_curves(case: &Case, mesh: &Mesh) -> Result<()> {
    let is_mentioned = |g: &Group| {
        let interfaces = &case.interfaces;
        let names = interfaces.opened.keys().chain(&interfaces.bonded).chain(&case.slits);
        names.into_iter().any(|name| g.is_called(name))
    };
    let curves = || mesh.groups.iter().filter(|g| g.dimension == 1);
    let lines = |g: &Group| g.cells.iter().map(|&line| edge(&mesh.cells[line].nodes)).collect::<Vec<_>>();
    let mentioned: BTreeSet<Edge> = curves().filter(|g| is_mentioned(g)).flat_map(lines).collect();
    let forgotten = |g: &&Group| !is_mentioned(g) && !lines(g).iter().all(|line| mentioned.contains(line));
    match enclosed(case, mesh, curves().filter(forgotten)).first() {
        None => Ok(()),
        Some((curve, body)) => Err(Error::input(format!(
            "\"{curve}\" is the border between \"{body}\" and what lies round it, and no interface has it, so that the two would be \
             bonded: write interfaces.{curve} = {{ \"body\": \"{body}\" }} to let them open and slip, or \
             interfaces.{curve} = \"bonded\""
        ))),
    }
}

/// Bodies within curves that the case calls bonded.
pub fn bonded_bodies(case: &Case, mesh: &Mesh) -> Vec<String> {
    let is_bonded = |g: &&Group| g.dimension == 1 && case.interfaces.bonded.iter().any(|name| g.is_called(name));
    enclosed(case, mesh, mesh.groups.iter().filter(is_bonded)).into_iter().map(|(_, body)| body).collect()
}

/// Groups of curves and points that lie on interfaces which stay closed.
pub fn on_closed_interfaces(case: &Case, mesh: &Mesh, all: bool) -> BTreeSet<String> {
    let opened = case.interfaces.opened.keys().filter(|_| all);
    let closed: Vec<&String> = opened.chain(&case.interfaces.bonded).collect();
    let is_closed = |g: &&Group| g.dimension == 1 && closed.iter().any(|name| g.is_called(name));
    let nodes: BTreeSet<usize> = mesh.groups.iter().filter(is_closed).flat_map(|g| mesh.nodes_of(g)).collect();
    let lies_there = |g: &&Group| {
        g.dimension < 2 && g.cells.iter().any(|&cell| mesh.cells[cell].nodes.iter().all(|node| nodes.contains(node)))
    };
    mesh.groups.iter().filter(lies_there).map(|g| g.name.clone()).collect()
}

/// (curve, body) where a closed line of the curve is the outer border of the body, a surface with a material, and other
/// faces lie beyond all of it.
fn enclosed<'a>(case: &Case, mesh: &Mesh, curves: impl Iterator<Item = &'a Group>) -> Vec<(String, String)> {
    let closed: Vec<(&Group, BTreeSet<Edge>)> =
        curves.flat_map(|curve| closed_lines(mesh, curve).into_iter().map(move |line| (curve, line))).collect();
    if closed.is_empty() {
        return vec![];
    }
    let sides = solid_sides(mesh);
    let has_material = |g: &&Group| g.dimension == 2 && case.materials.keys().any(|name| g.is_called(name));
    let bodies: Vec<&Group> = mesh.groups.iter().filter(has_material).collect();
    let of_body = |(curve, line): &(&Group, BTreeSet<Edge>)| {
        let body = bodies.iter().find(|body| is_outer_border(mesh, &sides, line, body))?;
        Some((curve.name.clone(), body.name.clone()))
    };
    closed.iter().filter_map(of_body).collect()
}

/// The connected parts of a curve in which exactly two lines meet at every corner.
fn closed_lines(mesh: &Mesh, curve: &Group) -> Vec<BTreeSet<Edge>> {
    let mut lines_at: BTreeMap<usize, Vec<Edge>> = BTreeMap::new();
    for line in curve.cells.iter().map(|&line| edge(&mesh.cells[line].nodes)) {
        lines_at.entry(line.0).or_default().push(line);
        lines_at.entry(line.1).or_default().push(line);
    }
    let mut parts = Vec::new();
    let mut left: BTreeSet<usize> = lines_at.keys().copied().collect();
    while let Some(first) = left.pop_first() {
        let (mut part, mut ends, mut is_closed) = (BTreeSet::new(), vec![first], true);
        while let Some(end) = ends.pop() {
            left.remove(&end);
            is_closed &= lines_at[&end].len() == 2;
            for &line in lines_at[&end].iter().filter(|line| part.insert(**line)) {
                ends.extend([line.0, line.1]);
            }
        }
        parts.extend(is_closed.then_some(part));
    }
    parts
}

/// Whether a closed line runs between the body, which lies within, and other faces.
fn is_outer_border(mesh: &Mesh, sides: &Sides, line: &BTreeSet<Edge>, body: &Group) -> bool {
    let is_of_body = |face: usize| body.cells.binary_search(&face).is_ok();
    // twice the area that the body's sides run round anticlockwise; none where the line is not between it and others
    let area: Option<f64> = line
        .iter()
        .map(|side| {
            let [(a, of_a), (b, of_b)] = &sides.get(side)?[..] else { return None };
            let nodes = match (is_of_body(*a), is_of_body(*b)) {
                (true, false) => of_a,
                (false, true) => of_b,
                _ => return None,
            };
            let [[x0, y0], [x1, y1]] = [0, 1].map(|i| mesh.points[nodes[i]]);
            Some(x0 * y1 - x1 * y0)
        })
        .sum();
    area.is_some_and(|area| area > 0.)
}
