//! From what a mesh file says to the plane mesh of the model.

use super::degenerate::{Origin, sound};
use super::duplicates::Duplicates;
use super::groups::{Members, name_of, named_groups};
use super::mesh::{Cell, Mesh, Shape};
use super::msh::{self, Block, Msh, Node};
use super::sides::refuse_unlike_sides;
use crate::number::short_to;
use crate::{Error, Result};
use std::collections::HashMap;
use std::path::Path;

/// A mesh is plane if its z vary by less than this part of its extent in x and y.
const FLAT: f64 = 1e-6;

impl Mesh {
    /// Reads a mesh file; see [`msh::read`] and [`Mesh::from_msh`].
    pub fn read(path: &Path) -> Result<Mesh> {
        Mesh::from_msh(&msh::read(path)?, &msh::file_name(path))
    }

    /// The plane mesh in `msh`; `name` is the file's name for messages.
    ///
    /// Kept are all faces, and the lines and points that belong to a group; nodes of no kept cell are dropped. Every
    /// cell stands once, faces run anticlockwise. Groups without a name are called `physical_DIMENSION_TAG`.
    ///
    /// Errors: no faces, a shape the solver does not know, nodes that are missing or not in one plane z = constant,
    /// a cell without extent, two groups of one name and dimension, elements of first and second order side by side.
    pub fn from_msh(msh: &Msh, name: &str) -> Result<Mesh> {
        let kept: Vec<&Block> = msh.blocks.iter().filter(|b| is_kept(b)).collect();
        let shapes: Vec<Shape> = kept.iter().map(|b| shape_of(b, msh, name)).collect::<Result<_>>()?;
        if !shapes.iter().any(|s| s.dimension() == 2) {
            return Err(Error::input(format!("{name} is empty: it has no faces (triangles or quadrangles)")));
        }
        let index = TagIndex::new(&msh.nodes, name)?;
        let nodes: Vec<Vec<usize>> = kept.iter().map(|b| index.nodes_of(b, name)).collect::<Result<_>>()?;
        let used = used_nodes(&nodes, msh.nodes.len());
        check_plane(&msh.nodes, &used, name)?;

        let (mut mesh, new_index) = points_of(&msh.nodes, &used, name);
        let mut members = Members::new();
        let mut duplicates = Duplicates::new(mesh.points.len());
        let mut tags = Vec::new();
        for ((block, shape), old_nodes) in kept.iter().zip(shapes).zip(nodes) {
            let group = block.physicals.first().map(|p| name_of(shape.dimension(), p.abs(), &msh.names));
            let origin = |tag| Origin { tag, group: group.as_deref(), family: block.kind.family };
            for (nodes, &tag) in old_nodes.chunks_exact(shape.node_count()).zip(&block.element_tags) {
                let nodes = nodes.iter().map(|&old| new_index[old]).collect();
                let cell = sound(&mesh, Cell { shape, nodes }, origin(tag))?;
                let same = duplicates.find(&cell, &mesh.cells);
                tags.extend(same.is_none().then_some(tag));
                let id = same.unwrap_or_else(|| mesh.add(cell, &mut duplicates));
                for physical in &block.physicals {
                    members.entry((shape.dimension(), physical.abs())).or_default().push(id);
                }
            }
        }
        (mesh.groups, mesh.dropped) = named_groups(members, &msh.names, name)?;
        refuse_unlike_sides(&mesh, &tags)?;
        mesh.remarks.extend(msh.without_entities.then(|| without_entities(msh, name)));
        Ok(mesh)
    }

    /// Adds a cell, a clockwise face turned.
    fn add(&mut self, cell: Cell, duplicates: &mut Duplicates) -> usize {
        let clockwise = self.measure(&cell) < 0.0;
        self.turned += usize::from(clockwise);
        self.cells.push(if clockwise { turned(&cell) } else { cell });
        duplicates.add(&self.cells);
        self.cells.len() - 1
    }
}

fn without_entities(msh: &Msh, name: &str) -> String {
    format!(
        "{name} has no section $Entities, so nothing says which of its {} physical groups an element belongs to: save it \
         with gmsh, which writes that section",
        msh.names.len()
    )
}

/// Faces are the model; lines and points only say what their groups are.
fn is_kept(block: &Block) -> bool {
    block.kind.dimension == 2 || !block.physicals.is_empty()
}

