//! Shadows on the device: volumes in a stencil, or a map of depths, and what the geometry pass knows of them.

use super::light::uniform_buffer;
use super::scene::GpuScene;
use super::{Capabilities, GpuContext, GpuError};
use crate::camera::{Camera, Projection};
use crate::scene::Scene;
use crate::shadow::{ShadowMethod, ShadowPlan};
use glam::{DMat4, DVec2, DVec3, DVec4};
use npr_outline::shadow_mask::{MASK_FORMAT, ShadowMaskPass};
use npr_outline::shadow_pass::{CastersOnDevice, ShadowPass};
use npr_outline::shadow_volume::ShadowCasters;
use std::cell::{OnceCell, Ref, RefCell};

/// `SurfaceShadow` of `surface_shadow.wgsl`.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct ShadowUniform {
    pub(super) light: [f32; 4],
    pub(super) light_px: [f32; 4],
    pub(super) world_from_px: [[f32; 4]; 4],
    pub(super) map_from_px: [[f32; 4]; 4],
    pub(super) terminator: f32,
    pub(super) padding0: f32,
    pub(super) padding1: f32,
    pub(super) padding2: f32,
}

/// What the geometry pass binds.
pub(super) struct ShadowOnDevice {
    pub(super) uniform: wgpu::Buffer,
    /// Which pixels of the picture are in shadow, [`MASK_FORMAT`].
    pub(super) mask: Option<wgpu::TextureView>,
    /// The map.
    pub(super) map: Option<wgpu::TextureView>,
}

/// What is bound where there are no shadows.
pub(super) struct BlankShadow {
    pub(super) uniform: wgpu::Buffer,
    pub(super) mask: wgpu::TextureView,
    pub(super) map: wgpu::TextureView,
    /// What the map is read with, blank or not.
    pub(super) nearest: wgpu::Sampler,
}

impl BlankShadow {
    pub(super) fn new(device: &wgpu::Device) -> Self {
        let uniform = uniform_buffer(device, &[0; size_of::<ShadowUniform>()]);
        let view = |format| texture(device, "no shadow", format, (1, 1)).create_view(&Default::default());
        let nearest = device.create_sampler(&wgpu::SamplerDescriptor { label: Some("nearest"), ..Default::default() });
        Self { uniform, mask: view(MASK_FORMAT), map: view(MAP_FORMAT), nearest }
    }
}

const MAP_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

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

/// Depth and stencil, and the mask that is made of them, of one size, made when first needed.
#[derive(Default)]
pub(super) struct StencilTarget {
    views: OnceCell<(wgpu::TextureView, wgpu::TextureView)>,
}

impl StencilTarget {
    /// Depth and stencil, and the mask.
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

/// What casts, on the device.
pub(super) enum ShadowCasting {
    /// All of it; the device sorts out what casts under a light.
    OnDevice(CastersOnDevice),
    /// What casts under the light of the last frame.
    Scanned(RefCell<Option<(DVec4, CastersOnDevice)>>),
}

/// The passes, made when they are first needed.
#[derive(Default)]
pub(super) struct ShadowPasses {
    /// For perspective and for parallel views.
    volumes: [OnceCell<ShadowPass>; 2],
    mask: OnceCell<ShadowMaskPass>,
    map: OnceCell<MapPass>,
    map_texture: RefCell<Option<wgpu::Texture>>,
}

/// A frame's shadows, as far as they are known before anything is drawn.
pub(super) struct ShadowFrame<'a> {
    pub(super) plan: &'a ShadowPlan,
    pub(super) light: DVec4,
    pub(super) camera: &'a Camera,
    pub(super) size: (u32, u32),
}

