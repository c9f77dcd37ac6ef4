//! The table `[shadow]` of a style file.

use super::style::{ShadowMethod, ShadowStyle};
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(crate) struct ShadowTable {
    method: MethodName,
    /// The side of a shadow map in texels.
    #[serde(skip_serializing_if = "Option::is_none")]
    side: Option<u32>,
    terminator: f32,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum MethodName {
    Volumes,
    Map,
}

impl Default for ShadowTable {
    fn default() -> Self {
        Self::new(&ShadowStyle::default())
    }
}

/// The default side of a shadow map, in texels.
const SIDE: u32 = 2048;

impl ShadowTable {
    pub(crate) fn new(shadow: &ShadowStyle) -> Self {
        let (method, side) = match shadow.method {
            ShadowMethod::Volumes => (MethodName::Volumes, None),
            ShadowMethod::Map { side } => (MethodName::Map, Some(side)),
        };
        Self { method, side, terminator: shadow.terminator }
    }

    pub(crate) fn shadow(self) -> Result<ShadowStyle, String> {
        let method = match (self.method, self.side) {
            (MethodName::Volumes, None) => ShadowMethod::Volumes,
            (MethodName::Volumes, Some(_)) => return Err("only a shadow map has a side, volumes have none".into()),
            (MethodName::Map, side) => ShadowMethod::Map { side: side.unwrap_or(SIDE) },
        };
        Ok(ShadowStyle { method, terminator: self.terminator })
    }
}
