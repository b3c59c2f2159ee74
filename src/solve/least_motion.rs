//! Statics: where joints leave a body a motion that nothing resists, the equilibrium of least motion is taken.
//!
//! A body that joints alone hold is tied by weak springs W to where it stood, u_0: K u + r(j) + W (u - u_0) = f. That is
//! solved again with u_0 = u until the springs carry nothing: then u is in equilibrium without them, and along motions
//! that nothing resists it is where it was.

use super::system::System;
use super::unknowns::Unknowns;
use crate::sparse::vector::{dot, norm, ratio};
use nalgebra::Matrix2;
use std::sync::Arc;

/// Stiffness of the springs over that of the body's softest joint, closed and no stiffer than the bodies beside it. A larger share
/// takes more rounds; a smaller one leaves more of where a free body stands to round-off, which over the default case's
/// steel rings is 1e-11 of the forces, 1e-13 over this of the displacements.
pub const SHARE: f64 = 1e-6;

/// A body whose springs carry more than this share of what they carried a round before falls freely: what else holds
/// it, if anything, is softer than a thousandth of the springs.
const FALLS_FREELY: f64 = 0.999;

/// The bodies that joints connect, without what supports hold: one may be held through another, and they may move freely
/// together.
struct Groups {
    /// for each body the number of its group, that of its first body
    of_bodies: Vec<usize>,
    /// stiffness of the softest joint of each group [Pa/m]
    softest: Vec<f64>,
}

impl Groups {
    fn new(system: &System, closed: &[Matrix2<f64>], body_of: &[Option<usize>]) -> Groups {
        let Unknowns { border, sides, .. } = &*system.unknowns;
        let bodies_at = |point| -> Vec<usize> {
            let rows = system.interface.places(point).flat_map(|place| sides.of(place)).map(|(row, _)| row);
            rows.filter_map(|row| body_of[row - border]).collect()
        };
        let at_points: Vec<Vec<usize>> = system.interface.points.iter().map(bodies_at).collect();
        let mut of_bodies: Vec<usize> = (0..system.free_bodies.len()).collect();
        loop {
            let before = of_bodies.clone();
            for bodies in &at_points {
                let first = bodies.iter().map(|&body| of_bodies[body]).min();
                first.iter().for_each(|&first| bodies.iter().for_each(|&body| of_bodies[body] = first));
            }
            if of_bodies == before {
                break;
            }
        }
        let mut softest = vec![f64::INFINITY; of_bodies.len()];
        for (bodies, d) in at_points.iter().zip(closed) {
            bodies.iter().map(|&body| of_bodies[body]).for_each(|g| softest[g] = f64::min(softest[g], d[(1, 1)]));
        }
        Groups { of_bodies, softest }
    }
}

/// W.
#[derive(Debug, Clone)]
pub struct Springs {
    /// of every unknown at the border [N/m]
    stiffness: Arc<[f64]>,
    /// number of the body that every unknown at the border moves, if any
    body_of: Arc<[Option<usize>]>,
    /// the same of its group
    group_of: Arc<[Option<usize>]>,
    /// number of bodies
    bodies: usize,
    border: usize,
}

impl Springs {
    /// `closed`: the stiffness of every joint point, closed [Pa/m]. None where supports hold every body.
    pub fn new(system: &System, closed: &[Matrix2<f64>]) -> Option<Springs> {
        let Unknowns { border, count, sides, .. } = &*system.unknowns;
        let mut body_of = vec![None; count - border];
        for (number, body) in system.free_bodies.iter().enumerate() {
            body.unknowns().for_each(|i| body_of[i - border] = Some(number));
        }
        let mut stiffness = vec![0.; count - border];
        let groups = Groups::new(system, closed, &body_of);
        let group_of: Vec<_> = body_of.iter().map(|body| body.map(|body: usize| groups.of_bodies[body])).collect();
        for point in &system.interface.points {
            // the same along both axes, whatever the joint's direction
            system.interface.tangent(point, &Matrix2::identity(), |i, j, area| {
                if i == j {
                    for (row, _) in sides.of(i) {
                        let of_group = |group: usize| SHARE * groups.softest[group] * area;
                        stiffness[row - border] += group_of[row - border].map_or(0., of_group);
                    }
                }
            });
        }
        let (bodies, border) = (system.free_bodies.len(), *border);
        (bodies > 0).then(|| Springs {
            stiffness: stiffness.into(),
            body_of: body_of.into(),
            group_of: group_of.into(),
            bodies,
            border,
        })
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
        let pulled = (0..self.bodies).map(|body| norm(&part(forces, &self.body_of, body))).enumerate();
        pulled.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(number, _)| number)
    }

    /// The largest displacement of a body along an axis, from one state of the border to another [m].
    pub fn travel(&self, from: &[f64], to: &[f64]) -> f64 {
        let of_bodies = from.iter().zip(to).zip(self.body_of.iter()).filter(|(_, body)| body.is_some());
        of_bodies.map(|((from, to), _)| (to - from).abs()).fold(0., f64::max)
    }

    /// For each group, as [`Springs::further`]: u_0 goes to the solution.
    pub fn no_further(&self) -> Vec<f64> {
        vec![0.; self.bodies]
    }

    /// For each group of bodies how far beyond the solution u its u_0 goes, over u - u_0: one factor for all that can move
    /// freely together, so that u_0 does not move along with it. Springs of the model make the forces W (u - u_0) fall by a
    /// factor q each round, and q / (1 - q) is the limit of that series. Where the forces do not fall, a
    /// body falls freely: u_0 goes twice as far as the round `before`, until joints stop it and the forces turn round.
    /// Forces of `round_off` say nothing.
    pub fn further(&self, before: &[f64], forces: &[f64], forces_before: &[f64], round_off: f64) -> Vec<f64> {
        let of_group = |group: usize| {
            let [now, then] = [forces, forces_before].map(|forces| part(forces, &self.group_of, group));
            let q = ratio(dot(&now, &then), dot(&then, &then));
            match norm(&now) > round_off && q > 0. {
                true if q > FALLS_FREELY => f64::max(1., 2. * before[group]),
                true => q / (1. - q),
                false => 0.,
            }
        };
        (0..self.bodies).map(of_group).collect()
    }

    /// u <- u + factor moved, each group with its own factor.
    pub fn add_to_groups(&self, u: &mut [f64], factors: &[f64], moved: &[f64]) {
        for ((u, moved), group) in u.iter_mut().zip(moved).zip(self.group_of.iter()) {
            group.iter().for_each(|&group| *u += factors[group] * moved);
        }
    }
}

/// The part of a vector at the border that belongs to a body or group.
fn part(x: &[f64], owners: &[Option<usize>], owner: usize) -> Vec<f64> {
    x.iter().zip(owners).filter(|(_, of)| **of == Some(owner)).map(|(x, _)| *x).collect()
}
