//! Volumetric locking: near nu = 1/2 the volume of every element is all but fixed, and T3 and standard Q4 have too few
//! freedoms left to move.

use super::case::Quad4;
use super::mesh::Shape;
use super::resolve::Model;
use std::collections::BTreeSet;

/// Share of a settlement from which a warning is given: a choice. Below it locking and the other errors of such meshes, 1 to
/// 2 %, are of one size.
const TOLERATED: f64 = 0.05;

/// Share of the settlement under a strip footing that T3 and standard Q4 lose to locking, on a mesh with five elements
/// across the footing: 1 - 1/(1 + 0.0036 r^0.85) with r = lambda/mu = 2 nu/(1 - 2 nu). Fitted to what this program
/// computes for nu = 0.3 to 0.4999: docs/theory.md, section 2.
pub fn estimated_error(poisson: f64) -> f64 {
    let r = 2. * poisson / (1. - 2. * poisson);
    1. - 1. / (1. + 0.0036 * r.powf(0.85))
}

/// A sentence for each material whose elements lock by more than is tolerated.
pub fn warnings(model: &Model) -> Vec<String> {
    let locks = |shape: Shape| match shape {
        Shape::Tri3 => true,
        Shape::Quad4 => model.quad4 == Quad4::Standard,
        Shape::Tri6 | Shape::Quad8 | Shape::Point | Shape::Line2 | Shape::Line3 => false,
    };
    let mut warnings = Vec::new();
    for (number, (name, material)) in model.materials.iter().enumerate() {
        let error = estimated_error(material.poisson);
        if error <= TOLERATED {
            continue;
        }
        let cells = (0..model.mesh.cells.len()).filter(|&cell| model.material_of[cell] == Some(number));
        let (mut all, mut locking) = (0., 0.);
        let mut shapes = BTreeSet::new();
        for face in cells.map(|cell| &model.mesh.cells[cell]) {
            let area = model.mesh.measure(face);
            all += area;
            if locks(face.shape) {
                locking += area;
                shapes.insert(face.shape);
            }
        }
        // A few triangles among elements that do not lock leave those free to move.
        if error * locking > TOLERATED * all {
            warnings.push(sentence(name, material.poisson, error, &shapes));
        }
    }
    warnings
}

fn sentence(name: &str, poisson: f64, error: f64, shapes: &BTreeSet<Shape>) -> String {
    let elements = match (shapes.contains(&Shape::Tri3), shapes.contains(&Shape::Quad4)) {
        (true, true) => "3-node triangles and standard 4-node quadrangles",
        (true, false) => "3-node triangles",
        _ => "standard 4-node quadrangles",
    };
    format!(
        "\"{name}\" has nu = {poisson}, near which {elements} lock: with five elements across the loaded width displacements \
         come out about {:.0} % too small, with ten about {:.0} %; use 4-node quadrangles with elements.quad4 = \"b_bar\", or \
         second order (Mesh.ElementOrder = 2)",
        100. * error,
        100. * finer(error)
    )
}

/// With half the element size r has a quarter of its effect.
fn finer(error: f64) -> f64 {
    let effect = error / (1. - error) / 4.;
    effect / (1. + effect)
}
