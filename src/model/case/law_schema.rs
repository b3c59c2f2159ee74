//! The JSON Schema of laws in time: for each law an object of its own, told apart by the key `law`.

use std::borrow::Cow;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Map, Value, json};

use super::law::{COMMON_KEYS, LawKeys, LawName};
use super::schema::{Zero, combination};
use crate::model::units::{self, Time};

/// Laws of a pressure [Pa], which may have a front.
pub struct PressureLaw;

/// Laws of a load along a direction, values in Q.
pub struct DirectedLaw<Q>(PhantomData<Q>);

impl JsonSchema for PressureLaw {
    fn schema_name() -> Cow<'static, str> {
        "PressureLaw".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        choice::<units::Pressure>(generator, &LawName::ALL, &[], &["front"])
    }
}

impl<Q: JsonSchema> JsonSchema for DirectedLaw<Q> {
    fn schema_name() -> Cow<'static, str> {
        format!("DirectedLaw{}", Q::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let laws: Vec<LawName> = LawName::ALL.into_iter().filter(|law| *law != LawName::Charge).collect();
        choice::<Q>(generator, &laws, &["direction"], &[])
    }
}

/// One of the laws, with keys of the kind of load that it must and that it may have. A wrong name is an error at its own
/// place, whatever else is wrong.
fn choice<Q: JsonSchema>(generator: &mut SchemaGenerator, laws: &[LawName], must: &[&str], may: &[&str]) -> Schema {
    let all = LawKeys::<Q>::json_schema(generator);
    let property = |key: &str| all.get("properties").map_or(Value::Null, |properties| properties[key].clone());
    let names: Vec<&str> = laws.iter().map(|law| law.keys().0).collect();
    let zero = Value::from(Option::<Zero<Time>>::json_schema(generator));
    let laws: Vec<Value> = laws.iter().map(|law| object(*law, must, may, &property, &zero)).collect();
    json_schema!({
        "description": all.get("description"),
        "allOf": [{ "required": ["law"], "properties": { "law": { "enum": names } } }],
        "oneOf": laws,
    })
}

/// The object of one law; `zero` is the schema of a rise that must be none.
fn object(law: LawName, must: &[&str], may: &[&str], property: &dyn Fn(&str) -> Value, zero: &Value) -> Value {
    let (name, _, required, optional) = law.keys();
    let (required, optional) = match law {
        LawName::Table => (&[][..], &["times", "values", "file"][..]),
        _ => (required, optional),
    };
    let required = [required, must].concat();
    let mut properties = Map::from_iter([("law".to_string(), json!({ "const": name, "description": law.words() }))]);
    properties.extend(required.iter().map(|key| (key.to_string(), not_null(property(key)))));
    properties.extend([optional, may, &COMMON_KEYS].concat().iter().map(|key| (key.to_string(), property(key))));
    if matches!(law, LawName::Ramp | LawName::HalfSine) {
        let none = "Only 0: this law begins at zero and has no jump to rise over.";
        properties.insert("rise".into(), json!({ "allOf": [zero], "description": none }));
    }
    if law != LawName::Charge && may.contains(&"front") {
        let front = json!({ "allOf": [not_null(property("front")), combination(&["speed"], &[])] });
        properties.insert("front".into(), json!({ "anyOf": [front, { "type": "null" }] }));
    }
    let keys: Vec<&str> = ["law"].into_iter().chain(required).collect();
    let mut object = Map::from_iter([("type".to_string(), json!("object")), ("title".to_string(), json!(name))]);
    object.extend([("properties".to_string(), properties.into()), ("required".to_string(), json!(keys))]);
    object.insert("additionalProperties".into(), false.into());
    object.extend(together(law));
    object.into()
}

/// Which of a law's keys exclude or need each other.
fn together(law: LawName) -> Map<String, Value> {
    let rules = match law {
        LawName::Table => vec![("oneOf", table())],
        LawName::Friedlander => vec![("oneOf", decay_or_impulse()), ("anyOf", negative_phase())],
        LawName::Charge => vec![("anyOf", own_front())],
        LawName::Linear | LawName::Step | LawName::Ramp | LawName::HalfSine => vec![],
    };
    rules.into_iter().map(|(keyword, choices)| (keyword.to_string(), choices)).collect()
}

fn decay_or_impulse() -> Value {
    json!([combination(&["decay"], &["impulse"]), combination(&["impulse"], &["decay"])])
}

/// Times and values here, or in a file.
fn table() -> Value {
    json!([combination(&["times", "values"], &["file"]), combination(&["file"], &["times", "values"])])
}

/// None, or with both its keys and not for straight lines.
fn negative_phase() -> Value {
    let keys = ["negative_peak", "negative_duration"];
    let mut both = combination(&keys, &[]);
    both["properties"]["form"] = json!({ "enum": ["friedlander", null] });
    json!([combination(&[], &keys), both])
}

/// A charge at a place makes its own front.
fn own_front() -> Value {
    json!([combination(&[], &["front"]), { "properties": { "explosion": combination(&[], &["at"]) } }])
}

/// The schema without null.
fn not_null(schema: Value) -> Value {
    let mut schema = schema;
    let other = schema["anyOf"].as_array().filter(|choices| choices.len() == 2 && choices[1]["type"] == "null");
    if let Some(Value::Object(mut other)) = other.map(|choices| choices[0].clone()) {
        let description = schema["description"].take();
        other.insert("description".into(), description);
        return other.into();
    }
    if let Some(types) = schema["type"].as_array() {
        let types: Vec<Value> = types.iter().filter(|kind| *kind != "null").cloned().collect();
        schema["type"] = if let [one] = &types[..] { one.clone() } else { types.into() };
    }
    schema
}
