//! Opens the interfaces: where a body meets the ground along a named curve, the elements on the two sides get nodes of
//! their own.
//!
//! Interfaces may close, run out of the mesh, end inside the solid, meet and cross. Round each node of an interface the
//! faces fall into sectors that no interface separates ([`sectors`]); each sector gets a node of its own. The two
//! sides of an interface line then give the node pairs, mid-side nodes included, and each joint knows its own two
//! elements, since a pipe may cross a layer boundary. Where an interface ends, the node stays single.

mod groups;
mod line;
mod sectors;

use super::mesh::{Mesh, Shape};
use super::sides::{Sides, edge, solid_sides};
use crate::number::place;
use crate::{Error, Result};
use line::{InterfaceLine, interface_lines};
use sectors::{Copies, copy_nodes};
use std::collections::HashMap;
use std::sync::Arc;

/// An interface to open: the group of its curve, and the group of faces on the side that its normal leaves.
#[derive(Debug, Clone, PartialEq)]
pub struct Seam {
    pub curve: String,
    pub body: String,
}

/// Two nodes at one place; jump = u(ground) - u(body). Where an interface ends inside the solid both are one node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Pair {
    pub ground: usize,
    pub body: usize,
}

impl Pair {
    /// Whether the two sides can move apart here.
    pub fn is_open(&self) -> bool {
        self.ground != self.body
    }
}

/// A joint element: one line of an interface curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// which seam it belongs to
    pub seam: usize,
    pub shape: Shape,
    /// indices of pairs in the line's node order, with the body on the left
    pub pairs: Vec<usize>,
    /// the face on the ground's side
    pub ground_cell: usize,
    /// the face on the body's side
    pub body_cell: usize,
}

/// The mesh with its interfaces open; clones share it.
#[derive(Debug, Clone, PartialEq)]
pub struct Opened {
    pub mesh: Arc<Mesh>,
    pub pairs: Arc<[Pair]>,
    pub joints: Arc<[Joint]>,
    /// of its faces
    pub sides: Arc<Sides>,
}

/// Opens every seam of a conforming mesh.
///
/// Errors name the group and the coordinates: a curve that has not its body on one side and something else on the
/// other, a line that belongs to two interfaces, an interface that separates nothing.
pub fn open(mesh: &Mesh, seams: &[Seam]) -> Result<Opened> {
    let faces_at = solid_sides(mesh);
    let lines = interface_lines(mesh, seams, &faces_at)?;
    let mut opened = mesh.clone();
    let copies = copy_nodes(&mut opened, &lines);
    groups::follow(mesh, &mut opened, &lines, &faces_at, &copies);
    let (pairs, joints) = joints(mesh, &lines, &faces_at, &copies);
    refuse_closed(mesh, seams, &pairs, &joints)?;
    let sides = solid_sides(&opened).into();
    Ok(Opened { mesh: opened.into(), pairs: pairs.into(), joints: joints.into(), sides })
}

/// A curve of a single line inside the solid has both its nodes at its ends, and separates nothing.
fn refuse_closed(mesh: &Mesh, seams: &[Seam], pairs: &[Pair], joints: &[Joint]) -> Result<()> {
    let separates = |joint: &Joint| joint.pairs.iter().any(|&p| pairs[p].is_open());
    match joints.iter().find(|joint| !separates(joint)) {
        None => Ok(()),
        Some(joint) => {
            let place = place(mesh.points[pairs[joint.pairs[0]].ground]);
            Err(Error::input(format!(
                "interface \"{}\" opens nothing at {place}: both ends of its line lie inside the solid; mesh it with \
                 two elements or more",
                seams[joint.seam].curve
            )))
        }
    }
}

/// A joint for each line, between what its nodes became on the body's side and on the ground's.
fn joints(mesh: &Mesh, lines: &[InterfaceLine], sides: &Sides, copies: &Copies) -> (Vec<Pair>, Vec<Joint>) {
    let mut index: HashMap<Pair, usize> = HashMap::new();
    let mut pairs = Vec::new();
    let mut joints = Vec::new();
    for &InterfaceLine { seam, cell, ground_cell, body_cell } in lines {
        let of_body = sides[&edge(&mesh.cells[cell].nodes)].iter().find(|(face, _)| *face == body_cell);
        let (_, nodes) = of_body.expect("the body's face was found by this edge");
        let numbers = nodes
            .iter()
            .map(|&node| {
                let pair = Pair {
                    ground: sectors::node_of(copies, ground_cell, node),
                    body: sectors::node_of(copies, body_cell, node),
                };
                *index.entry(pair).or_insert_with(|| {
                    pairs.push(pair);
                    pairs.len() - 1
                })
            })
            .collect();
        joints.push(Joint { seam, shape: mesh.cells[cell].shape, pairs: numbers, ground_cell, body_cell });
    }
    (pairs, joints)
}
