//! Tests that the shaders validate, and that the toon functions on the GPU equal those on the CPU.
#![cfg(feature = "gpu")]
#![allow(clippy::print_stdout)]

mod common;

use common::device;
use glam::{DVec3, Vec3};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use npr_harness::executor::Executor;
use npr_harness::gpu::{GpuContext, surface_wgsl};
use npr_harness::shade::Shade;
use npr_harness::style::styles;
use npr_toon::{Bands, ToonUniform, toon_band_hard, toon_n_dot_h, toon_n_dot_l, toon_shade, toon_width};
use wgpu::util::DeviceExt;

#[test]
fn the_surface_shaders_validate() {
    for style in styles() {
        let source = surface_wgsl(&style.shade).expect("good numbers");
        let head = source.lines().next().expect("a line");
        assert!(head.starts_with("// Made of: npr-toon; ") && head.contains("; surface.wgsl"), "{head}");
        let module = naga::front::wgsl::parse_str(&source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(&source)));
        if let Err(error) = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module) {
            panic!("{}", error.emit_to_string(&source));
        }
        let entries: Vec<_> = module.entry_points.iter().map(|entry| entry.name.as_str()).collect();
        let inked =
            ["vs_plain_inked", "fs_painted_inked", "fs_painted_textured_inked", "fs_texels", "fs_texels_textured"];
        let plain = ["vs_depth", "vs_plain", "vs_textured", "fs_painted", "fs_painted_textured", "fs_nothing"];
        let lit = ["vs_lit", "fs_lit", "fs_lit_inked", "fs_lit_plain", "fs_lit_vertex"];
        let others = ["fs_cut_out", "fs_clipped", "vs_facet", "fs_facet", "fs_facet_inked"];
        for name in plain.into_iter().chain(inked).chain(lit).chain(others) {
            assert!(entries.contains(&name), "{name} is not there");
        }
        let hatches = matches!(style.shade, Shade::Hatch(_));
        assert_eq!(entries.contains(&"fs_hatched"), hatches, "{}", style.name);
        // The shader defines no names with the libraries' prefixes, and contains each library entirely or not at all.
        for (library, prefix) in [(npr_toon::WGSL, "toon_"), (npr_gooch::WGSL, "gooch_")] {
            let library = naga::front::wgsl::parse_str(library).expect("the library parses");
            let prefixed =
                module.functions.iter().filter(|(_, f)| f.name.as_deref().is_some_and(|n| n.starts_with(prefix)));
            let count = prefixed.count();
            assert!(count == library.functions.len() || count == 0, "{}: {prefix}", style.name);
        }
    }
}

/// The number of inputs.
const COUNT: usize = 1 << 14;

const COMPUTE_WGSL: &str = "
struct Input { normal: vec4<f32>, to_light: vec4<f32>, to_eye: vec4<f32>, base: vec4<f32> }
// N.L, N.H, coverage, width; the smooth colour and 0; the hard colour and 0.
struct Output { light: vec4<f32>, smoothed: vec4<f32>, hard: vec4<f32> }
@group(0) @binding(0) var<uniform> bands: ToonBands;
@group(0) @binding(1) var<storage, read> inputs: array<Input>;
@group(0) @binding(2) var<storage, read_write> outputs: array<Output>;
@compute @workgroup_size(64)
fn shade(@builtin(global_invocation_id) id: vec3<u32>) {
    let in = inputs[id.x];
    let n_dot_l = toon_n_dot_l(in.normal.xyz, in.to_light.xyz);
    let n_dot_h = toon_n_dot_h(in.normal.xyz, in.to_light.xyz, in.to_eye.xyz);
    let width = toon_width(in.normal.w, in.to_light.w);
    // Functions of numbers that are exact on both sides.
    let smoothed = toon_shade(bands, in.base.rgb, in.to_eye.w, in.normal.w, in.base.w, in.to_light.w);
    let hard = toon_band(bands, n_dot_l, 0.0);
    outputs[id.x] = Output(
        vec4(n_dot_l, n_dot_h, toon_coverage(in.to_eye.w, 0.3, in.normal.w), width),
        vec4(smoothed, 0.0),
        vec4(hard, 0.0),
    );
}";

/// Pseudorandom numbers in 0..1 (SplitMix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1u32 << 24) as f32
    }

    fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.next()
    }

    /// A vector of length 0.05 to 20.
    fn vector(&mut self) -> Vec3 {
        let v = Vec3::from_array(std::array::from_fn(|_| self.between(-1.0, 1.0)));
        if !(0.1..=1.0).contains(&v.length()) {
            return self.vector();
        }
        v.normalize() * self.between(-3.0, 3.0).exp()
    }
}

