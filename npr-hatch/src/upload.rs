//! Uploads maps to wgpu textures, for `LOOKUP_WGSL`.

use crate::{HatchError, Tam, Thresholds};
use half::f16;
use wgpu::util::{DeviceExt, TextureDataOrder};

/// The channel type of a map's textures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TamChannels {
    /// `Rgba8Unorm`: the bytes of the map.
    #[default]
    Bytes,
    /// `Rgba16Float`: the same values in twice the memory. Software rasterisers filter them in floating point, but filter
    /// 8-bit channels in 8 bits with errors of up to 2/255.
    HalfFloats,
}

/// A map of six tones as two textures with all levels (Card & Mitchell 2002, listing 5).
#[derive(Clone, Debug)]
pub struct TamOnDevice {
    /// The three lighter tones, in red, green and blue.
    pub light: wgpu::Texture,
    /// The three darker tones.
    pub dark: wgpu::Texture,
}

/// Uploads a map of six tones.
///
/// # Errors
/// [`HatchError::PackTones`], [`HatchError::TooLarge`], and those of [`Tam::validate`].
pub fn upload_tam(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    tam: &Tam,
    channels: TamChannels,
) -> Result<TamOnDevice, HatchError> {
    tam.validate()?;
    let mut texels = [Vec::new(), Vec::new()];
    for level in 0..tam.levels() {
        for (texels, packed) in texels.iter_mut().zip(tam.pack_tones(level)?) {
            let bytes = packed.iter().flat_map(|&[r, g, b]| [r, g, b, 255]);
            match channels {
                TamChannels::Bytes => texels.extend(bytes),
                TamChannels::HalfFloats => {
                    texels.extend(bytes.flat_map(|byte| f16::from_f32(f32::from(byte) / 255.0).to_le_bytes()));
                }
            }
        }
    }
    let [light, dark] = texels;
    let format = match channels {
        TamChannels::Bytes => wgpu::TextureFormat::Rgba8Unorm,
        TamChannels::HalfFloats => wgpu::TextureFormat::Rgba16Float,
    };
    Ok(TamOnDevice {
        light: upload(device, queue, "the lighter tones", tam.side, format, &light)?,
        dark: upload(device, queue, "the darker tones", tam.side, format, &dark)?,
    })
}

/// Uploads thresholds as `Rg8Unorm` with all levels: the higher byte of each in red, the lower in green.
///
/// # Errors
/// [`HatchError::TooLarge`], [`HatchError::ImageSize`].
pub fn upload_thresholds(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    map: &Thresholds,
) -> Result<wgpu::Texture, HatchError> {
    for (level, texels) in map.levels.iter().enumerate() {
        let expected = (map.side as usize >> level).pow(2);
        if texels.len() != expected {
            return Err(HatchError::ImageSize { image: level, texels: texels.len(), expected });
        }
    }
    let bytes: Vec<u8> = map.levels.iter().flatten().flat_map(|threshold| threshold.to_be_bytes()).collect();
    upload(device, queue, "thresholds", map.side, wgpu::TextureFormat::Rg8Unorm, &bytes)
}

/// The sampler for `hatch_texels`: repeat addressing and trilinear filtering.
pub fn hatch_sampler(device: &wgpu::Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("tonal art map"),
        address_mode_u: wgpu::AddressMode::Repeat,
        address_mode_v: wgpu::AddressMode::Repeat,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    })
}

/// The sampler for `hatch_ink`: nearest filtering of texels and levels.
pub fn hatch_threshold_sampler(device: &wgpu::Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor { label: Some("thresholds"), ..Default::default() })
}

fn upload(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    side: u32,
    format: wgpu::TextureFormat,
    bytes: &[u8],
) -> Result<wgpu::Texture, HatchError> {
    let limit = device.limits().max_texture_dimension_2d;
    if side > limit {
        return Err(HatchError::TooLarge { side, limit });
    }
    let descriptor = wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
        mip_level_count: side.trailing_zeros() + 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    Ok(device.create_texture_with_data(queue, &descriptor, TextureDataOrder::LayerMajor, bytes))
}
