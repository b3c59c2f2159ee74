//! Curves that let waves out: which they are, where they must not be, and how they hold the ground while nothing moves.

use super::boundary::{Border, border};
use super::case::{Boundary, Case};
use super::mesh::Mesh;
use super::resolve::{Load, Model, Target};
use super::sides::{Sides, edge};
use crate::number::place;
use crate::physics::material::Material;
use crate::{Error, Result};

/// A line of dashpots.
#[derive(Debug, Clone, PartialEq)]
pub struct Absorber {
    pub line: Border,
    /// the face behind it
    pub face: usize,
    /// of that face
    pub material: Material,
    /// place of its group among the case's boundaries
    pub group: usize,
}

/// The lines of all boundaries.
///
/// Errors: a curve that is held as well, or viscous where a load pushes along it.
pub fn absorbers(
    case: &Case,
    mesh: &Mesh,
    sides: &Sides,
    material_of: impl Fn(usize) -> Material,
    loads: &[Load],
) -> Result<Vec<Absorber>> {
    let mut absorbers = Vec::new();
    for (number, (name, kind)) in case.boundaries.iter().enumerate() {
        let group = mesh.group_of(name, 1, "boundary")?;
        refuse_support(case, mesh, name, &group.cells)?;
        refuse_interface(case, mesh, name, &group.cells)?;
        for (line, face) in border(mesh, group, sides)? {
            if *kind == Boundary::Viscous {
                refuse_drain(mesh, name, &line, face, loads)?;
            }
            absorbers.push(Absorber { line, face, material: material_of(face), group: number });
        }
    }
    Ok(absorbers)
}

/// A support of the same name, or of another curve that runs over the same lines, would hold what should move.
fn refuse_support(case: &Case, mesh: &Mesh, name: &str, cells: &[usize]) -> Result<()> {
    for other in case.supports.keys() {
        let group = mesh.group(other).map_err(|e| Error::input(format!("supports: {e}")))?;
        if let Some(&cell) = cells.iter().find(|cell| group.cells.binary_search(cell).is_ok()) {
            let which = if other == name { String::new() } else { format!(", as \"{other}\",") };
            return Err(Error::input(format!(
                "\"{name}\" stands in boundaries and{which} in supports, at {}: a curve that lets waves out cannot be held; \
                 take it out of one (a static stage holds it by itself)",
                mesh.place(cell)
            )));
        }
    }
    Ok(())
}

/// Ground goes on behind an interface: its body.
fn refuse_interface(case: &Case, mesh: &Mesh, name: &str, cells: &[usize]) -> Result<()> {
    for (other, interface) in &case.interfaces.opened {
        let Ok(group) = mesh.group_of(other, 1, "interface") else { continue };
        if cells.iter().any(|cell| group.cells.binary_search(cell).is_ok()) {
            return Err(Error::input(format!(
                "boundaries.{name}: it lies on the interface \"{other}\" of \"{}\", inside the model; boundaries are edges of the mesh \
                 beyond which the ground goes on",
                interface.body
            )));
        }
    }
    Ok(())
}

/// Says where a load acts on dashpots themselves.
pub fn loaded(case: &Case, model: &Model) -> Option<String> {
    let lines = model.loads.iter().flat_map(|load| match &load.target {
        Target::Pressure { lines } | Target::Traction { lines, .. } => lines.iter().map(|l| (load, l)).collect(),
        _ => vec![],
    });
    let own = |line: &Border| model.absorbers.iter().find(|a| edge(&a.line.nodes) == edge(&line.nodes));
    let (load, absorber) = lines.filter_map(|(load, line)| Some((load, own(line)?))).next()?;
    let name = case.boundaries.keys().nth(absorber.group)?;
    Some(format!(
        "the load on \"{}\" acts on the dashpots of the boundary \"{name}\": the ground beyond takes half of it, as where a wave is \
         sent in from there; a free surface has no boundary",
        load.group
    ))
}

/// Where a load pushes along a viscous curve, the wave it makes runs along the dashpots: a load on a curve that ends
/// there, or on the ground right behind an upright one. The wave of a loaded line leaves it at right angles, so a curve
/// that goes on in the line's own direction is not on its way: a traction along a base sends an S wave away from all of it.
fn refuse_drain(mesh: &Mesh, name: &str, line: &Border, face: usize, loads: &[Load]) -> Result<()> {
    let along = line.tangent(mesh);
    for load in loads {
        let pushes: Vec<([f64; 2], usize)> = match &load.target {
            Target::Pressure { lines } => {
                let inwards = |l: &Border| [-l.tangent(mesh)[1], l.tangent(mesh)[0]];
                ends_at(line, lines).map(|(loaded, corner)| (inwards(loaded), corner)).collect()
            }
            Target::Traction { lines, direction } => {
                let across = ends_at(line, lines).filter(|(loaded, _)| !is_continuation(along, loaded.tangent(mesh)));
                across.map(|(_, corner)| (*direction, corner)).collect()
            }
            Target::BodyForce { cells, direction } if cells.contains(&face) && along[1].abs() > along[0].abs() => {
                vec![(*direction, line.nodes[0])]
            }
            _ => continue,
        };
        let slides = |[dx, dy]: [f64; 2]| (dx * along[0] + dy * along[1]).abs() > (dx * along[1] - dy * along[0]).abs();
        if let Some((_, node)) = pushes.into_iter().find(|(direction, _)| slides(*direction)) {
            let place = place(mesh.points[node]);
            return Err(Error::input(format!(
                "boundaries.{name}: it is \"viscous\", and the load on \"{}\" pushes along it where the two meet, at \
                 {place}: the ground beyond such a side moves with the wave, but dashpots would hold on to it and \
                 drain it; write \"free_field\" there, or take it out of boundaries and hold it across: \
                 \"supports\": {{ \"{name}\": [\"{}\"] }}",
                load.group,
                if along[1].abs() > along[0].abs() { "x" } else { "y" }
            )));
        }
    }
    Ok(())
}

/// Two lines that meet turn by less than 45 degrees.
fn is_continuation(along: [f64; 2], other: [f64; 2]) -> bool {
    (along[0] * other[0] + along[1] * other[1]).abs() > (along[0] * other[1] - along[1] * other[0]).abs()
}

/// Those of the loaded lines that share a node with a boundary's line without being it, and the node.
fn ends_at<'a>(line: &'a Border, loaded: &'a [Border]) -> impl Iterator<Item = (&'a Border, usize)> {
    let others = loaded.iter().filter(|l| edge(&l.nodes) != edge(&line.nodes));
    others.filter_map(|l| Some((l, *l.nodes.iter().find(|n| line.nodes.contains(n))?)))
}

impl Model {
    /// The model while nothing moves: upright absorbing lines hold x (rollers), all others x and y.
    pub fn held(&self) -> Model {
        let mut fixed = self.fixed.clone();
        for absorber in &self.absorbers {
            let upright = absorber.line.is_upright(&self.mesh);
            for &node in &absorber.line.nodes {
                fixed[node] = [true, fixed[node][1] || !upright];
            }
        }
        Model { fixed, absorbers: vec![], free_fields: vec![], ..self.clone() }
    }
}
