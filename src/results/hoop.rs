//! Hoop stress at the faces of a pipe wall: from the best points of its elements, fitted and extrapolated.
//!
//! Linear in the displacements: sigma_theta = sum of weight . u, the weights found once.

use super::ring::material_of;
use super::stress::best_points;
use crate::model::case::Quad4;
use crate::model::resolve::Model;
use crate::model::ring::RingShape;
use crate::physics::element::{self, Integral};
use crate::physics::shape::Shape;
use nalgebra::{DMatrix, RowDVector, RowVector3, Vector3};
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// (node, weight of its displacement) [Pa/m]
pub type Weights = Vec<(usize, [f64; 2])>;

/// sigma_theta = row u at a point of an element.
pub struct Sample {
    sector: usize,
    radius: f64,
    angle: f64,
    nodes: Vec<usize>,
    /// [Pa/m]
    row: RowDVector<f64>,
}

/// The best points of each element: its centre, with mid-sides 2 x 2 Gauss points or the three of T6.
pub fn samples(shape: &RingShape, model: &Model) -> Vec<Sample> {
    let in_face = |&(cell, sector): &(usize, usize)| {
        let face = &model.mesh.cells[cell];
        let material = material_of(model, cell);
        let at: Vec<[f64; 2]> = face.nodes.iter().map(|&n| model.mesh.points[n]).collect();
        let b_bar = face.shape == Shape::Quad4 && model.quad4 == Quad4::BBar;
        let mean = b_bar.then(|| element::mean_dilatation(&element::points(face.shape, &at, Integral::Stiffness)));
        let points = best_points(face.shape).into_iter().map(|place| element::point(face.shape, &at, place, 1.));
        let sample = |p: element::Point| {
            let [x, y] = [p.at[0] - shape.centre[0], p.at[1] - shape.centre[1]];
            let angle = y.atan2(x);
            // sigma_theta = e_theta' sigma e_theta
            let (sin, cos) = angle.sin_cos();
            let hoop = RowVector3::new(sin * sin, cos * cos, -2. * sin * cos);
            let stress = match &mean {
                None => material.plane_strain() * p.b(),
                Some(mean) => material.deviatoric() * p.b() + Vector3::new(1., 1., 0.) * mean * material.bulk_modulus(),
            };
            Sample { sector, radius: x.hypot(y), angle, nodes: face.nodes.clone(), row: hoop * stress }
        };
        points.map(sample).collect::<Vec<_>>()
    };
    shape.sectors.iter().flat_map(in_face).collect()
}

/// Least squares over the two sectors on either side of a ray, then the values at the ray on the inner and outer face.
///
/// The terms 1, 1/r^2, r^2, 1/r^4 (no more than there are places in a wall) hold Lame's solution and that of an
/// ovalised ring, Michell's cos 2 theta; each times 1, x, x^2 in the angle x.
pub fn at(shape: &RingShape, samples: &[Sample], ray: usize) -> [Weights; 2] {
    let rays = shape.rays.len();
    let near: Vec<&Sample> = samples.iter().filter(|s| (s.sector + rays + 2 - ray) % rays < 4).collect();
    let radial = radial_terms(shape, near[0].nodes.len());
    let (inner, outer) = shape.faces();
    let term = |k: usize, r: f64, angle: f64| {
        let x = ((angle + PI).rem_euclid(TAU) - PI) * rays as f64 / TAU;
        [1., (inner / r).powi(2), (r / inner).powi(2), (inner / r).powi(4)][k / 3] * [1., x, x * x][k % 3]
    };
    let fit =
        DMatrix::from_fn(near.len(), 3 * radial, |i, k| term(k, near[i].radius, near[i].angle - shape.rays[ray].angle));
    let inverse = fit.pseudo_inverse(1e-10).expect("the tolerance is not negative");
    [inner, outer].map(|radius| {
        let wanted = RowDVector::from_fn(3 * radial, |_, k| term(k, radius, 0.));
        of_nodes(&near, &(wanted * &inverse))
    })
}

/// The weights of the nodes' displacements from those of the samples' stresses.
fn of_nodes(samples: &[&Sample], weights: &RowDVector<f64>) -> Weights {
    let of_sample = |(s, weight): (&&Sample, &f64)| {
        let row = &s.row * *weight;
        s.nodes.iter().enumerate().map(move |(i, &n)| (n, [row[2 * i], row[2 * i + 1]])).collect::<Vec<_>>()
    };
    let mut sum: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
    for (node, [x, y]) in samples.iter().zip(weights.iter()).flat_map(of_sample) {
        let weight = sum.entry(node).or_default();
        *weight = [weight[0] + x, weight[1] + y];
    }
    sum.into_iter().collect()
}

/// As many as layers, twice as many with mid-sides, half as many of triangles of three nodes, which scatter.
fn radial_terms(shape: &RingShape, nodes: usize) -> usize {
    let layers = shape.radii.len() - 1;
    match nodes {
        3 => (layers / 2).clamp(1, 4),
        4 => layers.min(4),
        _ => (2 * layers).min(4),
    }
}
