//! What materials emit is added to the shaded colour, on both executors.

mod common;

use common::{cards, device, plain, planned, rendered, waves};
use glam::{Mat4, Vec3, Vec4};
use npr_harness::camera::{Camera, Framing};
use npr_harness::color::encode_srgb;
use npr_harness::executor::{Backend, Executor};
use npr_harness::picture::Image;
use npr_harness::plan::PaintPlan;
use npr_harness::scene::Scene;
use npr_harness::style::{Lines, Style, style, styles};
use npr_mesh::{AlphaMode, Material, Model, Texture, Wrap, embedded};
use npr_toon::normal::NormalUse;
use std::sync::Arc;

const SIZE: (u32, u32) = (96, 72);

/// The executors that there are.
fn executors() -> Vec<Executor> {
    let cpu = Executor::choose(Backend::Cpu).expect("there is always one");
    [Some(cpu), device()].into_iter().flatten().collect()
}

fn view(scene: &Scene) -> Camera {
    let framing = Framing { yaw_rad: 0.5, pitch_rad: 0.4, fov_y_rad: Some(0.7), distance: 1.0 };
    Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &framing)
}

fn picture(executor: &Executor, model: &Model, style: &Style) -> Image {
    let scene = Scene::new(model.clone());
    rendered(executor, &scene, style, &view(&scene), SIZE)
}

fn without_lines(name: &str) -> Style {
    Style { lines: Lines::default(), ..style(name).expect("a style of this crate") }
}

/// A cube above a ground, on which it casts a shadow. Both have this material.
fn cube_above_ground(material: Material) -> Model {
    let mut model = embedded::cube();
    model.positions.iter_mut().for_each(|p| p.y += 1.5);
    let mut ground = embedded::cube();
    let flat = Mat4::from_scale(Vec3::new(4.0, 0.1, 4.0));
    ground.positions.iter_mut().for_each(|p| *p = flat.transform_point3(*p));
    model.append(&ground);
    model.face_material = vec![0; model.faces.len()];
    model.materials = vec![material];
    model
}

fn emissive(base_color: Vec4, emissive: Vec3) -> Material {
    Material { emissive, ..plain(base_color, AlphaMode::Opaque, false) }
}

