//! A scene on the device.

use super::hatch::HatchTextures;
use super::shadow::ShadowCasting;
use super::surface::{MaterialUniform, SurfacePass};
use super::{Capabilities, GpuContext, GpuError};
use crate::hatch::HatchVertex;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::texture::MipMapped;
use bytemuck::Zeroable;
use glam::Vec4;
use npr_mesh::{AlphaMode, Texture, Wrap};
use npr_outline::filled_buffer::filled_buffer;
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use wgpu::util::DeviceExt;

/// On a software adapter, see [`GpuError::TooManyDraws`].
const SOFTWARE_DRAWS: usize = 2048;

/// Faces of one material, or of several that look alike, drawn by one call.
pub(super) struct Batch {
    /// The first of them.
    pub(super) material: usize,
    pub(super) indices: Range<u32>,
}

/// What of a scene stays the same from frame to frame.
pub struct GpuScene {
    /// Position and normal, interleaved.
    pub(super) vertices: wgpu::Buffer,
    /// Texture coordinate and colour, where any surface looks one up.
    pub(super) lookups: Option<wgpu::Buffer>,
    /// Per vertex its region, where lines are found in the image.
    pub(super) regions: Option<wgpu::Buffer>,
    /// Faces that are not blended, by material.
    pub(super) indices: Option<wgpu::Buffer>,
    pub(super) batches: Vec<Batch>,
    /// Faces that are blended; sorted anew for each view.
    pub(super) blended_faces: Vec<u32>,
    pub(super) materials: Materials,
    /// How many draws a pass may take.
    pub(super) most_draws: usize,
    /// Edges, where lines are found on the device.
    pub(super) edges: Option<npr_outline::line_pass::EdgesOnDevice>,
    /// Fins for all edges, where the printed form is drawn.
    pub(super) fins: Option<npr_outline::fin_pass::FinsOnDevice>,
    /// What casts shadows, where volumes are drawn.
    pub(super) casting: Option<ShadowCasting>,
    /// What tells where strokes lie, per vertex, and their map, where surfaces are hatched.
    pub(super) hatch: Option<(wgpu::Buffer, HatchTextures)>,
}

/// What surfaces are made of. A bind group of its own for each material would take what a device's driver keeps for each,
/// which with 40,000 of them is gigabytes.
pub(super) struct Materials {
    /// Per material the first one that looks the same.
    pub(super) alike: Vec<usize>,
    /// Per texture, and last for none, with all materials in the uniform buffer.
    groups: Vec<wgpu::BindGroup>,
    /// Per material its group, and where it lies in the uniform buffer, bytes.
    places: Vec<(usize, u32)>,
}

impl Materials {
    /// Binds a material's for the following draws.
    pub(super) fn bind(&self, pass: &mut wgpu::RenderPass<'_>, material: usize) {
        let (group, offset) = self.places[material];
        pass.set_bind_group(1, &self.groups[group], &[offset]);
    }
}

/// Whether a material's colour differs from pixel to pixel, or its alpha decides.
pub(super) fn is_looked_up(scene: &Scene, material: usize) -> bool {
    let m = &scene.model.materials[material];
    m.texture.is_some() || !scene.model.colors.is_empty() || matches!(m.alpha_mode, AlphaMode::Mask { .. })
}

impl GpuScene {
    pub(super) fn new(
        context: &GpuContext,
        capabilities: &Capabilities,
        pass: &SurfacePass,
        scene: &Scene,
        plan: &Plan,
    ) -> Result<Self, GpuError> {
        let model = &scene.model;
        let buffer = |what, contents: &[u8], usage| buffer(context, what, contents, usage);
        let split =
            plan.image.as_ref().map(|image| split_by_region(&model.faces, &image.face_region, model.positions.len()));
        let more: &[u32] = split.as_ref().map_or(&[], |split| &split.more);
        // All vertices, and again those that stand in several regions.
        let sources = || (0..model.positions.len()).chain(more.iter().map(|&vertex| vertex as usize));
        let vertices: Vec<[f32; 6]> = sources()
            .map(|i| {
                let (p, n) = (model.positions[i], model.normals[i]);
                [p.x, p.y, p.z, n.x, n.y, n.z]
            })
            .collect();
        let vertices = buffer("vertices", bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX)?;
        let lookups = if plan.looks_up() || plan.lit {
            let lookups: Vec<[f32; 6]> = sources()
                .map(|i| {
                    let uv = model.uvs.get(i).copied().unwrap_or_default();
                    let color = model.colors.get(i).copied().unwrap_or(Vec4::ONE);
                    [uv.x, uv.y, color.x, color.y, color.z, color.w]
                })
                .collect();
            Some(buffer("texture coordinates and colours", bytemuck::cast_slice(&lookups), wgpu::BufferUsages::VERTEX)?)
        } else {
            None
        };
        let no_regions = (split.is_none() && plan.lit).then(|| vec![0u32; model.positions.len()]);
        let regions = match split.as_ref().map(|split| &split.regions).or(no_regions.as_ref()) {
            Some(regions) => Some(buffer("regions", bytemuck::cast_slice(regions), wgpu::BufferUsages::VERTEX)?),
            None => None,
        };
        let hatch = match &plan.hatch {
            Some(hatch) => {
                let vertex = |i: usize| hatch.vertices.get(i).copied().unwrap_or(HatchVertex::zeroed());
                let vertices: Vec<HatchVertex> = sources().map(vertex).collect();
                let vertices = buffer("strokes", bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX)?;
                Some((vertices, HatchTextures::new(context, capabilities, hatch)?))
            }
            None => None,
        };
        let faces = split.as_ref().map_or(&model.faces, |split| &split.faces);
        let materials = materials(context, capabilities, pass, scene, plan)?;
        let (indices, batches, blended_faces) = batches(scene, faces, &materials.alike);
        let indices = if indices.is_empty() {
            None
        } else {
            Some(buffer("faces", bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX)?)
        };
        Ok(Self {
            vertices,
            lookups,
            regions,
            indices,
            batches,
            blended_faces,
            materials,
            most_draws: if capabilities.software { SOFTWARE_DRAWS } else { usize::MAX },
            edges: None,
            fins: None,
            casting: None,
            hatch,
        })
    }
}