impl ShadowFrame<'_> {
    fn uniform(&self, scene: &Scene) -> ShadowUniform {
        let size_px = DVec2::new(self.size.0.into(), self.size.1.into());
        let px_from_world = px_from_clip(size_px) * self.camera.clip_from_world(size_px.x / size_px.y);
        let world_from_px = px_from_world.inverse();
        let map_from_px = match self.plan.style.method {
            ShadowMethod::Map { side } => {
                let texels = DVec2::splat(side.into());
                px_from_clip(texels) * map_camera(scene, self.light).clip_from_world(1.0) * world_from_px
            }
            ShadowMethod::Volumes => DMat4::ZERO,
        };
        ShadowUniform {
            light: self.light.as_vec4().to_array(),
            light_px: (px_from_world * self.light).as_vec4().to_array(),
            world_from_px: world_from_px.as_mat4().to_cols_array_2d(),
            map_from_px: map_from_px.as_mat4().to_cols_array_2d(),
            terminator: self.plan.style.terminator,
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

/// What the light sees: all of the model's sphere, no more.
fn map_camera(scene: &Scene, light: DVec4) -> Camera {
    // A model without extent has no shadow, and the camera must have a size.
    let (middle, radius) = (scene.middle(), scene.radius().max(f64::MIN_POSITIVE.sqrt()));
    let away = if light.w == 0.0 { light.truncate() } else { light.truncate() - middle };
    let up = if away.y.abs() < 0.9 * away.length() { DVec3::Y } else { DVec3::X };
    if light.w == 0.0 {
        // From one radius before the sphere to one behind it.
        let projection = Projection::Orthographic { height: 2.0 * radius, far: 4.0 * radius };
        return Camera { eye: middle + away * (2.5 * radius), target: middle, up, projection, near: radius };
    }
    let distance = away.length();
    let projection = Projection::Perspective { fov_y_rad: 2.0 * (radius / distance).asin() };
    Camera { eye: light.truncate(), target: middle, up, projection, near: (distance - radius) * 0.99 }
}

impl ShadowPasses {
    /// Uploads what casts, or makes ready to do so for each light, where the device is not to sort it out.
    pub(super) fn upload(
        &self,
        context: &GpuContext,
        casters: &ShadowCasters,
        on_device: bool,
    ) -> Result<ShadowCasting, GpuError> {
        if !on_device {
            return Ok(ShadowCasting::Scanned(RefCell::default()));
        }
        Ok(ShadowCasting::OnDevice(CastersOnDevice::new(&context.device, casters)?))
    }

    /// Volumes counted against the depth that `draw_depth` draws into the view that it is given; or the map.
    #[expect(clippy::too_many_arguments, reason = "each is a thing of its own; a struct would only rename them")]
    pub(super) fn record(
        &self,
        context: &GpuContext,
        capabilities: &Capabilities,
        encoder: &mut wgpu::CommandEncoder,
        uploaded: &GpuScene,
        scene: &Scene,
        frame: &ShadowFrame<'_>,
        target: &StencilTarget,
        draw_depth: &mut dyn FnMut(&mut wgpu::CommandEncoder, &wgpu::TextureView) -> Result<(), GpuError>,
    ) -> Result<ShadowOnDevice, GpuError> {
        let device = &context.device;
        let uniform = uniform_buffer(device, bytemuck::bytes_of(&frame.uniform(scene)));
        if let ShadowMethod::Map { side } = frame.plan.style.method {
            let map = self.draw_map(context, capabilities, encoder, uploaded, scene, frame.light, side)?;
            return Ok(ShadowOnDevice { uniform, mask: None, map: Some(map) });
        }
        let format = capabilities.stencil_format();
        let (depth_stencil, mask) = target.views(device, format, frame.size);
        draw_depth(encoder, depth_stencil)?;
        let parallel = matches!(frame.camera.projection, Projection::Orthographic { .. });
        if parallel && !capabilities.unclipped_depth {
            return Err(GpuError::ParallelVolumes);
        }
        let pass = self.volumes[usize::from(parallel)]
            .get_or_init(|| ShadowPass::new(device, format, parallel).expect("a format with a stencil"));
        let aspect = f64::from(frame.size.0) / f64::from(frame.size.1);
        let clip_from_world = frame.camera.clip_from_world(aspect);
        let casting = uploaded.casting.as_ref().expect("what a plan with volumes uploads");
        let endless = if parallel { frame.plan.casters.endless(frame.light, -frame.camera.axes()[2]) } else { 0 };
        let area = scene.bounds().map(|bounds| frame.camera.area(bounds, frame.size, 1));
        let mut draw = |casters: &CastersOnDevice| {
            pass.record(device, encoder, casters, frame.light, clip_from_world, depth_stencil, endless, area)
        };
        match casting {
            ShadowCasting::OnDevice(casters) => draw(casters)?,
            ShadowCasting::Scanned(last) => {
                let is_same = last.borrow().as_ref().is_some_and(|(light, _)| *light == frame.light);
                if !is_same {
                    let scanned = CastersOnDevice::scanned(device, &frame.plan.casters, frame.light)?;
                    *last.borrow_mut() = Some((frame.light, scanned));
                }
                draw(&Ref::map(last.borrow(), |last| &last.as_ref().expect("it was just made").1))?;
            }
        }
        let pass = self.mask.get_or_init(|| ShadowMaskPass::new(device, format).expect("a format with a stencil"));
        pass.record(encoder, depth_stencil, mask, area)?;
        Ok(ShadowOnDevice { uniform, mask: Some(mask.clone()), map: None })
    }

    #[expect(clippy::too_many_arguments, reason = "each is a thing of its own; a struct would only rename them")]
    fn draw_map(
        &self,
        context: &GpuContext,
        capabilities: &Capabilities,
        encoder: &mut wgpu::CommandEncoder,
        uploaded: &GpuScene,
        scene: &Scene,
        light: DVec4,
        side: u32,
    ) -> Result<wgpu::TextureView, GpuError> {
        capabilities.check_size("the shadow map", (side, side))?;
        let mut kept = self.map_texture.borrow_mut();
        if kept.as_ref().is_none_or(|texture| texture.width() != side) {
            *kept = Some(texture(&context.device, "shadow map", MAP_FORMAT, (side, side)));
        }
        let view = kept.as_ref().expect("it was just made").create_view(&Default::default());
        let pass = self.map.get_or_init(|| MapPass::new(&context.device));
        pass.record(&context.device, encoder, uploaded, map_camera(scene, light).clip_from_world(1.0), &view);
        Ok(view)
    }
}

const MAP_WGSL: &str = include_str!("shadow_map.wgsl");

/// Depths as a light sees them.
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
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: 24,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &wgpu::vertex_attr_array![0 => Float32x3],
                })],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: MAP_FORMAT,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: Default::default(),
                // A texel stands for what lies up to half a texel from its middle along both axes, where a plane's depth
                // differs by up to the larger of its slopes: so far away from the light (reversed: less) nothing shadows
                // itself. The rest is for rounding.
                bias: wgpu::DepthBiasState { constant: -16, slope_scale: -1.0, clamp: 0.0 },
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
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        uploaded: &GpuScene,
        clip_from_world: DMat4,
        view: &wgpu::TextureView,
    ) {
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
        // What is not blended casts.
        if let Some(indices) = &uploaded.indices {
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.set_vertex_buffer(0, uploaded.vertices.slice(..));
            pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..(indices.size() / 4) as u32, 0, 0..1);
        }
    }
}
