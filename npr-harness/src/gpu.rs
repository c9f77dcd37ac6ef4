//! The GPU renderer, on wgpu.
//!
//! One geometry pass writes colour and depth; blended surfaces follow; then two passes over the pixels of edge lines.
//! Data that do not change from frame to frame are uploaded once, into a [`GpuScene`].

mod adapter;
pub(crate) mod context;
mod ground;
pub(crate) mod index_format;
pub(crate) mod instances;
mod materials;
mod resolve;
pub(crate) mod scene;
pub(crate) mod shader;
mod surface;
pub(crate) mod targets;
pub(crate) mod uniform;

pub use adapter::{DeviceLimits, GpuAdapter};
pub use context::GpuContext;
pub use scene::GpuScene;
use scene::ObjectEdges;
pub use shader::surface_wgsl;
pub use targets::Targets;

use crate::edge_lines::{EdgeLineMethod, EdgeLinePlan};
use crate::error::HarnessError;
use crate::ground::bounds_with;
use crate::hull_lines::gpu::{self as hull_lines, HullLinePass, HullTargets};
use crate::image_lines::gpu::{InkFrame, InkPasses};
use crate::picture::Image;
use crate::plan::Plan;
use crate::scene::{Object, ObjectLines, Scene};
use crate::shadow::gpu::{ShadowDepth, ShadowFrame, ShadowOnDevice, ShadowPasses, StencilTarget};
use crate::style::Style;
use crate::view::{View, size_px};
use glam::{DAffine3, DMat4};
use npr_outline::ContourEdges;
use npr_outline::fin_pass::FinPass;
use npr_outline::fin_printed::PrintedFins;
use npr_outline::line_pass::{
    LineGroup, LinePass, LineRecord, LineSource, LineTargets, VeilLayer, VeilLayers, line_records,
};
use npr_outline::line_style::LineStyle;
use npr_outline::normal_format::NormalFormat;
use npr_outline::segment::LineView;
use resolve::ResolvePass;
use shader::LightOnDevice;
use std::cell::{OnceCell, RefCell};
use std::sync::Arc;
use surface::{Purpose, SurfaceFrame, SurfacePass, SurfaceTargets, clear};

/// Panic message for passes that fail only for formats other than Unorm.
const UNORM: &str = "the pictures' format is Unorm";

/// Renders frames. Pipelines are created on first use and kept.
pub struct GpuRenderer<'a> {
    context: &'a GpuContext,
    surface: SurfacePass,
    /// Index 0: edges are classified on the CPU; index 1: on the GPU. Then the same for lines that see-through surfaces dim.
    lines: [OnceCell<LinePass>; 4],
    hulls: HullLinePass,
    printed: OnceCell<FinPass>,
    ink: InkPasses,
    shadows: ShadowPasses,
    resolve: ResolvePass,
    scratch: RefCell<(Vec<u32>, Vec<LineRecord>)>,
}

impl<'a> GpuRenderer<'a> {
    /// Creates the resources that depend on neither scene nor plan.
    pub fn new(context: &'a GpuContext) -> Self {
        Self {
            context,
            surface: SurfacePass::new(&context.device),
            lines: Default::default(),
            hulls: Default::default(),
            printed: OnceCell::new(),
            ink: Default::default(),
            shadows: Default::default(),
            resolve: Default::default(),
            scratch: Default::default(),
        }
    }

    /// Plans a picture for this renderer's device.
    ///
    /// # Errors
    /// Those of [`Plan::new`].
    pub fn plan(&self, scene: &Scene, style: &Style, view: &View) -> Result<Plan, HarnessError> {
        Plan::new(scene, style, view, &self.context.usable())
    }

