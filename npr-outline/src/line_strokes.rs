//! Lines on wgpu without triangles: compute shaders walk along each line and ink its pixels.
//!
//! A rasteriser that runs on the CPU spends most of its time on a line's two triangles, 3 µs of it measured on lavapipe,
//! where the line has a dozen pixels of ink. Here eight invocations, a vector register's worth, share a line and take
//! its columns in turn. As in [`crate::line_pass`] a pixel's ink is that of the line that covers most of it, whatever
//! their order: an atomic maximum keeps its coverage, and whoever comes first to a pixel puts it on a list. A second
//! dispatch mixes the listed pixels' colours, a third lays them down. So nothing is copied or cleared that no line touches; on the bunny at
//! 1280 × 720 this takes two thirds of the line pass's instructions there.
//!
//! Formulas and pictures are those of the line pass. Needs compute shaders and a picture that can be written as a
//! storage texture: [`STROKE_FORMAT`].

use crate::OutlineError;
use crate::filled_buffer::filled_buffer;
use crate::line_look::LineLook;
use crate::line_pass::{
    INK_WGSL, LineRecord, OutlineUniform, WGSL, bind_group, buffer_entry, nearest_sampler, picture_group,
    picture_layout, shader, storage_limit, workgroups,
};
use crate::segment::LineView;

const STROKES_WGSL: &str = include_str!("line_strokes.wgsl");

/// Of the picture that is inked.
pub const STROKE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Invocations that share a line; `SHARERS` of the shader.
const SHARERS: u32 = 8;

/// What a picture's pixels need between the dispatches: 12 bytes a pixel. For one frame at a time.
#[derive(Debug)]
pub struct StrokeBuffers {
    greatest: wgpu::Buffer,
    inked: wgpu::Buffer,
    inked_count: wgpu::Buffer,
    size_px: [u32; 2],
}

/// What a frame reads and draws into, all of one size.
#[derive(Clone, Copy, Debug)]
pub struct StrokeTargets<'a> {
    /// The picture, [`STROKE_FORMAT`], with `TEXTURE_BINDING` and `STORAGE_BINDING`; gets the lines.
    pub picture: &'a wgpu::TextureView,
    /// The scene's depth, reversed, readable.
    pub depth: &'a wgpu::TextureView,
    /// Made for this size.
    pub buffers: &'a StrokeBuffers,
}

/// The pipelines that draw lines by compute shaders.
#[derive(Debug)]
pub struct LineStrokes {
    view_layout: wgpu::BindGroupLayout,
    read_layout: wgpu::BindGroupLayout,
    lines_layout: wgpu::BindGroupLayout,
    write_layout: wgpu::BindGroupLayout,
    nearest: wgpu::Sampler,
    stroke: wgpu::ComputePipeline,
    mix_ink: wgpu::ComputePipeline,
    lay_ink: wgpu::ComputePipeline,
}

