//! The two lights that the painter takes for each object.
#![allow(clippy::print_stdout)]

mod common;

use common::{device, planned, rendered};
use glam::{DAffine3, DVec2, DVec3, Vec3};
use npr_harness::camera::{Camera, Framing};
use npr_harness::capabilities::Capabilities;
use npr_harness::check::{PLACES, Reference, Shot, agrees, magnitude};
use npr_harness::compare::compare;
use npr_harness::cpu::{self, CpuOptions, PrimaryHits};
use npr_harness::error::HarnessError;
use npr_harness::lights::{LightFrame, StyleLight};
use npr_harness::picture::Image;
use npr_harness::plan::Plan;
use npr_harness::scene::{MAX_LIGHTS, Scene};
use npr_harness::shade::Shade;
use npr_harness::shadow::ShadowStyle;
use npr_harness::style::{Lines, Style, style};
use npr_harness::view::View;
use npr_mesh::{AlphaMode, Material, Model, Object, embedded};
use npr_toon::source::Light;

const SIZE: (u32, u32) = (160, 90);

/// Where the spheres of the scene are.
const LEFT: f64 = -3.0;
const RIGHT: f64 = 3.0;

fn sphere(alpha_mode: AlphaMode) -> Model {
    let mut model = embedded::sphere(20);
    let base_color = glam::Vec4::new(0.9, 0.8, 0.7, 0.8);
    model.materials = vec![Material { base_color, alpha_mode, ..Material::default() }];
    model
}

/// Spheres of one mesh at these places.
fn scene_of(places: &[f64], alpha_mode: AlphaMode) -> Scene {
    let object = |&x: &f64| Object {
        name: String::new(),
        mesh: 0,
        world_from_mesh: DAffine3::from_translation(DVec3::new(x, 0.0, 0.0)),
    };
    Scene::with_objects(vec![sphere(alpha_mode)], places.iter().map(object).collect()).expect("a scene")
}

fn scene() -> Scene {
    scene_of(&[LEFT, RIGHT], AlphaMode::Opaque)
}

fn world(light: Light) -> StyleLight {
    StyleLight { light, frame: LightFrame::World }
}

fn lamp(x: f32, y: f32, color: Vec3) -> StyleLight {
    world(Light { color, ..Light::positional(Vec3::new(x, y, 2.5)) })
}

/// A distant light, a lamp above each sphere, and a distant light that matters less than these.
fn lights() -> Vec<StyleLight> {
    vec![
        world(Light {
            brightness: 0.8,
            color: Vec3::new(1.0, 0.95, 0.9),
            ..Light::directional(Vec3::new(0.2, 0.5, 1.0))
        }),
        lamp(LEFT as f32, 1.5, Vec3::new(1.0, 0.8, 0.6)),
        lamp(RIGHT as f32, 1.5, Vec3::new(0.7, 0.9, 1.0)),
        world(Light { brightness: 0.2, ..Light::directional(Vec3::new(-1.0, -0.4, 0.3)) }),
    ]
}

fn painter(lights: Vec<StyleLight>) -> Style {
    Style { lights, lines: Lines::NONE, ..style("two-lights").expect("a style of this crate") }
}

fn camera(scene: &Scene) -> Camera {
    let framing = Framing { yaw_rad: 0.2, pitch_rad: 0.2, ..Framing::default() };
    Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &framing)
}

fn on_cpu(scene: &Scene, style: &Style, camera: &Camera) -> Image {
    cpu::render(scene, &planned(scene, style, camera, SIZE), &CpuOptions::default(), &|_| {}).image()
}

/// The pixels of both executors' pictures, or of the CPU's alone where there is no device.
fn pictures(scene: &Scene, style: &Style, camera: &Camera) -> Vec<Image> {
    let on_device = device().map(|executor| rendered(&executor, scene, style, camera, SIZE));
    [Some(on_cpu(scene, style, camera)), on_device].into_iter().flatten().collect()
}

