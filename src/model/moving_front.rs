//! A front of pressure on its way over the loaded lines: which parts it has passed, and the forces on their nodes.
//!
//! A line is cut where the arrival turns (under a charge), so that over each part the front moves one way. The part
//! behind the front is integrated by itself: the total force is continuous in time, however large the elements are.

use super::boundary::Border;
use super::case::Clock;
use super::mesh::Mesh;
use crate::number::short_to;
use crate::physics::element::gauss_3;
use crate::physics::front::{Front, distance};
use crate::physics::pulse::Pulse;
use crate::physics::shape::Shape;
use crate::{Error, Result};

#[derive(Debug, Clone, PartialEq)]
pub struct MovingFront {
    front: Front,
    /// time of the front that is t = 0 of the calculation [s]
    zero: f64,
    parts: Vec<Part>,
}

/// A part of a line over which the front moves one way, from local coordinate `span[0]` to `span[1]` in [-1, 1].
#[derive(Debug, Clone, PartialEq)]
struct Part {
    /// number of the line it belongs to
    line: usize,
    shape: Shape,
    nodes: Vec<usize>,
    /// the line's nodes [m]
    at: Vec<[f64; 2]>,
    span: [f64; 2],
    /// when the pressure begins at both ends of the span [s]
    begins: [f64; 2],
    /// for the whole span
    points: Vec<Point>,
}

/// A Gauss point behind the front.
#[derive(Debug, Clone, PartialEq)]
struct Point {
    /// [s]
    arrival: f64,
    pulse: Pulse,
    /// on each node, per unit of the pulse [N/Pa]
    forces: Vec<[f64; 2]>,
}

/// A front that is nearer to one end of a part by no more than this share of the part's length is parallel to it:
/// round-off of places.
const AT_ONCE: f64 = 1e-9;

impl MovingFront {
    /// Errors where a charge's formula does not hold at some point of the lines.
    pub fn new(mesh: &Mesh, lines: &[Border], front: &Front, clock: Clock) -> Result<MovingFront> {
        let mut parts = Vec::new();
        for (number, line) in lines.iter().enumerate() {
            let at: Vec<[f64; 2]> = line.nodes.iter().map(|&n| mesh.points[n]).collect();
            for span in monotone(|r| front.way(place(line.shape, &at, r))) {
                for r in span {
                    check(front, place(line.shape, &at, r))?;
                }
                let (shape, nodes) = (line.shape, line.nodes.clone());
                parts.push(Part { line: number, shape, nodes, at: at.clone(), span, begins: [0.; 2], points: vec![] });
            }
        }
        let first = parts.iter().map(|p| front.arrival(p.place(p.span[0]))).fold(f64::INFINITY, f64::min);
        let zero = if clock == Clock::Arrival && first.is_finite() { first } else { 0. };
        let mut moving = MovingFront { front: front.clone(), zero, parts: vec![] };
        let completed = |part: Part| Part {
            begins: part.span.map(|r| moving.begins(part.place(r))),
            points: part.points(&moving, part.span),
            ..part
        };
        moving.parts = parts.into_iter().map(completed).collect();
        Ok(moving)
    }

    /// What moves.
    pub fn front(&self) -> &Front {
        &self.front
    }

    /// When the front passes x [s].
    pub fn arrival(&self, x: [f64; 2]) -> f64 {
        self.front.arrival(x) - self.zero
    }

    /// The pressure at x from t = 0 of the calculation on.
    pub fn pulse(&self, x: [f64; 2]) -> Pulse {
        Pulse::Delayed { law: Box::new(self.front.pulse(x)), start: self.arrival(x), rise: 0. }
    }

    /// When the pressure at x begins [s]: at the front's passage, or later if the pulse starts later.
    fn begins(&self, x: [f64; 2]) -> f64 {
        self.arrival(x) + self.front.start()
    }

    /// The pulse at the point that the front reaches first.
    pub fn first_pulse(&self) -> Pulse {
        let first = self.parts.iter().min_by(|a, b| a.begins[0].total_cmp(&b.begins[0]));
        first.map_or(Pulse::Step { peak: 0. }, |part| self.front.pulse(part.place(part.span[0])))
    }

