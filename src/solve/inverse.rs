//! Solves with S + sum area N' R' D R N for the many sets of joint tangents D that a run goes through.
//!
//! The inverse for one set is kept, dense; where few joints differ from it, Woodbury's formula corrects the solution,
//! and where many do, the inverse itself. So a change of status costs by what changed, not by the number of joints.

use super::interface::Interface;
use crate::sparse::columns::add_columns;
use faer::linalg::solvers::{DenseSolveCore, Solve};
use faer::{Accum, Mat, Par};
use nalgebra::Matrix2;

/// Share of the unknowns that may differ before the inverse is corrected: a solve then still costs about one product.
const MANY: usize = 8;

#[derive(Default)]
pub struct Inverse {
    /// the one that belongs to tangents of its own, perhaps after corrections
    kept: Option<Kept>,
    /// how the last tangents differ from those of the inverse
    change: Option<Change>,
}

struct Kept {
    /// D of every joint point that the inverse belongs to [Pa/m]
    tangents: Vec<Matrix2<f64>>,
    /// R
    inverse: Mat<f64>,
    /// made from S, not from another inverse
    fresh: bool,
}

impl Inverse {
    /// (S + sum area N' R' D R N)^-1 f, D per joint point. Zeros in f cost nothing.
    pub fn solve(&mut self, schur: &Mat<f64>, interface: &Interface, tangents: &[Matrix2<f64>], f: &[f64]) -> Vec<f64> {
        self.move_to(schur, interface, tangents);
        let kept = self.kept.as_ref().expect("made just before");
        let mut x = kept.times(f);
        if let Some(change) = &self.change {
            change.correct(&mut x, &kept.inverse);
        }
        x
    }

    /// Lets go of an inverse that many corrections have made inexact.
    pub fn forget(&mut self) {
        (self.kept, self.change) = (None, None);
    }

    /// Whether the last solution came from corrections.
    pub fn is_corrected(&self) -> bool {
        self.change.is_some() || self.kept.as_ref().is_some_and(|kept| !kept.fresh)
    }

    /// An inverse whose tangents differ from the given ones in few places, and how.
    fn move_to(&mut self, schur: &Mat<f64>, interface: &Interface, tangents: &[Matrix2<f64>]) {
        let limit = interface.count / MANY;
        match self.kept.take() {
            Some(kept) if kept.tangents == tangents => (self.kept, self.change) = (Some(kept), None),
            Some(kept) if self.change.as_ref().is_some_and(|change| change.to == tangents) => self.kept = Some(kept),
            Some(kept) => {
                let places = touched(interface, &kept.tangents, tangents);
                (self.kept, self.change) = match places.len() {
                    n if n <= limit => {
                        let change = Change::new(interface, &kept, tangents, places);
                        (Some(kept), Some(change))
                    }
                    n if n <= 4 * limit => {
                        let change = Change::new(interface, &kept, tangents, places);
                        (Some(kept.corrected(change)), None)
                    }
                    _ => (Some(Kept::new(schur, interface, tangents)), None),
                };
            }
            None => (self.kept, self.change) = (Some(Kept::new(schur, interface, tangents)), None),
        }
    }
}

impl Kept {
    fn new(schur: &Mat<f64>, interface: &Interface, tangents: &[Matrix2<f64>]) -> Kept {
        let mut matrix = schur.clone();
        for (point, d) in interface.points.iter().zip(tangents) {
            interface.tangent(point, d, |i, j, value| matrix[(i, j)] += value);
        }
        Kept { tangents: tangents.to_vec(), inverse: matrix.partial_piv_lu().inverse(), fresh: true }
    }

    /// R - R E W E'R.
    fn corrected(self, change: Change) -> Kept {
        let mut inverse = self.inverse;
        let all: Vec<usize> = (0..inverse.nrows()).collect();
        let weighted = &change.weights * picked(&inverse, &change.places, &all);
        let columns = picked(&inverse, &all, &change.places);
        faer::linalg::matmul::matmul(&mut inverse, Accum::Add, &columns, &weighted, -1., Par::Seq);
        Kept { tangents: change.to, inverse, fresh: false }
    }

    /// R f.
    fn times(&self, f: &[f64]) -> Vec<f64> {
        dense_times(&self.inverse, f)
    }
}

/// The places in the vector of jumps at which joint points see other tangents, ascending.
fn touched(interface: &Interface, from: &[Matrix2<f64>], to: &[Matrix2<f64>]) -> Vec<usize> {
    let points = interface.points.iter().zip(from).zip(to).filter(|((_, from), to)| from != to);
    let mut places: Vec<usize> = points.flat_map(|((point, _), _)| interface.places(point)).collect();
    places.sort_unstable();
    places.dedup();
    places
}

/// What some joint points' tangents add to the matrix: E C E', with E picking the places they touch. Its inverse is
/// R - R E W E'R, W = (1 + C E'R E)^-1 C.
struct Change {
    /// D of every joint point [Pa/m]
    to: Vec<Matrix2<f64>>,
    /// ascending
    places: Vec<usize>,
    /// W [N/m]
    weights: Mat<f64>,
}

