//! The disc in passes for a GPU, by jump flooding: in each pass every pixel takes the nearest of the line pixels that
//! it and some texels at the pass's distance know of.
//!
//! A texel of `R32Uint` holds the step from the pixel to the nearest line pixel known so far, 0 for none
//! ([`ink_flood_seed`]). A pass reads some texels at a distance, adds the way there, and keeps the shortest
//! ([`ink_flood_take`]); the last turns the distance into ink. All but that is done on
//! integers.
//!
//! Jump flooding in the plane (Rong & Tan 2006, "Jump flooding in GPU with applications to Voronoi diagram and
//! distance transform") reads eight neighbours a pass ([`FloodPlan::square`]). Here the axes are done one after the
//! other ([`FloodPlan::separable`]): along a row the nearest line pixel is found exactly, whatever the steps, since
//! every pixel on the way to it has the same nearest one; along columns sites at different
//! row distances compete, and a pixel on the way can discard the site that is nearest to a later pixel. Both variants
//! may therefore find a distance that is too large, never one that is too small. [`flood`] runs the same passes on the
//! CPU.

use crate::ImageSpaceError;
use crate::morphology::disc::{Disc, LINE, RADIUS_MAX_PX};
use crate::picture::{checked_len, ink_store};
use glam::{IVec2, UVec2};

/// A pixel that knows no line pixel.
pub const FLOOD_NONE: u32 = 0;

/// One pass, which reads besides the pixel itself the texels at ± `step`, ± 2 `step` … ± `fan` · `step` along x, y or
/// both.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FloodPass {
    /// The distance between the texels, px.
    pub step: u32,
    /// The number of texels to each side.
    pub fan: u32,
    /// Whether texels to the left and right are read.
    pub along_x: bool,
    /// Whether texels above and below are read; together with `along_x` also those on diagonals.
    pub along_y: bool,
}

/// The passes for a radius, in their order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FloodPlan {
    /// The passes, in order.
    pub passes: Vec<FloodPass>,
}

/// Steps such that sums of up to `fan` of each reach every whole number to `reach`, largest first.
fn steps(reach: u32, fan: u32) -> Vec<u32> {
    let mut steps = vec![1];
    let mut covered = fan;
    while covered < reach {
        let step = covered + 1;
        steps.push(step);
        covered += fan * step;
    }
    steps.reverse();
    steps
}

impl FloodPlan {
    /// Passes along x, then along y, that read `fan` texels to each side: fewer passes with more taps the larger it is.
    pub fn separable(disc: &Disc, fan: u32) -> Self {
        let steps = steps(reach_px(disc), fan.max(1));
        let pass = |along_x: bool| move |&step: &u32| FloodPass { step, fan: fan.max(1), along_x, along_y: !along_x };
        Self { passes: steps.iter().map(pass(true)).chain(steps.iter().map(pass(false))).collect() }
    }

    /// [`FloodPlan::separable`], with no more taps than are needed: the farthest pass of each axis has as many as reach
    /// the disc's border, up to twice `fan` before there is another pass.
    pub fn fitted(disc: &Disc, fan: u32) -> Self {
        let (reach, fan) = (reach_px(disc), fan.max(1));
        let mut steps = Vec::new();
        let mut covered = 0;
        loop {
            let step = covered + 1;
            let needed = (reach - covered).div_ceil(step);
            if needed <= 2 * fan {
                steps.push((step, needed));
                break;
            }
            steps.push((step, fan));
            covered += fan * step;
        }
        let pass = |along_x: bool| move |&(step, fan): &(u32, u32)| FloodPass { step, fan, along_x, along_y: !along_x };
        Self { passes: [true, false].into_iter().flat_map(|x| steps.iter().rev().map(pass(x))).collect() }
    }

    /// How far the passes along x together read.
    pub fn row_reach_px(&self) -> u32 {
        self.passes.iter().filter(|pass| pass.along_x).map(|pass| pass.step * pass.fan).sum()
    }

    /// Jump flooding in the plane, with a last pass by 1 px more.
    pub fn square(disc: &Disc) -> Self {
        let steps = steps(reach_px(disc), 1).into_iter().chain([1]);
        Self { passes: steps.map(|step| FloodPass { step, fan: 1, along_x: true, along_y: true }).collect() }
    }
}

/// Taps to each side in [`disc_plan`]: 2 to 4 took the same time, 1 and 6 were slower.
const FAN: u32 = 3;

