//! `--set PATH=VALUE`: the case file changed from the command line.

use serde_json::{Map, Value};

use super::duplicate::Unique;
use super::nearest;

/// A path this deep names nothing in a case.
const DEEPEST: usize = 32;

/// `json` with the value at a dotted path replaced; missing objects on the way are made.
///
/// `loads.surface.pressure.peak=200 kPa`, `damping.modes.1=3`, `damping=null`; in a list of loads `loads.0.surface...`. VALUE
/// is JSON if it reads as such, and must be where it begins with a bracket; else a string. null takes the key out. The error is a sentence that names the setting.
pub fn set(json: Value, setting: &str) -> Result<Value, String> {
    let (path, text) = setting
        .split_once('=')
        .ok_or_else(|| format!("--set {setting:?} has no \"=\"; write PATH=VALUE, as in time.step=\"0.2 ms\""))?;
    let keys: Vec<_> = path.split('.').map(str::trim).collect();
    if keys.iter().any(|key| key.is_empty()) || keys.len() > DEEPEST {
        return Err(format!(
            "--set {setting:?}: {path:?} is not a path; write keys with dots between, as in time.step"
        ));
    }
    let value = match serde_json::from_str(text) {
        Ok(Unique(value)) => value,
        Err(why) if text.trim_start().starts_with(['{', '[']) => {
            let message = why.to_string();
            let what = message.split(" at line ").next().unwrap_or_default();
            return Err(format!(
                "--set {setting:?}: its value is no JSON, at character {}: {what}; keys and texts stand in double quotes",
                why.column()
            ));
        }
        Err(_) => Value::String(text.trim().into()),
    };
    replaced(json, &keys, value).map_err(|why| format!("--set {setting:?}: {why}"))
}

/// The key that two settings give a value, of which one would be lost without a word.
pub fn twice(settings: &[String]) -> Option<String> {
    let path = |setting: &String| setting.split_once('=').map(|(path, _)| path.replace(char::is_whitespace, ""));
    let later = |i: usize| path(&settings[i]).filter(|of| settings[..i].iter().any(|s| path(s).as_ref() == Some(of)));
    let key = (0..settings.len()).find_map(later)?;
    Some(format!("--set gives {key} twice; one of the two would be lost: leave it out"))
}

/// Where a setting reaches into a group that the file does not have, which groups it has: `materials.layer_9.young=1`.
pub fn new_name(written: &Value, setting: &str) -> Option<String> {
    let keys: Vec<&str> = setting.split('=').next()?.split('.').map(str::trim).collect();
    let [section @ ("materials" | "interfaces" | "loads" | "initial"), name, _, ..] = keys[..] else { return None };
    let there: Vec<String> = match written.get(section) {
        Some(Value::Object(map)) => map.keys().cloned().collect(),
        Some(_) => return None,
        None => vec![],
    };
    let hint = nearest(name, there.iter().map(String::as_str)).map(|near| format!(", did you mean \"{near}\"?"));
    (!there.iter().any(|n| n == name)).then(|| {
        format!(
            "; --set {setting:?} makes a new {section}.{name}{} The file has: {}",
            hint.unwrap_or(".".into()),
            there.join(", ")
        )
    })
}

fn replaced(json: Value, keys: &[&str], value: Value) -> Result<Value, String> {
    let Some((&key, deeper)) = keys.split_first() else {
        return Ok(value);
    };
    match json {
        Value::Object(mut map) => {
            let old = map.get(key).cloned().unwrap_or(Value::Null);
            match replaced(old, deeper, value)? {
                Value::Null => map.shift_remove(key),
                new => map.insert(key.into(), new),
            };
            Ok(Value::Object(map))
        }
        Value::Null => replaced(Value::Object(Map::new()), keys, value),
        Value::Array(mut list) => {
            let length = list.len();
            let index = key.parse().ok().filter(|&i: &usize| i < length);
            let index = index.ok_or_else(|| format!("{key:?} is not a place in a list of {length}, counted from 0"))?;
            list[index] = replaced(list[index].take(), deeper, value)?;
            Ok(Value::Array(list))
        }
        scalar => Err(format!("there is no {key:?} inside {scalar}, which is a single value")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn what_was_set_is_found_at_its_path_and_the_rest_is_untouched() {
        let old = json!({ "a": { "b": 1, "c": [1, { "d": 2 }] }, "e": null });
        for (setting, pointer, expected) in [
            ("a.b=5", "/a/b", json!(5)),
            ("a.b=5 kPa", "/a/b", json!("5 kPa")),
            ("a.b=\"5\"", "/a/b", json!("5")),
            ("a.b==", "/a/b", json!("=")),
            ("a.c.0=[3]", "/a/c/0", json!([3])),
            ("a.c.1.d=x", "/a/c/1/d", json!("x")),
            ("e.f.g=true", "/e/f/g", json!(true)),
            ("new.f.0=1", "/new/f/0", json!(1)),
        ] {
            let new = set(old.clone(), setting).unwrap();
            assert_eq!(new.pointer(pointer), Some(&expected), "{setting}");
            assert_eq!(new["a"]["c"].as_array().unwrap().len(), 2, "{setting}");
        }
    }

    #[test]
    fn null_takes_a_key_out() {
        let old = json!({ "a": { "b": 1, "c": 2 }, "e": 3 });
        assert_eq!(set(old.clone(), "a.b=null").unwrap(), json!({ "a": { "c": 2 }, "e": 3 }));
        assert_eq!(set(old.clone(), "e=null").unwrap(), json!({ "a": { "b": 1, "c": 2 } }));
        assert_eq!(set(old.clone(), "none=null").unwrap(), old);
    }

    #[test]
    fn a_setting_that_means_nothing_is_a_sentence() {
        let old = json!({ "a": [1], "b": "text" });
        for (setting, words) in [
            ("a", "has no \"=\""),
            ("=1", "is not a path"),
            ("a..b=1", "is not a path"),
            ("a.1=1", "\"1\" is not a place in a list of 1"),
            ("a.x=1", "\"x\" is not a place in a list of 1"),
            ("b={c:1}", "no JSON, at character 2"),
            ("b={\"c\":1e400}", "no JSON, at character"),
            ("b={\"c\":1,\"c\":2}", "stands twice"),
            ("b.c=1", "there is no \"c\" inside \"text\""),
        ] {
            let sentence = set(old.clone(), setting).unwrap_err();
            assert!(sentence.contains(words) && sentence.contains(&format!("{setting:?}")), "{sentence}");
        }
        assert!(set(old, &format!("{}=1", ["x"; 9999].join("."))).is_err());
    }
}
