//! What the JSON Schema says beyond the types of the keys: ranges, keys that exclude each other, comments.

use std::borrow::Cow;
use std::marker::PhantomData;

use schemars::transform::transform_subschemas;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde_json::{Map, Value, json};

use super::Case;
use super::duplicate::COMMENT;

/// JSON Schema of the case file, for editors.
pub fn schema() -> Value {
    of_file::<Case>()
}

/// JSON Schema of a file in which comments may stand.
pub fn of_file<T: JsonSchema>() -> Value {
    let mut schema = schemars::schema_for!(T);
    allow_comments(&mut schema);
    schema.into()
}

/// Keys that begin with `_comment` in every object.
fn allow_comments(schema: &mut Schema) {
    let is_of_objects = ["properties", "additionalProperties"].iter().any(|key| schema.get(*key).is_some());
    if is_of_objects {
        schema.insert("patternProperties".into(), json!({ format!("^{COMMENT}"): true }));
    }
    transform_subschemas(&mut allow_comments, schema);
}

/// A choice in which the keys `given` have values and the keys `absent` have none; null is no value.
pub fn combination(given: &[&str], absent: &[&str]) -> Value {
    let with = |keys: &[&str], schema: Value| keys.iter().map(|key| (key.to_string(), schema.clone())).collect();
    let given_keys: Map<String, Value> = with(given, json!({ "not": { "type": "null" } }));
    let absent_keys: Map<String, Value> = with(absent, json!({ "type": "null" }));
    json!({ "required": given, "properties": given_keys.into_iter().chain(absent_keys).collect::<Map<_, _>>() })
}

/// Directions: not the zero vector.
pub fn not_zero(schema: &mut Schema) {
    schema.insert("contains".into(), json!({ "not": { "const": 0 } }));
}

macro_rules! ranges {
    ($($(#[$doc:meta])* $name:ident { $($keyword:literal: $bound:literal),+ }, $pattern:literal;)+) => { $(
        $(#[$doc])*
        pub struct $name<T>(PhantomData<T>);

        impl<T: JsonSchema> JsonSchema for $name<T> {
            fn inline_schema() -> bool {
                true
            }

            fn schema_name() -> Cow<'static, str> {
                format!("{}{}", stringify!($name), T::schema_name()).into()
            }

            fn json_schema(generator: &mut SchemaGenerator) -> Schema {
                let mut schema = generator.subschema_for::<T>();
                $(schema.insert($keyword.into(), $bound.into());)+
                schema.insert("pattern".into(), $pattern.into());
                schema
            }
        }
    )+ };
}

// Quantities with a unit are texts: where a sign stands before digits of which one is not zero, the number is negative.
ranges! {
    /// a quantity T greater than 0
    Positive { "exclusiveMinimum": 0 }, r"^\s*\+?[0-9.]*[1-9]";
    /// a quantity T of at least 0
    NotNegative { "minimum": 0 }, r"^\s*([+0-9.]|-[0.]+(?![0-9.]))";
    /// a quantity T that may be given, but only as 0
    Zero { "minimum": 0, "maximum": 0 }, r"^\s*[+-]?[0.]+(?![0-9.])";
}
