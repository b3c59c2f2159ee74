//! How the nodes move at t = 0.

use super::case::Case;
use super::mesh::Mesh;
use crate::number::place;
use crate::{Error, Result};

/// Motion of the nodes at t = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Initial {
    pub displacement: Vec<[f64; 2]>,
    pub velocity: Vec<[f64; 2]>,
}

/// (displacement, velocity) [m], [m/s]
type Motion = [[f64; 2]; 2];

/// The case's displacement and velocity by group; nodes of no such group are at rest.
///
/// Errors: groups that do not exist, or that share a node and give it different motions.
pub fn initial(case: &Case, mesh: &Mesh) -> Result<Initial> {
    let mut given: Vec<Option<(&str, Motion)>> = vec![None; mesh.points.len()];
    for (name, motion) in &case.initial {
        let group = mesh.group(name).map_err(|e| Error::input(format!("initial: {e}")))?;
        let new = [motion.displacement.map(f64::from), motion.velocity.map(f64::from)];
        for node in mesh.copies_of(group).flat_map(|group| mesh.nodes_of(group)) {
            if let Some((other, old)) = given[node].replace((name, new)).filter(|(_, old)| *old != new) {
                let place = place(mesh.points[node]);
                let [what, old, new] = match old[0] != new[0] {
                    true => ["displacement (m)".into(), format!("{:?}", old[0]), format!("{:?}", new[0])],
                    false => ["velocity (m/s)".into(), format!("{:?}", old[1]), format!("{:?}", new[1])],
                };
                return Err(Error::input(format!(
                    "initial: \"{other}\" and \"{name}\" share the node at {place} and give it different motions, \
                     {what} {old} and {new}: give both the same, or put an interface between them"
                )));
            }
        }
    }
    let of = |which: usize| given.iter().map(|g| g.map_or([0.; 2], |(_, motion)| motion[which])).collect();
    Ok(Initial { displacement: of(0), velocity: of(1) })
}
