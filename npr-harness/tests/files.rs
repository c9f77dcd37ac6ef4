//! Pictures of files: material options, smoothing groups, opacity, and models far from the origin. The colours are those
//! that are right, not those of another picture.

mod common;

use common::rendered;
use glam::{DVec2, DVec3, Vec3};
use image::{DynamicImage, GrayImage, ImageFormat, Luma, Rgb, RgbImage};
use npr_harness::camera::{Camera, Framing};
use npr_harness::compare::compare;
use npr_harness::executor::{Backend, Executor};
use npr_harness::inspect::inspect_loaded;
use npr_harness::picture::Image;
use npr_harness::scene::Scene;
use npr_harness::shade::Shade;
use npr_harness::style::{Style, style};
use npr_mesh::weld::Weld;
use npr_mesh::{LoadOptions, Loaded, load_bytes};
use std::io::{self, Cursor};

const SIZE: (u32, u32) = (160, 120);

/// From the front, without perspective.
const FRONT: Framing =
    Framing { yaw_rad: 0.0, pitch_rad: 0.0, roll_rad: 0.0, target: None, distance: 1.0, fov_y_rad: None };

fn loaded(name: &str, text: &str, files: &[(&str, Vec<u8>)]) -> Loaded {
    let resolver = |name: &str| match files.iter().find(|(known, _)| *known == name) {
        Some((_, bytes)) => Ok(bytes.clone()),
        None => Err(io::ErrorKind::NotFound.into()),
    };
    load_bytes(name, text.into(), &resolver, &LoadOptions::default()).expect("it loads")
}

/// The CPU and, if there is one, a device.
fn executors() -> Vec<Executor> {
    let mut executors = vec![Executor::choose(Backend::Cpu).expect("there is a CPU")];
    executors.extend(common::device());
    executors
}

fn framed(scene: &Scene, framing: &Framing) -> Camera {
    Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), framing)
}

/// The colour of a picture where the camera sees a point of the file.
fn color_at(image: &Image, scene: &Scene, camera: &Camera, point: DVec3) -> [u8; 3] {
    let clip = camera.clip_from_world(f64::from(SIZE.0) / f64::from(SIZE.1)) * scene.place_here(point).extend(1.0);
    let at = (DVec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * DVec2::new(SIZE.0.into(), SIZE.1.into());
    let [r, g, b, _] = image.pixel(at.x as u32, at.y as u32);
    [r, g, b]
}

fn with_shade(shade: Shade) -> Style {
    Style { shade, ..style("toon").expect("a style of the crate") }
}

fn encoded(image: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, format).expect("it can be encoded");
    bytes.into_inner()
}

/// Red and yellow quarters, red at the upper left.
fn quarters() -> RgbImage {
    RgbImage::from_fn(32, 32, |x, y| if (x < 16) == (y < 16) { Rgb([220, 30, 30]) } else { Rgb([250, 230, 120]) })
}

#[derive(Debug, PartialEq)]
enum Seen {
    Red,
    Yellow,
    Paper,
}

fn seen([r, g, b]: [u8; 3]) -> Seen {
    match (i32::from(r) - i32::from(g) > 60, i32::from(g) - i32::from(b) > 40) {
        (true, _) => Seen::Red,
        (_, true) => Seen::Yellow,
        _ => Seen::Paper,
    }
}

#[test]
fn options_alpha_and_formats_of_textures() {
    let disc = GrayImage::from_fn(64, 64, |x, y| {
        let (x, y) = (f64::from(x) - 31.5, f64::from(y) - 31.5);
        Luma([if x.hypot(y) < 26.0 { 255 } else { 0 }])
    });
    let files = [
        ("t.png", encoded(quarters(), ImageFormat::Png)),
        ("t.bmp", encoded(quarters(), ImageFormat::Bmp)),
        ("t.tga", encoded(quarters(), ImageFormat::Tga)),
        ("t.gif", encoded(DynamicImage::from(quarters()).into_rgba8(), ImageFormat::Gif)),
        ("disc.png", encoded(disc, ImageFormat::Png)),
    ];
    let maps = ["-s 2 2 1 t.png", "-o .25 0 0 t.png", "t.png\nmap_d disc.png", "t.bmp", "t.tga", "t.gif"];
    let (mut mtl, mut obj) = (String::new(), "mtllib m.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n".to_owned());
    for (number, map) in maps.iter().enumerate() {
        mtl += &format!("newmtl m{number}\nKd 1 1 1\nmap_Kd {map}\n");
        let x = 3 * number;
        obj += &format!("v {x} 0 0\nv {} 0 0\nv {} 2 0\nv {x} 2 0\n", x + 2, x + 2);
        obj += &format!("usemtl m{number}\nf -4/1 -3/2 -2/3 -1/4\n");
    }
    let scene = Scene::from(loaded("m.obj", &obj, &[&files[..], &[("m.mtl", mtl.into())]].concat()));
    let camera = framed(&scene, &FRONT);
    for executor in executors() {
        let image = rendered(&executor, &scene, &with_shade(style("toon").expect("toon").shade), &camera, SIZE);
        let at = |number: usize, u: f64, v: f64| {
            seen(color_at(&image, &scene, &camera, DVec3::new(3.0 * number as f64 + 2.0 * u, 2.0 * v, 0.0)))
        };
        let quarter = |u: f64, v: f64| {
            if (u.rem_euclid(1.0) < 0.5) == (v.rem_euclid(1.0) > 0.5) { Seen::Red } else { Seen::Yellow }
        };
        for (u, v) in [(0.125, 0.125), (0.375, 0.125), (0.875, 0.375), (0.625, 0.875), (0.375, 0.625), (0.875, 0.875)] {
            assert_eq!(at(0, u, v), quarter(2.0 * u, 2.0 * v), "repeated twice, at {u} {v}");
            assert_eq!(at(1, u, v), quarter(u + 0.25, v), "shifted, at {u} {v}");
            for (number, map) in maps.iter().enumerate().skip(3) {
                assert_eq!(at(number, u, v), quarter(u, v), "{map}, at {u} {v}");
            }
        }
        for (u, v) in [(0.06, 0.06), (0.94, 0.06), (0.06, 0.94), (0.94, 0.94)] {
            assert_eq!(at(2, u, v), Seen::Paper, "outside of the disc, at {u} {v}");
        }
        for (u, v) in [(0.3, 0.3), (0.7, 0.3), (0.3, 0.7), (0.7, 0.7)] {
            assert_eq!(at(2, u, v), quarter(u, v), "inside of the disc, at {u} {v}");
        }
    }
}

