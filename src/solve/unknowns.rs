//! The unknowns of the equations: the displacements that no support holds, numbered in elimination order with the nodes
//! of the interfaces last; behind them, in the vectors of a state, the jumps.
//!
//! jump = u(ground) - u(body) follows from the displacements, but where stiff joints make it a small difference of
//! large ones, its digits are lost there: so a state carries it beside them.

use super::jump_sides::JumpSides;
use crate::Result;
use crate::model::mesh::Mesh;
use crate::model::split::Pair;
use crate::sparse::{Graph, Orders};
use std::collections::{BTreeSet, HashMap, HashSet};

/// The jump of a pair along an axis as a sum of (place in the vector of jumps, sign). Most pairs have a place of their
/// own. Where interfaces meet, n copies of a node have n - 1 independent jumps, and the other pairs' are sums of these.
/// Empty where supports hold both nodes or an interface ends.
pub type PairJump = Vec<(usize, f64)>;

#[derive(Debug, Clone, PartialEq)]
pub struct Unknowns {
    /// number of equations
    pub count: usize,
    /// the displacements of interface nodes are the unknowns from here on
    pub border: usize,
    /// per node and axis
    numbers: Vec<[Option<usize>; 2]>,
    /// the jump of each pair along each axis
    pub jumps: Vec<[PairJump; 2]>,
    /// the unknowns that each jump lies between
    pub sides: JumpSides,
    /// the node whose motion an unknown is: for messages
    nodes: Vec<usize>,
}

impl Unknowns {
    /// `fixed` per node and axis; `orders`: those that are known.
    ///
    /// # Errors
    /// More unknowns than [`elimination_order`](crate::sparse::elimination_order) can number.
    pub fn new(mesh: &Mesh, fixed: &[[bool; 2]], pairs: &[Pair], orders: &Orders) -> Result<Unknowns> {
        let (inner, at_interfaces) = order_nodes(mesh, fixed, pairs, orders)?;
        let axes_of = |&node: &usize| (0..2).filter(move |&axis| !fixed[node][axis]).map(move |axis| (node, axis));
        let mut numbers = vec![[None; 2]; fixed.len()];
        let mut nodes = Vec::new();
        for (node, axis) in inner.iter().chain(&at_interfaces).flat_map(axes_of) {
            numbers[node][axis] = Some(nodes.len());
            nodes.push(node);
        }
        let border = inner.iter().flat_map(axes_of).count();
        let Jumps { of_pairs, sides } = Jumps::new(&numbers, pairs);
        Ok(Unknowns { count: nodes.len(), border, numbers, jumps: of_pairs, sides: JumpSides::new(sides), nodes })
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
        for (own_jump, other_jump) in self.jumps.as_flattened().iter().zip(others.jumps.as_flattened()) {
            if let [(to, sign)] = own_jump[..] {
                own[self.count + to] =
                    sign * other_jump.iter().map(|&(from, s)| s * q[others.count + from]).sum::<f64>();
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

/// The independent jumps, and those of all pairs as sums of them.
struct Jumps {
    /// per pair and axis
    of_pairs: Vec<[PairJump; 2]>,
    /// unknowns of ground and body of each independent jump, none where a support holds that side
    sides: Vec<[Option<usize>; 2]>,
}

impl Jumps {
    /// `numbers`: the unknowns of each node and axis.
    ///
    /// The pairs are the edges of a graph of unknowns, in which all that supports hold is one vertex. Those of a spanning
    /// forest, the first that are found, are independent; the jump of every other is the sum along its path in the forest.
    fn new(numbers: &[[Option<usize>; 2]], pairs: &[Pair]) -> Jumps {
        let mut of_pairs = vec![[PairJump::new(), PairJump::new()]; pairs.len()];
        let mut forest = Forest::default();
        let mut sides = Vec::new();
        for (pair, jumps) in pairs.iter().zip(&mut of_pairs).filter(|(pair, _)| pair.is_open()) {
            for axis in 0..2 {
                let [ground, body] = [pair.ground, pair.body].map(|node| numbers[node][axis]);
                jumps[axis] = forest.path(ground, body).unwrap_or_else(|| {
                    forest.add(ground, body, sides.len());
                    sides.push([ground, body]);
                    vec![(sides.len() - 1, 1.)]
                });
            }
        }
        Jumps { of_pairs, sides }
    }
}

/// Jumps between unknowns; none is what supports hold.
#[derive(Default)]
struct Forest(HashMap<Option<usize>, Vec<Branch>>);

/// A jump from one unknown to another: u(from) - u(to) = sign * jump.
#[derive(Clone, Copy)]
struct Branch {
    to: Option<usize>,
    jump: usize,
    sign: f64,
}

impl Forest {
    fn add(&mut self, ground: Option<usize>, body: Option<usize>, jump: usize) {
        self.0.entry(ground).or_default().push(Branch { to: body, jump, sign: 1. });
        self.0.entry(body).or_default().push(Branch { to: ground, jump, sign: -1. });
    }

    /// The jumps whose sum is u(ground) - u(body); none if no path leads from one to the other.
    fn path(&self, ground: Option<usize>, body: Option<usize>) -> Option<PairJump> {
        let mut seen = HashSet::from([ground]);
        let mut ends = vec![(ground, PairJump::new())];
        while let Some((end, path)) = ends.pop() {
            if end == body {
                return Some(path);
            }
            for branch in self.0.get(&end).into_iter().flatten().filter(|branch| seen.insert(branch.to)) {
                let longer = path.iter().copied().chain([(branch.jump, branch.sign)]).collect();
                ends.push((branch.to, longer));
            }
        }
        None
    }
}

/// Nodes that can move, in elimination order: by nested dissection, and then those of the interfaces.
fn order_nodes(mesh: &Mesh, fixed: &[[bool; 2]], pairs: &[Pair], orders: &Orders) -> Result<(Vec<usize>, Vec<usize>)> {
    let free: Vec<usize> = (0..fixed.len()).filter(|&node| fixed[node] != [true; 2]).collect();
    let mut vertex = vec![None; fixed.len()];
    free.iter().enumerate().for_each(|(v, &node)| vertex[node] = Some(v));
    let faces = mesh.cells.iter().filter(|cell| cell.shape.dimension() == 2);
    let cliques: Vec<Vec<usize>> = faces.map(|face| face.nodes.iter().filter_map(|&n| vertex[n]).collect()).collect();
    let graph = Graph::from_cliques(free.len(), cliques.iter().map(Vec::as_slice));
    let open = pairs.iter().filter(|pair| pair.is_open());
    let last: BTreeSet<usize> = open.flat_map(|p| [vertex[p.ground], vertex[p.body]]).flatten().collect();
    let last: Vec<usize> = last.into_iter().collect();
    let mut order: Vec<usize> = orders.of(&graph, &last)?.into_iter().map(|v| free[v]).collect();
    let at_interfaces = order.split_off(order.len() - last.len());
    Ok((order, at_interfaces))
}
