//! Parses the JSON, and repairs what the `gltf` crate does not accept.
//!
//! Its structures reject some valid files (`extras` that are not an object, a scene without nodes, an animation whose
//! target is defined by an extension) and files with faults that can be repaired.

use gltf::json::{self, Root};
use serde_json::{Map, Value};

/// Parses the JSON into typed structures.
///
/// # Errors
/// The fault, with line and column if the text is not JSON.
pub(super) fn parse(text: &[u8], warnings: &mut Vec<String>) -> Result<Root, String> {
    // First without repairs, which need a second copy and are rarely necessary.
    let first = match json::deserialize::from_slice(text) {
        Ok(root) => return Ok(root),
        Err(error) => error.to_string(),
    };
    // A duplicate field is ambiguous.
    if first.contains("duplicate field") {
        return Err(first);
    }
    let mut value: Value = serde_json::from_slice(text).map_err(|error| error.to_string())?;
    let mut repaired = Repaired::default();
    if let Value::Object(root) = &mut value {
        // Unused parts of the file.
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
        // The first message contains the line, if it is about the same fault.
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
    /// The recursion depth is limited by the parser.
    fn value(&mut self, value: &mut Value) {
        match value {
            Value::Object(members) => self.members(members),
            Value::Array(elements) => elements.iter_mut().for_each(|element| self.value(element)),
            Value::Number(number) if number.is_f64() => {
                // f64 represents integers up to this bound exactly.
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
