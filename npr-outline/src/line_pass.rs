//! Draws lines on wgpu, as rectangles in one pass.
//!
//! Where segments of a polyline overlap at their joints, no pixel may be inked twice: a pixel's ink is that of the line
//! with the greatest coverage. Each fragment computes the final colour from the picture without lines and writes its
//! coverage as depth; a depth test keeps the greatest. The result does not depend on the order of the lines, and only
//! pixels near lines are drawn.
//!
//! Needs the scene's depth buffer as a texture of the same size, `Depth32Float`, reversed, and the picture twice: as a
//! texture to read, and as a target that starts as its copy.

use crate::OutlineError;
use crate::contour::ContourEdges;
use crate::filled_buffer::filled_buffer;
use crate::line_style::LineStyle;
use crate::segment::{LineView, VEIL_LAYERS};
use crate::shader::assemble;
use crate::target::{check_color_format, check_reversed, check_view, is_same};
use glam::{DVec4, Vec3};

/// WGSL of [`crate::contour`] and [`crate::segment`]: no bindings, no entry points.
pub const WGSL: &str = concat!(include_str!("contour.wgsl"), include_str!("segment.wgsl"));
const CONTOUR: (&str, &str) = ("contour.wgsl", include_str!("contour.wgsl"));
const LINE: (&str, &str) = ("segment.wgsl", include_str!("segment.wgsl"));
const INK: (&str, &str) = ("line_ink.wgsl", include_str!("line_ink.wgsl"));
const PASS: (&str, &str) = ("line_pass.wgsl", include_str!("line_pass.wgsl"));
const PULLED: (&str, &str) = ("line_pulled.wgsl", include_str!("line_pulled.wgsl"));
const EDGE_RECORD: (&str, &str) = ("edge_record.wgsl", include_str!("edge_record.wgsl"));
const COMPACTION: (&str, &str) = ("compaction.wgsl", include_str!("compaction.wgsl"));

/// What see-through surfaces let through.
const fn through(veiled: bool) -> (&'static str, &'static str) {
    if veiled {
        ("line_veiled.wgsl", include_str!("line_veiled.wgsl"))
    } else {
        ("line_unveiled.wgsl", include_str!("line_unveiled.wgsl"))
    }
}

/// The shader that draws records.
pub(crate) fn record_wgsl(veiled: bool) -> String {
    assemble(&[CONTOUR, LINE, INK, through(veiled), PASS])
}

/// The shader that draws edges by their numbers.
pub(crate) fn pulled_wgsl(veiled: bool) -> String {
    assemble(&[CONTOUR, LINE, INK, through(veiled), PASS, EDGE_RECORD, PULLED])
}

/// The shader that finds the edges that are lines.
pub(crate) fn compaction_wgsl() -> String {
    assemble(&[CONTOUR, LINE, EDGE_RECORD, COMPACTION])
}

/// The format of the depth target that keeps the greatest coverage.
pub const COVERAGE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth16Unorm;

/// `OutlineView` of `segment.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct OutlineUniform {
    clip_from_world: [[f32; 4]; 4],
    viewport_px: [f32; 2],
    depth_per_px: [f32; 2],
    width_px: [f32; 4],
    ink: [f32; 4],
    local_eye: [f32; 4],
    edge_count: u32,
    always_count: u32,
    row_stride: u32,
    /// The width of the fifth kind.
    authored_px: f32,
    single_sided: u32,
    padding: [u32; 3],
}

const _: () = assert!(size_of::<OutlineUniform>() == 160);

/// A line found by a scan on the CPU, as it is uploaded: 52 bytes.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct LineRecord {
    /// The first end, world space, in the winding order of the first face.
    pub end0: [f32; 3],
    /// [`crate::LineKind`] in the three lowest bits, and [`RECORD_CUT_OUT`].
    pub kind_traits: u32,
    /// The second end, world space.
    pub end1: [f32; 3],
    /// The unit normal of the first face.
    pub normal0: [f32; 3],
    /// The unit normal of the second face for the winding of the first; zero at a boundary.
    pub normal1: [f32; 3],
}

