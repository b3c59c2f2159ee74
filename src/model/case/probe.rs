//! Points whose motion is written at every step.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::value::MapAccessDeserializer;
use serde::{Deserialize, Deserializer, de};

use crate::model::units::Length;

/// A named physical point, or a place.
#[derive(Debug, Clone, PartialEq)]
pub enum Probe {
    /// a point group of the mesh
    Group(String),
    /// a place in the plane [m]; `body` says which face group it belongs to where two meet
    Place { name: String, at: [f64; 2], body: Option<String> },
}

impl Probe {
    /// The head of its columns.
    pub fn name(&self) -> &str {
        match self {
            Probe::Group(name) | Probe::Place { name, .. } => name,
        }
    }
}

/// A place whose motion is written.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct PlaceKeys {
    /// Head of its columns.
    #[schemars(length(min = 1))]
    name: String,
    /// Coordinates x and y [m].
    at: [Length; 2],
    /// Face group the place belongs to, where two meet. Default: whichever holds it.
    body: Option<String>,
}

struct NameOrPlace;

impl<'de> de::Visitor<'de> for NameOrPlace {
    type Value = Probe;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the name of a physical point, or an object with \"name\" and \"at\": [x, y]")
    }

    fn visit_str<E: de::Error>(self, name: &str) -> Result<Probe, E> {
        Ok(Probe::Group(name.into()))
    }

    fn visit_map<A: de::MapAccess<'de>>(self, map: A) -> Result<Probe, A::Error> {
        let keys = PlaceKeys::deserialize(MapAccessDeserializer::new(map))?;
        Ok(Probe::Place { name: keys.name, at: keys.at.map(f64::from), body: keys.body })
    }
}

impl<'de> Deserialize<'de> for Probe {
    fn deserialize<D: Deserializer<'de>>(input: D) -> Result<Self, D::Error> {
        input.deserialize_any(NameOrPlace)
    }
}

impl JsonSchema for Probe {
    fn schema_name() -> Cow<'static, str> {
        "Probe".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut probe = PlaceKeys::json_schema(generator);
        probe.insert("type".into(), ["string", "object"].as_slice().into());
        probe.insert("minLength".into(), 1.into());
        probe.insert("description".into(), "The name of a physical point, or a place.".into());
        probe
    }
}