impl Change {
    fn new(interface: &Interface, kept: &Kept, to: &[Matrix2<f64>], places: Vec<usize>) -> Change {
        let n = places.len();
        let at = |i: usize| places.binary_search(&i).expect("collected from the same points");
        let mut matrix = Mat::zeros(n, n);
        let points = interface.points.iter().zip(&kept.tangents).zip(to);
        for ((point, from), to) in points.filter(|((_, from), to)| from != to) {
            interface.tangent(point, &(to - from), |i, j, value| matrix[(at(i), at(j))] += value);
        }
        let seen = picked(&kept.inverse, &places, &places);
        let system = Mat::<f64>::identity(n, n) + &matrix * seen;
        Change { to: to.to_vec(), weights: system.partial_piv_lu().solve(matrix), places }
    }

    /// x - R E W E'x.
    fn correct(&self, x: &mut [f64], inverse: &Mat<f64>) {
        let seen: Vec<f64> = self.places.iter().map(|&i| x[i]).collect();
        let weights = dense_times(&self.weights, &seen);
        let weights: Vec<(usize, f64)> = self.places.iter().zip(&weights).map(|(&j, weight)| (j, -weight)).collect();
        add_columns(x, inverse, &weights);
    }
}

/// Some rows and columns of A.
fn picked(a: &Mat<f64>, rows: &[usize], columns: &[usize]) -> Mat<f64> {
    let mut picked = Mat::zeros(rows.len(), columns.len());
    for (to, &from) in columns.iter().enumerate() {
        let column = a.col_as_slice(from);
        picked.col_as_slice_mut(to).iter_mut().zip(rows).for_each(|(to, &row)| *to = column[row]);
    }
    picked
}

/// A x. Zeros in x cost nothing.
pub fn dense_times(a: &Mat<f64>, x: &[f64]) -> Vec<f64> {
    let entries: Vec<(usize, f64)> = x.iter().copied().enumerate().filter(|(_, x)| *x != 0.).collect();
    let mut product = vec![0.; a.nrows()];
    add_columns(&mut product, a, &entries);
    product
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::case::Integration;
    use crate::model::mesh::Mesh;
    use crate::model::split::{Joint, Pair};
    use crate::physics::joint::{Friction, JointLaw};
    use crate::physics::shape::Shape;

    const PAIRS: usize = 40;

    /// Joints along the x axis.
    fn interface(integration: Integration) -> Interface {
        let points = (0..2 * PAIRS).map(|n| [(n % PAIRS) as f64, 0.]).collect();
        let mesh = Mesh { points, ..Mesh::default() };
        let pairs: Vec<Pair> = (0..PAIRS).map(|p| Pair { ground: p, body: PAIRS + p }).collect();
        let joint =
            |p: usize| Joint { seam: 0, shape: Shape::Line2, pairs: vec![p - 1, p], ground_cell: 0, body_cell: 0 };
        let joints: Vec<Joint> = (1..PAIRS).map(joint).collect();
        let law =
            JointLaw { normal_stiffness: 50., tangential_stiffness: 20., friction: Friction::Coulomb(0.3), gap: 0. };
        let jumps: Vec<_> = (0..PAIRS).map(|p| [Some(2 * p), Some(2 * p + 1)]).collect();
        Interface::new(&mesh, &pairs, &joints, &vec![(law, integration); joints.len()], &jumps)
    }

    /// Statuses that change here and there, once nearly everywhere: corrected solutions, corrected inverses, new ones.
    #[test]
    fn every_solution_is_that_of_the_whole_matrix() {
        for integration in [Integration::Lobatto, Integration::Gauss1] {
            let interface = interface(integration);
            let n = interface.count;
            let schur = Mat::from_fn(n, n, |i, j| if i == j { 30. } else { -0.2 / (1. + i.abs_diff(j) as f64) });
            let branches = [Matrix2::zeros(), Matrix2::new(20., 0., 0., 50.), Matrix2::new(0., -15., 0., 50.)];
            let mut tangents = vec![branches[1]; interface.points.len()];
            let mut inverse = Inverse::default();
            for round in 0..60 {
                let changes = if round == 30 { 70 } else { round % 7 };
                for k in 0..changes {
                    let point = (17 * round + 5 * k) % tangents.len();
                    tangents[point] = branches[(round + k) % 3];
                }
                let f: Vec<f64> =
                    (0..n).map(|i| if round % 2 == 0 || i < 3 { (i + round) as f64 } else { 0. }).collect();
                let x = inverse.solve(&schur, &interface, &tangents, &f);
                let mut product = dense_times(&schur, &x);
                for (point, d) in interface.points.iter().zip(&tangents) {
                    interface.tangent(point, d, |i, j, value| product[i] += value * x[j]);
                }
                let error = product.iter().zip(&f).fold(0., |e: f64, (p, f)| e.max((p - f).abs()));
                // Sixty corrections of a matrix of condition 10, f up to 140.
                assert!(error < 1e-10, "{integration:?}, round {round}: {error:e}");
            }
        }
    }
}
