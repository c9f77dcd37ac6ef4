//! The geometry pass.

use super::ground::{self, GroundOnDevice};
use super::instances::{Constant, INSTANCE_ATTRIBUTES, constant, instance_layout};
use super::scene::GpuScene;
use super::shader::{Blank, LightOnDevice, ShaderKey, assemble};
use super::targets::COLOR_FORMAT;
use super::uniform::uniform_buffer;
use crate::camera::Camera;
use crate::error::HarnessError;
use crate::geometry::{
    COLOR_BYTES, DIRECTION_BYTES, NORMAL_BYTES, OCTAVE_BYTES, POSITION_BYTES, REGION_BYTES, Streams, UV_BYTES,
    is_looked_up,
};
use crate::hatch::gpu::{HatchTextures, HatchUniform};
use crate::image_lines::gbuffer::targets::TEXEL_FORMAT;
use crate::image_lines::plan::ImagePlan;
use crate::plan::{Emission, PaintPlan, Plan};
use crate::scene::Scene;
use crate::scene::opacity::Hides;
use crate::shade::flag;
use crate::shadow::ShadowLines;
use crate::shadow::gpu::{BlankShadow, MAP_BIAS, ShadowOnDevice};
use glam::{DVec2, DVec3, DVec4};
use npr_imagespace::artist::{ArtistRotation, LineKind};
use npr_imagespace::format::texel::{DepthCode, TexelLayout};
use npr_imagespace::pass::fused::texel_format;
use npr_mesh::AlphaMode;
use npr_outline::filled_buffer::filled_buffer;
use npr_toon::painter::PainterUniform;
use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::num::NonZeroU64;
use std::ops::Range;

/// `SurfaceView` of `surface.wgsl`.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct SurfaceUniform {
    clip_from_world: [[f32; 4]; 4],
    to_eye: [f32; 4],
    to_eye_dx: [f32; 4],
    to_eye_dy: [f32; 4],
    eye: [f32; 4],
    clip_px: [f32; 4],
}

impl SurfaceUniform {
    /// For targets of a size; quantities per px refer to the pixels of these targets.
    fn new(scene: &Scene, camera: &Camera, size_px: DVec2) -> Self {
        // The vector from the surface towards the eye, opposite to the pixel's ray: a linear function of the pixel.
        let against = |x, y| -camera.ray(DVec2::new(x, y), size_px).1;
        let to_eye = against(0.0, 0.0);
        let column = |vector: DVec3| vector.as_vec3().extend(0.0).to_array();
        Self {
            clip_from_world: camera.clip_from_world(size_px.x / size_px.y).as_mat4().to_cols_array_2d(),
            to_eye: column(to_eye),
            to_eye_dx: column(against(1.0, 0.0) - to_eye),
            to_eye_dy: column(against(0.0, 1.0) - to_eye),
            eye: camera.homogeneous_eye().as_vec4().to_array(),
            clip_px: scene.clip.map_or(DVec4::ONE, |plane| camera.plane_px(plane, size_px)).as_vec4().to_array(),
        }
    }
}

/// `SurfaceInk` of `surface.wgsl`.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct InkUniform {
    code: DepthCode,
    right: [f32; 4],
    up: [f32; 4],
    back: [f32; 4],
    region_max: u32,
    padding0: u32,
    padding1: u32,
    padding2: u32,
}

impl InkUniform {
    fn new(image: &ImagePlan, camera: &Camera) -> Self {
        let axis = |axis: DVec3| axis.as_vec3().extend(0.0).to_array();
        let [right, up, back] = camera.axes().map(axis);
        Self {
            code: image.buffer_code(camera),
            right,
            up,
            back,
            region_max: image.regions.most,
            padding0: 0,
            padding1: 0,
            padding2: 0,
        }
    }
}

/// How a batch's fragments are shaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Paint {
    /// No colour is written.
    Nothing,
    /// Shaded by light whose direction is constant; only the normal varies.
    Painted,
    /// Shaded by light that varies over a face.
    Lit,
    /// Hatched with strokes.
    Hatched,
    /// The alpha of see-through surfaces.
    Veil,
}

/// The G-buffer output of a fragment, for lines in the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Inking {
    layout: TexelLayout,
    /// Whether texels are unquantised.
    unquantised: bool,
    line_kind: LineKind,
    rotation: ArtistRotation,
    region_of_texture: bool,
}

/// Faces of one material, of one or several objects.
struct Drawn<'a> {
    material: usize,
    /// Whether only fronts are shown, whatever the material says.
    one_sided: bool,
    indices: Range<u32>,
    instances: wgpu::BufferSlice<'a>,
    count: u32,
    mirrored: bool,
    /// The index of the pair of lights.
    lights: u32,
}