fn shape_of(block: &Block, msh: &Msh, name: &str) -> Result<Shape> {
    let (kind, what) = (block.kind, format!("{}-node {} elements", block.kind.nodes, block.kind.family));
    let group = match block.physicals.first() {
        Some(tag) => format!(" in the physical group \"{}\"", name_of(kind.dimension, tag.abs(), &msh.names)),
        None => String::new(),
    };
    match kind.number {
        15 => Ok(Shape::Point),
        1 => Ok(Shape::Line2),
        8 => Ok(Shape::Line3),
        2 => Ok(Shape::Tri3),
        3 => Ok(Shape::Quad4),
        9 => Ok(Shape::Tri6),
        16 => Ok(Shape::Quad8),
        _ if kind.dimension == 3 => Err(Error::input(format!(
            "{name} has {what}{group}, but the model is plane: mesh with gmsh -2, without physical volumes"
        ))),
        _ => Err(Error::input(format!(
            "{name} has {what}{group}; triangles of 3 or 6 and quadrangles of 4 or 8 nodes can be used: \
             set Mesh.ElementOrder to 1 or 2 and Mesh.SecondOrderIncomplete = 1"
        ))),
    }
}

/// Node tag -> place in the file's list of nodes.
enum TagIndex {
    /// by tag; `usize::MAX` where there is none
    Dense(Vec<usize>),
    Sparse(HashMap<usize, usize>),
}

impl TagIndex {
    fn new(nodes: &[Node], name: &str) -> Result<TagIndex> {
        let largest = nodes.iter().map(|n| n.tag).max().unwrap_or(0);
        let mut index = match largest / 8 <= nodes.len() {
            true => TagIndex::Dense(vec![usize::MAX; largest + 1]),
            false => TagIndex::Sparse(HashMap::with_capacity(nodes.len())),
        };
        for (place, node) in nodes.iter().enumerate() {
            let before = match &mut index {
                TagIndex::Dense(places) => {
                    Some(std::mem::replace(&mut places[node.tag], place)).filter(|&p| p != usize::MAX)
                }
                TagIndex::Sparse(places) => places.insert(node.tag, place),
            };
            if before.is_some() {
                return Err(Error::input(format!("node {} stands twice in {name}; the file is corrupt", node.tag)));
            }
        }
        Ok(index)
    }

    fn place(&self, tag: usize) -> Option<usize> {
        match self {
            TagIndex::Dense(places) => places.get(tag).copied().filter(|&p| p != usize::MAX),
            TagIndex::Sparse(places) => places.get(&tag).copied(),
        }
    }

    fn nodes_of(&self, block: &Block, name: &str) -> Result<Vec<usize>> {
        let missing = |i: usize| {
            let (element, node) = (block.element_tags[i / block.kind.nodes], block.node_tags[i]);
            Error::input(format!(
                "element {element} of {name} uses node {node}, which is not among its nodes; the file is corrupt"
            ))
        };
        let places = block.node_tags.iter().enumerate().map(|(i, &tag)| self.place(tag).ok_or_else(|| missing(i)));
        places.collect()
    }
}

fn used_nodes(nodes: &[Vec<usize>], count: usize) -> Vec<bool> {
    let mut used = vec![false; count];
    nodes.iter().flatten().for_each(|&n| used[n] = true);
    used
}

/// A mesh without cells that has the used nodes, and the index of each of the file's nodes in it.
fn points_of(nodes: &[Node], used: &[bool], name: &str) -> (Mesh, Vec<usize>) {
    let mut mesh = Mesh { name: name.into(), ..Mesh::default() };
    let mut new_index = vec![usize::MAX; nodes.len()];
    for (old, node) in nodes.iter().enumerate().filter(|&(old, _)| used[old]) {
        new_index[old] = mesh.points.len();
        mesh.points.push([node.xyz[0], node.xyz[1]]);
        mesh.tags.push(node.tag);
    }
    (mesh, new_index)
}

fn check_plane(nodes: &[Node], used: &[bool], name: &str) -> Result<()> {
    let used = || nodes.iter().zip(used).filter(|&(_, &used)| used).map(|(node, _)| node);
    let extent = |i: usize| {
        let span = |(low, high): (f64, f64), node: &Node| (low.min(node.xyz[i]), high.max(node.xyz[i]));
        let (low, high) = used().fold((f64::INFINITY, f64::NEG_INFINITY), span);
        high - low
    };
    let tolerance = FLAT * extent(0).max(extent(1));
    let Some(first) = used().next() else {
        return Ok(());
    };
    match used().find(|n| (n.xyz[2] - first.xyz[2]).abs() > tolerance) {
        None => Ok(()),
        Some(node) => Err(Error::input(format!(
            "{name} is not plane: node {} lies at z = {}, node {} at z = {}; the model must lie in a plane z = constant",
            first.tag,
            short_to(12, first.xyz[2]),
            node.tag,
            short_to(12, node.xyz[2])
        ))),
    }
}

/// The face run through the other way round: the first corner stays, each mid-side node stays with its side.
fn turned(face: &Cell) -> Cell {
    let (corners, mids) = face.nodes.split_at(face.shape.corner_count());
    let nodes = corners[..1].iter().chain(corners[1..].iter().rev()).chain(mids.iter().rev());
    Cell { shape: face.shape, nodes: nodes.copied().collect() }
}
