//! The unknowns of the equations: what is left of the nodal displacements when supports are gone and each interface
//! pair is described by its jump, numbered in elimination order with the jumps last.
//!
//! u = T q, with u(body) = u(ground) - jump; where a support holds one of the two, the other is counted from it.

use crate::model::mesh::Mesh;
use crate::model::split::Pair;
use crate::sparse::{Graph, Orders};
use crate::{Error, Result};
use std::collections::BTreeSet;

#[derive(Debug, Clone, PartialEq)]
pub struct Unknowns {
    pub count: usize,
    /// the jumps are the unknowns from here on
    pub first_jump: usize,
    /// row of T for dof(node n, axis i) = 2n + i: (unknown, +1 or -1)
    rows: Rows,
    /// for each pair and axis its jump; none where supports hold both nodes
    pub jumps: Vec<[Option<usize>; 2]>,
    /// (ground, body) of each pair
    pairs: Vec<[usize; 2]>,
    /// the node whose motion, or whose pair's jump, an unknown is: for messages
    nodes: Vec<usize>,
}

/// Lists of (unknown, sign), one after the other.
#[derive(Debug, Clone, PartialEq)]
struct Rows {
    entries: Vec<(usize, f64)>,
    /// where each list ends
    ends: Vec<usize>,
}

impl Rows {
    fn of(lists: impl Iterator<Item = Vec<(usize, f64)>>) -> Rows {
        let mut rows = Rows { entries: vec![], ends: vec![] };
        for list in lists {
            rows.entries.extend(list);
            rows.ends.push(rows.entries.len());
        }
        rows
    }

    fn at(&self, row: usize) -> &[(usize, f64)] {
        let start = if row == 0 { 0 } else { self.ends[row - 1] };
        &self.entries[start..self.ends[row]]
    }

    fn iter(&self) -> impl Iterator<Item = &[(usize, f64)]> {
        (0..self.ends.len()).map(|row| self.at(row))
    }
}

/// A displacement before numbering: sum of signed blocks, a block being a node or, after all nodes, a pair.
type Expression = Vec<(usize, f64)>;

impl Unknowns {
    /// `fixed` per node and axis; `orders`: those that are known.
    ///
    /// Errors: pairs that form a ring (three bodies with three interfaces in one point), which jumps cannot describe.
    pub fn new(mesh: &Mesh, fixed: &[[bool; 2]], pairs: &[Pair], orders: &Orders) -> Result<Unknowns> {
        let nodes = mesh.points.len();
        let expressions = [express(mesh, fixed, pairs, 0)?, express(mesh, fixed, pairs, 1)?];
        let mut free = vec![[false; 2]; nodes + pairs.len()];
        for (axis, rows) in expressions.iter().enumerate() {
            for &(block, _) in rows.iter().flatten() {
                free[block][axis] = true;
            }
        }
        let order = order_blocks(mesh, &expressions, &free, orders)?;
        let mut number = vec![[None; 2]; free.len()];
        let mut owners = Vec::new();
        for &block in &order {
            for axis in (0..2).filter(|&axis| free[block][axis]) {
                number[block][axis] = Some(owners.len());
                owners.push(if block < nodes { block } else { pairs[block - nodes].ground });
            }
        }
        let row = |node: usize, axis: usize| -> Vec<(usize, f64)> {
            let numbered = |&(block, sign): &(usize, f64)| number[block][axis].map(|q| (q, sign));
            expressions[axis][node].iter().filter_map(numbered).collect()
        };
        let rows = Rows::of((0..nodes).flat_map(|n| [row(n, 0), row(n, 1)]));
        let jumps = number.split_off(nodes);
        Ok(Unknowns {
            count: owners.len(),
            first_jump: owners.len() - jumps.iter().flatten().flatten().count(),
            rows,
            jumps,
            pairs: pairs.iter().map(|p| [p.ground, p.body]).collect(),
            nodes: owners,
        })
    }

    /// Row of T: which unknowns move this node along this axis, and with which sign.
    pub fn row(&self, node: usize, axis: usize) -> &[(usize, f64)] {
        self.rows.at(2 * node + axis)
    }

    /// u = T q at one node [as q].
    pub fn at_node(&self, q: &[f64], node: usize) -> [f64; 2] {
        [0, 1].map(|axis| self.row(node, axis).iter().map(|&(i, sign)| sign * q[i]).sum())
    }

    /// u = T q at all nodes.
    pub fn at_nodes(&self, q: &[f64]) -> Vec<[f64; 2]> {
        (0..self.rows.ends.len() / 2).map(|node| self.at_node(q, node)).collect()
    }

