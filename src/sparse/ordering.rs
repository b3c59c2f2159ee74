//! Elimination order: nested dissection, postordered, with chosen vertices at the end.

use std::sync::Mutex;

use metis_sys::{METIS_NodeND, METIS_SetDefaultOptions, idx_t, moptions_et_METIS_OPTION_SEED, rstatus_et_METIS_OK};
use sprs::CsMat;

use crate::{Error, Result};

/// Symmetric graph without self loops: the neighbours of `v` are `neighbours[start[v]..start[v + 1]]`, ascending.
/// A vertex is a block of unknowns, for example a node of a mesh.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Graph {
    pub start: Vec<usize>,
    pub neighbours: Vec<usize>,
}

impl Graph {
    /// Joins all vertices of a clique with each other: an element couples all its nodes.
    ///
    /// # Panics
    /// If a clique names a vertex that is not in `0..vertices`.
    pub fn from_cliques<'a>(vertices: usize, cliques: impl Iterator<Item = &'a [usize]> + Clone) -> Self {
        let mut first = vec![0; vertices + 1];
        cliques.clone().flatten().for_each(|&v| first[v + 1] += 1);
        (0..vertices).for_each(|v| first[v + 1] += first[v]);
        let mut next = first.clone();
        let mut cliques_of = vec![&[][..]; first[vertices]];
        for clique in cliques {
            for &v in clique {
                cliques_of[next[v]] = clique;
                next[v] += 1;
            }
        }

        let mut start = vec![0];
        let mut neighbours = Vec::new();
        let mut seen_by = vec![usize::MAX; vertices];
        for v in 0..vertices {
            seen_by[v] = v;
            for &w in cliques_of[first[v]..first[v + 1]].iter().copied().flatten() {
                if seen_by[w] != v {
                    seen_by[w] = v;
                    neighbours.push(w);
                }
            }
            neighbours[start[v]..].sort_unstable();
            start.push(neighbours.len());
        }
        Graph { start, neighbours }
    }

    pub fn len(&self) -> usize {
        self.start.len() - 1
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub fn neighbours_of(&self, v: usize) -> &[usize] {
        &self.neighbours[self.start[v]..self.start[v + 1]]
    }

    /// The matrix that is zero on every vertex and edge.
    pub fn zeros(&self) -> CsMat<f64> {
        let mut columns = Vec::with_capacity(self.neighbours.len() + self.len());
        for v in 0..self.len() {
            let (left, right) = self.neighbours_of(v).split_at(self.neighbours_of(v).partition_point(|&w| w < v));
            columns.extend_from_slice(left);
            columns.push(v);
            columns.extend_from_slice(right);
        }
        let start = self.start.iter().enumerate().map(|(v, edges)| edges + v).collect();
        CsMat::new((self.len(), self.len()), start, columns, vec![0.; self.neighbours.len() + self.len()])
    }

    /// The graph of `kept` alone, its vertices numbered as they stand there.
    fn subgraph(&self, kept: &[usize]) -> Graph {
        let mut new = vec![usize::MAX; self.len()];
        kept.iter().enumerate().for_each(|(i, &v)| new[v] = i);
        let mut start = vec![0];
        let mut neighbours = Vec::new();
        for &v in kept {
            neighbours.extend(self.neighbours_of(v).iter().map(|&w| new[w]).filter(|&w| w != usize::MAX));
            start.push(neighbours.len());
        }
        Graph { start, neighbours }
    }
}

/// `order[new] = old`: nested dissection of the graph without the vertices `last`, postordered along its
/// elimination tree, then `last` as given. The same graph gives the same order.
///
/// # Errors
/// If the graph is too large for METIS, which counts in 32 bits.
///
/// # Panics
/// If `last` names a vertex that is not in the graph, or one twice.
pub fn elimination_order(graph: &Graph, last: &[usize]) -> Result<Vec<usize>> {
    let mut is_last = vec![false; graph.len()];
    for &v in last {
        assert!(!is_last[v], "vertex {v} is named twice among the last ones");
        is_last[v] = true;
    }
    let interior: Vec<usize> = (0..graph.len()).filter(|&v| !is_last[v]).collect();
    let inner = graph.subgraph(&interior);
    let dissected = nested_dissection(&inner)?;
    let postorder = postorder(&elimination_tree(&inner, &dissected));
    Ok(postorder.iter().map(|&i| interior[dissected[i]]).chain(last.iter().copied()).collect())
}

