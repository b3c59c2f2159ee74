//! Shapes of the elements: angles, sides, and whether an element is folded.

use super::mesh::{Cell, Mesh};
use crate::number::place;
use crate::physics::element::{self, Integral};
use crate::{Error, Result};

/// Angles between the sides at a face's corners, the smallest and the largest [degrees].
pub fn angles(mesh: &Mesh, face: &Cell) -> [f64; 2] {
    let corners: Vec<[f64; 2]> = face.nodes[..face.shape.corner_count()].iter().map(|&n| mesh.points[n]).collect();
    let count = corners.len();
    let angle = |i: usize| {
        let [before, here, after] = [(i + count - 1) % count, i, (i + 1) % count].map(|j| corners[j]);
        let direction = |to: [f64; 2]| (to[1] - here[1]).atan2(to[0] - here[0]);
        (direction(before) - direction(after)).to_degrees().rem_euclid(360.)
    };
    (0..count).map(angle).fold([f64::INFINITY, 0.], |[low, high], a| [low.min(a), high.max(a)])
}

/// Lengths between neighbouring corners, the shortest and the longest [m].
pub fn sides(mesh: &Mesh, face: &Cell) -> [f64; 2] {
    let length = |side: Vec<usize>| {
        let [a, b] = [0, 1].map(|end| mesh.points[face.nodes[side[end]]]);
        (a[0] - b[0]).hypot(a[1] - b[1])
    };
    let lengths = face.shape.sides().into_iter().map(length);
    lengths.fold([f64::INFINITY, 0.], |[low, high], l| [low.min(l), high.max(l)])
}

/// A folded element has a Jacobian determinant that is not positive at an integration point: it cannot be integrated.
pub fn refuse_folded(mesh: &Mesh) -> Result<()> {
    for (number, cell) in mesh.cells.iter().enumerate().filter(|(_, c)| c.shape.dimension() == 2) {
        let at: Vec<[f64; 2]> = cell.nodes.iter().map(|&n| mesh.points[n]).collect();
        let rules = [Integral::Stiffness, Integral::Mass];
        if rules.iter().flat_map(|&rule| element::points(cell.shape, &at, rule)).any(|p| p.dv <= 0.) {
            let place = place(mesh.centroid(cell));
            let of: String = mesh.groups_of(number).map(|group| format!(" of \"{}\"", group.name)).collect();
            return Err(Error::input(format!(
                "the {:?} element{of} at {place} in {} is folded (its Jacobian determinant is not positive \
                 everywhere): mesh that place more finely or move its points",
                cell.shape, mesh.name
            )));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::mesh::Shape;

    fn quad(points: [[f64; 2]; 4]) -> Mesh {
        let cells = vec![Cell { shape: Shape::Quad4, nodes: vec![0, 1, 2, 3] }];
        Mesh { points: points.to_vec(), cells, ..Mesh::default() }
    }

    #[test]
    fn a_rhombus_has_its_angles_and_sides() {
        let mesh = quad([[0., 0.], [2., 0.], [3., 3f64.sqrt()], [1., 3f64.sqrt()]]);
        let [low, high] = angles(&mesh, &mesh.cells[0]);
        assert!((low - 60.).abs() < 1e-12 && (high - 120.).abs() < 1e-12);
        assert!(sides(&mesh, &mesh.cells[0]).iter().all(|l| (l - 2.).abs() < 1e-15));
    }

    #[test]
    fn an_arrowhead_is_folded_and_a_square_is_not() {
        assert!(refuse_folded(&quad([[0., 0.], [1., 0.], [1., 1.], [0., 1.]])).is_ok());
        let sentence = refuse_folded(&quad([[0., 0.], [1., 0.], [0.1, 0.1], [0., 1.]])).unwrap_err().to_string();
        assert!(sentence.contains("folded") && sentence.contains("(0.2750, 0.2750)"), "{sentence}");
    }
}
