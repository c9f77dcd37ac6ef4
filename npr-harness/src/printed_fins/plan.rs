//! The part of a plan that is about printed fins.

use crate::error::HarnessError;
use crate::scene::Scene;
use crate::schema::{within, within_colors};
use glam::Vec3;
use npr_outline::fin_printed::{PrintedFins, printed_fins};
use std::convert::Infallible;
use std::sync::Arc;

/// The settings of printed fins in a style.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedLines {
    /// Width far away, px.
    pub width_px: f32,
    /// Display-referred colour.
    pub ink: Vec3,
}

impl PrintedLines {
    pub(crate) fn validate(&self) -> Result<(), HarnessError> {
        within("a fin's width", self.width_px, 0.0, 256.0, "0..=256 px")?;
        within_colors("a component of the lines' ink", &self.ink.to_array())
    }
}

/// Printed fins of a scene.
#[derive(Clone, Debug)]
pub struct PrintedFinPlan {
    /// A fin for every edge.
    pub fins: Arc<PrintedFins>,
    /// Their width and colour.
    pub style: PrintedLines,
}

/// The key of the fins among what is derived of a scene.
#[derive(PartialEq)]
struct FinsKey;

impl PrintedFinPlan {
    pub(crate) fn new(scene: &Scene, style: PrintedLines) -> Self {
        let make = || Ok::<_, Infallible>(printed_fins(&scene.model, &scene.edges));
        let Ok(fins) = scene.derived.get(FinsKey, make);
        Self { fins, style }
    }
}