/// `order[new] = old` by METIS on the vertices that have neighbours; those that have none come first.
fn nested_dissection(graph: &Graph) -> Result<Vec<usize>> {
    let (coupled, mut order): (Vec<usize>, Vec<usize>) =
        (0..graph.len()).partition(|&v| !graph.neighbours_of(v).is_empty());
    if !coupled.is_empty() {
        order.extend(metis_order(&graph.subgraph(&coupled))?.into_iter().map(|i| coupled[i]));
    }
    Ok(order)
}

/// `order[new] = old` by METIS_NodeND, for a graph where every vertex has a neighbour.
fn metis_order(graph: &Graph) -> Result<Vec<usize>> {
    /// METIS draws from the one random generator of the C library: two calls at once would change each other's order.
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

    let too_large = |_| {
        Error::input(format!(
            "the system couples {} blocks of unknowns by {} entries, more than METIS can count ({}); a coarser mesh has fewer",
            graph.len(),
            graph.neighbours.len(),
            idx_t::MAX
        ))
    };
    let narrow = |list: &[usize]| list.iter().map(|&i| idx_t::try_from(i)).collect::<std::result::Result<Vec<_>, _>>();
    let mut start = narrow(&graph.start).map_err(too_large)?;
    let mut neighbours = narrow(&graph.neighbours).map_err(too_large)?;
    let mut vertices = idx_t::try_from(graph.len()).map_err(too_large)?;
    let mut old_of = vec![0; graph.len()];
    let mut new_of = vec![0; graph.len()];
    let mut options = [0; metis_sys::METIS_NOPTIONS as usize];

    let guard = ONE_AT_A_TIME.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    // SAFETY: `options` has METIS_NOPTIONS entries; `start` has vertices + 1 of them, is ascending and ends at the
    // length of `neighbours`, whose entries are below `vertices`; both results have `vertices` entries. METIS keeps
    // no pointer.
    let status = unsafe {
        METIS_SetDefaultOptions(options.as_mut_ptr());
        options[moptions_et_METIS_OPTION_SEED as usize] = 1;
        METIS_NodeND(
            &mut vertices,
            start.as_mut_ptr(),
            neighbours.as_mut_ptr(),
            std::ptr::null_mut(),
            options.as_mut_ptr(),
            old_of.as_mut_ptr(),
            new_of.as_mut_ptr(),
        )
    };
    drop(guard);
    if status != rstatus_et_METIS_OK {
        return Err(Error::input(format!(
            "METIS could not order the {} blocks of unknowns (its status is {status}); there may be too little memory",
            graph.len()
        )));
    }
    Ok(old_of.into_iter().map(|v| v as usize).collect())
}

const NONE: usize = usize::MAX;

/// `parent[new]` in the elimination tree of the graph taken in `order[new] = old`; `NONE` at a root.
/// Liu (1986), with path compression.
fn elimination_tree(graph: &Graph, order: &[usize]) -> Vec<usize> {
    let mut new_of = vec![0; order.len()];
    order.iter().enumerate().for_each(|(new, &old)| new_of[old] = new);
    let mut parent = vec![NONE; order.len()];
    let mut ancestor = vec![NONE; order.len()];
    for (j, &old) in order.iter().enumerate() {
        for &neighbour in graph.neighbours_of(old) {
            let mut i = new_of[neighbour];
            while i < j {
                let above = std::mem::replace(&mut ancestor[i], j);
                if above == NONE {
                    parent[i] = j;
                    break;
                }
                i = above;
            }
        }
    }
    parent
}

