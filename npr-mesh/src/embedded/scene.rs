//! A still life for examples and tests.

use glam::{Mat4, Vec3, Vec4};

use super::{cone, cube, ground, placed, sphere, teapot, torus};
use crate::{Material, Model};

/// Slightly below the objects that stand at y = 0, so that none of their faces is coplanar with the ground. The
/// offset is far below a pixel in any picture of the whole scene.
const GROUND_Y: f32 = -0.001;

/// A teapot with a cube (front left), a torus (front), a sphere (front right) and a cone (right) on a disc.
///
/// It is designed for a view from +Z and slightly above, such as from (3, 6, 13) towards (0, 1, 0.5). The disc has a
/// radius of 8, the teapot a height of 3.15. Each object has one material, in the order teapot, cube, torus, sphere,
/// cone, ground.
pub fn scene() -> Model {
    let at = |x: f32, y: f32, z: f32| Mat4::from_translation(Vec3::new(x, y, z));
    let turned = |degrees: f32| Mat4::from_rotation_y(degrees.to_radians());
    let scaled = |x: f32, y: f32, z: f32| Mat4::from_scale(Vec3::new(x, y, z));
    let mut scene = Model::default();
    let mut add = |model: Model, transform: Mat4, name: &str, srgb: [u8; 3]| {
        let material =
            Material { name: name.into(), base_color: linear(srgb), double_sided: true, ..Material::default() };
        scene.append(&placed(model, transform, material));
    };
    // Rotated so that the spout points slightly towards the viewer.
    add(teapot(12), turned(-20.0), "teapot", [0xd9, 0x6b, 0x43]);
    add(cube(), at(-3.4, 0.8, 3.3) * turned(-30.0) * scaled(0.8, 0.8, 0.8), "cube", [0x4f, 0x86, 0xb5]);
    add(torus(0.85, 0.3, 64, 32), at(0.2, 0.3, 4.1), "torus", [0x6f, 0xa8, 0x6a]);
    add(sphere(64), at(2.9, 0.9, 3.1) * scaled(0.9, 0.9, 0.9), "sphere", [0xe8, 0xb9, 0x3e]);
    add(cone(64), at(5.3, 1.3, 0.2) * scaled(1.1, 1.3, 1.1), "cone", [0x8b, 0x6b, 0xa8]);
    add(ground(8.0), at(0.0, GROUND_Y, 0.0), "ground", [0xec, 0xe4, 0xd4]);
    scene
}

/// An opaque sRGB colour in linear values.
fn linear(srgb: [u8; 3]) -> Vec4 {
    let decode = |byte: u8| {
        let encoded = f32::from(byte) / 255.0;
        if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
    };
    let [r, g, b] = srgb.map(decode);
    Vec4::new(r, g, b, 1.0)
}
