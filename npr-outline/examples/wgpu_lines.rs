//! A teapot drawn by a render pass of this example, with the crate's lines over it:
//! `cargo run --release -p npr-outline --features wgpu --example wgpu_lines -- teapot.ppm`.

use glam::dcamera::rh::proj::directx::perspective_infinite_reverse;
use glam::dcamera::rh::view::look_at_mat4;
use glam::{DVec2, DVec3};
use npr_mesh::{edges, embedded};
use npr_outline::contour_edges;
use npr_outline::line_pass::{COVERAGE_FORMAT, LineGroup, LinePass, LineSource, LineTargets, line_records};
use npr_outline::line_style::LineStyle;
use npr_outline::segment::LineView;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::*;

/// Rows of 3072 bytes, a multiple of 256, are copied without padding.
const SIZE: Extent3d = Extent3d { width: 768, height: 480, depth_or_array_layers: 1 };
const SIZE_PX: DVec2 = DVec2::new(768.0, 480.0);
const FOV_Y_RAD: f64 = 0.55;
const COLOR: TextureFormat = TextureFormat::Rgba8Unorm;
const DEPTH: TextureFormat = TextureFormat::Depth32Float;
/// Two tones.
const SHADER: &str = "
    struct Corner { @builtin(position) position: vec4<f32>, @location(0) normal: vec3<f32> }
    @group(0) @binding(0) var<uniform> clip_from_world: mat4x4<f32>;
    @vertex fn vs(@location(0) position: vec3<f32>, @location(1) normal: vec3<f32>) -> Corner {
        return Corner(clip_from_world * vec4(position, 1.0), normal);
    }
    @fragment fn fs(corner: Corner) -> @location(0) vec4<f32> {
        let lit = dot(normalize(corner.normal), vec3(-0.4, 0.8, 0.5)) > 0.3;
        return vec4(select(vec3(0.55, 0.62, 0.7), vec3(0.85, 0.88, 0.9), lit), 1.0);
    }";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let instance = Instance::new(InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;

    // Once for a model: its edges, and which of them can be lines.
    let model = embedded::teapot(12);
    let edges =
        edges::find(&model.positions, &model.faces, &model.face_polygon, &model.face_material, &Default::default());
    let contours = contour_edges(&model, &edges, &Default::default())?;
    // Once for a frame: those that are lines for this eye.
    let eye = DVec3::new(3.0, 5.0, 10.0);
    let (mut lines, mut records) = (Vec::new(), Vec::new());
    contours.scan(eye.extend(1.0), &mut lines);
    line_records(&contours, &model.positions, &lines, eye.extend(1.0), &mut records);
    let view = LineView {
        clip_from_world: perspective_infinite_reverse(FOV_Y_RAD, SIZE_PX.x / SIZE_PX.y, 0.1)
            * look_at_mat4(eye, DVec3::new(0.2, 1.5, 0.0), DVec3::Y),
        viewport_px: SIZE_PX,
        depth_per_px: DVec2::new(2.0 * (0.5 * FOV_Y_RAD).tan() / SIZE_PX.y, 0.0),
    };

    // The example's own render pass. Depth is reversed: 1 at the near plane, 0 at infinity.
    let buffer =
        |contents: &[u8], usage| device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage });
    let positions = buffer(bytemuck::cast_slice(&model.positions), BufferUsages::VERTEX);
    let normals = buffer(bytemuck::cast_slice(&model.normals), BufferUsages::VERTEX);
    let indices = buffer(bytemuck::cast_slice(&model.faces), BufferUsages::INDEX);
    let matrix = view.clip_from_world.as_mat4().to_cols_array();
    let matrix = buffer(bytemuck::bytes_of(&matrix), BufferUsages::UNIFORM);
    let source = ShaderSource::Wgsl(SHADER.into());
    let module = &device.create_shader_module(ShaderModuleDescriptor { label: None, source });
    let attributes = [&vertex_attr_array![0 => Float32x3], &vertex_attr_array![1 => Float32x3]];
    let layout =
        |attributes| Some(VertexBufferLayout { array_stride: 12, step_mode: VertexStepMode::Vertex, attributes });
    let buffers = &attributes.map(|attributes| layout(&attributes[..]));
    let compilation_options = PipelineCompilationOptions::default();
    let targets = &[Some(COLOR.into())];
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: VertexState { module, entry_point: None, compilation_options: compilation_options.clone(), buffers },
        primitive: Default::default(),
        depth_stencil: Some(DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(CompareFunction::Greater),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(FragmentState { module, entry_point: None, compilation_options, targets }),
        multiview_mask: None,
        cache: None,
    });
    let entries = &[BindGroupEntry { binding: 0, resource: matrix.as_entire_binding() }];
    let layout = &pipeline.get_bind_group_layout(0);
    let group = device.create_bind_group(&BindGroupDescriptor { label: None, layout, entries });
    let texture = |format, usage| {
        device.create_texture(&TextureDescriptor {
            label: None,
            size: SIZE,
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format,
            usage: usage | TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        })
    };
    let painted = texture(COLOR, TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC);
    let inked = texture(COLOR, TextureUsages::COPY_DST | TextureUsages::COPY_SRC);
    let depth = texture(DEPTH, TextureUsages::TEXTURE_BINDING);
    let coverage = texture(COVERAGE_FORMAT, TextureUsages::empty());
    let [painted_view, inked_view, depth_view, coverage_view] =
        [&painted, &inked, &depth, &coverage].map(|texture| texture.create_view(&Default::default()));
    let mut encoder = device.create_command_encoder(&Default::default());
    let ops = Operations { load: LoadOp::Clear(Color { r: 0.98, g: 0.97, b: 0.94, a: 1.0 }), store: StoreOp::Store };
    let target = RenderPassColorAttachment { view: &painted_view, depth_slice: None, resolve_target: None, ops };
    let depth_ops = Some(Operations { load: LoadOp::Clear(0.0), store: StoreOp::Store });
    let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
        color_attachments: &[Some(target)],
        depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
            view: &depth_view,
            depth_ops,
            stencil_ops: None,
        }),
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.set_vertex_buffer(0, positions.slice(..));
    pass.set_vertex_buffer(1, normals.slice(..));
    pass.set_index_buffer(indices.slice(..), IndexFormat::Uint32);
    pass.draw_indexed(0..3 * model.faces.len() as u32, 0, 0..1);
    drop(pass);

    // And the lines over a copy of it.
    encoder.copy_texture_to_texture(painted.as_image_copy(), inked.as_image_copy(), SIZE);
    let style = LineStyle { width_px: [2.5; 5], ink: [0.1, 0.1, 0.15, 1.0] };
    let targets =
        LineTargets { painted: &painted_view, depth: &depth_view, inked: &inked_view, coverage: &coverage_view };
    let line_pass = LinePass::new(&device, COLOR, false)?;
    let lines = LineGroup { source: LineSource::Records(&records), view, eye: eye.extend(1.0) };
    line_pass.record(&device, &mut encoder, &[lines], &style, &targets)?;

    let (size, usage) = (u64::from(4 * SIZE.width * SIZE.height), BufferUsages::COPY_DST | BufferUsages::MAP_READ);
    let copy = device.create_buffer(&BufferDescriptor { label: None, size, usage, mapped_at_creation: false });
    let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIZE.width), rows_per_image: None };
    encoder.copy_texture_to_buffer(inked.as_image_copy(), TexelCopyBufferInfo { buffer: &copy, layout }, SIZE);
    queue.submit([encoder.finish()]);
    copy.map_async(MapMode::Read, .., |mapped| mapped.expect("a buffer for reading can be mapped"));
    device.poll(PollType::wait_indefinitely())?;
    let mut ppm = format!("P6 {} {} 255\n", SIZE.width, SIZE.height).into_bytes();
    copy.get_mapped_range(..)?.chunks(4).for_each(|rgba| ppm.extend_from_slice(&rgba[..3]));
    Ok(std::fs::write(std::env::args().nth(1).unwrap_or_else(|| "teapot.ppm".into()), ppm)?)
}
