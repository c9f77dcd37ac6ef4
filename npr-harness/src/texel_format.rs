//! Formats of texels, and those of a frame's targets.

/// Display-referred colours, without sRGB encoding on store.
pub(crate) const COLOR: TexelFormat = TexelFormat::Rgba8Unorm;
/// Depth, reversed: 1 at the near plane.
pub(crate) const DEPTH: TexelFormat = TexelFormat::Depth32Float;
/// The greatest coverage of a pixel by lines along edges.
pub(crate) const COVERAGE: TexelFormat = TexelFormat::Depth16Unorm;
/// Ink of lines found in the image.
pub(crate) const INK: TexelFormat = TexelFormat::R8Unorm;
/// Unquantised texels of a style's own G-buffer.
pub(crate) const UNQUANTISED: TexelFormat = TexelFormat::Rgba32Uint;
/// Shadow masks.
pub(crate) const SHADOW_MASK: TexelFormat = TexelFormat::R8Uint;
/// Shadow maps.
pub(crate) const SHADOW_MAP: TexelFormat = TexelFormat::Depth32Float;
/// The format of a texel, with the name that WebGPU has for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names say what they are")]
pub enum TexelFormat {
    R8Unorm,
    R8Uint,
    Rg8Unorm,
    Rgba8Unorm,
    Rgba8UnormSrgb,
    Rgba16Float,
    R32Uint,
    R32Float,
    Rg32Uint,
    Rgba32Uint,
    Rgba32Float,
    Depth16Unorm,
    Depth24PlusStencil8,
    Depth32Float,
    Depth32FloatStencil8,
}

impl TexelFormat {
    /// The size of a texel, bytes. That of `Depth32FloatStencil8` is 8 on all common devices.
    pub const fn bytes(self) -> u64 {
        match self {
            Self::R8Unorm | Self::R8Uint => 1,
            Self::Rg8Unorm | Self::Depth16Unorm => 2,
            Self::Rgba8Unorm
            | Self::Rgba8UnormSrgb
            | Self::R32Uint
            | Self::R32Float
            | Self::Depth24PlusStencil8
            | Self::Depth32Float => 4,
            Self::Rgba16Float | Self::Rg32Uint | Self::Depth32FloatStencil8 => 8,
            Self::Rgba32Uint | Self::Rgba32Float => 16,
        }
    }

    /// The format of wgpu.
    #[cfg(feature = "gpu")]
    pub const fn on_device(self) -> wgpu::TextureFormat {
        use wgpu::TextureFormat as Format;
        match self {
            Self::R8Unorm => Format::R8Unorm,
            Self::R8Uint => Format::R8Uint,
            Self::Rg8Unorm => Format::Rg8Unorm,
            Self::Rgba8Unorm => Format::Rgba8Unorm,
            Self::Rgba8UnormSrgb => Format::Rgba8UnormSrgb,
            Self::Rgba16Float => Format::Rgba16Float,
            Self::R32Uint => Format::R32Uint,
            Self::R32Float => Format::R32Float,
            Self::Rg32Uint => Format::Rg32Uint,
            Self::Rgba32Uint => Format::Rgba32Uint,
            Self::Rgba32Float => Format::Rgba32Float,
            Self::Depth16Unorm => Format::Depth16Unorm,
            Self::Depth24PlusStencil8 => Format::Depth24PlusStencil8,
            Self::Depth32Float => Format::Depth32Float,
            Self::Depth32FloatStencil8 => Format::Depth32FloatStencil8,
        }
    }
}

/// The format of the target in which shadow volumes are counted.
pub(crate) const fn stencil_format(float_depth: bool) -> TexelFormat {
    if float_depth { TexelFormat::Depth32FloatStencil8 } else { TexelFormat::Depth24PlusStencil8 }
}

/// The number of mip levels of a texture.
pub(crate) fn level_count((width, height): (u32, u32)) -> u32 {
    width.max(height).max(1).ilog2() + 1
}
