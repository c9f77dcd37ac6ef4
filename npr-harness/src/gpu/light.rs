//! What the geometry pass knows of the light: constants of its pipelines, uniforms, and a ramp's image.

use super::{GpuContext, GpuError};
use crate::shade::Shade;
use crate::shade::painter::{PainterShade, Ramp2dSource};
use crate::shade::ramp::{RampShade, RampSource};
use crate::style::Style;
use bytemuck::Zeroable;
use npr_gooch::GoochUniform;
use npr_outline::filled_buffer::filled_buffer;
use npr_toon::ToonUniform;
use npr_toon::half_lambert::HalfLambert;
use npr_toon::normal::NormalUse;
use npr_toon::painter::{Painter, PainterUniform};
use npr_toon::ramp::RampUniform;
use npr_toon::row::TexelFilter;
use npr_toon::source::{Light, LightKind};
use npr_toon::table::Ramp2dUniform;
use wgpu::util::DeviceExt;

/// `SurfaceShade` of `surface_light.wgsl`.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct ShadeUniform {
    pub(super) ambient: f32,
    pub(super) half_scale: f32,
    pub(super) half_bias: f32,
    pub(super) half_squared: u32,
    pub(super) row_ends: [f32; 2],
    pub(super) padding: [u32; 2],
}

/// What of the light is known when a pipeline is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct LightVariant {
    /// Of the `SHADE_` constants of `surface_light.wgsl`.
    shade: u32,
    normals: NormalUse,
    positional: [bool; 2],
    highlight: bool,
    tinted: bool,
    ramp_image: Option<TexelFilter>,
    half_lambert: bool,
    pub(super) by_alpha: bool,
    /// How many bands, and how many stops.
    bands: u32,
    stops: u32,
}

impl LightVariant {
    fn new(style: &Style, lights: &[Light]) -> Self {
        let positional =
            |number: usize| matches!(lights.get(number).map(|light| light.place), Some(LightKind::Positional { .. }));
        let tinted = lights.first().is_none_or(|light| light.brightness != 1.0 || light.color != glam::Vec3::ONE);
        let mut variant = Self {
            shade: 0,
            normals: style.normals,
            positional: [positional(0), positional(1)],
            highlight: false,
            tinted,
            ramp_image: None,
            half_lambert: false,
            by_alpha: false,
            bands: 1,
            stops: 1,
        };
        match &style.shade {
            Shade::Paper | Shade::Lambert { .. } | Shade::Hatch(_) => {}
            Shade::Toon(bands) => {
                variant.shade = 1;
                variant.bands = bands.tones.len() as u32;
                variant.highlight = bands.highlight.is_some_and(|highlight| highlight.strength > 0.0);
            }
            Shade::Ramp(RampShade { ramp, half_lambert }) => {
                variant.shade = 2;
                variant.half_lambert = half_lambert.is_some();
                match ramp {
                    RampSource::Stops(ramp) => variant.stops = ramp.stops.len() as u32,
                    RampSource::Image(row) => variant.ramp_image = Some(row.filter),
                }
            }
            Shade::Painter(PainterShade { ramp, material_by_alpha, .. }) => {
                variant.shade = 3;
                variant.by_alpha = *material_by_alpha;
                match ramp {
                    Ramp2dSource::Ramps(ramps) => {
                        variant.stops = ramps.a.stops.len().max(ramps.b.stops.len()) as u32;
                    }
                    Ramp2dSource::Image(table) => variant.ramp_image = Some(table.filter),
                }
            }
            Shade::Gooch(_) => variant.shade = 4,
            Shade::Normals => variant.shade = 5,
        }
        variant
    }

    /// Whether light is computed at the vertices alone.
    pub(super) fn is_of_vertices(&self) -> bool {
        self.normals == NormalUse::PerVertex
    }

