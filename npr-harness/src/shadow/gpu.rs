//! Shadows on the GPU: volumes in a stencil buffer or a shadow map, and the uniform and textures that the surface
//! shader reads.

use super::plan::{ShadowPlan, ShadowTechnique, VolumeMethod};
use crate::camera::{Camera, Projection};
use crate::error::HarnessError;
use crate::geometry::POSITION_BYTES;
use crate::gpu::context::GpuContext;
use crate::gpu::index_format::IndexFormat;
use crate::gpu::instances::{INSTANCE_ATTRIBUTES, Instances, instance_layout};
use crate::gpu::uniform::uniform_buffer;
use crate::ground::bounds_with;
use crate::scene::{Object, Scene};
use crate::texel_format;
use crate::view::size_px;
use glam::{DMat4, DVec2, DVec3, DVec4};
use npr_outline::shadow_mask::{MASK_FORMAT, ShadowMaskPass};
use npr_outline::shadow_pass::{CastersOnDevice, PlacedCasters, ShadowPass};
use std::cell::{OnceCell, RefCell};
use std::collections::HashMap;
use std::ops::Range;

/// `SurfaceShadow` of `shadow.wgsl`.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct ShadowUniform {
    pub(crate) light: [f32; 4],
    pub(crate) light_px: [f32; 4],
    pub(crate) world_from_px: [[f32; 4]; 4],
    pub(crate) map_from_px: [[f32; 4]; 4],
    pub(crate) terminator: f32,
    pub(crate) padding0: f32,
    pub(crate) padding1: f32,
    pub(crate) padding2: f32,
}

/// The shadow resources that the geometry pass binds.
pub(crate) struct ShadowOnDevice {
    pub(crate) uniform: wgpu::Buffer,
    /// The shadow mask of the picture's pixels, in [`MASK_FORMAT`].
    pub(crate) mask: Option<wgpu::TextureView>,
    /// The shadow map.
    pub(crate) map: Option<wgpu::TextureView>,
}

/// The bias of depths in a shadow map.
///
/// A texel represents points up to half a texel from its centre along both axes, where the depth of a plane differs by up
/// to the larger of its slopes. With a bias of that slope away from the light (depth is reversed, so the bias is negative),
/// no plane shadows itself. The constant covers rounding.
pub(crate) const MAP_BIAS: wgpu::DepthBiasState = wgpu::DepthBiasState { constant: -16, slope_scale: -1.0, clamp: 0.0 };

/// The surfaces whose depth a shadow technique asks for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ShadowDepth {
    /// Those on which shadows fall, as the picture shows them.
    Receivers,
    /// Those that cast shadows, tested by alpha, seen from the light.
    Casters {
        /// The camera of the shadow map.
        from: Camera,
        /// The side of the map, texels.
        side: u32,
    },
}

/// Draws the depth of surfaces into a view.
pub(crate) type DrawDepth<'a> =
    dyn FnMut(&mut wgpu::CommandEncoder, &wgpu::TextureView, ShadowDepth) -> Result<(), HarnessError> + 'a;

/// Placeholder resources, bound if there are no shadows.
pub(crate) struct BlankShadow {
    pub(crate) uniform: wgpu::Buffer,
    pub(crate) mask: wgpu::TextureView,
    pub(crate) map: wgpu::TextureView,
    /// The sampler of the shadow map or of its placeholder.
    pub(crate) nearest: wgpu::Sampler,
}

impl BlankShadow {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let uniform = uniform_buffer(device, &[0; size_of::<ShadowUniform>()]);
        let view = |format| texture(device, "no shadow", format, (1, 1)).create_view(&Default::default());
        let nearest = device.create_sampler(&wgpu::SamplerDescriptor { label: Some("nearest"), ..Default::default() });
        Self { uniform, mask: view(MASK_FORMAT), map: view(MAP_FORMAT), nearest }
    }
}

const MAP_FORMAT: wgpu::TextureFormat = texel_format::SHADOW_MAP.on_device();

fn texture(device: &wgpu::Device, label: &str, format: wgpu::TextureFormat, size: (u32, u32)) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: size.0, height: size.1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

/// A depth-stencil target and the shadow mask made from it, of one size, created on first use.
#[derive(Default)]
pub(crate) struct StencilTarget {
    views: OnceCell<(wgpu::TextureView, wgpu::TextureView)>,
}

