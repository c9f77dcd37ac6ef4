//! Tests with models of any size and position.

mod common;

use common::rendered;

use glam::{DVec3, DVec4, Vec3, Vec4};
use npr_harness::camera::{Camera, Framing};
use npr_harness::compare::compare;
use npr_harness::executor::{Backend, Executor};
use npr_harness::lights::{LightFrame, StyleLight};
use npr_harness::picture::Image;
use npr_harness::scene::Scene;
use npr_harness::style::{Style, style, styles};
#[cfg(feature = "gpu")]
use npr_harness::view::View;
use npr_mesh::{AlphaMode, Model, embedded};
use npr_toon::source::Light;

const SIZE: (u32, u32) = (160, 120);

fn picture(executor: &Drawing<'_>, scene: &Scene, style: &Style, fov_y_rad: Option<f64>) -> Image {
    let framing = Framing { fov_y_rad, ..Framing::default() };
    let camera = Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &framing);
    match executor {
        Drawing::Rays(executor) => rendered(executor, scene, style, &camera, SIZE),
        #[cfg(feature = "gpu")]
        Drawing::Device(renderer, _) => {
            let plan = renderer.plan(scene, style, &View::new(camera, SIZE)).expect("a good style");
            let targets = renderer.targets(&plan.view).expect("targets");
            let uploaded = renderer.upload(scene, &plan).expect("an upload");
            renderer.draw(scene, &uploaded, &plan, &targets).expect("drawn");
            renderer.read(&targets).expect("a picture")
        }
    }
}

/// An executor that keeps its pipelines from picture to picture.
enum Drawing<'a> {
    Rays(&'a Executor),
    #[cfg(feature = "gpu")]
    Device(Box<npr_harness::gpu::GpuRenderer<'a>>, String),
}

impl Drawing<'_> {
    fn describe(&self) -> String {
        match self {
            Self::Rays(executor) => executor.describe(),
            #[cfg(feature = "gpu")]
            Self::Device(_, name) => name.clone(),
        }
    }
}

