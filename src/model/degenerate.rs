//! Elements of a mesh file that have no extent, or corners that are one: refused with what they are and where.

use super::mesh::{Cell, Mesh};
use crate::number::short;
use crate::{Error, Result};

/// A face is degenerate if its area is below this part of its longest side or diagonal squared.
const NO_AREA: f64 = 1e-12;
/// Two nodes of an element are in one place if they are closer than this part of its size.
const ONE_PLACE: f64 = 1e-9;

/// What a sentence says of an element of the file.
#[derive(Clone, Copy)]
pub(super) struct Origin<'a> {
    /// its number in the file
    pub tag: usize,
    /// of its group, if it has one
    pub group: Option<&'a str>,
    /// of the file's elements of that type, as `quadrangle`
    pub family: &'a str,
}

/// The cell, if its nodes are different, in different places, and it has a length or an area.
pub(super) fn sound(mesh: &Mesh, cell: Cell, origin: Origin) -> Result<Cell> {
    let at = |n: usize| mesh.points[n];
    let distance = |a: usize, b: usize| (at(a)[0] - at(b)[0]).powi(2) + (at(a)[1] - at(b)[1]).powi(2);
    let nodes = &cell.nodes;
    if let Some(&node) = nodes.iter().enumerate().find(|&(i, n)| nodes[..i].contains(n)).map(|(_, n)| n) {
        return Err(repeated(mesh, &cell, node, origin));
    }
    let reach = cell.corners().iter().map(|&n| distance(nodes[0], n)).fold(0., f64::max);
    let pairs = (0..nodes.len()).flat_map(|i| (0..i).map(move |j| [nodes[j], nodes[i]]));
    if let Some([a, b]) = pairs.into_iter().find(|&[a, b]| distance(a, b) <= ONE_PLACE * ONE_PLACE * reach) {
        return Err(coincident(mesh, &cell, [a, b], origin));
    }
    let least = if cell.shape.dimension() == 2 { NO_AREA * reach } else { 0. };
    match mesh.measure(&cell).abs() > least {
        true => Ok(cell),
        false => Err(flat(mesh, &cell, origin)),
    }
}

fn repeated(mesh: &Mesh, cell: &Cell, node: usize, origin: Origin) -> Error {
    let twice = format!("node {} twice", mesh.tags[node]);
    match cell.corners().iter().filter(|&&n| n == node).count() {
        2 if cell.corners().len() == 4 => {
            let remedy = "a quadrangle with a repeated corner is a triangle: write it as one";
            refusal(mesh, cell, origin, &twice, remedy)
        }
        _ => {
            let remedy = format!("it has {twice}: the file is corrupt, make the mesh again");
            refusal(mesh, cell, origin, no_extent(cell), &remedy)
        }
    }
}

fn coincident(mesh: &Mesh, cell: &Cell, [a, b]: [usize; 2], origin: Origin) -> Error {
    let [x, y] = mesh.points[b].map(short);
    let one_place = format!("its nodes {} and {} in one place, ({x}, {y})", mesh.tags[a], mesh.tags[b]);
    match cell.corners().len() {
        4 => {
            let remedy = "merge the two (Coherence Mesh in Gmsh) and make a triangle of it";
            refusal(mesh, cell, origin, &one_place, remedy)
        }
        _ => {
            let remedy =
                format!("it has {one_place}: merge the two (Coherence Mesh in Gmsh) and mesh that place again");
            refusal(mesh, cell, origin, no_extent(cell), &remedy)
        }
    }
}

fn flat(mesh: &Mesh, cell: &Cell, origin: Origin) -> Error {
    refusal(mesh, cell, origin, no_extent(cell), "its corners are on one line: mesh that place again")
}

fn no_extent(cell: &Cell) -> &'static str {
    ["no place", "no length", "no area"][cell.shape.dimension()]
}

/// What the element has that it must not have, its corners, what it is, what to do.
fn refusal(mesh: &Mesh, cell: &Cell, Origin { tag, group, family }: Origin, has: &str, remedy: &str) -> Error {
    let of = group.map_or(String::new(), |name| format!(" of \"{name}\""));
    let corners = corners(mesh, cell);
    Error::input(format!("element {tag} of {} has {has}; {corners}; it is a {family}{of}; {remedy}", mesh.name))
}

fn corners(mesh: &Mesh, cell: &Cell) -> String {
    let place = |&n: &usize| {
        let [x, y] = mesh.points[n].map(short);
        format!("({x}, {y})")
    };
    let places: Vec<String> = cell.corners().iter().map(place).collect();
    format!("its corners are {}", places.join(", "))
}