impl StencilTarget {
    /// Views of the depth-stencil target and of the mask.
    fn views(
        &self,
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        size: (u32, u32),
    ) -> &(wgpu::TextureView, wgpu::TextureView) {
        self.views.get_or_init(|| {
            let view = |label, format| texture(device, label, format, size).create_view(&Default::default());
            (view("shadow stencil", format), view("shadow mask", MASK_FORMAT))
        })
    }
}

/// The shadow casters on the GPU.
pub(crate) enum ShadowCasting {
    /// Per mesh: all faces and edges; the GPU selects those that bound the volumes for a light.
    OnDevice(Vec<CastersOnDevice>),
    /// Per object: the faces and edges that bound the volumes for the light of the last frame, in mesh space.
    Scanned(RefCell<Vec<(DVec4, CastersOnDevice)>>),
}

/// The passes, created on first use.
#[derive(Default)]
pub(crate) struct ShadowPasses {
    /// Index 0: perspective views; index 1: parallel views.
    volumes: [OnceCell<ShadowPass>; 2],
    mask: OnceCell<ShadowMaskPass>,
    map: OnceCell<MapPass>,
    /// By side: the textures of shadow maps.
    maps: RefCell<HashMap<u32, wgpu::Texture>>,
}

/// The inputs of the shadow passes, for a picture or for the geometry pass of its ink.
#[derive(Clone, Copy)]
pub(crate) struct ShadowFrame<'a> {
    pub(crate) context: &'a GpuContext,
    pub(crate) scene: &'a Scene,
    pub(crate) plan: &'a ShadowPlan,
    pub(crate) camera: &'a Camera,
    /// The size of the targets, px.
    pub(crate) size: (u32, u32),
    /// The shadow casters, if volumes are drawn.
    pub(crate) casting: Option<&'a ShadowCasting>,
    /// The casters of a shadow map: vertex positions, faces, and instances.
    pub(crate) positions: &'a wgpu::Buffer,
    pub(crate) indices: Option<&'a wgpu::Buffer>,
    pub(crate) index_format: IndexFormat,
    pub(crate) instances: &'a Instances,
    /// Per mesh: the range of its faces in [`Self::indices`].
    pub(crate) solid: &'a [Range<u32>],
}

impl ShadowFrame<'_> {
    fn uniform(&self) -> ShadowUniform {
        let size_px = size_px(self.size);
        let px_from_world = px_from_clip(size_px) * self.camera.clip_from_world(size_px.x / size_px.y);
        let world_from_px = px_from_world.inverse();
        let light = self.plan.light;
        let map_from_px = match self.plan.technique {
            ShadowTechnique::Map { side, .. } => {
                let texels = DVec2::splat(side.into());
                px_from_clip(texels) * map_camera(self.scene, light).clip_from_world(1.0) * world_from_px
            }
            ShadowTechnique::Volumes { .. } | ShadowTechnique::Rays => DMat4::ZERO,
        };
        ShadowUniform {
            light: light.as_vec4().to_array(),
            light_px: (px_from_world * light).as_vec4().to_array(),
            world_from_px: world_from_px.as_mat4().to_cols_array_2d(),
            map_from_px: map_from_px.as_mat4().to_cols_array_2d(),
            terminator: self.plan.terminator,
            padding0: 0.0,
            padding1: 0.0,
            padding2: 0.0,
        }
    }
}

/// (x px, y px, depth, 1) times w, from clip space.
fn px_from_clip(size_px: DVec2) -> DMat4 {
    let half = size_px / 2.0;
    DMat4::from_cols(
        DVec4::new(half.x, 0.0, 0.0, 0.0),
        DVec4::new(0.0, -half.y, 0.0, 0.0),
        DVec4::Z,
        DVec4::new(half.x, half.y, 0.0, 1.0),
    )
}

