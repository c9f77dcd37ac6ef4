//! Bilinear resampling of ink to the size of a picture: "line width from the size of the render texture" ("The
//! Evolution of a Cartoon Renderer"). A line is one or two pixels wide in the texture that it is found in. Scaled to
//! the picture it is wider by the ratio of the sizes where the texture is smaller, and paler where it is larger.
//!
//! The ink is stretched to cover the picture, whatever the two sizes, and interpolated bilinearly at the centre of each
//! pixel; texels beyond the border are those at it. At half the picture's size that is the usual tent of weights ¾ and
//! ¼, at the same size the texel itself, at twice the size the mean of a pixel's 2 × 2 texels. Above twice the size
//! some texels are not sampled, and thin lines break.

use crate::ImageSpaceError;
use crate::composite::{Composite, composite_picture};
use crate::picture::{checked_len, ink_store};
use glam::{IVec2, UVec2, Vec2};

/// WGSL of this module: no bindings, no entry points.
pub const RESAMPLE_WGSL: &str = include_str!("resample.wgsl");

/// The 2 × 2 texels that a pixel's ink is interpolated from: the upper left one, which may lie outside by 1, and the
/// weights of the right and the lower ones, 0..1. `scale` is texels of ink a pixel.
fn ink_resample_at(pixel: Vec2, scale: Vec2) -> (Vec2, Vec2) {
    let at = (pixel + 0.5) * scale - 0.5;
    let first = at.floor();
    (first, at - first)
}

/// Ink of a pixel from its 2 × 2 texels: upper left, upper right, lower left, lower right.
fn ink_resample_mix(taps: [f32; 4], weight: Vec2) -> f32 {
    let row = |left: f32, right: f32| left * (1.0 - weight.x) + right * weight.x;
    row(taps[0], taps[1]) * (1.0 - weight.y) + row(taps[2], taps[3]) * weight.y
}

/// Ink resampled to a picture's size. Ink of no texels is paper everywhere.
///
/// # Errors
/// [`ImageSpaceError::Length`] if `ink` does not have one element for each of its pixels.
pub fn resample(ink: &[u8], ink_size_px: UVec2, size_px: UVec2) -> Result<Vec<u8>, ImageSpaceError> {
    checked_len(ink.len(), ink_size_px)?;
    let count = size_px.x as usize * size_px.y as usize;
    if ink.is_empty() || count == 0 {
        return Ok(vec![0; count]);
    }
    let scale = ink_size_px.as_vec2() / size_px.as_vec2();
    let most = ink_size_px.as_ivec2() - 1;
    let mut out = Vec::with_capacity(count);
    for y in 0..size_px.y {
        for x in 0..size_px.x {
            let (first, weight) = ink_resample_at(UVec2::new(x, y).as_vec2(), scale);
            let taps = [IVec2::ZERO, IVec2::X, IVec2::Y, IVec2::ONE].map(|offset| {
                let at = (first.as_ivec2() + offset).clamp(IVec2::ZERO, most);
                f32::from(ink[at.y as usize * ink_size_px.x as usize + at.x as usize]) / 255.0
            });
            out.push(ink_store(ink_resample_mix(taps, weight)));
        }
    }
    Ok(out)
}

/// Composites ink of another size over a picture of 8-bit RGBA. Alpha does not change.
///
/// # Errors
/// If either does not have one element for each of its pixels.
pub fn composite_resampled(
    pixels: &mut [[u8; 4]],
    size_px: UVec2,
    ink: &[u8],
    ink_size_px: UVec2,
    how: &Composite,
) -> Result<(), ImageSpaceError> {
    checked_len(pixels.len(), size_px)?;
    composite_picture(pixels, &resample(ink, ink_size_px, size_px)?, how)
}
