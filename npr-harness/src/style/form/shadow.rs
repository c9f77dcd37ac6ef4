//! The keys of shadows.

use crate::shadow::{ShadowMethod, ShadowStyle};
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(super) struct ShadowForm {
    method: MethodForm,
    /// Of a map, texels along a side.
    #[serde(skip_serializing_if = "Option::is_none")]
    side: Option<u32>,
    terminator: f32,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum MethodForm {
    Volumes,
    Map,
}

impl Default for ShadowForm {
    fn default() -> Self {
        Self::new(&ShadowStyle::default())
    }
}

/// Of a map whose file does not say.
const SIDE: u32 = 2048;

impl ShadowForm {
    pub(super) fn new(shadow: &ShadowStyle) -> Self {
        let (method, side) = match shadow.method {
            ShadowMethod::Volumes => (MethodForm::Volumes, None),
            ShadowMethod::Map { side } => (MethodForm::Map, Some(side)),
        };
        Self { method, side, terminator: shadow.terminator }
    }

    pub(super) fn shadow(self) -> Result<ShadowStyle, String> {
        let method = match (self.method, self.side) {
            (MethodForm::Volumes, None) => ShadowMethod::Volumes,
            (MethodForm::Volumes, Some(_)) => return Err("only a shadow map has a side, volumes have none".into()),
            (MethodForm::Map, side) => ShadowMethod::Map { side: side.unwrap_or(SIDE) },
        };
        Ok(ShadowStyle { method, terminator: self.terminator })
    }
}
