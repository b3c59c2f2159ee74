//! Motions that no joint resists: where a body has one, equilibrium without inertia is not unique.

use super::free_body::{FreeBody, Way};
use super::least_motion::SHARE;
use super::system::{State, System};
use crate::physics::joint::Friction;
use crate::sparse::vector::ratio;
use nalgebra::{DMatrix, Matrix2, Vector2};
use std::sync::Arc;

/// Opening up to which a joint touches, over the jump that the largest force of the run makes where all joints are
/// closed: what a load that has ended leaves is round-off.
const TOUCHES: f64 = 1e-6;

/// What a body can do without resistance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Free {
    /// it touches nothing
    Everywhere,
    /// this motion, alone or with other bodies
    Along(Way),
}

/// The rigid motions of all bodies that joints alone hold, as joints see them.
pub struct FreeMotions {
    bodies: Arc<[FreeBody]>,
    /// (number of the body, way) of each motion
    motions: Vec<(usize, Way)>,
    /// of each joint point the (motion, g) that move it, g the local jump at 1 m
    seen: Vec<Vec<(usize, Vector2<f64>)>>,
    /// stiffness of each point closed, and without friction [N/m]
    closed: Vec<[Matrix2<f64>; 2]>,
    /// of all points together [N/m]
    stiffness: f64,
}

impl FreeMotions {
    pub fn new(system: &System) -> FreeMotions {
        let interface = &system.interface;
        let mut motions = Vec::new();
        let mut seen = vec![Vec::new(); interface.points.len()];
        for (body, (way, motion)) in system
            .free_bodies
            .iter()
            .enumerate()
            .flat_map(|(i, body)| body.motions.iter().map(move |motion| (i, motion)))
        {
            let mut u = vec![0.; system.unknowns.count];
            motion.iter().for_each(|&(unknown, displacement)| u[unknown] = displacement);
            let jumps = system.unknowns.sides.differences(&u);
            for (point, seen) in interface.points.iter().zip(&mut seen) {
                let g = interface.local(point, &jumps);
                (g != Vector2::zeros()).then(|| seen.push((motions.len(), g)));
            }
            motions.push((body, *way));
        }
        let closed: Vec<_> = (system.closed_joints_as_stiff_as_bodies().iter().zip(&interface.points))
            .map(|(d, point)| {
                let sticking = d * point.area;
                let slides = matches!(point.law.friction, Friction::Coulomb(f) if f == 0.);
                let tau = if slides { 0. } else { sticking[(0, 0)] };
                [sticking, Matrix2::new(tau, 0., 0., sticking[(1, 1)])]
            })
            .collect();
        let stiffness = closed.iter().map(|[d, _]| d[(1, 1)]).sum();
        FreeMotions { bodies: system.free_bodies.clone(), motions, seen, closed, stiffness }
    }

    /// Those that the joints leave, by body: eigenvalues below [`SHARE`] of A = sum area g' D g over the
    /// joint points that touch, in proportion to its diagonal where all are closed and stick. What has friction sticks here
    /// too: a joint that slips resists the way back.
    pub fn of(&self, touches: &[bool]) -> Vec<(&FreeBody, Free)> {
        let touched: Vec<bool> =
            (0..self.bodies.len()).map(|body| self.points_of(body).any(|point| touches[point])).collect();
        let nowhere = (0..self.bodies.len()).filter(|&body| !touched[body] && self.points_of(body).next().is_some());
        let mut free: Vec<(usize, Free)> = nowhere.map(|body| (body, Free::Everywhere)).collect();
        let held: Vec<usize> = (0..self.motions.len()).filter(|&m| touched[self.motions[m].0]).collect();
        if !held.is_empty() {
            let whole = self.resistance(&|point| self.closed[point][0]);
            let left = self.resistance(&|point| if touches[point] { self.closed[point][1] } else { Matrix2::zeros() });
            let scaled = |i: usize, j: usize| ratio(left[(i, j)], (whole[(i, i)] * whole[(j, j)]).sqrt());
            let eigen = DMatrix::from_fn(held.len(), held.len(), |i, j| scaled(held[i], held[j])).symmetric_eigen();
            let unresisted = (0..held.len()).filter(|&k| eigen.eigenvalues[k] < SHARE);
            free.extend(
                unresisted
                    .map(|k| self.motions[held[eigen.eigenvectors.column(k).iamax()]])
                    .map(|(body, way)| (body, Free::Along(way))),
            );
        }
        free.sort_unstable();
        free.dedup();
        free.into_iter().map(|(body, free)| (&self.bodies[body], free)).collect()
    }

    /// Which joint points touch in a state.
    pub fn touching(&self, system: &System, state: &State) -> Vec<bool> {
        let at_most = TOUCHES * state.largest_force / self.stiffness;
        let jumps = system.jumps(&state.q);
        let opening = |point| system.interface.local(point, jumps)[1] + point.law.gap;
        system.interface.points.iter().map(|point| opening(point) <= at_most).collect()
    }

    fn points_of(&self, body: usize) -> impl Iterator<Item = usize> + '_ {
        let moves = move |&(motion, _): &(usize, Vector2<f64>)| self.motions[motion].0 == body;
        (0..self.seen.len()).filter(move |&point| self.seen[point].iter().any(moves))
    }

    /// A = sum area g' D g [N/m], area D of a point given.
    fn resistance(&self, of_point: &dyn Fn(usize) -> Matrix2<f64>) -> DMatrix<f64> {
        let mut a = DMatrix::zeros(self.motions.len(), self.motions.len());
        for (point, seen) in self.seen.iter().enumerate() {
            let d = of_point(point);
            for (i, g_i) in seen {
                seen.iter().for_each(|(j, g_j)| a[(*i, *j)] += g_i.dot(&(d * g_j)));
            }
        }
        a
    }
}