const _: () = assert!(size_of::<LineRecord>() == 52);

/// In [`LineRecord::kind_traits`]: all faces of the edge are cut out by alpha.
pub const RECORD_CUT_OUT: u32 = 1 << 9;

/// Appends the records of the lines that a scan found. `eye` as for [`ContourEdges::scan`].
pub fn line_records(
    contours: &ContourEdges,
    positions: &[Vec3],
    lines: &[u32],
    eye: DVec4,
    records: &mut Vec<LineRecord>,
) {
    let eye = contours.local_eye(eye);
    records.extend(lines.iter().filter_map(|&line| {
        let edge = line as usize;
        let kind = contours.kind(edge, eye)?;
        let [normal0, normal1] = contours.normals(edge);
        let [end0, end1] = contours.edges[edge].ends.map(|v| positions[v as usize].to_array());
        let kind_traits = kind as u32 | if contours.edges[edge].is_cut_out() { RECORD_CUT_OUT } else { 0 };
        Some(LineRecord { end0, kind_traits, end1, normal0: normal0.to_array(), normal1: normal1.to_array() })
    }));
}

/// All edges of a model in buffers of the device, for finding lines there.
#[derive(Debug)]
pub struct EdgesOnDevice {
    compaction_group: wgpu::BindGroup,
    pulled_group: wgpu::BindGroup,
    /// Planes, edges and positions.
    read: [wgpu::Buffer; 3],
    lines: wgpu::Buffer,
    arguments: wgpu::Buffer,
    edge_count: u32,
    always_count: u32,
    single_sided: bool,
    local_origin: Vec3,
}

/// Where the lines of a frame come from.
#[derive(Clone, Copy, Debug)]
pub enum LineSource<'a> {
    /// Found by a scan on the CPU and uploaded as records. Faster on software adapters.
    Records(&'a [LineRecord]),
    /// Found by a compute pass and drawn indirectly, without uploads. Faster on hardware.
    OnDevice(&'a EdgesOnDevice),
}

/// Lines that are seen in one view, such as those of a mesh that is placed in a scene: view and eye are in the space of
/// the source's positions, which any affine matrix may map to the scene's.
#[derive(Clone, Copy, Debug)]
pub struct LineGroup<'a> {
    /// The lines.
    pub source: LineSource<'a>,
    /// From the space of the source's positions. The depth of [`LineView::clip_from_world`] is reversed: 1 at the near
    /// plane, falling with distance.
    pub view: LineView,
    /// The eye in the space of the source's positions: a point with w = 1 or the direction to the viewer with w = 0.
    pub eye: DVec4,
}

/// What a frame reads and draws into: views of the first level of textures of the size of [`LineView::viewport_px`],
/// with one sample a pixel.
#[derive(Clone, Copy, Debug)]
pub struct LineTargets<'a> {
    /// The picture without lines: a colour format of floats, `TEXTURE_BINDING`.
    pub painted: &'a wgpu::TextureView,
    /// The scene's depth, reversed: the depth aspect of a depth format, or `R32Float`; `TEXTURE_BINDING`.
    pub depth: &'a wgpu::TextureView,
    /// Of the format that the pass was made for, `RENDER_ATTACHMENT`; holds a copy of `painted`; lines are drawn over
    /// it. A view without sRGB of an sRGB texture will do.
    pub inked: &'a wgpu::TextureView,
    /// [`COVERAGE_FORMAT`], `RENDER_ATTACHMENT`; overwritten.
    pub coverage: &'a wgpu::TextureView,
}

/// A layer of see-through surfaces: views of textures of the picture's size.
#[derive(Clone, Copy, Debug)]
pub struct VeilLayer<'a> {
    /// Its depth, reversed, 0 where there is no surface: as [`LineTargets::depth`].
    pub depth: &'a wgpu::TextureView,
    /// Its alpha, in the first component of a colour format of floats, `TEXTURE_BINDING`.
    pub alpha: &'a wgpu::TextureView,
}

/// The nearest layers of see-through surfaces, in any order.
pub type VeilLayers<'a> = [VeilLayer<'a>; VEIL_LAYERS];

