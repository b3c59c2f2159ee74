//! `meshes/NAME.orders` beside the mesh: elimination orders that an earlier run has found. A run that finds none there, or
//! can leave none, only takes longer.

use crate::results::file;
use crate::sparse::Orders;
use std::path::{Path, PathBuf};

/// The orders beside a mesh; no orders where there is no such file, or it is not whole.
pub fn beside(mesh: &Path) -> Orders {
    std::fs::read(place(mesh)).ok().and_then(|bytes| Orders::from_bytes(&bytes)).unwrap_or_default()
}

/// Leaves them beside the mesh if there are new ones, unless something else has taken the place.
pub fn keep(mesh: &Path, orders: &Orders) {
    let place = place(mesh);
    let is_free = std::fs::read(&place).map_or(!place.exists(), |bytes| Orders::are_orders(&bytes));
    if orders.have_grown() && is_free {
        // The folder of a mesh may be one that cannot be written.
        let _ = file::replace(&place, &orders.to_bytes());
    }
}

fn place(mesh: &Path) -> PathBuf {
    mesh.with_extension("orders")
}
