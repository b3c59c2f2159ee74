//! Joint elements between ground and bodies, as integration points that see the jumps of their node pairs.
//!
//! Virtual work: r(j) = sum over points of area N' R' t(R N j), R turning global axes into (tangential, normal).

use super::unknowns::PairJump;
use crate::model::case::Integration;
use crate::model::mesh::Mesh;
use crate::model::split::{Joint, Pair};
use crate::physics::joint::{JointLaw, Response, Status};
use nalgebra::{Matrix2, Vector2};
use std::collections::HashMap;
use std::ops::Range;

/// Points on [-1, 1] and weights for a joint line of 2 or 3 nodes: Lobatto at the nodes (Simpson's rule for 3).
///
/// Gauss at the middle is the paper's; it leaves zig-zag jumps without energy on rings with an even number of nodes.
fn rule(integration: Integration, nodes: usize) -> Vec<(f64, f64)> {
    match (integration, nodes) {
        (Integration::Gauss1, _) => vec![(0., 2.)],
        (Integration::Lobatto, 2) => vec![(-1., 1.), (1., 1.)],
        (Integration::Lobatto, _) => vec![(-1., 1. / 3.), (0., 4. / 3.), (1., 1. / 3.)],
    }
}

/// An integration point of a joint element, or of all that have one at this place and would all answer alike: those of
/// one law that meet in a node of a smooth curve.
#[derive(Debug, Clone, PartialEq)]
pub struct JointPoint {
    /// its elements (number in the model, their part of the area [m^2]), at least one
    pub parts: Vec<(usize, f64)>,
    pub law: JointLaw,
    /// (pair, N) of the pairs that share in the jump here
    pub share: Vec<(usize, f64)>,
    /// unit normal from the body into the ground
    pub normal: [f64; 2],
    /// length times 1 m of depth that it stands for, all parts together [m^2]
    pub area: f64,
    /// where it lies [m]
    pub at: [f64; 2],
    /// which of [`Interface::seen`] it sees
    seen: Range<usize>,
}

impl JointPoint {
    /// R: rows are the tangential axis (-n_y, n_x) and the normal.
    pub fn rotation(&self) -> Matrix2<f64> {
        let [nx, ny] = self.normal;
        Matrix2::new(-ny, nx, nx, ny)
    }
}

/// What a joint point remembers of the last converged step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointState {
    /// plastic slip [m]
    pub slip: f64,
    pub status: Status,
    /// (tau, sigma_n) [Pa]
    pub traction: Vector2<f64>,
}

impl From<&Response> for JointState {
    fn from(r: &Response) -> Self {
        JointState { slip: r.slip, status: r.status, traction: r.traction }
    }
}

/// All joint points, over the vector of jumps, `count` of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Interface {
    pub count: usize,
    pub points: Vec<JointPoint>,
    /// (place in the vector of jumps, column of R N) of every jump component that a point sees, point by point
    seen: Vec<(usize, Vector2<f64>)>,
}

impl Interface {
    /// `laws` per joint element; `jumps` of each pair and axis.
    pub fn new(
        mesh: &Mesh,
        pairs: &[Pair],
        joints: &[Joint],
        laws: &[(JointLaw, Integration)],
        jumps: &[[PairJump; 2]],
    ) -> Interface {
        let points: Vec<JointPoint> = joints
            .iter()
            .zip(laws)
            .enumerate()
            .flat_map(|(number, (joint, &(law, integration)))| {
                let at: Vec<[f64; 2]> = joint.pairs.iter().map(|&p| mesh.points[pairs[p].ground]).collect();
                rule(integration, joint.pairs.len())
                    .into_iter()
                    .map(move |(r, w)| joint_point(number, joint, law, &at, r, w))
            })
            .collect();
        let count = jumps.iter().flatten().flatten().map(|(place, _)| place + 1).max().unwrap_or(0);
        let mut points = united(with_common_normals(points));
        let mut seen = Vec::new();
        for point in &mut points {
            let first = seen.len();
            seen.extend(seen_by(point, jumps));
            point.seen = first..seen.len();
        }
        Interface { count, points, seen }
    }

    fn seen_by(&self, point: &JointPoint) -> &[(usize, Vector2<f64>)] {
        &self.seen[point.seen.clone()]
    }

    /// Integration points of all joint elements, each counted by itself.
    pub fn element_points(&self) -> usize {
        self.points.iter().map(|point| point.parts.len()).sum()
    }

