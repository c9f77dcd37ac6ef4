//! Ink over a picture, also of another size: see [`crate::resample`].

use super::fullscreen::{Bound, Fullscreen, Output, flag, size_px, uniform};
use super::{InkTarget, Onto};

pub(super) const LAY: (&str, &str) = ("pass/lay.wgsl", include_str!("lay.wgsl"));

/// The pipelines, for ink of the picture's size and of another.
#[derive(Debug)]
pub struct LayPass {
    same: Fullscreen,
    scaled: Fullscreen,
}

impl LayPass {
    /// Makes the pipelines. Onto [`InkTarget::Ink`] the ink is brought to that picture's size.
    pub fn new(device: &wgpu::Device, target: InkTarget) -> Self {
        let pipeline = |same| {
            let bound = [Bound::Uniform, Bound::Float];
            Fullscreen::new(device, "lay", LAY, &bound, &[flag("same_size", same)], Output::Ink(target))
        };
        Self { same: pipeline(true), scaled: pipeline(false) }
    }

    /// Records laying `ink`, [`super::INK_FORMAT`] of any size, over the target. Sizes are those of the views'
    /// textures: a target that is a smaller level of its texture is not told from the largest.
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        ink: &wgpu::TextureView,
        onto: &Onto<'_>,
    ) {
        let (from, to) = (size_px(ink), size_px(onto.view));
        let scale = [from[0] as f32 / to[0] as f32, from[1] as f32 / to[1] as f32, 0.0, 0.0];
        let scale = uniform(device, bytemuck::bytes_of(&scale));
        let resources = [scale.as_entire_binding(), wgpu::BindingResource::TextureView(ink)];
        let draw = if from == to { &self.same } else { &self.scaled };
        draw.record(device, encoder, &resources, onto);
    }
}
