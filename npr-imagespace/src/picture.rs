//! Pictures as slices of rows from the top, their borders, and the neighbours that a filter reads.
//!
//! # Borders
//!
//! In the first and the last column the horizontal part of a filter's steps is 0, in the first and the last row the
//! vertical part. All taps then lie in the picture and opposite taps stay opposite, so that second differences over
//! them are valid. A picture of one pixel has no line, one of 1 × n px is filtered along its length, and a border
//! between the outermost two columns is drawn on the inner one. The papers do not say what lies outside.

use crate::ImageSpaceError;
use glam::{IVec2, UVec2};

/// WGSL of this module: no bindings, no entry points.
pub const PICTURE_WGSL: &str = include_str!("picture.wgsl");

/// Which neighbours a filter reads besides the pixel itself. Taps 0 and 2 are opposite, and 1 and 3.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Taps {
    /// Down right, down left, up left, up right: Card & Mitchell 2002, the slides of SIGGRAPH 2002, the inker.
    #[default]
    Diagonal,
    /// Right, down, left, up.
    Cross,
}

impl Taps {
    /// The four steps in px, x to the right and y down.
    pub fn offsets(self) -> [IVec2; 4] {
        match self {
            Self::Diagonal => [0, 1, 2, 3].map(|tap| ink_tap_diagonal(tap, IVec2::ONE)),
            Self::Cross => [0, 1, 2, 3].map(|tap| ink_tap_cross(tap, IVec2::ONE)),
        }
    }

    /// The ink, as a share of a full line, of one tap across a border where lines are soft: a straight border has two
    /// diagonal taps across it, and one tap along the axes.
    pub fn weight(self) -> f32 {
        match self {
            Self::Diagonal => 0.5,
            Self::Cross => 1.0,
        }
    }
}

/// How far a filter at a pixel steps along x and y: 1, or 0 where a step to either side would leave the picture.
pub fn ink_reach(pixel: UVec2, size_px: UVec2) -> IVec2 {
    let along = |at: u32, size: u32| i32::from(at > 0 && at + 1 < size);
    IVec2::new(along(pixel.x, size_px.x), along(pixel.y, size_px.y))
}

/// The step in px to diagonal tap 0–3: down right, down left, up left, up right. `reach` is that of [`ink_reach`].
fn ink_tap_diagonal(tap: u32, reach: IVec2) -> IVec2 {
    reach * IVec2::new(if tap == 0 || tap == 3 { 1 } else { -1 }, if tap < 2 { 1 } else { -1 })
}

/// The step in px to tap 0–3 along the axes: right, down, left, up. `reach` is that of [`ink_reach`].
fn ink_tap_cross(tap: u32, reach: IVec2) -> IVec2 {
    let along = if tap < 2 { 1 } else { -1 };
    reach * if tap & 1 == 0 { IVec2::new(along, 0) } else { IVec2::new(0, along) }
}

/// The number of pixels, or an error if a slice of `len` elements has another number.
pub(crate) fn checked_len(len: usize, size_px: UVec2) -> Result<usize, ImageSpaceError> {
    if size_px.x as usize * size_px.y as usize == len {
        return Ok(len);
    }
    Err(ImageSpaceError::Length { len, size_px })
}

/// Runs a filter over a picture, from the pixel and its four taps to ink within 0..=1, and stores the ink as an 8-bit
/// unorm target does.
///
/// # Errors
/// If `texels` does not have one element for each pixel.
pub fn filter_picture<T: Copy>(
    texels: &[T],
    size_px: UVec2,
    taps: Taps,
    filter: impl Fn(T, [T; 4]) -> f32,
) -> Result<Vec<u8>, ImageSpaceError> {
    let len = checked_len(texels.len(), size_px)?;
    let mut ink = Vec::with_capacity(len);
    let offsets = taps.offsets();
    for y in 0..size_px.y {
        for x in 0..size_px.x {
            let reach = ink_reach(UVec2::new(x, y), size_px);
            let at = |offset: IVec2| {
                let pixel = IVec2::new(x as i32, y as i32) + offset * reach;
                texels[pixel.y as usize * size_px.x as usize + pixel.x as usize]
            };
            ink.push(ink_store(filter(at(IVec2::ZERO), offsets.map(at))));
        }
    }
    Ok(ink)
}

/// A value as an 8-bit unorm target stores it: clamped to 0..=1, rounded to the nearest of 256 steps; NaN becomes 0.
pub fn ink_store(value: f32) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}