/// The greatest difference of a channel.
fn farthest(a: &Image, b: &Image) -> u8 {
    a.rgba8.iter().zip(&b.rgba8).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

fn byte(linear: f32) -> i32 {
    (encode_srgb(f64::from(linear.clamp(0.0, 1.0))) * 255.0).round() as i32
}

/// The pixels of two pictures, where the first shows a surface.
fn surfaces<'a>(paper: [u8; 4], a: &'a Image, b: &'a Image) -> impl Iterator<Item = ([u8; 4], [u8; 4])> + 'a {
    let pixels = |image: &'a Image| (0..SIZE.1).flat_map(move |y| (0..SIZE.0).map(move |x| image.pixel(x, y)));
    pixels(a).zip(pixels(b)).filter(move |(a, _)| *a != paper)
}

#[test]
fn a_black_surface_has_the_colour_that_it_emits() {
    // The orange of a file: red at its maximum, and half as much green.
    for (factor, expected) in [
        (Vec3::new(1.0, 0.5, 0.0), [255, 188, 0, 255]),
        (Vec3::new(0.0, 0.0, 0.2), [0, 0, 124, 255]),
        // A strong light is as bright as a picture can be.
        (Vec3::new(40.0, 0.0, 8.0), [255, 0, 255, 255]),
    ] {
        let model = cube_above_ground(emissive(Vec4::new(0.0, 0.0, 0.0, 1.0), factor));
        for name in ["toon", "toon-shadow", "gooch"] {
            let style = Style { paper: Vec3::splat(0.5), ..without_lines(name) };
            for executor in executors() {
                let image = picture(&executor, &model, &style);
                // No light of the style reaches a black surface, except that of its cool and warm tones.
                let exact =
                    surfaces([128, 128, 128, 255], &image, &image).filter(|(pixel, _)| *pixel == expected).count();
                let all = surfaces([128, 128, 128, 255], &image, &image).count();
                assert!(all > 500 && (exact == all || name == "gooch"), "{name}: {exact} of {all} are {expected:?}");
                let least = surfaces([128, 128, 128, 255], &image, &image).map(|(pixel, _)| pixel[0]).min();
                assert!(least >= Some(expected[0]), "{name}: {least:?}");
            }
        }
    }
}

#[test]
fn light_and_shadow_do_not_change_it() {
    let base = Vec4::new(0.2, 0.2, 0.2, 1.0);
    let factor = Vec3::new(0.1, 0.02, 0.2);
    let [lit, emitting] = [Vec3::ZERO, factor].map(|factor| cube_above_ground(emissive(base, factor)));
    for name in ["toon", "toon-shadow", "vertex-light", "two-lights", "hatch-shadow", "wash"] {
        let style = Style { paper: Vec3::ONE, ..without_lines(name) };
        if !shows_colors(&lit, &style) {
            continue;
        }
        for normals in [style.normals, NormalUse::PerFace, NormalUse::PerVertex] {
            let style = Style { normals, ..style.clone() };
            for executor in executors() {
                let [before, after] = [&lit, &emitting].map(|model| picture(&executor, model, &style));
                let (mut count, mut darkest, mut brightest) = (0, 255, 0);
                for (before, after) in surfaces([255; 4], &before, &after) {
                    for channel in 0..3 {
                        let sum = (i32::from(before[channel]) + byte(factor[channel])).min(255);
                        assert!((sum - i32::from(after[channel])).abs() <= 1, "{name}: {before:?} became {after:?}");
                    }
                    count += 1;
                    (darkest, brightest) = (darkest.min(before[0]), brightest.max(before[0]));
                }
                assert!(
                    count > 500 && brightest > darkest + 20,
                    "{name}: {count} pixels from {darkest} to {brightest}"
                );
            }
        }
    }
}

fn shows_colors(model: &Model, style: &Style) -> bool {
    let scene = Scene::new(model.clone());
    let plan = planned(&scene, style, &view(&scene), SIZE);
    plan.paint.as_ref().is_some_and(PaintPlan::shows_surface_color)
}

#[test]
fn it_is_shown_where_the_colours_of_surfaces_are() {
    let base = Vec4::new(0.1, 0.2, 0.3, 1.0);
    let [plain, emitting] =
        [Vec3::ZERO, Vec3::new(0.8, 0.3, 0.2)].map(|factor| cube_above_ground(emissive(base, factor)));
    let (mut shown, mut hidden) = (0, 0);
    for executor in executors() {
        for style in styles() {
            let difference = farthest(&picture(&executor, &plain, &style), &picture(&executor, &emitting, &style));
            if shows_colors(&plain, &style) {
                assert!(difference > 50, "{}: {difference}", style.name);
                shown += 1;
            } else {
                assert_eq!(difference, 0, "{}", style.name);
                hidden += 1;
            }
        }
    }
    assert!(shown > 5 && hidden > 5, "{shown} styles show it, {hidden} do not");
}

/// A texture with a colour for each quarter.
fn quarters() -> Texture {
    let texels: [[u8; 4]; 4] = [[255, 0, 0, 255], [0, 255, 0, 0], [0, 0, 255, 255], [188, 188, 188, 255]];
    let (width, height) = (2, 2);
    let rgba8 = Arc::from(texels.as_flattened());
    Texture { name: "quarters".into(), width, height, rgba8, wrap: [Wrap::Clamp; 2], smooth: false }
}

#[test]
fn a_texture_multiplies_it_in_linear_light() {
    let mut model = cards(1, 0.5, |_| emissive(Vec4::new(0.0, 0.0, 0.0, 1.0), Vec3::new(0.5, 1.0, 0.25)));
    model.materials[0].double_sided = true;
    model.textures = vec![quarters()];
    model.materials[0].emissive_texture = Some(0);
    let style = Style { paper: Vec3::splat(0.5), ..without_lines("toon") };
    // 188 is half of the light; the alpha of the texture has no meaning.
    let expected = [[byte(0.5), 0, 0], [0, 255, 0], [0, 0, byte(0.25)], [byte(0.25), 188, byte(0.125)]];
    for executor in executors() {
        let image = picture(&executor, &model, &style);
        let mut found = [0; 4];
        for (pixel, _) in surfaces([128, 128, 128, 255], &image, &image) {
            let is_near = |expected: &[i32; 3]| (0..3).all(|c| (i32::from(pixel[c]) - expected[c]).abs() <= 2);
            if let Some(quarter) = expected.iter().position(is_near) {
                found[quarter] += 1;
            }
        }
        assert!(found.iter().all(|&count| count > 100), "{found:?}");
    }
}

#[test]
fn executors_agree_on_emissive_textures() {
    let Some(device) = device() else { return };
    let cpu = Executor::choose(Backend::Cpu).expect("there is always one");
    // With and without a texture of the colour, cut out, blended, and of one colour.
    let mut model = cards(5, 1.3, |_| emissive(Vec4::new(0.3, 0.2, 0.1, 0.7), Vec3::new(0.4, 0.2, 0.6)));
    model.textures = vec![waves(61, 40, [Wrap::Repeat, Wrap::Mirror], true), waves(16, 8, [Wrap::Clamp; 2], true)];
    for (number, material) in model.materials.iter_mut().enumerate() {
        material.double_sided = true;
        material.emissive_texture = [Some(0), Some(1), None, Some(1), Some(0)][number];
        material.texture = [None, Some(0), Some(1), Some(1), None][number];
        material.alpha_mode = [
            AlphaMode::Opaque,
            AlphaMode::Opaque,
            AlphaMode::Mask { cutoff: 0.3 },
            AlphaMode::Opaque,
            AlphaMode::Blend,
        ][number];
    }
    for name in ["toon", "gooch", "vertex-light", "hatch", "ink-image", "cartoon"] {
        let style = Style {
            lines: Lines { edges: None, ..style(name).expect("a style").lines },
            ..style(name).expect("a style")
        };
        let [reference, actual] = [&cpu, &device].map(|executor| picture(executor, &model, &style));
        let differing = reference.rgba8.chunks(4).zip(actual.rgba8.chunks(4));
        let differing = differing.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 16)).count();
        // Pixels at the borders of surfaces.
        assert!(differing <= (SIZE.0 * SIZE.1 / 100) as usize, "{name}: {differing} pixels differ");
    }
}

