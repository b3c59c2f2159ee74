//! The physical groups of a mesh file and their names.

use super::mesh::Group;
use super::msh::PhysicalName;
use crate::{Error, Result};
use std::collections::BTreeMap;

/// (dimension, tag) of a physical group -> its cells.
pub(super) type Members = BTreeMap<(usize, i64), Vec<usize>>;

pub(super) fn name_of(dimension: usize, tag: i64, names: &[PhysicalName]) -> String {
    match names.iter().find(|n| (n.dimension, n.tag) == (dimension, tag)) {
        Some(named) => named.name.clone(),
        None => format!("physical_{dimension}_{tag}"),
    }
}

/// The groups by dimension and name; those that the file names and no element belongs to are empty. With it how many
/// elements stand twice in a group.
///
/// Errors: two groups of one name in one dimension, which Gmsh itself does not make.
pub(super) fn named_groups(mut members: Members, names: &[PhysicalName], file: &str) -> Result<(Vec<Group>, usize)> {
    for named in names.iter().filter(|n| n.dimension <= 2) {
        members.entry((named.dimension, named.tag)).or_default();
    }
    let mut groups: Vec<(i64, Group)> = Vec::with_capacity(members.len());
    let mut twice = 0;
    for ((dimension, tag), mut cells) in members {
        let all = cells.len();
        cells.sort_unstable();
        cells.dedup();
        twice += all - cells.len();
        let name = name_of(dimension, tag, names);
        if let Some((other, same)) = groups.iter().find(|(_, g)| (g.dimension, &g.name) == (dimension, &name)) {
            return Err(Error::input(format!(
                "{file} has two physical groups of {} called \"{name}\", {other} and {tag}, and the name would mean one of \
                 them or both; give each its own name",
                same.kind()
            )));
        }
        groups.push((tag, Group { name, dimension, cells }));
    }
    let mut groups: Vec<Group> = groups.into_iter().map(|(_, group)| group).collect();
    groups.sort_by(|a, b| (a.dimension, &a.name).cmp(&(b.dimension, &b.name)));
    Ok((groups, twice))
}
