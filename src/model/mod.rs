//! What is to be solved: the mesh, the case file, and the two joined by the names of the groups.

pub mod absorbing;
pub mod boundary;
pub mod case;
pub mod free_field;
pub mod mesh;
pub mod msh;
mod plane;
pub mod probes;
pub mod quality;
pub mod resolve;
pub mod ring;
pub mod split;
pub mod sweep;
pub mod units;
