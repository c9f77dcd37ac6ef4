//! A city far from the origin, placed there by the nodes of its file, has the picture of the same city at the origin.

mod common;

use base64::Engine;
use common::{Folder, device, rendered};
use glam::DVec3;
use npr_harness::camera::{Camera, Framing};
use npr_harness::executor::{Backend, Executor};
use npr_harness::picture::Image;
use npr_harness::scene::Scene;
use npr_harness::style::style;
use npr_mesh::{LoadOptions, embedded};

const SIZE: (u32, u32) = (160, 120);

/// 25 boxes of different heights, 0.3 apart, from this place on.
fn city(origin: DVec3) -> Scene {
    let cube = embedded::cube();
    let encoded = |bytes: &[u8]| base64::engine::general_purpose::STANDARD.encode(bytes);
    let bytes: Vec<u8> = [&cube.positions, &cube.normals]
        .into_iter()
        .flatten()
        .flat_map(|vector| vector.to_array())
        .flat_map(f32::to_le_bytes)
        .chain(cube.faces.iter().flatten().flat_map(|vertex| vertex.to_le_bytes()))
        .collect();
    let (vectors, indices) = (12 * cube.positions.len(), 12 * cube.faces.len());
    let house = |number: u32| {
        let (x, z) = (f64::from(number % 5), f64::from(number / 5));
        let height = 0.1 + 0.07 * f64::from(number * 7 % 11);
        let [x, y, z] = (origin + DVec3::new(0.3 * x, height, 0.3 * z)).to_array();
        format!(r#"{{"mesh":0,"translation":[{x},{y},{z}],"scale":[0.1,{height},0.1]}}"#)
    };
    let houses: Vec<String> = (0..25).map(house).collect();
    let view = |offset: usize, length: usize| format!(r#"{{"buffer":0,"byteOffset":{offset},"byteLength":{length}}}"#);
    let accessor = |view: usize, kind: &str, component: u32, count: usize| {
        format!(r#"{{"bufferView":{view},"componentType":{component},"type":"{kind}","count":{count}}}"#)
    };
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1}},"indices":2}}]}}],
        "accessors":[{},{},{}],"bufferViews":[{},{},{}],
        "buffers":[{{"byteLength":{},"uri":"data:;base64,{}"}}]}}"#,
        houses.join(","),
        accessor(0, "VEC3", 5126, cube.positions.len()),
        accessor(1, "VEC3", 5126, cube.positions.len()),
        accessor(2, "SCALAR", 5125, 3 * cube.faces.len()),
        view(0, vectors),
        view(vectors, vectors),
        view(2 * vectors, indices),
        bytes.len(),
        encoded(&bytes)
    );
    let folder = Folder::new();
    std::fs::write(folder.join("city.gltf"), text).expect("written");
    let loaded = npr_mesh::load(&folder.join("city.gltf"), &LoadOptions::default()).expect("a good file");
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    assert_eq!(loaded.objects.len(), 25);
    Scene::from(loaded)
}

fn picture(executor: &Executor, scene: &Scene, name: &str) -> Image {
    let framing = Framing { yaw_rad: 0.5, pitch_rad: 0.5, fov_y_rad: Some(0.6), ..Framing::default() };
    let camera = Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &framing);
    rendered(executor, scene, &style(name).expect("a style of this crate"), &camera, SIZE)
}

#[test]
fn a_city_at_utm_coordinates_has_the_picture_of_one_at_the_origin() {
    let near = city(DVec3::ZERO);
    let far = city(DVec3::new(500_000.123, 72.4, 5_400_000.456));
    let executors = [Executor::choose(Backend::Cpu).ok(), device()];
    for executor in executors.iter().flatten() {
        for name in ["cartoon", "toon-shadow"] {
            let [near, far] = [&near, &far].map(|scene| picture(executor, scene, name));
            let differs = |(a, b): &(&[u8], &[u8])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 16);
            let count = near.rgba8.chunks(4).zip(far.rgba8.chunks(4)).filter(differs).count();
            assert!(count <= (SIZE.0 * SIZE.1 / 1000) as usize, "{name}: {count} pixels differ");
            let colors: std::collections::HashSet<_> = near.rgba8.chunks(4).collect();
            // Paper, ink, and at least two bands.
            assert!(colors.len() >= 4, "{name}: {} colours", colors.len());
        }
    }
}