/// The passes for a disc, the same on a device and in [`flood`].
pub fn disc_plan(disc: &Disc) -> FloodPlan {
    FloodPlan::fitted(disc, FAN)
}

/// The largest distance along one axis, px, at which a line pixel changes a pixel's ink.
fn reach_px(disc: &Disc) -> u32 {
    let beyond = if disc.antialias { (disc.radius_px + 1.0).ceil() - 1.0 } else { disc.radius_px.floor() };
    (beyond as u32).max(1)
}

/// The texel of a pixel before the first pass.
pub fn ink_flood_seed(is_line: bool) -> u32 {
    if is_line { 0x8000_8000 } else { FLOOD_NONE }
}

/// The step in px from a pixel to the line pixel stored in its texel.
pub fn ink_flood_vector(site: u32) -> IVec2 {
    IVec2::new((site & 0xffff) as i32 - 0x8000, (site >> 16) as i32 - 0x8000)
}

/// The squared distance of the line pixel stored in a texel, px²; `u32::MAX` for none.
fn ink_flood_distance2(site: u32) -> u32 {
    if site == FLOOD_NONE {
        return u32::MAX;
    }
    ink_flood_vector(site).length_squared() as u32
}

/// The nearer of the line pixel of a texel, `best`, and that of the texel `offset` px away, `tap`.
pub fn ink_flood_take(best: u32, tap: u32, offset: IVec2) -> u32 {
    if tap == FLOOD_NONE {
        return best;
    }
    let vector = ink_flood_vector(tap) + offset;
    // Steps of more than 15 bits do not fit a texel.
    if vector.abs().max_element() > 0x7fff {
        return best;
    }
    if vector.length_squared() as u32 >= ink_flood_distance2(best) {
        return best;
    }
    (vector.x + 0x8000) as u32 | ((vector.y + 0x8000) as u32) << 16
}

/// Ink 0..=1 of a pixel that knows its nearest line pixel, as [`crate::morphology::disc`] defines it.
fn ink_flood_resolve(site: u32, radius_px: f32, antialias: bool) -> f32 {
    if site == FLOOD_NONE {
        return 0.0;
    }
    let square = ink_flood_distance2(site);
    if antialias {
        return (radius_px + 1.0 - (square as f32).sqrt()).clamp(0.0, 1.0);
    }
    if square <= (radius_px * radius_px).floor() as u32 { 1.0 } else { 0.0 }
}

/// One pass over a picture.
fn run_pass(from: &[u32], size: IVec2, pass: &FloodPass, to: &mut Vec<u32>) {
    to.clear();
    let (fan_x, fan_y) =
        (if pass.along_x { pass.fan as i32 } else { 0 }, if pass.along_y { pass.fan as i32 } else { 0 });
    for y in 0..size.y {
        for x in 0..size.x {
            let mut best = from[(y * size.x + x) as usize];
            for j in -fan_y..=fan_y {
                for i in -fan_x..=fan_x {
                    let offset = IVec2::new(i, j) * pass.step as i32;
                    let at = IVec2::new(x, y) + offset;
                    if at.cmpge(IVec2::ZERO).all() && at.cmplt(size).all() {
                        best = ink_flood_take(best, from[(at.y * size.x + at.x) as usize], offset);
                    }
                }
            }
            to.push(best);
        }
    }
}

/// The passes of a plan on the CPU, pixel by pixel as a GPU runs them: slow, and the reference for it.
///
/// # Errors
/// If `ink` does not have one element for each pixel, or the radius is out of range.
pub fn flood(ink: &[u8], size_px: UVec2, disc: &Disc, plan: &FloodPlan) -> Result<Vec<u8>, ImageSpaceError> {
    checked_len(ink.len(), size_px)?;
    if !(0.0..=RADIUS_MAX_PX).contains(&disc.radius_px) {
        return Err(ImageSpaceError::Radius { radius_px: disc.radius_px });
    }
    let mut from: Vec<u32> = ink.iter().map(|&ink| ink_flood_seed(ink >= LINE)).collect();
    let mut to = Vec::with_capacity(from.len());
    for pass in &plan.passes {
        run_pass(&from, size_px.as_ivec2(), pass, &mut to);
        std::mem::swap(&mut from, &mut to);
    }
    Ok(from.into_iter().map(|site| ink_store(ink_flood_resolve(site, disc.radius_px, disc.antialias))).collect())
}
