//! Assembles the surface shader and its light uniforms.

use super::context::GpuContext;
use super::uniform::uniform_buffer;
use crate::error::HarnessError;
use crate::hatch::gpu::{HATCH_ENTRY_WGSL, HATCH_FACETS_WGSL, HATCH_WGSL, HatchVariant};
use crate::plan::{PaintPlan, Plan};
use crate::shade::{Shade, ShadeOnDevice, ShadeView, flag};
use crate::shadow::gpu::SHADOW_WGSL;
use npr_outline::filled_buffer::filled_buffer;
use npr_toon::normal::NormalUse;
use npr_toon::painter::PainterUniform;
use npr_toon::source::{Light, LightKind};
use wgpu::util::DeviceExt;

/// The parts of a shader, each with its name.
pub(crate) type Parts = Vec<(&'static str, &'static str)>;

/// The parts of the shader for a shade: libraries, lights, the shade's own functions, shadows, the geometry pass, and that
/// of faces that are lit as wholes or in pieces.
fn parts(shade: &ShadeOnDevice, hatched: bool, lights_faces: bool) -> Parts {
    let mut parts = shade.wgsl.to_vec();
    let own = parts.split_off(parts.iter().position(|(name, _)| name.ends_with(".wgsl")).unwrap_or(parts.len()));
    parts.push(("npr-imagespace, format", npr_imagespace::format::FORMAT_WGSL));
    parts.push(("npr-imagespace, shadow", npr_imagespace::shadow::SHADOW_WGSL));
    parts.push(("npr-imagespace, artist", npr_imagespace::artist::ARTIST_WGSL));
    parts.push(("gbuffer/texel.wgsl", crate::image_lines::gbuffer::texel::WGSL));
    if hatched {
        parts.extend(HATCH_WGSL);
    }
    parts.push(("lights.wgsl", include_str!("../shade/lights.wgsl")));
    parts.extend(own);
    parts.push(SHADOW_WGSL);
    parts.push(("surface.wgsl", include_str!("surface.wgsl")));
    if hatched {
        parts.push(HATCH_ENTRY_WGSL);
    }
    if lights_faces {
        parts.push(("facets.wgsl", include_str!("facets.wgsl")));
        if hatched {
            parts.push(HATCH_FACETS_WGSL);
        }
    }
    parts
}

/// Concatenates the parts of a shader, with a list of them at its head and a name before each part.
pub(crate) fn assemble(parts: &Parts) -> String {
    let names: Vec<_> = parts.iter().map(|(name, _)| *name).collect();
    let mut text = format!("// Made of: {}.\n", names.join("; "));
    for (name, part) in parts {
        text.push_str("\n// ---- ");
        text.push_str(name);
        text.push('\n');
        text.push_str(part);
    }
    text
}

/// The complete surface shader for a shade.
///
/// # Errors
/// An error if a number of the shade is out of range.
pub fn surface_wgsl(shade: &Shade) -> Result<String, HarnessError> {
    let hatched = matches!(shade, Shade::Hatch(_));
    Ok(assemble(&parts(&shade.model().on_device(&ShadeView::default())?, hatched, true)))
}

/// The properties of light and shade that are fixed when a pipeline is created.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ShaderKey {
    /// The parts of the shader, by name.
    pub(super) parts: Parts,
    /// The values of its override constants.
    pub(super) constants: Vec<(&'static str, f64)>,
    /// Whether light is computed only at the vertices.
    pub(super) at_vertices: bool,
    /// Whether light is constant over faces or pieces of faces.
    pub(super) lights_faces: bool,
}

/// The GPU resources for the light and the shade of a picture, limited to those that the shade uses.
pub(super) struct LightOnDevice {
    pub(super) key: ShaderKey,
    /// `ToonPainter` of all objects, or one for each pair of lights, [`LightOnDevice::stride`] bytes apart.
    pub(super) lights: wgpu::Buffer,
    pub(super) stride: u32,
    pub(super) shade: Option<wgpu::Buffer>,
    pub(super) image: Option<wgpu::TextureView>,
}

