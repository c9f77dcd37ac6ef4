//! The frame on wgpu.
//!
//! One geometry pass into colour and depth; blended surfaces after it; then lines, two passes over the lines' own
//! pixels. Everything that does not change from frame to frame is uploaded once, into a [`GpuScene`].

mod adapter;
mod capabilities;
mod context;
mod error;
mod hatch;
mod ink;
mod light;
mod mean;
mod scene;
mod shadow;
mod surface;
mod targets;

pub use adapter::{DeviceLimits, GpuAdapter};
pub use capabilities::{Capabilities, VolumeMethod};
pub use context::GpuContext;
pub(crate) use context::REFUSED;
pub use error::GpuError;
pub use scene::GpuScene;
pub use surface::wgsl as surface_wgsl;
pub use targets::Targets;

use crate::camera::Camera;
use crate::compare::Image;
use crate::light::{casting_light, lights_in_world};
use crate::plan::{LineMethod, Plan};
use crate::scene::Scene;
use crate::shadow::{ShadowLines, ShadowMethod};
use crate::style::{Lines, Style};
use glam::DVec2;
use light::LightOnDevice;
use mean::MeanPass;
use npr_outline::fin_pass::FinPass;
use npr_outline::line_look::LineLook;
use npr_outline::line_pass::{LineRecord, LineSource, LineTargets, line_records};
use npr_outline::normal_format::NormalFormat;
use shadow::{ShadowFrame, ShadowPasses, StencilTarget};
use std::cell::{OnceCell, RefCell};
use surface::{SurfacePass, SurfaceTargets};

/// Renders frames. Pipelines are made when they are first needed, and kept.
pub struct GpuRenderer<'a> {
    context: &'a GpuContext,
    /// What is made use of.
    capabilities: Capabilities,
    surface: SurfacePass,
    lines: npr_outline::line_pass::LinePass,
    printed: OnceCell<FinPass>,
    ink: ink::InkPasses,
    shadows: ShadowPasses,
    mean: MeanPass,
    scratch: RefCell<(Vec<u32>, Vec<LineRecord>)>,
}

impl<'a> GpuRenderer<'a> {
    /// Makes what does not depend on scene or style, for all that the device can do.
    pub fn new(context: &'a GpuContext) -> Self {
        Self::with_capabilities(context, context.usable())
    }

    /// The same, making use of no more than `capabilities`.
    pub fn with_capabilities(context: &'a GpuContext, capabilities: Capabilities) -> Self {
        Self {
            context,
            surface: SurfacePass::new(&context.device),
            lines: npr_outline::line_pass::LinePass::new(
                &context.device,
                targets::COLOR_FORMAT,
                capabilities.can_find_lines(),
            )
            .expect("a color format without sRGB"),
            capabilities,
            printed: OnceCell::new(),
            ink: Default::default(),
            shadows: Default::default(),
            mean: Default::default(),
            scratch: Default::default(),
        }
    }

    /// Uploads what a plan needs of a scene.
    ///
    /// # Errors
    /// [`GpuError::BufferTooLarge`].
    pub fn upload(&self, scene: &Scene, plan: &Plan, method: LineMethod) -> Result<GpuScene, GpuError> {
        let capabilities = &self.capabilities;
        let lines = match (method, &plan.contours) {
            (LineMethod::Auto, Some(contours)) => capabilities.lines(contours.device_bytes(&scene.model.positions)).0,
            (method, _) => method,
        };
        let on_device = lines == LineMethod::OnDevice;
        let mut uploaded = GpuScene::new(self.context, capabilities, &self.surface, scene, plan)?;
        if let (true, Some(contours)) = (on_device, &plan.contours) {
            uploaded.edges = Some(self.lines.upload_edges(&self.context.device, contours, &scene.model.positions)?);
        }
        if let Some(shadow) = plan.shadow.as_ref().filter(|shadow| shadow.style.method == ShadowMethod::Volumes) {
            let sorted_there = match method {
                LineMethod::Auto => capabilities.volumes().0 == VolumeMethod::OnDevice,
                method => method == LineMethod::OnDevice,
            };
            uploaded.casting = Some(self.shadows.upload(self.context, &shadow.casters, sorted_there)?);
        }
        if let Some(fins) = &plan.printed_fins {
            uploaded.fins = Some(self.printed().upload(&self.context.device, fins)?);
        }
        Ok(uploaded)
    }

