//! Evaluates WGSL expressions on a device.
#![allow(clippy::print_stdout)]

use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::*;

/// The values of `expression`, a `vec4<f32>` of `a: vec4<f32>`, for each of `inputs`.
///
/// `None`, with a line on the standard output, where `NPR_GPU` is `off`, and without an adapter unless `NPR_GPU` is
/// `required`.
pub fn evaluate(library: &str, expression: &str, inputs: &[[f32; 4]]) -> Option<Vec<[f32; 4]>> {
    let wish = std::env::var("NPR_GPU").unwrap_or_default();
    if wish == "off" {
        println!("skipped: NPR_GPU=off");
        return None;
    }
    let instance = Instance::new(InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = match pollster::block_on(instance.request_adapter(&Default::default())) {
        Ok(adapter) => adapter,
        Err(error) if wish == "required" => panic!("NPR_GPU=required, and there is no adapter: {error}"),
        Err(error) => {
            println!("skipped: {error}");
            return None;
        }
    };
    let (device, queue) = pollster::block_on(adapter.request_device(&Default::default())).expect("a device");
    let source = format!(
        "{library}
        @group(0) @binding(0) var<storage, read> inputs: array<vec4<f32>>;
        @group(0) @binding(1) var<storage, read_write> outputs: array<vec4<f32>>;
        @compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
            let a = inputs[id.x];
            outputs[id.x] = {expression};
        }}"
    );
    let module =
        &device.create_shader_module(ShaderModuleDescriptor { label: None, source: ShaderSource::Wgsl(source.into()) });
    let pipeline = device.create_compute_pipeline(&ComputePipelineDescriptor {
        label: None,
        layout: None,
        module,
        entry_point: None,
        compilation_options: Default::default(),
        cache: None,
    });
    let contents: Vec<u8> = inputs.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    let buffer = |usage| device.create_buffer_init(&BufferInitDescriptor { label: None, contents: &contents, usage });
    let given = buffer(BufferUsages::STORAGE);
    let (found, copy) = (
        buffer(BufferUsages::STORAGE | BufferUsages::COPY_SRC),
        buffer(BufferUsages::COPY_DST | BufferUsages::MAP_READ),
    );
    let entries = [&given, &found].map(Buffer::as_entire_binding);
    let entries: Vec<_> = (0..).zip(entries).map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
    let layout = &pipeline.get_bind_group_layout(0);
    let group = device.create_bind_group(&BindGroupDescriptor { label: None, layout, entries: &entries });
    let mut encoder = device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(inputs.len() as u32, 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&found, 0, &copy, 0, found.size());
    queue.submit([encoder.finish()]);
    copy.map_async(MapMode::Read, .., |mapped| mapped.expect("a buffer for reading can be mapped"));
    device.poll(PollType::wait_indefinitely()).expect("the device finishes");
    let bytes = copy.get_mapped_range(..).expect("it is mapped").to_vec();
    let float = |at: usize| f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
    Some((0..inputs.len()).map(|i| [0, 4, 8, 12].map(|at| float(16 * i + at))).collect())
}