/// The pipelines that draw lines.
#[derive(Debug)]
pub struct LinePass {
    veiled: bool,
    view_layout: wgpu::BindGroupLayout,
    picture_layout: wgpu::BindGroupLayout,
    nearest: wgpu::Sampler,
    record_pipeline: wgpu::RenderPipeline,
    on_device: Option<OnDevicePipelines>,
    color_format: wgpu::TextureFormat,
}

#[derive(Debug)]
struct OnDevicePipelines {
    pulled_layout: wgpu::BindGroupLayout,
    compaction_layout: wgpu::BindGroupLayout,
    compaction: wgpu::ComputePipeline,
    pulled_pipeline: wgpu::RenderPipeline,
}

const RECORD_LAYOUT: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: size_of::<LineRecord>() as u64,
    step_mode: wgpu::VertexStepMode::Instance,
    attributes: &wgpu::vertex_attr_array![
        0 => Float32x3, 1 => Uint32, 2 => Float32x3, 3 => Float32x3, 4 => Float32x3
    ],
};

const EDGE_NUMBER_LAYOUT: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: 4,
    step_mode: wgpu::VertexStepMode::Instance,
    attributes: &wgpu::vertex_attr_array![0 => Uint32],
};

impl LinePass {
    /// Makes the pipelines for a colour target of `color_format`, of floats and without sRGB: coverage blends in
    /// display space.
    ///
    /// `on_device`: also those of [`LineSource::OnDevice`], which need compute shaders, storage buffers in vertex
    /// shaders and indirect drawing ([`wgpu::DownlevelFlags::COMPUTE_SHADERS`],
    /// [`wgpu::DownlevelFlags::VERTEX_STORAGE`], [`wgpu::DownlevelFlags::INDIRECT_EXECUTION`]).
    ///
    /// # Errors
    /// [`OutlineError::SrgbTarget`]; [`OutlineError::ViewFormat`] for a format that is no colour of floats.
    pub fn new(
        device: &wgpu::Device,
        color_format: wgpu::TextureFormat,
        on_device: bool,
    ) -> Result<Self, OutlineError> {
        Self::make(device, color_format, on_device, false)
    }

    /// As [`Self::new`], for lines that see-through surfaces dim ([`Self::record_through`]).
    ///
    /// # Errors
    /// As of [`Self::new`].
    pub fn veiled(
        device: &wgpu::Device,
        color_format: wgpu::TextureFormat,
        on_device: bool,
    ) -> Result<Self, OutlineError> {
        Self::make(device, color_format, on_device, true)
    }

