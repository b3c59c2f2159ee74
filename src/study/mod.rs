//! Whole runs: what each command does, from the case file to the last line on the screen.

pub mod blast;
pub mod check;
pub mod constants;
mod content;
pub mod converge;
mod cost;
mod curve;
mod damping;
pub mod domain;
mod equilibria;
mod finished;
pub mod gmsh;
mod history;
mod inputs;
mod loads;
mod memory;
mod mentions;
pub mod mesh;
mod mesh_report;
pub mod meshing;
pub mod modes;
mod orders;
mod overflow;
pub mod prepare;
mod quantity;
mod record;
mod recorder;
mod richardson;
pub mod run;
pub mod screen;
pub mod script;
mod series;
mod sources;
pub mod sweep;
mod temporary;
mod unsettled;
mod words;

/// `coralpipe schema`: the JSON Schema of the case file, or of the plan of a sweep.
pub fn schema(of_sweep: bool) -> String {
    format!("{:#}\n", if of_sweep { sweep::schema() } else { crate::model::case::schema() })
}
