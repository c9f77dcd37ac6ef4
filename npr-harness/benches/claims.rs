//! What the sources claim, measured: "The Evolution of a Cartoon Renderer", Card & Mitchell 2002, and the slides of
//! SIGGRAPH 2002.
//!
//! `cargo bench -p npr-harness --bench claims -- [--frames N] [--rounds N]`. Prints the rows of docs/claims.md. Times are
//! those of interleaved rounds in one run, and only their ratios mean something. Without an adapter the two parts that
//! need none are measured.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod common;

use common::shared;
use glam::{DVec2, DVec3, UVec2, Vec3};
use npr_harness::camera::{Camera, Framing, Projection};
use npr_harness::capabilities::Capabilities;
use npr_harness::cpu::{self, CpuOptions};
use npr_harness::executor::Executor;
use npr_harness::gpu::{GpuContext, GpuRenderer};
use npr_harness::image_lines::ImageInk;
use npr_harness::measure::{FrameCase, Rounds, Samples, time_frames, time_work};
use npr_harness::plan::Plan;
use npr_harness::printed_fins::PrintedLines;
use npr_harness::scene::Scene;
use npr_harness::shade::Shade;
use npr_harness::shade::lambert::Lambert;
use npr_harness::style::{Lines, Style, style};
use npr_harness::truth::lines::{TrueLines, accuracy, drawn_centreline, true_lines};
use npr_harness::view::View;
use npr_imagespace::composite::{AlphaTest, Composite, ink_alpha_passes};
use npr_imagespace::filter::fused::FusedFilter;
use npr_imagespace::filter::inker::Inker;
use npr_imagespace::filter::printed::ink_printed_inker;
use npr_imagespace::format::printed::{CLEAR, ink_printed_encode};
use npr_imagespace::format::texel::{DepthCode, TexelLayout, ink_texel64_tap};
use npr_imagespace::pass::composite::CompositePass;
use npr_imagespace::pass::fused::{FusedPass, texel_format};
use npr_imagespace::pass::{INK_FORMAT, InkTarget, PassTarget};
use npr_imagespace::picture::{Taps, filter_picture};
use npr_mesh::{Model, embedded, pn_triangles};
use npr_outline::line_style::LineStyle;

fn main() {
    let rounds = common::arguments(common::ROUNDS).rounds;
    let executor = common::on_adapter();
    println!("\n| claim | measured | verdict |\n| --- | --- | --- |");
    if let Some(executor) = &executor {
        second_geometry_pass(executor, &rounds);
        if let Executor::Gpu(context) = executor {
            alpha_test(context, &rounds);
            polygons(context, &rounds);
        }
    }
    depth_scaled_threshold();
    fins();
}

fn row(claim: &str, measured: &str, verdict: &str) {
    println!("| {claim} | {measured} | {verdict} |");
}

fn framed(model: Model, size: (u32, u32)) -> (Scene, View) {
    let scene = Scene::new(model);
    let camera = Camera::framed(scene.corners(), f64::from(size.0) / f64::from(size.1), &Framing::default());
    (scene, View::new(camera, size))
}

fn lambert(lines: Lines) -> Style {
    Style {
        shade: Shade::Lambert(Lambert { ambient: 0.25 }),
        lines,
        ..style("cartoon").expect("a style of this crate")
    }
}

/// Times of interleaved rounds, for each case.
fn timed(cases: &mut [Box<dyn FnMut() + '_>], rounds: &Rounds) -> Vec<Samples> {
    let mut cases: Vec<&mut dyn FnMut()> = cases.iter_mut().map(|case| &mut **case as &mut dyn FnMut()).collect();
    time_work(&mut cases, rounds)
}

/// The median over rounds of the ratio of two cases of the same round.
fn ratio(of: &Samples, to: &Samples) -> f64 {
    of.relative_to(to).median
}

/// Draws a plan again and again.
fn frames<'a>(
    context: &'a GpuContext,
    renderer: &'a GpuRenderer<'_>,
    scene: &'a Scene,
    plan: Plan,
) -> Box<dyn FnMut() + 'a> {
    let uploaded = renderer.upload(scene, &plan).expect("the scene fits");
    let targets = renderer.targets(&plan.view).expect("a size for every device");
    Box::new(move || {
        renderer.draw(scene, &uploaded, &plan, &targets).expect("the frame is drawn");
        context.wait().expect("the frame is drawn");
    })
}

