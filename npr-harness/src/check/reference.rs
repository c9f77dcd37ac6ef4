//! The reference picture of a shot, and where it is sensitive.

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

/// What is rendered, whatever renders it.
#[derive(Clone, Copy)]
pub struct Shot<'a> {
    /// The scene, and what is known of its primary hits in the plan's view.
    pub hits: &'a PrimaryHits<'a>,
    /// How it looks.
    pub style: &'a Style,
    /// Made of these.
    pub plan: &'a Plan,
}

/// In how many places a reference's samples lie, for [`PrimaryHits::kept`], but for a closer look.
pub const PLACES: usize = 17;

/// The reference picture of a shot, and the pixels in which it is sensitive to where its samples are: those in which its
/// colour changes by more than the allowed difference, or, where surfaces are painted, its depth by more than a slope
/// of [`MAX_SLOPE`] explains.
///
/// Strokes are as narrow as pixels, so a hatched picture changes nearly everywhere when its samples are moved, and
/// would nearly all be exempt. There the same picture in plain light says what is sensitive; strokes are moved by
/// [`ROUNDED_PX`] alone.
pub struct Reference<'a> {
    shot: Shot<'a>,
    frame: CpuFrame,
    /// Of a hatched shot: the same in plain light.
    plain: Option<Plain>,
    magnitude: u8,
    /// The picture.
    pub image: Image,
    /// Per pixel whether it is sensitive.
    pub exempt: Vec<bool>,
}

impl<'a> Reference<'a> {
    /// Renders it nine times: as it is, and with samples moved by [`SHIFT_PX`] in eight directions.
    ///
    /// # Errors
    /// None that can occur with pictures of one size.
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

    /// Moves samples by less than [`SHIFT_PX`] too, and in more directions, 64 renders: a sliver that is thinner than
    /// 1/100 px passes between the eight, and a rasteriser, whose corners lie on a grid of 1/256 px, hits it or not. One
    /// more render ends faces [`ROUNDED_PX`] before their boundaries: between two that touch and are not joined, no
    /// sample of the reference falls, wherever it is moved, and one of a device may. For shadows and for lines in the
    /// image 16 more say what changes where an edge runs as close to a pixel's centre.
    ///
    /// # Errors
    /// None that can occur with pictures of one size.
    pub fn look_closer(&mut self) -> Result<(), HarnessError> {
        for share in [1.0, 0.5, 0.25, 0.125] {
            self.exempt_where_moved(share * SHIFT_PX, 16)?;
        }
        self.exempt_changes(&CpuOptions { boundary_inset_px: ROUNDED_PX, ..Default::default() })?;
        self.exempt_around_edges()
    }

    /// Where an edge passes within [`ROUNDED_PX`] of a pixel's centre a device may show there what no sample of the
    /// reference does: at a contour the face that turns away, and where shadows change at a fold light or shadow, whatever
    /// is on both sides of it, since the volume that begins at that edge is as deep as the surface itself. Such a pixel is
    /// exempt where shadows change. Lines in the image look at their neighbours: what would change if any one such pixel
    /// showed something else is exempt too.
    fn exempt_around_edges(&mut self) -> Result<(), HarnessError> {
        let Shot { hits, plan, .. } = self.shot;
        if plan.image.is_none() && plan.shadow.is_none() {
            return Ok(());
        }
        // One sample a pixel, as lines in the image have.
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
        // One of nine at a time: beside another one that differs too, one may differ from nothing.
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

    /// Per pixel whether its depth changes by more than a slope explains when its sample is moved.
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

    /// Where the picture, or in plain light the same one, changes.
    fn exempt_changes(&mut self, options: &CpuOptions) -> Result<(), HarnessError> {
        let (moved, image) = match &self.plain {
            Some(plain) => (self.shot.in_light(plain).reference(options), &plain.image),
            None => (self.shot.reference(options), &self.image),
        };
        let changes = exempt_mask(image, &[moved.image()], self.magnitude)?;
        join(&mut self.exempt, &changes);
        if self.shot.plan.paint.is_some() {
            // Another surface, even one that happens to have the same colour: a rasteriser may show a third one
            // there, turned away and hidden by exact arithmetic.
            let other = self.shows_another_surface(&self.frame.depth, &moved.depth, SHIFT_PX);
            join(&mut self.exempt, &other);
        }
        Ok(())
    }
}

/// A shot with Lambert's light instead of strokes.
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

/// What is in either.
fn join(all: &mut [bool], more: &[bool]) {
    for (all, more) in all.iter_mut().zip(more) {
        *all |= more;
    }
}

/// Places on a circle, px.
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