    /// Uploads the data of a scene that a plan needs. They also serve plans of the same scene and style for other
    /// views.
    ///
    /// # Errors
    /// [`HarnessError::BufferTooLarge`], [`HarnessError::Outline`].
    pub fn upload(&self, scene: &Scene, plan: &Plan) -> Result<GpuScene, HarnessError> {
        let device = &self.context.device;
        let mut uploaded = GpuScene::new(self.context, self.surface.material_layout(), scene, plan)?;
        if let Some(EdgeLinePlan { contours, method: EdgeLineMethod::OnDevice, .. }) = &plan.edge_lines {
            let pass = self.lines(EdgeLineMethod::OnDevice, plan.veiled);
            let mut edges = contours.iter().map(|_| None).collect::<Vec<_>>();
            upload_edges(pass, device, scene, contours, &mut edges)?;
            uploaded.edges = Some(RefCell::new(edges));
        }
        if let Some(shadow) = &plan.shadow {
            uploaded.casting = self.shadows.upload(self.context, &shadow.technique)?;
        }
        if let Some(hulls) = &plan.hulls {
            uploaded.hulls = Some(hull_lines::upload(device, hulls)?);
        }
        if let Some(printed) = &plan.printed_fins {
            let upload = |fins: &Arc<PrintedFins>| self.printed().upload(device, fins);
            uploaded.fins = Some(printed.fins.iter().map(upload).collect::<Result<_, _>>()?);
        }
        Ok(uploaded)
    }

    fn lines(&self, method: EdgeLineMethod, veiled: bool) -> &LinePass {
        let on_device = method == EdgeLineMethod::OnDevice;
        let new = if veiled { LinePass::veiled } else { LinePass::new };
        self.lines[usize::from(on_device) + 2 * usize::from(veiled)]
            .get_or_init(|| new(&self.context.device, targets::COLOR_FORMAT, on_device).expect(UNORM))
    }

    fn printed(&self) -> &FinPass {
        let new = || FinPass::new(&self.context.device, targets::COLOR_FORMAT, NormalFormat::F32).expect(UNORM);
        self.printed.get_or_init(new)
    }

    /// Creates the render targets for pictures of a view.
    ///
    /// # Errors
    /// [`HarnessError::TextureTooLarge`].
    pub fn targets(&self, view: &View) -> Result<Targets, HarnessError> {
        Targets::new(self.context, view)
    }

    /// Submits a frame. It is complete when [`GpuContext::wait`] returns.
    ///
    /// - `uploaded`: uploaded for the same scene and a plan of the same style;
    /// - `targets`: created for the size and samples of the plan's view.
    ///
    /// # Errors
    /// [`HarnessError::TooManyDraws`], and those of the techniques' passes.
    pub fn draw(&self, scene: &Scene, uploaded: &GpuScene, plan: &Plan, targets: &Targets) -> Result<(), HarnessError> {
        let frame = self.encode(scene, uploaded, plan, targets)?;
        self.context.queue.submit([frame]);
        Ok(())
    }

