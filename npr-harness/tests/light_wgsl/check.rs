//! Evaluates WGSL expressions in compute shaders and compares them with reference functions.

use crate::random::Random;
use glam::{DVec4, Vec4};
use npr_harness::gpu::GpuContext;
use wgpu::util::DeviceExt as _;

/// The arguments of a function: `a`, `b`, `c` and `d` of its expression.
pub type Given = [Vec4; 4];

/// Models per check, and inputs per model: 16,384 inputs per check.
pub const MODELS: usize = 64;
pub const INPUTS: usize = 256;

/// The default bound.
pub const SMALL: f64 = 1e-5;

/// The largest error allowed on the GPU.
#[derive(Clone, Copy)]
pub enum Allowed {
    /// An absolute error per component.
    Within(f64),
    /// A relative error per component; a reference of 0 must be exact.
    Relative(f64),
    /// Any result is allowed, because the function is not continuous here.
    Anything,
}

/// A function, or one way to call it, with parameters of type `M`.
pub struct Check<M> {
    pub name: &'static str,
    /// An expression of type `vec4<f32>` in `a`, `b`, `c`, `d` and the uniform `u`.
    pub wgsl: &'static str,
    pub given: fn(&Random, &M) -> Given,
    pub rust: fn(&M, &Given) -> DVec4,
    pub allowed: fn(&M, &Given) -> Allowed,
}

/// The resources of a shader in addition to its inputs.
pub struct Extra<'a> {
    /// The names and types of the bindings from 2 on, which every module declares.
    pub declarations: String,
    pub layout: Vec<wgpu::BindingType>,
    /// The resources for each model.
    pub resources: Vec<Vec<wgpu::BindingResource<'a>>>,
}

/// The values of each expression for `INPUTS` inputs per model.
pub fn run(
    gpu: &GpuContext,
    library: &str,
    extra: &Extra,
    constants: &[(&str, f64)],
    expressions: &[&str],
    given: &[Vec<Given>],
) -> Vec<Vec<Vec4>> {
    let mut source = format!(
        "{library}\n{}
        @group(0) @binding(0) var<storage, read> given: array<mat4x4<f32>>;
        @group(0) @binding(1) var<storage, read_write> found: array<vec4<f32>>;\n",
        extra.declarations
    );
    for (number, expression) in expressions.iter().enumerate() {
        source += &format!(
            "@compute @workgroup_size(64) fn check_{number}(@builtin(global_invocation_id) id: vec3<u32>) {{
                let a = given[id.x][0]; let b = given[id.x][1]; let c = given[id.x][2]; let d = given[id.x][3];
                found[id.x] = {expression};
            }}\n"
        );
    }
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let storage = |read_only| wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only },
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let types = [storage(true), storage(false)].into_iter().chain(extra.layout.iter().copied());
    let entries: Vec<_> = (0..)
        .zip(types)
        .map(|(binding, ty)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty,
            count: None,
        })
        .collect();
    let layout =
        gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries });
    let pipeline_layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    });
    let each = expressions.iter().zip(given).enumerate();
    each.map(|(number, (_, given))| {
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: Some(&pipeline_layout),
            module: &module,
            entry_point: Some(&format!("check_{number}")),
            compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
            cache: None,
        });
        dispatch(gpu, &pipeline, &layout, extra, given)
    })
    .collect()
}

/// Evaluates the inputs of all models with one pipeline; each model has its slice of the buffers.
fn dispatch(
    gpu: &GpuContext,
    pipeline: &wgpu::ComputePipeline,
    layout: &wgpu::BindGroupLayout,
    extra: &Extra,
    given: &[Given],
) -> Vec<Vec4> {
    let input = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(given),
        usage: wgpu::BufferUsages::STORAGE,
    });
    let buffer = |usage| {
        let size = size_of::<Vec4>() as u64 * given.len() as u64;
        gpu.device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
    };
    let output = buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let copy = buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    for (model, resources) in extra.resources.iter().enumerate() {
        let part = |buffer, element: usize| {
            let size = (element * INPUTS) as u64;
            let size_of_part = wgpu::BufferSize::new(size);
            wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer,
                offset: model as u64 * size,
                size: size_of_part,
            })
        };
        let parts = [part(&input, size_of::<Given>()), part(&output, size_of::<Vec4>())];
        let entries: Vec<_> = (0..)
            .zip(parts.into_iter().chain(resources.iter().cloned()))
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries });
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(INPUTS as u32 / 64, 1, 1);
    }
    encoder.copy_buffer_to_buffer(&output, 0, &copy, 0, copy.size());
    gpu.queue.submit([encoder.finish()]);
    copy.map_async(wgpu::MapMode::Read, .., |result| result.expect("a buffer for reading can be mapped"));
    gpu.wait().expect("shaders compile and run");
    bytemuck::cast_slice(&copy.get_mapped_range(..).expect("it is mapped")).to_vec()
}

