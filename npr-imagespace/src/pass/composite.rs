//! Compositing ink of any size over a picture: see [`crate::resample`].

use super::fullscreen::{Bound, Fullscreen, Output, flag, uniform};
use super::target::{InkTarget, PassTarget, check_ink, texture_size_px};
use crate::ImageSpaceError;

pub(super) const COMPOSITE: &[(&str, &str)] = &[("pass/composite.wgsl", include_str!("composite.wgsl"))];

/// The pipelines, for ink of the picture's size and of another.
#[derive(Debug)]
pub struct CompositePass {
    same: Fullscreen,
    scaled: Fullscreen,
}

impl CompositePass {
    /// Makes the pipelines. With [`InkTarget::Ink`] the ink is resampled to the size of another ink picture.
    ///
    /// # Errors
    /// [`ImageSpaceError::SrgbPicture`], [`ImageSpaceError::PictureFormat`].
    pub fn new(device: &wgpu::Device, target: InkTarget) -> Result<Self, ImageSpaceError> {
        target.check(device)?;
        let pipeline = |same| {
            let bound = [Bound::Uniform, Bound::Float];
            Fullscreen::new(device, "composite", COMPOSITE, &bound, &[flag("same_size", same)], Output::Ink(target))
        };
        Ok(Self { same: pipeline(true), scaled: pipeline(false) })
    }

    /// Records compositing `ink`, of format [`super::INK_FORMAT`] and any size, over the target.
    ///
    /// # Errors
    /// If a texture is not as [`crate::pass`] says.
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        ink: &wgpu::TextureView,
        target: &PassTarget<'_>,
    ) -> Result<(), ImageSpaceError> {
        let to = self.same.check(target)?;
        check_ink(ink, None)?;
        let from = texture_size_px(ink);
        let scale = [from[0] as f32 / to[0] as f32, from[1] as f32 / to[1] as f32, 0.0, 0.0];
        let scale = uniform(device, bytemuck::bytes_of(&scale));
        let resources = [scale.as_entire_binding(), wgpu::BindingResource::TextureView(ink)];
        let draw = if from == to { &self.same } else { &self.scaled };
        draw.record(device, encoder, &resources, target);
        Ok(())
    }
}
