//! `meshes/NAME.orders` beside the mesh: elimination orders that an earlier run has found. A run that finds none there, or
//! can leave none, only takes longer.

use crate::input::{self, Kind};
use crate::results::file;
use crate::sparse::Orders;
use std::path::{Path, PathBuf};

/// The orders beside a mesh; no orders where there is no such file, or it is not whole.
pub fn beside(mesh: &Path) -> Orders {
    input::read(&place(mesh), Kind::Mesh).ok().and_then(|bytes| Orders::from_bytes(&bytes)).unwrap_or_default()
}

/// Says so where something else has taken their place.
pub fn in_the_way(mesh: &Path) -> Option<String> {
    let place = place(mesh);
    (!is_free(&place)).then(|| {
        format!(
            "{} is none of this program's files, so it is left alone; the orders of elimination of {} would be kept there, and \
             without them each run takes longer to set up: move it away, or give the mesh another name",
            place.display(),
            mesh.display()
        )
    })
}

/// Leaves them beside the mesh if there are new ones, unless something else has taken the place.
pub fn keep(mesh: &Path, orders: &Orders) {
    let place = place(mesh);
    if orders.have_grown() && is_free(&place) {
        // The folder of a mesh may be one that cannot be written.
        file::remove_parts_of(&place);
        let _ = file::replace(&place, &orders.to_bytes());
    }
}

fn is_free(place: &Path) -> bool {
    input::read(place, Kind::Mesh).map_or(!place.exists(), |bytes| Orders::are_orders(&bytes))
}

fn place(mesh: &Path) -> PathBuf {
    mesh.with_extension("orders")
}
