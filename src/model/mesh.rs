//! A plane mesh: points, cells, and the named groups that the whole interface to the user is made of.

use crate::number;
use std::collections::BTreeSet;

pub use crate::physics::shape::Shape;

/// One cell: a point, a line or a face of the mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    pub shape: Shape,
    /// indices into [`Mesh::points`], `shape.node_count()` of them; faces run anticlockwise, a line's direction means
    /// nothing
    pub nodes: Vec<usize>,
}

impl Cell {
    pub fn corners(&self) -> &[usize] {
        &self.nodes[..self.shape.corner_count()]
    }
}

/// Between the name of a group on an interface and that of a side.
pub const SIDE: char = '@';
/// What the name of a group ends with that holds the body's side of an interface.
pub const BODY_SIDE: &str = "@body";
/// What the name of a group ends with that holds the ground's side of an interface.
pub const GROUND_SIDE: &str = "@ground";

/// A physical group: its name and its members, all of one dimension.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    pub name: String,
    /// 0 point, 1 line, 2 face
    pub dimension: usize,
    /// indices into [`Mesh::cells`], ascending; empty if the file names a group that has no elements
    pub cells: Vec<usize>,
}

impl Group {
    /// Whether it holds the nodes that one side of an interface, or one surface at a junction, has: the geometry does not
    /// name it.
    pub fn is_a_side(&self) -> bool {
        self.name.contains(SIDE)
    }
}

/// Points in metres, in the plane; every cell stands once however many groups it belongs to.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mesh {
    /// the file's name, for messages: `twin_pipes.msh`
    pub name: String,
    pub points: Vec<[f64; 2]>,
    /// the node's tag in the file, for messages
    pub tags: Vec<usize>,
    /// all faces of the file, and the lines and points that belong to a group
    pub cells: Vec<Cell>,
    /// by dimension, then name; names are unique within a dimension
    pub groups: Vec<Group>,
    /// names of groups of curves and points on interfaces that the case leaves closed: all their sides are the group itself
    pub bonded: BTreeSet<String>,
    /// faces that ran clockwise in the file and were turned
    pub turned: usize,
    /// elements that stood more than once in a group of the file, and stand once here
    pub dropped: usize,
    /// what the file leaves open, as sentences for warnings
    pub remarks: Vec<String>,
}

impl Mesh {
    /// The larger of its extents along x and y [m].
    pub fn size(&self) -> f64 {
        let along = |axis: usize| {
            let least = self.points.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
            self.points.iter().map(|p| p[axis] - least).fold(0., f64::max)
        };
        along(0).max(along(1))
    }

    /// The ground's side of a group of curves or points that lies on an interface; none for other groups.
    pub fn ground_side(&self, group: &Group) -> Option<&Group> {
        let name = format!("{}{GROUND_SIDE}", group.name);
        self.groups.iter().find(|g| g.dimension == group.dimension && g.name == name)
    }

    /// A group and, where it lies on an interface and names no side itself, its ground's side.
    pub fn both_sides<'a>(&'a self, group: &'a Group) -> impl Iterator<Item = &'a Group> {
        std::iter::once(group).chain(self.ground_side(group))
    }

    /// A group and, where it lies on interfaces, the groups of all nodes at its places.
    pub fn copies_of<'a>(&'a self, group: &'a Group) -> impl Iterator<Item = &'a Group> {
        let lies_there = |g: &&Group| {
            let rest = g.name.strip_prefix(group.name.as_str());
            g.dimension == group.dimension && rest.is_some_and(|rest| rest.starts_with(SIDE))
        };
        std::iter::once(group).chain(self.groups.iter().filter(lies_there))
    }

    /// The groups a cell belongs to.
    pub fn groups_of(&self, cell: usize) -> impl Iterator<Item = &Group> {
        let dimension = self.cells[cell].shape.dimension();
        self.groups.iter().filter(move |g| g.dimension == dimension && g.cells.binary_search(&cell).is_ok())
    }

    /// Where a cell lies, for messages.
    pub fn place(&self, cell: usize) -> String {
        number::place(self.centroid(&self.cells[cell]))
    }

    /// The nodes of the group's cells, mid-side nodes too, each once, ascending.
    pub fn nodes_of(&self, group: &Group) -> Vec<usize> {
        let mut nodes: Vec<usize> = group.cells.iter().flat_map(|&c| self.cells[c].nodes.iter().copied()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// Number of a group's points, or its length [m], or its area [m^2].
    pub fn measure_of(&self, group: &Group) -> f64 {
        // a sum of no numbers is -0
        group.cells.iter().fold(0., |sum, &c| sum + self.measure(&self.cells[c]))
    }

    /// 1 for a point, a line's length [m], a face's area [m^2] (negative if it runs clockwise); curved sides count.
    pub fn measure(&self, cell: &Cell) -> f64 {
        match cell.shape.dimension() {
            0 => 1.0,
            1 => self.length(cell),
            _ => self.area(cell),
        }
    }

    /// Length: of the chord, or of the parabola x(s) = a + s (4m - 3a - b) + s^2 (2a + 2b - 4m) by 5 Gauss points.
    fn length(&self, cell: &Cell) -> f64 {
        let [a, b] = [self.points[cell.nodes[0]], self.points[cell.nodes[1]]];
        let Some(&mid) = cell.nodes.get(2) else {
            return (b[0] - a[0]).hypot(b[1] - a[1]);
        };
        let m = self.points[mid];
        let slope = |i: usize, s: f64| 4.0 * m[i] - 3.0 * a[i] - b[i] + 4.0 * s * (a[i] + b[i] - 2.0 * m[i]);
        GAUSS_5.iter().map(|&(s, weight)| weight * slope(0, s).hypot(slope(1, s))).sum()
    }

    /// Area by Green's theorem, 1/2 closed integral of (x dy - y dx): a straight side a-b gives 1/2 a x b,
    /// a parabola through its mid-side node m gives 1/6 (4 a x m + 4 m x b - a x b).
    fn area(&self, cell: &Cell) -> f64 {
        let corners = cell.shape.corner_count();
        let [x0, y0] = self.points[cell.nodes[0]];
        let at = |i: usize| [self.points[cell.nodes[i]][0] - x0, self.points[cell.nodes[i]][1] - y0];
        let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
        let side = |i: usize| {
            let (a, b) = (at(i), at((i + 1) % corners));
            if cell.nodes.len() == corners {
                return cross(a, b) / 2.0;
            }
            let m = at(corners + i);
            (4.0 * cross(a, m) + 4.0 * cross(m, b) - cross(a, b)) / 6.0
        };
        (0..corners).map(side).sum()
    }

    /// The mean of the cell's corners [m].
    pub fn centroid(&self, cell: &Cell) -> [f64; 2] {
        let corners = cell.corners();
        let mean = |i: usize| corners.iter().map(|&n| self.points[n][i]).sum::<f64>() / corners.len() as f64;
        [mean(0), mean(1)]
    }
}

/// (point, weight) on 0..1.
const GAUSS_5: [(f64, f64); 5] = [
    (0.046_910_077_030_668_0, 0.118_463_442_528_094_5),
    (0.230_765_344_947_158_5, 0.239_314_335_249_683_2),
    (0.5, 0.284_444_444_444_444_4),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_2),
    (0.953_089_922_969_332, 0.118_463_442_528_094_5),
];
