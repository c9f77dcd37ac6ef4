//! Materials on the GPU.

use super::context::GpuContext;
use crate::error::HarnessError;
use crate::geometry::{MaterialTable, MaterialUniform, material_table};
use crate::plan::Plan;
use crate::scene::Scene;
use crate::texture::MipMapped;
use npr_mesh::{Texture, Wrap};
use npr_outline::filled_buffer::filled_buffer;
use std::sync::Arc;
use wgpu::util::DeviceExt;

/// The material uniforms and textures. They share one bind group per pair of textures and use dynamic offsets: with one bind
/// group per material, the driver's own memory would reach gigabytes for 40,000 materials.
pub(super) struct Materials {
    /// Per material: the first material with the same appearance.
    pub(super) duplicates: Vec<usize>,
    /// One bind group per pair of textures, each with the uniforms of all materials.
    groups: Vec<wgpu::BindGroup>,
    /// Per material: the index of its group and its offset in the uniform buffer, bytes.
    places: Vec<(usize, u32)>,
}

impl Materials {
    pub(super) fn new(
        context: &GpuContext,
        layout: &wgpu::BindGroupLayout,
        scene: &Scene,
        plan: &Plan,
    ) -> Result<Self, HarnessError> {
        materials(context, layout, scene, plan)
    }

    /// Binds a material for the following draws.
    pub(super) fn bind(&self, pass: &mut wgpu::RenderPass<'_>, material: usize) {
        let (group, offset) = self.places[material];
        pass.set_bind_group(1, &self.groups[group], &[offset]);
    }
}

/// `uniforms` holds the uniforms of all materials; the dynamic offset selects one.
fn material_group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    uniforms: &wgpu::Buffer,
    [(texture, sampler), (emissive_texture, emissive_sampler)]: [&Uploaded; 2],
) -> wgpu::BindGroup {
    let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
    let size = wgpu::BufferSize::new(size_of::<MaterialUniform>() as u64);
    let uniform = wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer: uniforms, offset: 0, size });
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("material"),
        layout,
        entries: &[
            entry(0, uniform),
            entry(1, wgpu::BindingResource::TextureView(texture)),
            entry(2, wgpu::BindingResource::Sampler(sampler)),
            entry(3, wgpu::BindingResource::TextureView(emissive_texture)),
            entry(4, wgpu::BindingResource::Sampler(emissive_sampler)),
        ],
    })
}

pub(super) fn buffer(
    context: &GpuContext,
    what: &'static str,
    contents: &[u8],
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, HarnessError> {
    let (bytes, limit) = (contents.len() as u64, context.device.limits().max_buffer_size);
    if bytes > limit {
        return Err(HarnessError::BufferTooLarge { what, bytes, limit });
    }
    Ok(filled_buffer(&context.device, what, contents, usage))
}

fn materials(
    context: &GpuContext,
    layout: &wgpu::BindGroupLayout,
    scene: &Scene,
    plan: &Plan,
) -> Result<Materials, HarnessError> {
    let white = Texture {
        name: "white".into(),
        width: 1,
        height: 1,
        rgba8: Arc::from([255; 4]),
        wrap: [Wrap::Clamp; 2],
        smooth: true,
    };
    let read = scene.textures().iter().zip(&plan.textures).filter_map(|(texture, &used)| used.then_some(texture));
    let upload = |texture| upload_texture(context, texture);
    let textures: Vec<_> = read.chain([&white]).map(upload).collect::<Result<_, _>>()?;
    // Dynamic offsets must be multiples of the device's alignment.
    let MaterialTable { duplicates, pairs, places, uniforms } =
        material_table(scene, plan, context.capabilities.uniform_alignment as usize);
    if u32::try_from(uniforms.len()).is_err() {
        let bytes = uniforms.len() as u64;
        return Err(HarnessError::BufferTooLarge { what: "materials", bytes, limit: u32::MAX.into() });
    }
    let uniforms = buffer(context, "materials", &uniforms, wgpu::BufferUsages::UNIFORM)?;
    let group = |pair: &[usize; 2]| material_group(&context.device, layout, &uniforms, pair.map(|of| &textures[of]));
    Ok(Materials { duplicates, groups: pairs.iter().map(group).collect(), places })
}

/// A texture with its mip levels, and its sampler.
type Uploaded = (wgpu::TextureView, wgpu::Sampler);

fn upload_texture(context: &GpuContext, texture: &Texture) -> Result<Uploaded, HarnessError> {
    let levels = MipMapped::new(texture).levels;
    context.capabilities.check_size("a texture of the model", (texture.width, texture.height))?;
    let (width, height) = (texture.width, texture.height);
    let mut bytes = Vec::new();
    // The sizes of the levels are halved and rounded down, exactly as in `MipMapped`.
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
    Ok((uploaded.create_view(&Default::default()), sampler))
}
