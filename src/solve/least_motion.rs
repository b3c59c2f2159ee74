//! Statics: where joints leave a body a motion that nothing resists, the equilibrium of least motion is taken.
//!
//! A body that joints alone hold is tied by weak springs W to where it stood, u_0: K u + r(j) + W (u - u_0) = f. That is
//! solved again with u_0 = u until the springs carry nothing: then u is in equilibrium without them, and along motions
//! that nothing resists it is where it was.

use super::system::System;
use super::unknowns::Unknowns;
use crate::model::hold::{Part, held_by_joints};
use crate::model::resolve::Model;
use crate::sparse::vector::norm;
use nalgebra::Matrix2;
use std::borrow::Cow;
use std::sync::Arc;

/// Stiffness of the springs over that of the softest joint, closed and no stiffer than the bodies beside it. A larger share
/// takes more rounds; a smaller one leaves more of where a free body stands to round-off, which over the default case's
/// steel rings is 1e-11 of the forces, 1e-13 over this of the displacements.
pub const SHARE: f64 = 1e-6;

/// A body that joints alone hold.
#[derive(Debug, Clone, PartialEq)]
pub struct Loose {
    /// its surfaces
    pub name: String,
    /// the rigid motions that supports leave it
    pub motions: Vec<(Way, Motion)>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Way {
    X,
    Y,
    Turn,
}

/// (unknown, displacement [m]) of the body's nodes at interfaces.
pub type Motion = Vec<(usize, f64)>;

impl Loose {
    /// Boundaries that let waves out hold the ground here, as they do without inertia.
    pub fn all(model: &Model, unknowns: &Unknowns) -> Arc<[Loose]> {
        let model = &if model.absorbers.is_empty() { Cow::Borrowed(model) } else { Cow::Owned(model.held()) };
        let body = |part: Part| {
            let at_border = |&n: &usize| unknowns.of(n, 0).or(unknowns.of(n, 1)).is_some_and(|i| i >= unknowns.border);
            let nodes: Vec<usize> = part.nodes.iter().copied().filter(at_border).collect();
            Loose { name: part.name(), motions: motions(model, unknowns, &nodes, &part.nodes) }
        };
        held_by_joints(model).into_iter().map(body).filter(|body| !body.motions.is_empty()).collect()
    }

    fn unknowns(&self) -> impl Iterator<Item = usize> + '_ {
        self.motions.iter().flat_map(|(_, motion)| motion.iter().map(|&(unknown, _)| unknown))
    }
}

/// A shift along each axis that no support holds, and a turn about the middle where nothing is held at all; the farthest
/// node goes 1 m.
fn motions(model: &Model, unknowns: &Unknowns, nodes: &[usize], of_part: &[usize]) -> Vec<(Way, Motion)> {
    let middle = [0, 1].map(|i| nodes.iter().map(|&n| model.mesh.points[n][i]).sum::<f64>() / nodes.len() as f64);
    let arm = |n: usize| [0, 1].map(|i| model.mesh.points[n][i] - middle[i]);
    let farthest = nodes.iter().map(|&n| arm(n)[0].hypot(arm(n)[1])).fold(f64::MIN_POSITIVE, f64::max);
    let displacement = |way: Way, n: usize| match way {
        Way::X => [1., 0.],
        Way::Y => [0., 1.],
        Way::Turn => [-arm(n)[1] / farthest, arm(n)[0] / farthest],
    };
    let held = [0, 1].map(|axis| of_part.iter().any(|&n| model.fixed[n][axis]));
    let is_free = |way: &Way| match way {
        Way::X => !held[0],
        Way::Y => !held[1],
        Way::Turn => held == [false; 2],
    };
    let motion = |way: Way| {
        let of_node = |&n: &usize| {
            [0, 1].into_iter().filter_map(move |axis| Some((unknowns.of(n, axis)?, displacement(way, n)[axis])))
        };
        (way, nodes.iter().flat_map(of_node).collect())
    };
    let ways = [Way::X, Way::Y, Way::Turn].into_iter().filter(is_free);
    ways.map(motion).filter(|(_, motion): &(Way, Motion)| !motion.is_empty()).collect()
}

/// W.
#[derive(Debug, Clone)]
pub struct Springs {
    /// of every unknown at the border [N/m]
    stiffness: Arc<[f64]>,
    bodies: Arc<[Loose]>,
    border: usize,
}

impl Springs {
    /// `closed`: the stiffness of every joint point, closed [Pa/m]. None where supports hold every body.
    pub fn new(system: &System, closed: &[Matrix2<f64>]) -> Option<Springs> {
        let Unknowns { border, count, sides, .. } = &*system.unknowns;
        let mut is_loose = vec![false; count - border];
        system.loose.iter().flat_map(Loose::unknowns).for_each(|i| is_loose[i - border] = true);
        let mut stiffness = vec![0.; count - border];
        // A body may be held through others, by the softest joint of all.
        let softest = closed.iter().map(|d| d[(1, 1)]).fold(f64::INFINITY, f64::min);
        for point in &system.interface.points {
            // alike along both axes, whatever the joint's direction
            system.interface.tangent(point, &Matrix2::from_diagonal_element(SHARE * softest), |i, j, value| {
                if i == j {
                    sides
                        .of(i)
                        .filter(|(row, _)| is_loose[row - border])
                        .for_each(|(row, _)| stiffness[row - border] += value);
                }
            });
        }
        let (bodies, border) = (system.loose.clone(), *border);
        (!bodies.is_empty()).then(|| Springs { stiffness: stiffness.into(), bodies, border })
    }

    /// (unknown, stiffness [N/m]) of every spring.
    pub fn on_diagonal(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.stiffness.iter().enumerate().filter(|(_, w)| **w > 0.).map(|(i, &w)| (self.border + i, w))
    }

    /// W u [N] of displacements of the border.
    pub fn forces(&self, u: &[f64]) -> Vec<f64> {
        self.stiffness.iter().zip(u).map(|(w, u)| w * u).collect()
    }

    /// The body that such forces pull most, by its number.
    pub fn most_pulled(&self, forces: &[f64]) -> usize {
        let of_body = |body: &Loose| norm(&body.unknowns().map(|i| forces[i - self.border]).collect::<Vec<_>>());
        let bodies = self.bodies.iter().map(of_body).enumerate();
        bodies.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(number, _)| number)
    }
}
