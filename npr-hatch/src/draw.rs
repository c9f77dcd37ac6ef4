//! Strokes onto paper, until each image has its tone.

use crate::place::Order;
use crate::stroke::{Pen, cover};
use crate::{HatchError, Stroke, StrokeImage, Tam, TamParameters};

/// Which stroke.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Mark {
    /// 0 lengthwise, 1 crosswise.
    pub layer: usize,
    /// Into the layer's strokes.
    pub index: u32,
}

/// How much of the two layers an image has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Extent {
    /// How many strokes from the layer's beginning it has in full.
    pub whole: [u32; 2],
    /// With what share of its ink it has the stroke after those, in 255ths; 0: not at all.
    pub part: [u8; 2],
}

impl Extent {
    /// Whether the image has a stroke, be it in part.
    pub fn contains(&self, mark: Mark) -> bool {
        let whole = self.whole[mark.layer];
        mark.index < whole || mark.index == whole && self.part[mark.layer] > 0
    }

    /// How many strokes the image has, those in part included.
    pub fn strokes(&self) -> usize {
        (0..2).map(|layer| self.whole[layer] as usize + usize::from(self.part[layer] > 0)).sum()
    }
}

/// A tonal art map, and the strokes that it was made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// The images.
    pub tam: Tam,
    /// The strokes of the two layers, in the order in which they are placed.
    pub layers: [Vec<Stroke>; 2],
    /// By level, the finest first: its strokes in the order in which they are drawn.
    pub marks: Vec<Vec<Mark>>,
    /// In the order of [`Tam::images`]: what each image has.
    pub extents: Vec<Extent>,
}

impl Drawing {
    /// The images, drawn once more, with the parameters and the picture that this was made with: for strokes that have
    /// been moved or changed since.
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

/// Makes a tonal art map, of strokes that thin out at their ends, or that look like `image`.
///
/// Level by level from the coarsest, and tone by tone from the lightest, strokes are drawn until the image has its tone.
/// The last stroke of an image would be too much: there it has so much less ink as makes the tone come out, and in
/// darker tones and finer levels, where it must be as well, it has all of it.
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
        // How many strokes have as much ink as all texels, and 32 times as many: a texel remains paper under e^-32.
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

/// One level, as it becomes darker.
struct Sheet<'a> {
    side: u32,
    pen: Pen<'a>,
    ink: Vec<u8>,
    /// Of all the ink.
    sum: u64,
    extent: Extent,
    marks: Vec<Mark>,
    /// So many strokes that more would not help.
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

    /// Draws strokes until the tone is reached. All of the next coarser level's are among them. If the tone stays out of
    /// reach, how many strokes were drawn.
    fn darken(&mut self, orders: &mut [Order; 2], asked: f32, is_crossed: bool, coarser: Extent) -> Result<(), usize> {
        let target = ((1.0 - f64::from(asked)) * 255.0 * self.ink.len() as f64).round() as u64;
        for layer in 0..2 {
            while self.extent.whole[layer] < coarser.whole[layer] {
                self.look(orders, layer);
                self.put(layer, 255);
            }
        }
        while self.sum < target {
            if self.marks.len() > self.limit {
                return Err(self.marks.len());
            }
            let layer = self.next_layer(is_crossed, coarser);
            self.look(orders, layer);
            let strength = self.strength(layer, target - self.sum);
            self.put(layer, strength);
            if strength < 255 {
                break;
            }
        }
        for layer in 0..2 {
            // The image is dark enough, but the coarser one has a stroke more.
            if self.lacks_part(layer, coarser) {
                self.look(orders, layer);
                self.put(layer, 1);
            }
        }
        Ok(())
    }

    fn lacks_part(&self, layer: usize, coarser: Extent) -> bool {
        let Extent { whole, part } = self.extent;
        coarser.part[layer] > 0 && whole[layer] == coarser.whole[layer] && part[layer] == 0
    }

    /// What was begun comes first, then what the coarser level has begun.
    fn next_layer(&self, is_crossed: bool, coarser: Extent) -> usize {
        let Extent { whole: [lengthwise, crosswise], part } = self.extent;
        let begun = (0..2).find(|&layer| part[layer] > 0);
        let owed = (0..2).find(|&layer| self.lacks_part(layer, coarser));
        begun.or(owed).unwrap_or(usize::from(is_crossed && crosswise < lengthwise))
    }

    /// Finds out what the next stroke of a layer covers.
    fn look(&mut self, orders: &mut [Order; 2], layer: usize) {
        let stroke = orders[layer].stroke(self.extent.whole[layer] as usize);
        cover(&stroke, &self.pen, self.side, &mut self.covered);
    }

    /// By how much the stroke looked at makes the sum larger if it has so much of its ink.
    fn gain(&self, strength: u8) -> u64 {
        let more = |&(texel, ink): &(u32, u8)| u64::from(share(ink, strength).saturating_sub(self.ink[texel as usize]));
        self.covered.iter().map(more).sum()
    }

    /// How much of its ink the stroke looked at may have for the sum to grow by as close to `wanted` as it can: 1..=255,
    /// and no less than it has.
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

    /// Draws the stroke looked at, which is the layer's next one.
    fn put(&mut self, layer: usize, strength: u8) {
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

/// So many 255ths of the ink.
fn share(ink: u8, strength: u8) -> u8 {
    ((u32::from(ink) * u32::from(strength) + 127) / 255) as u8
}