    /// First and last time at which the front reaches a point of the lines [s].
    pub fn passage(&self) -> [f64; 2] {
        let times = self.parts.iter().map(|p| p.span.map(|r| self.arrival(p.place(r))));
        times.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [a, b]| [low.min(a), high.max(b)])
    }

    /// First and last time at which the pressure begins at a point of the lines [s].
    pub fn onset(&self) -> [f64; 2] {
        self.passage().map(|t| t + self.front.start())
    }

    /// The front's time that is t = 0 of the calculation [s].
    pub fn origin(&self) -> f64 {
        self.zero
    }

    /// Slowest and fastest speed of the front along the lines, part by part [m/s]; infinite where it reaches a part at
    /// once.
    pub fn trace_speeds(&self) -> [f64; 2] {
        let speed = |p: &Part| {
            let [a, b] = p.span.map(|r| p.place(r));
            let (length, way) = (distance(a, b), (self.front.way(b) - self.front.way(a)).abs());
            match way <= AT_ONCE * length {
                true => f64::INFINITY,
                false => length / (self.arrival(b) - self.arrival(a)).abs(),
            }
        };
        self.parts.iter().map(speed).fold([f64::INFINITY, 0.], |[low, high], u| [low.min(u), high.max(u)])
    }

    /// Forces on the nodes at time `t` [N]; a node comes once for each part that it belongs to.
    pub fn forces(&self, t: f64) -> impl Iterator<Item = (usize, [f64; 2])> {
        self.parts.iter().flat_map(move |part| self.forces_of(part, t))
    }

    /// The same for one line alone.
    pub fn forces_on(&self, line: usize, t: f64) -> impl Iterator<Item = (usize, [f64; 2])> {
        self.parts.iter().filter(move |part| part.line == line).flat_map(move |part| self.forces_of(part, t))
    }

    fn forces_of<'a>(&'a self, part: &'a Part, t: f64) -> Vec<(usize, [f64; 2])> {
        if t < part.begins[0] {
            return vec![];
        }
        if t >= part.begins[1] {
            return part.forces(&part.points, t);
        }
        let reached = self.reached(part, t);
        part.forces(&part.points(self, [part.span[0], reached]), t)
    }

    /// The local coordinate up to which a part is loaded, by bisection to the last digit.
    fn reached(&self, part: &Part, t: f64) -> f64 {
        let [mut behind, mut ahead] = part.span;
        for _ in 0..50 {
            let middle = (behind + ahead) / 2.;
            match self.begins(part.place(middle)) <= t {
                true => behind = middle,
                false => ahead = middle,
            }
        }
        (behind + ahead) / 2.
    }
}

impl Part {
    fn place(&self, r: f64) -> [f64; 2] {
        place(self.shape, &self.at, r)
    }

    /// Three Gauss points over a span: integral of N p n ds, the pressure pushing to the left, where the solid lies.
    fn points(&self, moving: &MovingFront, [from, to]: [f64; 2]) -> Vec<Point> {
        let half = (to - from) / 2.;
        let point = |(g, weight): (f64, f64)| {
            let r = (from + to) / 2. + half * g;
            let functions = self.shape.functions([r, 0.]);
            let tangent = [0, 1].map(|i| self.at.iter().zip(&functions).map(|(x, f)| f.1[0] * x[i]).sum::<f64>());
            let share = weight * half.abs();
            let forces = functions.iter().map(|(n, _)| [-tangent[1] * n * share, tangent[0] * n * share]).collect();
            let x = self.place(r);
            Point { arrival: moving.arrival(x), pulse: moving.front.pulse(x), forces }
        };
        gauss_3().into_iter().map(point).collect()
    }

    fn forces(&self, points: &[Point], t: f64) -> Vec<(usize, [f64; 2])> {
        let mut forces: Vec<_> = self.nodes.iter().map(|&node| (node, [0.; 2])).collect();
        for point in points {
            let p = point.pulse.at(t - point.arrival);
            for ((_, force), per_unit) in forces.iter_mut().zip(&point.forces) {
                force[0] += p * per_unit[0];
                force[1] += p * per_unit[1];
            }
        }
        forces
    }
}

fn place(shape: Shape, at: &[[f64; 2]], r: f64) -> [f64; 2] {
    let functions = shape.functions([r, 0.]);
    [0, 1].map(|i| at.iter().zip(&functions).map(|(x, f)| f.0 * x[i]).sum())
}

/// A charge's formula must hold at every distance.
fn check(front: &Front, x: [f64; 2]) -> Result<()> {
    match front {
        Front::Charge { explosion, at, .. } => explosion.check(distance(x, *at)).map_err(|e| {
            Error::input(format!("at ({}, {}) m of the curve: {e}", short_to(6, x[0]), short_to(6, x[1])))
        }),
        Front::Plane { .. } | Front::Circle { .. } => Ok(()),
    }
}

/// [-1, 1] cut where the front's way is shortest or longest inside; each piece runs from its earlier to its later end.
fn monotone(way: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
    let turns = [turn(&way), turn(&|r| -way(r))];
    let inner = turns.into_iter().flatten().next(); // one turn a line: elements are small against the front's curvature
    let ends = [Some(-1.), inner, Some(1.)];
    let ends: Vec<f64> = ends.into_iter().flatten().collect();
    let in_order = |w: &[f64]| if way(w[0]) <= way(w[1]) { [w[0], w[1]] } else { [w[1], w[0]] };
    ends.windows(2).map(in_order).collect()
}

/// Where a function with one minimum has it, by thirds; none at the ends.
fn turn(f: &impl Fn(f64) -> f64) -> Option<f64> {
    let [mut low, mut high] = [-1., 1.];
    for _ in 0..80 {
        let [a, b] = [low + (high - low) / 3., high - (high - low) / 3.];
        match f(a) < f(b) {
            true => high = b,
            false => low = a,
        }
    }
    let middle = (low + high) / 2.;
    (middle.abs() < 1. - 1e-6 && f(middle) < f(-1.) && f(middle) < f(1.)).then_some(middle)
}