/// The camera of the shadow map, which covers exactly the model's bounding sphere.
fn map_camera(scene: &Scene, light: DVec4) -> Camera {
    // A model without extent casts no shadow, but the camera must have a size.
    let (middle, radius) = (scene.middle(), scene.radius().max(f64::MIN_POSITIVE.sqrt()));
    let away = if light.w == 0.0 { light.truncate() } else { light.truncate() - middle };
    let up = if away.y.abs() < 0.9 * away.length() { DVec3::Y } else { DVec3::X };
    if light.w == 0.0 {
        // The depth range extends one radius before and behind the sphere.
        let projection = Projection::Orthographic { height: 2.0 * radius, far: 4.0 * radius };
        return Camera { eye: middle + away * (2.5 * radius), target: middle, up, projection, near: radius };
    }
    let distance = away.length();
    let projection = Projection::Perspective { fov_y_rad: 2.0 * (radius / distance).asin() };
    Camera { eye: light.truncate(), target: middle, up, projection, near: (distance - radius) * 0.99 }
}

impl ShadowPasses {
    /// Uploads the casters, or prepares to do so for each light if the CPU selects what bounds the volumes.
    pub(crate) fn upload(
        &self,
        context: &GpuContext,
        technique: &ShadowTechnique,
    ) -> Result<Option<ShadowCasting>, HarnessError> {
        Ok(match technique {
            ShadowTechnique::Volumes { casters, method: VolumeMethod::OnDevice, .. } => {
                let uploaded = casters.iter().map(|casters| CastersOnDevice::new(&context.device, casters));
                Some(ShadowCasting::OnDevice(uploaded.collect::<Result<_, _>>()?))
            }
            ShadowTechnique::Volumes { .. } => Some(ShadowCasting::Scanned(RefCell::default())),
            ShadowTechnique::Map { .. } | ShadowTechnique::Rays => None,
        })
    }

    /// Records shadow volumes against the depth that `draw_depth` draws into the view it is given, or the shadow map, which
    /// `draw_depth` draws if casters are tested by alpha.
    pub(crate) fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &ShadowFrame<'_>,
        target: &StencilTarget,
        draw_depth: &mut DrawDepth<'_>,
    ) -> Result<ShadowOnDevice, HarnessError> {
        let device = &frame.context.device;
        let uniform = uniform_buffer(device, bytemuck::bytes_of(&frame.uniform()));
        let light = frame.plan.light;
        let (casters, float_depth) = match &frame.plan.technique {
            &ShadowTechnique::Map { side, alpha_test } => {
                let map = if alpha_test {
                    let view = self.map_view(device, side);
                    let from = map_camera(frame.scene, light);
                    draw_depth(encoder, &view, ShadowDepth::Casters { from, side })?;
                    view
                } else {
                    self.draw_map(encoder, frame, side)
                };
                return Ok(ShadowOnDevice { uniform, mask: None, map: Some(map) });
            }
            ShadowTechnique::Volumes { casters, float_depth, .. } => (casters, *float_depth),
            // The plan was made for the CPU.
            ShadowTechnique::Rays => return Err(HarnessError::RayPlan),
        };
        let format = texel_format::stencil_format(float_depth).on_device();
        let (depth_stencil, mask) = target.views(device, format, frame.size);
        draw_depth(encoder, depth_stencil, ShadowDepth::Receivers)?;
        let parallel = matches!(frame.camera.projection, Projection::Orthographic { .. });
        let pass = self.volumes[usize::from(parallel)]
            .get_or_init(|| ShadowPass::new(device, format, parallel).expect(STENCIL));
        let aspect = f64::from(frame.size.0) / f64::from(frame.size.1);
        let clip_from_world = frame.camera.clip_from_world(aspect);
        let casting = frame.casting.expect("what a plan with volumes uploads");
        let objects = frame.scene.objects();
        let of_object = |object: &Object| {
            let (away, casters) = (-frame.camera.axes()[2], &casters[object.mesh()]);
            casters.endless(object.homogeneous(light), object.homogeneous(away.extend(0.0)).truncate())
        };
        let endless = if parallel { objects.iter().map(of_object).sum() } else { 0 };
        let area =
            bounds_with(frame.plan.ground.as_ref(), frame.scene).map(|bounds| frame.camera.area(bounds, frame.size, 1));
        let mut draw = |of_objects: Vec<&CastersOnDevice>| {
            let placed = |(casters, object): (_, &Object)| PlacedCasters {
                casters,
                world_from_mesh: *object.scene_from_mesh(),
                light: object.homogeneous(light),
            };
            let placed: Vec<_> = of_objects.into_iter().zip(objects).map(placed).collect();
            pass.record(device, encoder, &placed, clip_from_world, depth_stencil, endless, area)
        };
        match casting {
            ShadowCasting::OnDevice(casters) => draw(objects.iter().map(|object| &casters[object.mesh()]).collect())?,
            ShadowCasting::Scanned(last) => {
                let mut last = last.borrow_mut();
                for (number, object) in objects.iter().enumerate() {
                    let light = object.homogeneous(light);
                    if last.get(number).is_some_and(|(of, _)| *of == light) {
                        continue;
                    }
                    let scanned = (light, CastersOnDevice::of_light(device, &casters[object.mesh()], light)?);
                    match last.get_mut(number) {
                        Some(last) => *last = scanned,
                        None => last.push(scanned),
                    }
                }
                draw(last.iter().map(|(_, casters)| casters).collect())?;
            }
        }
        let pass = self.mask.get_or_init(|| ShadowMaskPass::new(device, format).expect(STENCIL));
        pass.record(encoder, depth_stencil, mask, area)?;
        Ok(ShadowOnDevice { uniform, mask: Some(mask.clone()), map: None })
    }

    /// A view of the shadow map of a size, which is made if there is none.
    fn map_view(&self, device: &wgpu::Device, side: u32) -> wgpu::TextureView {
        let mut maps = self.maps.borrow_mut();
        let map = maps.entry(side).or_insert_with(|| texture(device, "shadow map", MAP_FORMAT, (side, side)));
        map.create_view(&Default::default())
    }

    fn draw_map(&self, encoder: &mut wgpu::CommandEncoder, frame: &ShadowFrame<'_>, side: u32) -> wgpu::TextureView {
        let device = &frame.context.device;
        let view = self.map_view(device, side);
        let pass = self.map.get_or_init(|| MapPass::new(device));
        let clip_from_world = map_camera(frame.scene, frame.plan.light).clip_from_world(1.0);
        pass.record(encoder, frame, clip_from_world, &view);
        view
    }
}

