//! Each pass on whatever graphics adapter there is, against a pass that only copies as many bytes.
//!
//! `cargo bench -p npr-imagespace --features wgpu --bench passes -- [--size WIDTHxHEIGHT] [--frames N]`. Interleaved
//! rounds, a pass recorded N times (1 by default, which is too few on hardware, where the wait would take most of the
//! time), submitted and waited for at a time; minimum and median; read the ratios. Bytes are those of the textures' texels, each read once
//! and written once: what a cache cannot save.
//!
//! # Measured
//!
//! On lavapipe (Mesa 22.3.6, LLVM 15, 256 bits) and two cores of a Xeon at 2.5 GHz that did other work, too, 15 rounds;
//! minima in ms, and in brackets how often a copy of as many bytes. The larger picture at another time than the
//! smaller, and more of the machine was taken.
//!
//! | | 1280 × 720 | 1920 × 1080 |
//! | --- | --- | --- |
//! | copy of R8, R32, RG32, RGBA32 | 3.9, 5.9, 7.4, 8.5 | 15, 23, 27, 33 |
//! | fused, 32 bits, hard; soft | 25 (4.2); 28 (4.6) | 92 (3.9); 81 (3.5) |
//! | fused, 64 bits, hard; soft | 27 (3.7); 28 (3.7) | 64 (2.4); 106 (3.9) |
//! | separate, three textures | 51 (6.0) | 178 (5.5) |
//! | printed edges; inker | 18 (3.0); 13 (2.3) | 54 (2.3); 42 (1.8) |
//! | step, diagonal; cross; 3 × 3 | 12 (3.1); 13 (3.2); 20 (5.2) | 34 (2.3); 38 (2.6); 79 (5.4) |
//! | disc of 1 px, hard; soft | 24 (2.8); 23 (2.8) | 88 (2.7); 87 (2.7) |
//! | disc of 4 px | 31 (3.7); 29 (3.4) | 109 (3.4); 108 (3.3) |
//! | disc of 16 px | 38 (4.5); 38 (4.5) | 149 (4.6); 148 (4.6) |
//! | disc of 64 px | 54 (5.9); 58 (6.4) | 182 (5.2); 207 (6.0) |
//! | 3 × 3 ping-pong, 4 steps; 16 | 86 (14); 367 (43) | 328 (14); 1317 (41) |
//! | composite; from half the size; from double | 7.7 (1.0); 15 (2.0); 17 (2.3) | 20 (0.7); 52 (1.9); 56 (2.1) |
//!
//! A disc of 64 px takes 1.7 to 2.0 times as long as one of 4, and 2.2 to 2.9 times as long as one 3 × 3 step. Of its
//! line pixels 0.004 % at most are wrong, where ping-pong of as many steps is wrong in 3 to 11 % (diagonal, 3
//! × 3) and in 0 to 3.5 % (cross).
//!
//! With 1, 2, 3, 4 and 6 for the fan of the plan, a disc of 64 px took 2.7, 2.2, 2.2 to 3.2, 2.2 and 3.0 times as long
//! as one 3 × 3 step; 2 to 4 are the same but for noise.
#![allow(clippy::print_stdout, clippy::print_stderr)]

#[path = "../tests/gpu/device.rs"]
#[allow(dead_code, reason = "the tests use all of it")]
mod device;
#[path = "../tests/gpu/inputs.rs"]
#[allow(dead_code, reason = "the tests use all of it")]
mod inputs;

use device::{Gpu, gpu, view};
use inputs::{px, scene};
use npr_imagespace::composite::Composite;
use npr_imagespace::filter::fused::{FilterUniform, FusedFilter, ink_fused};
use npr_imagespace::filter::printed::PrintedFilter;
use npr_imagespace::filter::separate::SeparateFilter;
use npr_imagespace::format::printed::{CLEAR, ink_printed_encode};
use npr_imagespace::format::texel::*;
use npr_imagespace::morphology::disc::{Disc, DiscBuffers, dilate_disc};
use npr_imagespace::morphology::flood::{disc_plan, flood};
use npr_imagespace::morphology::{Kernel, Operation, ping_pong};
use npr_imagespace::pass::composite::CompositePass;
use npr_imagespace::pass::disc::{DiscPass, DiscScratch};
use npr_imagespace::pass::fused::{FusedPass, texel_format};
use npr_imagespace::pass::printed::PrintedPass;
use npr_imagespace::pass::separate::{SeparatePass, SeparateTextures};
use npr_imagespace::pass::step::{PingPong, Step, StepPass};
use npr_imagespace::pass::{INK_FORMAT, InkTarget, PassTarget};
use npr_imagespace::picture::{Taps, filter_picture};
use std::time::Instant;
use wgpu::TextureFormat;

