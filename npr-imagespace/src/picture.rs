//! Pictures as slices of rows from the top, their borders, and the neighbours that a filter reads.
//!
//! # Borders
//!
//! Where a horizontal step to either side would leave the picture, the horizontal part of a filter's steps is 0, and the
//! vertical part likewise: with steps of 1 px in the first and the last column and row. All taps then lie in the picture and opposite taps stay opposite, so that second differences over
//! them are valid. A picture of one pixel has no line, one of 1 × n px is filtered along its length, and a border
//! between the outermost two columns is drawn on the inner one. The papers do not say what lies outside.

use crate::ImageSpaceError;
use glam::{IVec2, IVec4, UVec2};

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
    /// Taps 0 and 1 at these steps, px, x to the right and y down, and taps 2 and 3 opposite them: the offsets that "The
    /// Evolution of a Cartoon Renderer" adds to the texture coordinates in listing 3. Each component is within
    /// ±[`STEP_MAX_PX`], and neither step is 0. Lines become as wide as the steps are long.
    Steps([IVec2; 2]),
}

/// The longest step of a tap along x or y, px.
pub const STEP_MAX_PX: i32 = 64;

impl Taps {
    /// The four steps in px, x to the right and y down.
    pub fn offsets(self) -> [IVec2; 4] {
        [0, 1, 2, 3].map(|tap| ink_tap(tap, self.steps(), IVec2::ONE))
    }

    /// The steps to taps 0 (x, y) and 1 (z, w) in px, as [`ink_tap`] takes them.
    pub fn steps(self) -> IVec4 {
        match self {
            Self::Diagonal => IVec4::new(1, 1, -1, 1),
            Self::Cross => IVec4::new(1, 0, 0, 1),
            Self::Steps([step0, step1]) => IVec4::new(step0.x, step0.y, step1.x, step1.y),
        }
    }

    /// The longest step along x and along y, px, for [`ink_reach`].
    pub fn longest_px(self) -> UVec2 {
        let [step0, step1] = [self.steps().truncate().truncate(), IVec2::new(self.steps().z, self.steps().w)];
        step0.abs().max(step1.abs()).as_uvec2()
    }

    /// Checks free steps.
    ///
    /// # Errors
    /// [`ImageSpaceError::TapStep`].
    pub fn validate(self) -> Result<(), ImageSpaceError> {
        let Self::Steps(steps) = self else { return Ok(()) };
        match steps.into_iter().find(|step| *step == IVec2::ZERO || step.abs().max_element() > STEP_MAX_PX) {
            Some(step_px) => Err(ImageSpaceError::TapStep { step_px }),
            None => Ok(()),
        }
    }

    /// The ink, as a share of a full line, of one tap across a border where lines are soft: a straight border has two
    /// taps across it where both steps have a part across, and else one.
    pub fn weight(self) -> f32 {
        if self.steps().to_array().contains(&0) { 1.0 } else { 0.5 }
    }
}

/// Whether a filter at a pixel steps along x and y: 1, or 0 where a step of `longest_px` to either side would leave the
/// picture.
pub fn ink_reach(pixel: UVec2, size_px: UVec2, longest_px: UVec2) -> IVec2 {
    let along = |at: u32, size: u32, step: u32| i32::from(at >= step && at + step < size);
    IVec2::new(along(pixel.x, size_px.x, longest_px.x), along(pixel.y, size_px.y, longest_px.y))
}

/// The step in px to tap 0–3. `steps` is that of [`Taps::steps`], `reach` that of [`ink_reach`].
pub fn ink_tap(tap: u32, steps: IVec4, reach: IVec2) -> IVec2 {
    let step = if tap & 1 == 0 { IVec2::new(steps.x, steps.y) } else { IVec2::new(steps.z, steps.w) };
    reach * if tap < 2 { step } else { -step }
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
/// If `texels` does not have one element for each pixel; [`ImageSpaceError::TapStep`].
pub fn filter_picture<T: Copy>(
    texels: &[T],
    size_px: UVec2,
    taps: Taps,
    filter: impl Fn(T, [T; 4]) -> f32,
) -> Result<Vec<u8>, ImageSpaceError> {
    let len = checked_len(texels.len(), size_px)?;
    let mut ink = Vec::with_capacity(len);
    taps.validate()?;
    let (offsets, longest_px) = (taps.offsets(), taps.longest_px());
    for y in 0..size_px.y {
        for x in 0..size_px.x {
            let reach = ink_reach(UVec2::new(x, y), size_px, longest_px);
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
