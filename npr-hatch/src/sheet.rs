//! Overview pictures: 8-bit gray pictures of a whole map, for [`crate::png`].
//!
//! They begin with the finest level that has at most [`LARGEST_SIDE`] texels along a side, which limits their size.

use crate::{Tam, Thresholds, hatch_threshold};

/// The maximum side in texels of an image on a sheet.
pub const LARGEST_SIDE: u32 = 512;

/// The distance between images in texels.
const GAP: u32 = 8;
/// The gray between images.
const BACKGROUND: u8 = 160;
/// The maximum number of tones per row.
const COLUMNS: u32 = 8;
/// The number of levels per tone.
const LEVELS: usize = 4;

/// An 8-bit gray picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// The number of columns.
    pub width: u32,
    /// The number of rows.
    pub height: u32,
    /// The gray of each texel row by row, 0 black and 255 white.
    pub texels: Vec<u8>,
}

impl Sheet {
    fn new(width: u32, height: u32) -> Self {
        Self { width, height, texels: vec![BACKGROUND; width as usize * height as usize] }
    }

    fn paste(&mut self, x: u32, y: u32, side: u32, image: &[u8]) {
        for (row, texels) in image.chunks_exact(side as usize).enumerate() {
            let first = (y as usize + row) * self.width as usize + x as usize;
            self.texels[first..first + side as usize].copy_from_slice(texels);
        }
    }
}

/// The finest level that a sheet shows.
fn first_level(side: u32) -> usize {
    (0..).find(|&level| side >> level <= LARGEST_SIDE).unwrap_or(0)
}

/// All tones, eight per row, each with its four finest levels below each other.
pub fn contact(tam: &Tam) -> Sheet {
    let first = first_level(tam.side);
    let side = tam.level_side(first);
    let tones = tam.tones.len() as u32;
    let (columns, rows) = (tones.min(COLUMNS), tones.div_ceil(COLUMNS));
    let levels = || (first..tam.levels()).take(LEVELS);
    let row_height: u32 = levels().map(|level| tam.level_side(level) + GAP).sum();
    let mut sheet = Sheet::new(columns * (side + GAP) + GAP, rows * row_height + GAP);
    for tone in 0..tones {
        let (x, mut y) = (GAP + tone % COLUMNS * (side + GAP), GAP + tone / COLUMNS * row_height);
        for level in levels() {
            sheet.paste(x, y, tam.level_side(level), tam.image(tone as usize, level));
            y += tam.level_side(level) + GAP;
        }
    }
    sheet
}

/// Each tone tiled 2 × 2 without gaps, one level coarser than in [`contact`].
pub fn tiled(tam: &Tam) -> Sheet {
    let level = first_level(tam.side) + 1;
    let side = tam.level_side(level);
    let tones = tam.tones.len() as u32;
    let columns = tones.div_ceil(2).min(COLUMNS);
    let step = 2 * side + GAP;
    let mut sheet = Sheet::new(columns * step + GAP, tones.div_ceil(columns) * step + GAP);
    for (tone, i) in (0..tones).flat_map(|tone| (0..4).map(move |i| (tone, i))) {
        let (x, y) = (GAP + tone % columns * step + i % 2 * side, GAP + tone / columns * step + i / 2 * side);
        sheet.paste(x, y, side, tam.image(tone as usize, level));
    }
    sheet
}

/// A gradient from white to black over four tiles, drawn with thresholds.
pub fn ramp(thresholds: &Thresholds) -> Sheet {
    let level = first_level(thresholds.side);
    let (side, texels) = (thresholds.side >> level, &thresholds.levels[level]);
    let mut sheet = Sheet::new(4 * side, side);
    let width = sheet.width;
    for (i, pixel) in (0..).zip(&mut sheet.texels) {
        let (x, y) = (i % width, i / width);
        let texel = f64::from(texels[(y * side + x % side) as usize]) / 65535.0;
        let tone = 1.0 - (f64::from(x) + 0.5) / f64::from(width);
        *pixel = (255.0 * (1.0 - hatch_threshold(texel, tone, 0.05)) + 0.5) as u8;
    }
    sheet
}
