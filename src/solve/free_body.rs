//! Bodies that joints alone hold, and the rigid motions that supports leave them.

use super::unknowns::Unknowns;
use crate::model::hold::{Part, held_by_joints, pivot};
use crate::model::resolve::Model;
use std::borrow::Cow;
use std::sync::Arc;

/// A body that joints alone hold.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeBody {
    /// its surfaces
    pub name: String,
    /// the rigid motions that supports leave it
    pub motions: Vec<(Way, Motion)>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Way {
    X,
    Y,
    Turn,
}

/// (unknown, displacement [m]) of the body's nodes at interfaces.
pub type Motion = Vec<(usize, f64)>;

impl FreeBody {
    /// Boundaries that let waves out hold the ground here, as they do without inertia.
    pub fn all(model: &Model, unknowns: &Unknowns) -> Arc<[FreeBody]> {
        let model = &if model.absorbers.is_empty() { Cow::Borrowed(model) } else { Cow::Owned(model.held()) };
        let body = |part: Part| {
            let at_border = |&n: &usize| unknowns.of(n, 0).or(unknowns.of(n, 1)).is_some_and(|i| i >= unknowns.border);
            let nodes: Vec<usize> = part.nodes.iter().copied().filter(at_border).collect();
            FreeBody { name: part.name(), motions: motions(model, unknowns, &nodes, &part.nodes) }
        };
        held_by_joints(model).into_iter().map(body).filter(|body| !body.motions.is_empty()).collect()
    }

    /// Those that its motions move.
    pub fn unknowns(&self) -> impl Iterator<Item = usize> + '_ {
        self.motions.iter().flat_map(|(_, motion)| motion.iter().map(|&(unknown, _)| unknown))
    }
}

/// A shift along each axis in which no support holds the body, and the turn that supports leave it; the farthest node
/// goes 1 m.
fn motions(model: &Model, unknowns: &Unknowns, nodes: &[usize], of_part: &[usize]) -> Vec<(Way, Motion)> {
    let pivot = pivot(model, of_part);
    let about = pivot.unwrap_or_default();
    let arm = |n: usize| [0, 1].map(|i| model.mesh.points[n][i] - about[i]);
    let farthest = nodes.iter().map(|&n| arm(n)[0].hypot(arm(n)[1])).fold(f64::MIN_POSITIVE, f64::max);
    let displacement = |way: Way, n: usize| match way {
        Way::X => [1., 0.],
        Way::Y => [0., 1.],
        Way::Turn => [-arm(n)[1] / farthest, arm(n)[0] / farthest],
    };
    let held = [0, 1].map(|axis| of_part.iter().any(|&n| model.fixed[n][axis]));
    let is_free = |way: &Way| match way {
        Way::X => !held[0],
        Way::Y => !held[1],
        Way::Turn => pivot.is_some(),
    };
    let motion = |way: Way| {
        let of_node = |&n: &usize| {
            [0, 1].into_iter().filter_map(move |axis| Some((unknowns.of(n, axis)?, displacement(way, n)[axis])))
        };
        (way, nodes.iter().flat_map(of_node).collect())
    };
    let ways = [Way::X, Way::Y, Way::Turn].into_iter().filter(is_free);
    ways.map(motion).filter(|(_, motion): &(Way, Motion)| !motion.is_empty()).collect()
}