/// Frames without lines, with the G-buffer as a second target of the picture's pass, and with a pass of its own.
fn second_geometry_pass(executor: &Executor, rounds: &Rounds) {
    let round = |segments: u32| embedded::sphere(segments);
    let bunny = || shared("stanford-bunny.obj");
    let models = [
        ("few polygons: cube, 1280 × 720", Some(embedded::cube()), (1280, 720)),
        ("sphere, 1280 × 720", Some(round(192)), (1280, 720)),
        ("many polygons: sphere, 320 × 180", Some(round(1024)), (320, 180)),
        ("bunny, 1280 × 720", bunny(), (1280, 720)),
        ("bunny, four triangles for one, 320 × 180", bunny().map(|model| subdivided(&model)), (320, 180)),
    ];
    for (name, model, size) in models {
        let Some(model) = model else { continue };
        let (scene, view) = framed(model, size);
        let plan = |lines| Plan::new(&scene, &lambert(lines), &view, &executor.capabilities()).expect("a good style");
        let beside = plan(Lines::image(ImageInk::default()));
        let mut apart = beside.clone();
        apart.image.as_mut().expect("lines in the image").own_surfaces = true;
        let plans = [plan(Lines::NONE), beside, apart];
        let cases = plans.each_ref().map(|plan| FrameCase { scene: &scene, plan });
        let times = time_frames(executor, &cases, rounds, &|_| {}).expect("the frames are drawn");
        let [beside, apart] = [1, 2].map(|case| ratio(&times[case].wall, &times[0].wall));
        let on_device = [0, 1, 2].map(|case| times[case].device.as_ref());
        let device = match on_device {
            [Some(plain), Some(beside), Some(apart)] => {
                format!("; in device time {:.2}, {:.2}", ratio(beside, plain), ratio(apart, plain))
            }
            _ => String::new(),
        };
        let measured = format!(
            "{name}, {} faces: over a frame without lines, two targets {beside:.2}, two passes {apart:.2}{device}",
            scene.face_count()
        );
        let kept = 100.0 * beside / apart;
        let holds = if kept < 67.0 { "holds nearly" } else { "less, where pixels and not polygons take the time" };
        let verdict =
            format!("{holds}: the second pass leaves {kept:.0} % of the frame rate of one pass with two targets");
        row("a second geometry pass halves the frame rate; several targets do not", &measured, &verdict);
    }
}

fn subdivided(model: &Model) -> Model {
    pn_triangles::tessellate(model, 2).expect("2 segments")
}

/// Buffers for passes over pixels alone.
struct Pixels {
    texels: wgpu::TextureView,
    code: DepthCode,
    ink: wgpu::TextureView,
    picture: wgpu::TextureView,
    /// The ink of the filter, found on the CPU.
    found: Vec<u8>,
}

const PICTURE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

