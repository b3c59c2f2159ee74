//! A mesh with its interfaces open, checked and opened once for all cases that open the same ones.

use super::mesh::Mesh;
use super::quality::refuse_folded;
use super::split::{self, Opened, Seam};
use crate::Result;
use crate::threads::both;
use std::sync::Mutex;

/// Of one mesh.
#[derive(Debug, Default)]
pub struct Openings(Mutex<Vec<(Vec<Seam>, Opened)>>);

impl Openings {
    /// Errors: those of [`split::open`], and a folded element.
    pub fn of(&self, mesh: &Mesh, seams: &[Seam]) -> Result<Opened> {
        let mut known = self.0.lock().expect("no thread panics with it");
        if let Some((_, opened)) = known.iter().find(|(open, _)| open == seams) {
            return Ok(opened.clone());
        }
        let (folded, opened) = both(|| refuse_folded(mesh), || split::open(mesh, seams));
        folded?;
        let opened = opened?;
        known.push((seams.to_vec(), opened.clone()));
        Ok(opened)
    }
}