#[test]
fn a_material_is_opaque_where_its_file_contradicts_itself() {
    for opacity in ["Tr 1.0\nd 1", "Tr 1", "d 0\nTr 0"] {
        let mtl = format!("newmtl m\nKd 1 0 0\n{opacity}\n");
        let obj = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
        let loaded = loaded("m.obj", obj, &[("m.mtl", mtl.into())]);
        assert!(loaded.warnings.iter().any(|warning| warning.text.contains("Tr")), "{opacity}: a warning");
        let scene = Scene::from(loaded);
        let camera = framed(&scene, &FRONT);
        for executor in executors() {
            let image = rendered(&executor, &scene, &style("toon").expect("toon"), &camera, SIZE);
            assert_eq!(seen(color_at(&image, &scene, &camera, DVec3::new(0.25, 0.25, 0.0))), Seen::Red, "{opacity}");
        }
    }
}

#[test]
fn facets_are_flat_and_groups_are_smooth() {
    // A roof of two slopes of 30 degrees, and one of 60.
    let roof = |statements: [&str; 4]| {
        let [a, b, c, d] = statements;
        let vertices =
            "v 0 0 0\nv 0 1 0\nv 1 0 .5\nv 1 1 .5\nv 2 0 0\nv 2 1 0\nv 3 0 1.7\nv 3 1 1.7\nv 4 0 0\nv 4 1 0\n";
        format!("{vertices}{a}\nf 1 3 4 2\n{b}\nf 3 5 6 4\n{c}\nf 5 7 8 6\n{d}\nf 7 9 10 8\n")
    };
    let normal = |x: f32, z: f32| Vec3::new(x, 0.0, z).normalize();
    let [gentle, steep] = [normal(-0.5, 1.0), normal(-1.7, 1.0)];
    let mirrored = |n: Vec3| Vec3::new(-n.x, n.y, n.z);
    let flat = [gentle, mirrored(gentle), steep, mirrored(steep)];
    let colors = |text: &str, executor: &Executor| {
        let scene = Scene::from(loaded("m.obj", text, &[]));
        let camera = framed(&scene, &FRONT);
        let image = rendered(executor, &scene, &with_shade(Shade::Normals), &camera, SIZE);
        [0.1, 0.9, 1.1, 1.9, 2.1, 2.9, 3.1, 3.9].map(|x| color_at(&image, &scene, &camera, DVec3::new(x, 0.5, 0.0)))
    };
    let is = |color: [u8; 3], normal: Vec3| {
        let expected = (normal * 0.5 + 0.5) * 255.0;
        color.iter().zip(expected.to_array()).all(|(actual, expected)| (f32::from(*actual) - expected).abs() < 3.0)
    };
    for executor in executors() {
        let off = colors(&roof(["s off", "", "", ""]), &executor);
        assert!((0..8).all(|place| is(off[place], flat[place / 2])), "flat: {off:?}");
        // At the ridges of a group the normal is upright.
        let smooth = colors(&roof(["s 1", "", "s 2", ""]), &executor);
        let ridge = |color: [u8; 3]| color[0].abs_diff(128) < 30;
        assert!([1, 2, 5, 6].iter().all(|&place| ridge(smooth[place])), "smooth at both ridges: {smooth:?}");
        // Between the groups each slope keeps its own.
        assert!(is(smooth[0], flat[0]) || smooth[0][0] < 100, "{smooth:?}");
        assert!(smooth[3][0] > 150 && smooth[4][0] < 60, "nothing is shared in the valley: {smooth:?}");
        // Without groups the crease angle decides.
        let without = colors(&roof([""; 4]), &executor);
        assert!(is(without[5], flat[2]) && is(without[6], flat[3]), "a crease: {without:?}");
    }
}

