//! Stress and strain of the elements, at their centres and at the nodes.

use super::nodal::{Nodal, Patchwork};
use super::sites::Sites;
use crate::model::case::Quad4;
use crate::model::resolve::Model;
use crate::physics::element::{self, Integral, Point};
use crate::physics::material::Material;
use crate::physics::shape::Shape;
use nalgebra::Vector3;
use std::ops::Range;

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

/// The principal stresses s1 >= s2 >= s3 [Pa] of (xx, yy, zz, xy): zz, and in the plane the mean of xx and yy plus and
/// minus the radius of Mohr's circle.
pub fn principal([xx, yy, zz, xy]: [f64; 4]) -> [f64; 3] {
    let (mean, radius) = ((xx + yy) / 2., ((xx - yy) / 2.).hypot(xy));
    let mut stresses = [mean + radius, mean - radius, zz];
    stresses.sort_by(|a, b| b.total_cmp(a));
    stresses
}

/// What turns nodal displacements into stresses; made once, used for every frame. Lists in one piece: that is quick.
pub struct Recovery {
    faces: Vec<Face>,
    /// of the faces, one after the other
    nodes: Vec<usize>,
    /// (dN/dx, dN/dy) of a face's nodes at one place, at the next, of the next face [1/m]
    gradients: Vec<[f64; 2]>,
    nodal: Nodal,
}

struct Face {
    /// where its nodes are listed
    nodes: Range<usize>,
    /// where its gradients begin: at the centre, then at the best points, then their mean
    gradients: usize,
    /// best points, unless the centre is the only one
    best_count: usize,
    /// of B-bar elements the bulk stress follows the mean dilatation
    b_bar: bool,
    material: Material,
}

impl Recovery {
    pub fn new(model: &Model, sites: &Sites) -> Recovery {
        let (mut faces, mut patches, mut places) = (vec![], vec![], vec![]);
        let (mut nodes, mut gradients) = (vec![], vec![]);
        for ((cell, material), sites) in model.faces().zip(&sites.faces) {
            let cell = &model.mesh.cells[cell];
            let at: Vec<[f64; 2]> = cell.nodes.iter().map(|&n| model.mesh.points[n]).collect();
            let point = |place: [f64; 2]| element::point(cell.shape, &at, place, 1.);
            let best: Vec<Point> = best_points(cell.shape).into_iter().map(point).collect();
            patches.push(Patchwork {
                shape: cell.shape,
                sites: sites.clone(),
                best: (places.len()..places.len() + best.len()).collect(),
            });
            places.extend(best.iter().map(|p| p.at));
            let b_bar = cell.shape == Shape::Quad4 && model.quad4 == Quad4::BBar;
            let best_count = if best.len() > 1 { best.len() } else { 0 };
            faces.push(Face {
                nodes: nodes.len()..nodes.len() + at.len(),
                gradients: gradients.len(),
                best_count,
                b_bar,
                material: *material,
            });
            nodes.extend(&cell.nodes);
            gradients.extend(point(centre(cell.shape)).gradient);
            gradients.extend(best.into_iter().take(best_count).flat_map(|p| p.gradient));
            if b_bar {
                let mean = element::mean_dilatation(&element::points(cell.shape, &at, Integral::Stiffness));
                gradients.extend((0..at.len()).map(|i| [mean[2 * i], mean[2 * i + 1]]));
            }
        }
        let points = sites.spread(&model.mesh.points);
        Recovery { faces, nodes, gradients, nodal: Nodal::new(&patches, &points, &places) }
    }

    /// epsilon = B u and sigma = D epsilon at the centre of every face, in the order of [`Model::faces`]; `u` per node
    /// [m].
    pub fn stresses(&self, u: &[[f64; 2]]) -> Vec<CellStress> {
        self.faces.iter().map(|face| self.stress(face, 0, u)).collect()
    }

    /// sigma = (xx, yy, zz, xy) recovered at every site [Pa]; `centres`: what [`Recovery::stresses`] gave for the same
    /// `u`.
    pub fn nodal_stresses(&self, u: &[[f64; 2]], centres: &[CellStress]) -> Vec<[f64; 4]> {
        let mut best = Vec::with_capacity(centres.len());
        for (face, centre) in self.faces.iter().zip(centres) {
            match face.best_count {
                0 => best.push(centre.stress),
                count => best.extend((1..=count).map(|place| self.stress(face, place, u).stress)),
            }
        }
        self.nodal.at_sites(&best)
    }

    /// `place`: 0 is the centre, from 1 the best points.
    fn stress(&self, face: &Face, place: usize, u: &[[f64; 2]]) -> CellStress {
        let [xx, yy, gamma] = self.strain(face, place, u);
        let dilatation = match face.b_bar {
            true => {
                let [xx, yy, _] = self.strain(face, 1 + face.best_count, u);
                xx + yy
            }
            false => xx + yy,
        };
        let mean_stress = face.material.bulk_modulus() * dilatation;
        let deviator = face.material.deviatoric() * Vector3::new(xx, yy, gamma);
        let out_of_plane = mean_stress - (deviator[0] + deviator[1]);
        CellStress {
            stress: [deviator[0] + mean_stress, deviator[1] + mean_stress, out_of_plane, deviator[2]],
            strain: [xx, yy, 0., gamma / 2.],
        }
    }

    /// (xx, yy, gamma_xy): sums of dN/dx u_x, dN/dy u_y, dN/dy u_x + dN/dx u_y over the nodes.
    fn strain(&self, face: &Face, place: usize, u: &[[f64; 2]]) -> [f64; 3] {
        let nodes = &self.nodes[face.nodes.clone()];
        let gradients = self.gradients[face.gradients + place * nodes.len()..].iter().zip(nodes);
        gradients.fold([0.; 3], |[xx, yy, gamma], (&[dx, dy], &node)| {
            let [ux, uy] = u[node];
            [xx + dx * ux, yy + dy * uy, gamma + dy * ux + dx * uy]
        })
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

    /// [[50, 30], [30, -20]] has eigenvalues 15 +- sqrt(35^2 + 30^2), 61.0977 and -31.0977; zz lies between them, above
    /// them and below them.
    #[test]
    fn principal_stresses_are_the_eigenvalues_in_falling_order() {
        let radius = 2125f64.sqrt();
        for (zz, expected) in [
            (0., [15. + radius, 0., 15. - radius]),
            (100., [100., 15. + radius, 15. - radius]),
            (-100., [15. + radius, 15. - radius, -100.]),
        ] {
            let found = principal([50., -20., zz, 30.]);
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-13), "{found:?}, not {expected:?}");
        }
    }
}
