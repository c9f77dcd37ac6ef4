//! Compositing ink over a picture.
//!
//! - [`Composite::Multiply`]: Card & Mitchell 2002 multiply the frame buffer with the edge image, white paper and black
//!   lines, so that several passes add up: c · (1 − ink).
//! - [`Composite::AlphaTested`]: the same with an alpha test that discards the white pixels of the edge image, whose
//!   alpha is 255 on paper and 0 on a line. Error in print: `D3DCMP_GREATER` keeps
//!   alpha above the reference, which is the paper, and discards the lines; and the reference `(DWORD) 0.5f` is 0, of
//!   0–255 ([`AlphaTest::PRINTED`]): the picture does not change, at the cost of writing all of it. Corrected: LESS and
//!   128 ([`AlphaTest::CORRECTED`]).
//! - [`Composite::Over`]: a line of any colour, by its coverage: c + opacity · ink · (line − c). The default. With a
//!   black opaque line it is the multiplication.
//!
//! Colours are display-referred, and coverage blends in display space.

use crate::ImageSpaceError;
use crate::picture::ink_store;
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, DVec4, Vec3};

/// WGSL of this module: no bindings, no entry points.
pub const COMPOSITE_WGSL: &str = include_str!("composite.wgsl");

/// How ink is composited over a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Composite {
    /// c · (1 − ink).
    Multiply,
    /// [`Composite::Multiply`] where a test is passed.
    AlphaTested(AlphaTest),
    /// A line of any colour: c + opacity · ink · (color − c).
    Over {
        /// Display-referred RGB.
        color: Vec3,
        /// 0..=1.
        opacity: f32,
    },
}

impl Default for Composite {
    fn default() -> Self {
        Self::Over { color: Vec3::ZERO, opacity: 1.0 }
    }
}

/// An alpha test on the edge image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct AlphaTest {
    /// Whether alpha below the reference passes; otherwise alpha above it.
    pub less: bool,
    /// The reference, 0–255.
    pub reference: u8,
}

impl AlphaTest {
    /// GREATER and `(DWORD) 0.5f`.
    pub const PRINTED: Self = Self { less: false, reference: 0 };
    /// LESS and 128.
    pub const CORRECTED: Self = Self { less: true, reference: 128 };
}

/// c · (1 − ink).
fn ink_multiply(color: DVec3, ink: f64) -> DVec3 {
    color * (1.0 - ink)
}

/// Whether a pixel of the edge image passes the test; its alpha is 1 − `ink` in 8 bits.
pub fn ink_alpha_passes(ink: f64, test: AlphaTest) -> bool {
    let alpha = 255 - ink_store(ink as f32);
    if test.less { alpha < test.reference } else { alpha > test.reference }
}

/// c · (1 − ink) where the test is passed, and else the colour as it was.
fn ink_alpha_tested(color: DVec3, ink: f64, test: AlphaTest) -> DVec3 {
    if ink_alpha_passes(ink, test) { ink_multiply(color, ink) } else { color }
}

/// c + opacity · ink · (line − c).
fn ink_over(color: DVec3, ink: f64, line: DVec3, opacity: f64) -> DVec3 {
    color + (line - color) * (opacity * ink)
}

/// The display-referred colour of a pixel after compositing `ink`, 0..=1, over `color`.
pub fn ink_composite(color: DVec3, ink: f64, how: &Composite) -> DVec3 {
    match *how {
        Composite::Multiply => ink_multiply(color, ink),
        Composite::AlphaTested(test) => ink_alpha_tested(color, ink, test),
        Composite::Over { color: line, opacity } => ink_over(color, ink, line.as_dvec3(), f64::from(opacity)),
    }
}

/// The premultiplied colour with which a blend unit has the result of [`ink_composite`]: the line's colour times its
/// opacity, and the opacity a. The picture becomes rgb + (1 − a) · c.
pub fn ink_premultiplied(ink: f64, how: &Composite) -> DVec4 {
    match *how {
        Composite::Multiply => DVec3::ZERO.extend(ink),
        Composite::AlphaTested(test) => DVec3::ZERO.extend(if ink_alpha_passes(ink, test) { ink } else { 0.0 }),
        Composite::Over { color, opacity } => color.as_dvec3().extend(1.0) * (f64::from(opacity) * ink),
    }
}

/// Composites 8-bit ink, one value for each pixel, over a picture of 8-bit RGBA. Alpha does not change.
///
/// # Errors
/// [`ImageSpaceError::Pixels`].
pub fn composite_picture(pixels: &mut [[u8; 4]], ink: &[u8], how: &Composite) -> Result<(), ImageSpaceError> {
    if pixels.len() != ink.len() {
        return Err(ImageSpaceError::Pixels { pixels: pixels.len(), ink: ink.len() });
    }
    for (pixel, &ink) in pixels.iter_mut().zip(ink) {
        // Nothing changes on paper, whatever the form.
        if ink == 0 {
            continue;
        }
        let color = DVec3::new(f64::from(pixel[0]), f64::from(pixel[1]), f64::from(pixel[2])) / 255.0;
        let mixed = ink_composite(color, f64::from(ink) / 255.0, how);
        pixel[..3].copy_from_slice(&mixed.to_array().map(|c| ink_store(c as f32)));
    }
    Ok(())
}

/// A [`Composite`] as `InkComposite` of the WGSL, 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct CompositeUniform {
    /// The line's display-referred colour, and its opacity, 0..=1.
    pub line: [f32; 4],
    /// 0 multiply, 1 alpha-tested, 2 over.
    pub form: u32,
    /// 1: LESS.
    pub alpha_less: u32,
    /// 0–255.
    pub alpha_reference: u32,
    /// Unused, 0.
    pub padding: u32,
}

impl From<&Composite> for CompositeUniform {
    fn from(how: &Composite) -> Self {
        match *how {
            Composite::Multiply => Self::zeroed(),
            Composite::AlphaTested(test) => Self {
                form: 1,
                alpha_less: u32::from(test.less),
                alpha_reference: u32::from(test.reference),
                ..Self::zeroed()
            },
            Composite::Over { color, opacity } => {
                Self { line: color.extend(opacity).to_array(), form: 2, ..Self::zeroed() }
            }
        }
    }
}