/// The render targets of the pass: depth, and optionally colour and G-buffer texels.
#[derive(Clone, Copy)]
pub(super) struct SurfaceTargets<'a> {
    pub(super) color: Option<&'a wgpu::TextureView>,
    pub(super) texels: Option<&'a wgpu::TextureView>,
    pub(super) depth: &'a wgpu::TextureView,
    pub(super) size_px: DVec2,
    /// The number of these pixels per picture pixel, along each axis.
    pub(super) samples: u32,
    pub(super) purpose: Purpose<'a>,
}

/// What surfaces are drawn for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Purpose<'a> {
    /// A picture, or its lines.
    Picture,
    /// The surfaces that shadows fall on: no blended ones.
    Receivers,
    /// The surfaces that cast shadows, from the light: none is culled or clipped away.
    Casters(Camera),
    /// A layer of blended surfaces with an alpha below 0.5: their nearest, or the nearest behind a layer, of which this is
    /// the depth. Their alpha is written as a colour.
    Veils(Option<&'a wgpu::TextureView>),
}

/// Which faces a draw has, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Layer {
    /// Unblended faces.
    Solid,
    /// Blended faces, over what is drawn.
    Blended,
    /// Blended faces where they hide lines behind them or cast shadows, into depth and G-buffer.
    Hiding,
}

/// The properties that distinguish one pipeline from another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Variant {
    paint: Paint,
    looked_up: bool,
    by_alpha: bool,
    emission: Emission,
    cull_back: bool,
    mirrored: bool,
    blended: bool,
    cut_out: bool,
    hiding: bool,
    /// Whether only what is behind a layer of see-through surfaces is drawn.
    behind_layer: bool,
    /// Whether depth is biased away from the light, in a shadow map.
    biased: bool,
    /// The index of the shader in [`SurfacePass::shaders`].
    shader: usize,
    shadow: ShadowVariant,
    /// The format of the depth buffer.
    depth: wgpu::TextureFormat,
    /// The attributes of vertices that have buffers.
    streams: Streams,
    /// Whether there is a colour target, even if it is not written.
    colored: bool,
    clipped: bool,
    mesh_normals: bool,
    inking: Option<Inking>,
    /// Whether the ground is drawn.
    ground: bool,
}

/// The source of a fragment's shadow, and how lines in the image use it: the override constants of `shadow.wgsl`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
struct ShadowVariant {
    source: u32,
    lines: u32,
}

impl ShadowVariant {
    fn new(plan: &Plan, shadow: Option<&ShadowOnDevice>) -> Self {
        let Some(shadow) = shadow else { return Self::default() };
        let lines = plan.image.as_ref().map_or(ShadowLines::None, |image| image.ink.shadows);
        Self {
            source: if shadow.mask.is_some() { 1 } else { 2 },
            lines: match lines {
                ShadowLines::None => 0,
                ShadowLines::Lines | ShadowLines::Separate { .. } => 1,
                ShadowLines::Negated => 2,
            },
        }
    }
}

/// The pipelines of the geometry pass.
pub(super) struct SurfacePass {
    /// Created on first use.
    shaders: RefCell<Vec<(ShaderKey, wgpu::ShaderModule)>>,
    view_layout: wgpu::BindGroupLayout,
    material_layout: wgpu::BindGroupLayout,
    layout: wgpu::PipelineLayout,
    blank: Blank,
    no_strokes: HatchTextures,
    no_shadow: BlankShadow,
    pipelines: RefCell<HashMap<Variant, wgpu::RenderPipeline>>,
}

/// The data of a picture's surfaces that do not depend on the targets.
#[derive(Clone, Copy)]
pub(super) struct SurfaceFrame<'a> {
    pub(super) device: &'a wgpu::Device,
    pub(super) scene: &'a Scene,
    pub(super) uploaded: &'a GpuScene,
    pub(super) plan: &'a Plan,
    pub(super) light: &'a LightOnDevice,
}

