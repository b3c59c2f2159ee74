//! Finds out whether a body is a ring of rays: a pipe wall whose corner nodes lie on rays from one centre, each with
//! the same radii, meshed in sectors between neighbouring rays.

use super::mesh::{Cell, Mesh};
use crate::number::{place, short_to};
use nalgebra::{DMatrix, DVector};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{PI, TAU};
use std::fmt;

/// Nodes may lie this far off their place, over the outer radius.
const TOLERANCE: f64 = 1e-5;

#[derive(Debug, Clone, PartialEq)]
pub struct RingShape {
    /// [m]
    pub centre: [f64; 2],
    /// of the corner nodes, from the inner face to the outer one [m]
    pub radii: Vec<f64>,
    /// anticlockwise from +x
    pub rays: Vec<Ray>,
    /// (face of the mesh, i) for every face, which lies between rays i and i + 1
    pub sectors: Vec<(usize, usize)>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Ray {
    /// from +x, anticlockwise, 0 to 2 pi
    pub angle: f64,
    /// corner nodes from the inner face to the outer one
    pub nodes: Vec<usize>,
}

/// Why a body is no ring of rays.
#[derive(Debug, Clone, PartialEq)]
pub enum NoRing {
    /// so many separate parts, or none
    Parts(usize),
    /// so many bores, not one
    Bores(usize),
    /// the outer border, or the bore, has nodes from the first to the second distance [m] from its centre
    NotRound(&'static str, [f64; 2]),
    /// distance of the bore's centre from that of the outer border [m]
    Eccentric(f64),
    /// a corner node at this place [m] is on no ray, or its ray has other radii, or its element spans several rays
    Unstructured([f64; 2]),
}

impl fmt::Display for NoRing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let length = |x: f64| short_to(4, x);
        match self {
            NoRing::Parts(0) => write!(f, "it has no surfaces"),
            NoRing::Parts(count) => write!(f, "it is in {count} separate parts"),
            NoRing::Bores(0) => write!(f, "it has no bore: a single closed line bounds it"),
            NoRing::Bores(count) => write!(f, "it has {count} bores"),
            NoRing::NotRound(what, [least, most]) => write!(
                f,
                "its {what} is no circle: corner nodes lie {} to {} m from the centre",
                length(*least),
                length(*most)
            ),
            NoRing::Eccentric(distance) => write!(f, "its bore is eccentric by {} m", length(*distance)),
            NoRing::Unstructured(at) => {
                write!(f, "its elements do not lie in layers between common rays from the centre, as at {}", place(*at))
            }
        }
    }
}

impl RingShape {
    /// `faces`: the body's, in `mesh`.
    pub fn find(mesh: &Mesh, faces: &[usize]) -> Result<RingShape, NoRing> {
        let Borders { outer, bore } = borders(mesh, faces)?;
        let centre = round(mesh, &outer, "outer border", 2. * TOLERANCE)?;
        // as many nodes in both borders: no notch
        let ring = (outer.len() == bore.len()).then(|| RingShape::of_rays(mesh, faces, &outer, centre));
        if let Some(ring) = ring.flatten() {
            return Ok(ring);
        }
        let [x, y] = round(mesh, &bore, "bore", 2. * TOLERANCE)?;
        let (off, allowed) = ((x - centre[0]).hypot(y - centre[1]), TOLERANCE * polar(mesh, centre, outer[0]).0);
        Err(if off > allowed { NoRing::Eccentric(off) } else { unstructured(mesh, faces, &outer, centre) })
    }

