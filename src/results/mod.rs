//! What people look at: frames for ParaView, histories, stresses, the summary.

pub mod file;
pub mod folder;
pub mod frame;
pub mod histories;
pub mod ring;
pub mod series;
pub mod stress;
pub mod summary;