    /// q of nodal displacements (or velocities); those of supported nodes do not count.
    pub fn from_nodes(&self, u: &[[f64; 2]]) -> Vec<f64> {
        let mut q = vec![0.; self.count];
        for (row, value) in self.rows.iter().zip(u.as_flattened()) {
            if let [(unknown, sign)] = row[..] {
                q[unknown] = sign * value;
            }
        }
        for (place, &[ground, body]) in self.jumps.iter().zip(&self.pairs) {
            for axis in 0..2 {
                if let Some(unknown) = place[axis] {
                    q[unknown] = self.held(u, ground, axis) - self.held(u, body, axis);
                }
            }
        }
        q
    }

    /// The unknowns that move a node along an axis in which `held` does not let it move.
    pub fn freed_from(&self, held: &Unknowns) -> BTreeSet<usize> {
        let rows = self.rows.iter().zip(held.rows.iter()).filter(|(_, held)| held.is_empty());
        rows.flat_map(|(row, _)| row.iter().map(|&(i, _)| i)).collect()
    }

    /// What a node can have of a displacement: nothing where a support holds it.
    fn held(&self, u: &[[f64; 2]], node: usize, axis: usize) -> f64 {
        if self.row(node, axis).is_empty() { 0. } else { u[node][axis] }
    }

    /// The node that an unknown belongs to (a jump's ground node).
    pub fn node_of(&self, unknown: usize) -> usize {
        self.nodes[unknown]
    }
}

/// Every node's displacement along one axis in terms of its root's and of the jumps between them.
fn express(mesh: &Mesh, fixed: &[[bool; 2]], pairs: &[Pair], axis: usize) -> Result<Vec<Expression>> {
    let mut neighbours: Vec<Vec<(usize, usize, f64)>> = vec![Vec::new(); fixed.len()];
    for (p, pair) in pairs.iter().enumerate() {
        neighbours[pair.ground].push((p, pair.body, -1.));
        neighbours[pair.body].push((p, pair.ground, 1.));
    }
    let is_ground = |n: usize| pairs.iter().all(|p| p.body != n);
    let mut roots: Vec<usize> = (0..fixed.len()).collect();
    roots.sort_by_cached_key(|&n| (!fixed[n][axis], !neighbours[n].is_empty() && !is_ground(n), n));

    let mut found: Vec<Option<Expression>> = vec![None; fixed.len()];
    for root in roots {
        if found[root].is_some() {
            continue;
        }
        found[root] = Some(if fixed[root][axis] { vec![] } else { vec![(root, 1.)] });
        let mut stack = vec![(root, usize::MAX)];
        while let Some((node, came_by)) = stack.pop() {
            let here = found[node].clone().expect("pushed after it was found");
            for &(pair, other, sign) in neighbours[node].iter().filter(|n| n.0 != came_by) {
                let held = fixed[other][axis];
                if (found[other].is_some() || held) && !(held && here.is_empty()) {
                    return Err(no_jump_there(mesh, node));
                }
                if found[other].is_none() {
                    let jump = (!held).then_some((fixed.len() + pair, sign));
                    found[other] = Some(here.iter().copied().chain(jump).collect());
                    stack.push((other, pair));
                }
            }
        }
    }
    Ok(found.into_iter().map(|e| e.expect("every node was a root or reached from one")).collect())
}

fn no_jump_there(mesh: &Mesh, node: usize) -> Error {
    let [x, y] = mesh.points[node];
    Error::input(format!(
        "the interfaces at ({x:.4}, {y:.4}) m close a ring of node pairs, or a support holds both ends of a chain of them: \
         let at most one body meet the ground in each point"
    ))
}

/// Blocks that carry unknowns, in elimination order: nodes by nested dissection, then all pairs.
fn order_blocks(
    mesh: &Mesh,
    expressions: &[Vec<Expression>; 2],
    free: &[[bool; 2]],
    orders: &Orders,
) -> Result<Vec<usize>> {
    let kept: Vec<usize> = (0..free.len()).filter(|&b| free[b] != [false; 2]).collect();
    let mut vertex = vec![usize::MAX; free.len()];
    for (v, &block) in kept.iter().enumerate() {
        vertex[block] = v;
    }
    let faces = mesh.cells.iter().filter(|c| c.shape.dimension() == 2);
    let cliques: Vec<Vec<usize>> = faces
        .map(|face| {
            let terms = face.nodes.iter().flat_map(|&n| expressions.iter().flat_map(move |e| &e[n]));
            let mut clique: Vec<usize> = terms.map(|&(block, _)| vertex[block]).collect();
            clique.sort_unstable();
            clique.dedup();
            clique
        })
        .collect();
    let nodes = mesh.points.len();
    let last: Vec<usize> = (0..kept.len()).filter(|&v| kept[v] >= nodes).collect();
    let graph = Graph::from_cliques(kept.len(), cliques.iter().map(Vec::as_slice));
    Ok(orders.of(&graph, &last)?.into_iter().map(|v| kept[v]).collect())
}
