//! Stress and strain of the elements, at their centres and at the nodes.

use super::nodal::{Nodal, Patchwork};
use super::sites::Sites;
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

/// sqrt(3 J2) [Pa] of (xx, yy, zz, xy).
pub fn von_mises([xx, yy, zz, xy]: [f64; 4]) -> f64 {
    (((xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2)) / 2. + 3. * xy * xy).sqrt()
}

/// What turns nodal displacements into stresses; made once, used for every frame.
pub struct Recovery {
    faces: Vec<Face>,
    nodal: Nodal,
}

struct Face {
    nodes: Vec<usize>,
    /// B at the centre
    centre: DMatrix<f64>,
    /// B at the best points; none where the centre is the only one
    best: Vec<DMatrix<f64>>,
    /// of B-bar elements, whose bulk stress follows the mean dilatation
    mean_dilatation: Option<DMatrix<f64>>,
    material: Material,
}

impl Recovery {
    pub fn new(model: &Model, sites: &Sites) -> Recovery {
        let (mut faces, mut patches, mut places) = (vec![], vec![], vec![]);
        for ((cell, material), sites) in model.faces().zip(&sites.faces) {
            let cell = &model.mesh.cells[cell];
            let at: Vec<[f64; 2]> = cell.nodes.iter().map(|&n| model.mesh.points[n]).collect();
            let best: Vec<Point> =
                best_points(cell.shape).into_iter().map(|place| element::point(cell.shape, &at, place, 1.)).collect();
            let numbers = places.len()..places.len() + best.len();
            patches.push(Patchwork { shape: cell.shape, sites: sites.clone(), best: numbers.collect() });
            places.extend(best.iter().map(|p| p.at));
            let b_bar = cell.shape == Shape::Quad4 && model.quad4 == Quad4::BBar;
            let points = || element::points(cell.shape, &at, Integral::Stiffness);
            faces.push(Face {
                centre: element::point(cell.shape, &at, centre(cell.shape), 1.).b(),
                best: best.iter().filter(|_| best.len() > 1).map(Point::b).collect(),
                mean_dilatation: b_bar.then(|| element::mean_dilatation(&points())),
                nodes: cell.nodes.clone(),
                material: *material,
            });
        }
        let points = sites.spread(&model.mesh.points);
        Recovery { faces, nodal: Nodal::new(&patches, &points, &places) }
    }

    /// epsilon = B u and sigma = D epsilon at the centre of every face, in the order of [`Model::faces`]; `u` per node [m].
    pub fn stresses(&self, u: &[[f64; 2]]) -> Vec<CellStress> {
        self.faces.iter().map(|face| face.stress(&face.centre, &face.motion(u))).collect()
    }

    /// sigma = (xx, yy, zz, xy) recovered at every site [Pa]; `centres`: what [`Recovery::stresses`] gave for the same `u`.
    pub fn nodal_stresses(&self, u: &[[f64; 2]], centres: &[CellStress]) -> Vec<[f64; 4]> {
        let of_face = |(face, centre): (&Face, &CellStress)| match face.best.is_empty() {
            true => vec![centre.stress],
            false => face.best_stresses(u),
        };
        self.nodal.at_sites(&self.faces.iter().zip(centres).flat_map(of_face).collect::<Vec<_>>())
    }
}

impl Face {
    /// (u_x, u_y of its node 0, of node 1, ...) [m].
    fn motion(&self, u: &[[f64; 2]]) -> DVector<f64> {
        DVector::from_iterator(2 * self.nodes.len(), self.nodes.iter().flat_map(|&n| u[n]))
    }

    fn best_stresses(&self, u: &[[f64; 2]]) -> Vec<[f64; 4]> {
        let u = self.motion(u);
        self.best.iter().map(|b| self.stress(b, &u).stress).collect()
    }

    fn stress(&self, b: &DMatrix<f64>, u: &DVector<f64>) -> CellStress {
        let product = b * u;
        let strain = Vector3::new(product[0], product[1], product[2]);
        let dilatation = strain[0] + strain[1];
        let bulk = self.mean_dilatation.as_ref().map_or(dilatation, |b| (b * u)[0]);
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
fn centre(shape: Shape) -> [f64; 2] {
    if shape.corner_count() == 3 { [1. / 3., 1. / 3.] } else { [0., 0.] }
}

/// Where stress converges fastest: the centre, with mid-sides the 2 x 2 Gauss points or the three of T6.
pub fn best_points(shape: Shape) -> Vec<[f64; 2]> {
    match shape {
        Shape::Tri6 => vec![[1. / 6., 1. / 6.], [2. / 3., 1. / 6.], [1. / 6., 2. / 3.]],
        Shape::Quad8 => element::gauss_2().iter().flat_map(|(r, _)| element::gauss_2().map(|(s, _)| [*r, s])).collect(),
        _ => vec![centre(shape)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Uniaxial 3 Pa, pure shear 2 Pa: sigma_v = 3, 2 sqrt(3).
    #[test]
    fn von_mises_of_uniaxial_and_shear_states() {
        assert!((von_mises([3., 0., 0., 0.]) - 3.).abs() < 1e-15);
        assert!((von_mises([0., 0., 0., 2.]) - 12f64.sqrt()).abs() < 1e-15);
        assert!(von_mises([5., 5., 5., 0.]).abs() < 1e-15);
    }
}