const ROUNDS: usize = 15;

/// A pass under test.
struct Timed<'a> {
    name: String,
    /// Read and written, of a pixel.
    bytes: f64,
    run: Box<dyn Fn(&mut wgpu::CommandEncoder) + 'a>,
    times_ms: Vec<f64>,
}

impl Timed<'_> {
    fn least(&self) -> f64 {
        self.times_ms.iter().copied().fold(f64::INFINITY, f64::min)
    }

    fn median(&self) -> f64 {
        let mut times = self.times_ms.clone();
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    }
}

/// All that is timed.
#[derive(Default)]
struct Passes<'a>(Vec<Timed<'a>>);

impl<'a> Passes<'a> {
    fn add(&mut self, name: &str, bytes: f64, run: impl Fn(&mut wgpu::CommandEncoder) + 'a) {
        self.0.push(Timed { name: name.to_owned(), bytes, run: Box::new(run), times_ms: Vec::new() });
    }

    /// `repeats`: how often a pass is recorded for one measurement.
    fn run(&mut self, gpu: &Gpu, repeats: u32) {
        for round in 0..=ROUNDS {
            for timed in &mut self.0 {
                let start = Instant::now();
                gpu.run(|encoder| (0..repeats).for_each(|_| (timed.run)(encoder)));
                // The first warms up.
                if round > 0 {
                    timed.times_ms.push(start.elapsed().as_secs_f64() * 1e3 / f64::from(repeats));
                }
            }
        }
    }

    fn least(&self, name: &str) -> f64 {
        self.0.iter().find(|timed| timed.name == name).expect("it is timed").least()
    }
}

/// A pass that loads a texel and stores it.
struct Copy {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    to: wgpu::TextureView,
    bytes: f64,
}

impl Copy {
    fn new(gpu: &Gpu, size: [u32; 2], format: TextureFormat) -> Self {
        let [from, to] = [(); 2].map(|()| view(&gpu.texture(format, size)));
        let is_whole = format.sample_type(None, None) == Some(wgpu::TextureSampleType::Uint);
        let (kind, sample_type) = if is_whole {
            ("u32", wgpu::TextureSampleType::Uint)
        } else {
            ("f32", wgpu::TextureSampleType::Float { filterable: false })
        };
        let source = format!(
            "@group(0) @binding(0) var texels: texture_2d<{kind}>;
            @vertex fn vs(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {{
                return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
            }}
            @fragment fn fs(@builtin(position) p: vec4<f32>) -> @location(0) vec4<{kind}> {{
                return textureLoad(texels, vec2<i32>(p.xy), 0);
            }}"
        );
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type,
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
                count: None,
            }],
        });
        let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: Some(&gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: None,
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            })),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fs"),
                compilation_options: Default::default(),
                targets: &[Some(format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&from) }],
        });
        let bytes = 2.0 * f64::from(format.block_copy_size(None).expect("a colour format"));
        Self { pipeline, group, to, bytes }
    }

    fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: None,
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.to,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// What is filtered, and the lines that the fused filter finds in it.
struct Frame {
    narrow: Vec<u32>,
    wide: Vec<[u32; 2]>,
    printed: Vec<[u8; 4]>,
    normals: Vec<[f32; 4]>,
    depths: Vec<f32>,
    regions: Vec<u32>,
    ink: Vec<u8>,
}

fn code(layout: TexelLayout) -> DepthCode {
    DepthCode::perspective(0.5, 60.0, layout).expect("a range")
}

