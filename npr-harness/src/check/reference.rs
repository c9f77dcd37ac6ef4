//! The reference picture of a shot, and the pixels where it is sensitive to sampling.

use super::magnitude;
use crate::capabilities::Capabilities;
use crate::compare::exempt_mask;
use crate::cpu::{self, CpuFrame, CpuOptions, PrimaryHits};
use crate::error::HarnessError;
use crate::image_lines::cpu::{Perturbation, perturbed};
use crate::picture::Image;
use crate::plan::Plan;
use crate::shade::Shade;
use crate::shade::lambert::Lambert;
use crate::shadow::ShadowLines;
use crate::shadow::cpu::ShadowAt;
use crate::style::Style;
use crate::truth::{ROUNDED_PX, SHIFT_PX};
use crate::view::View;
use glam::DVec2;
use npr_imagespace::shadow::ShadowState;
use npr_outline::segment::MAX_SLOPE;

/// The inputs of a picture, independent of the executor.
#[derive(Clone, Copy)]
pub struct Shot<'a> {
    /// The scene, and its cached primary hits in the plan's view.
    pub hits: &'a PrimaryHits<'a>,
    /// The style.
    pub style: &'a Style,
    /// The plan for the scene and the style.
    pub plan: &'a Plan,
}

/// The number of sample offsets of a reference, for [`PrimaryHits::kept`], not counting [`Reference::look_closer`].
pub const PLACES: usize = 17;

/// The reference picture of a shot, and its sensitive pixels: those whose colour changes by more than the allowed
/// difference when the samples are shifted, or, if surfaces are painted, whose depth changes by more than a slope of
/// [`MAX_SLOPE`] explains.
///
/// Strokes are as narrow as pixels, so shifting the samples would change nearly every pixel of a hatched picture, and
/// nearly all would be exempt. Instead, the same picture with plain lighting determines the sensitive pixels; strokes
/// are shifted only by [`ROUNDED_PX`].
pub struct Reference<'a> {
    shot: Shot<'a>,
    frame: CpuFrame,
    /// For a hatched shot: the same with plain lighting.
    plain: Option<Plain>,
    magnitude: u8,
    /// The picture.
    pub image: Image,
    /// Per pixel: whether it is sensitive.
    pub exempt: Vec<bool>,
}

impl<'a> Reference<'a> {
    /// Renders the shot nine times: unshifted, and with samples shifted by [`SHIFT_PX`] in eight directions.
    ///
    /// # Errors
    /// None in practice: all pictures have the same size.
    pub fn new(shot: Shot<'a>) -> Result<Self, HarnessError> {
        let frame = shot.reference(&CpuOptions::default());
        let magnitude = magnitude(shot.plan);
        let image = frame.image();
        let exempt = vec![false; frame.depth.len()];
        let plain = if shot.plan.hatch().is_some() { Some(Plain::new(&shot)?) } else { None };
        let mut reference = Self { shot, frame, plain, magnitude, image, exempt };
        reference.exempt_where_moved(SHIFT_PX, 8)?;
        if reference.plain.is_some() {
            for shift_px in around(ROUNDED_PX, 8) {
                let moved = shot.reference(&CpuOptions { shift_px, ..Default::default() });
                join(&mut reference.exempt, &exempt_mask(&reference.image, &[moved.image()], magnitude)?);
            }
        }
        Ok(reference)
    }

    /// Renders 64 more pictures, with shifts below [`SHIFT_PX`] too and in more directions: a sliver thinner than 1/100
    /// px passes between the eight samples, but a rasteriser, which rounds corners to a grid of 1/256 px, may hit it.
    /// One more render ends faces [`ROUNDED_PX`] before their boundaries: no shifted sample falls between two adjacent
    /// faces that are not connected, but a sample on a GPU may. For shadows and image-space lines, 16 more renders find
    /// what changes where an edge passes as close to a pixel's centre.
    ///
    /// # Errors
    /// None in practice: all pictures have the same size.
    pub fn look_closer(&mut self) -> Result<(), HarnessError> {
        for share in [1.0, 0.5, 0.25, 0.125] {
            self.exempt_where_moved(share * SHIFT_PX, 16)?;
        }
        self.exempt_changes(&CpuOptions { boundary_inset_px: ROUNDED_PX, ..Default::default() })?;
        self.exempt_around_edges()
    }