impl Pixels {
    fn new(context: &GpuContext, scene: &Scene, view: &View) -> Self {
        let style = lambert(Lines::image(ImageInk::default()));
        let plan = Plan::new(scene, &style, view, &Capabilities::RAY_CASTER).expect("a good style");
        let frame = cpu::render(scene, &plan, &CpuOptions::default(), &|_| {});
        let image = plan.image.as_ref().expect("lines in the image");
        let found = image.ink(&image.lines, &frame.texels);
        let texture = |format, bytes: &[u8]| {
            let extent = wgpu::Extent3d { width: view.size.0, height: view.size.1, depth_or_array_layers: 1 };
            let texture = context.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: extent,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::TEXTURE_BINDING
                    | wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            });
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(bytes.len() as u32 / view.size.1),
                rows_per_image: None,
            };
            context.queue.write_texture(texture.as_image_copy(), bytes, layout, extent);
            texture.create_view(&Default::default())
        };
        let count = view.size.0 as usize * view.size.1 as usize;
        let words: Vec<u8> = frame.texels.iter().flatten().flat_map(|word| word.to_ne_bytes()).collect();
        Self {
            texels: texture(texel_format(TexelLayout::Bits64), &words),
            code: image.code,
            ink: texture(INK_FORMAT, &found),
            picture: texture(PICTURE_FORMAT, &vec![200; 4 * count]),
            found,
        }
    }

    /// Records a pass some times, so that a submission is short beside it.
    fn repeated<'a>(
        &'a self,
        context: &'a GpuContext,
        record: impl Fn(&mut wgpu::CommandEncoder) + 'a,
    ) -> Box<dyn FnMut() + 'a> {
        Box::new(move || {
            let mut encoder = context.device.create_command_encoder(&Default::default());
            for _ in 0..8 {
                record(&mut encoder);
            }
            context.queue.submit([encoder.finish()]);
            context.wait().expect("the pass runs");
        })
    }

    /// The filter, into an ink picture.
    fn filter<'a>(&'a self, context: &'a GpuContext, pass: &'a FusedPass) -> Box<dyn FnMut() + 'a> {
        let composite = Composite::Multiply;
        self.repeated(context, move |encoder| {
            let target = PassTarget { view: &self.ink, composite: &composite, area: None };
            pass.record(&context.device, encoder, &FusedFilter::default(), &self.code, &self.texels, &target)
                .expect("the textures fit");
        })
    }
}

/// The composite of stored ink over a picture, with and without the alpha test, and the bytes that each writes.
fn alpha_test(context: &GpuContext, rounds: &Rounds) {
    let size = (1280, 720);
    let pass = CompositePass::new(&context.device, InkTarget::Picture(PICTURE_FORMAT)).expect("a picture's format");
    let forms =
        [Composite::Multiply, Composite::AlphaTested(AlphaTest::CORRECTED), Composite::AlphaTested(AlphaTest::PRINTED)];
    for (name, model) in [("built-in scene", Some(embedded::scene())), ("bunny", shared("stanford-bunny.obj"))] {
        let Some(model) = model else { continue };
        let (scene, view) = framed(model, size);
        let pixels = Pixels::new(context, &scene, &view);
        let mut cases = forms.each_ref().map(|composite| {
            pixels.repeated(context, |encoder| {
                let target = PassTarget { view: &pixels.picture, composite, area: None };
                pass.record(&context.device, encoder, &pixels.ink, &target).expect("the textures fit");
            })
        });
        let times = timed(&mut cases, rounds);
        let [tested, printed] = [1, 2].map(|case| ratio(&times[case], &times[0]));
        let all = 4 * pixels.found.len();
        let written =
            |test| 4 * pixels.found.iter().filter(|&&ink| ink_alpha_passes(f64::from(ink) / 255.0, test)).count();
        let [bytes, printed_bytes] = [AlphaTest::CORRECTED, AlphaTest::PRINTED].map(written);
        let measured = format!(
            "{name}, 1280 × 720: over multiplying all pixels, time {tested:.2}, bytes written {:.4} ({bytes} of {all}); \
             as printed, time {printed:.2}, bytes {:.4}",
            bytes as f64 / all as f64,
            printed_bytes as f64 / all as f64
        );
        let holds = if tested < 0.95 { "holds in bytes and in time here" } else { "holds in bytes, not in time here" };
        row(
            "the alpha test of the composite saves bandwidth",
            &measured,
            &format!("{holds}; as printed it keeps the white"),
        );
    }
}