fn frame(size: [u32; 2]) -> Frame {
    let seen = scene(size);
    let [narrow_code, wide_code] = [TexelLayout::Bits32, TexelLayout::Bits64].map(code);
    let wide: Vec<_> = seen
        .iter()
        .map(|seen| seen.map_or(BACKGROUND, |s| ink_texel64_pack(s.normal, s.region, s.depth, &wide_code)))
        .collect();
    let filter = FusedFilter::default();
    let uniform = FilterUniform::new(&filter, TexelLayout::Bits64, &wide_code).expect("the default is in range");
    let ink =
        |centre, taps: [[u32; 2]; 4]| ink_fused(&uniform, &ink_texel64_tap(centre), &taps.map(ink_texel64_tap)) as f32;
    Frame {
        narrow: seen
            .iter()
            .map(|seen| seen.map_or(0, |s| ink_texel32_pack(s.normal, s.region, s.depth, &narrow_code)))
            .collect(),
        ink: filter_picture(&wide, px(size), Taps::Diagonal, ink).expect("a texel for each pixel"),
        wide,
        printed: seen
            .iter()
            .map(|seen| seen.map_or(CLEAR, |s| ink_printed_encode(s.normal, (s.depth - 1.0) / 40.0)))
            .collect(),
        normals: seen.iter().map(|seen| seen.map_or([0.0; 4], |s| s.normal.extend(0.0).to_array())).collect(),
        depths: seen.iter().map(|seen| seen.map_or(f32::INFINITY, |s| s.depth)).collect(),
        regions: seen.iter().map(|seen| seen.map_or(0, |s| s.region)).collect(),
    }
}