    fn make(
        device: &wgpu::Device,
        color_format: wgpu::TextureFormat,
        on_device: bool,
        veiled: bool,
    ) -> Result<Self, OutlineError> {
        check_color_format(device, color_format)?;
        let layout = |label, entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        let mut stages = wgpu::ShaderStages::VERTEX_FRAGMENT;
        stages.set(wgpu::ShaderStages::COMPUTE, on_device);
        let view_layout = layout("outline view", &[buffer_entry(0, stages, wgpu::BufferBindingType::Uniform)]);
        let picture_layout = picture_layout(device, wgpu::ShaderStages::FRAGMENT, veiled);
        let pipeline =
            |module: &wgpu::ShaderModule, vertex: (&str, &wgpu::VertexBufferLayout<'_>), pulled: Option<&_>| {
                let groups = [Some(&view_layout), Some(&picture_layout), pulled];
                line_pipeline(device, module, vertex, &groups[..2 + usize::from(pulled.is_some())], color_format)
            };
        let module = shader(device, "outline lines", record_wgsl(veiled));
        let record_pipeline = pipeline(&module, ("vs_record", &RECORD_LAYOUT), None);
        let on_device = on_device.then(|| {
            let read = wgpu::BufferBindingType::Storage { read_only: true };
            let vertex = wgpu::ShaderStages::VERTEX;
            let pulled_layout = layout(
                "outline edges",
                &[buffer_entry(0, vertex, read), buffer_entry(1, vertex, read), buffer_entry(2, vertex, read)],
            );
            let write = wgpu::BufferBindingType::Storage { read_only: false };
            let compute = wgpu::ShaderStages::COMPUTE;
            let compaction_layout = layout(
                "outline compaction",
                &[
                    buffer_entry(0, compute, read),
                    buffer_entry(1, compute, read),
                    buffer_entry(2, compute, write),
                    buffer_entry(3, compute, write),
                ],
            );
            let module = shader(device, "outline pulled lines", pulled_wgsl(veiled));
            let pulled_pipeline = pipeline(&module, ("vs_pulled", &EDGE_NUMBER_LAYOUT), Some(&pulled_layout));
            let compaction = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some("outline compaction"),
                layout: Some(&device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                    label: Some("outline compaction"),
                    bind_group_layouts: &[Some(&view_layout), Some(&compaction_layout)],
                    immediate_size: 0,
                })),
                module: &shader(device, "outline compaction", compaction_wgsl()),
                entry_point: Some("compact"),
                compilation_options: Default::default(),
                cache: None,
            });
            OnDevicePipelines { pulled_layout, compaction_layout, compaction, pulled_pipeline }
        });
        Ok(Self {
            veiled,
            view_layout,
            picture_layout,
            nearest: nearest_sampler(device),
            record_pipeline,
            on_device,
            color_format,
        })
    }

    /// Uploads a model's edges: 20 bytes an edge, 16 a face and 12 a position.
    ///
    /// # Errors
    /// [`OutlineError::TooManyEdges`] where a buffer would be larger than the device allows.
    ///
    /// # Panics
    /// If the pass was made without `on_device`.
    pub fn upload_edges(
        &self,
        device: &wgpu::Device,
        contours: &ContourEdges,
        positions: &[Vec3],
    ) -> Result<EdgesOnDevice, OutlineError> {
        let pipelines = self.on_device.as_ref().expect("the pass was made for lines found on the device");
        let limit = storage_limit(device);
        let bytes = contours.device_bytes(positions);
        if bytes > limit {
            return Err(OutlineError::TooManyEdges { bytes, limit });
        }
        // Empty bindings are invalid; without edges the buffer has one blank record.
        let buffer = |label, contents: &[u8], usage| {
            let contents = if contents.is_empty() { &[0u8; 32][..] } else { contents };
            filled_buffer(device, label, contents, usage)
        };
        let storage = wgpu::BufferUsages::STORAGE;
        let planes = buffer("outline planes", bytemuck::cast_slice(&contours.planes), storage);
        let edges = buffer("outline edges", bytemuck::cast_slice(&contours.edges), storage);
        let positions = buffer("outline positions", bytemuck::cast_slice(positions), storage);
        Ok(Self::edges_on_device(device, pipelines, [planes, edges, positions], contours))
    }

    /// The edges of another placement of the same model: what it reads is `edges`', what is found is its own. `contours`
    /// are those that `edges` were uploaded from.
    ///
    /// # Panics
    /// If the pass was made without `on_device`.
    pub fn share_edges(&self, device: &wgpu::Device, edges: &EdgesOnDevice, contours: &ContourEdges) -> EdgesOnDevice {
        let pipelines = self.on_device.as_ref().expect("the pass was made for lines found on the device");
        Self::edges_on_device(device, pipelines, edges.read.clone(), contours)
    }

    fn edges_on_device(
        device: &wgpu::Device,
        pipelines: &OnDevicePipelines,
        read: [wgpu::Buffer; 3],
        contours: &ContourEdges,
    ) -> EdgesOnDevice {
        let storage = wgpu::BufferUsages::STORAGE;
        let lines = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("outline lines"),
            size: 4 * contours.edges.len().max(1) as u64,
            usage: storage | wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        // Four vertices; the compute pass counts the instances.
        let copied = wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        let arguments = filled_buffer(
            device,
            "outline draw arguments",
            bytemuck::cast_slice(&[4u32, 0, 0, 0]),
            storage | wgpu::BufferUsages::INDIRECT | copied,
        );
        let group = |layout, buffers: &[&wgpu::Buffer]| {
            let resources: Vec<_> = buffers.iter().map(|buffer| buffer.as_entire_binding()).collect();
            bind_group(device, "outline edges", layout, &resources)
        };
        let [planes, edges, positions] = &read;
        EdgesOnDevice {
            compaction_group: group(&pipelines.compaction_layout, &[planes, edges, &lines, &arguments]),
            pulled_group: group(&pipelines.pulled_layout, &[planes, edges, positions]),
            read,
            lines,
            arguments,
            edge_count: contours.edges.len() as u32,
            always_count: contours.always as u32,
            single_sided: contours.single_sided,
            local_origin: contours.origin,
        }
    }

    /// Records finding and drawing a frame's lines, those of all groups in one style.
    ///
    /// # Errors
    /// [`OutlineError::Width`]; [`OutlineError::TooManyEdges`] where the records do not fit a buffer; if a texture is
    /// not as [`LineTargets`] says; [`OutlineError::StandardDepth`], where a matrix can be judged. Nothing is recorded
    /// then.
    ///
    /// # Panics
    /// If the pass was made for lines that see-through surfaces dim.
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        groups: &[LineGroup<'_>],
        style: &LineStyle,
        targets: &LineTargets<'_>,
    ) -> Result<(), OutlineError> {
        self.record_through(device, encoder, groups, style, targets, None)
    }

    /// As [`Self::record`], with lines dimmed by the layers of see-through surfaces in front of them, if there are any.
    ///
    /// # Errors
    /// As of [`Self::record`].
    ///
    /// # Panics
    /// If there are layers and the pass was not made by [`Self::veiled`], or the reverse.
    pub fn record_through(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        groups: &[LineGroup<'_>],
        style: &LineStyle,
        targets: &LineTargets<'_>,
        layers: Option<&VeilLayers<'_>>,
    ) -> Result<(), OutlineError> {
        assert_eq!(self.veiled, layers.is_some(), "layers of see-through surfaces, and whether the pass reads them");
        style.validate()?;
        let limit = device.limits().max_buffer_size;
        for LineGroup { source, view, eye } in groups {
            self.check(view, *eye, targets)?;
            if let LineSource::Records(records) = source
                && size_of_val(*records) as u64 > limit
            {
                return Err(OutlineError::TooManyEdges { bytes: size_of_val(*records) as u64, limit });
            }
        }
        for VeilLayer { depth, alpha } in layers.into_iter().flatten() {
            let (size_px, needed) = (groups.first().map(|group| picture_px(&group.view)), "a depth format or R32Float");
            check_view("the depth of a see-through layer", depth, needed, is_depth, size_px)?;
            check_view(
                "the alpha of a see-through layer",
                alpha,
                "a colour format of floats",
                is_float_color,
                size_px,
            )?;
        }
        let picture_group = picture_group(device, &self.picture_layout, targets, layers, &self.nearest);
        for (number, group) in groups.iter().enumerate() {
            // Of all groups, a pixel's ink is that of the line with the greatest coverage.
            let load = if number == 0 { wgpu::LoadOp::Clear(0.0) } else { wgpu::LoadOp::Load };
            let last = number + 1 == groups.len();
            let store = if last { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
            let coverage = wgpu::Operations { load, store };
            self.record_group(device, encoder, group, style, targets, (&picture_group, coverage));
        }
        Ok(())
    }

    fn record_group(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        &LineGroup { source, view, eye }: &LineGroup<'_>,
        style: &LineStyle,
        targets: &LineTargets<'_>,
        (picture_group, coverage): (&wgpu::BindGroup, wgpu::Operations<f32>),
    ) {
        let uniform = OutlineUniform::new(style, &view, eye, source);
        let uniform = filled_buffer(device, "outline view", bytemuck::bytes_of(&uniform), wgpu::BufferUsages::UNIFORM);
        let view_group = bind_group(device, "outline", &self.view_layout, &[uniform.as_entire_binding()]);
        let records = match source {
            LineSource::Records([]) => None,
            LineSource::Records(records) => {
                let usage = wgpu::BufferUsages::VERTEX;
                Some(filled_buffer(device, "outline records", bytemuck::cast_slice(records), usage))
            }
            LineSource::OnDevice(edges) => {
                self.record_compaction(encoder, &view_group, edges);
                None
            }
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("lines"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: targets.inked,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: targets.coverage,
                depth_ops: Some(coverage),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_bind_group(0, &view_group, &[]);
        pass.set_bind_group(1, picture_group, &[]);
        match (source, &records) {
            (LineSource::Records(lines), Some(buffer)) => {
                pass.set_pipeline(&self.record_pipeline);
                pass.set_vertex_buffer(0, buffer.slice(..));
                pass.draw(0..4, 0..lines.len() as u32);
            }
            (LineSource::OnDevice(edges), _) => {
                let pipelines = self.on_device.as_ref().expect("the edges were uploaded by this pass");
                pass.set_pipeline(&pipelines.pulled_pipeline);
                pass.set_bind_group(2, &edges.pulled_group, &[]);
                pass.set_vertex_buffer(0, edges.lines.slice(..));
                pass.draw_indirect(&edges.arguments, 0);
            }
            (LineSource::Records(_), None) => {}
        }
    }

    /// Refuses what the pass cannot draw right with.
    fn check(&self, view: &LineView, eye: DVec4, targets: &LineTargets<'_>) -> Result<(), OutlineError> {
        let towards_viewer = (eye.w == 0.0).then(|| eye.truncate());
        check_reversed(&view.clip_from_world, towards_viewer)?;
        let size_px = Some(picture_px(view));
        check_view("a picture without lines", targets.painted, "a colour format of floats", is_float_color, size_px)?;
        check_view("the scene's depth", targets.depth, "a depth format or R32Float", is_depth, size_px)?;
        let needed = "the format that the pass was made for";
        check_view("a target", targets.inked, needed, |format| is_same(format, self.color_format), size_px)?;
        check_view("the coverage target", targets.coverage, "Depth16Unorm", |format| format == COVERAGE_FORMAT, size_px)
    }

    /// Records the compute pass; afterwards [`EdgesOnDevice::lines`] holds the lines' numbers.
    fn record_compaction(&self, encoder: &mut wgpu::CommandEncoder, view: &wgpu::BindGroup, edges: &EdgesOnDevice) {
        let pipelines = self.on_device.as_ref().expect("the edges were uploaded by this pass");
        // The instance count starts at 0; the other arguments do not change.
        encoder.clear_buffer(&edges.arguments, 4, Some(4));
        let mut pass = encoder
            .begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some("line scan"), timestamp_writes: None });
        pass.set_pipeline(&pipelines.compaction);
        pass.set_bind_group(0, view, &[]);
        pass.set_bind_group(1, &edges.compaction_group, &[]);
        let (columns, rows) = edges.workgroups();
        pass.dispatch_workgroups(columns, rows, 1);
    }
}

impl EdgesOnDevice {
    fn workgroups(&self) -> (u32, u32) {
        workgroups(self.edge_count)
    }

    /// The numbers of the lines that the last frame's compute pass found, in no particular order; the first
    /// [`EdgesOnDevice::arguments`]' instance count of them are valid. `COPY_SRC`.
    pub fn lines(&self) -> &wgpu::Buffer {
        &self.lines
    }

    /// The draw call's arguments: vertex count, instance count (the lines found), 0, 0. `COPY_SRC`.
    pub fn arguments(&self) -> &wgpu::Buffer {
        &self.arguments
    }
}

impl OutlineUniform {
    fn new(style: &LineStyle, view: &LineView, eye: DVec4, source: LineSource<'_>) -> Self {
        let [silhouette, boundary, crease, material_border, authored_px] = style.width_px;
        let of_records = Self {
            clip_from_world: view.clip_from_world.as_mat4().to_cols_array_2d(),
            viewport_px: view.viewport_px.as_vec2().to_array(),
            depth_per_px: view.depth_per_px.as_vec2().to_array(),
            width_px: [silhouette, boundary, crease, material_border],
            ink: style.ink,
            local_eye: [0.0; 4],
            edge_count: 0,
            always_count: 0,
            row_stride: 0,
            authored_px,
            single_sided: 0,
            padding: [0; 3],
        };
        let LineSource::OnDevice(edges) = source else { return of_records };
        Self {
            local_eye: (eye - edges.local_origin.as_dvec3().extend(0.0) * eye.w).as_vec4().to_array(),
            edge_count: edges.edge_count,
            always_count: edges.always_count,
            row_stride: 64 * edges.workgroups().0,
            single_sided: u32::from(edges.single_sided),
            ..of_records
        }
    }
}

/// The numbers of columns and rows of workgroups of 64 invocations, at most 65,535 a row, which every device supports.
fn workgroups(invocations: u32) -> (u32, u32) {
    let groups = invocations.div_ceil(64).max(1);
    let rows = groups.div_ceil(65_535);
    (groups.div_ceil(rows), rows)
}

/// The largest size of a storage buffer, bytes.
fn storage_limit(device: &wgpu::Device) -> u64 {
    device.limits().max_storage_buffer_binding_size.min(device.limits().max_buffer_size)
}

/// A bind group of resources with consecutive bindings.
pub(crate) fn bind_group(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    resources: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    let entries: Vec<_> = (0u32..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
}

fn shader(device: &wgpu::Device, label: &str, source: String) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    })
}

