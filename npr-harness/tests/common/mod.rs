//! Helpers for several tests.
#![allow(dead_code, clippy::print_stdout)]

use glam::{Mat4, Vec2, Vec3, Vec4};
use npr_harness::camera::Camera;
use npr_harness::capabilities::Capabilities;
use npr_harness::executor::{Backend, Executor, Picture};
use npr_harness::picture::Image;
use npr_harness::plan::Plan;
use npr_harness::scene::Scene;
use npr_harness::style::Style;
use npr_harness::view::View;
use npr_mesh::{AlphaMode, Material, Model, Texture, Wrap};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// The GPU executor, or `None` with a message if there is no adapter and `NPR_GPU` does not require one.
///
/// # Panics
/// If `NPR_GPU=required` and there is no adapter.
pub fn device() -> Option<Executor> {
    match Executor::choose(Backend::Auto).unwrap_or_else(|error| panic!("{error}")) {
        Executor::Cpu { why } => {
            println!("skipped: {}", why.map_or_else(|| "no device".to_owned(), |why| why.to_string()));
            None
        }
        #[cfg(feature = "gpu")]
        executor => Some(executor),
    }
}

/// The plan for the CPU.
pub fn planned(scene: &Scene, style: &Style, camera: &Camera, size: (u32, u32)) -> Plan {
    Plan::new(scene, style, &View::new(*camera, size), &Capabilities::RAY_CASTER).expect("a good style")
}

/// Renders a picture with an executor.
pub fn rendered(executor: &Executor, scene: &Scene, style: &Style, camera: &Camera, size: (u32, u32)) -> Image {
    executor.render(&Picture::new(scene, style, View::new(*camera, size)), &|_| {}).expect("a picture")
}

/// A new folder that is deleted when dropped.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new() -> Self {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let name = format!("npr-test-{}-{}", std::process::id(), NUMBER.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&path).expect("a folder can be made");
        Self(path)
    }

    pub fn join(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Models outside this repository, if present.
pub fn shared_models() -> Option<PathBuf> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    if !folder.is_dir() {
        println!("skipped: no models at {}", folder.display());
        return None;
    }
    Some(folder.to_owned())
}

/// A row of squares facing +Z; `material` returns the material of each.
pub fn cards(count: u32, uv_scale: f32, material: impl Fn(u32) -> Material) -> Model {
    let mut model = Model::default();
    for number in 0..count {
        // Each is slightly behind the previous one and rotated, so that they overlap.
        let place = Mat4::from_translation(Vec3::new(number as f32 * 1.3, 0.0, number as f32 * -0.4))
            * Mat4::from_rotation_y(0.3 + number as f32 * 0.7);
        let corners = [Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0), Vec2::ONE, Vec2::new(-1.0, 1.0)];
        let mut card = Model {
            positions: corners.map(|c| place.transform_point3(c.extend(0.0))).to_vec(),
            normals: vec![place.transform_vector3(Vec3::Z); 4],
            uvs: corners.map(|c| Vec2::new(c.x, -c.y) * uv_scale + 0.5).to_vec(),
            faces: vec![[0, 1, 2], [0, 2, 3]],
            face_material: vec![0; 2],
            face_polygon: vec![0; 2],
            materials: vec![material(number)],
            ..Default::default()
        };
        card.materials[0].name = format!("card {number}");
        model.append(&card);
    }
    model
}

/// Smooth waves in colour and alpha, without symmetry.
pub fn waves(width: u32, height: u32, wrap: [Wrap; 2], smooth: bool) -> Texture {
    let wave = |v: u32, n: u32, turns: f32, phase: f32| {
        let at = (v as f32 + 0.5) / n as f32;
        (127.5 + 120.0 * (std::f32::consts::TAU * (turns * at + phase)).sin()) as u8
    };
    let rgba8 = (0..height)
        .flat_map(|y| {
            (0..width).flat_map(move |x| {
                [
                    wave(x, width, 1.0, 0.1),
                    wave(y, height, 2.0, 0.3),
                    wave(x + y, width, 1.0, 0.6),
                    wave(y, height, 1.0, 0.0),
                ]
            })
        })
        .collect();
    Texture { name: "waves".into(), width, height, rgba8, wrap, smooth }
}

/// A material of one colour.
pub fn plain(base_color: Vec4, alpha_mode: AlphaMode, double_sided: bool) -> Material {
    Material { base_color, alpha_mode, double_sided, ..Default::default() }
}
