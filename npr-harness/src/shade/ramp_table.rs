//! Tables of a style file that 1D and 2D ramps have in common.

use crate::error::HarnessError;
use crate::schema::{Color, StyleFile};
use npr_toon::ramp::{Ramp, RampBlend, RampStop};
use npr_toon::row::TexelFilter;
use serde::{Deserialize, Serialize};

/// A ramp defined by its stops.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct StopsTable {
    #[serde(default)]
    blend: BlendName,
    at: Vec<f32>,
    colors: Vec<Color>,
}

#[derive(Clone, Copy, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum BlendName {
    #[default]
    Hard,
    Smooth,
}

impl StopsTable {
    pub(super) fn new(ramp: &Ramp) -> Self {
        let blend = match ramp.blend {
            RampBlend::Hard => BlendName::Hard,
            RampBlend::Smooth => BlendName::Smooth,
        };
        let at = ramp.stops.iter().map(|stop| stop.at).collect();
        Self { blend, at, colors: ramp.stops.iter().map(|stop| Color(stop.color)).collect() }
    }

    /// `table`: its name, for errors.
    pub(super) fn ramp(self, table: &str, file: &StyleFile<'_>) -> Result<Ramp, HarnessError> {
        if self.at.len() != self.colors.len() {
            let (stops, colors) = (self.at.len(), self.colors.len());
            return Err(file.wrong(format!("{table} has {stops} numbers in `at` and {colors} in `colors`")));
        }
        let blend = match self.blend {
            BlendName::Hard => RampBlend::Hard,
            BlendName::Smooth => RampBlend::Smooth,
        };
        let stops = self.at.into_iter().zip(self.colors).map(|(at, color)| RampStop { at, color: color.0 });
        Ok(Ramp { blend, stops: stops.collect() })
    }
}

/// How a ramp image is filtered.
#[derive(Clone, Copy, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum FilterName {
    Nearest,
    #[default]
    Linear,
}

impl From<TexelFilter> for FilterName {
    fn from(filter: TexelFilter) -> Self {
        match filter {
            TexelFilter::Nearest => Self::Nearest,
            TexelFilter::Linear => Self::Linear,
        }
    }
}

impl From<FilterName> for TexelFilter {
    fn from(name: FilterName) -> Self {
        match name {
            FilterName::Nearest => Self::Nearest,
            FilterName::Linear => Self::Linear,
        }
    }
}

/// The value of the override constant `shade_image_filter` for a computed ramp (`None`) or a ramp image.
pub(super) fn image_filter(filter: Option<TexelFilter>) -> f64 {
    match filter {
        None => 0.0,
        Some(TexelFilter::Nearest) => 1.0,
        Some(TexelFilter::Linear) => 2.0,
    }
}

pub(super) fn texels_of(rgba8: &[u8]) -> Vec<[u8; 4]> {
    rgba8.as_chunks::<4>().0.to_vec()
}
