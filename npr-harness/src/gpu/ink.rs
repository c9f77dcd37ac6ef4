//! Lines in the image on the device: filter, brush and composite.

use super::targets::{COLOR_FORMAT, InkTargets, Targets};
use super::{GpuContext, GpuError};
use crate::camera::Camera;
use crate::image_ink::{ImageLines, ImagePlan};
use glam::Vec3;
use npr_imagespace::format::texel::TexelLayout;
use npr_imagespace::morphology::Operation;
use npr_imagespace::pass::disc::DiscPass;
use npr_imagespace::pass::fused::FusedPass;
use npr_imagespace::pass::lay::LayPass;
use npr_imagespace::pass::{InkTarget, Onto};
use npr_imagespace::picture::Taps;
use std::cell::{OnceCell, RefCell};
use std::collections::HashMap;

/// What tells one filter's pipeline from another's.
type FilterKey = (Taps, bool, TexelLayout, InkTarget);

const PICTURE: InkTarget = InkTarget::Picture(COLOR_FORMAT);

/// The passes, made when they are first needed.
#[derive(Default)]
pub(super) struct InkPasses {
    filters: RefCell<HashMap<FilterKey, FusedPass>>,
    brushes: RefCell<HashMap<InkTarget, DiscPass>>,
    lay: OnceCell<LayPass>,
}

impl InkPasses {
    /// Finds the lines in the texels that were drawn, and lays them over the picture.
    #[expect(clippy::too_many_arguments, reason = "each is a thing of its own; a struct would only rename them")]
    pub(super) fn record(
        &self,
        context: &GpuContext,
        encoder: &mut wgpu::CommandEncoder,
        bounds: Option<(Vec3, Vec3)>,
        image: &ImagePlan,
        camera: &Camera,
        ink: &InkTargets,
        targets: &Targets,
    ) -> Result<(), GpuError> {
        for lines in image.passes() {
            self.record_lines(context, encoder, bounds, image, lines, camera, ink, targets)?;
        }
        Ok(())
    }

    /// One pass of lines.
    #[expect(clippy::too_many_arguments, reason = "each is a thing of its own; a struct would only rename them")]
    fn record_lines(
        &self,
        context: &GpuContext,
        encoder: &mut wgpu::CommandEncoder,
        bounds: Option<(Vec3, Vec3)>,
        image: &ImagePlan,
        lines: &ImageLines,
        camera: &Camera,
        ink: &InkTargets,
        targets: &Targets,
    ) -> Result<(), GpuError> {
        let device = &context.device;
        let area = |size, around_px| bounds.map(|bounds| camera.area(bounds, size, around_px));
        let onto = |view, size, around_px| Onto { view, composite: &lines.composite, area: area(size, around_px) };
        // Beside a surface there is a pixel of line, and then what the brush adds.
        let brush_px = lines.brush.map_or(0, |disc| disc.radius_px.ceil() as u32 + 1);
        let picture_size = (targets.width, targets.height);

        let filter = &lines.filter;
        // Without a brush lines are laid as they are found, if they are found at the picture's size.
        let found = ink.found.as_ref().filter(|_| lines.brush.is_some() || ink.size != picture_size);
        let target = if found.is_some() { InkTarget::Ink } else { PICTURE };
        let key = (filter.taps, filter.softness > 0.0, image.ink.layout, target);
        let mut filters = self.filters.borrow_mut();
        let pass = filters.entry(key).or_insert_with(|| {
            FusedPass::new(device, filter, image.ink.layout, target).expect("a color format without sRGB")
        });
        let view = found.unwrap_or(&targets.color_view);
        pass.record(device, encoder, filter, &image.code, &ink.texels, &onto(view, ink.size, 1))?;
        let Some(mut line) = found else { return Ok(()) };

        if let (Some(disc), Some(scratch)) = (&lines.brush, &ink.brush) {
            let thick = ink.thick.as_ref();
            let target = if thick.is_some() { InkTarget::Ink } else { PICTURE };
            let mut brushes = self.brushes.borrow_mut();
            let pass = brushes
                .entry(target)
                .or_insert_with(|| DiscPass::new(device, target).expect("a color format without sRGB"));
            let onto = onto(thick.unwrap_or(&targets.color_view), ink.size, 1 + brush_px);
            pass.record(device, encoder, Operation::Dilate, disc, line, scratch, &onto)?;
            let Some(thick) = thick else { return Ok(()) };
            line = thick;
        }
        // A pixel of ink is at most two of the picture's, and reaches as far again.
        let onto = onto(&targets.color_view, picture_size, 4 + 2 * brush_px);
        let lay = self.lay.get_or_init(|| LayPass::new(device, PICTURE).expect("a color format without sRGB"));
        lay.record(device, encoder, line, &onto)?;
        Ok(())
    }
}
