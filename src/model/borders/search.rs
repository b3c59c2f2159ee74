//! Finds where a mesh's border lies inside the solid.

use super::area::Faces;
use super::found::{Found, Overlap, Touch};
use super::segment::{Segment, cross, segments};
use super::tree::{Bounds, Tree};
use crate::model::mesh::Mesh;
use crate::model::sides::{EndSides, Side, end_sides};
use std::collections::HashSet;

pub fn search(mesh: &Mesh) -> Found {
    let EndSides { open, covered } = end_sides(mesh);
    let search = Search::new(mesh, &open);
    let (mut touches, crossings) = search.pairs();
    let known: HashSet<usize> =
        touches.iter().map(|touch| touch.sides).chain(crossings.iter().copied()).flatten().collect();
    touches.extend(search.lenses(&known));
    let crossing = |sides: [usize; 2]| Overlap { faces: sides.map(|side| open[side].face), sides: sides.to_vec() };
    let doubled = |sides: [Side; 2]| Overlap { faces: sides.map(|side| side.face), sides: vec![] };
    let covered_ends = search.covered(mesh, &open, &known);
    let overlaps =
        crossings.into_iter().map(crossing).chain(covered_ends).chain(covered.into_iter().map(doubled)).collect();
    Found { hinges: hinges(mesh, &open), open, touches, overlaps }
}

/// The border in straight pieces, and where they lie.
struct Search {
    segments: Vec<Segment>,
    tree: Tree,
    /// of the mesh [m]
    extent: f64,
}

impl Search {
    fn new(mesh: &Mesh, open: &[Side]) -> Search {
        let segments: Vec<Segment> =
            open.iter().enumerate().flat_map(|(number, side)| segments(mesh, number, side)).collect();
        let tree = Tree::new(segments.iter().map(|s| Bounds::of([s.from, s.to])).collect());
        Search { segments, tree, extent: Bounds::of(mesh.points.iter().copied()).extent() }
    }

    /// Where pieces lie on each other, and the sides that go through each other.
    fn pairs(&self) -> (Vec<Touch>, Vec<[usize; 2]>) {
        let (mut touches, mut crossings) = (vec![], vec![]);
        let mut near = vec![];
        for (number, one) in self.segments.iter().enumerate() {
            near.clear();
            self.tree.meeting(&one.reach(self.extent), |other| {
                // The sides of one face are never two parts, however thin it is.
                if self.segments[other].face != one.face {
                    near.push(other);
                }
            });
            near.sort_unstable();
            for other in near.iter().filter(|&&other| other > number).map(|&other| &self.segments[other]) {
                let sides = [one.side, other.side];
                match one.touches(other, self.extent) {
                    Some(stretch) if !stretch.same_side => touches.push(Touch { sides, ends: stretch.ends }),
                    None if !one.crosses(other, self.extent) => {}
                    _ => crossings.push(sides),
                }
            }
        }
        (touches, crossings)
    }

    /// Chords that span a gap, besides the `known` sides.
    fn lenses(&self, known: &HashSet<usize>) -> Vec<Touch> {
        let unknown = self.segments.iter().filter(|piece| !known.contains(&piece.side));
        let lens = |piece: &Segment| {
            let mut near = vec![];
            self.tree.meeting(&piece.reach(self.extent), |other| near.push(self.segments[other]));
            near.retain(|other| other.face != piece.face);
            let opposite = piece.spans_lens(&near, self.extent)?;
            Some(Touch { sides: [piece.side, opposite.side], ends: [piece.from, piece.to] })
        };
        unknown.filter_map(lens).collect()
    }

    /// Sides with another face beyond them, besides the `known` ones.
    fn covered(&self, mesh: &Mesh, open: &[Side], known: &HashSet<usize>) -> Vec<Overlap> {
        let pieces = self.segments.iter().filter(|s| !known.contains(&s.side) && self.layers_beyond(s) > 0);
        let pieces: Vec<&Segment> = pieces.collect();
        if pieces.is_empty() {
            return vec![];
        }
        let faces = Faces::of(mesh);
        let overlap = |piece: &Segment| {
            let own = open[piece.side].face;
            let other = faces.around(piece.beyond(), own)?;
            Some(Overlap { faces: [own, other], sides: vec![piece.side] })
        };
        pieces.into_iter().filter_map(overlap).collect()
    }

    /// m(x) just beyond a piece. A ray along +x from it leaves a face where it meets an upward piece, whose solid is on
    /// the left, and enters one at a downward piece; along +y it is the other way round. It runs along the axis that is
    /// steeper to the piece, so that it does not run along a straight border, and just beside the point, on the side of
    /// larger coordinates, so that it meets no ends.
    fn layers_beyond(&self, piece: &Segment) -> i64 {
        let (point, outwards) = (piece.probe(), piece.outwards());
        let axis = usize::from(outwards[1].abs() > outwards[0].abs());
        let (across, sign) = (1 - axis, if axis == 0 { 1 } else { -1 });
        let mut end = point;
        end[axis] = f64::INFINITY;
        let mut layers = 0;
        self.tree.meeting(&Bounds { low: point, high: end }, |other| {
            let other = &self.segments[other];
            let before = |p: [f64; 2]| i64::from(p[across] <= point[across]);
            let leaves = sign * (before(other.from) - before(other.to));
            if other != piece && leaves as f64 * cross(other.from, other.to, point) > 0. {
                layers += leaves;
            }
        });
        layers - i64::from(outwards[axis] < 0.)
    }
}

/// Nodes where the border passes twice: only they join what lies on their two sides.
fn hinges(mesh: &Mesh, open: &[Side]) -> Vec<usize> {
    let mut count = vec![0u32; mesh.points.len()];
    open.iter().flat_map(|side| &side.nodes[..2]).for_each(|&node| count[node] += 1);
    (0..count.len()).filter(|&node| count[node] > 2).collect()
}
