//! Named curves on the border of the mesh.

use super::mesh::{Group, Mesh};
use super::sides::{Sides, edge};
use crate::physics::shape::Shape;
use crate::{Error, Result};

/// A line on the border of the mesh, with the solid on its left.
#[derive(Debug, Clone, PartialEq)]
pub struct Border {
    pub shape: Shape,
    pub nodes: Vec<usize>,
}

impl Border {
    /// Unit vector from its first corner to its second.
    pub fn tangent(&self, mesh: &Mesh) -> [f64; 2] {
        let [a, b] = [0, 1].map(|i| mesh.points[self.nodes[i]]);
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        [(b[0] - a[0]) / length, (b[1] - a[1]) / length]
    }

    /// Nearer to the vertical than to the horizontal.
    pub fn is_upright(&self, mesh: &Mesh) -> bool {
        let [tx, ty] = self.tangent(mesh);
        ty.abs() > tx.abs()
    }
}

/// The group's lines with the solid on their left, and that solid's face; each must have a face on exactly one side.
pub fn border(mesh: &Mesh, group: &Group, sides: &Sides) -> Result<Vec<(Border, usize)>> {
    let oriented = |&cell: &usize| {
        let nodes = &mesh.cells[cell].nodes;
        match sides.get(&edge(nodes)).map(Vec::as_slice) {
            Some([(face, side)]) => Ok((Border { shape: mesh.cells[cell].shape, nodes: side.clone() }, *face)),
            found => Err(Error::input(format!(
                "load or boundary \"{}\": its line at {} has {}; it must lie on the border of the mesh",
                group.name,
                mesh.place(cell),
                if found.is_some() { "a surface on both sides" } else { "no surface beside it" },
            ))),
        }
    };
    group.cells.iter().map(oriented).collect()
}
