//! What a search of a mesh's border has found.

use crate::model::sides::{Edge, Side, edge};

/// The borders inside the solid of one mesh.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Found {
    /// sides of one face
    pub open: Vec<Side>,
    pub touches: Vec<Touch>,
    pub overlaps: Vec<Overlap>,
    /// nodes that alone join the faces on their two sides
    pub hinges: Vec<usize>,
}

/// Two sides lie on each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// of `Found::open`
    pub sides: [usize; 2],
    /// where it begins and ends [m]
    pub ends: [[f64; 2]; 2],
}

/// Two faces cover the same place.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlap {
    pub faces: [usize; 2],
    /// of `Found::open`: the sides that go through the other face, or lie inside it
    pub sides: Vec<usize>,
}

impl Found {
    pub fn edges(&self, touch: &Touch) -> [Edge; 2] {
        touch.sides.map(|side| edge(&self.open[side].nodes))
    }

    pub fn faces(&self, touch: &Touch) -> [usize; 2] {
        touch.sides.map(|side| self.open[side].face)
    }
}