impl LightOnDevice {
    pub(super) fn new(context: &GpuContext, plan: &Plan) -> Result<Self, HarnessError> {
        let paint = plan.paint.as_ref();
        let (shade, view) = paint.map_or((&Shade::Paper, ShadeView::default()), |paint| (&paint.shade, paint.view));
        let shade = shade.model().on_device(&view)?;
        let lights: &[Light] = paint.map_or(&[], |paint| &paint.lights);
        let mut constants = shade.constants.clone();
        constants.extend(light_constants(paint, lights));
        if let Some(hatch) = plan.hatch() {
            constants.extend(HatchVariant::new(hatch).constants());
        }
        let lights_faces = paint.is_some_and(PaintPlan::lights_faces);
        if lights_faces {
            let divisions = match paint.map(|paint| paint.normals) {
                Some(NormalUse::PerSubdividedFace(divisions)) => f64::from(divisions),
                _ => 0.0,
            };
            constants.push(("surface_divisions", divisions));
        }
        let image = match &shade.image {
            Some((width, height, texels)) => Some(upload_image(context, *width, *height, texels)?),
            None => None,
        };
        let at_vertices = paint.is_some_and(|paint| paint.normals == NormalUse::PerVertex);
        // Unchecked, because two lights that cancel out have no direction, which is not an error here.
        let placed = |lights: &[Light]| PainterUniform::unchecked(lights, shade.light_scale);
        let stride = (size_of::<PainterUniform>() as u32).next_multiple_of(context.capabilities.uniform_alignment);
        let pairs = paint.map_or(&[][..], |paint| &paint.light_pairs);
        let mut placed_lights = bytemuck::bytes_of(&placed(lights)).to_vec();
        for (number, pair) in pairs.iter().enumerate() {
            placed_lights.truncate(number * stride as usize);
            placed_lights.extend_from_slice(bytemuck::bytes_of(&placed(&pair.lights)));
            placed_lights.resize((number + 1) * stride as usize, 0);
        }
        let uniform = |contents: &[u8]| uniform_buffer(&context.device, contents);
        Ok(Self {
            key: ShaderKey {
                parts: parts(&shade, plan.hatch().is_some(), lights_faces),
                constants,
                at_vertices,
                lights_faces,
            },
            lights: filled_buffer(&context.device, "lights", &placed_lights, wgpu::BufferUsages::UNIFORM),
            stride,
            shade: (!shade.uniform.is_empty()).then(|| uniform(&shade.uniform)),
            image,
        })
    }
}

/// The override constants of `lights.wgsl`.
fn light_constants(paint: Option<&PaintPlan>, lights: &[Light]) -> [(&'static str, f64); 4] {
    let positional =
        |number: usize| flag(matches!(lights.get(number).map(|light| light.place), Some(LightKind::Positional { .. })));
    // Pairs of lights share a pipeline. A direction is a position at infinity.
    let paired = paint.is_some_and(|paint| !paint.light_pairs.is_empty());
    let any_positional = flag((0..lights.len()).any(|number| positional(number) != 0.0));
    let tinted = paired || lights.first().is_none_or(|light| light.brightness != 1.0 || light.color != glam::Vec3::ONE);
    [
        (
            "surface_normals",
            match paint.map(|paint| paint.normals) {
                None | Some(NormalUse::PerPixel) => 0.0,
                Some(NormalUse::Interpolated) => 1.0,
                Some(NormalUse::PerVertex) => 2.0,
                Some(NormalUse::PerFace | NormalUse::PerSubdividedFace(_)) => 3.0,
            },
        ),
        ("surface_first_positional", if paired { any_positional } else { positional(0) }),
        ("surface_second_positional", if paired { any_positional } else { positional(1) }),
        ("surface_tinted", flag(tinted)),
    ]
}

fn upload_image(
    context: &GpuContext,
    width: u32,
    height: u32,
    texels: &[[u8; 4]],
) -> Result<wgpu::TextureView, HarnessError> {
    let limit = context.device.limits().max_texture_dimension_2d;
    if width.max(height) > limit {
        return Err(HarnessError::RampTooLarge { width, height, limit });
    }
    let texture = context.device.create_texture_with_data(
        &context.queue,
        // Display-referred, like all colours of a style.
        &image_texture("image of the shade", width, height),
        wgpu::util::TextureDataOrder::LayerMajor,
        bytemuck::cast_slice(texels),
    );
    Ok(texture.create_view(&Default::default()))
}

fn image_texture(label: &'static str, width: u32, height: u32) -> wgpu::TextureDescriptor<'static> {
    wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    }
}

/// Placeholder resources, bound where a shade has none of its own.
pub(super) struct Blank {
    pub(super) uniform: wgpu::Buffer,
    pub(super) image: wgpu::TextureView,
}

impl Blank {
    pub(super) fn new(device: &wgpu::Device) -> Self {
        Self {
            uniform: uniform_buffer(device, &[0; 16]),
            image: device.create_texture(&image_texture("no image", 1, 1)).create_view(&Default::default()),
        }
    }
}