    /// R N j: (tangential, normal) jump at a point [as j].
    pub fn local(&self, point: &JointPoint, j: &[f64]) -> Vector2<f64> {
        self.seen_by(point).iter().map(|&(place, column)| column * j[place]).sum()
    }

    /// r(j) [N] of the points' tractions.
    pub fn forces(&self, tractions: impl Iterator<Item = Vector2<f64>>) -> Vec<f64> {
        self.forces_at(tractions.enumerate())
    }

    /// The same of the tractions (number of the point, traction) that some points have.
    pub fn forces_at(&self, tractions: impl Iterator<Item = (usize, Vector2<f64>)>) -> Vec<f64> {
        let mut r = vec![0.; self.count];
        for (number, traction) in tractions {
            let point = &self.points[number];
            self.seen_by(point).iter().for_each(|(place, column)| r[*place] += column.dot(&traction) * point.area);
        }
        r
    }

    /// Calls `add(row, column, value)` for a point's part of dr/dj = sum area N' R' D R N [N/m].
    pub fn tangent(&self, point: &JointPoint, d: &Matrix2<f64>, mut add: impl FnMut(usize, usize, f64)) {
        for &(j, of_j) in self.seen_by(point) {
            let traction = d * of_j * point.area;
            self.seen_by(point).iter().for_each(|(i, of_i)| add(*i, j, of_i.dot(&traction)));
        }
    }

    /// (place, entry of N'R' times something in local axes) of every jump component that a point sees.
    pub fn pulls(&self, point: &JointPoint, local: Vector2<f64>) -> Vec<(usize, f64)> {
        self.seen_by(point).iter().map(|(place, column)| (*place, column.dot(&local))).collect()
    }

    /// Where in the vector of jumps a point finds its own.
    pub fn places<'a>(&'a self, point: &'a JointPoint) -> impl Iterator<Item = usize> + 'a {
        self.seen_by(point).iter().map(|&(place, _)| place)
    }

    /// A point that sees jump component `place`, if any does.
    pub fn point_of(&self, place: usize) -> Option<usize> {
        self.points.iter().position(|point| self.places(point).any(|i| i == place))
    }
}

/// (place, column of R N) of the jumps that a point sees; `jumps` of each pair and axis.
fn seen_by(point: &JointPoint, jumps: &[[PairJump; 2]]) -> Vec<(usize, Vector2<f64>)> {
    let rotation = point.rotation();
    let mut seen: Vec<(usize, Vector2<f64>)> = Vec::new();
    for &(pair, n) in &point.share {
        for axis in 0..2 {
            for &(place, sign) in &jumps[pair][axis] {
                let column = rotation.column(axis) * (n * sign);
                match seen.iter_mut().find(|(known, _)| *known == place) {
                    Some((_, sum)) => *sum += column,
                    None => seen.push((place, column)),
                }
            }
        }
    }
    seen
}

/// Where two elements of a curve meet in a node under less than this, the curve is taken as smooth there: cos 30
/// degrees.
const SMOOTH: f64 = 0.866;

/// Points at one pair share the mean of their elements' normals, weighted by area, unless the curve has a corner there.
///
/// With each element's own normal a body that slips along a polygon would open one element's point and press the
/// other's.
fn with_common_normals(points: Vec<JointPoint>) -> Vec<JointPoint> {
    let mut at_pair: HashMap<usize, Vec<usize>> = HashMap::new();
    for (i, point) in points.iter().enumerate() {
        if let [(pair, _)] = point.share[..] {
            at_pair.entry(pair).or_default().push(i);
        }
    }
    let mut smooth = points.clone();
    for group in at_pair.values() {
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let sum = [0, 1].map(|k| group.iter().map(|&i| points[i].area * points[i].normal[k]).sum::<f64>());
        let length = sum[0].hypot(sum[1]);
        let mean = sum.map(|x| x / length);
        if group.iter().all(|&i| group.iter().all(|&j| dot(points[i].normal, points[j].normal) > SMOOTH)) {
            group.iter().for_each(|&i| smooth[i].normal = mean);
        }
    }
    smooth
}

