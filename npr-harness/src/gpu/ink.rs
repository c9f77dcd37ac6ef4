//! Lines in the image on the device: filter, brush and composite.

use super::targets::{COLOR_FORMAT, InkTargets, Targets};
use super::{GpuContext, GpuError};
use crate::camera::Camera;
use crate::image_ink::ImagePlan;
use crate::scene::Scene;
use npr_imagespace::format::texel::TexelLayout;
use npr_imagespace::pass::fused::FusedPass;
use npr_imagespace::pass::{InkTarget, Onto};
use npr_imagespace::picture::Taps;
use std::cell::RefCell;
use std::collections::HashMap;

/// What tells one filter's pipeline from another's.
type FilterKey = (Taps, bool, TexelLayout, InkTarget);

/// The passes, made when they are first needed.
#[derive(Default)]
pub(super) struct InkPasses {
    filters: RefCell<HashMap<FilterKey, FusedPass>>,
}

impl InkPasses {
    /// Finds the lines in the texels that were drawn, and lays them over the picture.
    #[expect(clippy::too_many_arguments, reason = "each is a thing of its own; a struct would only rename them")]
    pub(super) fn record(
        &self,
        context: &GpuContext,
        encoder: &mut wgpu::CommandEncoder,
        scene: &Scene,
        image: &ImagePlan,
        camera: &Camera,
        ink: &InkTargets,
        targets: &Targets,
    ) -> Result<(), GpuError> {
        let filter = &image.ink.filter;
        let target = InkTarget::Picture(COLOR_FORMAT);
        let key = (filter.taps, filter.softness > 0.0, image.ink.layout, target);
        let mut filters = self.filters.borrow_mut();
        let pass =
            filters.entry(key).or_insert_with(|| FusedPass::new(&context.device, filter, image.ink.layout, target));
        let area = scene.model.bounds().map(|bounds| camera.area(bounds, ink.size, 1));
        let onto = Onto { view: &targets.color_view, composite: &image.ink.composite, area };
        pass.record(&context.device, encoder, filter, &image.code, &ink.texels, &onto)?;
        Ok(())
    }
}
