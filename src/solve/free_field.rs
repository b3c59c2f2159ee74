//! What the ground beyond a side does to the model: the side's dashpots act on the difference from its motion, and its
//! lateral stress presses on the side.
//!
//! A column of the same layers moves up and down as under the load alone, u_x = 0. With n_x of the outward normal, the
//! traction on the side is t_x = n_x s_xx - rho c_p v_x, t_y = -rho c_s (v_y - v_y') with v' of the column and s_xx =
//! lambda (e + beta e'), e = du_y'/dy and e' its rate. The terms in v_x and v_y are dashpots of the model's own C;
//! those of the column are forces known before the model's step, since the column knows nothing of the model. Each rho
//! c v comes with its share of Rayleigh damping: see [`System::with_damping`].

use super::assembly::{corners, dashpot_block, stiffness_of_face};
use super::system::{Rayleigh, State, System};
use super::unknowns::Unknowns;
use super::unsettled::{Place, Unsettled};
use crate::Result;
use crate::model::absorbing::Absorber;
use crate::model::free_field::FreeField;
use crate::model::resolve::Model;
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
        let row =
            |unknown: usize| own.binary_search(&unknown).expect("the unknowns of all nodes of the side are there");
        for (a, b, value) in lateral_forces(side) {
            if let (Some(i), Some(j)) = (unknowns.of(a, 0), system.unknowns.of(b, 1)) {
                pressure.add_triplet(row(i), j, value);
            }
        }
        for (a, b, value) in side.lines.iter().flat_map(|line| shear_dashpots(model, line)) {
            if let (Some(i), Some(j)) = (unknowns.of(a, 1), system.unknowns.of(side.twin[&b], 1)) {
                drag.add_triplet(row(i), j, value);
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

/// (a, b, value) for a node a of the side and a node b of the column: the force on a along x per displacement of b along
/// y [N/m], n_x times the integral of N_a s_xx over the side.
///
/// The strip's left edge is held along x, and its nodal forces there are minus that integral: so what the side feels is in
/// equilibrium with the strip's own elements, also where their motion is uneven across.
fn lateral_forces(side: &FreeField) -> Vec<(usize, usize, f64)> {
    let mut found = Vec::new();
    for ((cell, material), beside) in side.column.faces().zip(&side.lines) {
        let k = stiffness_of_face(&side.column, cell, material);
        let nodes = &side.column.mesh.cells[cell].nodes;
        for (a, node_a) in nodes.iter().enumerate() {
            let Some(&on_side) = beside.line.nodes.iter().find(|node| side.twin[node] == *node_a) else { continue };
            for (b, &node_b) in nodes.iter().enumerate() {
                found.push((on_side, node_b, -side.outward * k[(2 * a, 2 * b + 1)]));
            }
        }
    }
    found
}

/// (a, b, value) for nodes a, b of a line: rho c_s times the integral of N_a N_b ds [N s/m].
fn shear_dashpots(model: &Model, Absorber { line, material, .. }: &Absorber) -> Vec<(usize, usize, f64)> {
    let at = corners(model, &line.nodes);
    let z_s = material.density * material.s_speed();
    let mut found = Vec::new();
    for (a, &node_a) in line.nodes.iter().enumerate() {
        for (b, &node_b) in line.nodes.iter().enumerate() {
            found.push((node_a, node_b, dashpot_block(&at, line.shape, [0., z_s], a, b)[1][1]));
        }
    }
    found
}