/// Runs the same on the CPU and, if there is one, on a GPU.
fn on_all(test: impl Fn(&Drawing<'_>)) {
    test(&Drawing::Rays(&Executor::choose(Backend::Cpu).expect("there is a CPU")));
    #[cfg(feature = "gpu")]
    if let Some(Executor::Gpu(context)) = common::device() {
        test(&Drawing::Device(Box::new(npr_harness::gpu::GpuRenderer::new(&context)), context.describe()));
    }
}

/// A teapot on a floor, not centred at the origin.
fn model() -> Model {
    let mut model = embedded::teapot(4);
    model.append(&embedded::ground(3.0));
    model
}

fn moved(mut model: Model, change: impl Fn(DVec3) -> DVec3) -> Model {
    for position in &mut model.positions {
        *position = change(position.as_dvec3()).as_vec3();
    }
    model
}

fn differing(a: &Image, b: &Image, magnitude: u8) -> u64 {
    compare(a, b, &[]).expect("one size").over(magnitude)
}

fn ink(image: &Image) -> usize {
    image.rgba8.chunks_exact(4).filter(|pixel| pixel[..3].iter().all(|&channel| channel < 90)).count()
}

/// Scaling by a power of two rounds nothing unless a number is denormal, so pictures are identical.
#[test]
fn every_style_is_the_same_at_sizes_that_are_powers_of_two() {
    on_all(|executor| {
        for style in styles() {
            for fov_y_rad in [Some(0.6), None] {
                let plain = picture(executor, &Scene::new(model()), &style, fov_y_rad);
                for octave in [-110, -21, -19, 19, 21, 110] {
                    let scaled = Scene::new(moved(model(), |p| p * 2f64.powi(octave)));
                    let far = picture(executor, &scaled, &style, fov_y_rad);
                    let count = differing(&plain, &far, 0);
                    assert_eq!(count, 0, "{} at 2^{octave} on {}", style.name, executor.describe());
                }
            }
        }
    });
}

/// Scaling by another factor rounds each coordinate to f32: at most one pixel in a thousand may differ by more than 2
/// of 255.
#[test]
fn lines_and_tones_are_those_of_any_other_size() {
    on_all(|executor| {
        for name in ["cartoon", "two-lights", "gooch", "ink-image", "printed-fins"] {
            let style = style(name).expect("it is there");
            let plain = picture(executor, &Scene::new(model()), &style, Some(0.6));
            assert!(ink(&plain) > 100, "{name}: {} px of ink", ink(&plain));
            for scale in [1e-38, 1e-30, 1e-20, 1e-10, 1e10, 1e20, 1e30, 5e37] {
                let far = picture(executor, &Scene::new(moved(model(), |p| p * scale)), &style, Some(0.6));
                let count = differing(&plain, &far, 2);
                assert!(count <= 19, "{name} at {scale:e} on {}: {count} px", executor.describe());
            }
        }
    });
}

/// At 1e7 an f32 cannot represent halves. A model with integer coordinates is exact there and must look exact.
#[test]
fn a_small_model_far_from_the_origin() {
    let cube = || moved(embedded::cube(), |p| (p * 8.0).round());
    on_all(|executor| {
        for name in ["cartoon", "two-lights", "hatch", "ink-image"] {
            let style = style(name).expect("it is there");
            for scale in [1.0, 1e-30f64, 1e30].map(|scale| 2f64.powi(scale.log2().round() as i32)) {
                let near = picture(executor, &Scene::new(moved(cube(), |p| p * scale)), &style, Some(0.6));
                assert!(ink(&near) > 100, "{name}: {} px of ink", ink(&near));
                for offset in [DVec3::new(1e7, 1e7, -1e7), DVec3::new(0.0, -16_777_000.0, 0.0)] {
                    let far = moved(cube(), |p| (p + offset) * scale);
                    let far = picture(executor, &Scene::new(far), &style, Some(0.6));
                    let count = differing(&near, &far, 2);
                    assert!(count <= 19, "{name} at {offset} × {scale:e} on {}: {count} px", executor.describe());
                }
            }
        }
    });
}

/// Positions of lights and clipping planes are in the model's units.
#[test]
fn lights_and_planes_go_with_a_model() {
    let plane = DVec4::new(0.3, -1.0, 0.2, 1.1);
    let light = DVec3::new(1.5, 2.5, 1.0);
    let shown = |executor: &Drawing<'_>, scale: f64, offset: DVec3| {
        let mut style = style("ink-image").expect("it is there");
        let place = ((light + offset) * scale).as_vec3();
        style.lights = vec![StyleLight { light: Light::positional(place), frame: LightFrame::World }];
        let mut scene = Scene::new(moved(model(), |p| (p + offset) * scale));
        let offset_of_plane = (plane.w - plane.truncate().dot(offset)) * scale;
        // The length of the normal has no effect.
        scene.clip = Some(scene.plane_here((plane.truncate().extend(offset_of_plane)) * 1e200));
        picture(executor, &scene, &style, Some(0.6))
    };
    on_all(|executor| {
        let plain = shown(executor, 1.0, DVec3::ZERO);
        let mut whole = style("ink-image").expect("it is there");
        whole.lights = vec![StyleLight { light: Light::positional(light.as_vec3()), frame: LightFrame::World }];
        let whole = picture(executor, &Scene::new(model()), &whole, Some(0.6));
        assert!(differing(&plain, &whole, 16) > 500, "the plane cuts something off");
        for scale in [2f64.powi(-60), 2f64.powi(60)] {
            let far = shown(executor, scale, DVec3::ZERO);
            assert_eq!(differing(&plain, &far, 1), 0, "{scale:e} on {}", executor.describe());
        }
        // At a distance of 4096, positions are rounded to 2^-12; a picture's px is about 2^-5.
        let far = shown(executor, 1.0, DVec3::new(4096.0, 0.0, -4096.0));
        let count = differing(&plain, &far, 64);
        assert!(count <= 200, "{count} px on {}", executor.describe());
    });
}

