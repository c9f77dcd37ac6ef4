//! Tests that missing capabilities and failures of a device are errors.
#![cfg(feature = "gpu")]

mod common;

use common::{cards, device, plain, rendered};
use glam::Vec4;
use npr_harness::camera::{Camera, Framing};
use npr_harness::error::HarnessError;
use npr_harness::executor::{Backend, Executor, GpuPolicy, Picture};
use npr_harness::gpu::{GpuContext, GpuRenderer};
use npr_harness::scene::Scene;
use npr_harness::style::{style, styles};
use npr_harness::view::View;
use npr_mesh::{AlphaMode, embedded};

fn on_device() -> Option<Box<GpuContext>> {
    match device()? {
        Executor::Gpu(context) => Some(context),
        Executor::Cpu { .. } => None,
    }
}

fn render(executor: &Executor, name: &str, size: (u32, u32)) -> Result<(), HarnessError> {
    let scene = Scene::new(embedded::cube());
    let style = style(name).expect("it is there");
    let camera = Camera::framed(scene.corners(), f64::from(size.0) / f64::from(size.1), &Framing::default());
    executor.render(&Picture::new(&scene, &style, View::new(camera, size)), &|_| {}).map(|_| ())
}

#[test]
fn a_lost_device_is_an_error_in_every_style() {
    for style in styles() {
        let Some(context) = on_device() else { return };
        context.device.destroy();
        let done = render(&Executor::Gpu(context), &style.name, (16, 16));
        let Err(error @ HarnessError::Lost { .. }) = &done else { panic!("{}: {done:?}", style.name) };
        let said = error.to_string();
        assert!(said.starts_with("the graphics device was lost: ") && said.lines().count() == 1, "{said}");
    }
}

/// The device is lost between two frames.
#[test]
fn a_device_may_be_lost_while_it_is_used() {
    let Some(context) = on_device() else { return };
    let scene = Scene::new(embedded::cube());
    let style = style("cartoon").expect("it is there");
    let camera = Camera::framed(scene.corners(), 1.0, &Framing::default());
    let renderer = GpuRenderer::new(&context);
    let plan = renderer.plan(&scene, &style, &View::new(camera, (32, 32))).expect("a good style");
    let targets = renderer.targets(&plan.view).expect("targets");
    let uploaded = renderer.upload(&scene, &plan).expect("an upload");
    renderer.draw(&scene, &uploaded, &plan, &targets).expect("drawn");
    renderer.read(&targets).expect("a picture");
    context.device.destroy();
    // Commands for a lost device report no error until the result is read.
    let _ = renderer.draw(&scene, &uploaded, &plan, &targets);
    let read = renderer.read(&targets);
    assert!(matches!(read, Err(HarnessError::Lost { .. })), "{read:?}");
}

#[test]
fn what_a_device_refuses_is_an_error_once() {
    let Some(context) = on_device() else { return };
    let usage = wgpu::BufferUsages::VERTEX;
    let too_large = context.device.limits().max_buffer_size.saturating_add(1) & !3;
    let buffer = |size| {
        let descriptor = wgpu::BufferDescriptor { label: Some("too large"), size, usage, mapped_at_creation: false };
        let _ = context.device.create_buffer(&descriptor);
    };
    buffer(too_large.max(1 << 60));
    let refused = context.wait();
    let Err(HarnessError::Device { fault } | HarnessError::OutOfMemory { fault }) = &refused else {
        panic!("{refused:?}")
    };
    assert!(fault.contains("too large") && fault.lines().count() == 1, "{fault}");
    context.wait().expect("it was told");
    render(&Executor::Gpu(context), "cartoon", (16, 16)).expect("the device goes on");
}

/// No adapter can allocate this much memory.
#[test]
fn a_device_without_memory_is_an_error() {
    let Some(context) = on_device() else { return };
    let size = context.device.limits().max_buffer_size.min(1 << 46) & !3;
    let mut kept = Vec::new();
    for _ in 0..1 << 12 {
        kept.push(filled_of(&context, size));
        match context.wait() {
            Ok(()) => {}
            Err(HarnessError::OutOfMemory { fault }) => {
                assert_eq!(fault.lines().count(), 1, "{fault}");
                return;
            }
            Err(other) => panic!("{other}"),
        }
    }
    // A software adapter can allocate as much as the system allows, so the test runs again with a limit.
    assert!(std::env::var_os("NPR_TEST_LIMITED").is_none(), "any memory is promised");
    let own = std::env::current_exe().expect("a test is a file");
    let limited = "ulimit -v 60000000 && NPR_TEST_LIMITED=1 exec \"$0\" --exact a_device_without_memory_is_an_error";
    let done = std::process::Command::new("sh").arg("-c").arg(limited).arg(own).output().expect("there is a shell");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stdout));
}

