//! The textures of a G-buffer on the GPU.

use super::style::GBuffer;

/// The format of unquantised texels.
pub(crate) const TEXEL_FORMAT: wgpu::TextureFormat = crate::texel_format::UNQUANTISED.on_device();

/// The encoded G-buffer, and a second ink picture for steps of morphology.
pub(crate) struct GBufferTargets {
    /// In the order of [`GBuffer::encoded`].
    pub(super) encoded: [Option<wgpu::TextureView>; 3],
    pub(super) ink: Option<wgpu::TextureView>,
}

impl GBufferTargets {
    /// `texture` makes a texture of a format for rendering and reading, `ink` a picture of ink.
    pub(crate) fn new(
        gbuffer: &GBuffer,
        texture: impl Fn(wgpu::TextureFormat) -> wgpu::TextureView,
        ink: impl FnOnce() -> wgpu::TextureView,
    ) -> Self {
        Self {
            encoded: gbuffer.encoded().map(|format| format.map(|format| texture(format.on_device()))),
            ink: gbuffer.has_steps().then(ink),
        }
    }
}
