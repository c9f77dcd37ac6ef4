//! Inverted hulls on the GPU.

use super::plan::HullPlan;
use crate::error::HarnessError;
use crate::gpu::targets::COLOR_FORMAT;
use crate::scene::Scene;
use crate::view::{View, size_px};
use npr_outline::hull::Hull;
use npr_outline::hull_pass::{HullOnDevice, HullPass, PlacedHull};
use std::cell::OnceCell;
use std::sync::Arc;

/// The pass, created on first use.
#[derive(Default)]
pub(crate) struct HullLinePass(OnceCell<HullPass>);

/// The targets over which hulls are drawn.
#[derive(Clone, Copy)]
pub(crate) struct HullTargets<'a> {
    pub(crate) color: &'a wgpu::TextureView,
    pub(crate) depth: &'a wgpu::TextureView,
    /// Width and height, px.
    pub(crate) size: (u32, u32),
}

/// Uploads the hull of each mesh.
pub(crate) fn upload(device: &wgpu::Device, plan: &HullPlan) -> Result<Vec<HullOnDevice>, HarnessError> {
    let upload = |hull: &Arc<Hull>| Ok(HullOnDevice::new(device, hull)?);
    plan.hulls.iter().map(upload).collect()
}

impl HullLinePass {
    /// Records drawing the hulls of all objects, which add their depth.
    pub(crate) fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        (plan, hulls): (&HullPlan, &[HullOnDevice]),
        scene: &Scene,
        view: &View,
        targets: &HullTargets<'_>,
    ) -> Result<(), HarnessError> {
        let pass = self.0.get_or_init(|| HullPass::new(device, COLOR_FORMAT).expect("the pictures' format is Unorm"));
        let scale = f64::from(view.samples);
        let placed: Vec<PlacedHull<'_>> = (plan.objects(scene))
            .map(|object| PlacedHull {
                hull: &hulls[object.mesh()],
                view: plan.view(object, &view.camera, size_px(targets.size), scale),
            })
            .collect();
        let ink = plan.style.ink.extend(1.0).to_array();
        Ok(pass.record(device, encoder, &placed, ink, targets.color, targets.depth)?)
    }
}