/// The vertices of a forest so that every subtree is contiguous and ends with its root; children stay ascending.
fn postorder(parent: &[usize]) -> Vec<usize> {
    let mut first_child = vec![NONE; parent.len()];
    let mut sibling = vec![NONE; parent.len()];
    let mut stack = Vec::new();
    for v in (0..parent.len()).rev() {
        match parent[v] {
            NONE => stack.push(v),
            p => sibling[v] = std::mem::replace(&mut first_child[p], v),
        }
    }
    let mut order = Vec::with_capacity(parent.len());
    while let Some(&v) = stack.last() {
        match std::mem::replace(&mut first_child[v], NONE) {
            NONE => {
                order.push(v);
                stack.pop();
            }
            child => {
                first_child[v] = sibling[child];
                stack.push(child);
            }
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sparse::testing::triangles;

    fn grid(nx: usize, ny: usize) -> Graph {
        let elements = triangles(nx, ny);
        Graph::from_cliques((nx + 1) * (ny + 1), elements.iter().map(|e| &e[..]))
    }

    fn graph(vertices: usize, edges: &[[usize; 2]]) -> Graph {
        Graph::from_cliques(vertices, edges.iter().map(|e| &e[..]))
    }

    /// Entries of L for a graph in `order`, by elimination of one vertex after the other.
    fn fill(graph: &Graph, order: &[usize]) -> usize {
        let parent = elimination_tree(graph, order);
        let mut new_of = vec![0; order.len()];
        order.iter().enumerate().for_each(|(new, &old)| new_of[old] = new);
        let mut rows = vec![std::collections::BTreeSet::new(); order.len()];
        for j in 0..order.len() {
            let own = graph.neighbours_of(order[j]).iter().map(|&w| new_of[w]).filter(|&i| i > j);
            rows[j].extend(own);
            if parent[j] != NONE {
                let above: Vec<usize> = rows[j].iter().copied().filter(|&i| i > parent[j]).collect();
                rows[parent[j]].extend(above);
            }
        }
        rows.iter().map(|r| r.len() + 1).sum()
    }

    #[test]
    fn cliques_join_all_their_vertices_once() {
        let graph = Graph::from_cliques(5, [&[0, 1, 2][..], &[2, 1, 3], &[2, 2]].into_iter());
        assert_eq!(graph.start, [0, 2, 5, 8, 10, 10]);
        assert_eq!(graph.neighbours, [1, 2, 0, 2, 3, 0, 1, 3, 1, 2]);
    }

    #[test]
    fn order_is_a_permutation_with_the_last_at_the_end() {
        let star: Vec<[usize; 2]> = (1..50).map(|v| [0, v]).collect();
        let two_parts: Vec<[usize; 2]> = (0..40).flat_map(|v| [[v, v + 1], [v + 50, v + 51]]).collect();
        let mut graphs: Vec<Graph> = (0..5).map(|n| graph(n, &[])).collect();
        graphs.extend([
            graph(2, &[[0, 1]]),
            graph(3, &[[0, 1]]),
            graph(3, &[[0, 1], [1, 2]]),
            graph(3, &[[0, 1], [1, 2], [0, 2]]),
            graph(4, &[[0, 1], [2, 3]]),
            graph(300, &[]),
            graph(50, &star),
            graph(120, &two_parts),
            Graph::from_cliques(230, [&(0..230).collect::<Vec<_>>()[..]].into_iter()),
            grid(1, 1),
            grid(30, 20),
        ]);
        for graph in &graphs {
            let n = graph.len();
            for m in [0, 1, 2, n / 2, n.saturating_sub(1), n] {
                let last: Vec<usize> = (0..m.min(n)).map(|i| (7 * i + 3) % n).collect();
                let distinct: std::collections::BTreeSet<_> = last.iter().collect();
                if distinct.len() < last.len() {
                    continue;
                }
                let order = elimination_order(graph, &last).expect("small graphs can be ordered");
                assert_eq!(order[n - last.len()..], last[..]);
                let mut sorted = order.clone();
                sorted.sort_unstable();
                assert!(sorted.iter().copied().eq(0..n), "{n} vertices, {m} of them last");
            }
        }
    }

    #[test]
    fn every_subtree_of_the_interior_is_contiguous() {
        let graph = grid(40, 30);
        let order = elimination_order(&graph, &[]).expect("small graphs can be ordered");
        let parent = elimination_tree(&graph, &order);
        let mut size = vec![1; order.len()];
        for v in 0..order.len() {
            if parent[v] != NONE {
                size[parent[v]] += size[v];
            }
        }
        for (v, size) in size.iter().enumerate() {
            let below = v + 1 - size..v;
            assert!(below.clone().all(|w| below.contains(&parent[w]) || parent[w] == v), "subtree of {v}");
        }
    }

    #[test]
    fn postorder_keeps_the_fill_of_nested_dissection_which_beats_the_natural_order() {
        let graph = grid(60, 60);
        let dissected = nested_dissection(&graph).expect("small graphs can be ordered");
        let order = elimination_order(&graph, &[]).expect("small graphs can be ordered");
        assert_eq!(fill(&graph, &order), fill(&graph, &dissected));
        let natural: Vec<usize> = (0..graph.len()).collect();
        // n log n against n^1.5: 2.5 times less at 61 x 61 nodes.
        assert!(2 * fill(&graph, &order) < fill(&graph, &natural));
    }

    #[test]
    fn the_order_is_the_same_from_all_threads() {
        let graph = grid(50, 40);
        let expected = elimination_order(&graph, &[5, 6]).expect("small graphs can be ordered");
        std::thread::scope(|scope| {
            let all: Vec<_> = (0..8).map(|_| scope.spawn(|| elimination_order(&graph, &[5, 6]))).collect();
            for one in all {
                assert_eq!(one.join().expect("no panic"), Ok(expected.clone()));
            }
        });
    }
}