/// The filter's time against that of the geometry, on models of more and more polygons that look alike.
fn polygons(context: &GpuContext, rounds: &Rounds) {
    let size = (1280, 720);
    let renderer = GpuRenderer::new(context);
    let pass = FusedPass::new(&context.device, &FusedFilter::default(), TexelLayout::Bits64, InkTarget::Ink)
        .expect("an ink picture");
    let bunny = shared("stanford-bunny.obj");
    let finer = bunny.as_ref().map(subdivided);
    let families = [
        ("spheres", [24, 96, 384, 1024].map(|segments| Some(embedded::sphere(segments))).to_vec()),
        ("suzanne, bunny, bunny subdivided", vec![shared("suzanne.obj"), bunny, finer]),
    ];
    for (name, models) in families {
        let models: Vec<Model> = models.into_iter().flatten().collect();
        if models.len() < 2 {
            continue;
        }
        let shown: Vec<(Scene, View)> = models.into_iter().map(|model| framed(model, size)).collect();
        let pixels: Vec<Pixels> = shown.iter().map(|(scene, view)| Pixels::new(context, scene, view)).collect();
        let filters = pixels.iter().map(|pixels| pixels.filter(context, &pass));
        let geometry = shown.iter().map(|(scene, view)| {
            let plan = Plan::new(scene, &lambert(Lines::NONE), view, &context.capabilities).expect("a good style");
            frames(context, &renderer, scene, plan)
        });
        let mut cases: Vec<_> = filters.chain(geometry).collect();
        let times = timed(&mut cases, rounds);
        let count = shown.len();
        let over = |first: usize| {
            let ratios: Vec<f64> = (0..count).map(|i| ratio(&times[first + i], &times[first])).collect();
            let text = ratios.iter().map(|ratio| format!("{ratio:.2}")).collect::<Vec<_>>().join(", ");
            (ratios, text)
        };
        let ((filter, filter_text), (_, geometry_text)) = (over(0), over(count));
        let faces = shown.iter().map(|(scene, _)| scene.face_count().to_string()).collect::<Vec<_>>().join(", ");
        let measured = format!(
            "{name} of {faces} faces, 1280 × 720, over the first: the filter {filter_text}; the geometry {geometry_text}"
        );
        let spread = filter.iter().fold(0.0f64, |most, ratio| most.max((ratio - 1.0).abs()));
        let verdict = format!(
            "{}: the filter's time varies by {:.0} %",
            if spread < 0.2 { "holds" } else { "does not hold" },
            100.0 * spread
        );
        row("the inker's cost does not depend on polygons", &measured, &verdict);
    }
}