impl SurfacePass {
    pub(super) fn new(device: &wgpu::Device) -> Self {
        let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let one_of = |binding, has_dynamic_offset| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: both,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset,
                min_binding_size: None,
            },
            count: None,
        };
        let uniform = |binding| one_of(binding, false);
        let fragment = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let texture = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let words = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Uint,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let depth = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let numbers = depth;
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let nearest = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering);
        let layout = |label, entries: &[_]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        let view_layout = layout(
            "surface view",
            &[
                uniform(0),
                uniform(1),
                uniform(2),
                one_of(3, true),
                fragment(4, texture),
                uniform(5),
                fragment(6, texture),
                fragment(7, texture),
                fragment(8, sampler),
                fragment(9, texture),
                uniform(10),
                fragment(11, words),
                fragment(12, depth),
                fragment(13, nearest),
                wgpu::BindGroupLayoutEntry { visibility: wgpu::ShaderStages::VERTEX, ..fragment(14, numbers) },
            ],
        );
        let material_layout = layout(
            "surface material",
            &[one_of(0, true), fragment(1, texture), fragment(2, sampler), fragment(3, texture), fragment(4, sampler)],
        );
        Self {
            shaders: RefCell::default(),
            layout: device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("surface"),
                bind_group_layouts: &[Some(&view_layout), Some(&material_layout)],
                immediate_size: 0,
            }),
            view_layout,
            material_layout,
            blank: Blank::new(device),
            no_strokes: HatchTextures::blank(device),
            no_shadow: BlankShadow::new(device),
            pipelines: RefCell::default(),
        }
    }

    pub(super) fn material_layout(&self) -> &wgpu::BindGroupLayout {
        &self.material_layout
    }

    /// The index of a shader, which is created if it does not exist.
    fn shader(&self, device: &wgpu::Device, key: &ShaderKey) -> usize {
        let mut shaders = self.shaders.borrow_mut();
        if let Some(known) = shaders.iter().position(|(known, _)| known == key) {
            return known;
        }
        // Shaders that differ only in their override constants share a module.
        let same = shaders.iter().find(|(known, _)| known.parts == key.parts).map(|(_, module)| module.clone());
        let module = same.unwrap_or_else(|| {
            device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("surface"),
                source: wgpu::ShaderSource::Wgsl(assemble(&key.parts).into()),
            })
        });
        shaders.push((key.clone(), module));
        shaders.len() - 1
    }

    /// Draws surfaces into targets. `shadow` holds the shadows computed for these targets.
    pub(super) fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &SurfaceFrame<'_>,
        shadow: Option<&ShadowOnDevice>,
        targets: &SurfaceTargets<'_>,
    ) -> Result<(), HarnessError> {
        let SurfaceFrame { device, scene, uploaded, plan, light } = *frame;
        let camera = match &targets.purpose {
            Purpose::Casters(camera) => camera,
            Purpose::Picture | Purpose::Receivers | Purpose::Veils(_) => &plan.view.camera,
        };
        let casts = matches!(targets.purpose, Purpose::Casters(_));
        // The depth of the layer before is bound in place of a shadow map, which no such pass reads.
        let (is_veil, layer_before) = match targets.purpose {
            Purpose::Veils(before) => (true, before),
            _ => (false, None),
        };
        let shader = self.shader(device, &light.key);
        let ink = plan.image.as_ref().map_or_else(bytemuck::Zeroable::zeroed, |image| InkUniform::new(image, camera));
        let view = uniform_buffer(device, bytemuck::bytes_of(&SurfaceUniform::new(scene, camera, targets.size_px)));
        let ink = uniform_buffer(device, bytemuck::bytes_of(&ink));
        let shade_image = light.image.as_ref().unwrap_or(&self.blank.image);
        let hatch_uniform = match plan.hatch() {
            Some(hatch) => {
                let uniform = HatchUniform::new(hatch, plan.paper, targets.samples)?;
                Some(uniform_buffer(device, bytemuck::bytes_of(&uniform)))
            }
            None => None,
        };
        let strokes = uploaded.hatch.as_ref().unwrap_or(&self.no_strokes);
        let bound = [
            view.as_entire_binding(),
            light.shade.as_ref().unwrap_or(&self.blank.uniform).as_entire_binding(),
            ink.as_entire_binding(),
            wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &light.lights,
                offset: 0,
                size: NonZeroU64::new(size_of::<PainterUniform>() as u64),
            }),
            wgpu::BindingResource::TextureView(shade_image),
            hatch_uniform.as_ref().unwrap_or(&strokes.blank).as_entire_binding(),
            wgpu::BindingResource::TextureView(&strokes.light),
            wgpu::BindingResource::TextureView(&strokes.dark),
            wgpu::BindingResource::Sampler(&strokes.sampler),
            wgpu::BindingResource::TextureView(&strokes.thresholds),
            shadow.map_or(&self.no_shadow.uniform, |shadow| &shadow.uniform).as_entire_binding(),
            wgpu::BindingResource::TextureView(
                shadow.and_then(|shadow| shadow.mask.as_ref()).unwrap_or(&self.no_shadow.mask),
            ),
            wgpu::BindingResource::TextureView(
                shadow.and_then(|shadow| shadow.map.as_ref()).or(layer_before).unwrap_or(&self.no_shadow.map),
            ),
            wgpu::BindingResource::Sampler(&self.no_shadow.nearest),
            wgpu::BindingResource::TextureView(uploaded.facets.as_ref().unwrap_or(&self.blank.image)),
        ];
        let entry = |(binding, resource)| wgpu::BindGroupEntry { binding, resource };
        let entries: Vec<_> = (0..).zip(bound).map(entry).collect();
        let view_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("surface view"),
            layout: &self.view_layout,
            entries: &entries,
        });
        let paint = match &plan.paint {
            _ if is_veil => Paint::Veil,
            Some(paint) if targets.color.is_some() => match (&paint.hatch, paint.interpolates_light) {
                (Some(_), _) => Paint::Hatched,
                (None, true) => Paint::Lit,
                (None, false) => Paint::Painted,
            },
            _ => Paint::Nothing,
        };
        let shows_colors = plan.paint.as_ref().is_some_and(PaintPlan::shows_surface_color);
        let by_alpha = plan.paint.as_ref().is_some_and(|paint| paint.shade.model().material_by_alpha());
        let blended = if plan.blended && !matches!(paint, Paint::Nothing | Paint::Veil) {
            back_to_front(scene, &uploaded.blended_faces, camera)
        } else {
            Vec::new()
        };
        let instances = uploaded.instances.borrow();
        let duplicates = &uploaded.materials.duplicates;
        let look = |&[object, face]: &[u32; 2]| {
            let one_sided = scene.placed(object).1.model().is_one_sided(face);
            (object, duplicates[scene.material_number(object, face)], one_sided)
        };
        let hiding = match targets.purpose {
            Purpose::Picture if !plan.blended_hide => Vec::new(),
            Purpose::Receivers => Vec::new(),
            _ => {
                let is_drawn = |&[object, face]: &[u32; 2]| {
                    let material = scene.material_number(object, face);
                    if is_veil { scene.veils(material) } else { scene.hides(material) != Hides::Nothing }
                };
                let mut faces: Vec<[u32; 2]> = uploaded.blended_faces.iter().copied().filter(is_drawn).collect();
                faces.sort_by_key(look);
                faces
            }
        };
        let blended_runs: Vec<&[[u32; 2]]> = blended.chunk_by(|a, b| look(a) == look(b)).collect();
        let hiding_runs: Vec<&[[u32; 2]]> = hiding.chunk_by(|a, b| look(a) == look(b)).collect();
        let solid_draws: usize = instances.runs().iter().map(|run| uploaded.batches[run.mesh].len()).sum();
        let (draws, limit) = (solid_draws + blended_runs.len() + hiding_runs.len(), uploaded.most_draws);
        if draws > limit {
            return Err(HarnessError::TooManyDraws { draws, limit });
        }
        let index_buffer = |faces: &[[u32; 2]]| {
            (!faces.is_empty()).then(|| {
                let faces: Vec<_> = faces.iter().map(|&face| uploaded.face_vertices(scene, face)).collect();
                let indices = uploaded.index_format.bytes(faces.as_flattened());
                filled_buffer(device, "blended faces", &indices, wgpu::BufferUsages::INDEX)
            })
        };
        let (blended_indices, hiding_indices) = (index_buffer(&blended), index_buffer(&hiding));
        let paper = paper(plan);
        let bound = (&view_group, uploaded, targets.depth);
        let paired = !plan.object_pairs().is_empty();
        // The pipeline that is set.
        let set = Cell::new(None);
        let draw = |pass: &mut wgpu::RenderPass<'_>, drawn: Drawn<'_>, colored: bool, layer: Layer| {
            let material = &scene.materials()[drawn.material];
            let (blended, hiding) = (layer == Layer::Blended, layer == Layer::Hiding);
            let paint = if hiding && !is_veil { Paint::Nothing } else { paint };
            // Blended surfaces write texels where they hide, apart from their colours.
            let inking = plan.image.as_ref().filter(|_| targets.texels.is_some() && !blended).map(|image| {
                let line_kind = image.line_kinds[drawn.material];
                Inking {
                    layout: image.ink.layout,
                    unquantised: image.gbuffer.is_some(),
                    line_kind,
                    rotation: image.artist_rotation(drawn.material),
                    region_of_texture: line_kind == LineKind::Regions && material.texture.is_some(),
                }
            });
            let wanted = paint != Paint::Nothing && (shows_colors || blended)
                || plan.cut_out
                || hiding && (is_veil || scene.hides(drawn.material) == Hides::Partly)
                || inking.is_some_and(|inking| inking.line_kind != LineKind::Normals);
            let variant = Variant {
                paint,
                looked_up: is_looked_up(scene, plan, drawn.material) && wanted,
                by_alpha: by_alpha && material.texture.is_some(),
                emission: match paint {
                    Paint::Nothing | Paint::Veil => Emission::None,
                    _ => plan.emission(material),
                },
                cull_back: !casts && (plan.cull_back || drawn.one_sided || !material.double_sided),
                mirrored: drawn.mirrored,
                blended,
                cut_out: matches!(material.alpha_mode, AlphaMode::Mask { .. }),
                hiding,
                behind_layer: layer_before.is_some(),
                biased: casts,
                shader,
                // Blended surfaces receive no shadows: the stencil was counted against the surfaces behind them.
                shadow: match layer {
                    Layer::Solid => ShadowVariant::new(plan, shadow),
                    Layer::Blended => ShadowVariant::default(),
                    Layer::Hiding => ShadowVariant { source: 0, ..ShadowVariant::new(plan, shadow) },
                },
                depth: targets.depth.texture().format(),
                streams: uploaded.streams.present,
                colored,
                clipped: !casts && scene.clip.is_some(),
                mesh_normals: plan.mesh_normals,
                inking,
                ground: false,
            };
            let indices = match layer {
                Layer::Solid => &uploaded.indices,
                Layer::Blended => &blended_indices,
                Layer::Hiding => &hiding_indices,
            };
            let Some(indices) = indices else { return };
            if set.get() != Some(variant) {
                let mut pipelines = self.pipelines.borrow_mut();
                pass.set_pipeline(pipelines.entry(variant).or_insert_with(|| self.pipeline(device, variant)));
                pass.set_index_buffer(indices.slice(..), uploaded.index_format.on_device());
                set.set(Some(variant));
            }
            if paired {
                pass.set_bind_group(0, &view_group, &[drawn.lights * light.stride]);
            }
            uploaded.materials.bind(pass, drawn.material);
            pass.set_vertex_buffer(INSTANCE_SLOT, drawn.instances);
            pass.draw_indexed(drawn.indices, 0, 0..drawn.count);
        };
        // WebGL2 has one write mask and one blend state for all targets of a pass. Therefore an unpainted picture is
        // cleared in a separate pass if texels are drawn, and blended surfaces, which write no texels, have a separate
        // pass.
        let colored = targets.color.is_some() && (paint != Paint::Nothing || targets.texels.is_none());
        let paper = if is_veil { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) } else { paper };
        let color = targets.color.map(|view| attachment(view, paper));
        // Zero texels denote background.
        let texels = targets.texels.map(|view| attachment(view, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT)));
        if let Some(view) = targets.color.filter(|_| !colored) {
            clear(encoder, plan, view);
        }
        let mut pass = begin(encoder, bound, [color.filter(|_| colored), texels], wgpu::LoadOp::Clear(0.0));
        for run in instances.runs().iter().filter(|_| !is_veil) {
            let (first, is_one) = run.material;
            for batch in &uploaded.batches[run.mesh] {
                let drawn = Drawn {
                    material: first + if is_one { 0 } else { batch.material },
                    one_sided: batch.one_sided,
                    indices: batch.indices.clone(),
                    instances: instances.slice(run),
                    count: run.objects.len() as u32,
                    mirrored: run.mirrored,
                    lights: run.lights,
                };
                draw(&mut pass, drawn, colored, Layer::Solid);
            }
        }
        let shows_ground = match targets.purpose {
            Purpose::Picture => shadow.is_some(),
            Purpose::Receivers => true,
            Purpose::Casters(_) | Purpose::Veils(_) => false,
        };
        if let Some(ground) = plan.ground().filter(|_| shows_ground) {
            let variant = Variant {
                paint: if paint == Paint::Painted { Paint::Lit } else { paint },
                looked_up: false,
                by_alpha: false,
                emission: Emission::None,
                cull_back: true,
                mirrored: false,
                blended: false,
                cut_out: false,
                hiding: false,
                behind_layer: false,
                biased: false,
                shader,
                shadow: ShadowVariant::new(plan, shadow),
                depth: targets.depth.texture().format(),
                streams: ground::STREAMS,
                colored,
                clipped: false,
                mesh_normals: plan.mesh_normals,
                inking: plan.image.as_ref().filter(|_| targets.texels.is_some()).map(|image| Inking {
                    layout: image.ink.layout,
                    unquantised: image.gbuffer.is_some(),
                    line_kind: LineKind::Normals,
                    rotation: ArtistRotation::PerPixel,
                    region_of_texture: false,
                }),
                ground: true,
            };
            let unread = (self.blank.image.clone(), self.no_strokes.sampler.clone());
            let on_device = GroundOnDevice::new(device, &self.material_layout, &unread, plan, ground);
            let mut pipelines = self.pipelines.borrow_mut();
            pass.set_pipeline(pipelines.entry(variant).or_insert_with(|| self.pipeline(device, variant)));
            pass.set_bind_group(0, &view_group, &[0]);
            on_device.draw(&mut pass, INSTANCE_SLOT);
            bind_vertices(&mut pass, uploaded);
            set.set(None);
        }
        if let (Some(view), Some(_), false) = (targets.color, targets.texels, blended_runs.is_empty()) {
            drop(pass);
            pass = begin(encoder, bound, [Some(attachment(view, wgpu::LoadOp::Load)), None], wgpu::LoadOp::Load);
        }
        let of_run = |run: &[[u32; 2]], start: u32| {
            let (object, material, one_sided) = look(&run[0]);
            Drawn {
                material,
                one_sided,
                indices: start..start + 3 * run.len() as u32,
                instances: instances.slice_of(object),
                count: 1,
                mirrored: scene.objects()[object as usize].is_mirrored(),
                lights: plan.object_pairs().get(object as usize).copied().unwrap_or(0),
            }
        };
        let mut start = 0;
        for run in blended_runs {
            draw(&mut pass, of_run(run, start), true, Layer::Blended);
            start += 3 * run.len() as u32;
        }
        if !hiding_runs.is_empty() && !is_veil {
            drop(pass);
            let texels = targets.texels.map(|view| attachment(view, wgpu::LoadOp::Load));
            pass = begin(encoder, bound, [None, texels], wgpu::LoadOp::Load);
        }
        let mut start = 0;
        for run in hiding_runs {
            draw(&mut pass, of_run(run, start), is_veil, Layer::Hiding);
            start += 3 * run.len() as u32;
        }
        Ok(())
    }

    fn pipeline(&self, device: &wgpu::Device, variant: Variant) -> wgpu::RenderPipeline {
        let Variant {
            paint,
            looked_up,
            by_alpha,
            emission,
            cull_back,
            mirrored,
            blended,
            colored,
            clipped,
            inking,
            ground,
            ..
        } = variant;
        let shaders = self.shaders.borrow();
        let (key, module) = &shaders[variant.shader];
        let inked = inking.is_some();
        // The ground is lit at its pixels.
        let lights_faces = key.lights_faces && !ground;
        let (vertex, fragment) = match (paint, looked_up, inked) {
            (Paint::Nothing, false, false) => ("vs_depth", if clipped { "fs_clipped" } else { "fs_nothing" }),
            (Paint::Nothing, true, false) => ("vs_textured", "fs_cut_out"),
            (Paint::Painted, false, false) => ("vs_plain", "fs_painted"),
            (Paint::Painted, true, false) => ("vs_textured", "fs_painted_textured"),
            (Paint::Lit, _, false) if lights_faces => ("vs_facet", "fs_facet"),
            (Paint::Lit, _, true) if lights_faces => ("vs_facet", "fs_facet_inked"),
            (Paint::Hatched, _, false) if lights_faces => ("vs_hatched_facet", "fs_hatched_facet"),
            (Paint::Hatched, _, true) if lights_faces => ("vs_hatched_facet", "fs_hatched_facet_inked"),
            // Shadows need the normal at the pixel.
            (Paint::Lit, false, false) if key.at_vertices && variant.shadow.source == 0 => {
                ("vs_lit_vertex", "fs_lit_vertex")
            }
            (Paint::Lit, false, false) => ("vs_lit_plain", "fs_lit_plain"),
            (Paint::Lit, true, false) => ("vs_lit", "fs_lit"),
            (Paint::Nothing, false, true) => ("vs_plain_inked", "fs_texels"),
            (Paint::Nothing, true, true) => ("vs_textured_inked", "fs_texels_textured"),
            (Paint::Painted, false, true) => ("vs_plain_inked", "fs_painted_inked"),
            (Paint::Painted, true, true) => ("vs_textured_inked", "fs_painted_textured_inked"),
            (Paint::Lit, _, true) => ("vs_lit", "fs_lit_inked"),
            (Paint::Veil, false, _) => ("vs_depth", "fs_veil"),
            (Paint::Veil, true, _) => ("vs_textured", "fs_veil_textured"),
            (Paint::Hatched, _, false) => ("vs_hatched", "fs_hatched"),
            (Paint::Hatched, _, true) => ("vs_hatched", "fs_hatched_inked"),
        };
        let hatched = paint == Paint::Hatched;
        let everything = hatched || vertex == "vs_lit" || vertex == "vs_facet";
        // The attributes that the vertex shader declares.
        let declared = Streams {
            normals: vertex != "vs_depth",
            uvs: everything || looked_up,
            colors: everything || looked_up,
            regions: everything || inked,
            directions: hatched,
            octaves: hatched,
        };
        let (streams, constants) = vertex_streams(declared, variant.streams);
        let objects: Vec<_> = INSTANCE_ATTRIBUTES.into_iter().chain(constants).collect();
        let mut buffers: Vec<_> = streams.iter().map(stream_layout).collect();
        buffers.push(Some(instance_layout(&objects)));
        let target = wgpu::ColorTargetState {
            format: COLOR_FORMAT,
            blend: blended.then_some(wgpu::BlendState::ALPHA_BLENDING),
            write_mask: if paint == Paint::Nothing { wgpu::ColorWrites::empty() } else { wgpu::ColorWrites::ALL },
        };
        let texels = inking.map(|inking| wgpu::ColorTargetState {
            format: if inking.unquantised { TEXEL_FORMAT } else { texel_format(inking.layout) },
            blend: None,
            write_mask: wgpu::ColorWrites::ALL,
        });
        let narrow = inking.is_some_and(|inking| inking.layout == TexelLayout::Bits32);
        let line_kind = inking.map_or(LineKind::Normals, |inking| inking.line_kind);
        let rotation = inking.map_or(ArtistRotation::PerPixel, |inking| inking.rotation);
        let region_of_texture = inking.is_some_and(|inking| inking.region_of_texture);
        let of_light = key.constants.iter().map(|&(name, value)| match name {
            "surface_normals" if ground => (name, 0.0),
            _ => (name, value),
        });
        let constants: Vec<_> = of_light
            .chain([
                ("surface_shadow", f64::from(variant.shadow.source)),
                ("surface_shadow_lines", f64::from(variant.shadow.lines)),
                ("surface_clipped", flag(clipped)),
                ("surface_mesh_normals", flag(variant.mesh_normals)),
                ("surface_narrow", flag(narrow)),
                ("surface_unquantised", flag(inking.is_some_and(|inking| inking.unquantised))),
                ("surface_line_kind", f64::from(line_kind as u32)),
                ("surface_artist", f64::from(rotation as u32)),
                ("surface_region_of_texture", flag(region_of_texture)),
                ("surface_by_alpha", flag(by_alpha)),
                ("surface_looked_up", flag(looked_up)),
                ("surface_blended", flag(blended)),
                ("surface_ground", flag(ground)),
                ("surface_emission", f64::from(emission as u32)),
                ("surface_hides", flag(variant.hiding)),
                ("surface_behind_layer", flag(variant.behind_layer)),
            ])
            .collect();
        let targets = [colored.then_some(target), texels];
        // The vertex stage needs the constants too, because it computes light.
        let options = || wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("surface"),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module,
                entry_point: Some(vertex),
                compilation_options: options(),
                buffers: &buffers,
            },
            primitive: wgpu::PrimitiveState {
                cull_mode: cull_back.then_some(wgpu::Face::Back),
                front_face: if mirrored { wgpu::FrontFace::Cw } else { wgpu::FrontFace::Ccw },
                ..Default::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: variant.depth,
                // The ground hides no lines, so that it stands in the depth buffer only where shadows are computed.
                depth_write_enabled: Some(!blended && (!ground || !colored && !inked)),
                // A face that is blended or cut out is seen on an opaque one at its place.
                depth_compare: Some(if blended || variant.hiding || variant.cut_out {
                    wgpu::CompareFunction::GreaterEqual
                } else {
                    wgpu::CompareFunction::Greater
                }),
                stencil: Default::default(),
                bias: if variant.biased { MAP_BIAS } else { Default::default() },
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module,
                entry_point: Some(fragment),
                compilation_options: options(),
                targets: match (colored, inking.is_some()) {
                    (false, false) => &[],
                    (_, inks) => &targets[..if inks { 2 } else { 1 }],
                },
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// The vertex buffer with the data of objects, after those of vertices.
const INSTANCE_SLOT: u32 = 7;

/// The layout of a vertex buffer of [`vertex_streams`], if it is bound.
fn stream_layout((stride, attributes): &(u64, Vec<wgpu::VertexAttribute>)) -> Option<wgpu::VertexBufferLayout<'_>> {
    let (array_stride, step_mode) = (*stride, wgpu::VertexStepMode::Vertex);
    (!attributes.is_empty()).then_some(wgpu::VertexBufferLayout { array_stride, step_mode, attributes })
}