/// A very distant light keeps its direction. (At 1e19 a style is rejected.)
#[test]
fn lights_may_be_far_away() {
    on_all(|executor| {
        let lit = |light: Light, scale: f32| {
            let mut style = style("lambert").expect("it is there");
            style.lights = vec![StyleLight { light, frame: LightFrame::World }];
            let scene = Scene::new(moved(model(), |p| p * f64::from(scale)));
            picture(executor, &scene, &style, Some(0.6))
        };
        let direction = Vec3::new(0.5, 0.8, 0.3);
        let expected = lit(Light::directional(direction), 1.0);
        for (distance, scale) in [(1e6, 1.0), (1e18, 1.0), (1e18, 1e-36), (1e-20, 1e-36)] {
            let found = lit(Light::positional(direction * distance), scale);
            let count = differing(&expected, &found, 2);
            assert!(count <= 19, "{distance:e}, {scale:e} on {}: {count} px", executor.describe());
        }
    });
}

#[test]
fn models_without_extent_give_a_picture_of_paper() {
    let style = style("cartoon").expect("it is there");
    let paper = style.paper.extend(1.0).to_array().map(|c| (c * 255.0).round() as u8);
    on_all(|executor| {
        for fov_y_rad in [Some(0.6), None] {
            for place in [Vec3::ZERO, Vec3::new(3.0, 4e7, -1e30), Vec3::splat(1e-40)] {
                let point = moved(embedded::cube(), |_| place.as_dvec3());
                let shown = picture(executor, &Scene::new(point), &style, fov_y_rad);
                assert!(shown.rgba8.chunks_exact(4).all(|pixel| pixel == paper), "{place}");
            }
        }
    });
}

/// Flat models, also edge-on, single triangles, degenerate lines, and one vertex far away from all others.
#[test]
fn awkward_extents_end_in_a_picture_of_finite_numbers() {
    let flat = |axis: usize| {
        moved(embedded::cube(), move |p| {
            let mut p = p;
            p[axis] = 0.5;
            p
        })
    };
    let one = |corners: [Vec3; 3]| Model {
        positions: corners.to_vec(),
        normals: vec![Vec3::Z; 3],
        faces: vec![[0, 1, 2]],
        face_material: vec![0],
        materials: vec![npr_mesh::Material::default()],
        ..Default::default()
    };
    let outlier = |far: f32| {
        let mut model = embedded::cube();
        model.positions[0] = Vec3::new(far, -far, far / 3.0);
        model
    };
    let mut unused = embedded::cube();
    unused.positions.push(Vec3::splat(3e38));
    unused.normals.push(Vec3::Y);
    let mut tiny_and_unused = moved(unused.clone(), |p| if p.x > 1e30 { p } else { p * 1e-30 });
    tiny_and_unused.materials[0].base_color = Vec4::new(0.5, 0.2, 0.2, 0.5);
    tiny_and_unused.materials[0].alpha_mode = AlphaMode::Blend;
    let models = [
        flat(0),
        flat(1),
        flat(2),
        one([Vec3::ZERO, Vec3::X, Vec3::Y]),
        one([Vec3::ZERO, Vec3::X, Vec3::X * 2.0]),
        one([Vec3::new(-3e38, 0.0, 0.0), Vec3::new(3e38, 0.0, 0.0), Vec3::new(0.0, 3e38, 3e38)]),
        one([Vec3::ZERO, Vec3::X * f32::from_bits(1), Vec3::Y * f32::from_bits(1)]),
        outlier(1e10),
        outlier(1e38),
        unused,
        tiny_and_unused,
    ];
    on_all(|executor| {
        for name in ["cartoon", "two-lights", "ink-thick", "hatch", "hatch-color", "printed-fins"] {
            let style = style(name).expect("it is there");
            for (number, model) in models.iter().enumerate() {
                for fov_y_rad in [Some(0.6), None] {
                    let scene = Scene::new(model.clone());
                    let shown = picture(executor, &scene, &style, fov_y_rad);
                    assert!(scene.meshes()[0].model().positions.iter().all(|p| p.is_finite()));
                    // All except the triangle without area, and models that are a mere dot next to an outlier.
                    if name == "cartoon" && ![4, 7, 8].contains(&number) {
                        let first = &shown.rgba8[..4];
                        let seen = shown.rgba8.chunks_exact(4).filter(|pixel| *pixel != first).count();
                        assert!(seen > 50, "model {number} on {}: {seen} px", executor.describe());
                    }
                }
            }
        }
    });
}
