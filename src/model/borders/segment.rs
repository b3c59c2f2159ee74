//! Straight pieces of the mesh's border, and how two of them lie to each other.

use super::tree::Bounds;
use crate::model::mesh::Mesh;
use crate::model::sides::Side;

/// Nearer than this part of the shorter side, two borders touch; a wider gap is air.
const TOUCHING: f64 = 2e-5;
/// Coordinates may be rounded by up to this part of the mesh's extent, as with nine digits.
const ROUNDING: f64 = 1e-8;
/// Pieces of a curved side, a parabola: it rises 1/256 as high above the chord of each as above its own.
const PIECES: usize = 16;
/// Pieces of two divisions of one circle of radius R lie apart by up to this part of the height h by which a side of
/// length L rises above its chord: h / 256 by the pieces, and h (L / 8R)^2, the error of the parabola, which is 0.006 h
/// with ten sides round the circle.
const PARABOLA: f64 = 0.01;
/// Two borders touch if more than this part of the shorter side lies on the other.
const LEAST_SHARE: f64 = 1e-3;
/// A chord whose ends touch the other side spans a gap, if it is lower than this part of its length: an arc of 45
/// degrees rises 0.1 above its chord.
const LENS: f64 = 0.1;
/// cos 37 degrees: directions of two borders that face each other.
const FACING: f64 = 0.8;

/// A piece of a side that only one face has, its solid on the left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    pub from: [f64; 2],
    pub to: [f64; 2],
    /// the number of its side
    pub side: usize,
    /// whose side it is
    pub face: usize,
    /// of the side's chord [m]
    side_length: f64,
    /// height of the side's middle above its chord [m]
    rise: f64,
    /// [m]
    length: f64,
}

/// Where two segments lie on each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    pub ends: [[f64; 2]; 2],
    /// whether the solids of the two lie on the same side of it, so that they overlap
    pub same_side: bool,
}

/// The pieces of the side of that number.
pub fn segments(mesh: &Mesh, number: usize, side: &Side) -> Vec<Segment> {
    let nodes = &side.nodes;
    let [a, b] = [0, 1].map(|i| mesh.points[nodes[i]]);
    let side_length = distance(a, b);
    let m = nodes.get(2).map_or(a, |&n| mesh.points[n]);
    let rise = match nodes.len() {
        3 => (cross(a, b, m) / side_length).abs(),
        _ => 0.,
    };
    let pieces = if rise > 1e-6 * side_length { PIECES } else { 1 };
    // x(s) = N_a a + N_b b + N_m m; the ends are the nodes to the last digit, so that neighbours join
    let at = |k: usize| match k as f64 / pieces as f64 {
        0. => a,
        1. => b,
        s => {
            let [n_a, n_b, n_m] = [(1. - s) * (1. - 2. * s), s * (2. * s - 1.), 4. * s * (1. - s)];
            [0, 1].map(|i| n_a * a[i] + n_b * b[i] + n_m * m[i])
        }
    };
    let piece = |k| {
        let (from, to) = (at(k), at(k + 1));
        Segment { from, to, side: number, face: side.face, side_length, rise, length: distance(from, to) }
    };
    (0..pieces).map(piece).collect()
}

impl Segment {
    /// A point of it at which no node of another part is likely to lie.
    pub fn probe(&self) -> [f64; 2] {
        self.at(0.414_213_562 * self.length)
    }

    /// A point just beyond it.
    pub fn beyond(&self) -> [f64; 2] {
        let (probe, outwards) = (self.probe(), self.outwards());
        [0, 1].map(|i| probe[i] + 1e-6 * outwards[i])
    }

    /// Away from the solid, not of unit length.
    pub fn outwards(&self) -> [f64; 2] {
        [self.to[1] - self.from[1], self.from[0] - self.to[0]]
    }

    /// All that can touch it, or span a gap with it.
    pub fn reach(&self, extent: f64) -> Bounds {
        let by = LENS * self.length + ROUNDING * extent;
        Bounds::of([self.from, self.to]).widened(by)
    }

    /// (distance along the segment, distance outwards) [m]
    fn frame(&self, p: [f64; 2]) -> [f64; 2] {
        let along: f64 = (0..2).map(|i| (p[i] - self.from[i]) * (self.to[i] - self.from[i])).sum();
        [along / self.length, -cross(self.from, self.to, p) / self.length]
    }

    fn at(&self, along: f64) -> [f64; 2] {
        [0, 1].map(|i| self.from[i] + along / self.length * (self.to[i] - self.from[i]))
    }

    /// Within this distance points of both coincide [m].
    fn tolerance(&self, other: &Segment, extent: f64) -> f64 {
        TOUCHING * self.side_length.min(other.side_length) + PARABOLA * self.rise.max(other.rise) + ROUNDING * extent
    }

    /// Where they lie on each other, if they do over a length.
    pub fn touches(&self, other: &Segment, extent: f64) -> Option<Stretch> {
        let tolerance = self.tolerance(other, extent);
        let [a, b] = [self.frame(other.from), self.frame(other.to)];
        let ends = [a[0].min(b[0]).max(0.), a[0].max(b[0]).min(self.length)];
        if ends[1] - ends[0] <= (LEAST_SHARE * self.length.min(other.length)).max(2. * tolerance) {
            return None;
        }
        let gap = |along: f64| a[1] + (along - a[0]) / (b[0] - a[0]) * (b[1] - a[1]);
        ends.iter()
            .all(|&along| gap(along).abs() <= tolerance)
            .then(|| Stretch { ends: ends.map(|along| self.at(along)), same_side: b[0] > a[0] })
    }

    /// Whether each goes through the other from one side to the other.
    pub fn crosses(&self, other: &Segment, extent: f64) -> bool {
        let tolerance = self.tolerance(other, extent);
        let parts = |one: &Segment, by: &Segment| {
            let [a, b] = [by.from, by.to].map(|p| one.frame(p)[1]);
            a.min(b) < -tolerance && a.max(b) > tolerance
        };
        parts(self, other) && parts(other, self)
    }

    /// Whether the border of `others` leaves this chord at one end, meets it at the other and keeps near between: the
    /// coarser division of a curve, whose chord spans a gap that nobody drew.
    pub fn spans_lens(&self, others: &[Segment], extent: f64) -> Option<Segment> {
        let facing = |other: &&Segment| {
            let [a, b] = [self.frame(other.from)[0], self.frame(other.to)[0]];
            a - b > FACING * other.length
        };
        let near = |other: &Segment, p, q| distance(p, q) <= self.tolerance(other, extent);
        let facing: Vec<&Segment> = others.iter().filter(facing).collect();
        facing.iter().find(|other| near(other, other.from, self.to))?;
        facing.iter().find(|other| near(other, other.to, self.from))?;
        let half = self.length / 2.;
        let opposite = facing.iter().find(|other| {
            let [a, b] = [self.frame(other.from), self.frame(other.to)];
            let gap = a[1] + (half - a[0]) / (b[0] - a[0]) * (b[1] - a[1]);
            b[0] <= half && half <= a[0] && gap >= 0. && gap <= LENS * self.length
        });
        opposite.map(|other| **other)
    }
}

pub fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Twice the area of the triangle a, b, c: positive if c lies on the left of a-b [m^2].
pub fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}
