//! The lines of the interfaces, each with the faces on its two sides.

use super::Seam;
use crate::model::mesh::Mesh;
use crate::model::sides::{Edge, Sides, edge};
use crate::number::place;
use crate::{Error, Result};
use std::collections::{BTreeMap, BTreeSet, HashMap};

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
        let turned = turned(mesh, &curve.cells);
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
            let [body_cell, ground_cell] =
                two_sides(mesh, seam, &Line { cell, is_turned: turned[&cell] }, &faces, faces_at)?;
            lines.push(InterfaceLine { seam: number, cell, ground_cell, body_cell });
        }
    }
    Ok(lines)
}

/// A line of a curve.
struct Line {
    cell: usize,
    /// whether it runs against the first line of its chain
    is_turned: bool,
}

/// Whether each line of a curve runs against the first one of its chain, in which every line begins where the one before
/// ends. A chain ends where more than two lines of the curve meet.
fn turned(mesh: &Mesh, lines: &[usize]) -> BTreeMap<usize, bool> {
    let ends = |line: usize| [mesh.cells[line].nodes[0], mesh.cells[line].nodes[1]];
    let mut lines_at: HashMap<usize, Vec<usize>> = HashMap::new();
    lines.iter().for_each(|&line| ends(line).into_iter().for_each(|end| lines_at.entry(end).or_default().push(line)));
    let mut turned = BTreeMap::new();
    for &first in lines {
        if turned.contains_key(&first) {
            continue;
        }
        turned.insert(first, false);
        let mut reached = vec![first];
        while let Some(line) = reached.pop() {
            for node in ends(line) {
                let [a, b] = lines_at[&node][..] else { continue };
                let next = if a == line { b } else { a };
                if !turned.contains_key(&next) {
                    let both_begin_or_end = (ends(line)[0] == node) == (ends(next)[0] == node);
                    turned.insert(next, turned[&line] != both_begin_or_end);
                    reached.push(next);
                }
            }
        }
    }
    turned
}

/// The faces on the body's side and on the ground's. A crack inside its body has the body's side on the left of the
/// first line as it is drawn.
fn two_sides(mesh: &Mesh, seam: &Seam, line: &Line, body: &BTreeSet<usize>, faces_at: &Sides) -> Result<[usize; 2]> {
    let nodes = &mesh.cells[line.cell].nodes;
    let beside = faces_at.get(&edge(nodes)).map_or(&[][..], Vec::as_slice);
    let inside = beside.iter().filter(|(face, _)| body.contains(face)).count();
    match beside {
        [(a, _), (b, _)] if inside == 1 => Ok(if body.contains(a) { [*a, *b] } else { [*b, *a] }),
        // faces run anticlockwise: the one on the left runs along the line
        [(a, side), (b, _)] if inside == 2 => {
            Ok(if (side[0] == nodes[0]) != line.is_turned { [*a, *b] } else { [*b, *a] })
        }
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
