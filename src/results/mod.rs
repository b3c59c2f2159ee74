//! What people look at: frames for ParaView, histories, stresses, the summary.

pub mod columns;
pub mod csv;
pub mod file;
pub mod folder;
pub mod foreign;
pub mod frame;
pub mod grid;
pub mod groups;
pub mod histories;
pub mod hoop;
pub mod lines;
pub mod motion;
pub mod nodal;
pub mod plot;
pub mod polar;
pub mod previous;
pub mod ring;
pub mod ring_table;
mod run_files;
pub mod series;
pub mod sites;
pub mod snapshots;
pub mod spectrum;
pub mod stress;
pub mod summary;
pub mod vtu;
mod xml_text;
