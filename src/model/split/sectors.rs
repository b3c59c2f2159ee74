//! The faces round a node of an interface, in sectors that no interface line separates.
//!
//! A node inside one interface has two sectors, a T-junction three, a crossing four; where an interface ends inside the
//! solid one sector runs all round the node. Every sector but one gets a copy of the node.

use super::line::InterfaceLine;
use crate::model::mesh::Mesh;
use crate::model::sides::{Edge, edge};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// (face, node of the closed mesh) -> the copy that the face has instead.
pub(super) type Copies = BTreeMap<(usize, usize), usize>;

/// What a face has at a node of the closed mesh: a copy, or the node itself.
pub(super) fn node_of(copies: &Copies, face: usize, node: usize) -> usize {
    *copies.get(&(face, node)).unwrap_or(&node)
}

/// What meets at a node of an interface.
struct Round {
    node: usize,
    /// each face with its sides that end or have their middle at the node
    faces: Vec<(usize, Vec<Edge>)>,
    /// those of them that are their body's side of an interface line at the node
    of_bodies: BTreeSet<usize>,
}

/// Gives every sector round the nodes of the interface `lines` a node of its own in `mesh`, which is closed before.
///
/// The node itself stays with a sector of no body, if there is one. Faces that meet in a node only, with no side in
/// common, are not separated: their first sectors keep the node together.
pub(super) fn copy_nodes(mesh: &mut Mesh, lines: &[InterfaceLine]) -> Copies {
    let interface: HashSet<Edge> = lines.iter().map(|line| edge(&mesh.cells[line.cell].nodes)).collect();
    let mut copies = Copies::new();
    for Round { node, faces, of_bodies } in rounds(mesh, lines) {
        for fan in fans(&faces, |_| true) {
            let mut sectors = fans(&fan, |side| !interface.contains(side));
            let is_body = |sector: &[(usize, Vec<Edge>)]| sector.iter().any(|(face, _)| of_bodies.contains(face));
            let kept = sectors.iter().position(|sector| !is_body(sector)).unwrap_or(0);
            sectors.remove(kept);
            for sector in sectors {
                let copy = mesh.points.len();
                mesh.points.push(mesh.points[node]);
                mesh.tags.push(mesh.tags[node]);
                copies.extend(sector.iter().map(|&(face, _)| ((face, node), copy)));
            }
        }
    }
    for (&(face, node), &copy) in &copies {
        mesh.cells[face].nodes.iter_mut().filter(|n| **n == node).for_each(|n| *n = copy);
    }
    copies
}

/// The nodes of the lines, in the order in which the lines have them first.
fn rounds(mesh: &Mesh, lines: &[InterfaceLine]) -> Vec<Round> {
    let mut rounds: Vec<Round> = Vec::new();
    let mut place: HashMap<usize, usize> = HashMap::new();
    for line in lines {
        for &node in &mesh.cells[line.cell].nodes {
            let place = *place.entry(node).or_insert_with(|| {
                rounds.push(Round { node, faces: vec![], of_bodies: BTreeSet::new() });
                rounds.len() - 1
            });
            rounds[place].of_bodies.insert(line.body_cell);
        }
    }
    for (cell, face) in mesh.cells.iter().enumerate().filter(|(_, c)| c.shape.dimension() == 2) {
        for (local, node) in face.nodes.iter().enumerate() {
            if let Some(&place) = place.get(node) {
                let sides = face.shape.sides().into_iter().filter(|side| side.contains(&local));
                let sides = sides.map(|side| edge(&[face.nodes[side[0]], face.nodes[side[1]]]));
                rounds[place].faces.push((cell, sides.collect()));
            }
        }
    }
    rounds
}

/// The faces in groups that hang together over sides that `joins`.
fn fans(faces: &[(usize, Vec<Edge>)], joins: impl Fn(&Edge) -> bool) -> Vec<Vec<(usize, Vec<Edge>)>> {
    let mut left = faces.to_vec();
    let mut fans = Vec::new();
    while let Some(first) = left.pop() {
        let mut fan = vec![first];
        let mut grown = 0;
        while grown < fan.len() {
            let sides = fan[grown].1.clone();
            let (touching, apart) =
                left.into_iter().partition(|(_, other)| other.iter().any(|side| joins(side) && sides.contains(side)));
            left = apart;
            fan.extend::<Vec<_>>(touching);
            grown += 1;
        }
        fans.push(fan);
    }
    fans.reverse();
    fans
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::mesh::{Cell, Shape};

    /// Squares of side 1, `across` in a row; cell k is square k, lines follow.
    fn squares(across: usize, rows: usize, lines: &[[usize; 2]]) -> Mesh {
        let node = |i: usize, j: usize| j * (across + 1) + i;
        let quads = (0..across * rows).map(|k| (k % across, k / across)).map(|(i, j)| Cell {
            shape: Shape::Quad4,
            nodes: vec![node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)],
        });
        let lines = lines.iter().map(|line| Cell { shape: Shape::Line2, nodes: line.to_vec() });
        let count = (across + 1) * (rows + 1);
        let points = (0..count).map(|n| [(n % (across + 1)) as f64, (n / (across + 1)) as f64]).collect();
        Mesh { points, tags: (1..=count).collect(), cells: quads.chain(lines).collect(), ..Mesh::default() }
    }

    /// How many nodes there are at each place after opening the lines, whose body is the cell given with each.
    fn copies_at(mesh: &Mesh, cuts: &[(usize, usize)]) -> BTreeMap<[i64; 2], usize> {
        let mut mesh = mesh.clone();
        let line =
            |&(cell, body_cell): &(usize, usize)| InterfaceLine { seam: 0, cell, body_cell, ground_cell: body_cell };
        copy_nodes(&mut mesh, &cuts.iter().map(line).collect::<Vec<_>>());
        let mut at = BTreeMap::new();
        mesh.points.iter().for_each(|p| *at.entry(p.map(|x| x as i64)).or_default() += 1);
        at
    }

    /// Nodes of the 2 x 2 squares: 0 1 2 below, 3 4 5, 6 7 8 above; squares 0 1 below, 2 3 above.
    #[test]
    fn a_crossing_has_four_nodes_a_t_junction_three_and_a_tip_one() {
        let mesh = squares(2, 2, &[[3, 4], [4, 5], [1, 4], [4, 7]]);
        let [left, right, below, above] = [(4, 2), (5, 3), (6, 0), (7, 2)];
        assert_eq!(copies_at(&mesh, &[left, right, below, above])[&[1, 1]], 4);
        assert_eq!(copies_at(&mesh, &[left, right, below])[&[1, 1]], 3);
        assert_eq!(copies_at(&mesh, &[left, right])[&[1, 1]], 2);
        let tip = copies_at(&mesh, &[left]);
        assert_eq!((tip[&[1, 1]], tip[&[0, 1]]), (1, 2));
    }

    /// Square 0 touches the two triangles of square 3 in node 4 alone; the line between these opens there.
    #[test]
    fn a_node_keeps_what_touches_in_it_alone_together() {
        let mut mesh = squares(2, 2, &[[4, 8]]);
        let triangle = |nodes: [usize; 3]| Cell { shape: Shape::Tri3, nodes: nodes.to_vec() };
        mesh.cells.splice(1..4, [triangle([4, 5, 8]), triangle([4, 8, 7])]);
        let at = copies_at(&mesh, &[(3, 1)]);
        assert_eq!((at[&[1, 1]], at[&[2, 2]]), (2, 2));
    }
}
