//! What the ground beyond a side does to the model: the side's dashpots act on the difference from its motion, and its
//! lateral stress presses on the side.
//!
//! A column of the same layers moves up and down as under the load alone, u_x = 0. With n_x of the outward normal, the
//! traction on the side is t_x = n_x s_xx - rho c_p v_x, t_y = -rho c_s (v_y - v_y') with v' of the column and s_xx =
//! lambda (e + beta e'), e = du_y'/dy and e' its rate. The terms in v_x and v_y are dashpots of the model's own C;
//! those of the column are forces known before the model's step, since the column knows nothing of the model. Each rho
//! c v comes with its share of Rayleigh damping: see [`System::with_damping`].

use super::assembly::{corners, dashpot_block};
use super::system::{Rayleigh, State, System};
use super::unknowns::Unknowns;
use super::unsettled::{Place, Unsettled};
use crate::Result;
use crate::model::absorbing::Absorber;
use crate::model::free_field::FreeField;
use crate::model::resolve::Model;
use crate::physics::element;
use crate::physics::shape::Shape;
use crate::sparse::{Orders, Symbolic, multiply};
use sprs::{CsMat, TriMat};
use std::sync::Arc;

/// The column beyond one side, and its forces on the side.
pub struct Column {
    pub system: System,
    pub symbolic: Arc<Symbolic>,
    /// for each node of the column the node of the side at its height
    origin: Vec<usize>,
    /// the model's unknowns that the forces act on, a row each of the two matrices
    unknowns: Vec<usize>,
    /// forces of n_x s_xx per displacement of the column [N/m]
    pressure: CsMat<f64>,
    /// forces of rho c_s v_y' per velocity of the column [N s/m]
    drag: CsMat<f64>,
}

impl Column {
    pub fn new(model: &Model, unknowns: &Unknowns, side: &FreeField, orders: &Orders) -> Result<Column> {
        let system = System::ordered(&side.column, orders)?;
        let on_side = side.twin.keys().flat_map(|&node| [unknowns.of(node, 0), unknowns.of(node, 1)]);
        let mut own: Vec<usize> = on_side.flatten().collect();
        own.sort_unstable();
        let size = (own.len(), system.unknowns.count);
        let (mut pressure, mut drag) = (TriMat::new(size), TriMat::new(size));
        for (a, b, axis, value) in side.lines.iter().flat_map(|line| couplings(model, line, side.outward)) {
            let matrix = if axis == 0 { &mut pressure } else { &mut drag };
            if let (Some(i), Some(j)) = (unknowns.of(a, axis), system.unknowns.of(side.twin[&b], 1)) {
                let row = own.binary_search(&i).expect("the unknowns of all nodes of the side are there");
                matrix.add_triplet(row, j, value);
            }
        }
        Ok(Column {
            symbolic: system.symbolic().into(),
            origin: side.origin.clone(),
            unknowns: own,
            pressure: pressure.to_csr(),
            drag: drag.to_csr(),
            system,
        })
    }

    /// The column of a model that differs from this one's in its loads only.
    pub fn with_loads_of(&self, side: &FreeField) -> Result<Column> {
        Ok(Column {
            system: self.system.with_loads_of(&side.column)?,
            symbolic: self.symbolic.clone(),
            origin: self.origin.clone(),
            unknowns: self.unknowns.clone(),
            pressure: self.pressure.clone(),
            drag: self.drag.clone(),
        })
    }

    pub fn with_damping(self, rayleigh: Rayleigh) -> Column {
        Column { system: self.system.with_damping(rayleigh, false), ..self }
    }

    /// (unknown of the model, force on it [N]) of n_x s_xx + rho c_s (v' + alpha u' / 2) in a state of the column.
    pub fn force(&self, State { q, v, .. }: &State) -> impl Iterator<Item = (usize, f64)> {
        let Rayleigh { alpha, beta } = self.system.rayleigh;
        let sum =
            |x: &[f64], factor: f64, y: &[f64]| -> Vec<f64> { x.iter().zip(y).map(|(x, y)| x + factor * y).collect() };
        let pressure = multiply(&self.pressure, &sum(q, beta, v));
        let drag = multiply(&self.drag, &sum(v, alpha / 2., q));
        self.unknowns.iter().copied().zip(pressure.into_iter().zip(drag).map(|(p, d)| p + d))
    }

    /// The same of rho c_s beta a' / 2.
    pub fn inertia(&self, state: &State) -> impl Iterator<Item = (usize, f64)> {
        let factor = self.system.rayleigh.beta / 2.;
        self.unknowns.iter().copied().zip(multiply(&self.drag, &state.a).into_iter().map(move |f| factor * f))
    }

    /// The same of the side's nodes: the column's are not the model's.
    pub fn on_side(&self, why: Unsettled) -> Unsettled {
        match why {
            Unsettled::Overflow(Place::Node(node)) => Unsettled::Overflow(Place::Node(self.origin[node])),
            other => other,
        }
    }

    /// The up and down part of the side's motion, at the column's nodes.
    pub fn own(&self, nodal: &[[f64; 2]]) -> Vec<[f64; 2]> {
        self.origin.iter().map(|&node| [0., nodal[node][1]]).collect()
    }
}

/// (a, b, axis, value) for nodes a, b of a line: along x n_x lambda of the integral of N_a dN_b/dy ds, along y rho c_s
/// of that of N_a N_b ds.
fn couplings(
    model: &Model,
    Absorber { line, material, .. }: &Absorber,
    outward: f64,
) -> Vec<(usize, usize, usize, f64)> {
    let at = corners(model, &line.nodes);
    let lambda = material.oedometric_modulus() - 2. * material.shear_modulus();
    let z_s = material.density * material.s_speed();
    let mut found = Vec::new();
    for (a, &node_a) in line.nodes.iter().enumerate() {
        for (b, &node_b) in line.nodes.iter().enumerate() {
            let along_y = dashpot_block(&at, line.shape, [0., z_s], a, b)[1][1];
            let upwards = (at[1][1] - at[0][1]).signum();
            found.push((node_a, node_b, 0, outward * lambda * upwards * slope(line.shape, a, b)));
            found.push((node_a, node_b, 1, along_y));
        }
    }
    found
}

/// Integral of N_a dN_b/dr dr over a line; times the sign of dy/dr it is that of N_a dN_b/dy ds.
fn slope(shape: Shape, a: usize, b: usize) -> f64 {
    let at = |r: f64| shape.functions([r, 0.]);
    element::gauss_3().into_iter().map(|(r, weight)| weight * at(r)[a].0 * at(r)[b].1[0]).sum()
}
