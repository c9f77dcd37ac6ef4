//! What is refused.

use glam::Vec3;
use thiserror::Error;

/// Why parameters of this crate cannot be used.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ToonError {
    /// There is no tone.
    #[error("at least one tone is needed")]
    NoTones,
    /// N tones have N - 1 borders.
    #[error("{tones} tones need {} thresholds, not {thresholds}", tones - 1)]
    Counts {
        /// How many there are.
        tones: usize,
        /// How many there are.
        thresholds: usize,
    },
    /// A threshold is NaN or infinite.
    #[error("threshold {index} is {value}, which is not finite")]
    ThresholdNotFinite {
        /// Into [`crate::Bands::thresholds`].
        index: usize,
        /// What stands there.
        value: f32,
    },
    /// A threshold is not above the one before it.
    #[error("threshold {index} is {value}, not above the {before} before it")]
    ThresholdOrder {
        /// Into [`crate::Bands::thresholds`].
        index: usize,
        /// What stands there.
        value: f32,
        /// What stands before it.
        before: f32,
    },
    /// A tone has a component that is negative, NaN or infinite.
    #[error("tone {index} is {value}: components must be finite and not negative")]
    Tone {
        /// Into [`crate::Bands::tones`].
        index: usize,
        /// What stands there.
        value: Vec3,
    },
    /// The highlight's threshold is NaN or infinite.
    #[error("the highlight's threshold is {value}, which is not finite")]
    HighlightThreshold {
        /// What it is.
        value: f32,
    },
    /// The highlight's colour has a component that is negative, NaN or infinite.
    #[error("the highlight's colour is {value}: components must be finite and not negative")]
    HighlightColor {
        /// What it is.
        value: Vec3,
    },
    /// The highlight's strength is not within 0..=1.
    #[error("the highlight's strength is {value}, not within 0..=1")]
    HighlightStrength {
        /// What it is.
        value: f32,
    },
    /// More bands than a [`crate::ToonUniform`] holds. (The Rust functions take any number.)
    #[error("{tones} tones are too many for the uniform, which holds {max}")]
    TooManyTones {
        /// How many there are.
        tones: usize,
        /// [`crate::MAX_BANDS`].
        max: usize,
    },
    /// A ramp has no stop.
    #[error("a ramp needs at least one stop")]
    NoStops,
    /// A stop's position is NaN or infinite.
    #[error("stop {index} is at {value}, which is not finite")]
    StopNotFinite {
        /// Into [`crate::ramp::Ramp::stops`].
        index: usize,
        /// Where it is.
        value: f32,
    },
    /// A stop is not beyond the one before it.
    #[error("stop {index} is at {value}, not above the {before} before it")]
    StopOrder {
        /// Into [`crate::ramp::Ramp::stops`].
        index: usize,
        /// Where it is.
        value: f32,
        /// Where the one before it is.
        before: f32,
    },
    /// A stop's colour has a component that is negative, NaN or infinite.
    #[error("the colour of stop {index} is {value}: components must be finite and not negative")]
    StopColor {
        /// Into [`crate::ramp::Ramp::stops`].
        index: usize,
        /// What it is.
        value: Vec3,
    },
    /// A stop of a 2D ramp lies where no light reaches, or hides the stop before it; or a smooth one begins below 0,
    /// where the image has nothing.
    #[error(
        "stop {index} of a 2D ramp is at {value}: all but the first must be above 0 and at most 1, and the first of a \
         smooth one not below 0"
    )]
    StopOutside {
        /// Into [`crate::ramp::Ramp::stops`].
        index: usize,
        /// Where it is.
        value: f32,
    },
    /// More stops than a [`crate::ramp::RampUniform`] holds. (The Rust functions take any number.)
    #[error("{stops} stops are too many for the uniform, which holds {max}")]
    TooManyStops {
        /// How many there are.
        stops: usize,
        /// [`crate::ramp::MAX_STOPS`].
        max: usize,
    },
    /// An image of a ramp has no texels, or another number of them than its size says.
    #[error("{texels} texels for an image of {width} by {height}: it must have as many as that, and at least one")]
    Texels {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// How many texels there are.
        texels: usize,
    },
    /// The ends of an image row are not ascending, or are not finite, or their difference is not.
    #[error("a row from {from} to {to}: the second end must be above the first, by a finite amount")]
    RowEnds {
        /// [`crate::row::RampRow::from`].
        from: f32,
        /// [`crate::row::RampRow::to`].
        to: f32,
    },
    /// The corner's threshold is not above 0 and finite.
    #[error("the corner's threshold is {value}, which is not finite and above 0")]
    CornerThreshold {
        /// What it is.
        value: f32,
    },
    /// The corner's colour has a component that is negative, NaN or infinite.
    #[error("the corner's colour is {value}: components must be finite and not negative")]
    CornerColor {
        /// What it is.
        value: Vec3,
    },
    /// A light has no direction in f32: its vector, or the square of its length, is zero or below 1e-30, NaN or infinite.
    #[error("light {index} comes from {value}: a direction must have a length between 1e-15 and 1e19")]
    LightDirection {
        /// Into the lights.
        index: usize,
        /// What it is.
        value: Vec3,
    },
    /// A light's position, or the square of its distance from the origin in f32, is NaN or infinite.
    #[error("light {index} is at {value}, which is not finite, or further than 1e19 away")]
    LightPosition {
        /// Into the lights.
        index: usize,
        /// What it is.
        value: Vec3,
    },
    /// A light's colour has a component that is negative, NaN or infinite.
    #[error("the colour of light {index} is {value}: components must be finite and not negative")]
    LightColor {
        /// Into the lights.
        index: usize,
        /// What it is.
        value: Vec3,
    },
    /// A light's brightness is negative, NaN or infinite.
    #[error("the brightness of light {index} is {value}: it must be finite and not negative")]
    LightBrightness {
        /// Into the lights.
        index: usize,
        /// What it is.
        value: f32,
    },
    /// More lights than a 2D ramp has axes.
    #[error("{lights} lights are too many: a 2D ramp has {max} axes")]
    TooManyLights {
        /// How many there are.
        lights: usize,
        /// [`crate::painter::MAX_LIGHTS`].
        max: usize,
    },
    /// The painter's scale of the light is negative, NaN or infinite.
    #[error("the light's scale is {value}: it must be finite and not negative")]
    LightScale {
        /// What it is.
        value: f32,
    },
    /// A half-Lambert's scale or bias cannot be used.
    #[error("scale {scale} and bias {bias}: both must be finite, and the scale above 0")]
    HalfLambert {
        /// [`crate::half_lambert::HalfLambert::scale`].
        scale: f32,
        /// [`crate::half_lambert::HalfLambert::bias`].
        bias: f32,
    },
}

/// Whether `value` can be a colour: finite and nowhere negative. Above 1 it is brighter than the display.
pub(crate) fn is_color(value: Vec3) -> bool {
    value.is_finite() && value.min_element() >= 0.0
}
