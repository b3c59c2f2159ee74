//! The nodes whose motion is written: named points, or the nodes nearest to a place.

use super::case::{Case, Probe};
use super::mesh::Mesh;
use super::quality;
use crate::number::{fixed, place, short};
use crate::{Error, Result};

/// A node whose motion is written at every step.
#[derive(Debug, Clone, PartialEq)]
pub struct NodeProbe {
    pub name: String,
    pub node: usize,
}

pub fn probes(case: &Case, mesh: &Mesh, warnings: &mut Vec<String>) -> Result<Vec<NodeProbe>> {
    let mut probes = Vec::new();
    for probe in &case.probes {
        let name = probe.name().to_string();
        let node = match probe {
            Probe::Group(group) => named_point(mesh, group)?,
            Probe::Place { at, body, .. } => nearest_node(mesh, &name, *at, body.as_deref(), warnings)?,
        };
        probes.push(NodeProbe { name, node });
    }
    Ok(probes)
}

fn named_point(mesh: &Mesh, name: &str) -> Result<usize> {
    let group = mesh.group_of(name, 0, "probe")?;
    match mesh.nodes_of(group)[..] {
        [node] => Ok(node),
        ref nodes => Err(Error::input(format!(
            "probe \"{name}\" must be one point; the group has {} points in {}",
            nodes.len(),
            mesh.name
        ))),
    }
}

fn nearest_node(
    mesh: &Mesh,
    name: &str,
    at: [f64; 2],
    body: Option<&str>,
    warnings: &mut Vec<String>,
) -> Result<usize> {
    let mut nodes = match body {
        Some(body) => mesh.nodes_of(mesh.group_of(body, 2, "probe body")?),
        None => {
            let faces = mesh.cells.iter().filter(|c| c.shape.dimension() == 2);
            faces.flat_map(|c| c.nodes.iter().copied()).collect()
        }
    };
    nodes.sort_unstable();
    let distance = |&n: &usize| (mesh.points[n][0] - at[0]).hypot(mesh.points[n][1] - at[1]);
    let nearest = nodes.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let node = nearest.ok_or_else(|| Error::input(format!("probe \"{name}\": {} has no nodes", mesh.name)))?;
    let place = place(mesh.points[node]);
    let at_short = format!("({}, {}) m", short(at[0]), short(at[1]));
    if distance(&node) > longest_side_at(mesh, node) {
        return Err(Error::input(format!(
            "probe \"{name}\" at {at_short} lies outside of {}: the nearest node, {place}, is {} m away, farther \
             than an element is long; the mesh spans {}",
            body.map_or(mesh.name.clone(), |body| format!("\"{body}\"")),
            short(distance(&node)),
            extent(mesh)
        )));
    }
    if distance(&node) > 1e-9 {
        warnings.push(format!(
            "probe \"{name}\" at {at_short} is taken at the nearest node, {place}, {} m away",
            fixed(3, distance(&node))
        ));
    }
    Ok(node)
}

/// Of the elements round a node [m].
fn longest_side_at(mesh: &Mesh, node: usize) -> f64 {
    let round = mesh.cells.iter().filter(|c| c.shape.dimension() == 2 && c.nodes.contains(&node));
    round.map(|face| quality::sides(mesh, face)[1]).fold(0., f64::max)
}

/// `x from 0 to 25 m, y from -15 to 0 m`
fn extent(mesh: &Mesh) -> String {
    let along = |i: usize, name: &str| {
        let values = mesh.points.iter().map(|p| p[i]);
        let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(v), h.max(v)]);
        format!("{name} from {} to {} m", short(low), short(high))
    };
    format!("{}, {}", along(0, "x"), along(1, "y"))
}