    /// The commands of a frame, as [`Self::draw`] submits them. They must be submitted before the next frame of the
    /// same upload is encoded.
    ///
    /// # Errors
    /// Those of [`Self::draw`].
    pub(crate) fn encode(
        &self,
        scene: &Scene,
        uploaded: &GpuScene,
        plan: &Plan,
        targets: &Targets,
    ) -> Result<wgpu::CommandBuffer, HarnessError> {
        let device = &self.context.device;
        let canvas = targets.canvas();
        let view = &plan.view;
        if uploaded.materials_version != scene.materials_version() {
            return Err(HarnessError::StaleUpload);
        }
        let light = LightOnDevice::new(self.context, plan)?;
        uploaded.instances.borrow_mut().update(self.context, scene, plan.regions(), plan.object_pairs());
        let frame = SurfaceFrame { device, scene, uploaded, plan, light: &light };
        targets.begin();
        let mut encoder = device.create_command_encoder(&Default::default());
        let ink = match &plan.image {
            Some(image) => Some((image, targets.ink(self.context, image)?)),
            None => None,
        };
        let beside_picture = ink.as_ref().filter(|(image, _)| !image.own_surfaces);
        let size = (canvas.width, canvas.height);
        let in_picture = plan.shadow.as_ref().is_some_and(|shadow| shadow.in_picture);
        let shadow = if in_picture { self.shadow(&mut encoder, &frame, size, &canvas.stencil)? } else { None };
        if plan.draws_surfaces {
            let drawn = SurfaceTargets {
                color: Some(&canvas.color_view),
                texels: beside_picture.map(|(_, ink)| &ink.texels),
                depth: canvas.depth_view(device),
                size_px: size_px(size),
                samples: view.samples,
                purpose: Purpose::Picture,
            };
            self.surface.record(&mut encoder, &frame, shadow.as_ref(), &drawn)?;
        } else {
            clear(&mut encoder, plan, &canvas.color_view);
        }
        if let (Some(plan), Some(hulls)) = (&plan.hulls, &uploaded.hulls) {
            let over = HullTargets { color: &canvas.color_view, depth: canvas.depth_view(device), size };
            self.hulls.record(device, &mut encoder, (plan, hulls), scene, view, &over)?;
        }
        let scale = f64::from(view.samples);
        if let (Some(printed), Some(fins)) = (&plan.printed_fins, &uploaded.fins) {
            for object in scene.objects().iter().filter(|object| object.lines != ObjectLines::None) {
                let fin_view = printed.view(scene, object, &view.camera, size_px(size), scale);
                let Some(fin_view) = fin_view else { continue };
                let ink = printed.style.ink.extend(1.0).to_array();
                let (fins, color, depth) = (&fins[object.mesh()], &canvas.color_view, canvas.depth_view(device));
                self.printed().record(device, &mut encoder, fins, &fin_view, ink, color, depth)?;
            }
        }
        if let Some(edges) = &plan.edge_lines {
            self.edge_lines(&mut encoder, &frame, edges, canvas)?;
        }
        if targets.samples > 1 {
            self.resolve.record(device, &mut encoder, targets.samples, canvas.drawn(), &targets.color_view);
        }
        if let Some((image, ink)) = &ink {
            if let Some(depth) = &ink.depth {
                // This pass only writes input for lines, so shadows are needed only if they have lines.
                let in_lines = plan.shadow.as_ref().is_some_and(|shadow| shadow.in_lines);
                let shadow = if in_lines { self.shadow(&mut encoder, &frame, ink.size, &ink.stencil)? } else { None };
                let size_px = size_px(ink.size);
                let texels = Some(&ink.texels);
                let purpose = Purpose::Picture;
                let drawn = SurfaceTargets { color: None, texels, depth, size_px, samples: 1, purpose };
                self.surface.record(&mut encoder, &frame, shadow.as_ref(), &drawn)?;
            }
            let ink_frame = InkFrame {
                device,
                image,
                camera: &view.camera,
                bounds: bounds_with(plan.ground(), scene),
                ink,
                picture: targets.drawn(),
                picture_size: (targets.width, targets.height),
            };
            self.ink.record(&mut encoder, &ink_frame)?;
        }
        Ok(encoder.finish())
    }

    /// Computes the shadows on the surfaces of a target of the given size.
    fn shadow(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &SurfaceFrame<'_>,
        size: (u32, u32),
        stencil: &StencilTarget,
    ) -> Result<Option<ShadowOnDevice>, HarnessError> {
        let Some(plan) = &frame.plan.shadow else { return Ok(None) };
        let shadow_frame = ShadowFrame {
            context: self.context,
            scene: frame.scene,
            plan,
            camera: &frame.plan.view.camera,
            size,
            casting: frame.uploaded.casting.as_ref(),
            positions: &frame.uploaded.positions,
            indices: frame.uploaded.indices.as_ref(),
            index_format: frame.uploaded.index_format,
            instances: &frame.uploaded.instances.borrow(),
            solid: &frame.uploaded.solid,
        };
        let mut draw_depth = |encoder: &mut wgpu::CommandEncoder, depth: &wgpu::TextureView, of: ShadowDepth| {
            let (size, purpose) = match of {
                ShadowDepth::Receivers => (size, Purpose::Receivers),
                ShadowDepth::Casters { from, side } => ((side, side), Purpose::Casters(from)),
            };
            let size_px = size_px(size);
            let drawn = SurfaceTargets { color: None, texels: None, depth, size_px, samples: 1, purpose };
            self.surface.record(encoder, frame, None, &drawn)
        };
        self.shadows.record(encoder, &shadow_frame, stencil, &mut draw_depth).map(Some)
    }

