//! Groups of the mesh that the case does not use.

use super::case::Case;
use super::mesh::{Group, Mesh};
use super::sides::{Edge, Sides, edge, solid_sides};
use crate::escape;
use crate::{Error, Result};
use std::collections::{BTreeSet, HashMap};

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
    let unused: Vec<&Group> =
        mesh.groups.iter().filter(|g| g.dimension == 1 && is_closed(mesh, g) && !is_used(g, case, mesh)).collect();
    if unused.is_empty() {
        return Ok(());
    }
    let sides = solid_sides(mesh);
    let bodies: Vec<&Group> = mesh
        .groups
        .iter()
        .filter(|g| g.dimension == 2 && case.materials.keys().any(|name| g.is_called(name)))
        .collect();
    let enclosed = |curve: &Group| bodies.iter().find(|body| is_border_of(mesh, &sides, curve, body)).copied();
    match unused.iter().find_map(|curve| Some((&curve.name, &enclosed(curve)?.name))) {
        None => Ok(()),
        Some((curve, body)) => Err(Error::input(format!(
            "\"{curve}\" is the border between \"{body}\" and the ground, and the case does not mention it, so that the two \
             would be bonded: write interfaces.{curve} = {{ \"body\": \"{body}\" }} to let them open and slip, or \
             interfaces.{curve} = \"bonded\""
        ))),
    }
}

/// Whether exactly two lines meet at each of its corners.
fn is_closed(mesh: &Mesh, curve: &Group) -> bool {
    let mut lines_at: HashMap<usize, usize> = HashMap::new();
    let ends = curve.cells.iter().flat_map(|&line| mesh.cells[line].corners());
    ends.for_each(|&node| *lines_at.entry(node).or_default() += 1);
    !curve.cells.is_empty() && lines_at.values().all(|&lines| lines == 2)
}

/// Whether the curve consists of all sides that the body's faces share with other faces.
fn is_border_of(mesh: &Mesh, sides: &Sides, curve: &Group, body: &Group) -> bool {
    let lines: BTreeSet<Edge> = curve.cells.iter().map(|&line| edge(&mesh.cells[line].nodes)).collect();
    let of_body = |face: usize| body.cells.binary_search(&face).is_ok();
    let shared = sides.iter().filter(|(_, faces)| match faces[..] {
        [(a, _), (b, _)] => of_body(a) != of_body(b),
        _ => false,
    });
    lines == shared.map(|(side, _)| *side).collect()
}
