//! The sequence of strokes.
//!
//! There is one sequence of strokes per direction, and every image draws a prefix of it, so that strokes are nested in tones
//! and in mip levels for any sequence. Every prefix must be distributed evenly.

use oorandom::Rand32;

use crate::stroke::{Pen, Stroke, cover};
use crate::{Placement, TamParameters};

/// The infinite sequence of strokes of one direction.
pub(crate) struct Order<'a> {
    /// The strokes placed so far.
    pub strokes: Vec<Stroke>,
    parameters: &'a TamParameters,
    pen: Pen<'a>,
    angle: f64,
    random: Rand32,
    /// The seeds of the scrambling of the sequence's axes.
    scramble: [u64; 2],
    /// The side and the ink of each level with all strokes placed so far, to rate candidates.
    levels: Vec<(u32, Vec<u8>)>,
    covered: Vec<(u32, u8)>,
}

impl<'a> Order<'a> {
    /// `layer` is 0 for lengthwise and 1 for crosswise strokes.
    pub fn new(parameters: &'a TamParameters, pen: Pen<'a>, layer: u64) -> Self {
        let turn = if layer == 0 { 0.0 } else { parameters.cross_deg };
        let seed = mix(parameters.seed ^ mix(layer));
        let levels = match parameters.placement {
            Placement::Sequence => Vec::new(),
            // Below a side of 8 texels candidates hardly differ.
            Placement::BestOf { .. } => std::iter::successors(Some(parameters.side), |side| Some(side / 2))
                .take_while(|&side| side >= 8)
                .map(|side| (side, vec![0; (side * side) as usize]))
                .collect(),
        };
        Self {
            strokes: Vec::new(),
            parameters,
            pen,
            angle: f64::from(parameters.angle_deg) + f64::from(turn),
            random: Rand32::new(seed),
            scramble: [mix(seed ^ 1), mix(seed ^ 2)],
            levels,
            covered: Vec::new(),
        }
    }

    /// The stroke at `index`. Strokes up to it are placed if necessary.
    pub fn stroke(&mut self, index: usize) -> Stroke {
        while self.strokes.len() <= index {
            let stroke = match self.parameters.placement {
                Placement::Sequence => {
                    let i = self.strokes.len() as u32;
                    let centre = [scramble(radical(i), self.scramble[0]), scramble(sobol(i), self.scramble[1])];
                    self.drawn(centre)
                }
                Placement::BestOf { candidates } => self.best_of(candidates),
            };
            self.strokes.push(stroke);
        }
        self.strokes[index]
    }

    /// A stroke of random shape with this centre.
    fn drawn(&mut self, centre: [u32; 2]) -> Stroke {
        let p = self.parameters;
        let mut between = |low: f32, high: f32| low + (high - low) * self.random.rand_float();
        let length = between(p.length[0], p.length[1]);
        let jitter = between(-p.jitter_deg, p.jitter_deg);
        let bow = between(-p.bow, p.bow);
        let pressure = between(p.pressure[0], p.pressure[1]);
        // The standard library's functions may differ between platforms.
        let (sin, cos) = libm::sincos((self.angle + f64::from(jitter)).to_radians());
        Stroke { centre, direction: [cos as f32, sin as f32], length, bow, pressure }
    }

    fn best_of(&mut self, candidates: u32) -> Stroke {
        let mut best = (f64::NEG_INFINITY, None);
        for _ in 0..candidates {
            let centre = [self.random.rand_u32(), self.random.rand_u32()];
            let stroke = self.drawn(centre);
            let mut score = 0.0;
            for (side, ink) in &self.levels {
                cover(&stroke, &self.pen, *side, &mut self.covered);
                let (mut all, mut new) = (0_u32, 0_u32);
                for &(texel, value) in &self.covered {
                    all += u32::from(value);
                    new += u32::from(value.saturating_sub(ink[texel as usize]));
                }
                score += f64::from(new) / f64::from(all.max(1));
            }
            if score > best.0 {
                best = (score, Some(stroke));
            }
        }
        let stroke = best.1.unwrap_or_else(|| self.drawn([0, 0]));
        for (side, ink) in &mut self.levels {
            cover(&stroke, &self.pen, *side, &mut self.covered);
            for &(texel, value) in &self.covered {
                let ink = &mut ink[texel as usize];
                *ink = value.max(*ink);
            }
        }
        stroke
    }
}

/// Van der Corput's sequence: the binary digits of `i` mirrored at the point, in 2^-32.
fn radical(i: u32) -> u32 {
    i.reverse_bits()
}

/// The second axis of the sequence of Sobol', whose direction numbers are the rows of Pascal's triangle modulo 2.
fn sobol(mut i: u32) -> u32 {
    let (mut x, mut direction) = (0, 1 << 31);
    while i != 0 {
        if i & 1 == 1 {
            x ^= direction;
        }
        direction ^= direction >> 1;
        i >>= 1;
    }
    x
}

/// Nested scrambling (Owen 1995): flips each bit of `x` at random, depending on all higher bits. It preserves the
/// equidistribution of a sequence.
fn scramble(x: u32, seed: u64) -> u32 {
    (0..32_u64).fold(x, |out, bit| {
        let above = (u64::from(x) >> (bit + 1)) | (bit << 40);
        out ^ (((mix(seed ^ mix(above)) >> 63) as u32) << bit)
    })
}

/// One step of SplitMix64 (Steele, Lea & Flood 2014), a bijection.
fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}
