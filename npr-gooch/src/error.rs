//! Errors of this crate.

use glam::Vec3;
use thiserror::Error;

/// A field of a [`crate::Gooch`] that is outside its valid range.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum GoochError {
    /// k_blue has a component that is negative, NaN or infinite.
    #[error("k_blue is {value}: components must be finite and not negative")]
    Blue {
        /// The rejected value.
        value: Vec3,
    },
    /// k_yellow has a component that is negative, NaN or infinite.
    #[error("k_yellow is {value}: components must be finite and not negative")]
    Yellow {
        /// The rejected value.
        value: Vec3,
    },
    /// α is negative, NaN or infinite.
    #[error("alpha is {value}: it must be finite and not negative")]
    Alpha {
        /// The rejected value.
        value: f32,
    },
    /// β is negative, NaN or infinite.
    #[error("beta is {value}: it must be finite and not negative")]
    Beta {
        /// The rejected value.
        value: f32,
    },
    /// The highlight's colour has a component that is negative, NaN or infinite.
    #[error("the highlight's colour is {value}: components must be finite and not negative")]
    HighlightColor {
        /// The rejected value.
        value: Vec3,
    },
    /// The highlight's strength is outside 0..=1.
    #[error("the highlight's strength is {value}: it must be within 0..=1")]
    HighlightStrength {
        /// The rejected value.
        value: f32,
    },
    /// The highlight's exponent is not finite or not above 0.
    #[error("the highlight's exponent is {value}: it must be finite and above 0")]
    HighlightExponent {
        /// The rejected value.
        value: f32,
    },
}