/// Boxes at whole and half units, moved by whole numbers.
fn city(offset: [i64; 3], is_ply: bool) -> String {
    let (mut vertices, mut faces, mut count) = (String::new(), String::new(), 0);
    for block in 0..16i64 {
        let (east, north, height) = (block % 4 * 40, block / 4 * 40, 10 + block * 7 % 30);
        for corner in 0..8i64 {
            let of = |bit: i64, from: i64, size: i64| (from + (corner >> bit & 1) * size) as f64 + 0.3;
            let [x, y, z] = [of(0, offset[0] + east, 22), of(1, offset[1], height), of(2, offset[2] + north, 26)];
            vertices += &format!("{}{x:.1} {y:.1} {z:.1}\n", if is_ply { "" } else { "v " });
        }
        for face in [[4, 5, 7, 6], [1, 3, 7, 5], [0, 2, 3, 1], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4]] {
            let first = 8 * block + i64::from(!is_ply);
            let [a, b, c, d] = face.map(|corner| first + corner);
            faces += &format!("{} {a} {b} {c} {d}\n", if is_ply { "4" } else { "f" });
            count += 1;
        }
    }
    if !is_ply {
        return vertices + &faces;
    }
    format!(
        "ply\nformat ascii 1.0\nelement vertex 128\nproperty double x\nproperty double y\nproperty double z\n\
         element face {count}\nproperty list uchar int vertex_indices\nend_header\n{vertices}{faces}"
    )
}

#[test]
fn a_city_at_utm_coordinates_is_the_picture_at_the_origin() {
    let framing = Framing { yaw_rad: 0.5, pitch_rad: 0.6, ..Framing::default() };
    for name in ["toon-shadow", "cartoon", "lines", "ink-image"] {
        let style = style(name).expect("a style of the crate");
        for executor in executors() {
            let picture = |offset: [i64; 3], is_ply: bool| {
                let scene = Scene::from(loaded(if is_ply { "m.ply" } else { "m.obj" }, &city(offset, is_ply), &[]));
                rendered(&executor, &scene, &style, &framed(&scene, &framing), SIZE)
            };
            let here = picture([0; 3], false);
            for (offset, is_ply) in
                [([500_000, 0, -5_400_000], false), ([500_000, 0, -5_400_000], true), ([0, 16_777_216, 0], false)]
            {
                let differing = compare(&here, &picture(offset, is_ply), &[]).expect("one size").over(16);
                let most = u64::from(SIZE.0 * SIZE.1) / 1000;
                assert!(differing <= most, "{name}, {}: {differing} px differ at {offset:?}", executor.describe());
            }
        }
    }
}

#[test]
fn statistics_of_what_is_far_are_exact() {
    let mut obj = String::new();
    for corner in 0..8 {
        let at = |bit: u32| if corner >> bit & 1 == 1 { 8 } else { 2 };
        obj += &format!("v 8388608.{} {} 8388608.{}\n", at(0), corner >> 1 & 1, at(2));
    }
    obj += "f 5 6 8 7\nf 2 4 8 6\nf 1 3 4 2\nf 1 5 7 3\nf 3 7 8 4\nf 1 2 6 5\n";
    let inspection = inspect_loaded("m", loaded("m.obj", &obj, &[]), Weld::Exact);
    assert_eq!(inspection.extent, [0.6, 1.0, 0.6]);
    assert_eq!((inspection.min, inspection.max), ([8388608.2, 0.0, 8388608.2], [8388608.8, 1.0, 8388608.8]));
    assert!(inspection.closed && inspection.zero_area_faces == 0 && inspection.positions == 8);
    let utm = "v 500000.0 5400000.0 0\nv 500000.3 5400000.0 0\nv 500000.0 5400000.2 0\nf 1 2 3\n";
    let inspection = inspect_loaded("m", loaded("m.obj", utm, &[]), Weld::Exact);
    assert_eq!((inspection.extent, inspection.zero_area_faces), ([0.3, 0.2, 0.0], 0));
    assert_eq!(inspection.min, [500_000.0, 5_400_000.0, 0.0]);
    let (model, _) = loaded("m.obj", utm, &[]).into_model_near();
    let [a, b, c] = model.faces[0].map(|vertex| model.positions[vertex as usize]);
    assert!(((b - a).cross(c - a).length() / 2.0 - 0.03).abs() < 1e-6, "its area");
}

#[test]
fn extents_beyond_f32_are_numbers() {
    let obj = "v -3e38 0 0\nv 3e38 0 0\nv 0 3e38 -1e-3\nf 1 2 3\n";
    let inspection = inspect_loaded("m", loaded("m.obj", obj, &[]), Weld::Exact);
    assert_eq!((inspection.extent[0], inspection.max[1]), (6e38, 3e38));
    let json = serde_json::to_string(&inspection).expect("plain numbers");
    assert!(!json.contains("null"), "{json}");
}