    /// Draws the nearest layers of see-through surfaces, each behind the one before.
    fn veils<'t>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &SurfaceFrame<'_>,
        canvas: &'t Targets,
    ) -> Result<VeilLayers<'t>, HarnessError> {
        let veils = canvas.veils(frame.device);
        let mut before = None;
        for [depth, alpha] in veils {
            let drawn = SurfaceTargets {
                color: Some(alpha),
                texels: None,
                depth,
                size_px: size_px((canvas.width, canvas.height)),
                samples: frame.plan.view.samples,
                purpose: Purpose::Veils(before),
            };
            self.surface.record(encoder, frame, None, &drawn)?;
            before = Some(depth);
        }
        Ok(std::array::from_fn(|layer| VeilLayer { depth: &veils[layer][0], alpha: &veils[layer][1] }))
    }

    /// Draws edge lines over the canvas.
    fn edge_lines(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &SurfaceFrame<'_>,
        edges: &EdgeLinePlan,
        canvas: &Targets,
    ) -> Result<(), HarnessError> {
        let View { camera, samples, .. } = &frame.plan.view;
        let (scene, scale) = (frame.scene, *samples as f32);
        let view = camera.line_view(size_px((canvas.width, canvas.height)));
        let eye = camera.homogeneous_eye();
        let groups = edges.groups(scene);
        if groups.is_empty() {
            return Ok(());
        }
        let layers = if frame.plan.veiled { Some(self.veils(encoder, frame, canvas)?) } else { None };
        let targets = canvas.begin_ink(frame.device, encoder);
        let line_targets = LineTargets {
            painted: &canvas.color_view,
            depth: canvas.depth_view(frame.device),
            inked: &targets.inked_view,
            coverage: &targets.coverage_view,
        };
        // The uploaded data decide the method; they belong to the same plan.
        let uploaded = match &frame.uploaded.edges {
            Some(uploaded) => {
                let pass = self.lines(EdgeLineMethod::OnDevice, frame.plan.veiled);
                upload_edges(pass, frame.device, scene, &edges.contours, &mut uploaded.borrow_mut())?;
                Some(uploaded.borrow())
            }
            None => None,
        };
        let method = if uploaded.is_some() { EdgeLineMethod::OnDevice } else { EdgeLineMethod::OnCpu };
        let mut scratch = self.scratch.borrow_mut();
        let (lines, records) = &mut *scratch;
        for (number, (style, objects)) in groups.into_iter().enumerate() {
            if number > 0 {
                canvas.continue_ink(encoder);
            }
            let groups: Vec<LineGroup<'_>> = match &uploaded {
                Some(uploaded) => {
                    let group = |&number: &u32| {
                        let object = &scene.objects()[number as usize];
                        let clip_from_mesh = view.clip_from_world * DMat4::from(*object.scene_from_mesh());
                        let (_, edges) = uploaded[number as usize].as_ref()?;
                        Some(LineGroup {
                            source: LineSource::OnDevice(edges),
                            view: LineView { clip_from_world: clip_from_mesh, ..view },
                            eye: object.homogeneous(eye),
                        })
                    };
                    objects.iter().filter_map(group).collect()
                }
                None => {
                    records.clear();
                    for number in objects {
                        let (object, mesh) = scene.placed(number);
                        let (contours, eye) = (&edges.contours[number as usize], object.homogeneous(eye));
                        contours.scan(eye, lines);
                        let first = records.len();
                        line_records(contours, &mesh.model().positions, lines, eye, records);
                        records[first..].iter_mut().for_each(|record| place_record(object, record));
                    }
                    vec![LineGroup { source: LineSource::Records(records), view, eye }]
                }
            };
            let style = &LineStyle { width_px: style.width_px.map(|width_px| width_px * scale), ..style };
            let pass = self.lines(method, frame.plan.veiled);
            pass.record_through(frame.device, encoder, &groups, style, &line_targets, layers.as_ref())?;
        }
        Ok(())
    }

    /// The lines that the GPU found for the last frame of this upload, unordered, as (object, edge); `None` if they
    /// were found on the CPU.
    ///
    /// # Errors
    /// [`HarnessError::Device`].
    pub(crate) fn found_lines(&self, uploaded: &GpuScene) -> Result<Option<Vec<[u32; 2]>>, HarnessError> {
        let Some(edges) = &uploaded.edges else { return Ok(None) };
        let mut found = Vec::new();
        for (object, edges) in (0u32..).zip(&*edges.borrow()) {
            let Some((_, edges)) = edges else { continue };
            let arguments: Vec<u32> = bytemuck::pod_collect_to_vec(&self.context.read_buffer(edges.arguments())?);
            let lines: Vec<u32> = bytemuck::pod_collect_to_vec(&self.context.read_buffer(edges.lines())?);
            // The second argument of the draw call is how many instances it has.
            found.extend(lines.iter().take(arguments[1] as usize).map(|&line| [object, line]));
        }
        Ok(Some(found))
    }

    /// The packed G-buffer of the last frame: normal, region and depth of each pixel of the ink, in the layout of
    /// [`ImageInk::layout`](crate::image_lines::ImageInk::layout). `None` if no frame had lines in the image.
    ///
    /// # Errors
    /// [`HarnessError::Device`].
    pub fn read_texels(&self, targets: &Targets) -> Result<Option<Vec<[u32; 2]>>, HarnessError> {
        targets.read_texels(self.context)
    }

    /// Waits for a frame and reads it back.
    ///
    /// # Errors
    /// [`HarnessError::Device`].
    pub fn read(&self, targets: &Targets) -> Result<Image, HarnessError> {
        targets.read(self.context)
    }
}

