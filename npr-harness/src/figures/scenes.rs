//! The scenes and views of figures.

use crate::camera::{Camera, Projection};
use crate::gallery::{painted_camera, painted_scene, still_life_camera};
use crate::scene::Scene;
use glam::{DAffine3, DVec3, DVec4, Mat4, Vec2, Vec3, Vec4};
use npr_imagespace::artist::LineKind;
use npr_mesh::pn_triangles::tessellate;
use npr_mesh::{AlphaMode, Material, Model, Texture, Wrap, embedded};

/// A scene and its view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Setting {
    /// The built-in still life.
    StillLife,
    /// The still life without its ground.
    Objects,
    /// The still life, with the near plane at half the distance.
    NearPlane,
    /// The scene that an artist painted lines on.
    Painted,
    /// A cube, a cylinder, a ball and a ring, seen from the side of +z.
    Front,
    /// A ball and a cylinder of few segments.
    Coarse,
    /// A sheet of tiles of one plane, each a mesh of its own.
    Tiles,
    /// A teapot placed twice, upright and lying.
    TwoTeapots,
    /// Round cans of long narrow faces, close to the viewer.
    Cans,
    /// A coarse ball, rounded as PN triangles, that passes through a cube.
    Crossing,
    /// The same, cut by a plane.
    Clipped,
    /// The same, cut by the near plane.
    NearCut,
    /// Alpha-tested cards with petals, before a ball.
    CutOut,
    /// A sharp wedge that points at the viewer.
    Wedge,
}

impl Setting {
    /// All settings.
    pub const ALL: [Self; 14] = [
        Self::StillLife,
        Self::Objects,
        Self::NearPlane,
        Self::Painted,
        Self::Front,
        Self::Coarse,
        Self::Tiles,
        Self::TwoTeapots,
        Self::Cans,
        Self::Crossing,
        Self::Clipped,
        Self::NearCut,
        Self::CutOut,
        Self::Wedge,
    ];

    /// What it is, and where a view is not the scene's usual one, how it is seen.
    pub fn about(self) -> &'static str {
        match self {
            Self::StillLife => "the built-in still life",
            Self::Objects => "the still life without its ground",
            Self::NearPlane => "the still life, the near plane at 7 of some 14 to 20 units",
            Self::Painted => "the scene that an artist painted",
            Self::Front => "a cube, a can, a ball and a ring from the side of +z",
            Self::Coarse => "a ball and a can of ten segments",
            Self::Tiles => "1,296 tiles of one plane, each a mesh",
            Self::TwoTeapots => "a teapot twice, upright and lying",
            Self::Cans => "cans of 367 to 613 segments",
            Self::Crossing => "a rounded ball through a cube",
            Self::Clipped => "a rounded ball through a cube, clipped by (-0.5, 0, -1, 1.1)",
            Self::NearCut => "a rounded ball through a cube, the near plane at 6.9 of some 8 units",
            Self::CutOut => "two alpha-tested cards before a ball",
            Self::Wedge => "a wedge of 24 degrees",
        }
    }

    /// The scene.
    pub fn scene(self) -> Scene {
        match self {
            Self::StillLife | Self::NearPlane => Scene::new(embedded::scene()),
            Self::Objects => Scene::new(objects()),
            Self::Painted => painted_scene(),
            Self::Front => Scene::new(front()),
            Self::Coarse => Scene::new(coarse()),
            Self::Tiles => tiles(),
            Self::TwoTeapots => two_teapots(),
            Self::Cans => Scene::new(cans()),
            Self::Crossing | Self::NearCut => Scene::new(crossing()),
            Self::Clipped => {
                let mut scene = Scene::new(crossing());
                scene.clip = Some(scene.plane_here(DVec4::new(-0.5, 0.0, -1.0, 1.1)));
                scene
            }
            Self::CutOut => Scene::new(cut_out()),
            Self::Wedge => Scene::new(wedge()),
        }
    }

    /// The view.
    pub fn camera(self) -> Camera {
        let looking = |eye: DVec3, target: DVec3, fov_deg: f64| Camera {
            eye,
            target,
            up: DVec3::Y,
            projection: Projection::Perspective { fov_y_rad: fov_deg.to_radians() },
            near: 0.1,
        };
        match self {
            Self::StillLife | Self::Objects => still_life_camera(),
            Self::NearPlane => Camera { near: 7.0, ..still_life_camera() },
            Self::Painted => painted_camera(),
            Self::Front => looking(DVec3::new(0.0, 1.0, 14.0), DVec3::new(0.0, 1.0, 0.0), 26.0),
            Self::Coarse => looking(DVec3::new(0.0, 2.2, 9.0), DVec3::new(0.0, 1.0, 0.0), 22.0),
            Self::Tiles => looking(DVec3::new(0.0, 0.0, 10.0), DVec3::ZERO, 34.0),
            Self::TwoTeapots => looking(DVec3::new(0.0, 4.5, 15.0), DVec3::new(0.0, 1.6, 0.0), 31.0),
            Self::Crossing | Self::Clipped => looking(DVec3::new(2.5, 3.0, 7.5), DVec3::new(0.0, 0.1, 0.0), 26.0),
            Self::NearCut => Camera { near: 6.9, ..Self::Crossing.camera() },
            Self::Wedge => looking(DVec3::new(0.0, 1.0, 9.0), DVec3::new(0.0, 0.6, 0.0), 22.0),
            Self::CutOut => looking(DVec3::new(0.5, 1.5, 8.0), DVec3::new(0.0, 0.1, 0.0), 26.0),
            Self::Cans => looking(DVec3::new(0.0, 1.4, 3.4), DVec3::new(0.0, 0.9, 0.0), 50.0),
        }
    }
}

