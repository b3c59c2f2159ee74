//! A mesh with its interfaces open, checked and opened once for all cases that open the same ones.

use super::borders::{Allowed, Borders};
use super::mesh::Mesh;
use super::quality::refuse_folded;
use super::split::{self, Opened, Seam};
use crate::Result;
use crate::threads::both;
use std::sync::{Arc, Mutex};

/// Of one mesh.
#[derive(Debug, Default)]
pub struct Openings(Mutex<Known>);

#[derive(Debug, Default)]
struct Known {
    borders: Option<Arc<Borders>>,
    opened: Vec<(Vec<Seam>, Opened)>,
}

impl Openings {
    /// The mesh with its seams open, and the borders inside the solid that the case means by its `slits`.
    ///
    /// Errors: a folded element, those of [`Borders::refuse`] and of [`split::open`].
    pub fn of(&self, mesh: &Mesh, seams: &[Seam], slits: &[String]) -> Result<(Opened, Allowed)> {
        let mut known = self.0.lock().expect("no thread panics with it");
        if let (Some(borders), Some((_, opened))) =
            (&known.borders, known.opened.iter().find(|(open, _)| open == seams))
        {
            return Ok((opened.clone(), borders.refuse(mesh, slits)?));
        }
        let before = known.borders.clone();
        let check = || {
            refuse_folded(mesh)?;
            Ok(before.unwrap_or_else(|| Borders::of(mesh).into()))
        };
        let (borders, opened) = both(check, || split::open(mesh, seams));
        let borders = known.borders.insert(borders?);
        let allowed = borders.refuse(mesh, slits)?;
        let opened = opened?;
        known.opened.push((seams.to_vec(), opened.clone()));
        Ok((opened, allowed))
    }
}
