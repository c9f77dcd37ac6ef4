//! The embedded models have the stated openings, outward faces and the stated sizes, and so do their subdivisions.

use std::collections::{HashMap, HashSet};
use std::f64::consts::PI;

use glam::{DVec3, Mat4, Vec2, Vec3, Vec4};
use npr_mesh::embedded::{cone, cube, cylinder, ground, placed, scene, sphere, teapot, torus};
use npr_mesh::subdivide::subdivide_midpoint;
use npr_mesh::{Material, Model};

struct Topology {
    /// V - E + F with vertices at one position merged.
    euler: i64,
    /// The number of edges with one face.
    open: usize,
    /// The number of edges with more than two faces, or with two faces that traverse them in the same direction.
    wrong: usize,
}

fn topology(model: &Model) -> Topology {
    let mut ids: HashMap<[u32; 3], u32> = HashMap::new();
    let welded: Vec<u32> = model
        .positions
        .iter()
        .map(|p| {
            let next = ids.len() as u32;
            *ids.entry((*p + Vec3::ZERO).to_array().map(f32::to_bits)).or_insert(next)
        })
        .collect();
    let mut vertices = HashSet::new();
    let mut edges: HashMap<(u32, u32), [u32; 2]> = HashMap::new();
    for face in &model.faces {
        let [a, b, c] = face.map(|v| welded[v as usize]);
        assert!(a != b && b != c && c != a, "a collapsed face");
        vertices.extend([a, b, c]);
        for (from, to) in [(a, b), (b, c), (c, a)] {
            edges.entry((from.min(to), from.max(to))).or_default()[usize::from(from < to)] += 1;
        }
    }
    Topology {
        euler: vertices.len() as i64 - edges.len() as i64 + model.faces.len() as i64,
        open: edges.values().filter(|[there, back]| there + back == 1).count(),
        wrong: edges.values().filter(|[there, back]| *there > 1 || *back > 1).count(),
    }
}

/// The volume between the faces and `apex`.
fn volume(model: &Model, apex: DVec3) -> f64 {
    let corner = |v: u32| model.positions[v as usize].as_dvec3() - apex;
    model.faces.iter().map(|f| corner(f[0]).dot(corner(f[1]).cross(corner(f[2]))) / 6.0).sum()
}

/// Array lengths match, faces have an area, and the normals at their corners are unit vectors on their front side.
fn check(model: &Model) {
    assert_eq!(model.normals.len(), model.positions.len());
    assert_eq!(model.face_material.len(), model.faces.len());
    assert!(model.face_polygon.is_empty() || model.face_polygon.len() == model.faces.len());
    assert!(model.face_polygon.is_sorted());
    assert!(model.face_material.iter().all(|&m| (m as usize) < model.materials.len()));
    for normal in &model.normals {
        assert!((normal.length() - 1.0).abs() < 1e-5, "{normal}");
    }
    for (index, face) in model.faces.iter().enumerate() {
        let [a, b, c] = face.map(|v| model.positions[v as usize].as_dvec3());
        let across = (b - a).cross(c - a);
        assert!(across.length() > 1e-9, "face {index} has no area");
        for v in face {
            let normal = model.normals[*v as usize].as_dvec3();
            assert!(normal.dot(across.normalize()) > 0.3, "face {index} at {a}: {normal} {}", across.normalize());
        }
    }
}

#[test]
fn closed_solids() {
    // With the Euler characteristic and the volume.
    let torus_volume = 2.0 * PI * PI * 2.0 * 0.25;
    let solids = [
        ("cube", cube(), 2, 8.0),
        ("sphere", sphere(128), 2, 4.0 / 3.0 * PI),
        ("cylinder", cylinder(128), 2, 2.0 * PI),
        ("cone", cone(128), 2, 2.0 / 3.0 * PI),
        ("torus", torus(2.0, 0.5, 128, 64), 0, torus_volume),
    ];
    for (name, model, euler, expected) in solids {
        for model in [subdivide_midpoint(&model), model] {
            check(&model);
            let found = topology(&model);
            assert_eq!((found.euler, found.open, found.wrong), (euler, 0, 0), "{name}");
            let volume = volume(&model, DVec3::ZERO);
            assert!(volume <= expected * 1.000001 && volume > expected * 0.995, "{name}: {volume}");
        }
    }
}