impl LineStrokes {
    /// Makes the pipelines. The device needs [`wgpu::DownlevelFlags::COMPUTE_SHADERS`], four storage buffers and one
    /// storage texture a stage.
    pub fn new(device: &wgpu::Device) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let layout = |label, entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        let view_layout = layout("stroke view", &[buffer_entry(0, compute, wgpu::BufferBindingType::Uniform)]);
        let read_layout = picture_layout(device, compute);
        let [read, write] = [true, false].map(|read_only| wgpu::BufferBindingType::Storage { read_only });
        let lines_layout = layout(
            "strokes",
            &[
                buffer_entry(0, compute, read),
                buffer_entry(1, compute, write),
                buffer_entry(2, compute, write),
                buffer_entry(3, compute, write),
            ],
        );
        let write_layout = layout(
            "stroke picture, written",
            &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: compute,
                ty: wgpu::BindingType::StorageTexture {
                    access: wgpu::StorageTextureAccess::WriteOnly,
                    format: STROKE_FORMAT,
                    view_dimension: wgpu::TextureViewDimension::D2,
                },
                count: None,
            }],
        );
        let module = shader(device, "outline strokes", &[WGSL, INK_WGSL, STROKES_WGSL]);
        let pipeline = |entry, groups: &[Option<&wgpu::BindGroupLayout>]| {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: Some(&device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                    label: Some(entry),
                    bind_group_layouts: groups,
                    immediate_size: 0,
                })),
                module: &module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
                cache: None,
            })
        };
        let stroke = pipeline("stroke", &[Some(&view_layout), Some(&read_layout), Some(&lines_layout)]);
        let mix_ink = pipeline("mix_ink", &[Some(&view_layout), Some(&read_layout), Some(&lines_layout)]);
        let lay_ink = pipeline("lay_ink", &[Some(&view_layout), None, Some(&lines_layout), Some(&write_layout)]);
        let nearest = nearest_sampler(device);
        Self { view_layout, read_layout, lines_layout, write_layout, nearest, stroke, mix_ink, lay_ink }
    }

    /// Makes the buffers for pictures of a size in px.
    ///
    /// # Errors
    /// [`OutlineError::PictureTooLarge`] where a buffer would be larger than the device allows.
    pub fn buffers(&self, device: &wgpu::Device, size_px: [u32; 2]) -> Result<StrokeBuffers, OutlineError> {
        let pixels = u64::from(size_px[0]) * u64::from(size_px[1]);
        let limit = storage_limit(device);
        if 8 * pixels > limit || pixels == 0 {
            return Err(OutlineError::PictureTooLarge { bytes: 8 * pixels, limit });
        }
        let buffer = |label, size, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: wgpu::BufferUsages::STORAGE | usage,
                mapped_at_creation: false,
            })
        };
        // A new buffer holds zeros.
        Ok(StrokeBuffers {
            greatest: buffer("greatest coverage", 4 * pixels, wgpu::BufferUsages::empty()),
            inked: buffer("inked pixels", 8 * pixels, wgpu::BufferUsages::empty()),
            inked_count: buffer("number of inked pixels", 4, wgpu::BufferUsages::COPY_DST),
            size_px,
        })
    }

    /// Records drawing a frame's lines.
    ///
    /// # Errors
    /// [`OutlineError::Width`]; [`OutlineError::TooManyEdges`] where the records do not fit a buffer.
    ///
    /// # Panics
    /// If the view is of another size than the buffers.
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        records: &[LineRecord],
        look: &LineLook,
        view: &LineView,
        targets: &StrokeTargets<'_>,
    ) -> Result<(), OutlineError> {
        look.validate()?;
        let StrokeBuffers { greatest, inked, inked_count, size_px } = targets.buffers;
        assert_eq!(view.viewport_px, glam::DVec2::from(size_px.map(f64::from)), "buffers of another size");
        if records.is_empty() {
            return Ok(());
        }
        let limit = storage_limit(device);
        let bytes = size_of_val(records) as u64;
        if bytes > limit || records.len() > (u32::MAX / SHARERS) as usize {
            return Err(OutlineError::TooManyEdges { bytes, limit });
        }
        let invocations = SHARERS * records.len() as u32;
        let (columns, rows) = workgroups(invocations);
        let uniform = OutlineUniform::of_records(look, view, records.len() as u32, 64 * columns);
        let buffer = |label, contents: &[u8], usage| filled_buffer(device, label, contents, usage);
        let uniform = buffer("stroke view", bytemuck::bytes_of(&uniform), wgpu::BufferUsages::UNIFORM);
        let records = buffer("stroke records", bytemuck::cast_slice(records), wgpu::BufferUsages::STORAGE);
        let group = |layout, resources: &[_]| bind_group(device, "strokes", layout, resources);
        let view_group = group(&self.view_layout, &[uniform.as_entire_binding()]);
        let read_group = picture_group(device, &self.read_layout, targets.depth, targets.picture, &self.nearest);
        let lines_group =
            group(&self.lines_layout, &[&records, greatest, inked, inked_count].map(wgpu::Buffer::as_entire_binding));
        let write_group = group(&self.write_layout, &[wgpu::BindingResource::TextureView(targets.picture)]);
        encoder.clear_buffer(inked_count, 0, None);
        let mut pass =
            encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some("strokes"), timestamp_writes: None });
        pass.set_pipeline(&self.stroke);
        pass.set_bind_group(0, &view_group, &[]);
        pass.set_bind_group(1, &read_group, &[]);
        pass.set_bind_group(2, &lines_group, &[]);
        pass.dispatch_workgroups(columns, rows, 1);
        // Enough to keep any device busy; each takes as many pixels as there are for it.
        const GROUPS: u32 = 64;
        pass.set_pipeline(&self.mix_ink);
        pass.dispatch_workgroups(GROUPS, 1, 1);
        pass.set_pipeline(&self.lay_ink);
        pass.set_bind_group(3, &write_group, &[]);
        pass.dispatch_workgroups(GROUPS, 1, 1);
        Ok(())
    }
}
