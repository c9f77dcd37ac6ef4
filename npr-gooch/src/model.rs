//! The parameters of the model.

use glam::Vec3;

use crate::GoochError;

/// The object colour k_d in the comments of Card & Mitchell 2002, listing 7: display-referred RGB.
pub const EXAMPLE_K_D: Vec3 = Vec3::new(0.0, 0.0, 0.4);

/// The cool and the warm colour, and the shares of the object's colour in each.
///
/// Values that do not come from a constructor should be checked with [`Gooch::validate`]. The functions of this crate do
/// not panic on invalid values, but their results are then unspecified.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(default, rename_all = "kebab-case", deny_unknown_fields))]
pub struct Gooch {
    /// k_blue, display-referred RGB.
    pub blue: Vec3,
    /// k_yellow, display-referred RGB.
    pub yellow: Vec3,
    /// α: the share of the object's colour in the cool tone, usually 0..=1.
    pub alpha: f32,
    /// β: the share of the object's colour in the warm tone, usually 0..=1.
    pub beta: f32,
    /// The assignment of α and β to the two tones.
    pub tones: Tones,
    /// The highlight, which covers the tones.
    pub highlight: Option<Highlight>,
}

/// The assignment of α and β to the cool and the warm tone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Tones {
    /// k_cool = k_blue + α k_d and k_warm = k_yellow + β k_d: Gooch et al. 1998, and the equation of Card & Mitchell 2002.
    #[default]
    Equation,
    /// k_cool = k_blue + β k_d and k_warm = k_yellow + α k_d: Card & Mitchell 2002, listing 7, which swaps α and β.
    SwappedShares,
}

/// A highlight that is blended over the tones. Unlike an added highlight it reaches exactly its own colour and does not
/// clip.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case", deny_unknown_fields))]
pub struct Highlight {
    /// Display-referred RGB.
    pub color: Vec3,
    /// The opacity at the centre of the highlight, 0..=1.
    pub strength: f32,
    /// The exponent n of Phong's term (R·E)^n, above 0.
    pub exponent: f32,
}

impl Gooch {
    /// A model from the four parameters of Gooch et al. 1998: k_blue = (0, 0, `b`), k_yellow = (`y`, `y`, 0), all usually
    /// within 0..=1. With the highlight of [`Gooch::default`].
    pub fn from_numbers(b: f32, y: f32, alpha: f32, beta: f32) -> Self {
        Self {
            blue: Vec3::new(0.0, 0.0, b),
            yellow: Vec3::new(y, y, 0.0),
            alpha,
            beta,
            tones: Tones::Equation,
            highlight: Some(Highlight { color: Vec3::ONE, strength: 1.0, exponent: 32.0 }),
        }
    }

    /// Card & Mitchell 2002, listing 7, which swaps α and β, with the numbers of its comments: α 0.4, β 0.5, k_yellow
    /// (0.5, 0.5, 0), k_blue (0, 0, 0.4), no highlight. Its example of k_d is [`EXAMPLE_K_D`].
    pub fn swapped_shares() -> Self {
        Self { tones: Tones::SwappedShares, highlight: None, ..Self::from_numbers(0.4, 0.5, 0.4, 0.5) }
    }

    /// The shares of the object's colour in the cool and in the warm tone.
    pub fn shares(&self) -> [f32; 2] {
        match self.tones {
            Tones::Equation => [self.alpha, self.beta],
            Tones::SwappedShares => [self.beta, self.alpha],
        }
    }

    /// Checks all fields and returns the first violation.
    pub fn validate(&self) -> Result<(), GoochError> {
        if !is_color(self.blue) {
            return Err(GoochError::Blue { value: self.blue });
        }
        if !is_color(self.yellow) {
            return Err(GoochError::Yellow { value: self.yellow });
        }
        if !is_share(self.alpha) {
            return Err(GoochError::Alpha { value: self.alpha });
        }
        if !is_share(self.beta) {
            return Err(GoochError::Beta { value: self.beta });
        }
        if let Some(Highlight { color, strength, exponent }) = self.highlight {
            if !is_color(color) {
                return Err(GoochError::HighlightColor { value: color });
            }
            if !(0.0..=1.0).contains(&strength) {
                return Err(GoochError::HighlightStrength { value: strength });
            }
            if !(exponent > 0.0 && exponent.is_finite()) {
                return Err(GoochError::HighlightExponent { value: exponent });
            }
        }
        Ok(())
    }
}

impl Default for Gooch {
    /// The parameters of Gooch et al. 1998: b = 0.55, y = 0.3, α = 0.25, β = 0.5, and a white highlight. The paper states
    /// no exponent; this crate uses 32.
    fn default() -> Self {
        Self::from_numbers(0.55, 0.3, 0.25, 0.5)
    }
}

fn is_share(value: f32) -> bool {
    value >= 0.0 && value.is_finite()
}

fn is_color(value: Vec3) -> bool {
    value.is_finite() && value.min_element() >= 0.0
}
