//! Where the mesh comes from, and the unit that it is drawn in.

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Deserialize;

use super::schema;

/// The section `geometry` of a case.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "GeometryKeys")]
pub struct Geometry {
    /// none where the command line gives the mesh
    pub source: Option<MeshSource>,
    /// of the mesh's coordinates
    pub unit: MeshUnit,
}

#[derive(Debug, Clone, PartialEq)]
pub enum MeshSource {
    /// a Gmsh script (`.geo`, path as written) and the constants it is run with, in the script's own units
    Script { script: PathBuf, parameters: BTreeMap<String, f64> },
    /// a mesh file (`.msh`, path as written)
    Mesh(PathBuf),
}

/// Unit of length that a mesh is drawn in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
pub enum MeshUnit {
    #[serde(rename = "mm")]
    Millimetre,
    #[serde(rename = "cm")]
    Centimetre,
    #[default]
    #[serde(rename = "m")]
    Metre,
    #[serde(rename = "km")]
    Kilometre,
    #[serde(rename = "in")]
    Inch,
    #[serde(rename = "ft")]
    Foot,
}

impl MeshUnit {
    /// The symbol, and the unit's length [m].
    fn symbol_and_length(self) -> (&'static str, f64) {
        match self {
            MeshUnit::Millimetre => ("mm", 1e-3),
            MeshUnit::Centimetre => ("cm", 1e-2),
            MeshUnit::Metre => ("m", 1.),
            MeshUnit::Kilometre => ("km", 1e3),
            MeshUnit::Inch => ("in", 0.0254),
            MeshUnit::Foot => ("ft", 0.3048),
        }
    }

    /// [m]
    pub fn length(self) -> f64 {
        self.symbol_and_length().1
    }
}

impl fmt::Display for MeshUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.symbol_and_length().0)
    }
}

/// `script`, with `parameters` if wanted, or `mesh`; paths start at the case file.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object")]
#[schemars(transform = source_or_unit)]
pub(super) struct GeometryKeys {
    /// Gmsh script (.geo).
    script: Option<PathBuf>,
    /// Constants of the script (DefineConstant) by name, in its own units. Default: the script's values.
    #[serde(default)]
    parameters: BTreeMap<String, f64>,
    /// Gmsh mesh (.msh), in place of a script.
    mesh: Option<PathBuf>,
    /// Unit of the mesh's coordinates, also of one given by --mesh: "mm", "cm", "m", "km", "in", "ft". All results, and the
    /// places of probes and charges in the case, are in metres. Default: "m".
    unit: Option<MeshUnit>,
}

/// A script, or a mesh without parameters, or a unit alone.
fn source_or_unit(keys: &mut schemars::Schema) {
    let no_parameters = serde_json::json!({ "parameters": { "additionalProperties": false } });
    let mut mesh = schema::combination(&["mesh"], &["script"]);
    let mut unit = schema::combination(&["unit"], &["script", "mesh"]);
    for choice in [&mut mesh, &mut unit] {
        choice["properties"]["parameters"] = no_parameters["parameters"].clone();
    }
    keys.insert("oneOf".into(), vec![schema::combination(&["script"], &["mesh"]), mesh, unit].into());
}

impl TryFrom<GeometryKeys> for Geometry {
    type Error = &'static str;

    fn try_from(keys: GeometryKeys) -> Result<Self, Self::Error> {
        let source = match (keys.script, keys.mesh) {
            (Some(script), None) => Some(MeshSource::Script { script, parameters: keys.parameters }),
            (None, _) if !keys.parameters.is_empty() => {
                return Err("\"parameters\" belong to a \"script\", not to a \"mesh\"");
            }
            (None, Some(mesh)) => Some(MeshSource::Mesh(mesh)),
            (None, None) if keys.unit.is_some() => None,
            _ => return Err("write either \"script\" (a .geo, with \"parameters\" if wanted) or \"mesh\" (a .msh)"),
        };
        Ok(Geometry { source, unit: keys.unit.unwrap_or_default() })
    }
}
