//! Opens the interfaces: where a body meets the ground along a named curve, the body's elements get copies of the
//! nodes.
//!
//! The ground keeps its nodes. Both node rows of each joint are known exactly, mid-side nodes too, and each joint knows
//! its own two elements, since a pipe may cross a layer boundary.

use super::mesh::{Group, Mesh, Shape};
use super::sides::{Edge, Sides, edge, solid_sides};
use crate::number::place;
use crate::{Error, Result};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

/// An interface to open: the group of its curve and the group of faces that is pulled off the ground.
#[derive(Debug, Clone, PartialEq)]
pub struct Seam {
    pub curve: String,
    pub body: String,
}

/// Two nodes at one place; jump = u(ground) - u(body).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Pair {
    pub ground: usize,
    pub body: usize,
}

/// A joint element: one line of an interface curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// which seam it belongs to
    pub seam: usize,
    pub shape: Shape,
    /// indices of pairs in the line's node order, running anticlockwise round the body
    pub pairs: Vec<usize>,
    /// the face it leans on, on either side
    pub ground_cell: usize,
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
/// Errors name the group and the coordinates: a curve that is not the border between its body and something else, or
/// one that ends while body and ground go on touching.
pub fn open(mesh: &Mesh, seams: &[Seam]) -> Result<Opened> {
    let faces_at = solid_sides(mesh);
    let bodies = seams
        .iter()
        .map(|seam| Ok(group_of(mesh, seam, &seam.body, 2)?.cells.iter().copied().collect()))
        .collect::<Result<Vec<BTreeSet<usize>>>>()?;
    let lines = border_lines(mesh, seams, &bodies, &faces_at)?;
    refuse_loose_ends(mesh, seams, &bodies, &lines, &faces_at)?;

    let mut opened = mesh.clone();
    let copies = copy_nodes(&mut opened, seams, &bodies, &lines);
    move_lines_and_points(mesh, &mut opened, &faces_at, &copies);
    let (pairs, joints) = joints(mesh, &lines, &faces_at, &copies);
    let sides = solid_sides(&opened).into();
    Ok(Opened { mesh: opened.into(), pairs: pairs.into(), joints: joints.into(), sides })
}

fn group_of<'a>(mesh: &'a Mesh, seam: &Seam, name: &str, dimension: usize) -> Result<&'a Group> {
    let role = if dimension == 2 { format!("interface \"{}\": its body", seam.curve) } else { "interface".into() };
    mesh.group_of(name, dimension, &role)
}

/// A line of a seam with the faces on its two sides.
struct BorderLine {
    seam: usize,
    cell: usize,
    ground_cell: usize,
    body_cell: usize,
}

fn border_lines(mesh: &Mesh, seams: &[Seam], bodies: &[BTreeSet<usize>], faces_at: &Sides) -> Result<Vec<BorderLine>> {
    let mut lines = Vec::new();
    for (seam, (Seam { curve, body }, faces)) in seams.iter().zip(bodies).enumerate() {
        let group = group_of(mesh, &seams[seam], curve, 1)?;
        for &cell in &group.cells {
            let nodes = &mesh.cells[cell].nodes;
            let sides = faces_at.get(&edge(nodes)).into_iter().flatten().map(|&(face, _)| face);
            let (inside, outside): (Vec<usize>, Vec<usize>) = sides.partition(|f| faces.contains(f));
            let (&[body_cell], &[ground_cell]) = (&inside[..], &outside[..]) else {
                let place = place(mesh.points[nodes[0]]);
                return Err(Error::input(format!(
                    "interface \"{curve}\" must be a border of its body \"{body}\": its line at {place} has {} \
                     elements of the body and {} others beside it, not one of each",
                    inside.len(),
                    outside.len()
                )));
            };
            lines.push(BorderLine { seam, cell, ground_cell, body_cell });
        }
    }
    Ok(lines)
}

