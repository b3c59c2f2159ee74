//! Which cells and nodes of the frames belong to each physical group, as arrays of 0 and 1 to threshold by.

use super::xml_text::possible;
use crate::model::resolve::Model;
use std::collections::{BTreeMap, HashMap};

/// A list of 0 and 1 for each name, `group_` before that of the group: without blanks or colons the Calculator of
/// ParaView takes it as a variable. Groups of one name are one list.
pub struct Groups {
    /// for each cell of a frame: surfaces on faces, open interfaces on their line cells
    pub cells: BTreeMap<String, Vec<u8>>,
    /// for each node of the mesh: curves, an open interface with both its sides, and points
    pub nodes: BTreeMap<String, Vec<u8>>,
}

impl Groups {
    pub fn new(model: &Model) -> Groups {
        let mut groups = Groups { cells: BTreeMap::new(), nodes: BTreeMap::new() };
        let place: HashMap<usize, usize> = model.faces().enumerate().map(|(place, (cell, _))| (cell, place)).collect();
        let [cells, nodes] = [place.len() + model.joints.len(), model.mesh.points.len()];
        for group in model.mesh.groups.iter().filter(|group| !group.cells.is_empty() && !group.is_a_side()) {
            if group.dimension == 2 {
                mark(&mut groups.cells, &group.name, cells, group.cells.iter().map(|cell| place[cell]));
            } else {
                let ground = model.mesh.ground_side(group).filter(|_| group.dimension == 1);
                let members = std::iter::once(group).chain(ground).flat_map(|group| model.mesh.nodes_of(group));
                mark(&mut groups.nodes, &group.name, nodes, members);
            }
        }
        for (seam, curve) in model.seams.iter().map(|seam| &seam.curve).enumerate() {
            // the case may write "curve:NAME"
            let name = model.mesh.group_of(curve, 1, "interface").map_or(curve, |group| &group.name);
            let lines = model.joints.iter().enumerate().filter(|(_, joint)| joint.seam == seam);
            mark(&mut groups.cells, name, cells, lines.map(|(number, _)| place.len() + number));
        }
        groups
    }
}

fn mark(lists: &mut BTreeMap<String, Vec<u8>>, name: &str, length: usize, members: impl Iterator<Item = usize>) {
    let list = lists.entry(format!("group_{}", possible(name))).or_insert_with(|| vec![0; length]);
    members.for_each(|member| list[member] = 1);
}