fn material(r: f32, g: f32, b: f32) -> Material {
    Material { base_color: Vec4::new(r, g, b, 1.0), ..Material::default() }
}

fn at(x: f32, y: f32, z: f32) -> Mat4 {
    Mat4::from_translation(Vec3::new(x, y, z))
}

fn front() -> Model {
    let mut model = Model::default();
    let parts = [
        (embedded::cube(), at(-3.6, 1.0, 0.0) * Mat4::from_scale(Vec3::splat(0.9)), material(0.2, 0.4, 0.6)),
        (embedded::cylinder(64), at(-1.2, 1.0, 0.0) * Mat4::from_scale(Vec3::splat(0.9)), material(0.6, 0.3, 0.15)),
        (embedded::sphere(64), at(1.2, 1.0, 0.0) * Mat4::from_scale(Vec3::splat(0.95)), material(0.7, 0.5, 0.1)),
        (embedded::torus(0.75, 0.3, 64, 32), at(3.6, 1.0, 0.0) * Mat4::from_rotation_x(1.1), material(0.2, 0.45, 0.2)),
    ];
    for (part, place, material) in parts {
        model.append(&embedded::placed(part, place, material));
    }
    model
}

fn coarse() -> Model {
    let mut model = Model::default();
    let (ball, can) = (material(0.7, 0.5, 0.1), material(0.6, 0.3, 0.15));
    model.append(&embedded::placed(embedded::sphere(10), at(-1.3, 1.0, 0.0), ball));
    model.append(&embedded::placed(embedded::cylinder(10), at(1.4, 1.0, 0.0), can));
    model
}

/// 48 × 27 tiles without gaps, so that neither normals nor depths differ, and 1,296 regions do.
fn tiles() -> Scene {
    let mut model = Model::default();
    for number in 0..48 * 27u32 {
        let (x, y) = ((number % 48) as f32, (number / 48) as f32);
        let corner = |dx: f32, dy: f32| Vec3::new((x + dx) * 0.2 - 4.8, (y + dy) * 0.2 - 2.7, 0.0);
        let tile = Model {
            positions: vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)],
            normals: vec![Vec3::Z; 4],
            faces: vec![[0, 1, 2], [0, 2, 3]],
            face_material: vec![0; 2],
            face_polygon: vec![0; 2],
            materials: vec![material(0.8, 0.8, 0.75)],
            ..Model::default()
        };
        model.append(&tile);
    }
    let mut scene = Scene::new(model);
    scene.line_kinds = vec![LineKind::Normals; scene.materials().len()];
    scene
}

fn two_teapots() -> Scene {
    let mut teapot = embedded::teapot(12);
    teapot.materials = vec![Material { double_sided: true, ..material(0.7, 0.3, 0.15) }];
    let placed = |name: &str, world_from_mesh| npr_mesh::Object { name: name.into(), mesh: 0, world_from_mesh };
    let upright = DAffine3::from_translation(DVec3::new(-3.0, 0.0, 0.0));
    // On its side, and turned around.
    let lying = DAffine3::from_translation(DVec3::new(3.2, 1.6, 0.0))
        * DAffine3::from_rotation_y(2.2)
        * DAffine3::from_rotation_z(std::f64::consts::FRAC_PI_2)
        * DAffine3::from_translation(DVec3::new(0.0, -1.5, 0.0));
    Scene::with_objects(vec![teapot], vec![placed("upright", upright), placed("lying", lying)])
        .expect("the transforms are regular")
}

fn objects() -> Model {
    let mut model = embedded::scene();
    // The ground is the last material.
    let ground = model.materials.len() as u32 - 1;
    let kept = model.face_material.iter().filter(|&&material| material != ground).count();
    model.faces.truncate(kept);
    model.face_material.truncate(kept);
    model.face_polygon.truncate(kept);
    model.face_mesh.truncate(kept);
    model
}