/// The stride and the attributes of each vertex buffer, without attributes where it is not bound; and the attributes that
/// a shader declares but no buffer of vertices has.
fn vertex_streams(
    declared: Streams,
    present: Streams,
) -> ([(u64, Vec<wgpu::VertexAttribute>); INSTANCE_SLOT as usize], Vec<wgpu::VertexAttribute>) {
    let mut constants = Vec::new();
    let mut stream = |(declared, present): (bool, bool), bytes, attributes: &[wgpu::VertexAttribute], value| {
        match (declared, present) {
            (true, true) => return (bytes, attributes.to_vec()),
            (true, false) => constants.extend(attributes.iter().map(|of| constant(of.shader_location, value))),
            (false, _) => {}
        }
        (bytes, Vec::new())
    };
    let streams = [
        stream((true, true), POSITION_BYTES, &wgpu::vertex_attr_array![0 => Float32x3], Constant::Zero),
        stream(
            (declared.normals, present.normals),
            NORMAL_BYTES,
            &wgpu::vertex_attr_array![1 => Float32x3],
            Constant::Zero,
        ),
        stream((declared.uvs, present.uvs), UV_BYTES, &wgpu::vertex_attr_array![2 => Float32x2], Constant::Zero),
        stream(
            (declared.colors, present.colors),
            COLOR_BYTES,
            &wgpu::vertex_attr_array![3 => Float32x4],
            Constant::One,
        ),
        stream(
            (declared.regions, present.regions),
            REGION_BYTES,
            &wgpu::vertex_attr_array![4 => Uint32],
            Constant::NoRegion,
        ),
        stream(
            (declared.directions, present.directions),
            DIRECTION_BYTES,
            &wgpu::vertex_attr_array![5 => Float32x3, 6 => Float32x3],
            Constant::Zero,
        ),
        stream(
            (declared.octaves, present.octaves),
            OCTAVE_BYTES,
            &wgpu::vertex_attr_array![7 => Float32],
            Constant::Zero,
        ),
    ];
    (streams, constants)
}