    pub(super) fn constants(&self) -> [(&'static str, f64); 10] {
        let flag = |flag: bool| f64::from(u8::from(flag));
        [
            // Loops over bands and stops are unrolled for as many as there are.
            (npr_toon::TOON_BANDS_OVERRIDE, f64::from(self.bands)),
            (npr_toon::ramp::TOON_STOPS_OVERRIDE, f64::from(self.stops)),
            ("surface_shade", f64::from(self.shade)),
            (
                "surface_normals",
                match self.normals {
                    NormalUse::PerPixel => 0.0,
                    NormalUse::Interpolated => 1.0,
                    NormalUse::PerVertex => 2.0,
                },
            ),
            ("surface_first_positional", flag(self.positional[0])),
            ("surface_second_positional", flag(self.positional[1])),
            ("surface_highlight", flag(self.highlight)),
            ("surface_tinted", flag(self.tinted)),
            (
                "surface_ramp_image",
                match self.ramp_image {
                    None => 0.0,
                    Some(TexelFilter::Nearest) => 1.0,
                    Some(TexelFilter::Linear) => 2.0,
                },
            ),
            ("surface_half_lambert", flag(self.half_lambert)),
        ]
    }
}

/// A style's light on the device. What its shade does not look at is not there.
pub(super) struct LightOnDevice {
    pub(super) variant: LightVariant,
    pub(super) lights: wgpu::Buffer,
    pub(super) shade: wgpu::Buffer,
    pub(super) bands: Option<wgpu::Buffer>,
    pub(super) ramps: Option<wgpu::Buffer>,
    pub(super) gooch: Option<wgpu::Buffer>,
    pub(super) ramp_image: Option<wgpu::TextureView>,
}

impl LightOnDevice {
    /// `lights` as [`crate::lights::lights_in_world`] has them.
    pub(super) fn new(context: &GpuContext, style: &Style, lights: &[Light]) -> Result<Self, GpuError> {
        let uniform = |contents: &[u8]| uniform_buffer(&context.device, contents);
        let (mut bands, mut ramps, mut gooch, mut ramp_image) = (None, None, None, None);
        let mut numbers = ShadeUniform::zeroed();
        let mut light_scale = Painter::LIGHT_SCALE;
        match &style.shade {
            Shade::Paper | Shade::Hatch(_) | Shade::Normals => {}
            Shade::Lambert { ambient } => numbers.ambient = *ambient,
            Shade::Toon(of) => bands = Some(uniform(bytemuck::bytes_of(&ToonUniform::new(of)?))),
            Shade::Ramp(RampShade { ramp, half_lambert }) => {
                if let Some(HalfLambert { scale, bias, squared }) = *half_lambert {
                    (numbers.half_scale, numbers.half_bias) = (scale, bias);
                    numbers.half_squared = u32::from(squared);
                }
                match ramp {
                    RampSource::Stops(ramp) => {
                        let both = Ramp2dUniform { a: RampUniform::new(ramp)?, ..Ramp2dUniform::zeroed() };
                        ramps = Some(uniform(bytemuck::bytes_of(&both)));
                    }
                    RampSource::Image(row) => {
                        numbers.row_ends = [row.from, row.to];
                        ramp_image = Some(upload_ramp(context, row.texels.len() as u32, 1, &row.texels)?);
                    }
                }
            }
            Shade::Painter(PainterShade { ramp, light_scale: scale, .. }) => {
                light_scale = *scale;
                match ramp {
                    Ramp2dSource::Ramps(of) => ramps = Some(uniform(bytemuck::bytes_of(&Ramp2dUniform::new(of)?))),
                    Ramp2dSource::Image(table) => {
                        ramp_image = Some(upload_ramp(context, table.size.x, table.size.y, &table.texels)?);
                    }
                }
            }
            Shade::Gooch(model) => gooch = Some(uniform(bytemuck::bytes_of(&GoochUniform::new(model)?))),
        }
        // Unchecked: two lights that cancel out have no direction, which is no error here.
        let placed = PainterUniform::unchecked(lights, light_scale);
        Ok(Self {
            variant: LightVariant::new(style, lights),
            lights: uniform(bytemuck::bytes_of(&placed)),
            shade: uniform(bytemuck::bytes_of(&numbers)),
            bands,
            ramps,
            gooch,
            ramp_image,
        })
    }
}

fn upload_ramp(
    context: &GpuContext,
    width: u32,
    height: u32,
    texels: &[[u8; 4]],
) -> Result<wgpu::TextureView, GpuError> {
    let limit = context.device.limits().max_texture_dimension_2d;
    if width.max(height) > limit {
        return Err(GpuError::RampTooLarge { width, height, limit });
    }
    let texture = context.device.create_texture_with_data(
        &context.queue,
        // Display-referred, as all of a style's colours.
        &ramp_texture(width, height),
        wgpu::util::TextureDataOrder::LayerMajor,
        bytemuck::cast_slice(texels),
    );
    Ok(texture.create_view(&Default::default()))
}

fn ramp_texture(width: u32, height: u32) -> wgpu::TextureDescriptor<'static> {
    wgpu::TextureDescriptor {
        label: Some("ramp"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    }
}

/// What is bound where a shade has nothing of its own.
pub(super) struct Blank {
    pub(super) uniform: wgpu::Buffer,
    pub(super) ramp_image: wgpu::TextureView,
}

impl Blank {
    pub(super) fn new(device: &wgpu::Device) -> Self {
        Self {
            // As large as the largest of them.
            uniform: uniform_buffer(device, &[0; size_of::<Ramp2dUniform>()]),
            ramp_image: device.create_texture(&ramp_texture(1, 1)).create_view(&Default::default()),
        }
    }
}

/// A uniform that is written once.
pub(super) fn uniform_buffer(device: &wgpu::Device, contents: &[u8]) -> wgpu::Buffer {
    debug_assert!(contents.len().is_multiple_of(16), "WebGL2 binds uniforms of whole vectors");
    filled_buffer(device, "uniform", contents, wgpu::BufferUsages::UNIFORM)
}