pub(crate) fn buffer_entry(
    binding: u32,
    visibility: wgpu::ShaderStages,
    ty: wgpu::BufferBindingType,
) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None }
}

fn is_float_color(format: wgpu::TextureFormat) -> bool {
    !format.has_depth_aspect() && matches!(format.sample_type(None, None), Some(wgpu::TextureSampleType::Float { .. }))
}

fn is_depth(format: wgpu::TextureFormat) -> bool {
    format.has_depth_aspect() || format == wgpu::TextureFormat::R32Float
}

/// Width and height of a view's picture, px.
fn picture_px(view: &LineView) -> [u32; 2] {
    [view.viewport_px.x as u32, view.viewport_px.y as u32]
}

/// The layout of group 1 of `line_ink.wgsl`: depth, the picture without lines, and the sampler for depth; and that of
/// `line_veiled.wgsl`.
fn picture_layout(device: &wgpu::Device, visibility: wgpu::ShaderStages, veiled: bool) -> wgpu::BindGroupLayout {
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering);
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
    let mut entries = vec![entry(0, texture), entry(1, texture), entry(2, sampler)];
    if veiled {
        entries.extend((3..3 + 2 * VEIL_LAYERS as u32).map(|binding| entry(binding, texture)));
    }
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("outline picture"),
        entries: &entries,
    })
}

