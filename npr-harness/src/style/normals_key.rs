//! The key `normals` of a style file: a name, or a table with the number of divisions.

use npr_toon::normal::{DIVISIONS, NormalUse};
use serde::de::{self, Deserialize, Deserializer, MapAccess, Visitor};
use serde::ser::{Serialize, SerializeMap, Serializer};
use std::fmt;

/// The value of the key, of which `"per-subdivided-face"` is short for a table with the default number of divisions.
#[derive(Clone, Copy)]
pub(super) struct NormalsKey(pub(super) NormalUse);

const PER_SUBDIVIDED_FACE: &str = "per-subdivided-face";
const NAMES: &[&str] = &["per-pixel", "interpolated", "per-vertex", "per-face", PER_SUBDIVIDED_FACE];

impl Serialize for NormalsKey {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let name = match self.0 {
            NormalUse::PerPixel => "per-pixel",
            NormalUse::Interpolated => "interpolated",
            NormalUse::PerVertex => "per-vertex",
            NormalUse::PerFace => "per-face",
            NormalUse::PerSubdividedFace(divisions) => {
                let mut map = serializer.serialize_map(Some(1))?;
                map.serialize_entry(PER_SUBDIVIDED_FACE, &divisions)?;
                return map.end();
            }
        };
        serializer.serialize_str(name)
    }
}

impl<'de> Deserialize<'de> for NormalsKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NormalsVisitor).map(Self)
    }
}

struct NormalsVisitor;

impl<'de> Visitor<'de> for NormalsVisitor {
    type Value = NormalUse;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a use of normals, \"{}\", or {{ {PER_SUBDIVIDED_FACE} = divisions }}", NAMES.join("\", \""))
    }

    fn visit_str<E: de::Error>(self, name: &str) -> Result<NormalUse, E> {
        Ok(match name {
            "per-pixel" => NormalUse::PerPixel,
            "interpolated" => NormalUse::Interpolated,
            "per-vertex" => NormalUse::PerVertex,
            "per-face" => NormalUse::PerFace,
            PER_SUBDIVIDED_FACE => NormalUse::PerSubdividedFace(DIVISIONS),
            _ => return Err(E::unknown_variant(name, NAMES)),
        })
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<NormalUse, A::Error> {
        let Some(key) = map.next_key::<String>()? else {
            return Err(de::Error::custom(format!("an empty table: it needs {PER_SUBDIVIDED_FACE}")));
        };
        if key != PER_SUBDIVIDED_FACE {
            return Err(de::Error::unknown_field(&key, &[PER_SUBDIVIDED_FACE]));
        }
        let divisions = map.next_value()?;
        match map.next_key::<String>()? {
            Some(key) => Err(de::Error::unknown_field(&key, &[PER_SUBDIVIDED_FACE])),
            None => Ok(NormalUse::PerSubdividedFace(divisions)),
        }
    }
}
