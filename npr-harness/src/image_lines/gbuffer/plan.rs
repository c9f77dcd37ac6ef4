//! The part of a plan for a G-buffer.

use super::style::{GBuffer, GBufferTarget};
use crate::camera::{Camera, Projection};
use crate::error::HarnessError;
use crate::scene::Scene;
use npr_imagespace::filter::separate::SeparateDepthTest;
use npr_imagespace::format::depth::DepthRange;
use npr_imagespace::format::texel::DepthCode;

/// The part of a plan for a G-buffer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GBufferPlan {
    /// The settings of the style. In a parallel view depth steps are in scene units.
    pub gbuffer: GBuffer,
    /// The scene's depth range, limited by the near plane.
    pub range: DepthRange,
    /// 1/z, or z in a parallel view, is this scale times the value of the depth buffer plus this bias. The other fields
    /// are as [`DepthCode`] has them.
    pub buffer: DepthCode,
}

impl GBufferPlan {
    pub(crate) fn new(scene: &Scene, gbuffer: &GBuffer, camera: &Camera) -> Result<Self, HarnessError> {
        let (near, far) = scene.depth_range(camera);
        // A flat scene that faces the viewer has one depth.
        let far = (far * f64::from(gbuffer.far)).max(near * (1.0 + 1e-5));
        let range = DepthRange::new(near as f32, far as f32)?;
        let mut gbuffer = *gbuffer;
        let (scale, bias, parallel) = match camera.projection {
            Projection::Perspective { .. } => (1.0 / camera.near, 0.0, 0),
            Projection::Orthographic { far, .. } => (camera.near - far, far, 1),
        };
        if let GBufferTarget::Separate(separate) = &mut gbuffer.target
            && let Some(depth) = &mut separate.filter.depth
        {
            depth.parallel = parallel != 0;
            if let (true, SeparateDepthTest::Bend { step } | SeparateDepthTest::Step { step }) =
                (depth.parallel, &mut depth.test)
            {
                // Limited to the largest f32, with which no depth step is a line.
                *step = (*step * 2.0 * scene.radius() as f32).min(f32::MAX);
            }
        }
        Ok(Self { gbuffer, range, buffer: DepthCode { scale: scale as f32, bias: bias as f32, most: 0.0, parallel } })
    }
}
