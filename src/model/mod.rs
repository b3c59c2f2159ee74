//! What is to be solved: the mesh, the case file, and the two joined by the names of the groups.

pub mod absorbing;
pub mod arrival;
pub mod boundary;
pub mod case;
mod charge;
pub mod free_field;
mod groups;
pub mod hold;
pub mod idle;
pub mod initial;
mod loads;
pub mod mesh;
pub mod moving_front;
pub mod msh;
pub mod openings;
mod overflow;
mod plane;
pub mod probes;
pub mod quality;
pub mod resolve;
pub mod ring;
mod sampled;
pub mod sides;
pub mod split;
pub mod travel;
mod twins;
pub mod units;
