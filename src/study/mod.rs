//! Whole runs: what each command does, from the case file to the last line on the screen.

pub mod blast;
pub mod check;
pub mod constants;
mod curve;
pub mod gmsh;
mod inputs;
mod loads;
pub mod mesh;
mod mesh_report;
pub mod meshing;
pub mod modes;
pub mod prepare;
mod recorder;
pub mod run;
pub mod screen;
pub mod script;
pub mod sweep;
mod unsettled;

/// `coralpipe schema`: the JSON Schema of the case file.
pub fn schema() -> String {
    format!("{:#}\n", crate::model::case::schema())
}