/// Sixteen numbers: normal and a width, light and a width, eye and N·L, colour and N·H.
fn random_inputs() -> Vec<[f32; 16]> {
    let mut random = Random(7);
    (0..COUNT)
        .map(|i| {
            let [normal, light, eye] = std::array::from_fn(|_| random.vector());
            // The rounding error at a border is that of N·L divided by the width; below a width of 0.01 it would
            // dominate.
            let widths = if i % 8 == 0 { [0.0; 2] } else { [random.between(0.01, 0.5), random.between(0.01, 0.5)] };
            let base = Vec3::from_array(std::array::from_fn(|_| random.next()));
            let rows = [
                normal.extend(widths[0]),
                light.extend(widths[1]),
                eye.extend(random.between(-1.0, 1.0)),
                base.extend(random.between(0.7, 1.0)),
            ];
            std::array::from_fn(|at| rows[at / 4][at % 4])
        })
        .collect()
}

fn on_device(context: &GpuContext, bands: &Bands, inputs: &[[f32; 16]]) -> Vec<[f32; 12]> {
    let device = &context.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("toon"),
        source: wgpu::ShaderSource::Wgsl([npr_toon::WGSL, COMPUTE_WGSL].concat().into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("toon"),
        layout: None,
        module: &module,
        entry_point: Some("shade"),
        compilation_options: wgpu::PipelineCompilationOptions {
            constants: &[(npr_toon::TOON_BANDS_OVERRIDE, bands.tones.len() as f64)],
            ..Default::default()
        },
        cache: None,
    });
    let uniform = ToonUniform::new(bands).expect("good bands");
    let filled = |contents: &[u8], usage| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
    };
    let empty = |usage| {
        let size = (COUNT * size_of::<[f32; 12]>()) as u64;
        device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
    };
    let uniform = filled(bytemuck::bytes_of(&uniform), wgpu::BufferUsages::UNIFORM);
    let inputs = filled(bytemuck::cast_slice(inputs), wgpu::BufferUsages::STORAGE);
    let outputs = empty(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let copy = empty(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[(0, &uniform), (1, &inputs), (2, &outputs)]
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() }),
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups((COUNT / 64) as u32, 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&outputs, 0, &copy, 0, copy.size());
    context.queue.submit([encoder.finish()]);
    copy.map_async(wgpu::MapMode::Read, .., |result| result.expect("it can be mapped"));
    context.wait().expect("no fault");
    bytemuck::pod_collect_to_vec(&copy.get_mapped_range(..).expect("it is mapped"))
}

#[test]
fn toon_functions_are_the_same_on_the_device() {
    let Some(executor) = device() else { return };
    let Executor::Gpu(context) = &executor else { return };
    if !context.capabilities.compute {
        println!("skipped: {} has no compute shaders", context.describe());
        return;
    }
    let inputs = random_inputs();
    for (name, bands) in [
        ("default", Bands::default()),
        ("text", Bands::diffuse_and_specular()),
        ("listing", Bands::three_diffuse_bands()),
    ] {
        let mut worst = [0.0f64; 5];
        let mut at_a_border = 0;
        for (input, output) in inputs.iter().zip(on_device(context, &bands, &inputs)) {
            let vector = |row: usize| DVec3::from_array(std::array::from_fn(|i| f64::from(input[4 * row + i])));
            let last = |row: usize| f64::from(input[4 * row + 3]);
            let n_dot_l = toon_n_dot_l(vector(0), vector(1));
            let expected = [
                n_dot_l,
                toon_n_dot_h(vector(0), vector(1), vector(2)),
                npr_toon::toon_coverage(last(2), f64::from(0.3f32), last(0)),
                toon_width(last(0), last(1)),
            ];
            for i in 0..4 {
                worst[i] = worst[i].max((f64::from(output[i]) - expected[i]).abs());
            }
            let smoothed = toon_shade(&bands, vector(3), last(2), last(0), last(3), last(1));
            for i in 0..3 {
                worst[4] = worst[4].max((f64::from(output[4 + i]) - smoothed[i]).abs());
            }
            if bands.thresholds.iter().any(|&t| (n_dot_l - f64::from(t)).abs() < 1e-5) {
                at_a_border += 1;
                continue;
            }
            let hard = toon_band_hard(&bands, n_dot_l).as_vec3().to_array();
            assert_eq!(output[8..11], hard, "{name}: N·L is {n_dot_l}");
        }
        println!(
            "{name}, {COUNT} inputs: N·L off by at most {:.1e}, N·H {:.1e}, coverage {:.1e}, width {:.1e}, colour {:.1e}; {at_a_border} at a border",
            worst[0], worst[1], worst[2], worst[3], worst[4]
        );
        assert!(worst.iter().all(|&difference| difference <= 1e-5), "{name}: {worst:?}");
        assert!(at_a_border < 20);
    }
}
