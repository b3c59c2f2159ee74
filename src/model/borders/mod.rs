//! Borders inside the solid: places where a part of the mesh lies on another, or over it, without sharing its nodes.
//! No force passes there, although the drawing shows one solid.
//!
//! Let m(x) be the number of faces that cover x. It changes only across sides that one face alone has, by one. A sound
//! mesh has m = 1 on one side of each of them and m = 0 on the other. So two parts touch where such sides lie on each
//! other, and overlap where one goes through another or the place beyond it is covered. Between the coarse and the fine
//! division of one curve lie slivers of gap and of overlap: the coarse chord spans the gap.

mod area;
mod found;
mod report;
mod search;
mod segment;
mod tree;

use super::mesh::Mesh;
use super::sides::{Edge, edge};
use crate::{Error, Result};
use found::{Found, Touch};
use report::Report;
use std::collections::HashSet;

/// The borders inside the solid of one mesh.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Borders(Found);

/// A border that the case means to be open: faces on its two sides, and where it lies [m].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slit {
    pub faces: [usize; 2],
    pub ends: [[f64; 2]; 2],
}

/// What the case means, and what is doubtful.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Allowed {
    pub slits: Vec<Slit>,
    pub warnings: Vec<String>,
}

impl Borders {
    pub fn of(mesh: &Mesh) -> Borders {
        Borders(search::search(mesh))
    }

    /// `slits`: curve groups along which two sides may lie on each other.
    ///
    /// Errors: a slit that is no group of curves; a border inside the solid that is no slit, with its place, length or
    /// area, the groups on both sides, and what to do.
    pub fn refuse(&self, mesh: &Mesh, slits: &[String]) -> Result<Allowed> {
        let mut meant: HashSet<Edge> = HashSet::new();
        let mut warnings = Vec::new();
        for name in slits {
            let lines = &mesh.group_of(name, 1, "slits:")?.cells;
            let edges: HashSet<Edge> = lines.iter().map(|&line| edge(&mesh.cells[line].nodes)).collect();
            if !self.0.touches.iter().any(|touch| self.0.edges(touch).iter().any(|e| edges.contains(e))) {
                warnings.push(format!(
                    "slits: \"{name}\" is no slit: nowhere along it do two sides lie on each other without sharing their \
                     nodes, so it has no effect"
                ));
            }
            meant.extend(edges);
        }
        let is_meant = |touch: &&Touch| self.0.edges(touch).iter().any(|e| meant.contains(e));
        let (allowed, refused): (Vec<&Touch>, Vec<&Touch>) = self.0.touches.iter().partition(is_meant);
        let report = Report::new(mesh, &self.0);
        if let Some(sentence) = report.sentence(&refused) {
            return Err(Error::input(sentence));
        }
        warnings.extend(report.hinges(&allowed));
        let slit = |touch: &Touch| Slit { faces: self.0.faces(touch), ends: touch.ends };
        Ok(Allowed { slits: allowed.into_iter().map(slit).collect(), warnings })
    }

    /// What is wrong or doubtful, for a mesh without a case, which may mean some of it.
    pub fn warnings(&self, mesh: &Mesh) -> Vec<String> {
        let report = Report::new(mesh, &self.0);
        let touches: Vec<&Touch> = self.0.touches.iter().collect();
        report.sentence(&touches).into_iter().chain(report.hinges(&[])).collect()
    }
}