/// The object at the centre of each pixel.
fn objects_of_pixels(scene: &Scene, camera: &Camera) -> Vec<Option<u32>> {
    let size_px = DVec2::new(SIZE.0.into(), SIZE.1.into());
    let pixels = (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x, y)));
    let object = |(x, y): (u32, u32)| {
        let (origin, direction) = camera.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5), size_px);
        scene.closest(origin, direction, (0.0, f64::INFINITY), |hit| hit.front).map(|hit| hit.object)
    };
    pixels.map(object).collect()
}

fn pairs(plan: &Plan) -> Vec<[usize; 2]> {
    let paint = plan.paint.as_ref().expect("surfaces are painted");
    paint.object_pairs.iter().map(|&pair| paint.light_pairs[pair as usize].numbers).collect()
}

/// The largest difference of a component within an object, of 255.
fn apart(a: &Image, b: &Image, of: &[Option<u32>], object: u32) -> u8 {
    let pixels = a.rgba8.chunks_exact(4).zip(b.rgba8.chunks_exact(4)).zip(of);
    let within = pixels.filter(|(_, of)| **of == Some(object)).map(|(pair, _)| pair);
    within.flat_map(|(a, b)| a.iter().zip(b).map(|(a, b)| a.abs_diff(*b))).max().expect("the object is seen")
}

#[test]
fn each_object_has_the_lights_that_matter_most_to_it() {
    let scene = scene();
    let (camera, style) = (camera(&scene), painter(lights()));
    assert_eq!(pairs(&planned(&scene, &style, &camera, SIZE)), [[0, 1], [0, 2]]);
    let objects = objects_of_pixels(&scene, &camera);
    let both = pictures(&scene, &style, &camera);
    for (object, other) in [(0, 2), (1, 1)] {
        let numbers = [0, object as usize + 1];
        // A scene with these two lights alone.
        let alone = pictures(&scene, &painter(numbers.map(|number| lights()[number]).to_vec()), &camera);
        let wrong = pictures(&scene, &painter([0, other].map(|number| lights()[number]).to_vec()), &camera);
        for ((image, alone), wrong) in both.iter().zip(&alone).zip(&wrong) {
            assert!(apart(image, alone, &objects, object) <= 1, "object {object}");
            assert!(apart(image, wrong, &objects, object) > 20, "object {object}");
        }
    }
}

#[test]
fn with_two_lights_nothing_is_chosen() {
    let scene = scene();
    let camera = camera(&scene);
    let plan = planned(&scene, &painter(lights()[..2].to_vec()), &camera, SIZE);
    assert_eq!(pairs(&plan), [[0; 2]; 0]);
    // Two of no brightness change nothing either, although there are four to choose from.
    let off = |light: StyleLight| StyleLight { light: Light { brightness: 0.0, ..light.light }, ..light };
    let mut four = lights();
    (four[2], four[3]) = (off(four[2]), off(four[3]));
    let pairs_of_images = pictures(&scene, &painter(four), &camera).into_iter().zip(pictures(
        &scene,
        &painter(lights()[..2].to_vec()),
        &camera,
    ));
    for (four, two) in pairs_of_images {
        let most = four.rgba8.iter().zip(&two.rgba8).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(most <= Some(1), "{most:?}");
    }
}

#[test]
fn the_order_of_objects_does_not_matter() {
    for alpha_mode in [AlphaMode::Opaque, AlphaMode::Blend] {
        let [forth, back] = [[LEFT, RIGHT], [RIGHT, LEFT]].map(|places| scene_of(&places, alpha_mode));
        let (camera, style) = (camera(&forth), painter(lights()));
        assert_eq!(pairs(&planned(&back, &style, &camera, SIZE)), [[0, 2], [0, 1]]);
        for (a, b) in pictures(&forth, &style, &camera).into_iter().zip(pictures(&back, &style, &camera)) {
            assert_eq!(a.rgba8, b.rgba8);
        }
    }
}

#[test]
fn an_object_names_its_lights() {
    let mut scene = scene();
    let (camera, style) = (camera(&scene), painter(lights()));
    scene.set_lights(1, Some([3, 1])).expect("a style can have them");
    assert_eq!(pairs(&planned(&scene, &style, &camera, SIZE)), [[0, 1], [3, 1]]);
    let objects = objects_of_pixels(&scene, &camera);
    let named = pictures(&scene, &style, &camera);
    // The order says which axis of the ramp each has.
    scene.set_lights(1, None).expect("the painter chooses");
    let alone = pictures(&scene, &painter(vec![lights()[3], lights()[1]]), &camera);
    for (named, alone) in named.iter().zip(&alone) {
        assert!(apart(named, alone, &objects, 1) <= 1);
        assert!(apart(named, alone, &objects, 0) > 20);
    }
}

