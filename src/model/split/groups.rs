//! The groups of curves and points in the opened mesh.
//!
//! A line follows the face it borders. On an interface a group of curves or points `NAME` has two sides, which are groups
//! of their own: `NAME@body` and `NAME@ground`. `NAME` itself has the body's nodes there. Where interfaces meet, a point
//! `NAME` has a node for each surface: `NAME@SURFACE`.

use super::line::InterfaceLine;
use super::sectors::{Copies, node_of};
use crate::model::mesh::{BODY_SIDE, Cell, GROUND_SIDE, Group, Mesh, SIDE, Shape};
use crate::model::sides::{Edge, Sides, edge};
use std::collections::{BTreeSet, HashMap};

/// Moves the lines and points of `opened`, which are those of the closed `mesh`, to the nodes of the faces they belong
/// to, and adds the groups of the two sides.
pub(super) fn follow(mesh: &Mesh, opened: &mut Mesh, lines: &[InterfaceLine], faces_at: &Sides, copies: &Copies) {
    let places = Places::new(mesh, lines);
    let on_side = |cell: &Cell, face: usize| Cell {
        shape: cell.shape,
        nodes: cell.nodes.iter().map(|&node| node_of(copies, face, node)).collect(),
    };
    // of each cell on an interface, the cell on the ground's side
    let mut of_ground: HashMap<usize, usize> = HashMap::new();
    for (number, cell) in mesh.cells.iter().enumerate() {
        match places.faces(cell) {
            Some([body, ground]) => {
                opened.cells[number] = on_side(cell, body);
                of_ground.insert(number, opened.cells.len());
                opened.cells.push(on_side(cell, ground));
            }
            None if cell.shape.dimension() == 1 => {
                let beside = faces_at.get(&edge(&cell.nodes)).and_then(|faces| faces.first());
                opened.cells[number] = beside.map_or(cell.clone(), |&(face, _)| on_side(cell, face));
            }
            None => {}
        }
    }
    for group in mesh.groups.iter().filter(|g| g.cells.iter().any(|cell| of_ground.contains_key(cell))) {
        let mut ground: Vec<usize> = group.cells.iter().filter_map(|cell| of_ground.get(cell).copied()).collect();
        ground.sort_unstable();
        let body = group.cells.iter().copied().filter(|cell| of_ground.contains_key(cell)).collect();
        for (side, cells) in [(BODY_SIDE, body), (GROUND_SIDE, ground)] {
            opened.groups.push(Group { name: format!("{}{side}", group.name), dimension: group.dimension, cells });
        }
    }
    let copied: BTreeSet<usize> = copies.keys().map(|&(_, node)| node).collect();
    for point in mesh.groups.iter().filter(|g| g.dimension == 0) {
        let node = |cell: usize| mesh.cells[cell].nodes[0];
        if let [cell] = point.cells[..]
            && copied.contains(&node(cell))
        {
            add_nodes_of_surfaces(mesh, opened, &point.name, node(cell), copies);
        }
    }
}

/// Where more than two nodes lie at the place of a point, a group for each surface that has one of them. A surface that is
/// called as a side comes before it: which interface's side is meant is not clear there.
fn add_nodes_of_surfaces(mesh: &Mesh, opened: &mut Mesh, point: &str, node: usize, copies: &Copies) {
    let faces: Vec<usize> = (0..mesh.cells.len())
        .filter(|&cell| mesh.cells[cell].shape.dimension() == 2 && mesh.cells[cell].nodes.contains(&node))
        .collect();
    let nodes_of =
        |faces: &[usize]| -> BTreeSet<usize> { faces.iter().map(|&face| node_of(copies, face, node)).collect() };
    if nodes_of(&faces).len() < 3 {
        return;
    }
    for surface in mesh.groups.iter().filter(|g| g.dimension == 2) {
        let own: Vec<usize> = faces.iter().copied().filter(|face| surface.cells.binary_search(face).is_ok()).collect();
        let nodes = nodes_of(&own);
        if let (Some(&own), 1) = (nodes.first(), nodes.len()) {
            let cells = vec![opened.cells.len()];
            opened.cells.push(Cell { shape: Shape::Point, nodes: vec![own] });
            let name = format!("{point}{SIDE}{}", surface.name);
            opened.groups.retain(|group| group.dimension > 0 || group.name != name);
            opened.groups.push(Group { name, dimension: 0, cells });
        }
    }
}

/// What lies on an interface.
struct Places {
    /// the faces on the body's and on the ground's side of each line
    of_lines: HashMap<Edge, [usize; 2]>,
    /// those of the first line at each node
    of_nodes: HashMap<usize, [usize; 2]>,
}

impl Places {
    fn new(mesh: &Mesh, lines: &[InterfaceLine]) -> Places {
        let mut places = Places { of_lines: HashMap::new(), of_nodes: HashMap::new() };
        for line in lines {
            let (nodes, faces) = (&mesh.cells[line.cell].nodes, [line.body_cell, line.ground_cell]);
            places.of_lines.insert(edge(nodes), faces);
            nodes.iter().for_each(|&node| _ = places.of_nodes.entry(node).or_insert(faces));
        }
        places
    }

    /// The faces on the body's and on the ground's side of a line or point; none if it lies on no interface.
    fn faces(&self, cell: &Cell) -> Option<[usize; 2]> {
        match cell.shape.dimension() {
            0 => self.of_nodes.get(&cell.nodes[0]).copied(),
            1 => self.of_lines.get(&edge(&cell.nodes)).copied(),
            _ => None,
        }
    }
}
