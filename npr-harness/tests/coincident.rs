//! Faces that lie in one plane and overlap: one is seen by the rule of [`npr_mesh::coplanar`], the same on both executors.
#![allow(clippy::print_stdout)]

mod common;

use common::{device, planned, rendered};
use glam::{DAffine3, DQuat, DVec3, Vec3};
use npr_harness::camera::{Camera, Framing};
use npr_harness::cpu::{CpuOptions, render};
use npr_harness::executor::Executor;
use npr_harness::picture::Image;
use npr_harness::scene::Scene;
use npr_harness::style::{Style, style};
use npr_mesh::{AlphaMode, Material, Model, Object};

const SIZE: (u32, u32) = (160, 120);
/// Colour, lines along edges and in the image, shadows and hatching.
const STYLES: [&str; 6] = ["cartoon", "lines", "ink-image", "toon-shadow", "hatch-planes", "printed-hatch"];

const RED: [f32; 3] = [0.9, 0.02, 0.02];
const BLUE: [f32; 3] = [0.02, 0.03, 0.9];
const GREEN: [f32; 3] = [0.02, 0.7, 0.02];

fn named(name: &str) -> Style {
    style(name).expect("a style of the crate")
}

fn material(color: [f32; 3], double_sided: bool) -> Material {
    Material { base_color: Vec3::from(color).extend(1.0), double_sided, ..Material::default() }
}

/// A convex polygon in the plane z = 0, cut into a fan from one of its corners.
fn polygon(corners: &[(f64, f64)], from: usize, turned: bool, color: [f32; 3]) -> Model {
    let count = corners.len();
    let corner = |i: usize| ((from + i) % count) as u32;
    let fan = (1..count - 1).map(|i| {
        let [a, b, c] = [corner(0), corner(i), corner(i + 1)];
        if turned { [a, c, b] } else { [a, b, c] }
    });
    let faces: Vec<[u32; 3]> = fan.collect();
    Model {
        positions: corners.iter().map(|&(x, y)| Vec3::new(x as f32, y as f32, 0.0)).collect(),
        normals: vec![if turned { Vec3::NEG_Z } else { Vec3::Z }; count],
        face_material: vec![0; faces.len()],
        face_polygon: vec![0; faces.len()],
        faces,
        materials: vec![material(color, true)],
        ..Model::default()
    }
}

const SQUARE: [(f64, f64); 4] = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
const MARK: [(f64, f64); 4] = [(-0.5, -0.2), (0.55, -0.4), (0.6, 0.3), (-0.4, 0.5)];

/// Models turned by `turn` in f32, in one mesh, or each as an object of its own.
fn scene(models: &[Model], turn: DQuat, as_objects: bool) -> Scene {
    let turned = |model: &Model| model.clone().transformed(&DAffine3::from_quat(turn));
    if as_objects {
        let object = |mesh| Object {
            name: String::new(),
            mesh,
            // The transform turns in f64 what the single mesh has in f32.
            world_from_mesh: DAffine3::from_quat(turn),
        };
        let objects = (0..models.len()).map(object).collect();
        return Scene::with_objects(models.to_vec(), objects).expect("they can be placed");
    }
    let mut all = Model::default();
    models.iter().for_each(|model| all.append(&turned(model)));
    Scene::new(all)
}

fn camera(scene: &Scene, yaw_deg: f64) -> Camera {
    let framing = Framing { yaw_rad: yaw_deg.to_radians(), ..Framing::default() };
    Camera::framed(scene.corners(), 4.0 / 3.0, &framing)
}

fn on_cpu(scene: &Scene, style: &Style, camera: &Camera) -> Image {
    render(scene, &planned(scene, style, camera, SIZE), &CpuOptions::default(), &|_| {}).image()
}

/// The share of pixels in which a channel differs by more than 16.
fn difference(a: &Image, b: &Image) -> f64 {
    let pixels = a.rgba8.chunks_exact(4).zip(b.rgba8.chunks_exact(4));
    let differ = pixels.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 16)).count();
    differ as f64 / (SIZE.0 * SIZE.1) as f64
}