/// Evaluates and compares functions that read a uniform of the WGSL type `kind`, `pack`ed from each model.
///
/// # Panics
/// If any error exceeds its bound, after the whole table is printed.
pub fn compare<M, U: bytemuck::Pod>(
    gpu: &GpuContext,
    library: &str,
    kind: &str,
    constants: &[(&str, f64)],
    models: &[M],
    pack: impl Fn(&M) -> U,
    checks: &[Check<M>],
) {
    assert_eq!(models.len(), MODELS);
    let buffers: Vec<_> = models
        .iter()
        .map(|model| {
            gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: None,
                contents: bytemuck::bytes_of(&pack(model)),
                usage: wgpu::BufferUsages::UNIFORM,
            })
        })
        .collect();
    let extra = Extra {
        declarations: format!("@group(0) @binding(2) var<uniform> u: {kind};"),
        layout: vec![wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        }],
        resources: buffers.iter().map(|buffer| vec![buffer.as_entire_binding()]).collect(),
    };
    compare_with(gpu, library, &extra, constants, models, checks);
}

/// The same with `extra` resources for each model.
pub fn compare_with<M>(
    gpu: &GpuContext,
    library: &str,
    extra: &Extra,
    constants: &[(&str, f64)],
    models: &[M],
    checks: &[Check<M>],
) {
    let random = Random::new(1);
    let mut given_to = |check: &Check<M>| -> Vec<Given> {
        models.iter().flat_map(|model| std::iter::repeat_n(model, INPUTS)).map(|m| (check.given)(&random, m)).collect()
    };
    let given: Vec<_> = checks.iter().map(&mut given_to).collect();
    let expressions: Vec<_> = checks.iter().map(|check| check.wgsl).collect();
    let found = run(gpu, library, extra, constants, &expressions, &given);
    println!("{:<44} {:>6} {:>6} {:>10} {:>8}", "function", "inputs", "exempt", "difference", "of bound");
    let mut faults = Vec::new();
    for ((check, given), found) in checks.iter().zip(&given).zip(&found) {
        let (mut exempt, mut most, mut most_of_bound) = (0, 0.0_f64, 0.0_f64);
        let mut worst = None;
        for (number, (given, found)) in given.iter().zip(found).enumerate() {
            let model = &models[number / INPUTS];
            let expected = (check.rust)(model, given);
            let apart = (found.as_dvec4() - expected).abs();
            let (difference, bound) = match (check.allowed)(model, given) {
                Allowed::Within(bound) => (apart.max_element(), bound),
                // 0 / 0, because a reference of 0 must be exact.
                Allowed::Relative(bound) => ((apart / expected.abs().max(DVec4::splat(1e-300))).max_element(), bound),
                Allowed::Anything => {
                    exempt += 1;
                    continue;
                }
            };
            // NaN counts as an infinite error.
            let difference = if found.is_finite() { difference } else { f64::INFINITY };
            let of_bound = if difference > 0.0 { difference / bound } else { 0.0 };
            most = most.max(difference);
            if of_bound > most_of_bound {
                (most_of_bound, worst) = (of_bound, Some((given, found, expected)));
            }
        }
        println!("{:<44} {:>6} {exempt:>6} {most:>10.1e} {most_of_bound:>8.3}", check.name, given.len());
        if let Some((given, found, expected)) = worst.filter(|_| most_of_bound > 1.0) {
            faults.push(format!(
                "{}: {most_of_bound:.1} times the bound: {given:?}: {found}, not {expected}",
                check.name
            ));
        }
        // A check with too many exemptions would be meaningless.
        if given.len() < 10_000 || exempt * 10 > given.len() {
            faults.push(format!("{}: {exempt} of {} inputs are exempt", check.name, given.len()));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
