//! Stress and strain of the elements, at their centres.

use crate::model::case::Quad4;
use crate::model::resolve::Model;
use crate::physics::element::{self, Integral, Point};
use crate::physics::material::Material;
use crate::physics::shape::Shape;
use nalgebra::{DMatrix, DVector, Vector3};

/// Components (xx, yy, zz, xy), tension positive; shear strain as a tensor's, gamma / 2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellStress {
    /// [Pa]
    pub stress: [f64; 4],
    pub strain: [f64; 4],
}

impl CellStress {
    /// sqrt(3 J2) [Pa].
    pub fn von_mises(&self) -> f64 {
        let [xx, yy, zz, xy] = self.stress;
        (((xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2)) / 2. + 3. * xy * xy).sqrt()
    }
}

/// What turns nodal displacements into stresses; made once, used for every frame.
pub struct Recovery {
    faces: Vec<Face>,
}

struct Face {
    nodes: Vec<usize>,
    b: DMatrix<f64>,
    /// of B-bar elements, whose bulk stress follows the mean dilatation
    mean_dilatation: Option<DMatrix<f64>>,
    material: Material,
}

impl Recovery {
    pub fn new(model: &Model) -> Recovery {
        let face = |(cell, material): (usize, &Material)| {
            let cell = &model.mesh.cells[cell];
            let at: Vec<[f64; 2]> = cell.nodes.iter().map(|&n| model.mesh.points[n]).collect();
            let b_bar = cell.shape == Shape::Quad4 && model.quad4 == Quad4::BBar;
            let points = || element::points(cell.shape, &at, Integral::Stiffness);
            Face {
                b: centre(cell.shape, &at).b(),
                mean_dilatation: b_bar.then(|| element::mean_dilatation(&points())),
                nodes: cell.nodes.clone(),
                material: *material,
            }
        };
        Recovery { faces: model.faces().map(face).collect() }
    }

    /// epsilon = B u and sigma = D epsilon at the centre of every face, in the order of [`Model::faces`]; `u` per node [m].
    pub fn stresses(&self, u: &[[f64; 2]]) -> Vec<CellStress> {
        self.faces.iter().map(|face| face.stress(u)).collect()
    }
}

impl Face {
    fn stress(&self, u: &[[f64; 2]]) -> CellStress {
        let u = DVector::from_iterator(2 * self.nodes.len(), self.nodes.iter().flat_map(|&n| u[n]));
        let product = &self.b * &u;
        let strain = Vector3::new(product[0], product[1], product[2]);
        let dilatation = strain[0] + strain[1];
        let bulk = self.mean_dilatation.as_ref().map_or(dilatation, |b| (b * &u)[0]);
        let mean_stress = self.material.bulk_modulus() * bulk;
        let deviator = self.material.deviatoric() * strain;
        let out_of_plane = mean_stress - (deviator[0] + deviator[1]);
        CellStress {
            stress: [deviator[0] + mean_stress, deviator[1] + mean_stress, out_of_plane, deviator[2]],
            strain: [strain[0], strain[1], 0., strain[2] / 2.],
        }
    }
}

/// Where T3 is constant and Q4 superconvergent.
fn centre(shape: Shape, nodes: &[[f64; 2]]) -> Point {
    let at = if shape.corner_count() == 3 { [1. / 3., 1. / 3.] } else { [0., 0.] };
    element::point(shape, nodes, at, 1.)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Uniaxial 3 Pa, pure shear 2 Pa: sigma_v = 3, 2 sqrt(3).
    #[test]
    fn von_mises_of_uniaxial_and_shear_states() {
        let of = |stress| CellStress { stress, strain: [0.; 4] }.von_mises();
        assert!((of([3., 0., 0., 0.]) - 3.).abs() < 1e-15);
        assert!((of([0., 0., 0., 2.]) - 12f64.sqrt()).abs() < 1e-15);
        assert!(of([5., 5., 5., 0.]).abs() < 1e-15);
    }
}
