//! Draws strokes until each image has its tone.

use crate::order::Order;
use crate::stroke::{Pen, cover};
use crate::{HatchError, Stroke, StrokeImage, Tam, TamParameters};

/// Identifies a stroke of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Mark {
    /// The layer: 0 lengthwise strokes, 1 crosswise strokes.
    pub layer: usize,
    /// Index into the strokes of the layer.
    pub index: u32,
}

/// The prefixes of the two layers that an image contains.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Extent {
    /// Per layer, the number of strokes with full ink.
    pub whole: [u32; 2],
    /// Per layer, the ink of the following stroke in 255ths of its full ink; 0 if the image does not contain it.
    pub part: [u8; 2],
}

impl Extent {
    /// Whether the image contains a stroke, with full or reduced ink.
    pub fn contains(&self, mark: Mark) -> bool {
        let whole = self.whole[mark.layer];
        mark.index < whole || mark.index == whole && self.part[mark.layer] > 0
    }

    /// The number of strokes of the image, including those with reduced ink.
    pub fn strokes(&self) -> usize {
        (0..2).map(|layer| self.whole[layer] as usize + usize::from(self.part[layer] > 0)).sum()
    }
}

/// A tonal art map and its strokes.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// The images.
    pub tam: Tam,
    /// The strokes of the two layers in the order of placement.
    pub layers: [Vec<Stroke>; 2],
    /// Per level, the finest first: its strokes in the order of drawing.
    pub marks: Vec<Vec<Mark>>,
    /// The strokes of each image, in the order of [`Tam::images`].
    pub extents: Vec<Extent>,
}

impl Drawing {
    /// Draws the images again after strokes have been changed. `parameters` and `image` are those that the drawing was made
    /// with.
    pub fn images(&self, parameters: &TamParameters, image: Option<&StrokeImage>) -> Tam {
        let pen = Pen::new(parameters, image);
        let (tones, levels) = (self.tam.tones.len(), self.marks.len());
        let mut images = Vec::with_capacity(tones * levels);
        let mut covered = Vec::new();
        for (i, extent) in self.extents.iter().enumerate() {
            let side = self.tam.level_side(i % levels);
            let mut texels = vec![255; (side * side) as usize];
            for mark in self.marks[i % levels].iter().filter(|&&mark| extent.contains(mark)) {
                let is_whole = mark.index < extent.whole[mark.layer];
                let strength = if is_whole { 255 } else { extent.part[mark.layer] };
                cover(&self.layers[mark.layer][mark.index as usize], &pen, side, &mut covered);
                for &(texel, ink) in &covered {
                    let texel: &mut u8 = &mut texels[texel as usize];
                    *texel = (255 - share(ink, strength)).min(*texel);
                }
            }
            images.push(texels);
        }
        Tam { tones: self.tam.tones.clone(), side: self.tam.side, images }
    }
}

/// Draws a tonal art map with tapered strokes, or with strokes from `image`.
///
/// The levels are drawn from the coarsest to the finest, and the tones of a level from the lightest to the darkest. Strokes
/// are added until an image has its tone. The last stroke of an image has reduced ink so that the tone is met, and full ink
/// in darker tones and finer levels, which contain it as well.
///
/// Errors: those of [`TamParameters::validate`], and [`HatchError::Unreachable`] if the strokes are too faint for a tone.
pub fn draw(parameters: &TamParameters, image: Option<&StrokeImage>) -> Result<Drawing, HatchError> {
    parameters.validate()?;
    let pen = Pen::new(parameters, image);
    let mut orders = [0, 1].map(|layer| Order::new(parameters, pen, layer));
    let tones = &parameters.tones;
    let levels = parameters.side.trailing_zeros() as usize + 1;
    let mut images = vec![Vec::new(); tones.len() * levels];
    let mut extents = vec![Extent::default(); tones.len() * levels];
    let mut marks = vec![Vec::new(); levels];
    for level in (0..levels).rev() {
        let side = parameters.side >> level;
        // 32 times the number of strokes whose ink equals that of a black image: the expected fraction of paper is then
        // below e^-32.
        let stroke = f64::from(parameters.length[0] * side as f32 * pen.width_px) * pen.mean_ink().max(0.01);
        let limit = 1024 + (32.0 * f64::from(side * side) / stroke) as usize;
        let mut sheet = Sheet::new(side, pen, limit);
        for (tone, &asked) in tones.iter().enumerate() {
            let coarser = if level + 1 < levels { extents[tone * levels + level + 1] } else { Extent::default() };
            let is_crossed = parameters.cross_from.is_some_and(|from| tone >= from);
            sheet.darken(&mut orders, asked, is_crossed, coarser).map_err(|strokes| HatchError::Unreachable {
                tone,
                asked,
                side: sheet.side,
                strokes,
                reached: sheet.tone(),
            })?;
            extents[tone * levels + level] = sheet.extent;
            images[tone * levels + level] = sheet.ink.iter().map(|&ink| 255 - ink).collect();
        }
        marks[level] = sheet.marks;
    }
    let tam = Tam { tones: tones.clone(), side: parameters.side, images };
    Ok(Drawing { tam, layers: orders.map(|order| order.strokes), marks, extents })
}

