//! The plan of a sweep: one case, and the values that its keys and the constants of its script take in turn.

use crate::input::{self, Kind};
use crate::model::case::Unique;
use crate::{Error, Result};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde_json::{Map, Value, json};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The plan of a sweep: every combination of the listed values is a run.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object")]
#[schemars(transform = varies_something)]
pub struct Plan {
    /// For editors: where this schema lies; ignored.
    #[serde(rename = "$schema", default)]
    _schema: Option<String>,
    /// The case file; a relative path starts at the plan.
    pub case: PathBuf,
    /// Path of a key in the case, as for --set: the values it takes. Default: none.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Values>")]
    pub set: Map<String, Value>,
    /// Constant of the case's script, as for --geo: the numbers it takes. Default: none.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Numbers>")]
    pub geo: Map<String, Value>,
    /// true glues pipes and ground together. Default: false.
    #[serde(default)]
    pub bonded: bool,
    /// true writes frames for ParaView too, not only histories, rings and summaries. Default: false.
    #[serde(default)]
    pub frames: bool,
}

/// A list of values, none twice, in the schema.
struct Values;

/// A list of numbers, none twice, in the schema.
struct Numbers;

impl JsonSchema for Values {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Values".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "array", "minItems": 1, "uniqueItems": true })
    }
}

impl JsonSchema for Numbers {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Numbers".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "array", "minItems": 1, "uniqueItems": true, "items": { "type": "number" } })
    }
}

/// `set` or `geo` has an entry that is no comment.
fn varies_something(plan: &mut Schema) {
    let has_entries = |key: &str| {
        let entries = json!({ "not": { "additionalProperties": false } });
        json!({ "required": [key], "properties": { key: entries } })
    };
    plan.insert("anyOf".into(), json!([has_entries("set"), has_entries("geo")]));
}

/// One run of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Variant {
    /// of its folder: the varied names and values, `friction0.3_peak-50kPa`
    pub name: String,
    /// (column of the table, value)
    pub values: Vec<(String, Value)>,
    /// `PATH=VALUE` each
    pub sets: Vec<String>,
    pub geo: BTreeMap<String, f64>,
}

/// More runs than this are a slip of the pen.
const MOST: usize = 10_000;

impl Plan {
    /// # Errors
    /// The file cannot be read, is no plan, or varies nothing.
    pub fn read(path: &Path) -> Result<Plan> {
        let place = path.display();
        let text = input::read_text(path, Kind::Plan).map_err(|e| Error::input(format!("{place}: {e}")))?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        let plan = serde_json::from_str(text).and_then(|Unique(json)| serde_json::from_value(json));
        let plan: Plan = plan.map_err(|e| {
            Error::input(format!(
                "{place}: {e}; a plan looks like {{ \"case\": \"twin_pipes.json\", \"set\": {{ \
                 \"interfaces.interface_left.friction\": [0.2, 0.4] }}, \"geo\": {{ \"spacing\": [1.8, 2.4] }} }}"
            ))
        })?;
        for (kind, name, values) in plan.varied() {
            if values.as_array().is_none_or(Vec::is_empty) {
                return Err(Error::input(format!("{place}: {kind}.{name}: write a list of values, as in [0.2, 0.4]")));
            }
            if let Some(value) = twice(values.as_array().map_or(&[], Vec::as_slice)) {
                return Err(Error::input(format!(
                    "{place}: {kind}.{name}: {value} stands twice in its list, and the same case would run twice"
                )));
            }
        }
        let runs = plan.varied().fold(1usize, |n, (.., v)| n.saturating_mul(v.as_array().map_or(1, Vec::len)));
        if plan.varied().next().is_none() {
            return Err(Error::input(format!("{place}: it varies nothing: vary something by \"set\" or \"geo\"")));
        }
        if runs > MOST {
            return Err(Error::input(format!("{place}: it asks for {runs} runs; {MOST} combinations are the most")));
        }
        Ok(Plan { case: path.parent().unwrap_or(Path::new("")).join(&plan.case), ..plan })
    }

    fn varied(&self) -> impl Iterator<Item = (&'static str, &String, &Value)> {
        self.set.iter().map(|(k, v)| ("set", k, v)).chain(self.geo.iter().map(|(k, v)| ("geo", k, v)))
    }

