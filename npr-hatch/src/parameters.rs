//! The parameters of a tonal art map.

use crate::HatchError;

/// The minimum side of a map's finest level in texels.
pub const MIN_SIDE: u32 = 8;
/// The maximum side of a map's finest level in texels.
pub const MAX_SIDE: u32 = 4096;
/// The maximum number of tones of a map.
pub const MAX_TONES: usize = 64;
/// The maximum number of candidates per stroke.
pub const MAX_CANDIDATES: u32 = 4096;

/// The method that determines the positions of strokes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case", deny_unknown_fields))]
#[non_exhaustive]
pub enum Placement {
    /// The (0, 2)-sequence of Sobol' with scrambled digits (Owen 1995): of any 2^(a+b) consecutive strokes that begin at a
    /// multiple of 2^(a+b), each of the 2^a × 2^b equal boxes contains one, for every a and b. A position takes a few
    /// integer operations.
    Sequence,
    /// The best of several random candidates (Praun et al. 2001): the one that adds the most ink to the levels relative to
    /// its own ink.
    BestOf {
        /// The number of candidates per stroke, 1..=[`MAX_CANDIDATES`].
        candidates: u32,
    },
}

/// The parameters of a tonal art map.
///
/// Angles are measured from the x axis of the texture towards its y axis. `jitter_deg`, `bow`, `length` and `pressure`
/// define ranges, from which the value of each stroke is drawn with uniform distribution.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(default, rename_all = "kebab-case", deny_unknown_fields))]
pub struct TamParameters {
    /// The mean tones, 0 black and 1 white, exclusive, in strictly descending order: the lightest first.
    pub tones: Vec<f32>,
    /// The side of the finest level in texels: a power of two, [`MIN_SIDE`]..=[`MAX_SIDE`].
    pub side: u32,
    /// The seed of the random positions and shapes of strokes.
    pub seed: u64,
    /// The width of strokes in texels, equal at every level: 1..=64, and at most a quarter of the side. Thinner strokes
    /// could not make a texel black.
    pub width_px: f32,
    /// The minimum and maximum length of strokes as a fraction of the side: 0.02..=1. Strokes are drawn with a length of at
    /// least two texels.
    pub length: [f32; 2],
    /// The direction of strokes in degrees, -360..=360.
    pub angle_deg: f32,
    /// The maximum deviation from that direction in degrees: 0..=45.
    pub jitter_deg: f32,
    /// The maximum sagitta of a stroke to either side of its chord, as a fraction of its length: 0..=0.2.
    pub bow: f32,
    /// The fraction of a stroke over which its width decreases at the ends: 0..=1, over half that length at the start. It
    /// has no effect on strokes from a picture.
    pub taper: f32,
    /// The minimum and maximum ink of strokes: 0.05..=1, where 1 is black.
    pub pressure: [f32; 2],
    /// The index of the first tone with crosswise strokes; 0 is the lightest. From this tone on, new strokes are crosswise
    /// until both directions have equal numbers of strokes, and then alternate. `None` disables crosswise strokes.
    pub cross_from: Option<usize>,
    /// The angle from lengthwise to crosswise strokes in degrees, -360..=360.
    pub cross_deg: f32,
    /// The method that determines positions.
    pub placement: Placement,
}

impl Default for TamParameters {
    /// Six tones from 6/7 to 1/7, a side of 256 texels, strokes 1.5 texels wide, and crosswise strokes in the three darker
    /// tones.
    fn default() -> Self {
        Self {
            tones: even_tones(6),
            side: 256,
            seed: 1,
            width_px: 1.5,
            length: [0.3, 0.6],
            angle_deg: 0.0,
            jitter_deg: 2.0,
            bow: 0.01,
            taper: 0.3,
            pressure: [0.8, 1.0],
            cross_from: Some(3),
            cross_deg: 90.0,
            placement: Placement::Sequence,
        }
    }
}

/// `count` tones in equal steps between white and black, exclusive: 1 - i / (count + 1). With six such tones the transfer
/// curve of [`crate::hatch_transfer`] is linear.
pub fn even_tones(count: usize) -> Vec<f32> {
    (1..=count).map(|i| 1.0 - i as f32 / (count + 1) as f32).collect()
}

impl TamParameters {
    /// Checks all fields and returns the first violation.
    pub fn validate(&self) -> Result<(), HatchError> {
        validate_shape(&self.tones, self.side)?;
        let within = |name, value: f32, low, high| {
            if value >= low && value <= high { Ok(()) } else { Err(HatchError::Range { name, value, low, high }) }
        };
        within("width_px", self.width_px, 1.0, 64.0_f32.min(self.side as f32 / 4.0))?;
        for (name, [low, high], least) in [("length", self.length, 0.02), ("pressure", self.pressure, 0.05)] {
            within(name, low, least, 1.0)?;
            within(name, high, least, 1.0)?;
            if low > high {
                return Err(HatchError::Order { name, low, high });
            }
        }
        within("angle_deg", self.angle_deg, -360.0, 360.0)?;
        within("jitter_deg", self.jitter_deg, 0.0, 45.0)?;
        within("bow", self.bow, 0.0, 0.2)?;
        within("taper", self.taper, 0.0, 1.0)?;
        within("cross_deg", self.cross_deg, -360.0, 360.0)?;
        if let Some(tone) = self.cross_from
            && tone >= self.tones.len()
        {
            return Err(HatchError::CrossFrom { tone, tones: self.tones.len() });
        }
        if let Placement::BestOf { candidates } = self.placement
            && !(1..=MAX_CANDIDATES).contains(&candidates)
        {
            return Err(HatchError::Candidates { candidates });
        }
        Ok(())
    }
}

/// Checks the side of a map.
pub(crate) fn validate_side(side: u32) -> Result<(), HatchError> {
    if !side.is_power_of_two() || !(MIN_SIDE..=MAX_SIDE).contains(&side) {
        return Err(HatchError::Side { side });
    }
    Ok(())
}

/// Checks the tones and the side of a map.
pub(crate) fn validate_shape(tones: &[f32], side: u32) -> Result<(), HatchError> {
    validate_side(side)?;
    if tones.is_empty() || tones.len() > MAX_TONES {
        return Err(HatchError::TonesCount { tones: tones.len() });
    }
    let mut before = 1.0;
    for (index, &value) in tones.iter().enumerate() {
        if !(value > 0.0 && value < before) {
            return Err(HatchError::Tone { index, value, before });
        }
        before = value;
    }
    Ok(())
}
