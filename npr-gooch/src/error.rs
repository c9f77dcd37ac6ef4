//! What is refused.

use glam::Vec3;
use thiserror::Error;

/// Why a [`crate::Gooch`] cannot be used.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum GoochError {
    /// k_blue has a component that is negative, NaN or infinite.
    #[error("k_blue is {value}: components must be finite and not negative")]
    Blue {
        /// What it is.
        value: Vec3,
    },
    /// k_yellow has a component that is negative, NaN or infinite.
    #[error("k_yellow is {value}: components must be finite and not negative")]
    Yellow {
        /// What it is.
        value: Vec3,
    },
    /// α is negative, NaN or infinite.
    #[error("alpha is {value}: it must be finite and not negative")]
    Alpha {
        /// What it is.
        value: f32,
    },
    /// β is negative, NaN or infinite.
    #[error("beta is {value}: it must be finite and not negative")]
    Beta {
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
    /// The highlight's exponent is not above 0 and finite.
    #[error("the highlight's exponent is {value}: it must be finite and above 0")]
    HighlightExponent {
        /// What it is.
        value: f32,
    },
}
