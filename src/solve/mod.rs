//! The equations: assembled, condensed to the nodes of the interfaces, marched through time.

pub mod assembly;
pub mod condensate;
pub mod condensed;
pub mod contact;
mod diagnosis;
pub mod energy;
pub mod free_body;
pub mod free_field;
pub mod free_motion;
pub mod interface;
mod inverse;
pub mod joints;
pub mod jump_sides;
pub mod law;
pub mod least_motion;
pub mod march;
pub mod modes;
mod motion;
pub mod newmark;
mod refinement;
pub mod start;
pub mod step;
pub mod system;
mod tresca;
pub mod unknowns;
pub mod unsettled;
