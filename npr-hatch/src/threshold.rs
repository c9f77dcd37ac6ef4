//! All tones in one channel: each texel stores the tone below which it is ink.
//!
//! After M. Webb, E. Praun, A. Finkelstein, H. Hoppe: *Fine Tone Control in Hardware Hatching*, NPAR 2002. Since strokes are
//! nested and ordered, the images of all tones can be stored as one image of thresholds, with as many tones as texels. The
//! threshold of a texel is its rank in the order of inking: strokes are drawn one after another, each from its start to
//! its end. For every t exactly a fraction 1 - t of the texels of a level has a threshold above t.

use crate::parameters::validate_side;
use crate::stroke::{Pen, cover};
use crate::{Drawing, HatchError, Mark, StrokeImage, TamParameters};

/// The minimum coverage of a texel that counts as ink, of 255.
const INK: u8 = 128;

/// The thresholds of all levels.
#[derive(Clone, Debug, PartialEq)]
pub struct Thresholds {
    /// Side of the finest level in texels.
    pub side: u32,
    /// Per level, from the finest to that of one texel, row by row: the tone below which a texel is ink, 0 black and
    /// 65535 white.
    pub levels: Vec<Vec<u16>>,
}

impl Thresholds {
    /// The thresholds of a drawing. `parameters` and `image` are those that it was drawn with.
    ///
    /// Texels that are paper in the darkest tone are ordered by the ink of their neighbourhood, darkest first.
    pub fn new(drawing: &Drawing, parameters: &TamParameters, image: Option<&StrokeImage>) -> Self {
        let pen = Pen::new(parameters, image);
        let side = drawing.tam.side;
        let levels =
            drawing.marks.iter().enumerate().map(|(level, marks)| thresholds(drawing, marks, &pen, side >> level));
        Self { side, levels: levels.collect() }
    }

    /// Checks all levels and returns the first violation. The result of [`Thresholds::new`] is valid.
    ///
    /// A valid level of n texels has exactly the thresholds 65535 (1 - (i + 1/2) / n), i from 0 to n - 1, rounded, in any
    /// order, so that the fraction of ink is correct for every tone. The time is linear in the number of texels; two tables
    /// of 256 KiB are allocated.
    pub fn validate(&self) -> Result<(), HatchError> {
        validate_side(self.side)?;
        let levels = self.side.trailing_zeros() as usize + 1;
        for level in 0..levels.max(self.levels.len()) {
            let texels = self.levels.get(level).map_or(0, Vec::len);
            let expected = if level < levels { (self.side as usize >> level).pow(2) } else { 0 };
            if texels != expected || level >= levels {
                return Err(HatchError::ThresholdSize { level, texels, expected });
            }
        }
        for (level, texels) in self.levels.iter().enumerate() {
            let (mut found, mut expected) = (vec![0_u32; 1 << 16], vec![0_u32; 1 << 16]);
            for (rank, &texel) in texels.iter().enumerate() {
                found[usize::from(texel)] += 1;
                expected[usize::from(threshold(rank, texels.len()))] += 1;
            }
            if let Some(value) = (0..=u16::MAX).find(|&value| found[usize::from(value)] != expected[usize::from(value)])
            {
                let (found, expected) = (found[usize::from(value)], expected[usize::from(value)]);
                return Err(HatchError::ThresholdCount { level, threshold: value, found, expected });
            }
        }
        Ok(())
    }

    /// A level in 8 bits, rounded down, for texture formats that every device can filter.
    pub fn to_u8(&self, level: usize) -> Vec<u8> {
        self.levels[level].iter().map(|&threshold| (u32::from(threshold) * 255 / 65535) as u8).collect()
    }
}

/// The threshold of the texel with this rank in the order of inking of `count` texels.
fn threshold(rank: usize, count: usize) -> u16 {
    ((1.0 - (rank as f64 + 0.5) / count as f64) * 65535.0).round() as u16
}

fn thresholds(drawing: &Drawing, marks: &[Mark], pen: &Pen, side: u32) -> Vec<u16> {
    let count = (side * side) as usize;
    let mut ink = vec![0_u8; count];
    // Sort keys: the stroke by which a texel turns to ink, and the position along it.
    let mut times = vec![u64::MAX; count];
    let mut covered = Vec::new();
    for (rank, mark) in marks.iter().enumerate() {
        cover(&drawing.layers[mark.layer][mark.index as usize], pen, side, &mut covered);
        for (i, &(texel, over)) in covered.iter().enumerate() {
            let texel = texel as usize;
            if over > ink[texel] {
                if over >= INK && ink[texel] < INK {
                    times[texel] = (rank as u64) << 32 | i as u64;
                }
                ink[texel] = over;
            }
        }
    }
    let mask = side as usize - 1;
    for (texel, time) in times.iter_mut().enumerate() {
        if *time == u64::MAX {
            let (x, y) = (texel & mask, texel / side as usize);
            let around = (0..9)
                .map(|i| u64::from(ink[((y + mask + i / 3) & mask) * side as usize + ((x + mask + i % 3) & mask)]));
            // After all inked texels, by the missing ink of the 3 × 3 neighbourhood with the centre weighted threefold.
            let missing = 255 * 11 - (around.sum::<u64>() + 2 * u64::from(ink[texel]));
            *time = (1 << 63) | missing << 32 | texel as u64;
        }
    }
    let mut order: Vec<u32> = (0..count as u32).collect();
    order.sort_unstable_by_key(|&texel| times[texel as usize]);
    let mut levels = vec![0; count];
    for (rank, &texel) in order.iter().enumerate() {
        levels[texel as usize] = threshold(rank, count);
    }
    levels
}

/// The ink of a texel for a tone, 0..=1.
///
/// `texel` is its threshold, 0..=1. `width` is the range of tones over which it turns to ink: 0 gives binary texels, whose
/// fraction of ink is exact; a width of the order of the threshold difference between texels at an edge (0.02 to 0.1)
/// smooths them. At tone 0 every texel is ink, including those whose threshold rounds to 0, as one does in a map of side
/// 256.
pub fn hatch_threshold(texel: f64, tone: f64, width: f64) -> f64 {
    if width > 0.0 {
        ((texel - tone) / width + 0.5).clamp(0.0, 1.0)
    } else if texel > tone || tone <= 0.0 {
        1.0
    } else {
        0.0
    }
}

/// The value to compare thresholds with so that the mean has the requested tone, for texels that turn to ink over `width`,
/// 0..=1. It is the tone itself except near black and white, where a part of the width is beyond all thresholds.
///
/// Thresholds are distributed evenly over 0..=1. Compared with τ < width / 2 they leave a mean of
/// (τ + width / 2)² / (2 width) paper, which is solved for τ; white is symmetric. For black and white the result is outside
/// the range of all thresholds, so that rounding leaves no specks.
///
/// ```
/// use npr_hatch::lookup::hatch_soft_tone;
/// assert_eq!([0.0, 0.3, 1.0].map(|tone| hatch_soft_tone(tone, 0.25)), [-0.25, 0.3, 1.25]);
/// ```
pub fn hatch_soft_tone(tone: f64, width: f64) -> f64 {
    let end = 0.5 * width;
    if tone <= 0.0 {
        -width
    } else if tone >= 1.0 {
        1.0 + width
    } else if tone < end {
        (2.0 * width * tone).sqrt() - end
    } else if tone > 1.0 - end {
        1.0 + end - (2.0 * width * (1.0 - tone)).sqrt()
    } else {
        tone
    }
}
