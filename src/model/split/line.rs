//! The lines of the interfaces, each with the faces on its two sides.

use super::Seam;
use crate::model::mesh::Mesh;
use crate::model::sides::{Edge, Sides, edge};
use crate::number::place;
use crate::{Error, Result};
use std::collections::{BTreeSet, HashMap};

/// A line of a seam with the faces on its two sides.
pub(super) struct InterfaceLine {
    pub seam: usize,
    pub cell: usize,
    pub ground_cell: usize,
    pub body_cell: usize,
}

/// The lines of all seams, seam by seam.
///
/// Errors name the group and the coordinates: a curve that has not its body on one side and something else on the
/// other, a line that belongs to two interfaces.
pub(super) fn interface_lines(mesh: &Mesh, seams: &[Seam], faces_at: &Sides) -> Result<Vec<InterfaceLine>> {
    let mut lines: Vec<InterfaceLine> = Vec::new();
    let mut taken: HashMap<Edge, usize> = HashMap::new();
    for (number, seam) in seams.iter().enumerate() {
        let role = format!("interface \"{}\": its body", seam.curve);
        let faces: BTreeSet<usize> = mesh.group_of(&seam.body, 2, &role)?.cells.iter().copied().collect();
        let curve = mesh.group_of(&seam.curve, 1, "interface")?;
        for &cell in &curve.cells {
            if let Some(&other) = taken.get(&edge(&mesh.cells[cell].nodes)) {
                return Err(Error::input(format!(
                    "the line at {} belongs to two interfaces, \"{}\" and \"{}\": give each line of the geometry to one of \
                     them",
                    mesh.place(cell),
                    seams[other].curve,
                    seam.curve
                )));
            }
            taken.insert(edge(&mesh.cells[cell].nodes), number);
            let [body_cell, ground_cell] = two_sides(mesh, seam, cell, &faces, faces_at)?;
            lines.push(InterfaceLine { seam: number, cell, ground_cell, body_cell });
        }
    }
    Ok(lines)
}

/// The faces on the body's side and on the ground's. A crack inside its body has the body's side on the left of the
/// line as it is drawn.
fn two_sides(mesh: &Mesh, seam: &Seam, cell: usize, body: &BTreeSet<usize>, faces_at: &Sides) -> Result<[usize; 2]> {
    let nodes = &mesh.cells[cell].nodes;
    let beside = faces_at.get(&edge(nodes)).map_or(&[][..], Vec::as_slice);
    let inside = beside.iter().filter(|(face, _)| body.contains(face)).count();
    match beside {
        [(a, _), (b, _)] if inside == 1 => Ok(if body.contains(a) { [*a, *b] } else { [*b, *a] }),
        // faces run anticlockwise: the one on the left runs along the line
        [(a, side), (b, _)] if inside == 2 => Ok(if side[0] == nodes[0] { [*a, *b] } else { [*b, *a] }),
        _ => {
            let place = place(mesh.points[nodes[0]]);
            Err(Error::input(format!(
                "interface \"{}\" must have its body \"{}\" on one side and another surface on the other: its line at \
                 {place} has {inside} elements of the body and {} others beside it",
                seam.curve,
                seam.body,
                beside.len() - inside
            )))
        }
    }
}
