//! The unknowns of the equations: the displacements that no support holds, numbered in elimination order with the nodes
//! of the interfaces last; behind them, in the vectors of a state, the jumps.
//!
//! jump = u(ground) - u(body) follows from the displacements, but where stiff joints make it a small difference of
//! large ones, its digits are lost there: so a state carries it beside them.

use super::jump_sides::JumpSides;
use crate::model::mesh::Mesh;
use crate::model::split::Pair;
use crate::number::place;
use crate::sparse::{Graph, Orders};
use crate::{Error, Result};
use std::collections::BTreeSet;

#[derive(Debug, Clone, PartialEq)]
pub struct Unknowns {
    /// number of equations
    pub count: usize,
    /// the displacements of interface nodes are the unknowns from here on
    pub border: usize,
    /// per node and axis
    numbers: Vec<[Option<usize>; 2]>,
    /// for each pair and axis its place in the vector of jumps; none where supports hold both nodes
    pub jumps: Vec<[Option<usize>; 2]>,
    /// the unknowns that each jump lies between
    pub sides: JumpSides,
    /// the node whose motion an unknown is: for messages
    nodes: Vec<usize>,
}

impl Unknowns {
    /// `fixed` per node and axis; `orders`: those that are known.
    ///
    /// # Errors
    /// Pairs that form a ring (three bodies with three interfaces in one point), whose jumps depend on each other; or
    /// more unknowns than [`elimination_order`](crate::sparse::elimination_order) can number.
    pub fn new(mesh: &Mesh, fixed: &[[bool; 2]], pairs: &[Pair], orders: &Orders) -> Result<Unknowns> {
        refuse_rings(mesh, fixed, pairs)?;
        let (inner, at_interfaces) = order_nodes(mesh, fixed, pairs, orders)?;
        let axes_of = |&node: &usize| (0..2).filter(move |&axis| !fixed[node][axis]).map(move |axis| (node, axis));
        let mut numbers = vec![[None; 2]; fixed.len()];
        let mut nodes = Vec::new();
        for (node, axis) in inner.iter().chain(&at_interfaces).flat_map(axes_of) {
            numbers[node][axis] = Some(nodes.len());
            nodes.push(node);
        }
        let border = inner.iter().flat_map(axes_of).count();
        let mut sides = Vec::new();
        let jump = |pair: &Pair, axis: usize| {
            let side = [pair.ground, pair.body].map(|node: usize| numbers[node][axis]);
            (side != [None; 2]).then(|| {
                sides.push(side);
                sides.len() - 1
            })
        };
        let jumps = both_axes(pairs, jump);
        Ok(Unknowns { count: nodes.len(), border, numbers, jumps, sides: JumpSides::new(sides), nodes })
    }

    /// Length of a state's vectors: the unknowns, then the jumps.
    pub fn with_jumps(&self) -> usize {
        self.count + self.sides.count()
    }

    /// The unknown that moves this node along this axis; none where a support holds it.
    pub fn of(&self, node: usize, axis: usize) -> Option<usize> {
        self.numbers[node][axis]
    }

    /// Displacement of one node [as q].
    pub fn at_node(&self, q: &[f64], node: usize) -> [f64; 2] {
        self.numbers[node].map(|unknown| unknown.map_or(0., |i| q[i]))
    }

    /// Displacements of all nodes.
    pub fn at_nodes(&self, q: &[f64]) -> Vec<[f64; 2]> {
        (0..self.numbers.len()).map(|node| self.at_node(q, node)).collect()
    }

    /// q, jumps included, of nodal displacements (or velocities); those of supported nodes do not count.
    pub fn from_nodes(&self, u: &[[f64; 2]]) -> Vec<f64> {
        let mut q = vec![0.; self.count];
        for (unknowns, u) in self.numbers.iter().zip(u) {
            for axis in 0..2 {
                unknowns[axis].iter().for_each(|&i| q[i] = u[axis]);
            }
        }
        let jumps = self.sides.differences(&q);
        q.extend(jumps);
        q
    }

