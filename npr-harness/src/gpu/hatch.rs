//! Strokes on the device: what pipelines know of them, a uniform, and the map's textures.

use super::light::uniform_buffer;
use super::{Capabilities, GpuContext, GpuError};
use crate::hatch::HatchPlan;
use crate::style::{HatchEncoding, HatchGround, HatchMapping, HatchShade, HatchTransfer, Style, six_tones};
use glam::DVec3;
use npr_hatch::upload::{hatch_sampler, hatch_threshold_sampler, upload_tam, upload_thresholds};

/// `SurfaceHatch` of `surface_hatch.wgsl`.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct HatchUniform {
    pub(super) light_tones: [f32; 3],
    pub(super) texels: f32,
    pub(super) dark_tones: [f32; 3],
    pub(super) last_level: f32,
    pub(super) ink: [f32; 3],
    pub(super) tiles: f32,
    pub(super) paper: [f32; 3],
    pub(super) brightness: f32,
    pub(super) ambient: f32,
    pub(super) width: f32,
    pub(super) padding: [u32; 2],
}

impl HatchUniform {
    /// `samples`: along each axis of a pixel.
    pub(super) fn new(style: &Style, shade: &HatchShade, plan: &HatchPlan, samples: u32) -> Result<Self, GpuError> {
        let tam = plan.tam()?;
        let (light, dark) = six_tones(tam);
        let three = |of: DVec3| of.as_vec3().to_array();
        let (brightness, ambient) = match shade.transfer {
            HatchTransfer::Listing4 { brightness } => (brightness, 0.0),
            HatchTransfer::Linear { ambient } => (0.0, ambient),
        };
        Ok(Self {
            light_tones: three(light),
            texels: tam.side as f32 * shade.texel_px * samples as f32,
            dark_tones: three(dark),
            last_level: (tam.levels() - 1) as f32,
            ink: shade.ink.to_array(),
            tiles: (1.0 / plan.tile) as f32,
            paper: style.paper.to_array(),
            brightness,
            ambient,
            width: HatchShade::WIDTH as f32,
            padding: [0; 2],
        })
    }
}

/// What of strokes is known when a pipeline is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct HatchVariant {
    mapping: HatchMapping,
    encoding: HatchEncoding,
    listing_4: bool,
    ground: HatchGround,
}

impl HatchVariant {
    pub(super) fn new(shade: &HatchShade, plan: &HatchPlan) -> Self {
        Self {
            mapping: plan.mapping,
            encoding: shade.encoding,
            listing_4: matches!(shade.transfer, HatchTransfer::Listing4 { .. }),
            ground: shade.ground,
        }
    }

    pub(super) fn constants(variant: Option<Self>) -> [(&'static str, f64); 4] {
        let is = |test: &dyn Fn(&Self) -> bool| f64::from(u8::from(variant.as_ref().is_some_and(test)));
        let mapping = match variant.map(|variant| variant.mapping) {
            None | Some(HatchMapping::Coordinates) => 0.0,
            Some(HatchMapping::Planes) => 1.0,
            Some(HatchMapping::Form) => 2.0,
        };
        [
            ("surface_hatch_mapping", mapping),
            ("surface_hatch_thresholds", is(&|variant| variant.encoding == HatchEncoding::Thresholds)),
            ("surface_hatch_listing_4", is(&|variant| variant.listing_4)),
            ("surface_hatch_over_surface", is(&|variant| variant.ground == HatchGround::Surface)),
        ]
    }
}

/// A map's textures; what is not looked up is blank.
pub(super) struct HatchTextures {
    pub(super) light: wgpu::TextureView,
    pub(super) dark: wgpu::TextureView,
    pub(super) sampler: wgpu::Sampler,
    pub(super) thresholds: wgpu::TextureView,
    /// Nothing, where surfaces are not hatched.
    pub(super) blank: wgpu::Buffer,
}

impl HatchTextures {
    pub(super) fn blank(device: &wgpu::Device) -> Self {
        let view = |format| {
            let descriptor = wgpu::TextureDescriptor {
                label: Some("no tonal art map"),
                size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            };
            device.create_texture(&descriptor).create_view(&Default::default())
        };
        Self {
            light: view(wgpu::TextureFormat::Rgba8Unorm),
            dark: view(wgpu::TextureFormat::Rgba8Unorm),
            sampler: hatch_sampler(device),
            thresholds: view(wgpu::TextureFormat::Rg8Unorm),
            blank: uniform_buffer(device, &[0; size_of::<HatchUniform>()]),
        }
    }

    pub(super) fn new(context: &GpuContext, capabilities: &Capabilities, plan: &HatchPlan) -> Result<Self, GpuError> {
        let (device, queue) = (&context.device, &context.queue);
        let mut textures = Self::blank(device);
        let view = |texture: wgpu::Texture| texture.create_view(&Default::default());
        match plan.drawn_thresholds()? {
            Some(thresholds) => {
                textures.thresholds = view(upload_thresholds(device, queue, thresholds)?);
                textures.sampler = hatch_threshold_sampler(device);
            }
            None => {
                let (channels, _) = capabilities.tonal_art_map();
                let tam = upload_tam(device, queue, plan.tam()?, channels)?;
                (textures.light, textures.dark) = (view(tam.light), view(tam.dark));
            }
        }
        Ok(textures)
    }
}
