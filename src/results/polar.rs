//! Hoop and radial stress at the centres of elements of round bodies.

use super::ring::bodies;
use super::stress::CellStress;
use crate::model::resolve::Model;
use crate::model::ring::centre_of_round;
use std::collections::HashMap;

/// For every face the direction from the centre of its body to its own; none where the body's outer border is far from a circle
/// or it is the body of no interface. Faces of several bodies belong to the first.
pub struct Polar {
    /// (cos, sin) of the angle from +x
    directions: Vec<Option<[f64; 2]>>,
}

impl Polar {
    pub fn new(model: &Model) -> Polar {
        let place: HashMap<usize, usize> = model.faces().enumerate().map(|(place, (cell, _))| (cell, place)).collect();
        let mut directions = vec![None; place.len()];
        for body in bodies(model) {
            let Some([cx, cy]) = centre_of_round(&model.mesh, &body.cells) else { continue };
            for cell in &body.cells {
                let [x, y] = model.mesh.centroid(&model.mesh.cells[*cell]);
                let distance = (x - cx).hypot(y - cy);
                let direction = (distance > 0.).then(|| [(x - cx) / distance, (y - cy) / distance]);
                let known: &mut Option<[f64; 2]> = &mut directions[place[cell]];
                *known = known.or(direction);
            }
        }
        Polar { directions }
    }

    /// sigma_theta = e_theta' sigma e_theta and sigma_r = e_r' sigma e_r [Pa]; zero where there is no direction.
    pub fn stresses(&self, faces: &[CellStress]) -> [Vec<f64>; 2] {
        let hoop_and_radial = |(face, direction): (&CellStress, &Option<[f64; 2]>)| {
            let [xx, yy, _, xy] = face.stress;
            direction.map_or([0.; 2], |[c, s]| {
                [s * s * xx + c * c * yy - 2. * s * c * xy, c * c * xx + s * s * yy + 2. * s * c * xy]
            })
        };
        let both: Vec<[f64; 2]> = faces.iter().zip(&self.directions).map(hoop_and_radial).collect();
        [0, 1].map(|k| both.iter().map(|values| values[k]).collect())
    }
}
