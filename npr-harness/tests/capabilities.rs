//! Tests with each capability of an adapter removed in turn: the picture stays within the largest difference of `npr
//! check`, and the methods name the reason. Failures that cannot be predicted fall back to the next method, and finally
//! to the CPU.
#![cfg(feature = "gpu")]

mod common;

use common::{device, planned};
use glam::Vec4;
use npr_harness::camera::{Camera, Framing};
use npr_harness::capabilities::{Capabilities, ExecutorKind};
use npr_harness::check::{PLACES, Reference, Shot, magnitude};
use npr_harness::compare::{Tolerance, compare};
use npr_harness::cpu::PrimaryHits;
use npr_harness::edge_lines::EdgeLineMethod;
use npr_harness::error::HarnessError;
use npr_harness::executor::{Backend, CpuReason, Executor, GpuPolicy, Picture, Rendered};
use npr_harness::gallery::{painted_camera, painted_scene, still_life_camera};
use npr_harness::gpu::{self, DeviceLimits, GpuAdapter, GpuContext, GpuRenderer};
use npr_harness::image_lines::ImageInk;
use npr_harness::picture::Image;
use npr_harness::plan::Plan;
use npr_harness::scene::Scene;
use npr_harness::style::{Lines, Style, style};
use npr_harness::view::View;
use npr_imagespace::artist::ArtistRotation;
use npr_mesh::{AlphaMode, Material, Texture, Wrap, embedded};

const SIZE: (u32, u32) = (192, 108);

/// Edge lines, image-space lines, dilation of ink of another size, shadow volumes, and both encodings of strokes.
const STYLES: [&str; 6] = ["cartoon", "ink-image", "ink-thick", "toon-shadow", "hatch-planes", "hatch-shadow"];

fn context(limits: DeviceLimits) -> Option<GpuContext> {
    // Reports a missing adapter, or fails if one is required.
    device()?;
    Some(GpuAdapter::find().expect("it was there").open(limits).expect("it opens"))
}

struct Shown {
    scene: Scene,
    camera: Camera,
}

impl Shown {
    fn new(camera: Camera) -> Self {
        Self { scene: Scene::new(embedded::scene()), camera }
    }

    fn parallel() -> Self {
        let scene = Scene::new(embedded::scene());
        let aspect = f64::from(SIZE.0) / f64::from(SIZE.1);
        let framing = Framing { fov_y_rad: None, ..Framing::default() };
        Self { camera: Camera::framed(scene.corners(), aspect, &framing), scene }
    }

    /// Compares pictures of a device with some capabilities disabled with the reference.
    fn check<'a>(&self, context: &GpuContext, style: &Style, cases: impl IntoIterator<Item = (&'a str, Capabilities)>) {
        let plan = planned(&self.scene, style, &self.camera, SIZE);
        let hits = PrimaryHits::kept(&self.scene, View::new(self.camera, SIZE), PLACES);
        let magnitude = magnitude(&plan);
        let mut reference = Reference::new(Shot { hits: &hits, style, plan: &plan }).expect("the sizes are one");
        let tolerance = [Tolerance { magnitude, count: 0 }];
        let mut closer = false;
        for (what, capabilities) in cases {
            let image = self.render(context, &capabilities, style).expect("a picture");
            let mut comparison = compare(&reference.image, &image, &reference.exempt).expect("one size");
            if !comparison.passes(&tolerance) && !closer {
                reference.look_closer().expect("one size");
                closer = true;
                comparison = compare(&reference.image, &image, &reference.exempt).expect("one size");
            }
            let name = &style.name;
            assert!(comparison.passes(&tolerance), "{name}, {what}: {} of 255", comparison.worst);
            // A small picture has more edges per pixel than those of `npr check`.
            assert!(comparison.exempt_share() < 0.1, "{name}, {what}: {} exempt", comparison.exempt_share());
        }
    }

    fn plan(&self, style: &Style, capabilities: &Capabilities) -> Result<Plan, HarnessError> {
        self.plan_of(style, capabilities, SIZE, 1)
    }

    fn plan_of(
        &self,
        style: &Style,
        capabilities: &Capabilities,
        size: (u32, u32),
        samples: u32,
    ) -> Result<Plan, HarnessError> {
        Plan::new(&self.scene, style, &View { samples, ..View::new(self.camera, size) }, capabilities)
    }

    fn render(&self, context: &GpuContext, capabilities: &Capabilities, style: &Style) -> Result<Image, HarnessError> {
        gpu::render(context, &self.scene, &self.plan(style, capabilities)?)
    }
}

fn named(name: &str) -> Style {
    style(name).expect("a style of this crate")
}

