//! Morphology: dilation and erosion of ink.
//!
//! Ink is 0 on paper and 255, or 1.0, on a line. In the papers lines are black on white: their dilation is a minimum,
//! here it is a maximum.
//!
//! - this module: steps by one pixel with four, five or nine taps, hard and soft, and n of them by ping-pong;
//! - [`disc`]: a Euclidean disc of any radius, exact, at a cost that does not grow with the radius;
//! - [`flood`]: the same in passes for a GPU, on sites packed into 32 bits.
//!
//! Outside the picture there is paper for a dilation and ink for an erosion, so that the picture's border neither adds
//! nor removes ink.
//!
//! # Sources
//!
//! - [`Kernel::Diagonal`]: "The Evolution of a Cartoon Renderer", listing 5: ink if any of the four diagonal
//!   neighbours is. The pixel itself is not read: an isolated line pixel becomes four with a hole between them, and n
//!   steps make a chequered square.
//! - [`Kernel::Cross`]: the slides of SIGGRAPH 2002 read a + of five.
//! - [`ink_dilate_soft_cross`]: the slides' shader, in their polarity saturate(0.4 Σ − 1), which in ink is min(0.4 Σ,
//!   1): one line pixel of five gives 0.4, two 0.8 and three 1.
//! - [`ink_dilate_soft_diagonal`]: listing 5's second program as its text has it: the four samples, times a threshold
//!   from 0.25 (softest) to 1 (hard), clamped. Error in print: the program reads two of the four and does
//!   not clamp ([`ink_dilate_soft_diagonal_printed`]).

mod direct;
pub mod disc;
pub mod flood;
mod ink;

use crate::ImageSpaceError;
use crate::picture::checked_len;
use glam::UVec2;

/// WGSL of this module and of [`flood`]: no bindings, no entry points.
pub const MORPHOLOGY_WGSL: &str = concat!(include_str!("morphology.wgsl"), include_str!("morphology/flood.wgsl"));

/// Which pixels a step reads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Kernel {
    /// The four diagonal ones, and not the pixel.
    Diagonal,
    /// The pixel and its four neighbours along the axes.
    #[default]
    Cross,
    /// The pixel and its eight neighbours.
    Square,
}

/// Ink of four taps: the largest.
pub fn ink_dilate4(taps: [f64; 4]) -> f64 {
    taps.into_iter().fold(0.0, f64::max)
}

/// Ink of four taps: the smallest.
pub fn ink_erode4(taps: [f64; 4]) -> f64 {
    taps.into_iter().fold(1.0, f64::min)
}

/// The slides' soft dilation of a pixel and its four neighbours: min(0.4 Σ, 1).
pub fn ink_dilate_soft_cross(centre: f64, taps: [f64; 4]) -> f64 {
    (0.4 * (centre + taps.iter().sum::<f64>())).min(1.0)
}

/// The smoothed dilation of the four diagonal taps as listing 5's text has it: min(threshold · Σ, 1).
pub fn ink_dilate_soft_diagonal(taps: [f64; 4], threshold: f64) -> f64 {
    (threshold * taps.iter().sum::<f64>()).min(1.0)
}

/// The smoothed dilation as listing 5 computes it: the first two taps, clamped only by the render target.
pub fn ink_dilate_soft_diagonal_printed(taps: [f64; 4], threshold: f64) -> f64 {
    threshold * taps[0] + threshold * taps[1]
}

/// One step of dilation: `out` becomes the largest ink of the kernel's pixels.
///
/// # Errors
/// If `ink` does not have one element for each pixel.
pub fn dilate(ink: &[u8], size_px: UVec2, kernel: Kernel, out: &mut Vec<u8>) -> Result<(), ImageSpaceError> {
    step(ink, size_px, kernel, 0, u8::max, out)
}

/// One step of erosion: `out` becomes the smallest ink of the kernel's pixels.
///
/// # Errors
/// If `ink` does not have one element for each pixel.
pub fn erode(ink: &[u8], size_px: UVec2, kernel: Kernel, out: &mut Vec<u8>) -> Result<(), ImageSpaceError> {
    step(ink, size_px, kernel, 255, u8::min, out)
}

