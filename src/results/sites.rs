//! The nodes as each material sees them: a value at a site belongs to one material.

use crate::model::resolve::Model;
use std::collections::BTreeMap;

/// Where materials share a node, the first has the site of the node's own number, the others one each after all nodes.
pub struct Sites {
    /// node of each site
    pub nodes: Vec<usize>,
    /// sites of each face, in the order of [`Model::faces`]
    pub faces: Vec<Vec<usize>>,
}

impl Sites {
    /// Groups of faces with the same constants are one material.
    pub fn new(model: &Model) -> Sites {
        let mut nodes: Vec<usize> = (0..model.mesh.points.len()).collect();
        let mut taken = vec![false; nodes.len()];
        let mut number: BTreeMap<(usize, Option<usize>), usize> = BTreeMap::new();
        let mut site = |node: usize, material: Option<usize>| {
            *number.entry((node, material)).or_insert_with(|| {
                if !std::mem::replace(&mut taken[node], true) {
                    return node;
                }
                nodes.push(node);
                nodes.len() - 1
            })
        };
        let faces = model.faces().map(|(cell, material)| {
            let alike = model.materials.iter().position(|(_, other)| other == material);
            model.mesh.cells[cell].nodes.iter().map(|&node| site(node, alike)).collect()
        });
        let faces = faces.collect();
        Sites { nodes, faces }
    }

    /// Values per node, given to its sites.
    pub fn spread<T: Copy>(&self, of_nodes: &[T]) -> Vec<T> {
        self.nodes.iter().map(|&node| of_nodes[node]).collect()
    }

    /// Vectors in the plane per node, given to its sites as vectors in space.
    pub fn in_space(&self, of_nodes: &[[f64; 2]]) -> Vec<[f64; 3]> {
        let in_space = |&node: &usize| [of_nodes[node][0], of_nodes[node][1], 0.];
        self.nodes.iter().map(in_space).collect()
    }
}
