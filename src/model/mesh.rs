//! A plane mesh: points, cells, and the named groups that the whole interface to the user is made of.

/// The cell shapes the solver knows; nodes in Gmsh's order (corners anticlockwise, then mid-sides).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Shape {
    Point,
    Line2,
    Line3,
    Tri3,
    Quad4,
    Tri6,
    Quad8,
}

impl Shape {
    pub fn node_count(self) -> usize {
        match self {
            Shape::Point => 1,
            Shape::Line2 => 2,
            Shape::Line3 | Shape::Tri3 => 3,
            Shape::Quad4 => 4,
            Shape::Tri6 => 6,
            Shape::Quad8 => 8,
        }
    }

    pub fn corner_count(self) -> usize {
        match self {
            Shape::Point => 1,
            Shape::Line2 | Shape::Line3 => 2,
            Shape::Tri3 | Shape::Tri6 => 3,
            Shape::Quad4 | Shape::Quad8 => 4,
        }
    }

    /// 0 point, 1 line, 2 face.
    pub fn dimension(self) -> usize {
        match self {
            Shape::Point => 0,
            Shape::Line2 | Shape::Line3 => 1,
            _ => 2,
        }
    }
}

/// One cell: a point, a line or a face of the mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    pub shape: Shape,
    /// indices into [`Mesh::points`], `shape.node_count()` of them; faces run anticlockwise
    pub nodes: Vec<usize>,
}

/// A physical group: its name and its members, all of one dimension.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    pub name: String,
    /// 0 point, 1 line, 2 face
    pub dimension: usize,
    /// indices into [`Mesh::cells`], ascending
    pub cells: Vec<usize>,
}

/// Points in metres, in the plane; every cell stands once however many groups it belongs to.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mesh {
    pub points: Vec<[f64; 2]>,
    /// the node's tag in the file, for messages
    pub tags: Vec<usize>,
    pub cells: Vec<Cell>,
    pub groups: Vec<Group>,
    /// faces that ran clockwise in the file and were turned
    pub turned: usize,
}