#[test]
fn without_emission_the_plan_is_the_same() {
    let mut model = cards(1, 1.0, |_| plain(Vec4::ONE, AlphaMode::Opaque, true));
    model.textures = vec![waves(16, 8, [Wrap::Repeat; 2], true)];
    model.materials[0].emissive_texture = Some(0);
    let plan = |model: &Model, name: &str| {
        let scene = Scene::new(model.clone());
        planned(&scene, &style(name).expect("a style"), &view(&scene), SIZE)
    };
    // A texture of nothing is not read.
    let dark = plan(&model, "toon");
    assert_eq!((dark.emits, dark.looks_up, &dark.textures[..]), (false, false, &[false][..]));
    model.materials[0].emissive = Vec3::ONE;
    let bright = plan(&model, "toon");
    assert_eq!((bright.emits, bright.looks_up, &bright.textures[..]), (true, true, &[true][..]));
    // Nor where surfaces do not show their colours.
    let paper = plan(&model, "lines");
    assert_eq!((paper.emits, paper.looks_up, &paper.textures[..]), (false, false, &[false][..]));
    model.materials[0].emissive_texture = None;
    let constant = plan(&model, "toon");
    assert_eq!((constant.emits, constant.looks_up, &constant.textures[..]), (true, false, &[false][..]));
}