#[test]
fn what_an_object_cannot_have_is_refused() {
    let mut scene = scene();
    for (lights, said) in [
        ([2, 2], "object 0 cannot have the lights 2 and 2: they are the same"),
        ([0, MAX_LIGHTS], "object 0 cannot have the lights 0 and 8: a style has at most 8 lights"),
    ] {
        let error = scene.set_lights(0, Some(lights)).expect_err("an error");
        assert_eq!(error.to_string(), said);
    }
    assert_eq!(scene.objects()[0].lights(), None);
    let camera = camera(&scene);
    let planned = |scene: &Scene, style: &Style| {
        Plan::new(scene, style, &View::new(camera, SIZE), &Capabilities::RAY_CASTER).map(|plan| pairs(&plan))
    };
    scene.set_lights(1, Some([1, 4])).expect("some style has them");
    for count in [1, 4] {
        let error = planned(&scene, &painter(lights()[..count].to_vec())).expect_err("an error").to_string();
        assert_eq!(error, "object 1 cannot have the lights 1 and 4: the style has fewer");
    }
    // A shade that takes all lights as one does not ask.
    let toon = Style { shade: Shade::Toon(Default::default()), ..painter(lights()) };
    assert_eq!(planned(&scene, &toon).expect("a plan"), [[0; 2]; 0]);
    // The light that casts shadows is an object's first.
    let shadow = Some(ShadowStyle::default());
    let mut dim = lights();
    dim[0].light.brightness = 0.01;
    scene.set_lights(1, None).expect("the painter chooses");
    assert_eq!(planned(&scene, &painter(dim.clone())).expect("a plan"), [[1, 2]; 2]);
    assert_eq!(planned(&scene, &Style { shadow, ..painter(dim.clone()) }).expect("a plan"), [[0, 1], [0, 2]]);
    scene.set_lights(1, Some([2, 0])).expect("a style can have them");
    let error = planned(&scene, &Style { shadow, ..painter(dim) }).expect_err("an error").to_string();
    assert!(error.contains("casts shadows"), "{error}");
    let many = painter(vec![StyleLight::KEY; 9]);
    assert!(matches!(many.validate(), Err(HarnessError::TooManyLights { lights: 9, max: 8 })));
    painter(vec![StyleLight::KEY; 8]).validate().expect("a good style");
}

#[test]
fn of_equal_lights_the_first_are_taken() {
    let scene = scene();
    let camera = camera(&scene);
    let lights = [Vec3::X, Vec3::Y, Vec3::Z].map(|from| world(Light::directional(from)));
    assert_eq!(pairs(&planned(&scene, &painter(lights.to_vec()), &camera, SIZE)), [[0, 1]; 2]);
}

/// With shadows and without, on both executors, against the reference.
#[test]
fn pairs_are_the_same_on_both() {
    let Some(executor) = device() else { return };
    let mut scene = scene_of(&[LEFT, 0.0, RIGHT], AlphaMode::Opaque);
    scene.set_lights(1, Some([0, 3])).expect("a style can have them");
    let camera = camera(&scene);
    let hits = PrimaryHits::kept(&scene, View::new(camera, SIZE), PLACES);
    for shadow in [None, Some(ShadowStyle::default())] {
        let style = Style { shadow, ..painter(lights()) };
        let plan = planned(&scene, &style, &camera, SIZE);
        let actual = rendered(&executor, &scene, &style, &camera, SIZE);
        let mut reference = Reference::new(Shot { hits: &hits, style: &style, plan: &plan }).expect("pictures");
        reference.look_closer().expect("pictures");
        let compared = compare(&reference.image, &actual, &reference.exempt).expect("one size");
        println!("{} of 255, {:.2} % exempt", compared.worst, compared.exempt_share() * 100.0);
        assert!(agrees(&compared, magnitude(&plan)), "{}", compared.worst);
    }
}