/// Panic message for passes that fail only for formats without a stencil.
const STENCIL: &str = "the format has a stencil";

/// The shader of shadows on surfaces.
pub(crate) const SHADOW_WGSL: (&str, &str) = ("shadow.wgsl", include_str!("shadow.wgsl"));

const MAP_WGSL: &str = include_str!("shadow_map.wgsl");

/// The pipeline that draws the shadow map.
struct MapPass {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
}

impl MapPass {
    fn new(device: &wgpu::Device) -> Self {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("shadow map"),
            source: wgpu::ShaderSource::Wgsl(MAP_WGSL.into()),
        });
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("shadow map"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("shadow map"),
            layout: Some(&device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("shadow map"),
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            })),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs_shadow_map"),
                compilation_options: Default::default(),
                buffers: &[
                    Some(wgpu::VertexBufferLayout {
                        array_stride: POSITION_BYTES,
                        step_mode: wgpu::VertexStepMode::Vertex,
                        attributes: &wgpu::vertex_attr_array![0 => Float32x3],
                    }),
                    Some(instance_layout(&INSTANCE_ATTRIBUTES)),
                ],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: MAP_FORMAT,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: Default::default(),
                bias: MAP_BIAS,
            }),
            multisample: Default::default(),
            fragment: None,
            multiview_mask: None,
            cache: None,
        });
        Self { layout, pipeline }
    }

    fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &ShadowFrame<'_>,
        clip_from_world: DMat4,
        view: &wgpu::TextureView,
    ) {
        let device = &frame.context.device;
        let uniform = uniform_buffer(device, bytemuck::bytes_of(&clip_from_world.as_mat4().to_cols_array_2d()));
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shadow map"),
            layout: &self.layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() }],
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow map"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        // Unblended faces cast shadows.
        if let Some(indices) = frame.indices {
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.set_vertex_buffer(0, frame.positions.slice(..));
            pass.set_index_buffer(indices.slice(..), frame.index_format.on_device());
            for run in frame.instances.runs() {
                pass.set_vertex_buffer(1, frame.instances.slice(run));
                pass.draw_indexed(frame.solid[run.mesh].clone(), 0, 0..run.objects.len() as u32);
            }
        }
    }
}