fn bench(gpu: &Gpu, size: [u32; 2], repeats: u32) {
    let device = &gpu.device;
    let frame = frame(size);
    let inked = frame.ink.iter().filter(|&&ink| ink > 0).count() as f64 / frame.ink.len() as f64;
    println!("{} × {} px, {:.1} % ink", size[0], size[1], 100.0 * inked);
    let narrow = view(&gpu.upload(texel_format(TexelLayout::Bits32), size, bytemuck::cast_slice(&frame.narrow)));
    let wide = view(&gpu.upload(texel_format(TexelLayout::Bits64), size, bytemuck::cast_slice(&frame.wide)));
    let printed = view(&gpu.upload(TextureFormat::Rgba8Unorm, size, frame.printed.as_flattened()));
    let normals = view(&gpu.upload(TextureFormat::Rgba32Float, size, bytemuck::cast_slice(&frame.normals)));
    let depths = view(&gpu.upload(TextureFormat::R32Float, size, bytemuck::cast_slice(&frame.depths)));
    let regions = view(&gpu.upload(TextureFormat::R32Uint, size, bytemuck::cast_slice(&frame.regions)));
    let ink = view(&gpu.upload(INK_FORMAT, size, &frame.ink));
    let half_size = size.map(|len| len / 2);
    let half_ink = view(&gpu.upload(INK_FORMAT, half_size, &vec![0; (half_size[0] * half_size[1]) as usize]));
    let double_size = size.map(|len| 2 * len);
    let double_ink = view(&gpu.upload(INK_FORMAT, double_size, &vec![0; (double_size[0] * double_size[1]) as usize]));
    let [out, other] = [(); 2].map(|()| view(&gpu.texture(INK_FORMAT, size)));
    let picture = view(&gpu.texture(TextureFormat::Rgba8Unorm, size));
    let scratch = DiscScratch::new(device, size);
    let composite = Composite::default();
    let onto_ink = PassTarget { view: &out, composite: &composite, area: None };
    let onto_picture = PassTarget { view: &picture, composite: &composite, area: None };
    let over = InkTarget::Picture(TextureFormat::Rgba8Unorm);

    let copies: Vec<_> = [INK_FORMAT, TextureFormat::R32Uint, TextureFormat::Rg32Uint, TextureFormat::Rgba32Uint]
        .map(|format| (format, Copy::new(gpu, size, format)))
        .into();
    let steps = PingPong::new(device, Kernel::Square);
    let disc_pass = DiscPass::new(device, InkTarget::Ink).expect("a picture that blends");
    let mut timed = Passes::default();
    for (format, copy) in &copies {
        timed.add(&format!("copy {format:?}"), copy.bytes, |encoder| copy.record(encoder));
    }
    for (layout, texels, bytes) in [(TexelLayout::Bits32, &narrow, 4.0), (TexelLayout::Bits64, &wide, 8.0)] {
        for (how, softness) in [("hard", 0.0), ("soft", 0.1)] {
            let filter = FusedFilter { softness, ..Default::default() };
            let pass = FusedPass::new(device, &filter, layout, InkTarget::Ink).expect("a picture that blends");
            let run = move |encoder: &mut wgpu::CommandEncoder| {
                pass.record(device, encoder, &filter, &code(layout), texels, &onto_ink).expect("in range");
            };
            timed.add(&format!("fused, {layout:?}, {how}"), bytes + 1.0, run);
        }
    }
    let filter = FusedFilter::default();
    let pass = FusedPass::new(device, &filter, TexelLayout::Bits64, over).expect("a picture that blends");
    let wide = &wide;
    let run = move |encoder: &mut wgpu::CommandEncoder| {
        pass.record(device, encoder, &filter, &code(TexelLayout::Bits64), wide, &onto_picture).expect("in range");
    };
    timed.add("fused, Wide, hard, over a picture", 8.0 + 8.0, run);
    let separate = SeparateFilter::default();
    let pass = SeparatePass::new(device, &separate, InkTarget::Ink).expect("a picture that blends");
    let run = move |encoder: &mut wgpu::CommandEncoder| {
        let textures = SeparateTextures { normal: Some(&normals), depth: Some(&depths), region: Some(&regions) };
        pass.record(device, encoder, &separate, &textures, &onto_ink).expect("in range");
    };
    timed.add("separate, 3 textures", 16.0 + 4.0 + 4.0 + 1.0, run);
    for (name, filter) in [
        ("printed edges", PrintedFilter::default()),
        ("printed inker", PrintedFilter::Inker(npr_imagespace::filter::inker::Inker::default())),
    ] {
        let pass = PrintedPass::new(device, &filter, InkTarget::Ink).expect("a picture that blends");
        let printed = &printed;
        let run = move |encoder: &mut wgpu::CommandEncoder| {
            pass.record(device, encoder, &filter, printed, &onto_ink).expect("in range");
        };
        timed.add(name, 4.0 + 1.0, run);
    }
    for (name, step) in [
        ("step, diagonal", Step::Dilate(Kernel::Diagonal)),
        ("step, cross", Step::Dilate(Kernel::Cross)),
        (SQUARE, Step::Dilate(Kernel::Square)),
        ("step, soft cross", Step::SoftCross),
    ] {
        let pass = StepPass::new(device, step, InkTarget::Ink).expect("no threshold");
        let ink = &ink;
        let run = move |encoder: &mut wgpu::CommandEncoder| {
            pass.record(device, encoder, ink, &onto_ink).expect("one size");
        };
        timed.add(name, 2.0, run);
    }
    for count in [4u32, 16] {
        // From one scratch to another, since both are overwritten.
        let (steps, out, other) = (&steps, &out, &other);
        let run = move |encoder: &mut wgpu::CommandEncoder| {
            steps.record(device, encoder, Operation::Dilate, count, [out, other]).expect("one size");
        };
        timed.add(&format!("ping-pong, 3 × 3, {count} steps"), 2.0 * f64::from(count), run);
    }
    for radius_px in [1.0, 4.0, 16.0, 64.0] {
        for antialias in [false, true] {
            let disc = Disc { radius_px, antialias };
            let columns = disc_plan(&disc).passes.iter().filter(|pass| pass.along_y).count() as f64;
            let (disc_pass, ink, scratch) = (&disc_pass, &ink, &scratch);
            let run = move |encoder: &mut wgpu::CommandEncoder| {
                let dilate = Operation::Dilate;
                disc_pass.record(device, encoder, dilate, &disc, ink, scratch, &onto_ink).expect("in range");
            };
            // Ink to bits, to steps, columns, and steps to ink.
            let bytes = 1.0 + 0.25 + 4.0 + 8.0 * columns + 4.0 + 1.0;
            timed.add(&disc_name(&disc), bytes, run);
        }
    }
    for (name, ink, bytes) in
        [("composite", &ink, 1.0), ("composite, half", &half_ink, 0.25), ("composite, double", &double_ink, 4.0)]
    {
        let pass = CompositePass::new(device, over).expect("a picture that blends");
        let run = move |encoder: &mut wgpu::CommandEncoder| {
            pass.record(device, encoder, ink, &onto_picture).expect("ink of any size");
        };
        timed.add(name, bytes + 8.0, run);
    }

    timed.run(gpu, repeats);
    let square = timed.least(SQUARE);
    let pixels = f64::from(size[0]) * f64::from(size[1]);
    println!("                                      min     median    bytes    / copy of as many   / 3 × 3");
    for t in &timed.0 {
        // The copy that moves as many bytes, or the next more; what moves more than any, as often.
        let (copied, (_, copy)) = match copies.iter().find(|(_, copy)| copy.bytes >= t.bytes) {
            Some(found) => (1.0, found),
            None => (t.bytes / copies[copies.len() - 1].1.bytes, &copies[copies.len() - 1]),
        };
        let copied = copied * timed.0.iter().find(|other| other.bytes == copy.bytes).expect("copies are first").least();
        println!(
            "  {:<34} {:7.2} ms {:7.2} ms {:6.1} MB {:8.2} {:15.2}",
            t.name,
            t.least(),
            t.median(),
            t.bytes * pixels / 1e6,
            t.least() / copied,
            t.least() / square
        );
    }
    let least = |radius_px, antialias| timed.least(&disc_name(&Disc { radius_px, antialias }));
    for (how, antialias) in [("hard", false), ("soft", true)] {
        let (near, far) = (least(4.0, antialias), least(64.0, antialias));
        println!(
            "  disc of 64 px, {how}: {:.2} of a disc of 4 px (to be 2.5 at most), {:.2} of one 3 × 3 step (12 at most)",
            far / near,
            far / square
        );
    }
    errors(&frame.ink, size);
}