/// The number of pixels whose largest channel is that of a colour, for each of red, green and blue.
fn counts(image: &Image) -> [usize; 3] {
    let mut counts = [0; 3];
    for pixel in image.rgba8.chunks_exact(4) {
        let largest = (0..3).max_by_key(|&i| pixel[i]).unwrap_or(0);
        let rest = (0..3).filter(|&i| i != largest).map(|i| pixel[i]).max().unwrap_or(0);
        counts[largest] += usize::from(pixel[largest] > 60 && pixel[largest] / 2 > rest);
    }
    counts
}

fn turns() -> [DQuat; 3] {
    let axis = DVec3::new(0.6, 0.64, -0.48);
    [DQuat::IDENTITY, DQuat::from_axis_angle(axis, 0.4), DQuat::from_axis_angle(axis, -0.7)]
}

/// Calls `check` with the picture of each executor, of models in one mesh and as objects.
fn in_all_ways(models: &[Model], yaws_deg: [f64; 2], check: &dyn Fn(&Image, &str)) {
    let device = device();
    let pictures = |scene: &Scene, style: &Style, camera: &Camera| {
        let mut all = vec![on_cpu(scene, style, camera)];
        all.extend(device.as_ref().map(|device| rendered(device, scene, style, camera, SIZE)));
        all
    };
    for (number, turn) in turns().into_iter().enumerate() {
        for as_objects in [false, true] {
            let scene = scene(models, turn, as_objects);
            for yaw_deg in yaws_deg {
                let camera = camera(&scene, yaw_deg);
                for name in ["toon", "cartoon", "toon-shadow"] {
                    for picture in pictures(&scene, &named(name), &camera) {
                        check(&picture, &format!("{name}, turn {number}, objects: {as_objects}, from {yaw_deg}"));
                    }
                }
            }
        }
    }
}

#[test]
fn a_face_that_is_there_twice_has_the_colour_of_the_later() {
    for from in 0..4 {
        let models = [polygon(&SQUARE, 0, false, RED), polygon(&SQUARE, from, false, BLUE)];
        in_all_ways(&models, [25.0, 160.0], &|picture, what| {
            let [red, _, blue] = counts(picture);
            assert!(red == 0 && blue > 1000, "fan from {from}, {what}: {red} {blue}");
        });
    }
}

#[test]
fn of_opposite_faces_the_one_turned_to_the_eye_is_seen() {
    for from in 0..2 {
        let models = [polygon(&SQUARE, 0, false, RED), polygon(&SQUARE, from, true, BLUE)];
        in_all_ways(&models, [20.0, 20.0], &|picture, what| {
            let [red, _, blue] = counts(picture);
            assert!(blue == 0 && red > 1000, "{what}: {red} {blue}");
        });
        in_all_ways(&models, [200.0, 200.0], &|picture, what| {
            let [red, _, blue] = counts(picture);
            assert!(red == 0 && blue > 1000, "{what}: {red} {blue}");
        });
    }
}

#[test]
fn a_mark_on_a_sheet_is_whole_if_it_is_later_and_hidden_if_it_is_earlier() {
    let (sheet, mark) = (polygon(&SQUARE, 0, false, BLUE), polygon(&MARK, 1, false, RED));
    // The share of the sheet that the mark covers.
    let share = 0.7375 / 4.0;
    in_all_ways(&[sheet.clone(), mark.clone()], [25.0, 155.0], &|picture, what| {
        let [red, _, blue] = counts(picture);
        let found = red as f64 / (red + blue) as f64;
        // Lines along the borders take some pixels of both.
        assert!((found / share - 1.0).abs() < 0.2, "{what}: {found} of {share}");
    });
    in_all_ways(&[mark, sheet], [25.0, 155.0], &|picture, what| assert_eq!(counts(picture)[0], 0, "{what}"));
}

#[test]
fn what_is_left_of_a_cut_out_mark_is_seen_on_a_sheet() {
    let (sheet, mut mark) = (polygon(&SQUARE, 0, false, BLUE), polygon(&MARK, 1, false, RED));
    mark.materials[0].alpha_mode = AlphaMode::Mask { cutoff: 0.5 };
    // Alpha falls from the lower to the upper corners.
    mark.colors = [1.0, 1.0, 0.0, 0.0].map(|alpha| Vec3::ONE.extend(alpha)).to_vec();
    let share = 0.7375 / 4.0;
    in_all_ways(&[sheet, mark], [25.0, 155.0], &|picture, what| {
        let [red, _, blue] = counts(picture);
        let found = red as f64 / (red + blue) as f64;
        assert!((0.3..0.6).contains(&(found / share)), "{what}: {found} of {share}");
    });
}