/// One point for all that see one pair from one side under one law.
fn united(points: Vec<JointPoint>) -> Vec<JointPoint> {
    let mut united: Vec<JointPoint> = Vec::new();
    let mut at_pair: HashMap<usize, Vec<usize>> = HashMap::new();
    for point in points {
        let alike = |&&i: &&usize| (united[i].normal, united[i].law) == (point.normal, point.law);
        let known = match point.share[..] {
            [(pair, _)] => at_pair.entry(pair).or_default(),
            _ => &mut vec![],
        };
        match known.iter().find(alike) {
            Some(&i) => {
                united[i].area += point.area;
                united[i].parts.extend(point.parts);
            }
            None => {
                known.push(united.len());
                united.push(point);
            }
        }
    }
    united
}

/// The joint runs anticlockwise round the body, so the outward normal is the tangent turned by -90 degrees.
fn joint_point(number: usize, joint: &Joint, law: JointLaw, at: &[[f64; 2]], r: f64, weight: f64) -> JointPoint {
    let functions = joint.shape.functions([r, 0.]);
    let sum = |f: &dyn Fn(usize) -> f64| (0..at.len()).map(f).sum::<f64>();
    let tangent = [0, 1].map(|i| sum(&|a| functions[a].1[0] * at[a][i]));
    let det = tangent[0].hypot(tangent[1]);
    let share = joint.pairs.iter().zip(&functions).map(|(&p, f)| (p, f.0));
    JointPoint {
        parts: vec![(number, det * weight)],
        law,
        share: share.filter(|(_, n)| *n != 0.).collect(),
        normal: [tangent[1] / det, -tangent[0] / det],
        area: det * weight,
        at: [0, 1].map(|i| sum(&|a| functions[a].0 * at[a][i])),
        seen: 0..0,
    }
}

#[cfg(test)]
pub mod testing {
    use super::*;
    use crate::model::mesh::Shape;

    /// Joints with these laws along a line of nodes, each of them a pair, the body above it.
    pub fn along(nodes: &[[f64; 2]], laws: &[JointLaw]) -> Interface {
        let count = nodes.len();
        let mesh = Mesh { points: [nodes, nodes].concat(), ..Mesh::default() };
        let pairs: Vec<Pair> = (0..count).map(|p| Pair { ground: p, body: count + p }).collect();
        let joint =
            |p: usize| Joint { seam: 0, shape: Shape::Line2, pairs: vec![p, p + 1], ground_cell: 0, body_cell: 0 };
        let joints: Vec<Joint> = (0..laws.len()).map(joint).collect();
        let laws: Vec<(JointLaw, Integration)> = laws.iter().map(|law| (*law, Integration::Lobatto)).collect();
        let jumps: Vec<_> = (0..count).map(|p| [vec![(2 * p, 1.)], vec![(2 * p + 1, 1.)]]).collect();
        Interface::new(&mesh, &pairs, &joints, &laws, &jumps)
    }

    pub const LAW: JointLaw = JointLaw {
        normal_stiffness: 50.,
        tangential_stiffness: 20.,
        friction: crate::physics::joint::Friction::Coulomb(0.3),
        gap: 0.,
    };
}

#[cfg(test)]
mod tests {
    use super::testing::{LAW, along};
    use super::*;
    use crate::physics::joint::Friction;

    #[test]
    fn elements_of_one_law_on_a_smooth_line_share_their_points() {
        let interface = along(&[[0., 0.], [1., 0.], [4., 0.]], &[LAW, LAW]);
        let parts: Vec<_> = interface.points.iter().map(|p| (p.area, p.parts.clone())).collect();
        let of_two = (2., vec![(0, 0.5), (1, 1.5)]);
        assert_eq!(parts, [(0.5, vec![(0, 0.5)]), of_two, (1.5, vec![(1, 1.5)])]);
        assert_eq!(interface.element_points(), 4);
    }

    #[test]
    fn elements_of_other_laws_or_round_a_corner_keep_their_own_points() {
        let slippery = JointLaw { friction: Friction::Coulomb(0.1), ..LAW };
        let straight = along(&[[0., 0.], [1., 0.], [4., 0.]], &[LAW, slippery]);
        assert_eq!(straight.points.iter().map(|p| p.law.friction).filter(|f| *f == LAW.friction).count(), 2);
        let corner = along(&[[0., 0.], [1., 0.], [1., 3.]], &[LAW, LAW]);
        let normals: Vec<[f64; 2]> = corner.points.iter().map(|p| p.normal).collect();
        assert_eq!(normals, [[0., -1.], [0., -1.], [1., 0.], [1., 0.]]);
        assert!([straight, corner].iter().all(|i| i.points.iter().all(|p| p.parts.len() == 1)));
    }
}