fn paper(plan: &Plan) -> wgpu::LoadOp<wgpu::Color> {
    let paper = plan.paper.as_dvec3();
    wgpu::LoadOp::Clear(wgpu::Color { r: paper.x, g: paper.y, b: paper.z, a: 1.0 })
}

fn attachment(view: &wgpu::TextureView, load: wgpu::LoadOp<wgpu::Color>) -> wgpu::RenderPassColorAttachment<'_> {
    let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
    wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }
}

/// Records filling a picture with paper.
pub(super) fn clear(encoder: &mut wgpu::CommandEncoder, plan: &Plan, color: &wgpu::TextureView) {
    drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("paper"),
        color_attachments: &[Some(attachment(color, paper(plan)))],
        ..Default::default()
    }));
}

/// Begins a pass over depth and, if present, colour and texels, and binds everything that does not depend on the
/// material.
fn begin<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    (view_group, uploaded, depth): (&wgpu::BindGroup, &GpuScene, &wgpu::TextureView),
    attachments: [Option<wgpu::RenderPassColorAttachment<'_>>; 2],
    load_depth: wgpu::LoadOp<f32>,
) -> wgpu::RenderPass<'a> {
    let count = if attachments[1].is_some() { 2 } else { usize::from(attachments[0].is_some()) };
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("geometry"),
        color_attachments: &attachments[..count],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(wgpu::Operations { load: load_depth, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    pass.set_bind_group(0, view_group, &[0]);
    bind_vertices(&mut pass, uploaded);
    pass
}

/// Binds the attributes of all vertices.
fn bind_vertices(pass: &mut wgpu::RenderPass<'_>, uploaded: &GpuScene) {
    pass.set_vertex_buffer(0, uploaded.positions.slice(..));
    for (slot, buffer) in (1..).zip(&uploaded.streams.buffers) {
        if let Some(buffer) = buffer {
            pass.set_vertex_buffer(slot, buffer.slice(..));
        }
    }
}

/// Sorts blended faces from the farthest to the nearest by the eye depth of their centroid; ties keep the file's order.
fn back_to_front(scene: &Scene, faces: &[[u32; 2]], camera: &Camera) -> Vec<[u32; 2]> {
    let back = camera.axes()[2];
    let depth = |[object, face]: [u32; 2]| scene.face_corners(object, face).into_iter().sum::<DVec3>().dot(back);
    let mut keyed: Vec<(f64, [u32; 2])> = faces.iter().map(|&face| (depth(face), face)).collect();
    keyed.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    keyed.into_iter().map(|(_, face)| face).collect()
}

#[cfg(test)]
mod tests;
