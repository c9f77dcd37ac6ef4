//! Image-space lines on the GPU: filter, dilation and composite.

use super::gbuffer::gpu::GBufferPasses;
use super::gbuffer::style::Show;
use super::plan::{ImageLines, ImagePlan};
use crate::camera::Camera;
use crate::error::HarnessError;
use crate::gpu::targets::{COLOR_FORMAT, InkTargets};
use glam::Vec3;
use npr_imagespace::format::texel::TexelLayout;
use npr_imagespace::morphology::Operation;
use npr_imagespace::pass::composite::CompositePass;
use npr_imagespace::pass::disc::DiscPass;
use npr_imagespace::pass::fused::FusedPass;
use npr_imagespace::pass::{InkTarget, PassTarget};
use npr_imagespace::picture::Taps;
use std::cell::{OnceCell, RefCell};
use std::collections::HashMap;

/// The properties that distinguish one filter pipeline from another.
type FilterKey = (Taps, bool, TexelLayout, InkTarget);

/// Panic message for passes that fail only for formats other than Unorm.
const UNORM: &str = "the format is Unorm";

const PICTURE: InkTarget = InkTarget::Picture(COLOR_FORMAT);

/// The passes, created on first use.
#[derive(Default)]
pub(crate) struct InkPasses {
    filters: RefCell<HashMap<FilterKey, FusedPass>>,
    dilations: RefCell<HashMap<InkTarget, DiscPass>>,
    composite: OnceCell<CompositePass>,
    gbuffer: GBufferPasses,
}

/// A picture over which lines are drawn.
#[derive(Clone, Copy)]
pub(crate) struct InkFrame<'a> {
    pub(crate) device: &'a wgpu::Device,
    pub(crate) image: &'a ImagePlan,
    pub(crate) camera: &'a Camera,
    /// The bounding box of the scene; there are no lines outside it.
    pub(crate) bounds: Option<(Vec3, Vec3)>,
    pub(crate) ink: &'a InkTargets,
    pub(crate) picture: &'a wgpu::TextureView,
    pub(crate) picture_size: (u32, u32),
}

impl InkPasses {
    /// Finds the lines in the G-buffer and draws them over the picture.
    pub(crate) fn record(&self, encoder: &mut wgpu::CommandEncoder, frame: &InkFrame<'_>) -> Result<(), HarnessError> {
        if let Some(gbuffer) = frame.image.gbuffer.as_ref().filter(|plan| plan.gbuffer.show != Show::Lines) {
            self.gbuffer.show(frame.device, encoder, gbuffer, frame.ink, frame.picture);
            return Ok(());
        }
        frame.image.passes().try_for_each(|lines| self.record_lines(encoder, frame, lines))
    }

    /// Records one pass of lines.
    fn record_lines(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &InkFrame<'_>,
        lines: &ImageLines,
    ) -> Result<(), HarnessError> {
        let InkFrame { device, image, ink, picture, picture_size, .. } = *frame;
        // Filters and steps of a style's own may reach any distance.
        let bounds = frame.bounds.filter(|_| image.gbuffer.is_none());
        let area = |size, around_px| bounds.map(|bounds| frame.camera.area(bounds, size, around_px));
        let onto =
            |view, size, around_px| PassTarget { view, composite: &lines.composite, area: area(size, around_px) };
        // Lines extend beyond a surface as far as the filter's steps, plus the radius of the dilation.
        let filter = &lines.filter;
        let filter_px = filter.taps.longest_px().max_element();
        let dilation_px = lines.dilation.map_or(0, |disc| disc.radius_px.ceil() as u32 + 1) + filter_px - 1;

        let found = ink.found.as_ref().filter(|_| image.is_stored(lines));
        if let Some(gbuffer) = &image.gbuffer {
            self.gbuffer.find(device, encoder, gbuffer, ink)?;
        } else {
            let target = if found.is_some() { InkTarget::Ink } else { PICTURE };
            let key = (filter.taps, filter.softness > 0.0, image.ink.layout, target);
            let mut filters = self.filters.borrow_mut();
            let pass = filters
                .entry(key)
                .or_insert_with(|| FusedPass::new(device, filter, image.ink.layout, target).expect(UNORM));
            let view = found.unwrap_or(picture);
            pass.record(device, encoder, filter, &image.code, &ink.texels, &onto(view, ink.size, filter_px))?;
        }
        let Some(mut line) = found else { return Ok(()) };

        if let (Some(disc), Some(scratch)) = (&lines.dilation, &ink.dilation) {
            let thick = ink.thick.as_ref();
            let target = if thick.is_some() { InkTarget::Ink } else { PICTURE };
            let mut dilations = self.dilations.borrow_mut();
            let pass = dilations.entry(target).or_insert_with(|| DiscPass::new(device, target).expect(UNORM));
            let onto = onto(thick.unwrap_or(picture), ink.size, 1 + dilation_px);
            pass.record(device, encoder, Operation::Dilate, disc, line, scratch, &onto)?;
            let Some(thick) = thick else { return Ok(()) };
            line = thick;
        }
        // A pixel of ink covers at most two pixels of the picture, so the margin is doubled.
        let onto = onto(picture, picture_size, 4 + 2 * dilation_px);
        let composite = self.composite.get_or_init(|| CompositePass::new(device, PICTURE).expect(UNORM));
        composite.record(device, encoder, line, &onto)?;
        Ok(())
    }
}
