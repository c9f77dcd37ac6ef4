//! A scene with artist-controlled inner lines: each material has a different source for them.

use crate::camera::{Camera, Projection};
use crate::scene::Scene;
use glam::{DVec3, Mat4, Vec2, Vec3, Vec4};
use npr_imagespace::artist::{LineKind, artist_color};
use npr_mesh::{Material, Model, Texture, Wrap, embedded};

/// A ball with seams (vertex colours), a brick tower (texture), a die (regions from a texture), a cube with creases
/// (normals) and one without.
pub fn painted_scene() -> Scene {
    let mut model = Model::default();
    let at = |x: f32, y: f32, z: f32| Mat4::from_translation(Vec3::new(x, y, z));
    let turned = |degrees: f32| Mat4::from_rotation_y(f32::to_radians(degrees));
    let material = |name: &str, base_color: Vec4, texture: Option<u32>| Material {
        name: name.into(),
        base_color,
        texture,
        double_sided: false,
        ..Material::default()
    };
    let mut add = |part: Model, transform: Mat4, material: Material| {
        // `placed` would offset the texture's index, which already is that in the scene.
        let texture = material.texture;
        model.append(&embedded::placed(part, transform, Material { texture: None, ..material }));
        if let Some(last) = model.materials.last_mut() {
            last.texture = texture;
        }
    };
    let cube = |size: f32| Mat4::from_scale(Vec3::splat(size));
    add(ball(), at(-2.6, 1.0, 0.4) * turned(20.0), material("ball", Vec4::new(0.75, 0.35, 0.2, 1.0), None));
    let bricks_color = Vec4::new(0.55, 0.3, 0.22, 1.0);
    add(
        tower(),
        at(0.1, 1.4, -0.9) * Mat4::from_scale(Vec3::new(0.9, 1.4, 0.9)),
        material("tower", bricks_color, Some(0)),
    );
    add(die(), at(2.5, 0.7, 0.9) * turned(-35.0) * cube(0.7), material("die", Vec4::ONE, Some(1)));
    let blue = Vec4::new(0.2, 0.35, 0.6, 1.0);
    add(embedded::cube(), at(-0.9, 0.5, 2.1) * turned(30.0) * cube(0.5), material("creased", blue, None));
    add(embedded::cube(), at(0.9, 0.5, 2.3) * turned(55.0) * cube(0.5), material("blank", blue, None));
    add(embedded::ground(6.0), at(0.0, -0.001, 0.0), material("ground", Vec4::new(0.8, 0.76, 0.65, 1.0), None));
    model.textures = vec![bricks(), pips()];
    let mut scene = Scene::new(model);
    scene.line_kinds = vec![
        LineKind::VertexColor,
        LineKind::Texture,
        LineKind::Regions,
        LineKind::Normals,
        LineKind::None,
        LineKind::Normals,
    ];
    scene
}

/// The camera for which the scene is composed.
pub fn painted_camera() -> Camera {
    Camera {
        eye: DVec3::new(1.5, 4.6, 11.0),
        target: DVec3::new(0.0, 1.05, 0.4),
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y_rad: 27f64.to_radians() },
        near: 0.1,
    }
}

/// A sphere with eight sectors and two caps. Faces share no vertices, so that colours end at their borders.
fn ball() -> Model {
    let round = embedded::sphere(96);
    let mut ball =
        Model { face_material: round.face_material.clone(), materials: round.materials.clone(), ..Model::default() };
    for face in &round.faces {
        let corners = face.map(|v| round.positions[v as usize]);
        let middle: Vec3 = corners.iter().sum::<Vec3>() / 3.0;
        let sector = (middle.z.atan2(middle.x) / std::f32::consts::TAU * 8.0).rem_euclid(8.0) as u32;
        let index = if middle.y.abs() > 0.93 { 2 } else { sector % 2 };
        let first = ball.positions.len() as u32;
        ball.faces.push([first, first + 1, first + 2]);
        ball.positions.extend(corners);
        ball.normals.extend(face.map(|v| round.normals[v as usize]));
        ball.colors.extend([linear(artist_color(index)); 3]);
    }
    ball
}