fn filled_of(context: &GpuContext, size: u64) -> wgpu::Buffer {
    context.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("large"),
        size,
        usage: wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    })
}

#[test]
fn pictures_beyond_the_limits_are_refused_by_name() {
    let Some(context) = on_device() else { return };
    let limit = context.device.limits().max_texture_dimension_2d;
    let executor = Executor::Gpu(context);
    for (name, size) in [("cartoon", (limit + 1, 2)), ("lines", (2, limit + 1)), ("ink-thick", (limit / 2 + 1, 2))] {
        let done = render(&executor, name, size);
        let Err(HarnessError::TextureTooLarge { limit: said, .. }) = done else { panic!("{name}: {done:?}") };
        assert_eq!(said, limit);
        let error = HarnessError::TextureTooLarge { what: "the picture", width: size.0, height: size.1, limit };
        let fallback = Executor::fallback(Backend::Auto, error);
        if GpuPolicy::from_env().expect("a policy") == GpuPolicy::Auto {
            assert!(fallback.is_ok_and(|executor| executor.is_cpu()));
        } else {
            assert!(fallback.is_err(), "a device was asked for");
        }
    }
    render(&executor, "cartoon", (limit, 1)).expect("as long as can be");
}

/// 3,000 cards that do not occlude each other, with as many materials, all different or all equal.
fn many_cards(different: bool) -> Scene {
    let mut scene = cards(3_000, 1.0, |n| {
        let shade = if different { n as f32 / 3e3 } else { 0.5 };
        plain(Vec4::new(shade, 0.4, 0.8, 1.0), AlphaMode::Opaque, true)
    });
    scene.materials.iter_mut().enumerate().for_each(|(n, material)| material.name = n.to_string());
    Scene::new(scene)
}

/// With one draw per material, lavapipe used 0.4 MB per draw: 19 GB for 40,000 materials.
#[test]
fn many_materials_take_no_draw_each_or_are_refused() {
    let Some(context) = on_device() else { return };
    let is_software = context.is_software();
    let executor = Executor::Gpu(context);
    for different in [false, true] {
        let scene = many_cards(different);
        for style in ["cartoon", "ink-image", "toon-shadow"].map(|name| style(name).expect("it is there")) {
            let camera = Camera::framed(scene.corners(), 1.0, &Framing::default());
            let done = executor.render(&Picture::new(&scene, &style, View::new(camera, (32, 32))), &|_| {});
            if !(different && is_software) {
                done.expect("a picture");
                continue;
            }
            let Err(error @ HarnessError::TooManyDraws { draws: 3_000, .. }) = done else {
                panic!("{}: {done:?}", style.name)
            };
            if GpuPolicy::from_env().expect("a policy") == GpuPolicy::Auto {
                assert!(Executor::fallback(Backend::Auto, error).expect("the CPU").is_cpu());
            }
        }
    }
}

/// The first has another colour than those that follow, so that the picture shows which were drawn.
#[test]
fn faces_on_one_another_are_drawn_once_and_the_last_is_seen() {
    let Some(context) = on_device() else { return };
    let executor = Executor::Gpu(context);
    let mut model = embedded::cube();
    let faces = model.faces.len() as u32;
    model.materials = [0.2, 0.9].map(|red| plain(Vec4::new(red, 0.5, 0.5, 1.0), AlphaMode::Opaque, false)).to_vec();
    model.face_material = vec![1; faces as usize];
    let once = Scene::new(model.clone());
    model.face_material.fill(0);
    for _ in 0..50_000 / faces {
        model.faces.extend_from_within(..faces as usize);
        model.face_material.extend(vec![1; faces as usize]);
    }
    model.face_polygon.clear();
    model.face_polygon.extend(0..model.faces.len() as u32);
    let often = Scene::new(model);
    let style = style("toon-shadow").expect("it is there");
    let camera = Camera::framed(once.corners(), 1.0, &Framing::default());
    let pictures = [&once, &often].map(|scene| {
        let start = std::time::Instant::now();
        let picture = rendered(&executor, scene, &style, &camera, (1024, 1024));
        (picture, start.elapsed())
    });
    assert!(pictures[0].0 == pictures[1].0, "another picture");
    assert!(pictures[1].1 < 5 * pictures[0].1, "{:?} and {:?}", pictures[0].1, pictures[1].1);
}
