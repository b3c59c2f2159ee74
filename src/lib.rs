//! Buried pipes and layered ground under a blast wave: plane-strain finite elements with opening and
//! slipping joints, from a Gmsh geometry to a ParaView time series.
//!
//! One folder is one floor, and imports go down only:
//! `study -> results -> solve -> model -> physics`, with `sparse` beside `physics` at the bottom.
//!
//! Conventions, said once: SI units; `x` right, `y` up; tension positive; a joint's normal points from the body into
//! the ground and its gap is positive when open; thickness out of the plane is 1 m; `dof(node n, axis i) = 2n + i`.

pub mod error;
pub mod escape;
mod free_memory;
mod input;
pub mod model;
pub mod number;
pub mod physics;
pub mod results;
pub mod solve;
pub mod sparse;
pub mod study;
mod threads;

pub use error::{Error, Result};