/// Converts a display-referred colour to a linear opaque one.
fn linear(color: Vec3) -> Vec4 {
    let decode = |c: f32| crate::color::decode_srgb(f64::from(c)) as f32;
    Vec4::new(decode(color.x), decode(color.y), decode(color.z), 1.0)
}

/// A cylinder with a texture that repeats twice around it.
fn tower() -> Model {
    let mut tower = embedded::cylinder(96);
    let around = |p: Vec3| p.z.atan2(p.x) / std::f32::consts::TAU;
    // The lids are mapped to a single brick of the second row.
    let lid = Vec2::new(0.05, 0.19);
    let is_lid = |normal: Vec3| normal.y.abs() > 0.5;
    let side = |p: Vec3| Vec2::new(2.0 * around(p), 0.5 - 0.5 * p.y);
    let uv = |(&p, &n): (&Vec3, &Vec3)| if is_lid(n) { lid } else { side(p) };
    tower.uvs = tower.positions.iter().zip(&tower.normals).map(uv).collect();
    // Faces across the seam, where the angle wraps around, get separate vertices.
    for face in &mut tower.faces {
        if is_lid(tower.normals[face[0] as usize]) {
            continue;
        }
        let angles = face.map(|v| around(tower.positions[v as usize]));
        if angles.iter().any(|&a| a > 0.25) {
            *face = face.map(|v| {
                if around(tower.positions[v as usize]) > -0.25 {
                    return v;
                }
                tower.positions.push(tower.positions[v as usize]);
                tower.normals.push(tower.normals[v as usize]);
                tower.uvs.push(tower.uvs[v as usize] + Vec2::X * 2.0);
                (tower.positions.len() - 1) as u32
            });
        }
    }
    tower
}

/// A cube with the whole texture on each side.
fn die() -> Model {
    let mut die = embedded::cube();
    let corners = [Vec2::Y, Vec2::ONE, Vec2::X, Vec2::ZERO];
    die.uvs = (0..die.positions.len()).map(|v| corners[v % 4]).collect();
    die
}

/// Red and alpha select one of four directions; adjacent bricks have different ones.
fn bricks() -> Texture {
    const SIZE: u32 = 256;
    let texel = |x: u32, y: u32| {
        let row = y / (SIZE / 8);
        let column = (x + if row % 2 == 1 { SIZE / 8 } else { 0 }) / (SIZE / 4) % 4;
        let of = |bit: u32| if bit % 2 == 1 { 255 } else { 0 };
        [of(row), 0, 0, of(column)]
    };
    let rgba8 = (0..SIZE).flat_map(|y| (0..SIZE).flat_map(move |x| texel(x, y))).collect();
    Texture { name: "bricks".into(), width: SIZE, height: SIZE, rgba8, wrap: [Wrap::Repeat, Wrap::Clamp], smooth: true }
}

/// Five pips, each a region with its own colour.
fn pips() -> Texture {
    const SIZE: u32 = 128;
    let centers = [(0.26, 0.26), (0.74, 0.26), (0.5, 0.5), (0.26, 0.74), (0.74, 0.74)];
    let texel = |x: u32, y: u32| {
        let at = |v: u32| (v as f32 + 0.5) / SIZE as f32;
        let inside = |(cx, cy): (f32, f32)| (at(x) - cx).hypot(at(y) - cy) < 0.1;
        if centers.into_iter().any(inside) { [196, 60, 52, 255] } else { [244, 240, 228, 255] }
    };
    let rgba8 = (0..SIZE).flat_map(|y| (0..SIZE).flat_map(move |x| texel(x, y))).collect();
    Texture { name: "pips".into(), width: SIZE, height: SIZE, rgba8, wrap: [Wrap::Clamp; 2], smooth: true }
}