/// A smooth sphere farther and farther away, inked by the constant and by the falling normal threshold.
fn depth_scaled_threshold() {
    let size = (640u32, 360u32);
    let scene = Scene::new(embedded::sphere(96));
    let fov_y_rad = 30f64.to_radians();
    let focal_px = f64::from(size.1) / 2.0 / (fov_y_rad / 2.0).tan();
    let distances = [11.0, 17.0, 22.0, 34.0, 45.0, 67.0, 96.0, 134.0];
    let far = distances[distances.len() - 1];
    let constant = Inker { normal_fall: 0.0, ..Inker::default() };
    let falling = Inker::default();
    let low = Inker { normal_cos: falling.normal_cos - falling.normal_fall, ..constant };
    let share = |distance: f64, inker: &Inker, far: f64| {
        let camera = Camera {
            eye: DVec3::Z * distance,
            target: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Perspective { fov_y_rad },
            near: 0.1,
        };
        let style = lambert(Lines::image(ImageInk::default()));
        let plan =
            Plan::new(&scene, &style, &View::new(camera, size), &Capabilities::RAY_CASTER).expect("a good style");
        let code = plan.image.as_ref().expect("lines in the image").code;
        let frame = cpu::render(&scene, &plan, &CpuOptions::default(), &|_| {});
        let bytes = |&words: &[u32; 2]| {
            let tap = ink_texel64_tap(words);
            if tap.region == 0 {
                return CLEAR;
            }
            let normal = tap.normal.as_vec3().normalize_or_zero();
            ink_printed_encode(normal, (code.depth(tap.depth as u32) / far) as f32)
        };
        let bytes: Vec<[u8; 4]> = frame.texels.iter().map(bytes).collect();
        let ink =
            filter_picture(&bytes, UVec2::from(size), Taps::Diagonal, |_, taps| ink_printed_inker(inker, taps) as f32)
                .expect("one for each pixel");
        // Well within the contour: not the outline, and not where the surface turns away within a few pixels.
        let radius_px = focal_px / distance;
        let inner_px = (radius_px - 2.5).min(0.7 * radius_px);
        let middle = DVec2::new(f64::from(size.0), f64::from(size.1)) / 2.0;
        let pixels = (0..size.1).flat_map(|y| (0..size.0).map(move |x| DVec2::new(f64::from(x), f64::from(y)) + 0.5));
        let inner: Vec<bool> =
            pixels.zip(ink).filter(|(at, _)| at.distance(middle) < inner_px).map(|(_, ink)| ink > 0).collect();
        100.0 * inner.iter().filter(|&&ink| ink).count() as f64 / inner.len() as f64
    };
    let list =
        |inker: &Inker, far: f64| distances.map(|distance| format!("{:.0}", share(distance, inker, far))).join(", ");
    let radii = distances.map(|distance| format!("{:.0}", focal_px / distance)).join(", ");
    let measured = format!(
        "a smooth sphere of {radii} px radius, the last at the far plane: % of its inside inked, threshold constant 0.9: \
         {}; 0.9 − 0.25 depth, as printed: {}, and with the far plane four times as far: {}; constant 0.65: {}",
        list(&constant, far),
        list(&falling, far),
        list(&falling, 4.0 * far),
        list(&low, far)
    );
    // Two faces that meet at an angle, near the eye.
    let folded = |inker: &Inker, angle_deg: f64| {
        let normal = |angle: f64| Vec3::new(angle.sin() as f32, 0.0, angle.cos() as f32);
        let [flat, tilted] = [0.0, angle_deg.to_radians()].map(|angle| ink_printed_encode(normal(angle), 0.1));
        ink_printed_inker(inker, [tilted, flat, flat, tilted]) > 0.5
    };
    let sharpest = |inker: &Inker| (1..=90).find(|&angle| folded(inker, f64::from(angle))).unwrap_or(90);
    let verdict = format!(
        "holds, if the far plane is not much farther than what is seen; a constant as low is as clean, but near by misses \
         folds below {}° instead of {}°",
        sharpest(&low),
        sharpest(&falling)
    );
    row("the depth-scaled threshold cures lines in the distance", &measured, &verdict);
}