#[test]
fn fewest_segments() {
    for model in [sphere(0), cylinder(0), cone(0), torus(1.0, 0.5, 0, 0)] {
        let found = topology(&model);
        assert_eq!((found.open, found.wrong), (0, 0));
        assert!(volume(&model, DVec3::ZERO) > 0.0);
    }
}

#[test]
fn sphere_tends_to_its_volume() {
    let error = |segments| 4.0 / 3.0 * PI - volume(&sphere(segments), DVec3::ZERO);
    // Second order: twice the segments, a quarter of the error.
    for segments in [16, 32, 64] {
        let ratio = error(segments) / error(2 * segments);
        assert!((3.8..4.2).contains(&ratio), "{ratio}");
    }
}

#[test]
fn cube_has_six_polygons() {
    let cube = cube();
    assert_eq!((cube.faces.len(), cube.positions.len()), (12, 24));
    assert_eq!(cube.face_polygon, [0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5]);
    assert_eq!(cube.bounds(), Some((Vec3::NEG_ONE, Vec3::ONE)));
}

#[test]
fn ground_looks_up() {
    let ground = ground(5.0);
    check(&ground);
    assert_eq!(topology(&ground).open, 128);
    assert!(ground.normals.iter().all(|&n| n == Vec3::Y));
    assert_eq!(ground.bounds(), Some((Vec3::new(-5.0, 0.0, -5.0), Vec3::new(5.0, 0.0, 5.0))));
}

#[test]
fn teapot_has_no_cracks() {
    assert_eq!(teapot(0), teapot(2));
    for n in [2, 3, 7, 12, 16] {
        let model = teapot(n);
        assert_eq!(model.faces.len(), (64 * n * n - 8 * n) as usize);
        let found = topology(&model);
        assert_eq!(found.wrong, 0);
        // Six boundary loops: rim and lid of four quarters each, and four of two halves each.
        assert_eq!(found.open, 16 * n as usize);
        // Two discs (body, lid) and two tubes; the handle ends at a position where the body has a vertex.
        assert_eq!(found.euler, 2 - 1);
        // Every vertex belongs to a face.
        let used: HashSet<u32> = model.faces.iter().flatten().copied().collect();
        assert_eq!(used.len(), model.positions.len());
    }
}

#[test]
fn teapot_looks_outwards() {
    // With fewer segments the narrow lip of the spout is cut off.
    for n in [10, 12, 33] {
        let model = teapot(n);
        check(&model);
        let (low, high) = model.bounds().unwrap();
        assert_eq!((low.y, high.y), (0.0, 3.15));
        assert!(low.x == -3.0 && high.x > 3.4 && high.x < 3.5, "{low} {high}");
        assert_eq!((low.z, high.z), (-2.0, 2.0));
        assert!(volume(&model, DVec3::Y) > 15.0);
    }
}

#[test]
fn teapot_normals_are_those_of_the_surface() {
    let model = teapot(16);
    let normal_at = |p: Vec3| {
        let found: Vec<_> = (0..model.positions.len()).filter(|&v| model.positions[v] == p).collect();
        assert_eq!(found.len(), 1, "{p}");
        model.normals[found[0]]
    };
    // The poles of lid and bottom, and the ring of the body with a vertical tangent.
    assert_eq!(normal_at(Vec3::new(0.0, 3.15, 0.0)), Vec3::Y);
    assert_eq!(normal_at(Vec3::ZERO), Vec3::NEG_Y);
    assert_eq!(normal_at(Vec3::new(2.0, 0.9, 0.0)), Vec3::X);
    // Face normals converge to vertex normals.
    let widest = |n: u32| {
        let model = teapot(n);
        let angle = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|v| model.positions[v as usize].as_dvec3());
            let mean: DVec3 = face.iter().map(|&v| model.normals[v as usize].as_dvec3()).sum();
            (b - a).cross(c - a).angle_between(mean)
        };
        model.faces.iter().map(angle).fold(0.0, f64::max)
    };
    let (coarse, fine) = (widest(16), widest(64));
    assert!(fine < coarse / 2.0 && fine < 0.1, "{coarse} {fine}");
}