    fn of_rays(mesh: &Mesh, faces: &[usize], outer: &[usize], centre: [f64; 2]) -> Option<RingShape> {
        let mut rays: Vec<Ray> =
            outer.iter().map(|&n| Ray { angle: polar(mesh, centre, n).1, nodes: vec![] }).collect();
        rays.sort_by(|a, b| a.angle.total_cmp(&b.angle));
        let allowed = TOLERANCE * polar(mesh, centre, outer[0]).0;

        let mut ray_of = BTreeMap::new();
        for node in faces.iter().flat_map(|&f| mesh.cells[f].corners()).copied().collect::<BTreeSet<_>>() {
            let (radius, angle) = polar(mesh, centre, node);
            let ray = nearest(&rays, angle);
            if radius * (rays[ray].angle - angle).sin().abs() > allowed || (rays[ray].angle - angle).cos() < 0. {
                return None;
            }
            ray_of.insert(node, ray);
            rays[ray].nodes.push(node);
        }
        let radius = |&node: &usize| polar(mesh, centre, node).0;
        rays.iter_mut().for_each(|ray| ray.nodes.sort_by(|a, b| radius(a).total_cmp(&radius(b))));
        let radii: Vec<f64> = rays[0].nodes.iter().map(radius).collect();
        let alike = |ray: &Ray| {
            ray.nodes.len() == radii.len() && ray.nodes.iter().zip(&radii).all(|(n, r)| (radius(n) - r).abs() < allowed)
        };
        let sectors = faces.iter().map(|&f| Some((f, sector(&mesh.cells[f], &ray_of, rays.len())?)));
        let sectors = sectors.collect::<Option<_>>()?;
        rays.iter().all(alike).then_some(RingShape { centre, radii, rays, sectors })
    }

    /// The ray before sector i is ray i; the ray after it:
    pub fn after(&self, sector: usize) -> usize {
        (sector + 1) % self.rays.len()
    }

    /// (inner radius, outer radius) [m].
    pub fn faces(&self) -> (f64, f64) {
        (self.radii[0], self.radii[self.radii.len() - 1])
    }
}

fn polar(mesh: &Mesh, [cx, cy]: [f64; 2], node: usize) -> (f64, f64) {
    let [x, y] = mesh.points[node];
    let angle = (y - cy).atan2(x - cx);
    // Round-off below +x is still +x.
    ((x - cx).hypot(y - cy), if angle < -1e-9 { angle + TAU } else { angle.max(0.) })
}

fn nearest(rays: &[Ray], angle: f64) -> usize {
    let next = rays.partition_point(|ray| ray.angle < angle);
    let candidates = [next % rays.len(), (next + rays.len() - 1) % rays.len()];
    let off = |&ray: &usize| 1. - (rays[ray].angle - angle).cos();
    candidates.into_iter().min_by(|a, b| off(a).total_cmp(&off(b))).expect("there are two")
}

/// i if the corners lie on rays i and i + 1, and on both.
fn sector(face: &Cell, ray_of: &BTreeMap<usize, usize>, rays: usize) -> Option<usize> {
    let on: BTreeSet<usize> = face.corners().iter().map(|n| ray_of[n]).collect();
    match on.into_iter().collect::<Vec<_>>()[..] {
        [a, b] if b == a + 1 => Some(a),
        [0, b] if b + 1 == rays => Some(b),
        _ => None,
    }
}

/// Corner nodes of a body's two border lines.
struct Borders {
    outer: Vec<usize>,
    bore: Vec<usize>,
}

fn borders(mesh: &Mesh, faces: &[usize]) -> Result<Borders, NoRing> {
    // faces run anticlockwise, so an outer border does and a bore's does not
    let (mut outer, mut bores): (Vec<_>, Vec<_>) =
        loops(mesh, faces).into_iter().partition(|nodes| area(mesh, nodes) > 0.);
    match (outer.len(), bores.len()) {
        (1, 1) => Ok(Borders { outer: outer.remove(0), bore: bores.remove(0) }),
        (1, count) => Err(NoRing::Bores(count)),
        (count, _) => Err(NoRing::Parts(count)),
    }
}

/// The closed lines that bound the faces, by their corner nodes.
fn loops(mesh: &Mesh, faces: &[usize]) -> Vec<Vec<usize>> {
    let sides: BTreeSet<(usize, usize)> = faces.iter().flat_map(|&f| corner_sides(&mesh.cells[f])).collect();
    let mut next: BTreeMap<usize, usize> = sides.iter().copied().filter(|&(a, b)| !sides.contains(&(b, a))).collect();
    let mut loops = Vec::new();
    while let Some((&first, _)) = next.iter().next() {
        let mut nodes = vec![first];
        while let Some(node) = next.remove(&nodes[nodes.len() - 1]).filter(|&n| n != first) {
            nodes.push(node);
        }
        loops.push(nodes);
    }
    loops
}