#[test]
fn executors_agree_on_glass_before_the_back_of_an_opaque_face() {
    let Some(device) = device() else { return };
    let (mut glass, red) = (polygon(&SQUARE, 0, false, BLUE), polygon(&SQUARE, 1, true, RED));
    glass.materials[0].base_color.w = 0.6;
    glass.materials[0].alpha_mode = AlphaMode::Blend;
    for turn in turns() {
        for as_objects in [false, true] {
            let scene = scene(&[glass.clone(), red.clone()], turn, as_objects);
            for (name, yaw_deg) in [("cartoon", 30.0), ("ink-image", 30.0), ("toon-shadow", 30.0), ("cartoon", 210.0)] {
                let (style, camera) = (named(name), camera(&scene, yaw_deg));
                let share =
                    difference(&on_cpu(&scene, &style, &camera), &rendered(&device, &scene, &style, &camera, SIZE));
                assert!(share <= 0.001, "{name} from {yaw_deg}, objects: {as_objects}: {share}");
            }
        }
    }
}

struct Random(u64);

impl Random {
    fn below(&mut self, end: u32) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as u32) % end
    }

    fn unit(&mut self) -> f64 {
        f64::from(self.below(1 << 30)) / f64::from(1 << 30)
    }
}

/// Coplanar, repeated and opposite faces in several planes that cross, in three colours.
fn soup(random: &mut Random) -> Vec<Model> {
    let mut models = Vec::new();
    for _ in 0..3 {
        let turn = DQuat::from_xyzw(random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5, random.unit());
        let place =
            DAffine3::from_rotation_translation(turn.normalize(), DVec3::new(random.unit(), random.unit(), 0.0));
        let mut corners = Vec::new();
        for _ in 0..6 {
            if corners.is_empty() || random.below(3) > 0 {
                let middle = (random.unit() - 0.5, random.unit() - 0.5);
                let size = 0.3 + random.unit();
                let start = random.unit() * 6.0;
                let count = 3 + random.below(4);
                corners = (0..count)
                    .map(|i| {
                        let angle = start + f64::from(i) / f64::from(count) * std::f64::consts::TAU;
                        (middle.0 + size * angle.cos(), middle.1 + size * angle.sin())
                    })
                    .collect();
            }
            let color = [RED, GREEN, BLUE][random.below(3) as usize];
            let from = random.below(corners.len() as u32) as usize;
            models.push(polygon(&corners, from, random.below(2) == 0, color).transformed(&place));
        }
    }
    models
}

#[test]
fn executors_agree_on_soups_of_coplanar_repeated_and_opposite_faces() {
    let Some(device) = device() else { return };
    let mut random = Random(11);
    for round in 0..4 {
        let models = soup(&mut random);
        for as_objects in [false, true] {
            let scene = scene(&models, DQuat::IDENTITY, as_objects);
            let camera = camera(&scene, f64::from(random.below(360)));
            for name in STYLES {
                let style = named(name);
                let (cpu, gpu) = (on_cpu(&scene, &style, &camera), rendered(&device, &scene, &style, &camera, SIZE));
                let share = difference(&cpu, &gpu);
                println!("{name}, soup {round}, objects: {as_objects}: {:.3} %", 100.0 * share);
                assert!(share <= 0.001, "{name}, soup {round}, objects: {as_objects}: {share}");
            }
        }
    }
}

#[test]
fn a_mesh_and_objects_of_the_same_faces_give_the_same_picture() {
    let models = soup(&mut Random(5));
    let executors = [Some(Executor::Cpu { why: None }), device()];
    let [one, many] = [false, true].map(|as_objects| scene(&models, DQuat::IDENTITY, as_objects));
    let camera = camera(&one, 35.0);
    for executor in executors.iter().flatten() {
        let [one, many] = [&one, &many].map(|scene| rendered(executor, scene, &named("toon"), &camera, SIZE));
        assert!(difference(&one, &many) <= 0.001, "{}", difference(&one, &many));
    }
}
