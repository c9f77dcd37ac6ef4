//! Errors of this crate.

use glam::Vec3;
use thiserror::Error;

/// A parameter of this crate that is outside its valid range.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ToonError {
    /// A style has no tone.
    #[error("at least one tone is needed")]
    NoTones,
    /// The number of thresholds is not one less than the number of tones.
    #[error("{tones} tones need {} thresholds, not {thresholds}", tones - 1)]
    Counts {
        /// The number of tones.
        tones: usize,
        /// The number of thresholds.
        thresholds: usize,
    },
    /// A threshold is NaN or infinite.
    #[error("threshold {index} is {value}, which is not finite")]
    ThresholdNotFinite {
        /// Index into [`crate::Bands::thresholds`].
        index: usize,
        /// The rejected value.
        value: f32,
    },
    /// A threshold is not above the preceding threshold.
    #[error("threshold {index} is {value}, not above the preceding {before}")]
    ThresholdOrder {
        /// Index into [`crate::Bands::thresholds`].
        index: usize,
        /// The rejected value.
        value: f32,
        /// The preceding threshold.
        before: f32,
    },
    /// A tone has a component that is negative, NaN or infinite.
    #[error("tone {index} is {value}: components must be finite and not negative")]
    Tone {
        /// Index into [`crate::Bands::tones`].
        index: usize,
        /// The rejected value.
        value: Vec3,
    },
    /// The highlight's threshold is NaN or infinite.
    #[error("the highlight's threshold is {value}, which is not finite")]
    HighlightThreshold {
        /// The rejected value.
        value: f32,
    },
    /// The highlight's colour has a component that is negative, NaN or infinite.
    #[error("the highlight's colour is {value}: components must be finite and not negative")]
    HighlightColor {
        /// The rejected value.
        value: Vec3,
    },
    /// The strength of the highlight is outside 0..=1.
    #[error("the highlight's strength is {value}: it must be within 0..=1")]
    HighlightStrength {
        /// The rejected value.
        value: f32,
    },
    /// There are more bands than a [`crate::ToonUniform`] holds. The Rust functions accept any number.
    #[error("{tones} tones are too many for the uniform, which holds {max}")]
    TooManyTones {
        /// The number of tones.
        tones: usize,
        /// The maximum, [`crate::MAX_BANDS`].
        max: usize,
    },
    /// A ramp has no stop.
    #[error("a ramp needs at least one stop")]
    NoStops,
    /// A stop's position is NaN or infinite.
    #[error("stop {index} is at {value}, which is not finite")]
    StopNotFinite {
        /// Index into [`crate::ramp::Ramp::stops`].
        index: usize,
        /// The position of the stop.
        value: f32,
    },
    /// The position of a stop is not above that of the preceding stop.
    #[error("stop {index} is at {value}, not above the preceding {before}")]
    StopOrder {
        /// Index into [`crate::ramp::Ramp::stops`].
        index: usize,
        /// The position of the stop.
        value: f32,
        /// The position of the preceding stop.
        before: f32,
    },
    /// A stop's colour has a component that is negative, NaN or infinite.
    #[error("the colour of stop {index} is {value}: components must be finite and not negative")]
    StopColor {
        /// Index into [`crate::ramp::Ramp::stops`].
        index: usize,
        /// The rejected value.
        value: Vec3,
    },
    /// A stop of a 2D ramp other than the first is outside 0..=1 or at 0, or the first stop of a smooth ramp with several
    /// stops is below 0. The coordinates of a 2D ramp are clamped to 0..=1.
    #[error(
        "stop {index} of a 2D ramp is at {value}: every stop but the first must be above 0 and at most 1, and the first \
         stop of a smooth ramp must not be below 0"
    )]
    StopOutside {
        /// Index into [`crate::ramp::Ramp::stops`].
        index: usize,
        /// The position of the stop.
        value: f32,
    },
    /// There are more stops than a [`crate::ramp::RampUniform`] holds. The Rust functions accept any number.
    #[error("{stops} stops are too many for the uniform, which holds {max}")]
    TooManyStops {
        /// The number of stops.
        stops: usize,
        /// The maximum, [`crate::ramp::MAX_STOPS`].
        max: usize,
    },
    /// A ramp image is empty, or its number of texels is not width × height.
    #[error(
        "{texels} texels for an image of {width} by {height}: it must have width times height texels, and at least one"
    )]
    Texels {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// The number of texels.
        texels: usize,
    },
    /// The depths of [`crate::x_toon::Detail::Depth`] do not ascend from above 0, or are not finite.
    #[error("detail from a depth of {near} to {far}: the first must be above 0, the second above the first and finite")]
    DetailDepths {
        /// Where detail is 1.
        near: f32,
        /// Where it is 0.
        far: f32,
    },
    /// The exponent of [`crate::x_toon::Detail::Silhouette`] is not above 0 and finite.
    #[error("an exponent of detail of {exponent}: it must be above 0 and finite")]
    DetailExponent {
        /// The rejected value.
        exponent: f32,
    },
    /// The ends of an image row are not ascending, or their difference is not finite.
    #[error("a row from {from} to {to}: the end must be above the start by a finite amount")]
    RowEnds {
        /// [`crate::row::RampRow::from`].
        from: f32,
        /// [`crate::row::RampRow::to`].
        to: f32,
    },
    /// The corner's threshold is not above 0 and finite.
    #[error("the corner's threshold is {value}, which is not finite and above 0")]
    CornerThreshold {
        /// The rejected value.
        value: f32,
    },
    /// The corner's colour has a component that is negative, NaN or infinite.
    #[error("the corner's colour is {value}: components must be finite and not negative")]
    CornerColor {
        /// The rejected value.
        value: Vec3,
    },
    /// The direction of a light cannot be normalised in f32: the square of its length is below 1e-30, infinite or NaN.
    #[error("light {index} comes from the direction {value}: its length must be between 1e-15 and 1e19")]
    LightDirection {
        /// Index of the light.
        index: usize,
        /// The rejected value.
        value: Vec3,
    },
    /// The position of a light is not finite, or the square of its distance from the origin overflows f32.
    #[error("light {index} is at {value}: its distance from the origin must be at most 1e19")]
    LightPosition {
        /// Index of the light.
        index: usize,
        /// The rejected value.
        value: Vec3,
    },
    /// A light's colour has a component that is negative, NaN or infinite.
    #[error("the colour of light {index} is {value}: components must be finite and not negative")]
    LightColor {
        /// Index of the light.
        index: usize,
        /// The rejected value.
        value: Vec3,
    },
    /// A light's brightness is negative, NaN or infinite.
    #[error("the brightness of light {index} is {value}: it must be finite and not negative")]
    LightBrightness {
        /// Index of the light.
        index: usize,
        /// The rejected value.
        value: f32,
    },
    /// There are more lights than a 2D ramp has axes.
    #[error("{lights} lights are too many: a 2D ramp has {max} axes")]
    TooManyLights {
        /// The number of lights.
        lights: usize,
        /// The maximum, [`crate::painter::MAX_LIGHTS`].
        max: usize,
    },
    /// The light scale of a painter is negative, NaN or infinite.
    #[error("the light scale is {value}: it must be finite and not negative")]
    LightScale {
        /// The rejected value.
        value: f32,
    },
    /// The number of divisions of [`crate::normal::NormalUse::PerSubdividedFace`] is outside its range.
    #[error("{divisions} divisions of each side of a face: it must be 1..={max}")]
    Divisions {
        /// The rejected value.
        divisions: u32,
        /// The maximum, [`crate::normal::MAX_DIVISIONS`].
        max: u32,
    },
    /// The scale or bias of half-Lambert lighting is not finite, or the scale is not above 0.
    #[error("half-Lambert scale {scale} and bias {bias}: both must be finite, and the scale above 0")]
    HalfLambert {
        /// [`crate::half_lambert::HalfLambert::scale`].
        scale: f32,
        /// [`crate::half_lambert::HalfLambert::bias`].
        bias: f32,
    },
}

/// Whether every component of `value` is finite and not negative. Components above 1 are allowed.
pub(crate) fn is_color(value: Vec3) -> bool {
    value.is_finite() && value.min_element() >= 0.0
}