const SQUARE: &str = "step, 3 × 3";

fn disc_name(disc: &Disc) -> String {
    format!("disc of {} px, {}", disc.radius_px, if disc.antialias { "soft" } else { "hard" })
}

/// How much of the exact disc's ink the disc of the passes lacks, which is what it has too little, and ping-pong's
/// shapes beside it.
fn errors(ink: &[u8], size: [u32; 2]) {
    let wrong = |a: &[u8], exact: &[u8]| {
        let covered = exact.iter().filter(|&&ink| ink > 0).count() as f64;
        100.0 * a.iter().zip(exact).filter(|(a, b)| a.abs_diff(**b) > 1).count() as f64 / covered
    };
    for radius_px in [1.0, 4.0, 16.0, 64.0] {
        for antialias in [false, true] {
            let disc = Disc { radius_px, antialias };
            let mut exact = Vec::new();
            dilate_disc(ink, px(size), &disc, &mut DiscBuffers::default(), &mut exact).expect("in range");
            let flooded = flood(ink, px(size), &disc, &disc_plan(&disc)).expect("in range");
            print!("  {:<20} {:.4} % of the line pixels wrong", disc_name(&disc), wrong(&flooded, &exact));
            if !antialias {
                for kernel in [Kernel::Diagonal, Kernel::Cross, Kernel::Square] {
                    let steps = ping_pong(ink, px(size), kernel, Operation::Dilate, radius_px as u32).expect("it fits");
                    print!(", {kernel:?} steps {:.1} %", wrong(&steps, &exact));
                }
            }
            println!();
        }
    }
}

/// The sizes and repeats of the arguments.
fn arguments() -> Option<(Vec<[u32; 2]>, u32)> {
    let (mut sizes, mut repeats) = (vec![[1280, 720], [1920, 1080]], 1);
    // Cargo adds an argument of its own.
    let mut arguments = std::env::args().skip(1).filter(|argument| argument != "--bench");
    while let Some(argument) = arguments.next() {
        let value = arguments.next()?;
        match argument.as_str() {
            "--size" => {
                let (width, height) = value.split_once('x')?;
                sizes = vec![[width.parse().ok()?, height.parse().ok()?]];
            }
            "--frames" => repeats = value.parse().ok().filter(|&repeats| repeats > 0)?,
            _ => return None,
        }
    }
    Some((sizes, repeats))
}

fn main() {
    let Some((sizes, repeats)) = arguments() else {
        eprintln!("expected [--size WIDTHxHEIGHT] [--frames N]");
        std::process::exit(2)
    };
    let Some(gpu) = gpu() else { return };
    for size in sizes {
        bench(gpu, size, repeats);
    }
}
