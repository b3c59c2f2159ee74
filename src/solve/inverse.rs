//! Solves with S + sum area N' R' D R N for the many sets of joint tangents D that a run goes through.
//!
//! The inverse for one set is kept, dense; where few joints differ from it, Woodbury's formula corrects the solution,
//! and where many do, the inverse itself. So a change of status costs by what changed, not by the number of joints.
//! Except where joints alone hold a body: once they slip all round it, nothing keeps it from turning but a billionth of
//! their stiffness, and what such a matrix is corrected to, or from, has no digits for that turn.

use super::interface::{Interface, JointPoint};
use crate::sparse::columns::add_columns;
use faer::linalg::solvers::{DenseSolveCore, PartialPivLu, Solve};
use faer::{Accum, ColMut, Mat, Par};
use nalgebra::{Matrix2, Vector2};

/// A change of no more dyads than unknowns over this is left to correct each solution; one of more corrects the inverse.
/// With 256 unknowns G costs 14 us for 16 dyads, 30 us for 32 and 75 us for 64, and often they are gone again in the next
/// iteration. The inverse is corrected in 10 us a dyad.
const MANY: usize = 8;

/// One of more than this times as many makes a new inverse, which costs as much as correcting one by 200 dyads of 256
/// unknowns. But where all points begin to slip, a dyad for every other unknown, and nothing else holds a body, what is
/// left of the old inverse has no digits.
const TOO_MANY: usize = 3;

pub struct Inverse {
    /// whether every set of tangents has an inverse of its own
    exact: bool,
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
    pub fn new(exact: bool) -> Inverse {
        Inverse { exact, kept: None, change: None }
    }

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
        let many = interface.count / MANY;
        match self.kept.take() {
            Some(kept) if kept.tangents == tangents => (self.kept, self.change) = (Some(kept), None),
            Some(kept) if self.change.as_ref().is_some_and(|change| change.to == tangents) => self.kept = Some(kept),
            Some(kept) if !self.exact => {
                let dyads = dyads_between(interface, &kept.tangents, tangents);
                (self.kept, self.change) = match dyads.len() {
                    n if n <= many => {
                        let change = Change::new(&kept, tangents, dyads);
                        (Some(kept), Some(change))
                    }
                    n if n <= TOO_MANY * many => {
                        let change = Change::new(&kept, tangents, dyads);
                        (Some(kept.corrected(change)), None)
                    }
                    _ => (Some(Kept::new(schur, interface, tangents)), None),
                };
            }
            _ => (self.kept, self.change) = (Some(Kept::new(schur, interface, tangents)), None),
        }
    }
}

#[cfg(test)]
impl Inverse {
    /// As many corrections may leave it: of the right tangents, but not exact.
    pub fn wear(&mut self, factor: f64) {
        let kept = self.kept.as_mut().expect("it was solved with");
        kept.inverse = faer::Scale(factor) * &kept.inverse;
        kept.fresh = false;
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

    /// R - R U G^-1 V'R.
    fn corrected(self, Change { to, dyads, system }: Change) -> Kept {
        let mut inverse = self.inverse;
        let mut left = Mat::zeros(inverse.nrows(), dyads.len());
        let mut right = Mat::from_fn(dyads.len(), inverse.ncols(), |a, j| dyads[a].seen_in(inverse.col_as_slice(j)));
        dyads.iter().enumerate().for_each(|(a, d)| add_columns(left.col_as_slice_mut(a), &inverse, &d.left));
        system.solve_in_place(&mut right);
        faer::linalg::matmul::matmul(&mut inverse, Accum::Add, &left, &right, -1., Par::Seq);
        Kept { tangents: to, inverse, fresh: false }
    }

    /// R f.
    fn times(&self, f: &[f64]) -> Vec<f64> {
        dense_times(&self.inverse, f)
    }
}

/// Part of what a joint point's tangent adds to the matrix: left right', both by (place, value).
struct Dyad {
    /// [m^2]
    left: Vec<(usize, f64)>,
    /// [Pa/m]
    right: Vec<(usize, f64)>,
}

impl Dyad {
    fn new(interface: &Interface, point: &JointPoint, u: Vector2<f64>, v: Vector2<f64>) -> Dyad {
        Dyad { left: interface.pulls(point, u * point.area), right: interface.pulls(point, v) }
    }

