//! Statics: where joints leave a body a motion that nothing resists, the equilibrium of least motion is taken.
//!
//! A body that joints alone hold is tied by weak springs W to where it stood, u_0: K u + r(j) + W (u - u_0) = f. That is
//! solved again with u_0 = u until the springs carry nothing: then u is in equilibrium without them, and along motions
//! that nothing resists it is where it was.

use super::free_body::FreeBody;
use super::system::System;
use super::unknowns::Unknowns;
use crate::sparse::vector::norm;
use nalgebra::Matrix2;
use std::sync::Arc;

/// Stiffness of the springs over that of the softest joint, closed and no stiffer than the bodies beside it. A larger share
/// takes more rounds; a smaller one leaves more of where a free body stands to round-off, which over the default case's
/// steel rings is 1e-11 of the forces, 1e-13 over this of the displacements.
pub const SHARE: f64 = 1e-6;

/// W.
#[derive(Debug, Clone)]
pub struct Springs {
    /// of every unknown at the border [N/m]
    stiffness: Arc<[f64]>,
    bodies: Arc<[FreeBody]>,
    border: usize,
}

impl Springs {
    /// `closed`: the stiffness of every joint point, closed [Pa/m]. None where supports hold every body.
    pub fn new(system: &System, closed: &[Matrix2<f64>]) -> Option<Springs> {
        let Unknowns { border, count, sides, .. } = &*system.unknowns;
        let mut is_loose = vec![false; count - border];
        system.free_bodies.iter().flat_map(FreeBody::unknowns).for_each(|i| is_loose[i - border] = true);
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
        let (bodies, border) = (system.free_bodies.clone(), *border);
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
        let of_body = |body: &FreeBody| norm(&body.unknowns().map(|i| forces[i - self.border]).collect::<Vec<_>>());
        let bodies = self.bodies.iter().map(of_body).enumerate();
        bodies.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(number, _)| number)
    }
}