/// The bind group of [`picture_layout`].
fn picture_group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    targets: &LineTargets<'_>,
    layers: Option<&VeilLayers<'_>>,
    nearest: &wgpu::Sampler,
) -> wgpu::BindGroup {
    let mut resources = vec![
        wgpu::BindingResource::TextureView(targets.depth),
        wgpu::BindingResource::TextureView(targets.painted),
        wgpu::BindingResource::Sampler(nearest),
    ];
    for VeilLayer { depth, alpha } in layers.into_iter().flatten() {
        resources.extend([depth, alpha].map(|view| wgpu::BindingResource::TextureView(view)));
    }
    bind_group(device, "outline picture", layout, &resources)
}

/// A sampler without filtering that repeats the border texels outside a texture.
fn nearest_sampler(device: &wgpu::Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor { label: Some("nearest"), ..Default::default() })
}

fn line_pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    (entry, buffer): (&str, &wgpu::VertexBufferLayout<'_>),
    groups: &[Option<&wgpu::BindGroupLayout>],
    format: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("lines"),
        layout: Some(&device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("outline"),
            bind_group_layouts: groups,
            immediate_size: 0,
        })),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            buffers: &[Some(buffer.clone())],
        },
        primitive: wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::TriangleStrip, ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: COVERAGE_FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("fs_ink"),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

#[cfg(test)]
mod tests;