    /// right'x
    fn seen_in(&self, x: &[f64]) -> f64 {
        self.right.iter().map(|&(i, value)| value * x[i]).sum()
    }
}

/// What tangents add to the matrix of others. Between sticking and slipping a row of D changes, between slipping and
/// open a column: one dyad each.
fn dyads_between(interface: &Interface, from: &[Matrix2<f64>], to: &[Matrix2<f64>]) -> Vec<Dyad> {
    let mut dyads = Vec::new();
    for ((point, from), to) in interface.points.iter().zip(from).zip(to).filter(|((_, from), to)| from != to) {
        dyads.extend(dyads_of(&(to - from)).map(|(u, v)| Dyad::new(interface, point, u, v)));
    }
    dyads
}

/// (u, v) with sum u v' = D: by the rows of D, or by its columns if one of them is zero. |u| = 1 in both, so that rows
/// and columns give entries of G of one size: otherwise half of its digits are lost.
fn dyads_of(d: &Matrix2<f64>) -> impl Iterator<Item = (Vector2<f64>, Vector2<f64>)> + use<> {
    let axes = [Vector2::x(), Vector2::y()];
    let rows = axes.map(|axis| (axis, d.tr_mul(&axis)));
    let columns = axes.map(|axis| (d * axis, axis));
    let is_not_zero = |(u, v): &(Vector2<f64>, Vector2<f64>)| *u != Vector2::zeros() && *v != Vector2::zeros();
    let fewer = if columns.iter().all(is_not_zero) { rows } else { columns };
    fewer.into_iter().filter(is_not_zero).map(|(u, v)| (u / u.norm(), v * u.norm()))
}

/// What some joint points' tangents add to the matrix: U V', a column of both for each dyad. Its inverse is
/// R - R U G^-1 V'R, G = 1 + V'R U.
struct Change {
    /// D of every joint point [Pa/m]
    to: Vec<Matrix2<f64>>,
    dyads: Vec<Dyad>,
    /// G
    system: PartialPivLu<f64>,
}

impl Change {
    fn new(kept: &Kept, to: &[Matrix2<f64>], dyads: Vec<Dyad>) -> Change {
        let through = |a: &Dyad, b: &Dyad| -> f64 {
            b.left.iter().map(|&(j, value)| value * a.seen_in(kept.inverse.col_as_slice(j))).sum()
        };
        let unit = |a: usize, b: usize| if a == b { 1. } else { 0. };
        let count = dyads.len();
        let system = Mat::from_fn(count, count, |a, b| unit(a, b) + through(&dyads[a], &dyads[b]));
        Change { to: to.to_vec(), system: system.partial_piv_lu(), dyads }
    }

    /// x - R U G^-1 V'x.
    fn correct(&self, x: &mut [f64], inverse: &Mat<f64>) {
        let mut weights: Vec<f64> = self.dyads.iter().map(|dyad| dyad.seen_in(x)).collect();
        self.system.solve_in_place(ColMut::from_slice_mut(&mut weights));
        let mut pulled = vec![0.; x.len()];
        for (dyad, weight) in self.dyads.iter().zip(&weights) {
            dyad.left.iter().for_each(|&(i, value)| pulled[i] -= value * weight);
        }
        add_columns(x, inverse, &not_zero(&pulled));
    }
}

/// A x. Zeros in x cost nothing.
pub fn dense_times(a: &Mat<f64>, x: &[f64]) -> Vec<f64> {
    let mut product = vec![0.; a.nrows()];
    add_columns(&mut product, a, &not_zero(x));
    product
}

fn not_zero(x: &[f64]) -> Vec<(usize, f64)> {
    x.iter().copied().enumerate().filter(|(_, x)| *x != 0.).collect()
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
        let jumps: Vec<_> = (0..PAIRS).map(|p| [vec![(2 * p, 1.)], vec![(2 * p + 1, 1.)]]).collect();
        Interface::new(&mesh, &pairs, &joints, &vec![(law, integration); joints.len()], &jumps)
    }

    #[test]
    fn a_point_that_begins_to_slip_or_opens_from_slip_changes_the_matrix_by_one_dyad() {
        let interface = interface(Integration::Lobatto);
        let [open, sticks, slips] =
            [[0.; 4], [20., 0., 0., 50.], [0., -15., 0., 50.]].map(|[a, b, c, d]| Matrix2::new(a, b, c, d));
        let dyads = |from, to| {
            let of_all = |d| vec![d; interface.points.len()];
            dyads_between(&interface, &of_all(from), &of_all(to)).len() / interface.points.len()
        };
        assert_eq!([dyads(sticks, slips), dyads(slips, open), dyads(open, sticks)], [1, 1, 2]);
        assert_eq!(dyads(slips, slips), 0);
    }

    /// One dyad each: a body that nothing else holds can turn then, and G is singular but for round-off.
    #[test]
    fn points_that_all_begin_to_slip_make_a_new_inverse() {
        let interface = interface(Integration::Lobatto);
        let matrix = Mat::from_fn(interface.count, interface.count, |i, j| if i == j { 30. } else { 0. });
        let f = vec![1.; interface.count];
        let mut inverse = Inverse::new(false);
        let mut after = |d: Matrix2<f64>| {
            inverse.solve(&matrix, &interface, &vec![d; interface.points.len()], &f);
            inverse.is_corrected()
        };
        assert!(!after(Matrix2::new(20., 0., 0., 50.)) && !after(Matrix2::new(0., -15., 0., 50.)));
    }

