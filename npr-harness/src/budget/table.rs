//! What each way to make a part of a picture costs, and how far it is expected to err.

use crate::hatch::HatchMapping;
use crate::shade::Shade;
use crate::shade::ramp::RampSource;
use crate::variant::Part;
use npr_toon::ramp::RampBlend;
use serde::{Deserialize, Serialize};

/// The measured costs and expected errors on a machine. Plain data, filled by the laboratory and stored in a file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CostTable {
    /// The version of this crate that measured it.
    pub version: String,
    /// The executors that were measured, by name; the plain pass of the first is the unit of time.
    pub executors: Vec<String>,
    /// What was measured.
    pub entries: Vec<Entry>,
    /// Errors that are expected, whatever executor.
    pub expected: Vec<Expected>,
}

/// The cost of a variant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// The executor.
    pub executor: String,
    /// The part: [`Part::Light`] and [`Part::Strokes`] are the whole of a frame without lines and shadows, the others
    /// what they add to one.
    pub part: Part,
    /// The variant.
    pub variant: String,
    /// For light and strokes: what is lit.
    pub shade: Option<ShadeKey>,
    /// The samples along each axis of a pixel for which it was measured: it is used for as many, and if there is no other
    /// entry for more.
    pub samples: u32,
    /// The cost.
    pub cost: Cost,
}

/// The expected error of a variant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Expected {
    /// The part.
    pub part: Part,
    /// The variant.
    pub variant: String,
    /// For light and strokes: what is lit.
    pub shade: Option<ShadeKey>,
    /// The samples along each axis of a pixel.
    pub samples: u32,
    /// The mean error over the scenes of the calibration.
    pub error: f64,
}

/// A time that is linear in samples and faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// Ms a frame.
    pub fixed_ms: f64,
    /// Ns a sample: pixels of the picture, times the samples in each.
    pub sample_ns: f64,
    /// Ns a face.
    pub face_ns: f64,
}

/// What a frame contains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amounts {
    /// Pixels, times the samples in each.
    pub samples: f64,
    /// Faces of all objects.
    pub faces: f64,
}

impl Cost {
    /// Ms.
    pub fn ms(&self, amounts: &Amounts) -> f64 {
        self.fixed_ms + 1e-6 * (self.sample_ns * amounts.samples + self.face_ns * amounts.faces)
    }
}

/// How surfaces are painted, as far as it changes costs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ShadeKey {
    /// Surfaces are not painted.
    Paper,
    /// Diffuse light without bands: the plain pass.
    Lambert,
    /// Bands.
    Toon,
    /// A ramp in steps.
    HardRamp,
    /// A ramp that is interpolated.
    SmoothRamp,
    /// Two lights on a 2D ramp.
    Painter,
    /// Bands that fade.
    XToon,
    /// Gooch's tones.
    Gooch,
    /// Normals as colours.
    Normals,
    /// Strokes by texture coordinates.
    HatchCoordinates,
    /// Strokes by three planes.
    HatchPlanes,
    /// Strokes along the form.
    HatchForm,
}

impl ShadeKey {
    /// That of a shade.
    pub fn of(shade: &Shade) -> Self {
        match shade {
            Shade::Paper => Self::Paper,
            Shade::Lambert(_) => Self::Lambert,
            Shade::Toon(_) => Self::Toon,
            Shade::Ramp(ramp) => match &ramp.ramp {
                RampSource::Stops(stops) if stops.blend == RampBlend::Smooth => Self::SmoothRamp,
                _ => Self::HardRamp,
            },
            Shade::Painter(_) => Self::Painter,
            Shade::XToon(_) => Self::XToon,
            Shade::Gooch(_) => Self::Gooch,
            Shade::Normals => Self::Normals,
            Shade::Hatch(hatch) => match hatch.mapping {
                HatchMapping::Coordinates => Self::HatchCoordinates,
                HatchMapping::Planes => Self::HatchPlanes,
                HatchMapping::Form => Self::HatchForm,
            },
        }
    }

    /// The shade whose measured errors are expected of it: bands for what has steps, Gooch's tones for what is smooth.
    pub fn errs_like(self) -> Self {
        match self {
            Self::Toon | Self::HardRamp | Self::Painter | Self::XToon => Self::Toon,
            Self::Lambert | Self::SmoothRamp | Self::Gooch | Self::Normals => Self::Gooch,
            // Where a model has no coordinates, planes take their place.
            Self::HatchCoordinates | Self::HatchPlanes => Self::HatchPlanes,
            Self::HatchForm => Self::HatchForm,
            Self::Paper => Self::Paper,
        }
    }
}

impl CostTable {
    /// The cost of a variant on an executor, ms.
    pub fn ms(
        &self,
        executor: &str,
        part: Part,
        variant: &str,
        shade: Option<ShadeKey>,
        samples: u32,
        amounts: &Amounts,
    ) -> Option<f64> {
        let is_of = |entry: &&Entry| {
            entry.executor == executor
                && entry.part == part
                && entry.variant == variant
                && entry.shade == shade
                && entry.samples <= samples
        };
        // The entry for as many samples as possible.
        let entry = self.entries.iter().filter(is_of).max_by_key(|entry| entry.samples)?;
        Some(entry.cost.ms(amounts))
    }

    /// The error that is expected of a variant.
    pub fn error(&self, part: Part, variant: &str, shade: Option<ShadeKey>, samples: u32) -> Option<f64> {
        let shade = shade.map(ShadeKey::errs_like);
        let is_of = |entry: &&Expected| {
            entry.part == part && entry.variant == variant && entry.shade == shade && entry.samples <= samples
        };
        Some(self.expected.iter().filter(is_of).max_by_key(|entry| entry.samples)?.error)
    }
}
