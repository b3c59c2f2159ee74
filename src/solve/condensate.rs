//! What bodies and ground do where they meet: T, the Schur complement of the displacements of interface nodes, inverted
//! once. Without joints ground and bodies know nothing of each other there, and T falls apart into blocks.

use super::jump_sides::JumpSides;
use super::unknowns::Unknowns;
use crate::sparse::vector::add;
use crate::sparse::{Factor, Symmetric};
use faer::linalg::solvers::DenseSolveCore;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, Par};

pub struct Condensate {
    blocks: Vec<Block>,
    /// N, of displacements at the border
    sides: JumpSides,
    /// S = (N T^-1 N')^-1, the forces at the jumps that make jumps [N/m]
    pub schur: Mat<f64>,
    packed_schur: Symmetric,
    /// |S|, the root of the sum of the squares of its entries [N/m]
    pub norm: f64,
}

/// A part of T that nothing couples to the rest.
struct Block {
    /// ascending
    places: Vec<usize>,
    /// T^-1 [m/N]
    inverse: Symmetric,
    /// T itself, where solutions are to be refined [N/m]
    matrix: Option<Symmetric>,
}

impl Block {
    /// T^-1 b; where T is at hand, with a second round for what the first has left of b.
    fn displacements(&self, b: &[f64]) -> Vec<f64> {
        let mut c = self.inverse.times(b);
        if let Some(matrix) = &self.matrix {
            let left: Vec<f64> = b.iter().zip(matrix.times(&c)).map(|(b, t)| b - t).collect();
            add(&mut c, 1., &self.inverse.times(&left));
        }
        c
    }
}

impl Condensate {
    /// T = L_cc L_cc', L_cc the trailing block of the factor. What is `refined` gets the last digits, for twice the
    /// work: without inertia T may be of very stiff and very soft parts.
    pub fn new(factor: &Factor, unknowns: &Unknowns, refined: bool) -> Condensate {
        let trailing = factor.trailing(unknowns.count - unknowns.border);
        let mut inverse = Mat::zeros(trailing.nrows(), trailing.ncols());
        let mut blocks = Vec::new();
        for places in independent(&trailing) {
            let n = places.len();
            let l = Mat::from_fn(n, n, |i, j| trailing[(places[i], places[j])]);
            let mut l_inverse = Mat::identity(n, n);
            solve_lower_triangular_in_place(l.as_ref(), l_inverse.as_mut(), Par::Seq);
            let of_block = l_inverse.transpose() * &l_inverse;
            (0..n).for_each(|j| (0..n).for_each(|i| inverse[(places[i], places[j])] = of_block[(i, j)]));
            let matrix = refined.then(|| Symmetric::new(&(&l * l.transpose())));
            blocks.push(Block { inverse: Symmetric::new(&of_block), matrix, places });
        }
        let sides = unknowns.sides.behind(unknowns.border);
        let between = |a: usize, b: usize| -> f64 {
            sides
                .of(a)
                .flat_map(|(i, s)| sides.of(b).map(move |(j, t)| (i, j, s * t)))
                .map(|(i, j, s)| s * inverse[(i, j)])
                .sum()
        };
        let flexibility = Mat::from_fn(sides.count(), sides.count(), between);
        let schur = flexibility.partial_piv_lu().inverse();
        Condensate { blocks, sides, packed_schur: Symmetric::new(&schur), norm: schur.norm_l2(), schur }
    }

    /// T^-1 b: displacements [m] under forces at the border [N].
    pub fn displacements(&self, b: &[f64]) -> Vec<f64> {
        let mut c = vec![0.; b.len()];
        for block in &self.blocks {
            let own: Vec<f64> = block.places.iter().map(|&i| b[i]).collect();
            block.places.iter().zip(block.displacements(&own)).for_each(|(&i, own)| c[i] = own);
        }
        c
    }

    /// N c: the jumps of displacements of the border.
    pub fn jumps(&self, c: &[f64]) -> Vec<f64> {
        self.sides.differences(c)
    }

    /// S j: forces at the jumps [N].
    pub fn forces(&self, jumps: &[f64]) -> Vec<f64> {
        self.packed_schur.times(jumps)
    }

    /// b - N' forces: forces at the border [N] with those that pull the sides of the jumps together.
    pub fn pulled(&self, b: &[f64], forces: &[f64]) -> Vec<f64> {
        let mut pulled = b.to_vec();
        self.sides.add_forces(&mut pulled, -1., forces);
        pulled
    }
}

/// The rows of L that no entry couples to others, group by group.
fn independent(l: &Mat<f64>) -> Vec<Vec<usize>> {
    let n = l.nrows();
    let mut group: Vec<usize> = (0..n).collect();
    for j in 0..n {
        for i in (j + 1..n).filter(|&i| l[(i, j)] != 0.) {
            let (old, new) = (group[i].max(group[j]), group[i].min(group[j]));
            if old != new {
                group.iter_mut().filter(|g| **g == old).for_each(|g| *g = new);
            }
        }
    }
    let members = |g: usize| (0..n).filter(|&i| group[i] == g).collect::<Vec<_>>();
    (0..n).map(members).filter(|places| !places.is_empty()).collect()
}
