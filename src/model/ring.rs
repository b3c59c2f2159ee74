//! Finds out whether a body is a ring of rays: a pipe wall whose corner nodes lie on rays from one centre, each with
//! the same radii, meshed in sectors between neighbouring rays.

use super::mesh::{Cell, Mesh};
use nalgebra::{DMatrix, DVector};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

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

impl RingShape {
    /// `faces`: the body's, in `mesh`. None if they are no ring of rays.
    pub fn find(mesh: &Mesh, faces: &[usize]) -> Option<RingShape> {
        let outer = outer_border(mesh, faces)?;
        let centre = centre_of_circle(mesh, &outer)?;
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

/// The corner nodes of the outer of exactly two border loops, which have as many nodes each.
fn outer_border(mesh: &Mesh, faces: &[usize]) -> Option<Vec<usize>> {
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
    // Faces run anticlockwise, so the outer border does and the inner one does not.
    let area = |nodes: &[usize]| -> f64 {
        let cross = |i: usize| {
            let ([x0, y0], [x1, y1]) = (mesh.points[nodes[i]], mesh.points[nodes[(i + 1) % nodes.len()]]);
            (x0 * y1 - x1 * y0) / 2.
        };
        (0..nodes.len()).map(cross).sum()
    };
    // As many nodes in both: no notch.
    let two = loops.len() == 2 && loops[0].len() == loops[1].len();
    loops.into_iter().find(|l| two && l.len() > 2 && area(l) > 0.)
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