fn buffer(
    context: &GpuContext,
    what: &'static str,
    contents: &[u8],
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, GpuError> {
    let (bytes, limit) = (contents.len() as u64, context.device.limits().max_buffer_size);
    if bytes > limit {
        return Err(GpuError::BufferTooLarge { what, bytes, limit });
    }
    Ok(filled_buffer(&context.device, what, contents, usage))
}

/// Faces whose vertices are each in one region.
struct Split {
    /// Of all vertices, the added ones included.
    regions: Vec<u32>,
    /// The vertices that are added, by what they repeat.
    more: Vec<u32>,
    faces: Vec<[u32; 3]>,
}

/// Gives each vertex the region of its first face, and the others' faces vertices of their own.
fn split_by_region(faces: &[[u32; 3]], face_region: &[u32], vertices: usize) -> Split {
    let mut split = Split { regions: vec![0; vertices], more: Vec::new(), faces: Vec::with_capacity(faces.len()) };
    let mut added = HashMap::new();
    for (face, &region) in faces.iter().zip(face_region) {
        split.faces.push(face.map(|vertex| {
            let first = &mut split.regions[vertex as usize];
            if *first == 0 {
                *first = region;
            }
            if *first == region {
                return vertex;
            }
            *added.entry((vertex, region)).or_insert_with(|| {
                split.more.push(vertex);
                (vertices + split.more.len() - 1) as u32
            })
        }));
    }
    split.regions.resize(vertices + split.more.len(), 0);
    for ((_, region), vertex) in added {
        split.regions[vertex as usize] = region;
    }
    split
}

fn batches(scene: &Scene, faces: &[[u32; 3]], alike: &[usize]) -> (Vec<u32>, Vec<Batch>, Vec<u32>) {
    let model = &scene.model;
    let alike = |face: u32| alike[model.face_material[face as usize] as usize];
    let is_blended =
        |face: u32| model.materials[model.face_material[face as usize] as usize].alpha_mode == AlphaMode::Blend;
    let (blended, mut solid): (Vec<u32>, Vec<u32>) = (0..model.faces.len() as u32).partition(|&f| is_blended(f));
    // Stable, so that the faces of a material keep the order of the file, whose neighbours share vertices.
    solid.sort_by_key(|&face| alike(face));
    // Behind a face with the same corners, drawn before, none passes the depth test; a file with half a million of them
    // is to be drawn all the same. Where alpha cuts out, the first may leave the second to be seen.
    if !scene.edges.further_faces.is_empty() || scene.edges.skipped.iter().any(|&skipped| skipped) {
        let mut seen = HashSet::new();
        solid.retain(|&face| {
            let corners = model.faces[face as usize].map(|v| scene.edges.representative[v as usize]);
            let material = alike(face);
            matches!(model.materials[material].alpha_mode, AlphaMode::Mask { .. }) || seen.insert((material, corners))
        });
    }
    let mut batches: Vec<Batch> = Vec::new();
    let mut indices = Vec::with_capacity(3 * solid.len());
    for face in solid {
        let material = alike(face);
        let start = indices.len() as u32;
        indices.extend(faces[face as usize]);
        match batches.last_mut() {
            Some(batch) if batch.material == material => batch.indices.end += 3,
            _ => batches.push(Batch { material, indices: start..start + 3 }),
        }
    }
    (indices, batches, blended)
}

fn materials(
    context: &GpuContext,
    capabilities: &Capabilities,
    pass: &SurfacePass,
    scene: &Scene,
    plan: &Plan,
) -> Result<Materials, GpuError> {
    let white = Texture {
        name: "white".into(),
        width: 1,
        height: 1,
        rgba8: vec![255; 4],
        wrap: [Wrap::Clamp; 2],
        smooth: true,
    };
    let of_model: &[Texture] = if plan.looks_up() { &scene.model.textures } else { &[] };
    let upload = |texture| upload_texture(context, capabilities, texture);
    let textures: Vec<_> = of_model.iter().chain([&white]).map(upload).collect::<Result<_, _>>()?;
    // A uniform's dynamic offset is a multiple of this.
    let stride = size_of::<MaterialUniform>()
        .next_multiple_of(context.device.limits().min_uniform_buffer_offset_alignment as usize);
    let mut uniforms: Vec<u8> = Vec::new();
    let mut first: HashMap<_, usize> = HashMap::new();
    let (mut alike, mut places) = (Vec::new(), Vec::new());
    for (number, material) in scene.model.materials.iter().enumerate() {
        let group = material.texture.map(|t| t as usize).filter(|&t| t < of_model.len()).unwrap_or(of_model.len());
        let (_, _, size, levels) = &textures[group];
        let cutoff = if let AlphaMode::Mask { cutoff } = material.alpha_mode { cutoff } else { f32::MIN };
        let base_color = if is_looked_up(scene, number) {
            material.base_color
        } else {
            scene.material_colors[number].as_vec3().extend(material.base_color.w)
        };
        let uniform = MaterialUniform {
            base_color: base_color.to_array(),
            texture_size: *size,
            last_level: (*levels - 1) as f32,
            cutoff,
            wrap: material.texture.map_or([0; 2], |t| scene.model.textures[t as usize].wrap.map(|wrap| wrap as u32)),
            padding: [0; 2],
        };
        let bytes: [u8; size_of::<MaterialUniform>()] = bytemuck::cast(uniform);
        // What a draw's pipeline depends on besides.
        let line_kind = plan.image.as_ref().and_then(|image| image.line_kinds.get(number)).map(|&kind| kind as u32);
        let is_blended = material.alpha_mode == AlphaMode::Blend;
        let look = (bytes, material.texture, material.double_sided, is_looked_up(scene, number), is_blended, line_kind);
        let same = *first.entry(look).or_insert(number);
        alike.push(same);
        if same == number {
            let offset = u32::try_from(uniforms.len()).map_err(|_| GpuError::BufferTooLarge {
                what: "materials",
                bytes: uniforms.len() as u64,
                limit: u32::MAX.into(),
            })?;
            places.push((group, offset));
            uniforms.extend(bytes);
            uniforms.resize(uniforms.len().next_multiple_of(stride), 0);
        } else {
            places.push(places[same]);
        }
    }
    if uniforms.is_empty() {
        uniforms.resize(stride, 0);
    }
    let uniforms = buffer(context, "materials", &uniforms, wgpu::BufferUsages::UNIFORM)?;
    let group = |(view, sampler, _, _): &_| pass.material_group(&context.device, &uniforms, view, sampler);
    Ok(Materials { alike, groups: textures.iter().map(group).collect(), places })
}

/// A texture with its mip levels, what it is read with, its size and its number of levels.
type Uploaded = (wgpu::TextureView, wgpu::Sampler, [f32; 2], u32);

fn upload_texture(context: &GpuContext, capabilities: &Capabilities, texture: &Texture) -> Result<Uploaded, GpuError> {
    let levels = MipMapped::new(texture).levels;
    capabilities.check_size("a texture of the model", (texture.width, texture.height))?;
    let (width, height) = (texture.width, texture.height);
    let mut bytes = Vec::new();
    // A texture's levels halve, rounding down, exactly as those of `MipMapped` do.
    for (_, _, level) in &levels {
        bytes.extend_from_slice(level);
    }
    let uploaded = context.device.create_texture_with_data(
        &context.queue,
        &wgpu::TextureDescriptor {
            label: Some(&texture.name),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: levels.len() as u32,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8UnormSrgb,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        wgpu::util::TextureDataOrder::LayerMajor,
        &bytes,
    );
    let address = |wrap| match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
        Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
    };
    let sampler = context.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some(&texture.name),
        address_mode_u: address(texture.wrap[0]),
        address_mode_v: address(texture.wrap[1]),
        mag_filter: if texture.smooth { wgpu::FilterMode::Linear } else { wgpu::FilterMode::Nearest },
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    });
    Ok((uploaded.create_view(&Default::default()), sampler, [width as f32, height as f32], levels.len() as u32))
}
