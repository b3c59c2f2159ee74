//! The sides of faces by their corners, and whether all elements that meet along a side share all its nodes.

use super::mesh::{Cell, Mesh};
use crate::{Error, Result};
use std::collections::{BTreeSet, HashMap};

/// An edge by its two corner nodes, smaller first.
pub type Edge = (usize, usize);

/// Every side of every face with that face, running anticlockwise, by its corners; twice where two faces share it.
pub type Sides = HashMap<Edge, Vec<(usize, Vec<usize>)>>;

/// The edge of a line or of a side, whose first two nodes are its ends.
pub fn edge(nodes: &[usize]) -> Edge {
    (nodes[0].min(nodes[1]), nodes[0].max(nodes[1]))
}

pub fn solid_sides(mesh: &Mesh) -> Sides {
    let mut sides = Sides::new();
    for (cell, face) in mesh.cells.iter().enumerate().filter(|(_, c)| c.shape.dimension() == 2) {
        for nodes in sides_of(face) {
            sides.entry(edge(&nodes)).or_default().push((cell, nodes));
        }
    }
    sides
}

/// A side of a face, running anticlockwise: two ends, then the mid-side node if there is one.
#[derive(Debug, Clone, PartialEq)]
pub struct Side {
    pub face: usize,
    pub nodes: Vec<usize>,
}

/// The sides at which the solid may end.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EndSides {
    /// sides of exactly one face
    pub open: Vec<Side>,
    /// two sides with the same two ends whose faces lie on the same side of them, so that they overlap
    pub covered: Vec<[Side; 2]>,
}

/// The nodes of all sides that one face alone has: the mesh's borders, outer and inner.
pub fn open_sides(mesh: &Mesh) -> Vec<Vec<usize>> {
    let mut open: Vec<Vec<usize>> = end_sides(mesh).open.into_iter().map(|side| side.nodes).collect();
    open.sort_unstable();
    open
}

/// Without the memory of [`solid_sides`]: sides are gathered by their smaller end, then sorted by their larger one.
pub fn end_sides(mesh: &Mesh) -> EndSides {
    let mut ends = EndSides::default();
    let Bundles { starts, mut sides } = Bundles::of(mesh);
    for bundle in starts.windows(2) {
        let bundle = &mut sides[bundle[0]..bundle[1]];
        bundle.sort_unstable();
        for same in bundle.chunk_by(|a, b| a.larger == b.larger) {
            if let [only] = same {
                ends.open.push(only.side(mesh));
            }
            let overlapping = same.windows(2).filter(|pair| pair[0].rises == pair[1].rises);
            ends.covered.extend(overlapping.map(|pair| [pair[0].side(mesh), pair[1].side(mesh)]));
        }
    }
    ends
}

/// A side of a face, small enough for millions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
struct Local {
    /// end
    larger: u32,
    /// whether it runs to its larger end
    rises: bool,
    /// in the face
    number: u8,
    face: u32,
}

impl Local {
    fn side(self, mesh: &Mesh) -> Side {
        let face = self.face as usize;
        Side { face, nodes: sides_of(&mesh.cells[face]).swap_remove(self.number as usize) }
    }
}

/// The sides of all faces, by their smaller end.
struct Bundles {
    /// for each node, where its sides begin
    starts: Vec<usize>,
    sides: Vec<Local>,
}

impl Bundles {
    fn of(mesh: &Mesh) -> Bundles {
        let mut starts = vec![0; mesh.points.len() + 1];
        each_side(mesh, |smaller, _| starts[smaller + 1] += 1);
        (1..starts.len()).for_each(|i| starts[i] += starts[i - 1]);
        let (mut next, mut sides) = (starts.clone(), vec![Local::default(); starts[starts.len() - 1]]);
        each_side(mesh, |smaller, side| {
            sides[next[smaller]] = side;
            next[smaller] += 1;
        });
        Bundles { starts, sides }
    }
}

/// Every side of every face, with its smaller end.
fn each_side(mesh: &Mesh, mut see: impl FnMut(usize, Local)) {
    for (face, cell) in mesh.cells.iter().enumerate().filter(|(_, c)| c.shape.dimension() == 2) {
        let corners = cell.corners();
        let mut from = corners[corners.len() - 1];
        for (next, &to) in corners.iter().enumerate() {
            let number = (next + corners.len() - 1) % corners.len();
            let side = Local { larger: from.max(to) as u32, rises: from < to, number: number as u8, face: face as u32 };
            see(from.min(to), side);
            from = to;
        }
    }
}

/// The nodes of a line, or of each side of a face: two ends, then the mid-side node if there is one.
fn sides_of(cell: &Cell) -> Vec<Vec<usize>> {
    match cell.shape.dimension() {
        0 => vec![],
        1 => vec![cell.nodes.clone()],
        _ => cell.shape.sides().into_iter().map(|side| side.iter().map(|&local| cell.nodes[local]).collect()).collect(),
    }
}

/// Elements of first and second order side by side are not joined at the mid-side nodes: what they compute is wrong
/// without a word. `tags`: of the cells in the file, for the sentence.
///
/// Errors: two cells with the same edge of which one has a mid-side node and the other has not, or has another; a
/// mid-side node that is an end of another cell's side.
pub fn refuse_unlike_sides(mesh: &Mesh, tags: &[usize]) -> Result<()> {
    let mut seen: HashMap<Edge, (usize, Option<usize>)> = HashMap::new();
    let mut mids: HashMap<usize, usize> = HashMap::new();
    for (cell, nodes) in
        mesh.cells.iter().enumerate().flat_map(|(c, cell)| sides_of(cell).into_iter().map(move |s| (c, s)))
    {
        let mid = nodes.get(2).copied();
        let &mut (other, mid_of_other) = seen.entry(edge(&nodes)).or_insert((cell, mid));
        if mid != mid_of_other {
            return Err(unlike(mesh, tags, [cell, other]));
        }
        mids.extend(mid.map(|mid| (mid, cell)));
    }
    for (cell, corners) in
        mesh.cells.iter().enumerate().filter(|(_, c)| c.shape.dimension() > 0).map(|(c, x)| (c, x.corners()))
    {
        if let Some(&other) = corners.iter().find_map(|corner| mids.get(corner)) {
            return Err(unlike(mesh, tags, [cell, other]));
        }
    }
    Ok(())
}

fn unlike(mesh: &Mesh, tags: &[usize], cells: [usize; 2]) -> Error {
    let [one, other] = cells.map(|cell| {
        let groups: BTreeSet<&str> = mesh.groups_of(cell).map(|g| g.name.as_str()).collect();
        let whose = groups.iter().map(|name| format!(" of \"{name}\"")).collect::<String>();
        format!("the {}-node element {}{whose} at {}", mesh.cells[cell].nodes.len(), tags[cell], mesh.place(cell))
    });
    let is_second_order = |cell: usize| mesh.cells[cell].nodes.len() > mesh.cells[cell].corners().len();
    let cause = match cells.iter().all(|&cell| is_second_order(cell)) {
        true => {
            "each has a mid-side node of its own, so that the two can part between the corners; join them by BooleanFragments or \
             Coherence in the script"
        }
        false => {
            "first and second order are mixed; mesh faces and curves with one Mesh.ElementOrder, and save them together"
        }
    };
    Error::input(format!("{}: {one} and {other} meet along a side, but do not share all its nodes: {cause}", mesh.name))
}