/// A seam may close on itself or run out of the mesh, but not stop where body and ground still share an edge.
fn refuse_loose_ends(
    mesh: &Mesh,
    seams: &[Seam],
    bodies: &[BTreeSet<usize>],
    lines: &[BorderLine],
    faces_at: &Sides,
) -> Result<()> {
    let opened: HashMap<Edge, &str> =
        lines.iter().map(|l| (corner_edge(mesh, l.cell), seams[l.seam].body.as_str())).collect();
    let mut touched: HashMap<&str, BTreeSet<usize>> = HashMap::new();
    for (edge, body) in &opened {
        touched.entry(body).or_default().extend([edge.0, edge.1]);
    }
    for (seam, faces) in seams.iter().zip(bodies) {
        let ends = touched.entry(&seam.body).or_default();
        let still_joined = faces_at.iter().find(|(edge, sides)| {
            let split = sides.iter().filter(|(f, _)| faces.contains(f)).count();
            split == 1
                && sides.len() == 2
                && opened.get(edge) != Some(&seam.body.as_str())
                && (ends.contains(&edge.0) || ends.contains(&edge.1))
        });
        if let Some((&(a, b), _)) = still_joined {
            let place = place(mesh.points[if ends.contains(&a) { a } else { b }]);
            return Err(Error::input(format!(
                "interface \"{}\" ends at {place} although \"{}\" goes on touching the ground there: let the curve \
                 close, or run to the border of the mesh",
                seam.curve, seam.body
            )));
        }
    }
    Ok(())
}

fn corner_edge(mesh: &Mesh, line: usize) -> Edge {
    edge(&mesh.cells[line].nodes)
}

/// For each face, what its nodes became.
type Copies = BTreeMap<(usize, usize), usize>;

/// Gives each body's faces their own copy of the body's seam nodes; (face, node) -> copy.
fn copy_nodes(opened: &mut Mesh, seams: &[Seam], bodies: &[BTreeSet<usize>], lines: &[BorderLine]) -> Copies {
    let mut copies = Copies::new();
    let mut copy_of: BTreeMap<(&str, usize), usize> = BTreeMap::new();
    for line in lines {
        for node in opened.cells[line.cell].nodes.clone() {
            copy_of.entry((&seams[line.seam].body, node)).or_insert_with(|| {
                opened.points.push(opened.points[node]);
                opened.tags.push(opened.tags[node]);
                opened.points.len() - 1
            });
        }
    }
    for (seam, faces) in seams.iter().zip(bodies) {
        for &face in faces {
            for node in &mut opened.cells[face].nodes {
                if let Some(&copy) = copy_of.get(&(seam.body.as_str(), *node)) {
                    copies.insert((face, *node), copy);
                    *node = copy;
                }
            }
        }
    }
    copies
}

/// Lines of other groups follow the face they border; named points on a seam belong to the body.
fn move_lines_and_points(mesh: &Mesh, opened: &mut Mesh, faces_at: &Sides, copies: &Copies) {
    let body_node: HashMap<usize, usize> = copies.iter().map(|(&(_, node), &copy)| (node, copy)).collect();
    for (c, cell) in mesh.cells.iter().enumerate() {
        let follows = match cell.shape.dimension() {
            0 => {
                opened.cells[c].nodes = cell.nodes.iter().map(|n| *body_node.get(n).unwrap_or(n)).collect();
                continue;
            }
            // The body's side where there are two, as for points.
            1 => faces_at.get(&edge(&cell.nodes)).and_then(|faces| {
                faces.iter().find(|(f, _)| copies.contains_key(&(*f, cell.nodes[0]))).or(faces.first())
            }),
            _ => None,
        };
        if let Some(&(face, _)) = follows {
            opened.cells[c].nodes = cell.nodes.iter().map(|&n| *copies.get(&(face, n)).unwrap_or(&n)).collect();
        }
    }
}

/// A joint for each line, between what its nodes became on the body's side and on the ground's.
fn joints(mesh: &Mesh, lines: &[BorderLine], sides: &Sides, copies: &Copies) -> (Vec<Pair>, Vec<Joint>) {
    let mut index: HashMap<Pair, usize> = HashMap::new();
    let mut pairs = Vec::new();
    let mut joints = Vec::new();
    let became = |face: usize, node: usize| *copies.get(&(face, node)).unwrap_or(&node);
    for &BorderLine { seam, cell, ground_cell, body_cell } in lines {
        let of_body = sides[&corner_edge(mesh, cell)].iter().find(|(face, _)| *face == body_cell);
        let (_, nodes) = of_body.expect("the body's face was found by this edge");
        let numbers = nodes
            .iter()
            .map(|&node| {
                let pair = Pair { ground: became(ground_cell, node), body: became(body_cell, node) };
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