fn cans() -> Model {
    let mut model = Model::default();
    for (x, z, radius, height, segments) in [
        (-1.5, 0.0, 0.5, 1.0, 501),
        (-0.2, 0.7, 0.35, 0.8, 367),
        (0.9, 0.2, 0.45, 1.1, 433),
        (1.9, -0.8, 0.4, 1.2, 613),
    ] {
        // Tilted, so that normals have no component of 0, which every format holds exactly.
        let tilted = Mat4::from_rotation_z(0.17 * x) * Mat4::from_rotation_x(0.11 + 0.2 * z);
        let place = at(x, height, z) * tilted * Mat4::from_scale(Vec3::new(radius, height, radius));
        model.append(&embedded::placed(embedded::cylinder(segments), place, material(0.6, 0.6, 0.6)));
    }
    model
}

fn crossing() -> Model {
    let mut model = Model::default();
    let (blue, yellow) = (material(0.2, 0.4, 0.6), material(0.7, 0.5, 0.1));
    model.append(&embedded::placed(embedded::cube(), at(-0.5, 0.0, 0.0) * Mat4::from_rotation_y(0.4), blue));
    let round = tessellate(&embedded::sphere(10), 6).unwrap_or_default();
    model.append(&embedded::placed(round, at(0.8, 0.3, 0.4) * Mat4::from_scale(Vec3::splat(1.1)), yellow));
    model
}

/// Two crossed cards of leaves that alpha cuts out, and a ball behind them.
fn cut_out() -> Model {
    const SIDE: u32 = 128;
    let mut model = Model::default();
    model.append(&embedded::placed(embedded::sphere(48), at(0.6, 0.0, -1.2), material(0.7, 0.5, 0.1)));
    for (x, turn) in [(-0.9, 0.35f32), (1.1, -0.5)] {
        let corners = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
        let place = at(x, 0.0, 0.4) * Mat4::from_rotation_y(turn);
        let card = Model {
            positions: corners
                .iter()
                .map(|c| place.transform_point3(Vec3::new(c.x * 2.0 - 1.0, c.y * 2.0 - 1.0, 0.0)))
                .collect(),
            normals: vec![place.transform_vector3(Vec3::Z); 4],
            uvs: corners.to_vec(),
            faces: vec![[0, 1, 2], [0, 2, 3]],
            face_material: vec![0; 2],
            face_polygon: vec![0; 2],
            materials: vec![Material {
                texture: Some(0),
                alpha_mode: AlphaMode::Mask { cutoff: 0.5 },
                double_sided: true,
                ..Material::default()
            }],
            textures: vec![leaves(SIDE)],
            ..Model::default()
        };
        model.append(&card);
    }
    model
}

/// Five petals: opaque inside, transparent outside.
fn leaves(side: u32) -> Texture {
    let texel = |x: u32, y: u32| {
        let at = (Vec2::new(x as f32, y as f32) + 0.5) / side as f32 * 2.0 - 1.0;
        let petal = 0.62 + 0.3 * (5.0 * at.y.atan2(at.x)).cos();
        let alpha = ((petal - at.length()) * 12.0 + 0.5).clamp(0.0, 1.0);
        [96, 150, 84, (alpha * 255.0) as u8]
    };
    let rgba8 = (0..side).flat_map(|y| (0..side).flat_map(move |x| texel(x, y))).collect();
    Texture { name: "petals".into(), width: side, height: side, rgba8, wrap: [Wrap::Clamp; 2], smooth: true }
}

/// Two faces that meet in an upright ridge at an angle of 24°, closed behind, above and below.
fn wedge() -> Model {
    let (half, deep, high) = (12f32.to_radians().tan() * 3.0, 3.0, 1.8);
    let corners = [[0.0, 1.5], [half, 1.5 - deep], [-half, 1.5 - deep]];
    let mut model = Model { materials: vec![material(0.8, 0.8, 0.75)], ..Model::default() };
    let mut polygon = |points: &[Vec3]| {
        let first = model.positions.len() as u32;
        let normal = (points[1] - points[0]).cross(points[2] - points[0]).normalize();
        let number = model.face_polygon.last().map_or(0, |last| last + 1);
        model.positions.extend(points);
        model.normals.extend(points.iter().map(|_| normal));
        for corner in 2..points.len() as u32 {
            model.faces.push([first, first + corner - 1, first + corner]);
            model.face_material.push(0);
            model.face_polygon.push(number);
        }
    };
    let at = |[x, z]: [f32; 2], y: f32| Vec3::new(x, y, z);
    for side in 0..3 {
        let (a, b) = (corners[side], corners[(side + 1) % 3]);
        polygon(&[at(a, 0.0), at(b, 0.0), at(b, high), at(a, high)]);
    }
    polygon(&corners.map(|corner| at(corner, high)));
    let [a, b, c] = corners.map(|corner| at(corner, 0.0));
    polygon(&[a, c, b]);
    model
}
