//! The reference picture of a shot, and where it is sensitive.

use super::{ROUNDED_PX, SHIFT_PX, magnitude};
use crate::camera::Camera;
use crate::compare::{Image, exempt_mask};
use crate::cpu::{self, CpuFrame, CpuOptions};
use crate::error::HarnessError;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::style::{Shade, Style};
use glam::DVec2;
use npr_outline::segment::MAX_SLOPE;

/// What is rendered, whatever renders it.
#[derive(Clone, Copy)]
pub struct Shot<'a> {
    /// What is shown.
    pub scene: &'a Scene,
    /// How.
    pub style: &'a Style,
    /// Made of these.
    pub plan: &'a Plan,
    /// From where.
    pub camera: &'a Camera,
    /// Px.
    pub size: (u32, u32),
}

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
        let plain = if shot.plan.hatch.is_some() { Some(Plain::new(&shot)?) } else { None };
        let mut reference = Self { shot, frame, plain, magnitude, image, exempt };
        reference.exempt_where_moved(SHIFT_PX, 8)?;
        if reference.plain.is_some() {
            for shift_px in around(ROUNDED_PX, 8) {
                let moved = shot.reference(&CpuOptions { shift_px, ..Default::default() });
                reference.exempt_where(&exempt_mask(&reference.image, &[moved.image()], magnitude)?);
            }
        }
        Ok(reference)
    }

    /// Moves samples by less than [`SHIFT_PX`] too, and in more directions, 64 renders: a sliver that is thinner than
    /// 1/100 px passes between the eight, and a rasteriser, whose corners lie on a grid of 1/256 px, hits it or not. One
    /// more render ends faces [`ROUNDED_PX`] before their boundaries: between two that touch and are not joined, no
    /// sample of the reference falls, wherever it is moved, and one of a device may. For lines in the image 17 more say
    /// what changes where a contour runs as close to a pixel's centre.
    ///
    /// # Errors
    /// None that can occur with pictures of one size.
    pub fn look_closer(&mut self) -> Result<(), HarnessError> {
        for share in [1.0, 0.5, 0.25, 0.125] {
            self.exempt_where_moved(share * SHIFT_PX, 16)?;
        }
        self.exempt_changes(&CpuOptions { boundary_inset_px: ROUNDED_PX, ..Default::default() })?;
        self.exempt_around_contours()
    }

    /// Where a contour passes within [`ROUNDED_PX`] of a pixel's centre a rasteriser may show the face that turns away
    /// there, whose normal no sample of the reference has. Lines in the image look at their neighbours: what changes
    /// if such a pixel differs from all around it is sensitive.
    fn exempt_around_contours(&mut self) -> Result<(), HarnessError> {
        let Shot { scene, style, plan, camera, size } = self.shot;
        if plan.image.is_none() {
            return Ok(());
        }
        let mut unsure = std::collections::BTreeSet::new();
        for direction in 0..16u8 {
            let shift_px = ROUNDED_PX * DVec2::from_angle(f64::from(direction) / 16.0 * std::f64::consts::TAU);
            let moved = self.shot.reference(&CpuOptions { shift_px, ..Default::default() });
            let other = |&pixel: &usize| self.shows_another_surface(&moved, pixel, ROUNDED_PX);
            unsure.extend((0..self.exempt.len()).filter(other));
        }
        let unsure: Vec<usize> = unsure.into_iter().collect();
        let blotted = cpu::render_unsure(scene, style, plan, camera, size, &CpuOptions::default(), &unsure, &|_| {});
        self.exempt_where(&exempt_mask(&self.image, &[blotted.image()], self.magnitude)?);
        Ok(())
    }

    /// Whether a pixel's depth changes by more than a slope explains when its sample is moved.
    fn shows_another_surface(&self, moved: &CpuFrame, pixel: usize, by_px: f64) -> bool {
        let (width, height) = self.shot.size;
        let view = self.shot.camera.line_view(DVec2::new(f64::from(width), f64::from(height)));
        let (here, moved) = (self.frame.depth[pixel], moved.depth[pixel]);
        let per_px = here.max(moved) * view.depth_per_px.x + view.depth_per_px.y;
        (here - moved).abs() > MAX_SLOPE * by_px * per_px
    }

    fn exempt_where_moved(&mut self, by_px: f64, directions: u32) -> Result<(), HarnessError> {
        for shift_px in around(by_px, directions) {
            self.exempt_changes(&CpuOptions { shift_px, ..Default::default() })?;
        }
        Ok(())
    }

    fn exempt_where(&mut self, changes: &[bool]) {
        for (exempt, changes) in self.exempt.iter_mut().zip(changes) {
            *exempt |= changes;
        }
    }

    /// Where the picture, or in plain light the same one, changes.
    fn exempt_changes(&mut self, options: &CpuOptions) -> Result<(), HarnessError> {
        let (moved, image) = match &self.plain {
            Some(plain) => (self.shot.in_light(plain).reference(options), &plain.image),
            None => (self.shot.reference(options), &self.image),
        };
        self.exempt_where(&exempt_mask(image, &[moved.image()], self.magnitude)?);
        if self.shot.plan.painted {
            // Another surface, even one that happens to have the same colour: a rasteriser may show a third one
            // there, turned away and hidden by exact arithmetic.
            for pixel in 0..self.exempt.len() {
                self.exempt[pixel] |= self.shows_another_surface(&moved, pixel, SHIFT_PX);
            }
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
        let style = Style { shade: Shade::Lambert { ambient: 0.2 }, ..shot.style.clone() };
        let plan = Plan::new(shot.scene, &style, shot.camera)?;
        let lit = Shot { style: &style, plan: &plan, ..*shot };
        let image = lit.reference(&CpuOptions::default()).image();
        Ok(Self { style, plan, image })
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
        cpu::render(self.scene, self.style, self.plan, self.camera, self.size, options, &|_| {})
    }
}
