//! Matrices for the tests of this folder.

use sprs::{CsMat, TriMat};

use super::lanczos::pseudo_random;
use super::{Graph, elimination_order};

/// Numbers in -1..1 that look random: the same at every run.
pub fn random(n: usize, seed: usize) -> Vec<f64> {
    pseudo_random(n, seed)
}

/// Triangles of a grid with `nx` x `ny` cells, each cut along a diagonal.
pub fn triangles(nx: usize, ny: usize) -> Vec<[usize; 3]> {
    let node = |i, j| j * (nx + 1) + i;
    (0..nx * ny)
        .map(|c| (c % nx, c / nx))
        .flat_map(|(i, j)| {
            [[node(i, j), node(i + 1, j), node(i + 1, j + 1)], [node(i, j), node(i + 1, j + 1), node(i, j + 1)]]
        })
        .collect()
}

/// A symmetric positive definite matrix with the pattern of T3 plane strain on a grid, two unknowns a node, in
/// elimination order with the nodes `last` at the end: sum over triangles of B^T B, random B, and the unit matrix.
pub fn grid_matrix(nx: usize, ny: usize, last: &[usize]) -> CsMat<f64> {
    let elements = triangles(nx, ny);
    let nodes = (nx + 1) * (ny + 1);
    let graph = Graph::from_cliques(nodes, elements.iter().map(|e| &e[..]));
    let order = elimination_order(&graph, last).expect("a small graph can be ordered");
    let mut new_of = vec![0; nodes];
    order.iter().enumerate().for_each(|(new, &old)| new_of[old] = new);

    let mut a = TriMat::new((2 * nodes, 2 * nodes));
    (0..2 * nodes).for_each(|i| a.add_triplet(i, i, 1.0));
    for (e, nodes) in elements.iter().enumerate() {
        let unknown = |k: usize| 2 * new_of[nodes[k / 2]] + k % 2;
        let b = random(18, e);
        for (i, j) in (0..36).map(|k| (k / 6, k % 6)) {
            let bb = (0..3).map(|r| b[6 * r + i] * b[6 * r + j]).sum();
            a.add_triplet(unknown(i), unknown(j), bb);
        }
    }
    a.to_csr()
}

/// `a` with all its entries.
pub fn dense(a: &CsMat<f64>) -> nalgebra::DMatrix<f64> {
    let mut full = nalgebra::DMatrix::zeros(a.rows(), a.cols());
    a.iter().for_each(|(&aij, (i, j))| full[(i, j)] = aij);
    full
}

/// max |x_i - y_i|
pub fn distance(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).fold(0.0, |d: f64, (x, y)| d.max((x - y).abs()))
}
