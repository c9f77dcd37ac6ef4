//! What the light is made of.

use glam::Vec3;

use crate::GoochError;

/// The object's colour in listing 7's comments, k_d: display-referred RGB.
pub const LISTING_7_K_D: Vec3 = Vec3::new(0.0, 0.0, 0.4);

/// Cool and warm, and how much of the object's colour is in each.
///
/// Check a value that was not made by a constructor with [`Gooch::validate`]. The functions of this crate do not
/// panic on bad ones, but what they return then means nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gooch {
    /// k_blue, display-referred RGB.
    pub blue: Vec3,
    /// k_yellow, display-referred RGB.
    pub yellow: Vec3,
    /// α: how much of the object's colour is in the cool tone, usually 0..=1.
    pub alpha: f32,
    /// β: how much of it is in the warm tone, usually 0..=1.
    pub beta: f32,
    /// Which of the two goes with which.
    pub tones: Tones,
    /// What lies over the tones.
    pub highlight: Option<Highlight>,
}

/// How cool and warm are made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Tones {
    /// k_cool = k_blue + α k_d, k_warm = k_yellow + β k_d: Gooch 1998, and Card & Mitchell's equation.
    #[default]
    Equation,
    /// The lit side is k_yellow + α k_d and the other one k_blue + β k_d: Card & Mitchell's listing 7 as printed,
    /// with α and β the other way around.
    Listing7,
}

/// A spot that is mixed over the tones, not added, so that it reaches its own colour and does not clip on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Highlight {
    /// Display-referred RGB.
    pub color: Vec3,
    /// How opaque it is in its middle: 0 leaves the tone, 1 replaces it.
    pub strength: f32,
    /// The exponent of Phong's term (R·E)^n: the larger, the smaller the spot.
    pub exponent: f32,
}

impl Gooch {
    /// The paper's four numbers: k_blue = (0, 0, `b`), k_yellow = (`y`, `y`, 0), all usually within 0..=1. With the
    /// highlight of [`Gooch::default`].
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

    /// Card & Mitchell's listing 7 as printed, with the numbers of its comments: α 0.4, β 0.5, k_yellow (0.5, 0.5, 0),
    /// k_blue (0, 0, 0.4). No highlight. Its k_d is [`LISTING_7_K_D`].
    pub fn listing_7() -> Self {
        Self { tones: Tones::Listing7, highlight: None, ..Self::from_numbers(0.4, 0.5, 0.4, 0.5) }
    }

    /// How much of the object's colour is in the cool tone, and how much in the warm.
    pub fn shares(&self) -> [f32; 2] {
        match self.tones {
            Tones::Equation => [self.alpha, self.beta],
            Tones::Listing7 => [self.beta, self.alpha],
        }
    }

    /// Which rule is broken, if one is; the first found.
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
    /// Gooch 1998: b = 0.55, y = 0.3, α = 0.25, β = 0.5, and a white highlight. The paper gives no exponent; 32 is this
    /// crate's.
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
