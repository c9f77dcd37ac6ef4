//! What a tonal art map is to be like.

use crate::HatchError;

/// The smallest side of a map's finest level.
pub const MIN_SIDE: u32 = 8;
/// The largest side of a map's finest level.
pub const MAX_SIDE: u32 = 4096;
/// The most tones that a map may have.
pub const MAX_TONES: usize = 64;
/// The most candidates for a stroke.
pub const MAX_CANDIDATES: u32 = 4096;

/// How the next stroke's place is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Placement {
    /// The (0, 2)-sequence of Sobol', its digits scrambled (Owen 1995): among any 2^(a+b) strokes in a row from a
    /// multiple of that, each of the 2^a × 2^b equal boxes has one, for every a and b. The places cost a few
    /// integer operations each and are even in both axes after any number of strokes, so nothing has to be
    /// searched.
    Sequence,
    /// The best of some random candidates, as in Praun 2001: that which adds the most ink to the levels, by its own.
    BestOf {
        /// How many are tried for each stroke, 1..=[`MAX_CANDIDATES`].
        candidates: u32,
    },
}

/// What a tonal art map is to be like.
///
/// Angles turn from the texture's x axis toward its y axis. Where `jitter_deg`, `bow`, `length` and `pressure` say how
/// much strokes differ, each stroke's own value is drawn evenly from the range.
#[derive(Clone, Debug, PartialEq)]
pub struct TamParameters {
    /// Mean tones, 0 black and 1 white, the lightest first: strictly falling, white and black excluded.
    pub tones: Vec<f32>,
    /// Side of the finest level in texels: a power of two, [`MIN_SIDE`]..=[`MAX_SIDE`].
    pub side: u32,
    /// What the strokes' places and shapes are drawn from.
    pub seed: u64,
    /// A stroke's width in texels, the same at every level: 1..=64, and at most a quarter of the side. (A thinner
    /// one could make no texel black.)
    pub width_px: f32,
    /// A stroke's length as a share of the side: 0.02..=1. (No stroke is drawn shorter than two texels.)
    pub length: [f32; 2],
    /// Along what the strokes run.
    pub angle_deg: f32,
    /// How far a stroke may be turned from that, either way: 0..=45.
    pub jitter_deg: f32,
    /// How far a stroke may bend from its chord, either way, as a share of its length: 0..=0.2.
    pub bow: f32,
    /// The share of a stroke over which it thins out: 0..=1, half as fast where it is lifted as where it is set down.
    /// Of no effect on strokes from a picture.
    pub taper: f32,
    /// How black a stroke is: 0.05..=1.
    pub pressure: [f32; 2],
    /// From which tone on, counted from 0, the lightest, new strokes run crosswise, until there are as many as
    /// lengthwise ones; then both take turns. `None`: never.
    pub cross_from: Option<usize>,
    /// From the lengthwise strokes to the crosswise ones.
    pub cross_deg: f32,
    /// How places are found.
    pub placement: Placement,
}

impl Default for TamParameters {
    /// Six tones from 6/7 to 1/7, 256 texels, strokes 1.5 texels wide, the three darker tones hatched crosswise.
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

/// `count` tones in equal steps between white and black, these excluded: 1 - i / (count + 1). With six of them the blend
/// of listing 5 is as light as its light factor says ([`crate::hatch_transfer`]).
pub fn even_tones(count: usize) -> Vec<f32> {
    (1..=count).map(|i| 1.0 - i as f32 / (count + 1) as f32).collect()
}

impl TamParameters {
    /// Which rule is broken, if one is; the first found.
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

/// Whether a map can have this side.
pub(crate) fn validate_side(side: u32) -> Result<(), HatchError> {
    if !side.is_power_of_two() || !(MIN_SIDE..=MAX_SIDE).contains(&side) {
        return Err(HatchError::Side { side });
    }
    Ok(())
}

/// Whether a map can have these tones and this side.
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
