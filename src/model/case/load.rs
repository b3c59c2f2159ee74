//! Loads of a group and their laws in time.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::{Deserialize, Deserializer, de};

use super::range::{self, Number};
use crate::model::units::{ForceDensity, LineForce, Pressure, Time};
use crate::physics::pulse::Pulse;

/// One load of one group.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", expecting = "an object with one kind of load")]
pub enum Load {
    /// Pressure on a curve group [Pa]; positive presses on the body.
    Pressure(
        #[serde(deserialize_with = "pulse::<_, Pressure>")]
        #[schemars(with = "LawKeys<Pressure>")]
        Pulse,
    ),
    /// Force per area on a curve group [Pa], in a fixed direction.
    Traction(
        #[serde(deserialize_with = "directed::<_, Pressure>")]
        #[schemars(with = "DirectedKeys<Pressure>")]
        Directed,
    ),
    /// Force per volume of a face group [N/m^3].
    BodyForce(
        #[serde(deserialize_with = "directed::<_, ForceDensity>")]
        #[schemars(with = "DirectedKeys<ForceDensity>")]
        Directed,
    ),
    /// Force on a point group, per metre of depth [N/m].
    Force(
        #[serde(deserialize_with = "directed::<_, LineForce>")]
        #[schemars(with = "DirectedKeys<LineForce>")]
        Directed,
    ),
}

impl Load {
    /// Its history in time.
    pub fn pulse(&self) -> &Pulse {
        match self {
            Load::Pressure(pulse) => pulse,
            Load::Traction(d) | Load::BodyForce(d) | Load::Force(d) => &d.pulse,
        }
    }
}

/// A load along a fixed direction.
#[derive(Debug, Clone, PartialEq)]
pub struct Directed {
    /// unit vector (x, y)
    pub direction: [f64; 2],
    pub pulse: Pulse,
}

/// Name of a law in time.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum LawName {
    /// falls in a straight line from `peak` at t = 0 to zero at `duration`
    Linear,
    /// `peak` from t = 0 on
    Step,
    /// straight lines between `values` at `times`, given here or in a `file`
    Table,
}

/// A law in time: zero before t = 0.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object", bound(deserialize = "Q: Number<'de>"))]
struct LawKeys<Q> {
    law: LawName,
    /// Value at t = 0 (laws "linear" and "step").
    peak: Option<Q>,
    /// Time until zero [s], greater than 0 (law "linear").
    #[serde(default, deserialize_with = "range::optional_positive")]
    duration: Option<Time>,
    /// Times [s], each later than the one before; zero before the first, the last value held (law "table").
    times: Option<Vec<Time>>,
    /// Values at the times (law "table").
    values: Option<Vec<Q>>,
    /// Text file with a time [s] and a value [SI] a line, in place of `times` and `values` (law "table").
    file: Option<PathBuf>,
}

/// A law in time and the direction in which it acts.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object", bound(deserialize = "Q: Number<'de>"))]
struct DirectedKeys<Q> {
    law: LawName,
    /// Direction (x right, y up); only its direction counts, not its length.
    direction: [f64; 2],
    /// Value at t = 0 (laws "linear" and "step").
    peak: Option<Q>,
    /// Time until zero [s], greater than 0 (law "linear").
    #[serde(default, deserialize_with = "range::optional_positive")]
    duration: Option<Time>,
    /// Times [s], each later than the one before; zero before the first, the last value held (law "table").
    times: Option<Vec<Time>>,
    /// Values at the times (law "table").
    values: Option<Vec<Q>>,
    /// Text file with a time [s] and a value [SI] a line, in place of `times` and `values` (law "table").
    file: Option<PathBuf>,
}

fn pulse<'de, D: Deserializer<'de>, Q: Number<'de>>(input: D) -> Result<Pulse, D::Error> {
    LawKeys::<Q>::deserialize(input)?.pulse().map_err(de::Error::custom)
}

fn directed<'de, D: Deserializer<'de>, Q: Number<'de>>(input: D) -> Result<Directed, D::Error> {
    let DirectedKeys { law, direction, peak, duration, times, values, file } = DirectedKeys::<Q>::deserialize(input)?;
    let pulse = LawKeys { law, peak, duration, times, values, file }.pulse().map_err(de::Error::custom)?;
    let length = direction[0].hypot(direction[1]);
    if !(length.is_normal()) {
        return Err(de::Error::custom(format_args!("\"direction\" is {direction:?}, and must not be the zero vector")));
    }
    Ok(Directed { direction: direction.map(|d| d / length), pulse })
}

impl<Q: Into<f64>> LawKeys<Q> {
    /// The law in SI; every key must belong to it.
    fn pulse(self) -> Result<Pulse, &'static str> {
        let LawKeys { law, peak, duration, times, values, file } = self;
        match (law, peak, duration, times, values, file) {
            (LawName::Linear, Some(peak), Some(duration), None, None, None) => {
                Ok(Pulse::Linear { peak: peak.into(), duration: duration.0 })
            }
            (LawName::Step, Some(peak), None, None, None, None) => Ok(Pulse::Step { peak: peak.into() }),
            (LawName::Table, None, None, Some(times), Some(values), None) => {
                table(times.into_iter().map(|t| t.0).collect(), values.into_iter().map(Q::into).collect())
            }
            (LawName::Linear, ..) => Err("the law \"linear\" needs \"peak\" and \"duration\", and nothing else"),
            (LawName::Step, ..) => Err("the law \"step\" needs \"peak\", and nothing else"),
            (LawName::Table, ..) => {
                Err("the law \"table\" needs either \"times\" and \"values\" or a \"file\", and nothing else")
            }
        }
    }
}

fn table(times: Vec<f64>, values: Vec<f64>) -> Result<Pulse, &'static str> {
    if times.len() != values.len() || times.len() < 2 {
        return Err("a table needs as many values as times, and at least two of each");
    }
    if !times.is_sorted_by(|a, b| a < b) || times[0] < 0.0 {
        return Err("the times of a table must ascend, each later than the one before, from 0 or later");
    }
    Ok(Pulse::Table { times, values })
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
        let object = generator.subschema_for::<BTreeMap<String, Load>>();
        let list = generator.subschema_for::<Vec<BTreeMap<String, Load>>>();
        json_schema!({ "anyOf": [object, list] })
    }
}