    /// Where an edge passes within [`ROUNDED_PX`] of a pixel's centre, a GPU may show a surface or shadow state there
    /// that no sample of the reference has: at a contour, the back-facing face; where shadows change at a fold, light
    /// or shadow regardless of both sides, because the volume that starts at that edge has the depth of the surface
    /// itself. Such pixels are exempt if shadows change. Image-space lines depend on neighbours, so pixels that would
    /// change if any one such pixel changed are exempt too.
    fn exempt_around_edges(&mut self) -> Result<(), HarnessError> {
        let Shot { hits, plan, .. } = self.shot;
        if plan.image.is_none() && plan.shadow.is_none() {
            return Ok(());
        }
        // One sample per pixel, as for image-space lines.
        let one_sample = Plan { view: View { samples: 1, ..plan.view }, ..plan.clone() };
        let seen = |options: &CpuOptions| -> (Vec<f64>, Vec<ShadowAt>) {
            let seen = cpu::seen(hits, &one_sample, options);
            seen.iter().map(|seen| seen.map_or((0.0, ShadowAt::default()), |seen| (seen.depth, seen.shadow))).unzip()
        };
        let (depth, shadow) = seen(&CpuOptions::default());
        let mut unsure = vec![false; depth.len()];
        for shift_px in around(ROUNDED_PX, 16) {
            let (moved_depth, moved_shadow) = seen(&CpuOptions { shift_px, ..Default::default() });
            join(&mut unsure, &self.shows_another_surface(&depth, &moved_depth, ROUNDED_PX));
            let changes: Vec<bool> = shadow.iter().zip(&moved_shadow).map(|(here, moved)| here != moved).collect();
            join(&mut unsure, &changes);
            join(&mut self.exempt, &changes);
        }
        let Some(image) = &plan.image else { return Ok(()) };
        let states = [ShadowState::Lit, ShadowState::Cast, ShadowState::BackFacing].map(Perturbation::State);
        let of_shadows: &[Perturbation] = match image.ink.shadows {
            ShadowLines::None | ShadowLines::Negated => &[],
            ShadowLines::Lines | ShadowLines::Separate { .. } => &states,
        };
        let blank = cpu::without_ink(hits, plan, &CpuOptions::default(), &|_| {});
        // Perturbs one of nine pixels at a time, because the effects of adjacent perturbations can cancel.
        let (width, _) = plan.view.size;
        for group in 0..9 {
            let is_of_group = |&pixel: &usize| {
                let (x, y) = (pixel % width as usize, pixel / width as usize);
                unsure[pixel] && y % 3 * 3 + x % 3 == group
            };
            let pixels: Vec<usize> = (0..unsure.len()).filter(is_of_group).collect();
            for &perturbation in [Perturbation::Other].iter().chain(of_shadows) {
                let perturbed = perturbed(image, &blank, &pixels, perturbation).image();
                join(&mut self.exempt, &exempt_mask(&self.image, &[perturbed], self.magnitude)?);
            }
        }
        Ok(())
    }

    /// Per pixel: whether its depth changes by more than a slope explains when its sample is shifted.
    fn shows_another_surface(&self, here: &[f64], moved: &[f64], by_px: f64) -> Vec<bool> {
        let View { camera, size: (width, height), .. } = &self.shot.plan.view;
        let per_px = camera.line_view(DVec2::new(f64::from(*width), f64::from(*height))).depth_per_px;
        let is_other = |(here, moved): (&f64, &f64)| {
            let per_px = here.max(*moved) * per_px.x + per_px.y;
            (here - moved).abs() > MAX_SLOPE * by_px * per_px
        };
        here.iter().zip(moved).map(is_other).collect()
    }

    fn exempt_where_moved(&mut self, by_px: f64, directions: u32) -> Result<(), HarnessError> {
        for shift_px in around(by_px, directions) {
            self.exempt_changes(&CpuOptions { shift_px, ..Default::default() })?;
        }
        Ok(())
    }

    /// Exempts the pixels where the picture, or its version with plain lighting, changes.
    fn exempt_changes(&mut self, options: &CpuOptions) -> Result<(), HarnessError> {
        let (moved, image) = match &self.plain {
            Some(plain) => (self.shot.in_light(plain).reference(options), &plain.image),
            None => (self.shot.reference(options), &self.image),
        };
        let changes = exempt_mask(image, &[moved.image()], self.magnitude)?;
        join(&mut self.exempt, &changes);
        if self.shot.plan.paint.is_some() {
            // A different surface is exempt even if it has the same colour: a rasteriser may show a third surface
            // there, back-facing and hidden with exact arithmetic.
            let other = self.shows_another_surface(&self.frame.depth, &moved.depth, SHIFT_PX);
            join(&mut self.exempt, &other);
        }
        Ok(())
    }
}

/// A shot with Lambert shading instead of strokes.
struct Plain {
    style: Style,
    plan: Plan,
    image: Image,
}

impl Plain {
    fn new(shot: &Shot<'_>) -> Result<Self, HarnessError> {
        let style = Style { shade: Shade::Lambert(Lambert { ambient: 0.2 }), ..shot.style.clone() };
        let plan = Plan::new(shot.hits.scene, &style, &shot.plan.view, &Capabilities::RAY_CASTER)?;
        let lit = Shot { style: &style, plan: &plan, ..*shot };
        let image = lit.reference(&CpuOptions::default()).image();
        Ok(Self { style, plan, image })
    }
}

/// The union of two masks.
fn join(all: &mut [bool], more: &[bool]) {
    for (all, more) in all.iter_mut().zip(more) {
        *all |= more;
    }
}

/// Evenly spaced points on a circle, px.
fn around(radius_px: f64, directions: u32) -> impl Iterator<Item = DVec2> {
    let angle = move |number| f64::from(number) / f64::from(directions) * std::f64::consts::TAU;
    (0..directions).map(move |number| radius_px * DVec2::from_angle(angle(number)))
}

impl<'a> Shot<'a> {
    fn in_light(&self, plain: &'a Plain) -> Self {
        Self { style: &plain.style, plan: &plain.plan, ..*self }
    }
}

impl Shot<'_> {
    fn reference(&self, options: &CpuOptions) -> CpuFrame {
        cpu::render_kept(self.hits, self.plan, options, &|_| {})
    }
}
