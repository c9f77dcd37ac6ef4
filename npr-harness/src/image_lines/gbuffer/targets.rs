//! The textures of a G-buffer on the GPU.

use super::style::{GBuffer, GBufferTarget};
use npr_imagespace::pass::INK_FORMAT;

/// The format of unquantised texels.
pub(crate) const TEXEL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;
pub(super) const RGBA8: [wgpu::TextureFormat; 1] = [wgpu::TextureFormat::Rgba8Unorm];
/// Of normals, depths and regions as the filters read them.
pub(super) const SEPARATE: [wgpu::TextureFormat; 3] =
    [wgpu::TextureFormat::Rgba32Float, wgpu::TextureFormat::R32Float, wgpu::TextureFormat::R32Uint];

/// The encoded G-buffer, and a second ink picture for steps of morphology.
pub(crate) struct GBufferTargets {
    pub(super) encoded: Vec<wgpu::TextureView>,
    pub(super) ink: wgpu::TextureView,
}

impl GBufferTargets {
    /// `texture` makes a texture of a format for rendering and reading.
    pub(crate) fn new(gbuffer: &GBuffer, texture: impl Fn(wgpu::TextureFormat) -> wgpu::TextureView) -> Self {
        let formats: &[_] = match gbuffer.target {
            GBufferTarget::Rgba8(_) => &RGBA8,
            GBufferTarget::Separate(_) => &SEPARATE,
        };
        Self { encoded: formats.iter().map(|&format| texture(format)).collect(), ink: texture(INK_FORMAT) }
    }
}
