//! A curve between a body and the ground that opens and slips.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::{Deserialize, Deserializer, de};

use super::range;
use super::schema::{NotNegative, Positive};
use crate::model::units::{JointStiffness, Length};

/// Interfaces by curve group.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Interfaces {
    /// that open into joints
    pub opened: BTreeMap<String, Interface>,
    /// that the case leaves closed, since it says "bonded"
    pub bonded: BTreeSet<String>,
}

/// What the case says of one interface.
enum Choice {
    Opened(Interface),
    Bonded,
}

/// The word for an interface whose two sides share their nodes.
const BONDED: &str = "bonded";

impl<'de> Deserialize<'de> for Choice {
    fn deserialize<D: Deserializer<'de>>(input: D) -> Result<Choice, D::Error> {
        struct JointsOrBonded;
        impl<'de> de::Visitor<'de> for JointsOrBonded {
            type Value = Choice;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "an object or \"{BONDED}\"")
            }

            fn visit_str<E: de::Error>(self, word: &str) -> Result<Choice, E> {
                match word {
                    BONDED => Ok(Choice::Bonded),
                    _ => Err(E::invalid_value(de::Unexpected::Str(word), &self)),
                }
            }

            fn visit_map<A: de::MapAccess<'de>>(self, map: A) -> Result<Choice, A::Error> {
                Interface::deserialize(MapAccessDeserializer::new(map)).map(Choice::Opened)
            }
        }
        input.deserialize_any(JointsOrBonded)
    }
}

impl<'de> Deserialize<'de> for Interfaces {
    fn deserialize<D: Deserializer<'de>>(input: D) -> Result<Interfaces, D::Error> {
        let mut interfaces = Interfaces::default();
        for (curve, choice) in BTreeMap::<String, Choice>::deserialize(input)? {
            match choice {
                Choice::Opened(interface) => drop(interfaces.opened.insert(curve, interface)),
                Choice::Bonded => drop(interfaces.bonded.insert(curve)),
            }
        }
        Ok(interfaces)
    }
}

impl JsonSchema for Interfaces {
    fn schema_name() -> Cow<'static, str> {
        "Interfaces".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let interface = generator.subschema_for::<Interface>();
        json_schema!({
            "type": "object",
            "additionalProperties": {
                "anyOf": [interface, { "const": BONDED, "description": "Both sides share their nodes." }]
            },
        })
    }
}

/// Zero-thickness joints with the stiffness of a thin layer of the ground beside them.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object")]
pub struct Interface {
    /// Group of surfaces on the side that the normal leaves; the other side is the ground.
    pub body: String,
    /// Thickness t [m] of the thin layer of ground, greater than 0: the stiffness is E_oed/t (normal) and G/t (tangential). Default: 1 cm.
    #[serde(default = "one_centimetre", deserialize_with = "range::positive")]
    #[schemars(with = "Positive<Length>")]
    pub thickness: Length,
    /// Points where the joint law holds: "lobatto" (nodes) or "gauss_1" (one in the middle, as the paper). Default: "lobatto".
    #[serde(default)]
    pub integration: Integration,
    /// Coefficient of Coulomb friction [-], at least 0. Default: that of the ground's material.
    #[serde(default, deserialize_with = "range::optional_not_negative")]
    #[schemars(extend("minimum" = 0))]
    pub friction: Option<f64>,
    /// Normal stiffness [Pa/m], greater than 0. Default: E_oed/t of the ground.
    #[serde(default, deserialize_with = "range::optional_positive")]
    #[schemars(with = "Option<Positive<JointStiffness>>")]
    pub normal_stiffness: Option<JointStiffness>,
    /// Tangential stiffness [Pa/m], greater than 0. Default: G/t of the ground.
    #[serde(default, deserialize_with = "range::optional_positive")]
    #[schemars(with = "Option<Positive<JointStiffness>>")]
    pub tangential_stiffness: Option<JointStiffness>,
    /// Normal gap at the start [m], at least 0. Default: 0.
    #[serde(default, deserialize_with = "range::not_negative")]
    #[schemars(with = "NotNegative<Length>")]
    pub gap: Length,
}

fn one_centimetre() -> Length {
    Length(0.01)
}

/// Integration points of a joint element.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
pub enum Integration {
    /// at the nodes: 2 points for the 4-node joint, 3 for the 6-node one
    #[default]
    #[serde(rename = "lobatto")]
    Lobatto,
    /// one point in the middle: the paper's, with zig-zag modes of zero energy
    #[serde(rename = "gauss_1")]
    Gauss1,
}
