//! All tones in one channel: each texel holds the tone at which it turns to ink.
//!
//! After M. Webb, E. Praun, A. Finkelstein, H. Hoppe: *Fine Tone Control in Hardware Hatching*, NPAR 2002. Since strokes are
//! nested and have an order, the images of all tones are one image of thresholds, and there are as many tones as
//! texels instead of six. A texel's threshold comes from its place in that order, not from the six tones' levels: strokes
//! follow each other, and each grows from its start to its end as it gets darker. So exactly a share 1 - t of a
//! level's texels has a threshold above t, for every t, and no tone shows a step.

use crate::parameters::validate_side;
use crate::stroke::{Pen, cover};
use crate::{Drawing, HatchError, Mark, StrokeImage, TamParameters};

/// Half of full ink: from here on a texel counts as ink.
const INK: u8 = 128;

/// The thresholds of all levels.
#[derive(Clone, Debug, PartialEq)]
pub struct Thresholds {
    /// Side of the finest level.
    pub side: u32,
    /// From the finest level to that of one texel, row by row: the tone, 0 black and 65535 white, below which a texel is
    /// ink.
    pub levels: Vec<Vec<u16>>,
}

impl Thresholds {
    /// The thresholds of a drawing, with what it was drawn from.
    ///
    /// What is paper even in the darkest tone follows the ink of its neighbourhood: strokes grow together.
    pub fn new(drawing: &Drawing, parameters: &TamParameters, image: Option<&StrokeImage>) -> Self {
        let pen = Pen::new(parameters, image);
        let side = drawing.tam.side;
        let levels =
            drawing.marks.iter().enumerate().map(|(level, marks)| thresholds(drawing, marks, &pen, side >> level));
        Self { side, levels: levels.collect() }
    }

    /// Which rule is broken, if one is; the first found. What [`Thresholds::new`] gives breaks none.
    ///
    /// Each level of n texels has the thresholds 65535 (1 - (i + 1/2) / n), i from 0 to n - 1, rounded, in any order, and no
    /// other. So the share of ink is right at every tone; that the order is one of strokes cannot be told. Counting
    /// them takes a time linear in the texels, and two tables of 256 KiB.
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
            for (place, &texel) in texels.iter().enumerate() {
                found[usize::from(texel)] += 1;
                expected[usize::from(threshold(place, texels.len()))] += 1;
            }
            if let Some(value) = (0..=u16::MAX).find(|&value| found[usize::from(value)] != expected[usize::from(value)])
            {
                let (found, expected) = (found[usize::from(value)], expected[usize::from(value)]);
                return Err(HatchError::ThresholdCount { level, threshold: value, found, expected });
            }
        }
        Ok(())
    }

    /// A level in eight bits: 255 tones instead of one for each texel, and a filterable texture everywhere.
    pub fn to_u8(&self, level: usize) -> Vec<u8> {
        self.levels[level].iter().map(|&threshold| (u32::from(threshold) * 255 / 65535) as u8).collect()
    }
}

/// Of the texel with so many before it that turn to ink earlier, of `count`.
fn threshold(place: usize, count: usize) -> u16 {
    ((1.0 - (place as f64 + 0.5) / count as f64) * 65535.0).round() as u16
}

fn thresholds(drawing: &Drawing, marks: &[Mark], pen: &Pen, side: u32) -> Vec<u16> {
    let count = (side * side) as usize;
    let mut ink = vec![0_u8; count];
    // When a texel turns to ink.
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
            let faint = 255 * 11 - (around.sum::<u64>() + 2 * u64::from(ink[texel]));
            *time = (1 << 63) | faint << 32 | texel as u64;
        }
    }
    let mut order: Vec<u32> = (0..count as u32).collect();
    order.sort_unstable_by_key(|&texel| times[texel as usize]);
    let mut levels = vec![0; count];
    for (place, &texel) in order.iter().enumerate() {
        levels[texel as usize] = threshold(place, count);
    }
    levels
}

/// How much ink a texel has, 0..=1, where a tone is wanted.
///
/// `texel` is its threshold as a share of white. `width` is the span of tones over which a texel turns to ink: 0 gives
/// hard texels, whose share is exact; about as much as thresholds differ between the texels of an edge (0.02 to
/// 0.1) smooths them. Like the tones' images, thresholds may be filtered. Black is solid: a threshold that rounds to 0,
/// as one does in a map of side 256, is ink there too.
pub fn hatch_threshold(texel: f64, tone: f64, width: f64) -> f64 {
    if width > 0.0 {
        ((texel - tone) / width + 0.5).clamp(0.0, 1.0)
    } else if texel > tone || tone <= 0.0 {
        1.0
    } else {
        0.0
    }
}
