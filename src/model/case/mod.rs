//! The case file: everything about a calculation that is not geometry, in the user's words.
//!
//! The types below are the file's keys and are already in SI; how the file is read stands in `read`.
//! Values that are impossible by themselves are refused while reading, so a `Case` only holds possible ones.

mod damping;
mod duplicate;
mod explosion;
mod geometry;
mod interface;
mod law;
mod law_schema;
mod load;
mod material;
mod probe;
mod range;
mod read;
mod schema;
mod sentence;
mod set;
mod strict;
mod table;
mod time;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

use crate::model::units::{Acceleration, Length, Velocity};

use damping::DampingKeys;
pub use damping::{Damping, Rayleigh};
pub use duplicate::Unique;
pub use explosion::{Blast, ExplosionKeys};
use geometry::GeometryKeys;
pub use geometry::{Geometry, MeshSource, MeshUnit};
pub use interface::{Integration, Interface, Interfaces};
pub use load::{Clock, Directed, Load, Loads, Pressure};
pub use material::Material;
pub use probe::Probe;
pub use schema::{of_file as schema_of_file, schema};
pub use sentence::{from_serde as sentence_of, nearest};
pub use time::{Integrator, Newmark, Newton, Output, Start, TimeStepping};

/// Materials, interfaces, supports, loads and time of one calculation; every name is a physical group of the mesh.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object")]
#[schemars(transform = nothing_of_motion_in_statics)]
pub struct Case {
    /// For editors: where this schema lies; ignored.
    #[serde(rename = "$schema", default)]
    _schema: Option<String>,
    /// What is calculated, for people.
    #[serde(default)]
    pub title: String,
    /// "dynamic", or "static": equilibrium at every time step, without inertia and damping. Default: "dynamic".
    #[serde(default)]
    pub analysis: Analysis,
    /// The Gmsh script or mesh; left out where the command line gives the mesh.
    #[serde(default)]
    #[schemars(with = "Option<GeometryKeys>")]
    pub geometry: Option<Geometry>,
    /// Material of each face group.
    pub materials: BTreeMap<String, Material>,
    /// Curves that open into joints between a body and the ground, or "bonded" where they stay closed. Default: none.
    #[serde(default)]
    pub interfaces: Interfaces,
    /// Curves along which two parts may lie on each other without sharing nodes, such as cracks made by Gmsh's
    /// Plugin(Crack): no force passes there, and the two sides can move into each other. Default: none.
    #[serde(default)]
    pub slits: Vec<String>,
    /// Directions in which a curve or point group is held; "curve:NAME" where points and curves have the same name. Default: none.
    #[serde(default)]
    pub supports: BTreeMap<String, Vec<Axis>>,
    /// Boundaries by curve group that let waves out: "viscous" (base), "free_field" (upright sides, where the layers go on
    /// beyond the mesh). Default: none.
    #[serde(default)]
    pub boundaries: BTreeMap<String, Boundary>,
    /// Loads by group; an object, or a list of objects that add up. Default: none.
    #[serde(default)]
    pub loads: Loads,
    /// Rayleigh damping. Default: undamped.
    #[serde(default)]
    #[schemars(with = "Option<DampingKeys>")]
    pub damping: Option<Damping>,
    /// Gravity, downwards [m/s^2]; a dynamic calculation starts from the equilibrium under it. Default: 0.
    #[serde(default, deserialize_with = "range::not_negative")]
    #[schemars(with = "schema::NotNegative<Acceleration>")]
    pub gravity: Acceleration,
    /// Velocity and displacement at t = 0 by group, named as in supports; the rest is at rest. Default: none.
    #[serde(default)]
    pub initial: BTreeMap<String, Initial>,
    /// How elements are formulated.
    #[serde(default)]
    pub elements: Elements,
    /// Mass matrix: "consistent", "lumped", or "redistributed", which moves the mass of nodes on interfaces to the other nodes of their elements, against chatter of undamped joints. Default: "consistent".
    #[serde(default)]
    pub mass: Mass,
    /// Step, end and integrator.
    pub time: TimeStepping,
    /// Iterations of a step with contact.
    #[serde(default)]
    pub newton: Newton,
    /// Points whose history is written at every step. Default: none.
    #[serde(default)]
    pub probes: Vec<Probe>,
    #[serde(default)]
    pub output: Output,
    /// the file read
    #[serde(skip)]
    path: PathBuf,
    /// the file's content after `--set`, tables of loads read in: all that a result depends on, but the mesh
    #[serde(skip)]
    json: Value,
}

/// Statics has no motion at the start and no time in which joints chatter.
fn nothing_of_motion_in_statics(case: &mut schemars::Schema) {
    let is_static =
        serde_json::json!({ "required": ["analysis"], "properties": { "analysis": { "const": "static" } } });
    let without = serde_json::json!({ "properties": {
        "initial": { "additionalProperties": false },
        "time": { "properties": { "energy_tolerance": { "type": "null" } } },
    } });
    case.insert("if".into(), is_static);
    case.insert("then".into(), without);
}

/// A direction of the plane: x right, y up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    X,
    Y,
}

impl Axis {
    /// 0 for x, 1 for y
    pub fn index(self) -> usize {
        self as usize
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Analysis {
    #[default]
    Dynamic,
    Static,
}

/// What a curve does with the waves that reach it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Boundary {
    /// dashpots of the impedances rho c_p and rho c_s of the ground behind the curve (Lysmer and Kuhlemeyer 1969)
    Viscous,
    /// the same dashpots, on what differs from the column of ground beyond an upright side, which is computed alongside
    FreeField,
}

/// Motion of a group's nodes at t = 0.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object")]
pub struct Initial {
    /// (x, y) [m/s]. Default: 0.
    #[serde(default)]
    pub velocity: [Velocity; 2],
    /// (x, y) [m]. Default: 0.
    #[serde(default)]
    pub displacement: [Length; 2],
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default, expecting = "an object")]
pub struct Elements {
    /// Four-node quadrilaterals: "standard", or "b_bar" (mean dilatation, no volumetric locking). Default: "standard".
    pub quad4: Quad4,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Quad4 {
    #[default]
    Standard,
    BBar,
}

/// How inertia is spread over the nodes of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Mass {
    /// with the shape functions of the displacements
    #[default]
    Consistent,
    /// all at the nodes
    Lumped,
    /// consistent, but that of nodes on interfaces moved to the other nodes of their elements (Khenous, Laborde and Renard
    /// 2008)
    Redistributed,
}

impl Case {
    /// The case file, as it was given.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file's name without folder and ending: names the output folder and series.
    pub fn name(&self) -> String {
        self.path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
    }

    /// A path written in the case, seen from the working directory: relative ones start at the case file's folder.
    pub fn resolve(&self, path: &Path) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(path)
    }

    /// Unit of the mesh's coordinates.
    pub fn mesh_unit(&self) -> MeshUnit {
        self.geometry.as_ref().map_or(MeshUnit::default(), |geometry| geometry.unit)
    }

    /// What was calculated: the file after `--set`, with the tables of loads read in.
    pub fn json(&self) -> &Value {
        &self.json
    }

    /// What is calculated, in SI: equal for cases that are written in different ways only.
    pub fn meaning(&self) -> String {
        format!("{:?}", Case { json: Value::Null, path: PathBuf::new(), ..self.clone() })
    }

    /// Time between frames [s]: `output.every`, else about a hundredth of the end, in whole steps.
    pub fn frame_interval(&self) -> f64 {
        let step = self.time.step.0;
        self.output.every.map_or_else(|| step * (self.time.end.0 / 100.0 / step).round().max(1.0), f64::from)
    }
}
