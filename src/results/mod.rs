//! What people look at: frames for ParaView, histories, stresses, the summary.

pub mod file;
pub mod folder;
pub mod frame;
pub mod histories;
pub mod hoop;
pub mod motion;
pub mod nodal;
pub mod ring;
pub mod ring_table;
pub mod series;
pub mod sites;
pub mod stress;
pub mod summary;