/// [m^2], positive where the line runs anticlockwise.
fn area(mesh: &Mesh, nodes: &[usize]) -> f64 {
    let cross = |i: usize| {
        let ([x0, y0], [x1, y1]) = (mesh.points[nodes[i]], mesh.points[nodes[(i + 1) % nodes.len()]]);
        (x0 * y1 - x1 * y0) / 2.
    };
    (0..nodes.len()).map(cross).sum()
}

/// A body whose outer border is this round, the difference of its radii over the largest [-], has directions round and
/// from its centre; those of an oval pipe are off by about as much.
const OVAL: f64 = 0.05;

/// A polygon covers at least this part of its circle [-]: one of six equal sides covers 0.83, a square, whose corners lie
/// on a circle too, 0.64.
const LEAST_COVER: f64 = 0.8;

/// The centre of a body whose outer border is a circle, or nearly, whatever is within; none of other bodies.
pub fn centre_of_round(mesh: &Mesh, faces: &[usize]) -> Option<[f64; 2]> {
    let mut outer: Vec<_> = loops(mesh, faces).into_iter().filter(|nodes| area(mesh, nodes) > 0.).collect();
    let border = outer.pop().filter(|_| outer.is_empty())?;
    let centre = round(mesh, &border, "outer border", OVAL).ok()?;
    let circle = PI * polar(mesh, centre, border[0]).0.powi(2);
    (area(mesh, &border) > LEAST_COVER * circle).then_some(centre)
}

/// The centre of a border line whose corner nodes lie on a circle; `tolerance`: difference of radii over the largest.
fn round(mesh: &Mesh, nodes: &[usize], what: &'static str, tolerance: f64) -> Result<[f64; 2], NoRing> {
    let mean = |i: usize| nodes.iter().map(|&n| mesh.points[n][i]).sum::<f64>() / nodes.len() as f64;
    let fitted = centre_of_circle(mesh, nodes).filter(|_| nodes.len() > 2);
    let centre = fitted.unwrap_or([mean(0), mean(1)]);
    let radii = nodes.iter().map(|&n| polar(mesh, centre, n).0);
    let [least, most] = radii.fold([f64::INFINITY, 0.], |[least, most], r| [least.min(r), f64::max(most, r)]);
    match fitted.is_some() && most - least <= tolerance * most {
        true => Ok(centre),
        false => Err(NoRing::NotRound(what, [least, most])),
    }
}

/// Names the first corner node that is on no ray through a node of the outer border; where all are, the body's first.
fn unstructured(mesh: &Mesh, faces: &[usize], outer: &[usize], centre: [f64; 2]) -> NoRing {
    let direction = |node: usize| polar(mesh, centre, node).1;
    let mut rays: Vec<f64> = outer.iter().map(|&node| direction(node)).collect();
    rays.sort_by(f64::total_cmp);
    let is_off = |&node: &usize| {
        let after = rays.partition_point(|&ray| ray < direction(node));
        let beside = [after % rays.len(), (after + rays.len() - 1) % rays.len()].map(|i| rays[i] - direction(node));
        beside.iter().all(|angle| angle.sin().abs() > TOLERANCE || angle.cos() < 0.)
    };
    let mut corners = faces.iter().flat_map(|&f| mesh.cells[f].corners().iter().copied());
    let first = mesh.cells[faces[0]].nodes[0];
    NoRing::Unstructured(mesh.points[corners.find(is_off).unwrap_or(first)])
}

fn corner_sides(face: &Cell) -> Vec<(usize, usize)> {
    face.shape.sides().iter().map(|side| (face.nodes[side[0]], face.nodes[side[1]])).collect()
}

/// Least squares of 2 c.x + d = x.x, with x counted from the first node.
fn centre_of_circle(mesh: &Mesh, nodes: &[usize]) -> Option<[f64; 2]> {
    let [x0, y0] = mesh.points[nodes[0]];
    let at: Vec<[f64; 2]> = nodes.iter().map(|&n| [mesh.points[n][0] - x0, mesh.points[n][1] - y0]).collect();
    let a = DMatrix::from_fn(at.len(), 3, |i, k| if k < 2 { 2. * at[i][k] } else { 1. });
    let b = DVector::from_iterator(at.len(), at.iter().map(|[x, y]| x * x + y * y));
    let c = a.svd(true, true).solve(&b, 1e-14).ok()?;
    Some([x0 + c[0], y0 + c[1]])
}
