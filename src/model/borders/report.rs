//! Sentences about borders inside the solid: between which groups, where, how long or how large, what to do.

use super::area::{Area, Faces};
use super::found::{Found, Overlap, Touch};
use super::segment::distance;
use crate::model::mesh::Mesh;
use crate::model::sides::Side;
use crate::number::fixed;
use std::collections::{BTreeMap, BTreeSet};

/// Two divisions of one border overlap in slivers: on average thinner than this part of the sides along them.
const SLIVER: f64 = 0.1;
/// What else helps where elements of one group overlap.
const FOLDED: &str = "; elements of one surface are folded over each other where its mesh is too coarse for its border: mesh it more finely";
/// Pairs of groups in one sentence.
const PAIRS: usize = 4;

pub struct Report<'a> {
    mesh: &'a Mesh,
    found: &'a Found,
}

/// The groups on the two sides, in the order of the alphabet.
type Groups = [String; 2];

/// What two groups both cover, and the sides of `Found::open` by which that was found.
struct Doubled {
    groups: Groups,
    area: Area,
    sides: BTreeSet<usize>,
}

/// A border that two groups have in common.
#[derive(Default)]
struct Common {
    /// whether the two sides go through each other, as two divisions of a curve do
    overlaps: bool,
    /// [m]
    length: f64,
    /// [m]
    points: Vec<[f64; 2]>,
}

impl Common {
    fn add(&mut self, length: f64, points: impl IntoIterator<Item = [f64; 2]>) {
        self.length += length;
        self.points.extend(points);
    }

    /// Touch along 6 m, from (0, 2) to (6, 2) m; from left to right, upwards where it is upright.
    fn touch(&self) -> String {
        let order = |a: &&[f64; 2], b: &&[f64; 2]| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]));
        let ends = [self.points.iter().min_by(order), self.points.iter().max_by(order)];
        let [from, to] = ends.map(|end| end.map_or_else(String::new, |p| place(*p)));
        format!(
            "touch {}along {} m, from {from} to {to} m, without sharing nodes, so that no force passes",
            if self.overlaps { "and partly overlap " } else { "" },
            fixed(4, self.length)
        )
    }
}

fn place([x, y]: [f64; 2]) -> String {
    format!("({}, {})", fixed(4, x), fixed(4, y))
}