#[test]
fn placing_keeps_outside_outside() {
    let turned = Mat4::from_rotation_z(0.7) * Mat4::from_scale(Vec3::new(1.0, 2.0, 3.0));
    let mirrored = turned * Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    for transform in [turned, mirrored] {
        let model = placed(cone(32), transform, Material { name: "felt".into(), ..Material::default() });
        check(&model);
        assert!((volume(&model, DVec3::ZERO) / volume(&cone(32), DVec3::ZERO) - 6.0).abs() < 1e-4);
        assert_eq!(model.materials.len(), 1);
        assert_eq!(model.materials[0].name, "felt");
    }
}

/// The corners of the faces of each material.
fn objects(model: &Model) -> Vec<Vec<Vec3>> {
    let mut objects = vec![Vec::new(); model.materials.len()];
    for (face, &material) in model.faces.iter().zip(&model.face_material) {
        objects[material as usize].extend(face.map(|v| model.positions[v as usize]));
    }
    objects
}

#[test]
fn still_life_stands_on_the_ground_and_apart() {
    let scene = scene();
    check(&scene);
    assert_eq!(topology(&scene).wrong, 0);
    let names: Vec<_> = scene.materials.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["teapot", "cube", "torus", "sphere", "cone", "ground"]);
    let objects = objects(&scene);
    let (ground, things) = objects.split_last().unwrap();
    let highest = ground.iter().map(|p| p.y).fold(f32::MIN, f32::max);
    assert!(highest < 0.0 && highest > -0.01);
    for (i, a) in things.iter().enumerate() {
        let lowest = a.iter().map(|p| p.y).fold(f32::MAX, f32::min);
        assert!(lowest.abs() < 1e-6, "{} {lowest}", names[i]);
        // Two objects are disjoint if a vertical plane separates them.
        for (j, b) in things.iter().enumerate().take(i) {
            let gap = (0..64).map(|k| Vec2::from_angle(std::f32::consts::TAU * k as f32 / 64.0)).map(|direction| {
                let along = |p: &Vec3| Vec2::new(p.x, p.z).dot(direction);
                b.iter().map(along).fold(f32::MAX, f32::min) - a.iter().map(along).fold(f32::MIN, f32::max)
            });
            let gap = gap.fold(f32::MIN, f32::max);
            assert!(gap > 0.1, "{} and {}: {gap}", names[i], names[j]);
        }
    }
}