/// Printed fins and lines from edges against the exact contours of coarse and fine spheres and of a cube.
fn fins() {
    let size = (480, 270);
    let silhouettes = |width| LineStyle { width_px: [width, width, 0.0, 0.0, 0.0], ink: [0.0, 0.0, 0.0, 1.0] };
    let black_on_white = |lines| Style {
        paper: Vec3::ONE,
        shade: Shade::Paper,
        lines,
        ..style("cartoon").expect("a style of this crate")
    };
    let models = [
        ("sphere of 8 segments", embedded::sphere(8)),
        ("sphere of 16 segments", embedded::sphere(16)),
        ("sphere of 32 segments", embedded::sphere(32)),
        ("sphere of 96 segments", embedded::sphere(96)),
        ("torus of 10 × 6 segments", embedded::torus(1.0, 0.4, 10, 6)),
        ("cone of 8 sides", embedded::cone(8)),
        ("cube", embedded::cube()),
    ];
    for (name, model) in models {
        let scene = Scene::new(model);
        let views = [(0.35, 0.3), (1.3, -0.2), (2.5, 0.7), (4.1, 0.1), (5.2, -0.5), (0.9, 1.1)];
        // F1 and recall of 1 px, the recall of creases too, and the share of the contour that is narrower than half, or wider than one and a half
        // times, of what is asked for; fins, then lines.
        let mut sums = [[0.0; 4]; 2];
        for (yaw_rad, pitch_rad) in views {
            let framing = Framing { yaw_rad, pitch_rad, ..Framing::default() };
            let camera = Camera::framed(scene.corners(), f64::from(size.0) / f64::from(size.1), &framing);
            // Without and with creases: fins are drawn at silhouettes alone.
            let [truth, with_creases] = [std::f64::consts::PI, std::f64::consts::FRAC_PI_4]
                .map(|crease_angle_rad| true_lines(&scene, &camera, size, crease_angle_rad));
            let dark = |lines| {
                let plan =
                    Plan::new(&scene, &black_on_white(lines), &View::new(camera, size), &Capabilities::RAY_CASTER)
                        .expect("a good style");
                let image = cpu::render(&scene, &plan, &CpuOptions::default(), &|_| {}).image();
                image.rgba8.chunks_exact(4).map(|p| 1.0 - f64::from(p[1]) / 255.0).collect::<Vec<f64>>()
            };
            let fins = |width_px| dark(Lines::printed(PrintedLines { width_px, ..PrintedLines::default() }));
            let edges = |width_px| dark(Lines::edges(silhouettes(width_px)));
            for (sums, [thin, wide]) in sums.iter_mut().zip([[fins(1.0), fins(WIDE_PX)], [edges(1.0), edges(WIDE_PX)]])
            {
                let drawn = drawn_centreline(&thin, size.0, size.1);
                let [found, of_all] = [&truth, &with_creases].map(|truth| accuracy(truth, &drawn, 1.5));
                let misfit = share_of_misfits(&truth, &wide, WIDE_PX);
                for (sum, value) in sums.iter_mut().zip([found.f1, found.recall, of_all.recall, misfit]) {
                    *sum += value / views.len() as f64;
                }
            }
        }
        let [[f1, recall, of_all, misfit], [line_f1, line_recall, _, line_misfit]] = sums;
        let holds = if misfit < 0.05 && recall > 0.99 { "does not hold for its contour" } else { "holds" };
        row(
            "fins are poor on low-poly and angular models",
            &format!(
                "{name}, its contour: fins F1 {f1:.3}, recall {recall:.3} (with creases {of_all:.3}), {:.1} % off the width \
                 of {WIDE_PX} px by more than half; lines from edges {line_f1:.3}, {line_recall:.3}, {:.1} %",
                100.0 * misfit,
                100.0 * line_misfit
            ),
            &format!(
                "{holds}: fins miss {:.1} % of the contour, and {:.0} % of the lines with creases",
                100.0 * (1.0 - recall),
                100.0 * (1.0 - of_all)
            ),
        );
    }
}

/// The width of the lines whose width is measured, px.
const WIDE_PX: f32 = 6.0;

/// The share of the visible contour where a line, measured across it, is narrower than half of the width asked for or
/// wider than one and a half times that.
fn share_of_misfits(truth: &TrueLines, darkness: &[f64], width_px: f32) -> f64 {
    const STEP_PX: f64 = 0.25;
    let (columns, rows) = truth.size_px;
    let (mut all, mut misfits) = (0.0, 0.0);
    for (point, length, segment) in truth.samples() {
        let [from, to] = truth.segments[segment].ends_px;
        let across = (to - from).normalize_or_zero().perp();
        let reach = (2.0 * f64::from(width_px) / STEP_PX) as i32;
        let dark = (-reach..=reach).map(|step| {
            let DVec2 { x, y } = point + across * (f64::from(step) * STEP_PX);
            let is_inside = x >= 0.0 && y >= 0.0 && x < f64::from(columns) && y < f64::from(rows);
            if is_inside { darkness[y as usize * columns as usize + x as usize] } else { 0.0 }
        });
        let ratio = dark.sum::<f64>() * STEP_PX / f64::from(width_px);
        all += length;
        misfits += if (0.5..=1.5).contains(&ratio) { 0.0 } else { length };
    }
    misfits / all
}