impl<'a> Report<'a> {
    pub fn new(mesh: &'a Mesh, found: &'a Found) -> Report<'a> {
        Report { mesh, found }
    }

    /// What must not be, if anything: these touches and every overlap.
    pub fn sentence(&self, touches: &[&Touch]) -> Option<String> {
        let mut common: BTreeMap<Groups, Common> = BTreeMap::new();
        for touch in touches {
            let groups = self.groups(self.found.faces(touch));
            common.entry(groups).or_default().add(distance(touch.ends[0], touch.ends[1]), touch.ends);
        }
        let (mut surfaces, mut folded) = (Vec::new(), false);
        for Doubled { groups, area, sides } in self.doubled() {
            let squares: f64 = sides.iter().map(|&side| self.length(side).powi(2)).sum();
            if area.size < SLIVER * squares {
                self.add_slivers(common.entry(groups).or_default(), &sides);
            } else {
                let size = fixed(4, area.size);
                let text = format!("overlap over {size} m2 round {} m, which count twice", place(area.centre()));
                folded |= groups[0] == groups[1];
                surfaces.push(between(&groups, "elements", &text));
            }
        }
        let lines = common.iter().map(|(groups, common)| between(groups, "parts", &common.touch()));
        let found: Vec<String> = lines.chain(surfaces.iter().cloned()).collect();
        (!found.is_empty()).then(|| {
            let more = match found.len().saturating_sub(PAIRS) {
                0 => String::new(),
                more => format!("; so do {more} more pairs of groups"),
            };
            format!(
                "{}: {}{more}: {}{}",
                self.mesh.name,
                found.iter().take(PAIRS).cloned().collect::<Vec<_>>().join("; "),
                remedy(!common.is_empty(), !surfaces.is_empty()),
                if folded { FOLDED } else { "" }
            )
        })
    }

    /// The overlaps by pairs of groups.
    fn doubled(&self) -> Vec<Doubled> {
        if self.found.overlaps.is_empty() {
            return vec![];
        }
        let mut overlapping: BTreeMap<Groups, BTreeSet<usize>> = BTreeMap::new();
        for Overlap { faces, sides } in &self.found.overlaps {
            overlapping.entry(self.groups(*faces)).or_default().extend(sides);
        }
        let names: Vec<String> = (0..self.mesh.cells.len()).map(|cell| self.group(cell)).collect();
        let faces = Faces::of(self.mesh);
        let area = |[one, other]: &Groups| faces.covered_by_both(|c| names[c] == *one, |c| names[c] == *other);
        let doubled = |(groups, sides)| Doubled { area: area(&groups), groups, sides };
        overlapping.into_iter().map(doubled).collect()
    }

    /// The border of two divisions, whose sides go through each other: as long as the longer of the two.
    fn add_slivers(&self, common: &mut Common, sides: &BTreeSet<usize>) {
        common.overlaps = true;
        let mut lengths: BTreeMap<String, f64> = BTreeMap::new();
        for &side in sides {
            let Side { face, nodes } = &self.found.open[side];
            *lengths.entry(self.group(*face)).or_default() += self.length(side);
            common.add(0., nodes[..2].iter().map(|&node| self.mesh.points[node]));
        }
        let longest = lengths.values().copied().fold(0., f64::max);
        // Within one group both divisions are in the sum.
        common.add(if lengths.len() == 1 && sides.len() > 1 { longest / 2. } else { longest }, []);
    }

    /// Nodes that join two parts alone, other than the ends of slits.
    pub fn hinges(&self, slits: &[&Touch]) -> Option<String> {
        let open = &self.found.open;
        let ends: BTreeSet<usize> =
            slits.iter().flat_map(|t| t.sides).flat_map(|side| open[side].nodes.iter().copied()).collect();
        let hinges: Vec<usize> = self.found.hinges.iter().copied().filter(|node| !ends.contains(node)).collect();
        let &first = hinges.first()?;
        let at_first = open.iter().filter(|side| side.nodes[..2].contains(&first));
        let groups: BTreeSet<String> = at_first.map(|side| self.group(side.face)).collect();
        let more = match hinges.len() {
            1 => String::new(),
            n => format!(", as at {} more nodes", n - 1),
        };
        Some(format!(
            "parts of {} meet at {} m in a single node of {}{more}: it passes forces and no moment, as a hinge does",
            groups.into_iter().collect::<Vec<_>>().join(" and "),
            place(self.mesh.points[first]),
            self.mesh.name,
        ))
    }

    fn groups(&self, faces: [usize; 2]) -> Groups {
        let mut groups = faces.map(|face| self.group(face));
        groups.sort();
        groups
    }

    fn group(&self, face: usize) -> String {
        let group = self.mesh.groups_of(face).next();
        group.map_or_else(|| "a surface without group".into(), |g| format!("\"{}\"", g.name))
    }

    /// Of a side's chord [m].
    fn length(&self, side: usize) -> f64 {
        let nodes = &self.found.open[side].nodes;
        distance(self.mesh.points[nodes[0]], self.mesh.points[nodes[1]])
    }
}

/// `"a" and "b" touch`, or within one group `two parts of "a" touch`.
fn between(groups: &Groups, what: &str, how: &str) -> String {
    match groups[0] == groups[1] {
        true => format!("{what} of {} {how}", groups[0]),
        false => format!("{} and {} {how}", groups[0], groups[1]),
    }
}

fn remedy(touch: bool, overlap: bool) -> String {
    let join = "BooleanFragments or Coherence in the script joins them";
    let slip = "an interface along the common curve then lets them slip, and a border that is meant to stay open is named \
                in \"slits\" by its curve";
    let cut = "BooleanDifference cuts one surface out of the other";
    match (touch, overlap) {
        (true, false) => format!("{join}; {slip}"),
        (false, true) => format!("{join}; {cut}"),
        _ => format!("{join}; {cut}; {slip}"),
    }
}