/// A morphological operation of n steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// n dilations.
    Dilate,
    /// n erosions.
    Erode,
    /// n erosions, then n dilations: lines thinner than n kernels vanish.
    Open,
    /// n dilations, then n erosions: gaps narrower than n kernels close.
    Close,
}

impl Operation {
    /// Its one or two halves, in order: whether each erodes.
    pub(crate) fn halves(self) -> impl Iterator<Item = bool> {
        let (first, second) = match self {
            Self::Dilate => (false, None),
            Self::Erode => (true, None),
            Self::Open => (true, Some(false)),
            Self::Close => (false, Some(true)),
        };
        std::iter::once(first).chain(second)
    }
}

/// `steps` steps of each half of an operation, alternating between two pictures, as a GPU does with two targets.
///
/// # Errors
/// If `ink` does not have one element for each pixel.
pub fn ping_pong(
    ink: &[u8],
    size_px: UVec2,
    kernel: Kernel,
    operation: Operation,
    steps: u32,
) -> Result<Vec<u8>, ImageSpaceError> {
    checked_len(ink.len(), size_px)?;
    let (mut from, mut to) = (ink.to_vec(), Vec::new());
    for eroding in operation.halves() {
        for _ in 0..steps {
            if eroding {
                erode(&from, size_px, kernel, &mut to)?;
            } else {
                dilate(&from, size_px, kernel, &mut to)?;
            }
            std::mem::swap(&mut from, &mut to);
        }
    }
    Ok(from)
}

/// The row with the given index, or `none` outside the picture.
fn neighbour<'a>(ink: &'a [u8], width: usize, row: Option<usize>, none: &'a [u8]) -> &'a [u8] {
    row.and_then(|y| ink.get(y * width..(y + 1) * width)).unwrap_or(none)
}

fn step(
    ink: &[u8],
    size_px: UVec2,
    kernel: Kernel,
    identity: u8,
    pick: impl Fn(u8, u8) -> u8,
    out: &mut Vec<u8>,
) -> Result<(), ImageSpaceError> {
    let len = checked_len(ink.len(), size_px)?;
    out.resize(len, 0);
    let width = size_px.x as usize;
    if len == 0 {
        return Ok(());
    }
    let none = vec![identity; width];
    // The largest or smallest of each column's pixels, with one neutral value at each end.
    let mut column = vec![identity; width + 2];
    for (y, (own, to)) in ink.chunks_exact(width).zip(out.chunks_exact_mut(width)).enumerate() {
        let above = neighbour(ink, width, y.checked_sub(1), &none);
        let below = neighbour(ink, width, Some(y + 1), &none);
        let vertical = above.iter().zip(below).map(|(&a, &b)| pick(a, b));
        match kernel {
            Kernel::Diagonal => column[1..=width].iter_mut().zip(vertical).for_each(|(c, v)| *c = v),
            Kernel::Square => {
                column[1..=width].iter_mut().zip(vertical.zip(own)).for_each(|(c, (v, &o))| *c = pick(v, o));
            }
            Kernel::Cross => {
                to.iter_mut().zip(vertical.zip(own)).for_each(|(t, (v, &o))| *t = pick(v, o));
                column[1..=width].copy_from_slice(own);
            }
        }
        let beside = column[..width].iter().zip(&column[2..]).map(|(&a, &b)| pick(a, b));
        match kernel {
            Kernel::Diagonal => to.iter_mut().zip(beside).for_each(|(t, s)| *t = s),
            Kernel::Square => {
                to.iter_mut().zip(beside.zip(&column[1..])).for_each(|(t, (s, &c))| *t = pick(s, c));
            }
            Kernel::Cross => to.iter_mut().zip(beside).for_each(|(t, s)| *t = pick(*t, s)),
        }
    }
    Ok(())
}