/// The capability removed, and the methods that a style then reports.
type Case = (&'static str, fn(&mut Capabilities), &'static str, &'static str);

const HARDWARE: ExecutorKind = ExecutorKind::HardwareAdapter;

const CASES: [Case; 8] = [
    ("nothing", |c| c.kind = HARDWARE, "cartoon", "found and drawn on the device"),
    ("compute shaders", |c| (c.kind, c.compute) = (HARDWARE, false), "cartoon", "the adapter has no compute shaders"),
    (
        "storage in vertex shaders",
        |c| (c.kind, c.vertex_storage) = (HARDWARE, false),
        "cartoon",
        "no storage buffers in vertex shaders",
    ),
    (
        "indirect draws",
        |c| (c.kind, c.indirect_draws) = (HARDWARE, false),
        "cartoon",
        "no draws with arguments in a buffer",
    ),
    ("a stencil beside floats", |c| c.float_stencil = false, "toon-shadow", "no stencil beside floats"),
    ("depth as computed", |c| c.exact_depth = false, "lines", "multiples of 2^-24"),
    ("a software adapter's filtering", |c| c.kind = ExecutorKind::SoftwareAdapter, "hatch-planes", "half floats"),
    ("hardware's filtering", |c| c.kind = HARDWARE, "hatch-planes", "bytes"),
];

#[test]
fn without_a_capability_the_picture_is_right_and_the_reason_named() {
    let Some(context) = context(DeviceLimits::Adapter) else { return };
    let shown = Shown::new(still_life_camera());
    let cases = CASES.map(|(what, take, ..)| {
        let mut capabilities = context.capabilities.clone();
        take(&mut capabilities);
        (what, capabilities)
    });
    for name in STYLES {
        shown.check(&context, &named(name), cases.clone());
    }
    for ((what, capabilities), (.., of_style, said)) in cases.iter().zip(CASES) {
        let style = named(of_style);
        let methods = shown.plan(&style, capabilities).expect("a small picture").methods;
        assert!(methods.iter().any(|method| method.why.contains(said)), "{what}: {methods:?}");
    }
}

/// On hardware, each of the three capabilities for finding lines on the GPU is reported as the reason if it alone is
/// missing.
#[test]
fn lines_are_found_on_the_cpu_for_the_reason_that_is_there() {
    let all = Capabilities {
        kind: HARDWARE,
        compute: true,
        no_compute: "the adapter has no compute shaders",
        vertex_storage: true,
        indirect_draws: true,
        unclipped_depth: true,
        float_stencil: true,
        exact_depth: true,
        float_targets: true,
        texture_px: 2048,
        storage_bytes: 1 << 27,
        uniform_alignment: 256,
        memory_bytes: 1 << 31,
    };
    assert_eq!(all.edge_lines(1 << 27, 1), (EdgeLineMethod::OnDevice, "found and drawn on the device".to_owned()));
    for (missing, reason) in [
        (Capabilities { storage_bytes: 1 << 19, ..all.clone() }, "so many edges"),
        (Capabilities { compute: false, ..all.clone() }, "compute shaders"),
        (Capabilities { vertex_storage: false, ..all.clone() }, "storage buffers in vertex shaders"),
        (Capabilities { indirect_draws: false, ..all.clone() }, "draws with arguments in a buffer"),
    ] {
        let (method, why) = missing.edge_lines(1 << 20, 1);
        assert_eq!(method, EdgeLineMethod::OnCpu, "{reason}");
        assert!(why.contains(reason), "{why}");
    }
    let software = Capabilities { kind: ExecutorKind::SoftwareAdapter, ..all };
    assert_eq!(software.edge_lines(1 << 20, 1).0, EdgeLineMethod::OnCpu);
}

#[test]
fn shadow_volumes_in_a_parallel_view_need_unclipped_depth() {
    let Some(context) = context(DeviceLimits::Adapter) else { return };
    let shown = Shown::parallel();
    let style = named("toon-shadow");
    if context.capabilities.unclipped_depth {
        shown.check(&context, &style, [("parallel", context.capabilities.clone())]);
    }
    let clipped = Capabilities { unclipped_depth: false, ..context.capabilities.clone() };
    assert!(matches!(shown.plan(&style, &clipped), Err(HarnessError::ParallelVolumes)));
    let perspective = Shown::new(still_life_camera());
    perspective.plan(&style, &clipped).expect("perspective views have no far plane");
}

#[test]
fn under_webgl2_limits_pictures_are_right_or_the_texture_is_named() {
    let Some(mut context) = context(DeviceLimits::Webgl2) else { return };
    let capabilities = &context.capabilities;
    assert!(!capabilities.compute && !capabilities.can_find_lines() && capabilities.texture_px == 2048);
    let shown = Shown::new(still_life_camera());
    for name in STYLES {
        shown.check(&context, &named(name), [("WebGL2", context.capabilities.clone())]);
    }
    // The most that a vertex hands to its pixels: strokes and lines in the image, with an artist's directions.
    let painted = Shown { scene: painted_scene(), camera: painted_camera() };
    for artist in [ArtistRotation::PerVertex, ArtistRotation::PerObject].map(Some) {
        let lines = Lines::image(ImageInk { artist, ..ImageInk::default() });
        for name in ["hatch", "toon"] {
            let style = Style { lines, ..named(name) };
            painted.check(&context, &style, [("WebGL2", context.capabilities.clone())]);
        }
    }
    // The ink has twice the size of 1280 × 720.
    let style = named("ink-thick");
    let refused = shown.plan_of(&style, capabilities, (1280, 720), 1);
    let Err(HarnessError::TextureTooLarge { what: "the ink", width: 2560, height: 1440, limit: 2048 }) = refused else {
        panic!("{refused:?}")
    };
    let samples = |samples| shown.plan_of(&named("cartoon"), &context.capabilities, (960, 540), samples);
    samples(2).expect("1920 × 1080 samples");
    assert!(matches!(samples(3), Err(HarnessError::TextureTooLarge { what: "the picture's samples", .. })));

    // If the driver rejects compute shaders although it reports support, the next method is used.
    let promised = &mut context.capabilities;
    (promised.kind, promised.compute) = (HARDWARE, true);
    (promised.vertex_storage, promised.indirect_draws, promised.storage_bytes) = (true, true, 1 << 27);
    let cartoon = named("cartoon");
    let refused = shown.render(&context, &context.capabilities, &cartoon);
    assert!(matches!(refused, Err(HarnessError::Device { .. } | HarnessError::Outline(_))), "{refused:?}");
    let mut executor = Executor::Gpu(Box::new(context));
    let picture = Picture::new(&shown.scene, &cartoon, View::new(shown.camera, SIZE));
    for _ in 0..2 {
        let rendered = executor.render_with_fallback(Backend::Auto, &picture, &|_| {});
        let Rendered { plan, why_cpu, .. } = rendered.expect("without compute shaders it can");
        assert_eq!(why_cpu, None);
        let says = |text: &str| plan.methods.iter().any(|method| method.why.contains(text));
        assert!(says("found on the CPU") && says("the driver refused"), "{:?}", plan.methods);
    }
}

#[test]
fn what_a_device_cannot_make_the_cpu_makes_unless_a_device_is_required() {
    let Some(context) = context(DeviceLimits::Webgl2) else { return };
    let scene = Scene::new(embedded::cube());
    let camera = Camera::framed(scene.corners(), 1100.0 / 8.0, &Framing::default());
    let style = named("ink-thick");
    let picture = Picture::new(&scene, &style, View::new(camera, (1100, 8)));
    let mut executor = Executor::Gpu(Box::new(context));
    let required = GpuPolicy::from_env().expect("a policy") == GpuPolicy::Required;
    for backend in [Backend::Auto, Backend::Gpu] {
        let done = executor.render_with_fallback(backend, &picture, &|_| {});
        if required || backend == Backend::Gpu {
            assert!(matches!(done, Err(HarnessError::TextureTooLarge { what: "the ink", .. })), "{backend:?}");
            continue;
        }
        let Rendered { image, why_cpu: why, .. } = done.expect("the CPU makes it");
        assert_eq!((image.width, image.height), (1100, 8));
        assert!(matches!(&why, Some(CpuReason::Unable(why)) if why.contains("2200 × 16")), "{why:?}");
    }
    assert!(!executor.is_cpu(), "the device still makes smaller pictures");
    if !required {
        let Executor::Gpu(context) = &executor else { panic!("a device") };
        context.device.destroy();
        let small = Picture { view: View::new(camera, (16, 16)), ..picture };
        let rendered = executor.render_with_fallback(Backend::Auto, &small, &|_| {});
        let why = rendered.expect("the CPU makes it").why_cpu;
        assert!(matches!(&why, Some(CpuReason::Unable(why)) if why.contains("lost")), "{why:?}");
        assert!(executor.is_cpu(), "a lost device makes no further picture");
    }
}

#[test]
fn a_texture_beyond_the_limits_is_refused_by_name() {
    let Some(context) = context(DeviceLimits::Webgl2) else { return };
    let mut model =
        common::cards(1, 1.0, |_| Material { texture: Some(0), ..common::plain(Vec4::ONE, AlphaMode::Opaque, true) });
    let texels = |width: u32| Texture {
        width,
        height: 1,
        rgba8: vec![128; 4 * width as usize].into(),
        ..common::waves(1, 1, [Wrap::Repeat; 2], true)
    };
    for (width, fits) in [(2048, true), (2049, false)] {
        model.textures = vec![texels(width)];
        let scene = Scene::new(model.clone());
        let camera = Camera::framed(scene.corners(), 1.0, &Framing::default());
        let style = named("toon");
        let view = View::new(camera, SIZE);
        let on_device = Plan::new(&scene, &style, &view, &context.capabilities).map(|_| ());
        // A plan for another executor.
        let uploaded = GpuRenderer::new(&context).upload(&scene, &planned(&scene, &style, &camera, SIZE)).map(|_| ());
        for refused in [on_device, uploaded] {
            let named = matches!(
                refused,
                Err(HarnessError::TextureTooLarge { what: "a texture of the model", limit: 2048, .. })
            );
            assert!(if fits { refused.is_ok() } else { named }, "{width}: {refused:?}");
        }
    }
}