    /// Every combination, the last list running fastest.
    pub fn variants(&self) -> Result<Vec<Variant>> {
        let nothing = Variant { name: String::new(), values: vec![], sets: vec![], geo: BTreeMap::new() };
        let mut variants = vec![nothing];
        for (kind, name, values) in self.varied() {
            let values = values.as_array().map_or(&[][..], Vec::as_slice);
            let extended = variants.iter().flat_map(|variant| {
                let told = |k| (values.len() > 1).then_some(k);
                values.iter().enumerate().map(move |(k, value)| variant.with(kind, name, value, told(k)))
            });
            variants = extended.collect::<Result<_>>()?;
        }
        Ok(told_apart(variants))
    }
}

impl Variant {
    /// With one more value; its place in the list where there are others to tell it from.
    fn with(&self, kind: &str, name: &str, value: &Value, place: Option<usize>) -> Result<Variant> {
        let mut variant = self.clone();
        match (kind, value.as_f64()) {
            ("set", _) => variant.sets.push(format!("{name}={value}")),
            (_, Some(number)) => _ = variant.geo.insert(name.into(), number),
            _ => {
                return Err(Error::input(format!(
                    "geo.{name}: {value} is no number; a script's constants are numbers"
                )));
            }
        }
        if let Some(place) = place {
            let last = name.rsplit('.').next().unwrap_or(name);
            let separator = if variant.name.is_empty() { "" } else { "_" };
            variant.name += &format!("{separator}{last}{}", in_a_name(value, place));
        }
        variant.values.push((name.into(), value.clone()));
        Ok(variant)
    }
}

/// The first value that an earlier one equals; 4 and 4.0 are equal.
fn twice(values: &[Value]) -> Option<&Value> {
    let equal = |a: &Value, b: &Value| a == b || (a.is_number() && a.as_f64() == b.as_f64());
    values.iter().enumerate().find(|(i, value)| values[..*i].iter().any(|v| equal(v, value))).map(|(_, value)| value)
}

/// A value as part of a folder's name: numbers and short words as they are, all else by its place in the list.
fn in_a_name(value: &Value, k: usize) -> String {
    let text = match value {
        Value::String(text) => text.clone(),
        Value::Number(number) => number.to_string(),
        _ => return format!("#{}", k + 1),
    };
    let fit: String = text.chars().filter(|c| c.is_ascii_alphanumeric() || "+-.".contains(*c)).collect();
    if fit.is_empty() || fit.len() > 24 { format!("#{}", k + 1) } else { fit }
}

/// Names that stand twice get a number.
fn told_apart(variants: Vec<Variant>) -> Vec<Variant> {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let numbered = variants.into_iter().map(|variant| {
        let count = seen.entry(variant.name.clone()).or_default();
        *count += 1;
        let name = match (variant.name.as_str(), *count) {
            ("", _) => "run".into(),
            (_, 1) => variant.name,
            (name, count) => format!("{name}_{count}"),
        };
        Variant { name, ..variant }
    });
    numbered.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn plan(json: Value) -> Plan {
        serde_json::from_value(json).unwrap()
    }

    #[test]
    fn every_combination_is_a_run_with_a_name_of_its_own() {
        let plan = plan(json!({ "case": "a.json", "geo": { "spacing": [1.8, 2.4] },
                                "set": { "interfaces.left.friction": [0.2, 0.4], "loads.top.peak": ["-50 kPa", {"law": "step"}] } }));
        let variants = plan.variants().unwrap();
        let names: Vec<&str> = variants.iter().map(|v| v.name.as_str()).collect();
        assert_eq!(variants.len(), 8);
        assert_eq!(names[0], "friction0.2_peak-50kPa_spacing1.8");
        assert_eq!(names[3], "friction0.2_peak#2_spacing2.4");
        assert_eq!(variants[7].sets, ["interfaces.left.friction=0.4", r#"loads.top.peak={"law":"step"}"#]);
        assert_eq!(variants[7].geo["spacing"], 2.4);
    }

    #[test]
    fn equal_names_are_numbered() {
        let plan = plan(json!({ "case": "a.json", "set": { "left.friction": [0.2], "x.y": ["1 m", "1m"] } }));
        let names: Vec<String> = plan.variants().unwrap().into_iter().map(|v| v.name).collect();
        assert_eq!(names, ["y1m", "y1m_2"]);
    }
}
