//! JSON that the `gltf` crate takes.
//!
//! Its structures refuse some of what the specification allows (`extras` that are no object, a scene without nodes, an
//! animation whose target an extension names) and all of what can be understood although it is not allowed.

use gltf::json::{self, Root};
use serde_json::{Map, Value};

/// The typed structure of a file.
///
/// # Errors
/// What is wrong, with line and column where the text is not JSON.
pub(super) fn parse(text: &[u8], warnings: &mut Vec<String>) -> Result<Root, String> {
    // As it is first: to repair costs a second copy, and nearly no file needs it.
    let first = match json::deserialize::from_slice(text) {
        Ok(root) => return Ok(root),
        Err(error) => error.to_string(),
    };
    // Of two values for one name, either could be meant.
    if first.contains("duplicate field") {
        return Err(first);
    }
    let mut value: Value = serde_json::from_slice(text).map_err(|error| error.to_string())?;
    let mut repaired = Repaired::default();
    if let Value::Object(root) = &mut value {
        // Nothing here is read from them.
        root.remove("animations");
        root.remove("cameras");
        for scene in root.get_mut("scenes").and_then(Value::as_array_mut).into_iter().flatten() {
            if let Value::Object(scene) = scene {
                scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
            }
        }
    }
    repaired.value(&mut value);
    let root = json::deserialize::from_value(value).map_err(|error| {
        // The first message knows the line, if it is about the same thing.
        let second = error.to_string();
        if first.starts_with(&second) { first } else { second }
    })?;
    let counts = [
        (repaired.fractions, "whole numbers are written with a fraction"),
        (repaired.nulls, "values are null: they count as absent"),
        (repaired.names, "names are no strings: they are passed over"),
    ];
    warnings.extend(counts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")));
    Ok(root)
}

#[derive(Default)]
struct Repaired {
    fractions: u64,
    nulls: u64,
    names: u64,
}

impl Repaired {
    /// The parser has bounded the depth.
    fn value(&mut self, value: &mut Value) {
        match value {
            Value::Object(members) => self.members(members),
            Value::Array(elements) => elements.iter_mut().for_each(|element| self.value(element)),
            Value::Number(number) if number.is_f64() => {
                // Whole numbers up to here are exact.
                let most = (1u64 << 53) as f64;
                if let Some(whole) = number.as_f64().filter(|x| x.fract() == 0.0 && x.abs() <= most) {
                    *value = Value::from(whole as i64);
                    self.fractions += 1;
                }
            }
            _ => {}
        }
    }

    fn members(&mut self, members: &mut Map<String, Value>) {
        members.remove("extras");
        let before = members.len();
        members.retain(|_, value| !value.is_null());
        self.nulls += (before - members.len()) as u64;
        if members.get("name").is_some_and(|name| !name.is_string()) {
            members.remove("name");
            self.names += 1;
        }
        members.values_mut().for_each(|value| self.value(value));
    }
}