    fn printed(&self) -> &FinPass {
        self.printed.get_or_init(|| {
            FinPass::new(&self.context.device, targets::COLOR_FORMAT, NormalFormat::F32)
                .expect("a color format without sRGB")
        })
    }

    /// Makes targets of a size, for one sample a pixel.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`].
    pub fn targets(&self, width: u32, height: u32) -> Result<Targets, GpuError> {
        self.targets_of_samples(width, height, 1)
    }

    /// Makes targets of a size, for several samples along each axis of a pixel. What is drawn from surfaces and edges is
    /// drawn as many times as large, with lines as much wider, and averaged; lines in the image are found and laid at the
    /// picture's own size.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`].
    pub fn targets_of_samples(&self, width: u32, height: u32, samples: u32) -> Result<Targets, GpuError> {
        Targets::new(self.context, &self.capabilities, (width, height), samples)
    }

    /// Submits a frame. It is done when [`GpuContext::wait`] returns.
    ///
    /// # Errors
    /// What is wrong with the style.
    pub fn draw(
        &self,
        scene: &Scene,
        uploaded: &GpuScene,
        style: &Style,
        plan: &Plan,
        camera: &Camera,
        targets: &Targets,
    ) -> Result<(), GpuError> {
        let device = &self.context.device;
        let canvas = targets.canvas();
        let size_px = DVec2::new(f64::from(canvas.width), f64::from(canvas.height));
        let eye = camera.homogeneous_eye();
        let light = LightOnDevice::new(self.context, style, &lights_in_world(style, scene, camera))?;
        targets.begin();
        let mut encoder = device.create_command_encoder(&Default::default());
        let ink = match &plan.image {
            Some(image) => Some((image, targets.ink(self.context, &self.capabilities, image)?)),
            None => None,
        };
        let shadow_of = |encoder: &mut wgpu::CommandEncoder, size: (u32, u32), stencil: &StencilTarget| {
            let Some(shadow) = &plan.shadow else { return Ok(None) };
            let frame = ShadowFrame { plan: shadow, light: casting_light(style, scene, camera), camera, size };
            let mut draw_depth = |encoder: &mut wgpu::CommandEncoder, depth: &wgpu::TextureView| {
                let size_px = DVec2::new(size.0.into(), size.1.into());
                let drawn = SurfaceTargets { color: None, texels: None, depth, size_px, samples: 1 };
                self.surface.record(device, encoder, uploaded, scene, style, plan, camera, &light, None, &drawn)
            };
            let (context, capabilities) = (self.context, &self.capabilities);
            self.shadows
                .record(context, capabilities, encoder, uploaded, scene, &frame, stencil, &mut draw_depth)
                .map(Some)
        };
        // A picture that is left as paper shows nothing of shadows but by its lines.
        let one_pass = ink.as_ref().is_none_or(|(_, ink)| ink.depth.is_none());
        let shadow = if plan.painted || one_pass {
            shadow_of(&mut encoder, (canvas.width, canvas.height), &canvas.stencil)?
        } else {
            None
        };
        let drawn = SurfaceTargets {
            color: Some(&canvas.color_view),
            texels: ink.as_ref().filter(|(_, ink)| ink.depth.is_none()).map(|(_, ink)| &ink.texels),
            depth: &canvas.depth_view,
            size_px,
            samples: targets.samples,
        };
        let shadow = shadow.as_ref();
        self.surface.record(device, &mut encoder, uploaded, scene, style, plan, camera, &light, shadow, &drawn)?;
        let scale = targets.samples as f32;
        if let (Some(Lines::Fins(look)), Some(contours)) = (&style.lines, &plan.contours) {
            let mut scratch = self.scratch.borrow_mut();
            let (lines, records) = &mut *scratch;
            let source = match &uploaded.edges {
                Some(edges) => LineSource::OnDevice(edges),
                None => {
                    contours.scan(eye, lines);
                    line_records(contours, &scene.model.positions, lines, eye, records);
                    LineSource::Records(records)
                }
            };
            let look = &LineLook { width_px: look.width_px.map(|width_px| width_px * scale), ..*look };
            let view = camera.line_view(size_px);
            let line_targets = LineTargets {
                painted: &canvas.color_view,
                depth: &canvas.depth_view,
                inked: &canvas.inked_view,
                winner: &canvas.winner_view,
            };
            canvas.begin_ink(&mut encoder);
            self.lines.record(device, &mut encoder, source, look, &view, eye, &line_targets)?;
        }
        if let (Some(Lines::Printed { width_px, ink }), Some(fins), Some(bounds)) =
            (&style.lines, &uploaded.fins, scene.bounds())
        {
            let view = camera.fin_view(size_px, f64::from(*width_px * scale), bounds);
            let ink = ink.extend(1.0).to_array();
            self.printed().record(device, &mut encoder, fins, &view, ink, &canvas.color_view, &canvas.depth_view)?;
        }
        if targets.samples > 1 {
            self.mean.record(device, &mut encoder, targets.samples, canvas.drawn(), &targets.color_view);
        }
        if let Some((image, ink)) = &ink {
            if let Some(depth) = &ink.depth {
                // Only lines are drawn here: without lines of shadows there is no need for them.
                let shadow = if image.ink.shadows == ShadowLines::None {
                    None
                } else {
                    shadow_of(&mut encoder, ink.size, &ink.stencil)?
                };
                let shadow = shadow.as_ref();
                let size_px = DVec2::new(ink.size.0.into(), ink.size.1.into());
                let drawn = SurfaceTargets { color: None, texels: Some(&ink.texels), depth, size_px, samples: 1 };
                self.surface.record(
                    device,
                    &mut encoder,
                    uploaded,
                    scene,
                    style,
                    plan,
                    camera,
                    &light,
                    shadow,
                    &drawn,
                )?;
            }
            self.ink.record(self.context, &mut encoder, scene.bounds(), image, camera, ink, targets)?;
        }
        self.context.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// The lines, in no order, that the device found for the last frame of this upload, or `None` if it was not asked
    /// to ([`LineMethod`]).
    ///
    /// # Errors
    /// [`GpuError::Device`].
    pub fn found_lines(&self, uploaded: &GpuScene) -> Result<Option<Vec<u32>>, GpuError> {
        let Some(edges) = &uploaded.edges else { return Ok(None) };
        let arguments: Vec<u32> = bytemuck::pod_collect_to_vec(&self.context.read_buffer(edges.arguments())?);
        let mut lines: Vec<u32> = bytemuck::pod_collect_to_vec(&self.context.read_buffer(edges.lines())?);
        // The second argument of the draw call is how many instances it has.
        lines.truncate(arguments[1] as usize);
        Ok(Some(lines))
    }

    /// What the last frame's surfaces left for lines in the image: normal, region and depth of each pixel of the ink,
    /// packed as [`ImageInk::layout`](crate::image_ink::ImageInk::layout) says. `None` if no frame had such lines.
    ///
    /// # Errors
    /// [`GpuError::Device`].
    pub fn read_texels(&self, targets: &Targets) -> Result<Option<Vec<[u32; 2]>>, GpuError> {
        targets.read_texels(self.context)
    }

    /// Waits for a frame and fetches it.
    ///
    /// # Errors
    /// [`GpuError::Device`].
    pub fn read(&self, targets: &Targets) -> Result<Image, GpuError> {
        targets.read(self.context)
    }
}

/// Renders one picture, making use of no more than `capabilities`: upload, draw, fetch. `samples`: along each axis of a
/// pixel.
///
/// # Errors
/// [`GpuError`].
#[expect(clippy::too_many_arguments, reason = "each is a thing of its own; a struct would only rename them")]
pub fn render(
    context: &GpuContext,
    capabilities: Capabilities,
    scene: &Scene,
    style: &Style,
    plan: &Plan,
    camera: &Camera,
    (width, height): (u32, u32),
    samples: u32,
    method: LineMethod,
) -> Result<Image, GpuError> {
    let renderer = GpuRenderer::with_capabilities(context, capabilities);
    let targets = renderer.targets_of_samples(width, height, samples)?;
    let uploaded = renderer.upload(scene, plan, method)?;
    renderer.draw(scene, &uploaded, style, plan, camera, &targets)?;
    renderer.read(&targets)
}