/// One level while strokes are added.
struct Sheet<'a> {
    side: u32,
    pen: Pen<'a>,
    ink: Vec<u8>,
    /// The sum of `ink`.
    sum: u64,
    extent: Extent,
    marks: Vec<Mark>,
    /// The number of strokes after which a tone counts as unreachable.
    limit: usize,
    covered: Vec<(u32, u8)>,
}

impl<'a> Sheet<'a> {
    fn new(side: u32, pen: Pen<'a>, limit: usize) -> Self {
        let ink = vec![0; (side * side) as usize];
        Self { side, pen, ink, sum: 0, extent: Extent::default(), marks: Vec::new(), limit, covered: Vec::new() }
    }

    fn tone(&self) -> f64 {
        1.0 - self.sum as f64 / (255.0 * self.ink.len() as f64)
    }

    /// Adds strokes, first those of the next coarser level, until the tone is reached. The error is the number of strokes if
    /// the tone is unreachable.
    fn darken(&mut self, orders: &mut [Order; 2], asked: f32, is_crossed: bool, coarser: Extent) -> Result<(), usize> {
        let target = ((1.0 - f64::from(asked)) * 255.0 * self.ink.len() as f64).round() as u64;
        for layer in 0..2 {
            while self.extent.whole[layer] < coarser.whole[layer] {
                self.cover_next(orders, layer);
                self.draw_covered(layer, 255);
            }
        }
        while self.sum < target {
            if self.marks.len() > self.limit {
                return Err(self.marks.len());
            }
            let layer = self.next_layer(is_crossed, coarser);
            self.cover_next(orders, layer);
            let strength = self.strength(layer, target - self.sum);
            self.draw_covered(layer, strength);
            if strength < 255 {
                break;
            }
        }
        for layer in 0..2 {
            // The image is dark enough, but the coarser level contains one more stroke, with reduced ink.
            if self.lacks_part(layer, coarser) {
                self.cover_next(orders, layer);
                self.draw_covered(layer, 1);
            }
        }
        Ok(())
    }

    fn lacks_part(&self, layer: usize, coarser: Extent) -> bool {
        let Extent { whole, part } = self.extent;
        coarser.part[layer] > 0 && whole[layer] == coarser.whole[layer] && part[layer] == 0
    }

    /// The layer of the next stroke: first one with reduced ink in this image, then one with reduced ink in the coarser
    /// level, then by `is_crossed`.
    fn next_layer(&self, is_crossed: bool, coarser: Extent) -> usize {
        let Extent { whole: [lengthwise, crosswise], part } = self.extent;
        let partial = (0..2).find(|&layer| part[layer] > 0);
        let partial_in_coarser = (0..2).find(|&layer| self.lacks_part(layer, coarser));
        partial.or(partial_in_coarser).unwrap_or(usize::from(is_crossed && crosswise < lengthwise))
    }

    /// Finds the texels that the next stroke of a layer covers.
    fn cover_next(&mut self, orders: &mut [Order; 2], layer: usize) {
        let stroke = orders[layer].stroke(self.extent.whole[layer] as usize);
        cover(&stroke, &self.pen, self.side, &mut self.covered);
    }

    /// The increase of the sum by the covered texels if the stroke has this share of its ink, in 255ths.
    fn gain(&self, strength: u8) -> u64 {
        let more = |&(texel, ink): &(u32, u8)| u64::from(share(ink, strength).saturating_sub(self.ink[texel as usize]));
        self.covered.iter().map(more).sum()
    }

    /// The share of ink, 1..=255 and at least its present share, with which the stroke increases the sum by an amount as
    /// close to `wanted` as possible.
    fn strength(&self, layer: usize, wanted: u64) -> u8 {
        if self.gain(255) <= wanted {
            return 255;
        }
        let (mut low, mut high) = (self.extent.part[layer], 255);
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            if self.gain(middle) > wanted { high = middle } else { low = middle }
        }
        if low > 0 && wanted - self.gain(low) <= self.gain(high) - wanted { low } else { high }
    }

    /// Draws the covered texels with this share of ink, and counts the stroke.
    fn draw_covered(&mut self, layer: usize, strength: u8) {
        for &(texel, ink) in &self.covered {
            let under = &mut self.ink[texel as usize];
            let over = share(ink, strength).max(*under);
            self.sum += u64::from(over - *under);
            *under = over;
        }
        let Extent { whole, part } = &mut self.extent;
        if part[layer] == 0 {
            self.marks.push(Mark { layer, index: whole[layer] });
        }
        if strength == 255 {
            whole[layer] += 1;
            part[layer] = 0;
        } else {
            part[layer] = strength;
        }
    }
}

/// `strength` 255ths of the ink, rounded.
fn share(ink: u8, strength: u8) -> u8 {
    ((u32::from(ink) * u32::from(strength) + 127) / 255) as u8
}