#[test]
fn subdivision_interpolates_and_keeps_polygons() {
    use npr_mesh::SideVisibility::{Hard, Hidden, Silhouette, Unstated};
    let square = Model {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y],
        normals: vec![Vec3::Z, Vec3::X, Vec3::Z, Vec3::NEG_X],
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
        colors: vec![Vec4::ZERO, Vec4::ONE, Vec4::ONE, Vec4::ONE],
        faces: vec![[0, 1, 2], [0, 2, 3]],
        face_material: vec![0, 0],
        face_mesh: vec![0, 1],
        face_polygon: vec![7, 7],
        one_sided: vec![false, true],
        lines: vec![[0, 2]],
        side_visibility: vec![[Hard, Hidden, Silhouette], [Unstated; 3]],
        materials: vec![Material::default()],
        textures: vec![],
    };
    let fine = subdivide_midpoint(&square);
    assert_eq!((fine.faces.len(), fine.positions.len()), (8, 9));
    assert_eq!(fine.face_polygon, [7; 8]);
    assert_eq!(fine.one_sided, [false, false, false, false, true, true, true, true]);
    assert_eq!(fine.lines, [[0, 2]]);
    assert_eq!(
        fine.side_visibility,
        [
            [Hard, Hidden, Silhouette],
            [Hard, Hidden, Hidden],
            [Hidden, Hidden, Silhouette],
            [Hidden; 3],
            [Unstated; 3],
            [Unstated; 3],
            [Unstated; 3],
            [Unstated; 3],
        ]
    );
    assert_eq!(fine.face_mesh, [0, 0, 0, 0, 1, 1, 1, 1]);
    assert_eq!(fine.positions[..4], square.positions);
    // The midpoints of 0-1, 1-2, 2-0, 2-3, 3-0, in this order.
    assert_eq!(fine.positions[4], Vec3::new(0.5, 0.0, 0.0));
    assert_eq!(fine.positions[6], Vec3::new(0.5, 0.5, 0.0));
    assert!(fine.normals[4].abs_diff_eq(Vec3::new(0.5_f32.sqrt(), 0.0, 0.5_f32.sqrt()), 1e-6));
    assert_eq!(fine.uvs[6], Vec2::splat(0.5));
    assert_eq!(fine.colors[4], Vec4::splat(0.5));
    assert_eq!(fine.faces[..4], [[0, 4, 6], [4, 1, 5], [6, 5, 2], [4, 5, 6]]);
    assert!(subdivide_midpoint(&sphere(8)).face_polygon.is_empty());
    assert_eq!(subdivide_midpoint(&Model::default()), Model::default());
}

#[test]
fn meshes_that_are_appended_stay_apart() {
    let (one, count) = (cube(), cube().faces.len());
    assert!(one.face_mesh.is_empty());
    let mut three = Model::default();
    for _ in 0..3 {
        three.append(&one);
    }
    let numbers = |of: u32| vec![of; count];
    assert_eq!(three.face_mesh, [numbers(0), numbers(1), numbers(2)].concat());
    // A model of several meshes keeps its meshes.
    let mut four = cube();
    four.append(&three);
    assert_eq!(four.face_mesh, [numbers(0), numbers(1), numbers(2), numbers(3)].concat());
}

#[test]
fn faces_without_material_get_one_beside_others_that_have_some() {
    let (with, count) = (cube(), cube().faces.len());
    let without = Model { face_material: vec![], materials: vec![], ..with.clone() };
    let numbers = |of: u32| vec![of; count];
    for (first, second) in [(&with, &without), (&without, &with)] {
        let mut both = first.clone();
        both.append(second);
        assert_eq!(both.face_material, [numbers(0), numbers(1)].concat());
        assert_eq!(both.materials.len(), 2);
        let (given, face) = if first.materials.is_empty() { (0, 0) } else { (1, count as u32) };
        assert_eq!(both.materials[given], Material::default());
        assert_eq!(both.material_of(face), Some(&both.materials[given]));
    }
    let mut neither = without.clone();
    neither.append(&without);
    assert!(neither.face_material.is_empty() && neither.materials.is_empty());
    assert_eq!(neither.material_of(0), None);
    // Appending an empty model to an empty model adds no material.
    let mut only = with.clone();
    only.append(&Model::default());
    assert_eq!((only.face_material, only.materials), (with.face_material, with.materials));
}

#[test]
fn subdivision_multiplies_faces_by_four() {
    let model = teapot(4);
    let twice = subdivide_midpoint(&subdivide_midpoint(&model));
    assert_eq!(twice.faces.len(), model.faces.len() * 16);
    assert_eq!(topology(&twice).open, topology(&model).open * 4);
    assert_eq!(topology(&twice).euler, topology(&model).euler);
    assert!((volume(&twice, DVec3::Y) - volume(&model, DVec3::Y)).abs() < 1e-3);
}
