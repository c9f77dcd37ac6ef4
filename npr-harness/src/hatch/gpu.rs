//! Strokes on the GPU: the override constants of `hatch.wgsl`, its uniform, and the textures of the map.

use super::plan::HatchPlan;
use super::style::{HatchEncoding, HatchGround, HatchMapping, HatchShade, HatchTransfer, six_tones};
use crate::error::HarnessError;
use crate::gpu::context::GpuContext;
use crate::gpu::uniform::uniform_buffer;
use crate::shade::flag;
use glam::{DVec3, Vec3};
use npr_hatch::upload::{TamChannels, hatch_sampler, hatch_threshold_sampler, upload_tam, upload_thresholds};

/// The shader parts for hatched surfaces, after their libraries.
pub(crate) const HATCH_WGSL: &[(&str, &str)] =
    &[("npr-hatch", npr_hatch::WGSL), ("npr-hatch, lookup", npr_hatch::LOOKUP_WGSL)];

/// The entry points of hatched surfaces.
pub(crate) const HATCH_ENTRY_WGSL: (&str, &str) = ("hatch.wgsl", include_str!("hatch.wgsl"));

/// The entry points of hatched surfaces whose light is constant over faces or pieces of faces.
pub(crate) const HATCH_FACETS_WGSL: (&str, &str) = ("hatch/facets.wgsl", include_str!("facets.wgsl"));

/// `SurfaceHatch` of `hatch.wgsl`.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct HatchUniform {
    pub(crate) light_tones: [f32; 3],
    pub(crate) texels: f32,
    pub(crate) dark_tones: [f32; 3],
    pub(crate) last_level: f32,
    pub(crate) ink: [f32; 3],
    pub(crate) tiles: f32,
    pub(crate) paper: [f32; 3],
    pub(crate) brightness: f32,
    pub(crate) ambient: f32,
    pub(crate) width: f32,
    pub(crate) padding: [u32; 2],
}

impl HatchUniform {
    /// `samples` is the number of samples along each axis of a pixel.
    pub(crate) fn new(plan: &HatchPlan, paper: Vec3, samples: u32) -> Result<Self, HarnessError> {
        let (tam, shade) = (plan.tam()?, &plan.shade);
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
            paper: paper.to_array(),
            brightness,
            ambient,
            width: HatchShade::WIDTH as f32,
            padding: [0; 2],
        })
    }
}

/// The properties of strokes that are fixed when a pipeline is created.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct HatchVariant {
    mapping: HatchMapping,
    encoding: HatchEncoding,
    listing_4: bool,
    ground: HatchGround,
    weights_at_vertices: bool,
}

impl HatchVariant {
    pub(crate) fn new(plan: &HatchPlan) -> Self {
        Self {
            mapping: plan.shade.mapping,
            encoding: plan.shade.encoding,
            listing_4: matches!(plan.shade.transfer, HatchTransfer::Listing4 { .. }),
            ground: plan.shade.ground,
            weights_at_vertices: plan.weights_at_vertices,
        }
    }

    pub(crate) fn constants(&self) -> [(&'static str, f64); 5] {
        let mapping = match self.mapping {
            HatchMapping::Coordinates => 0.0,
            HatchMapping::Planes => 1.0,
            HatchMapping::Form => 2.0,
        };
        [
            ("surface_hatch_mapping", mapping),
            ("surface_hatch_thresholds", flag(self.encoding == HatchEncoding::Thresholds)),
            ("surface_hatch_listing_4", flag(self.listing_4)),
            ("surface_hatch_over_surface", flag(self.ground == HatchGround::Surface)),
            ("surface_hatch_at_vertices", flag(self.weights_at_vertices)),
        ]
    }
}

/// The textures of a map; those that are not used are placeholders.
pub(crate) struct HatchTextures {
    pub(crate) light: wgpu::TextureView,
    pub(crate) dark: wgpu::TextureView,
    pub(crate) sampler: wgpu::Sampler,
    pub(crate) thresholds: wgpu::TextureView,
    /// A placeholder uniform, bound for surfaces that are not hatched.
    pub(crate) blank: wgpu::Buffer,
}

impl HatchTextures {
    pub(crate) fn blank(device: &wgpu::Device) -> Self {
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

    /// `channels` is the storage format of six tones.
    pub(crate) fn new(context: &GpuContext, plan: &HatchPlan, channels: TamChannels) -> Result<Self, HarnessError> {
        let (device, queue) = (&context.device, &context.queue);
        let mut textures = Self::blank(device);
        let view = |texture: wgpu::Texture| texture.create_view(&Default::default());
        match plan.drawn_thresholds()? {
            Some(thresholds) => {
                textures.thresholds = view(upload_thresholds(device, queue, thresholds)?);
                textures.sampler = hatch_threshold_sampler(device);
            }
            None => {
                let tam = upload_tam(device, queue, plan.tam()?, channels)?;
                (textures.light, textures.dark) = (view(tam.light), view(tam.dark));
            }
        }
        Ok(textures)
    }
}