    /// q of other unknowns of the same nodes and pairs [as q], the jumps with all their digits.
    pub fn from_others(&self, others: &Unknowns, q: &[f64]) -> Vec<f64> {
        let mut own = self.from_nodes(&others.at_nodes(q));
        for (own_jumps, other_jumps) in self.jumps.iter().zip(&others.jumps) {
            for axis in 0..2 {
                if let (Some(to), Some(from)) = (own_jumps[axis], other_jumps[axis]) {
                    own[self.count + to] = q[others.count + from];
                }
            }
        }
        own
    }

    /// A state's vector: something of each unknown, and behind it the jumps.
    pub fn vector(&self, of_unknown: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut x = Vec::with_capacity(self.with_jumps());
        x.extend((0..self.count).map(of_unknown));
        x.extend(self.sides.differences(&x));
        x
    }

    /// The unknowns that move a node along an axis in which `held` does not let it move.
    pub fn freed_from(&self, held: &Unknowns) -> BTreeSet<usize> {
        let nodes = self.numbers.as_flattened().iter().zip(held.numbers.as_flattened());
        nodes.filter(|(_, held)| held.is_none()).filter_map(|(unknown, _)| *unknown).collect()
    }

    /// The node that an unknown moves.
    pub fn node_of(&self, unknown: usize) -> usize {
        self.nodes[unknown]
    }
}

fn both_axes(pairs: &[Pair], mut of: impl FnMut(&Pair, usize) -> Option<usize>) -> Vec<[Option<usize>; 2]> {
    pairs.iter().map(|pair| [of(pair, 0), of(pair, 1)]).collect()
}

/// Errors: a jump that is the sum of others. All held nodes count as one, which does not move.
fn refuse_rings(mesh: &Mesh, fixed: &[[bool; 2]], pairs: &[Pair]) -> Result<()> {
    let held = fixed.len();
    for axis in 0..2 {
        let mut joined_to: Vec<usize> = (0..=held).collect();
        let end = |joined_to: &[usize], node: usize| {
            let mut end = if fixed[node][axis] { held } else { node };
            while joined_to[end] != end {
                end = joined_to[end];
            }
            end
        };
        for pair in pairs.iter().filter(|p| !fixed[p.ground][axis] || !fixed[p.body][axis]) {
            let (ground, body) = (end(&joined_to, pair.ground), end(&joined_to, pair.body));
            if ground == body {
                let place = place(mesh.points[pair.ground]);
                return Err(Error::input(format!(
                    "the interfaces at {place} close a ring of node pairs, or a support holds both ends of a \
                     chain of them: let at most one body meet the ground in each point"
                )));
            }
            joined_to[ground.min(body)] = ground.max(body);
        }
    }
    Ok(())
}

/// Nodes that can move, in elimination order: by nested dissection, and then those of the interfaces.
fn order_nodes(mesh: &Mesh, fixed: &[[bool; 2]], pairs: &[Pair], orders: &Orders) -> Result<(Vec<usize>, Vec<usize>)> {
    let free: Vec<usize> = (0..fixed.len()).filter(|&node| fixed[node] != [true; 2]).collect();
    let mut vertex = vec![None; fixed.len()];
    free.iter().enumerate().for_each(|(v, &node)| vertex[node] = Some(v));
    let faces = mesh.cells.iter().filter(|cell| cell.shape.dimension() == 2);
    let cliques: Vec<Vec<usize>> = faces.map(|face| face.nodes.iter().filter_map(|&n| vertex[n]).collect()).collect();
    let graph = Graph::from_cliques(free.len(), cliques.iter().map(Vec::as_slice));
    let last: BTreeSet<usize> = pairs.iter().flat_map(|p| [vertex[p.ground], vertex[p.body]]).flatten().collect();
    let last: Vec<usize> = last.into_iter().collect();
    let mut order: Vec<usize> = orders.of(&graph, &last)?.into_iter().map(|v| free[v]).collect();
    let at_interfaces = order.split_off(order.len() - last.len());
    Ok((order, at_interfaces))
}
