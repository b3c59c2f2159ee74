//! Loads of a group.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::{Deserialize, Deserializer, de};
use serde_json::{Map, Value, json};

use super::law;
use super::law_schema::{DirectedLaw, PressureLaw};
use crate::model::units::{self, ForceDensity, LineForce};
use crate::physics::front::Front;
use crate::physics::pulse::Pulse;

/// One load of one group.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", expecting = "an object with one kind of load")]
#[schemars(transform = one_kind)]
pub enum Load {
    /// Pressure on a curve group [Pa]; positive presses on the body.
    Pressure(
        #[serde(deserialize_with = "law::pressure")]
        #[schemars(with = "PressureLaw")]
        Pressure,
    ),
    /// Force per area on a curve group [Pa], in a fixed direction.
    Traction(
        #[serde(deserialize_with = "law::directed::<_, units::Pressure>")]
        #[schemars(with = "DirectedLaw<units::Pressure>")]
        Directed,
    ),
    /// Force per volume of a face group [N/m^3].
    BodyForce(
        #[serde(deserialize_with = "law::directed::<_, ForceDensity>")]
        #[schemars(with = "DirectedLaw<ForceDensity>")]
        Directed,
    ),
    /// Force on a point group, per metre of depth [N/m].
    Force(
        #[serde(deserialize_with = "law::directed::<_, LineForce>")]
        #[schemars(with = "DirectedLaw<LineForce>")]
        Directed,
    ),
}

impl Load {
    /// Of the group that it acts on: 0 points, 1 curves, 2 surfaces.
    pub fn dimension(&self) -> usize {
        match self {
            Load::Pressure(_) | Load::Traction(_) => 1,
            Load::BodyForce(_) => 2,
            Load::Force(_) => 0,
        }
    }
}

/// In place of a choice of objects one object with a choice of keys: what is wrong inside is then reported at its place.
fn one_kind(load: &mut Schema) {
    let Some(Value::Array(kinds)) = load.remove("oneOf") else { return };
    let mut properties = Map::new();
    let mut choices = Vec::new();
    for kind in kinds {
        for (key, law) in kind["properties"].as_object().into_iter().flatten() {
            properties.insert(key.clone(), json!({ "$ref": law["$ref"], "description": kind["description"] }));
        }
        choices.push(json!({ "required": kind["required"] }));
    }
    load.insert("type".into(), "object".into());
    load.insert("properties".into(), properties.into());
    load.insert("additionalProperties".into(), false.into());
    load.insert("oneOf".into(), choices.into());
}

/// How a pressure acts on a curve.
#[derive(Debug, Clone, PartialEq)]
pub enum Pressure {
    /// everywhere at once
    Simultaneous(Pulse),
    /// where the front has passed
    Sweeping(Front, Clock),
    /// either of these, of an explosion whose burst and wave do not quite fit its place
    Noted { pressure: Box<Pressure>, note: String },
}

/// What t = 0 is, where a load sweeps over a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Clock {
    /// the front reaches the curve
    #[default]
    Arrival,
    /// the charge explodes
    Detonation,
}

/// A load along a fixed direction.
#[derive(Debug, Clone, PartialEq)]
pub struct Directed {
    /// unit vector (x, y)
    pub direction: [f64; 2],
    pub pulse: Pulse,
}

/// Loads by group; several such objects add up.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Loads(Vec<BTreeMap<String, Load>>);

impl Loads {
    /// Every load with the name of its group.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Load)> {
        self.0.iter().flatten().map(|(group, load)| (group.as_str(), load))
    }
}

struct ObjectOrList;

impl<'de> de::Visitor<'de> for ObjectOrList {
    type Value = Loads;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object with a load for each group, or a list of such objects")
    }

    fn visit_map<A: de::MapAccess<'de>>(self, map: A) -> Result<Loads, A::Error> {
        Ok(Loads(vec![BTreeMap::deserialize(MapAccessDeserializer::new(map))?]))
    }

    fn visit_seq<A: de::SeqAccess<'de>>(self, list: A) -> Result<Loads, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(list)).map(Loads)
    }
}

impl<'de> Deserialize<'de> for Loads {
    fn deserialize<D: Deserializer<'de>>(input: D) -> Result<Self, D::Error> {
        input.deserialize_any(ObjectOrList)
    }
}

impl JsonSchema for Loads {
    fn schema_name() -> Cow<'static, str> {
        "Loads".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let load = generator.subschema_for::<Load>();
        let object = generator.subschema_for::<BTreeMap<String, Load>>();
        json_schema!({ "type": ["object", "array"], "additionalProperties": load, "items": object })
    }
}
