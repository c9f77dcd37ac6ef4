//! Parses the JSON, and repairs what the `gltf` crate does not accept.
//!
//! Its structures reject some valid files (`extras` that are not an object, a scene without nodes, an animation whose
//! target is defined by an extension) and files with faults that can be repaired.

use super::extra::Extra;
use crate::load::external::shortened;
use gltf::json::{self, Root};
use serde::Deserialize;
use serde_json::{Map, Value};

/// Why a text is no document.
#[derive(Debug)]
pub(super) enum ParseFault {
    /// Of another version of glTF.
    Version(String),
    /// The fault, with line and column if the text is not JSON.
    Malformed(String),
}

impl From<String> for ParseFault {
    fn from(fault: String) -> Self {
        Self::Malformed(fault)
    }
}

/// Parses the JSON into typed structures.
///
/// # Errors
/// A text that is not JSON, that lacks something necessary, or that is of another version of glTF.
pub(super) fn parse(text: &[u8], warnings: &mut Vec<String>) -> Result<(Root, Extra), ParseFault> {
    // First without repairs, which need a second copy and are rarely necessary.
    let first = match json::deserialize::from_slice(text) {
        Ok(root) => return Ok((root, serde_json::from_slice(text).map_err(|error| error.to_string())?)),
        Err(error) => error.to_string(),
    };
    // A duplicate field is ambiguous.
    if first.contains("duplicate field") {
        return Err(first.into());
    }
    let mut value: Value = serde_json::from_slice(text).map_err(|error| error.to_string())?;
    check_version(&value)?;
    let mut repaired = Repaired::default();
    let mut unused = [Value::Null, Value::Null];
    if let Value::Object(root) = &mut value {
        // Unused parts of the file, of which only the indices are read.
        unused = ["animations", "cameras"].map(|name| root.remove(name).unwrap_or_default());
        for scene in root.get_mut("scenes").and_then(Value::as_array_mut).into_iter().flatten() {
            if let Value::Object(scene) = scene {
                scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
            }
        }
    }
    repaired.value(&mut value);
    let extra = Extra::deserialize(&value).map_err(|error| error.to_string());
    let root = json::deserialize::from_value(value).map_err(|error| {
        // The first message contains the line, if it is about the same fault.
        let second = error.to_string();
        if first.starts_with(&second) { first } else { second }
    })?;
    let mut extra = extra?;
    unused.iter_mut().for_each(|value| Repaired::default().value(value));
    let [animations, cameras] = unused;
    extra.animations = serde_json::from_value(animations).unwrap_or_default();
    extra.cameras = serde_json::from_value(cameras).unwrap_or_default();
    let counts = [
        (repaired.fractions, "whole numbers are written with a fraction"),
        (repaired.nulls, "values are null: they count as absent"),
        (repaired.names, "names are no strings: they are passed over"),
    ];
    warnings.extend(counts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")));
    Ok((root, extra))
}

/// Recognises other versions of glTF, whose documents have other structures.
fn check_version(value: &Value) -> Result<(), ParseFault> {
    // glTF 1.0 has dictionaries where glTF 2.0 has arrays.
    let names = ["accessors", "bufferViews", "buffers", "materials", "meshes", "nodes", "scenes"];
    let has_dictionaries = names.iter().any(|name| value.get(name).is_some_and(Value::is_object));
    let Value::Object(root) = value else { return Ok(()) };
    let stated = root.get("asset").and_then(|asset| asset.get("version")).filter(|version| !version.is_null());
    let Some(version) = stated else {
        return Err(match has_dictionaries {
            true => ParseFault::Version("1.0".to_owned()),
            false => ParseFault::Malformed("it states no version, which is \"2.0\" in `asset`".to_owned()),
        });
    };
    if let Some(number) = version.as_f64() {
        return Err(match number.trunc() == 2.0 {
            true => ParseFault::Malformed("the version in `asset` is a number, not a text".to_owned()),
            false => ParseFault::Version(format!("{number:?}")),
        });
    }
    match version.as_str().filter(|text| *text != "2" && !text.starts_with("2.")) {
        Some(other) => Err(ParseFault::Version(shortened(other))),
        None => Ok(()),
    }
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