/// Uploads the edges of objects that have lines, where they are not uploaded yet or their transforms have changed the
/// angles between faces. Objects with the same contours share what is read.
fn upload_edges(
    pass: &LinePass,
    device: &wgpu::Device,
    scene: &Scene,
    contours: &[Arc<ContourEdges>],
    uploaded: &mut [Option<ObjectEdges>],
) -> Result<(), HarnessError> {
    for (number, ((object, mesh), contours)) in scene.placed_objects().zip(contours).enumerate() {
        if object.lines == ObjectLines::None {
            uploaded[number] = None;
            continue;
        }
        let is_same = |known: &ObjectEdges| Arc::ptr_eq(contours, &known.0);
        if uploaded[number].as_ref().is_some_and(is_same) {
            continue;
        }
        let edges = match uploaded.iter().flatten().find(|known| is_same(known)) {
            Some((_, edges)) => pass.share_edges(device, edges, contours),
            None => pass.upload_edges(device, contours, &mesh.model().positions)?,
        };
        uploaded[number] = Some((Arc::clone(contours), edges));
    }
    Ok(())
}

/// Transforms a line record from mesh space to scene space.
fn place_record(object: &Object, record: &mut LineRecord) {
    if *object.scene_from_mesh() == DAffine3::IDENTITY {
        return;
    }
    let [end0, end1] = [record.end0, record.end1].map(|end| object.point(end.into()).as_vec3().to_array());
    // A reflection reverses the winding of a face relative to its normal.
    (record.end0, record.end1) = if object.is_mirrored() { (end1, end0) } else { (end0, end1) };
    for normal in [&mut record.normal0, &mut record.normal1] {
        *normal = object.normal((*normal).into()).as_vec3().to_array();
    }
}

/// Opens the adapter that [`GpuAdapter::find`] returns, with the limits set in the environment
/// ([`DeviceLimits::from_env`]).
///
/// # Errors
/// [`HarnessError::NoAdapter`] with a list of the adapters considered, [`HarnessError::NoDevice`],
/// [`HarnessError::GpuLimits`].
pub fn open() -> Result<GpuContext, HarnessError> {
    GpuAdapter::find()?.open(DeviceLimits::from_env()?)
}

/// Renders one picture: upload, draw, read back.
///
/// # Errors
/// [`HarnessError`].
pub fn render(context: &GpuContext, scene: &Scene, plan: &Plan) -> Result<Image, HarnessError> {
    let renderer = GpuRenderer::new(context);
    let targets = renderer.targets(&plan.view)?;
    let uploaded = renderer.upload(scene, plan)?;
    renderer.draw(scene, &uploaded, plan, &targets)?;
    renderer.read(&targets)
}