    #[test]
    fn points_that_go_back_to_where_they_were_have_their_old_solution() {
        let interface = interface(Integration::Lobatto);
        let matrix = Mat::from_fn(interface.count, interface.count, |i, j| if i == j { 30. } else { 0. });
        let f = vec![1.; interface.count];
        let before = vec![Matrix2::new(20., 0., 0., 50.); interface.points.len()];
        let mut changed = before.clone();
        changed[7] = Matrix2::zeros();
        let mut inverse = Inverse::new(false);
        let [first, other, last] =
            [&before, &changed, &before].map(|d| (inverse.solve(&matrix, &interface, d, &f), inverse.is_corrected()));
        assert!(!first.1 && other.1 && first.0 != other.0);
        assert_eq!(first, last);
    }

    #[test]
    fn an_inverse_that_was_corrected_is_told_and_can_be_forgotten() {
        let interface = interface(Integration::Lobatto);
        let matrix = Mat::from_fn(interface.count, interface.count, |i, j| if i == j { 30. } else { 0. });
        let f = vec![1.; interface.count];
        let before = vec![Matrix2::new(20., 0., 0., 50.); interface.points.len()];
        let mut changed = before.clone();
        // two dyads each: too many to correct solutions, too few for a new inverse
        changed[..6].fill(Matrix2::zeros());
        let mut inverse = Inverse::new(false);
        for d in [&before, &changed] {
            inverse.solve(&matrix, &interface, d, &f);
        }
        assert!(inverse.change.is_none() && inverse.is_corrected());
        inverse.forget();
        inverse.solve(&matrix, &interface, &changed, &f);
        assert!(!inverse.is_corrected());
    }

    /// A body that springs hold together, and nothing else than joints holds in place, falls: all of them are open, then
    /// a third of them close. The matrix goes from nearly singular to singular along the joints only, and there
    /// corrections have no digits.
    #[test]
    fn a_body_that_hangs_on_joints_alone_needs_an_inverse_for_every_set_of_tangents() {
        let interface = interface(Integration::Lobatto);
        let n = interface.count;
        // springs between neighbours, stiffer across the line than along it and inclined to both
        let spring = [[30., 10.], [10., 60.]];
        let mut schur = Mat::<f64>::zeros(n, n);
        for p in 1..PAIRS {
            for (a, b, sign) in [(p, p, 1.), (p - 1, p - 1, 1.), (p, p - 1, -1.), (p - 1, p, -1.)] {
                (0..2).for_each(|i| (0..2).for_each(|j| schur[(2 * a + i, 2 * b + j)] += sign * spring[i][j]));
            }
        }
        let [open, slips] = [50e-9, 50.].map(|normal| Matrix2::new(20e-9, 0., 0., normal));
        let mut tangents = vec![open; interface.points.len()];
        let f: Vec<f64> = (0..n).map(|i| (i % 2) as f64).collect();
        let [mut exact, mut corrected] = [true, false].map(Inverse::new);
        for inverse in [&mut exact, &mut corrected] {
            inverse.solve(&schur, &interface, &tangents, &f);
        }
        tangents[..PAIRS / 3].fill(slips);
        let [new, exact, corrected] =
            [&mut Inverse::new(true), &mut exact, &mut corrected].map(|i| i.solve(&schur, &interface, &tangents, &f));
        assert_eq!(exact, new);
        let off = corrected.iter().zip(&new).map(|(c, n)| (c - n).abs() / n.abs()).fold(0., f64::max);
        assert!(off > 1e-6, "corrections lose {off:e} only: they would do");
    }

    /// Statuses that change here and there, once nearly everywhere: corrected solutions, corrected inverses, new ones.
    #[test]
    fn every_solution_is_that_of_the_whole_matrix() {
        // the default case's joints have 3e9 Pa/m
        for (integration, scale) in [(Integration::Lobatto, 1.), (Integration::Gauss1, 1.), (Integration::Lobatto, 1e8)]
        {
            let interface = interface(integration);
            let n = interface.count;
            let entry = |i: usize, j: usize| if i == j { 30. } else { -0.2 / (1. + i.abs_diff(j) as f64) };
            let schur = Mat::from_fn(n, n, |i, j| scale * entry(i, j));
            let branches =
                [[0.; 4], [20., 0., 0., 50.], [0., -15., 0., 50.]].map(|[a, b, c, d]| Matrix2::new(a, b, c, d) * scale);
            let mut tangents = vec![branches[1]; interface.points.len()];
            let mut inverse = Inverse::new(false);
            for round in 0..60 {
                let changes = if round == 30 { 70 } else { round % 7 };
                for k in 0..changes {
                    let point = (17 * round + 7 * k) % tangents.len();
                    tangents[point] = branches[(round + k / 2) % 3];
                }
                let f: Vec<f64> =
                    (0..n).map(|i| if round % 2 == 0 || i < 3 { (i + round) as f64 } else { 0. }).collect();
                let x = inverse.solve(&schur, &interface, &tangents, &f);
                let mut product = dense_times(&schur, &x);
                for (point, d) in interface.points.iter().zip(&tangents) {
                    interface.tangent(point, d, |i, j, value| product[i] += value * x[j]);
                }
                let exact = product.iter().zip(&f).all(|(p, f)| (p - f).abs() < 1e-10);
                // Corrections between a few new inverses of a matrix of condition 10, f up to 140.
                assert!(exact, "{integration:?}, {scale:e}, round {round}");
            }
        }
    }
}
