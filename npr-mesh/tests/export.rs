//! Models written as `.glb` and loaded again.
#![cfg(all(feature = "export", feature = "gltf"))]

mod glb;

use SideVisibility::{Hard, Hidden, RepeatedHard, Silhouette, Unstated};
use glam::{DAffine3, DMat3, DVec3, Vec2, Vec3, Vec4, dvec3};
use glb::load_glb;
use npr_mesh::export::{ExportError, ExportOptions, glb, side_classes};
use npr_mesh::{AlphaMode, Limits, Loaded, Material, Model, Object, SideVisibility, Texture, Wrap, embedded};
use proptest::prelude::*;

const EDGES: ExportOptions = ExportOptions { edges: Some(0.8) };

fn once() -> Vec<Object> {
    vec![Object { name: String::new(), mesh: 0, world_from_mesh: DAffine3::IDENTITY }]
}

fn written(model: &Model, options: &ExportOptions) -> Vec<u8> {
    glb(std::slice::from_ref(model), &once(), options).expect("a good model")
}

fn json(file: &[u8]) -> serde_json::Value {
    let length = u32::from_le_bytes(file[12..16].try_into().expect("four bytes")) as usize;
    serde_json::from_slice(&file[20..20 + length]).expect("JSON")
}

fn loaded(file: &[u8]) -> Loaded {
    let loaded = load_glb(file, Limits::default()).expect("a good file");
    assert_eq!(loaded.warnings, []);
    loaded
}

/// The faces in the order of their materials, in which a file has them.
fn order(model: &Model) -> Vec<usize> {
    let mut faces: Vec<usize> = (0..model.faces.len()).collect();
    faces.sort_by_key(|&face| model.face_material.get(face).copied());
    faces
}

/// All vertex data of each corner.
fn corners(model: &Model, face: usize) -> Vec<Vec<f32>> {
    let of_vertex = |&vertex: &u32| {
        let vertex = vertex as usize;
        let mut values = model.positions[vertex].to_array().to_vec();
        values.extend(model.normals[vertex].to_array());
        values.extend(model.uvs.get(vertex).copied().unwrap_or_default().to_array());
        values.extend(model.colors.get(vertex).copied().unwrap_or(Vec4::ONE).to_array());
        values
    };
    model.faces[face].iter().map(of_vertex).collect()
}

fn models() -> Vec<(&'static str, Model)> {
    vec![
        ("cube", embedded::cube()),
        ("sphere", embedded::sphere(8)),
        ("cylinder", embedded::cylinder(12)),
        ("cone", embedded::cone(9)),
        ("torus", embedded::torus(1.0, 0.4, 12, 6)),
        ("teapot", embedded::teapot(3)),
        ("scene", embedded::scene()),
    ]
}

#[test]
fn what_is_written_is_loaded_again() {
    for (name, model) in models() {
        let file = written(&model, &EDGES);
        let (classes, normals) = side_classes(&model, 0.8);
        let again = loaded(&file).into_model();
        assert_eq!(again.faces.len(), model.faces.len(), "{name}");
        for (new, old) in order(&model).into_iter().enumerate() {
            assert_eq!(again.side_visibility[new], classes[old], "{name}: face {old}");
            // The loader divides normals by their length anew.
            let differences = corners(&again, new).concat().into_iter().zip(corners(&model, old).concat());
            assert!(differences.into_iter().all(|(a, b)| (a - b).abs() < 2e-7), "{name}: face {old}");
            assert_eq!(
                again.material_of(new as u32),
                model.material_of(old as u32).or(Some(&Material::default())),
                "{name}"
            );
        }
        assert!(!classes.iter().flatten().any(|class| *class == Unstated));
        let silhouettes = classes.iter().flatten().filter(|class| **class == Silhouette).count();
        assert_eq!(normals.values().map(Vec::len).sum::<usize>(), silhouettes);
        // In a second generation nothing is classed anew.
        let second = written(&again, &ExportOptions { edges: Some(0.01) });
        assert_eq!((second.len(), json(&second)), (file.len(), json(&file)), "{name}");
        assert_eq!(loaded(&second).into_model().side_visibility, again.side_visibility, "{name}");
        // Without classes nothing is stated.
        let plain = loaded(&written(&model, &ExportOptions::default())).into_model();
        assert!(plain.side_visibility.is_empty());
    }
}

fn counts(model: &Model) -> [usize; 4] {
    let (classes, _) = side_classes(model, 0.8);
    [Hidden, Silhouette, Hard, RepeatedHard].map(|class| classes.iter().flatten().filter(|c| **c == class).count())
}

#[test]
fn edges_are_classed_by_their_angles() {
    // Six diagonals with two sides each; twelve edges.
    assert_eq!(counts(&embedded::cube()), [12, 0, 12, 12]);
    // Both rims are hard. Of the caps' diagonals and of the sides' all are hidden, and each of the twelve edges along the
    // side is stated once.
    let [hidden, silhouettes, hard, repeated] = counts(&embedded::cylinder(12));
    assert_eq!((silhouettes, hard, repeated), (12, 24, 24));
    assert_eq!((hidden + silhouettes + hard + repeated) % 3, 0);
    // A smooth closed surface has silhouettes alone, each stated at one of its two sides.
    // Its quads are flat.
    assert_eq!(counts(&embedded::torus(1.0, 0.4, 24, 12)), [3 * 576 - 576, 576, 0, 0]);
    // A plate: its border is hard, the diagonal flat.
    let plate = Model {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::ONE.with_z(0.0), Vec3::Y],
        normals: vec![Vec3::Z; 4],
        faces: vec![[0, 1, 2], [0, 2, 3]],
        ..Model::default()
    };
    assert_eq!(side_classes(&plate, 0.8).0, [[Hard, Hard, Hidden], [Hidden, Hard, Hard]]);
    // Folded by 30° it is a silhouette, by 60° a crease; three faces at one edge make it hard.
    let folded = |angle: f32| {
        let mut folded = plate.clone();
        let along = Vec3::new(1.0, 1.0, 0.0).normalize();
        let across = Vec3::new(-1.0, 1.0, 0.0) * 0.5;
        folded.positions[3] = Vec3::new(0.5, 0.5, 0.0) + glam::Quat::from_axis_angle(along, angle) * across;
        side_classes(&folded, 0.8).0
    };
    assert_eq!(folded(30f32.to_radians()), [[Hard, Hard, Silhouette], [Hidden, Hard, Hard]]);
    assert_eq!(folded(-60f32.to_radians()), [[Hard, Hard, Hard], [RepeatedHard, Hard, Hard]]);
    let mut three = plate.clone();
    three.positions.push(Vec3::Z);
    three.normals.push(Vec3::Z);
    three.faces.push([0, 2, 4]);
    assert_eq!(side_classes(&three, 0.8).0[2], [RepeatedHard, Hard, Hard]);
}

#[test]
fn the_diagonal_of_a_polygon_is_hidden_only_where_it_is_flat() {
    let quad = |height: f32| {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, height), Vec3::Y];
        Model { positions, faces: vec![[0, 1, 2], [0, 2, 3]], face_polygon: vec![0, 0], ..folded_plate() }
    };
    assert_eq!(side_classes(&quad(0.0), 0.8).0, [[Hard, Hard, Hidden], [Hidden, Hard, Hard]]);
    // By less than what makes a fold, and by more.
    for height in [0.01, 0.5] {
        let (classes, normals) = side_classes(&quad(height), 0.8);
        assert_eq!(classes, [[Hard, Hard, Silhouette], [Hidden, Hard, Hard]]);
        let [own, other] = normals[&0][0].map(Vec3::from_array);
        assert!(own.distance(Vec3::new(0.0, -height, 1.0).normalize()) < 1e-6, "{own}");
        assert!(other.distance(Vec3::new(-height, 0.0, 1.0).normalize()) < 1e-6, "{other}");
    }
}

#[test]
fn an_edge_is_stated_once_for_each_material() {
    let model = Model { face_material: vec![0, 1], materials: vec![Material::default(); 2], ..folded_plate() };
    assert_eq!(side_classes(&model, 0.8).0, [[Hard, Hard, Hard], [Hard, Hard, Hard]]);
    let one = Model { face_material: vec![1, 1], ..model };
    assert_eq!(side_classes(&one, 0.8).0, [[Hard, Hard, Hard], [RepeatedHard, Hard, Hard]]);
}

/// Two faces at a right angle.
fn folded_plate() -> Model {
    Model {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z],
        normals: vec![Vec3::Z; 4],
        faces: vec![[0, 1, 2], [0, 2, 3]],
        ..Model::default()
    }
}

#[test]
fn what_the_file_states_is_kept_and_the_rest_is_classed_beside_it() {
    let stated = |sides: [[SideVisibility; 3]; 2]| {
        side_classes(&Model { side_visibility: sides.to_vec(), ..folded_plate() }, 0.8).0
    };
    let u = Unstated;
    assert_eq!(stated([[u, u, u], [Hidden, Hidden, Silhouette]])[1], [Hidden, Hidden, Silhouette]);
    // Of an edge that one side states the other side is the repetition; else its angle decides.
    assert_eq!(stated([[u, u, u], [Hard, u, u]]), [[Hard, Hard, RepeatedHard], [Hard, Hard, Hard]]);
    assert_eq!(stated([[u, u, u], [Hidden, u, u]])[0], [Hard, Hard, Hard]);
    // Even nonsense: an edge that is stated twice, or only as a repetition.
    for sides in [[[Hard; 3]; 2], [[RepeatedHard; 3]; 2], [[Silhouette; 3]; 2], [[Hidden; 3]; 2]] {
        assert_eq!(stated(sides), sides);
    }
}

#[test]
fn silhouettes_have_the_outward_normals_of_both_faces() {
    let model = embedded::sphere(8);
    let (classes, normals) = side_classes(&model, 0.8);
    for (&face, pairs) in &normals {
        let of_face = classes[face as usize].iter().filter(|class| **class == Silhouette).count();
        assert_eq!(pairs.len(), of_face);
        let middle: Vec3 = model.faces[face as usize].iter().map(|&v| model.positions[v as usize]).sum();
        for [own, other] in pairs.iter().map(|pair| pair.map(Vec3::from_array)) {
            assert!(own.is_normalized() && other.is_normalized());
            assert!(own.dot(middle.normalize()) > 0.9 && other.dot(middle.normalize()) > 0.5, "{own} {other} {middle}");
            assert!(own.dot(other) < 0.9999);
        }
    }
    // In the file there are two for each, in the order of the sides.
    let file = written(&model, &EDGES);
    let length = u32::from_le_bytes(file[12..16].try_into().expect("four bytes")) as usize;
    let json = json(&file);
    let extension = &json["meshes"][0]["primitives"][0]["extensions"]["EXT_mesh_primitive_edge_visibility"];
    let accessor = &json["accessors"][extension["silhouetteNormals"].as_u64().expect("a number") as usize];
    let silhouettes = classes.iter().flatten().filter(|class| **class == Silhouette).count();
    assert_eq!((accessor["count"].as_u64(), &accessor["type"]), (Some(2 * silhouettes as u64), &"VEC3".into()));
    let view = &json["bufferViews"][accessor["bufferView"].as_u64().expect("a number") as usize];
    let start = 28 + length + view["byteOffset"].as_u64().expect("a number") as usize;
    let first = (0..model.faces.len() as u32).find_map(|face| normals.get(&face)).expect("one")[0][0];
    let bytes: Vec<u8> = first.iter().flat_map(|x| x.to_le_bytes()).collect();
    assert_eq!(file[start..start + 12], bytes);
    assert_eq!(json["extensionsUsed"], serde_json::json!(["EXT_mesh_primitive_edge_visibility"]));
}

#[test]
fn lines_objects_materials_and_textures_are_written() {
    let texture = Texture {
        name: "two texels".into(),
        width: 2,
        height: 1,
        rgba8: vec![255, 0, 0, 255, 0, 128, 255, 40].into(),
        wrap: [Wrap::Mirror, Wrap::Clamp],
        smooth: false,
    };
    let material = |name: &str, alpha_mode, texture| Material {
        name: name.into(),
        base_color: Vec4::new(0.1, 0.2, 0.3, 0.4),
        texture,
        alpha_mode,
        double_sided: false,
        emissive: Vec3::new(0.25, 3.0, 0.0),
        emissive_texture: texture,
    };
    let model = Model {
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::new(0.25, -3.0)],
        colors: vec![Vec4::new(0.5, 0.25, 0.125, 1.0); 4],
        face_material: vec![1, 0],
        materials: vec![material("a", AlphaMode::Mask { cutoff: 0.3 }, Some(0)), material("", AlphaMode::Blend, None)],
        textures: vec![texture],
        lines: vec![[0, 3], [1, 3]],
        ..folded_plate()
    };
    let wire = Model { faces: Vec::new(), face_material: Vec::new(), lines: vec![[3, 2]], ..folded_plate() };
    let mirrored = DMat3::from_diagonal(dvec3(-2.0, 1.0, 1.0));
    let objects = vec![
        Object { name: "here".into(), mesh: 0, world_from_mesh: DAffine3::IDENTITY },
        Object {
            name: "there".into(),
            mesh: 1,
            world_from_mesh: DAffine3 { matrix3: mirrored, translation: dvec3(8.0, 0.5, -4.0) },
        },
    ];
    let again = loaded(&glb(&[model.clone(), wire.clone()], &objects, &EDGES).expect("good models"));
    assert_eq!(again.objects, objects);
    let found = &again.meshes[0];
    assert_eq!(found.materials, model.materials);
    let [texture, expected] = [&found.textures[0], &model.textures[0]];
    assert_eq!((&texture.rgba8, texture.wrap, texture.smooth), (&expected.rgba8, expected.wrap, expected.smooth));
    let ends =
        |model: &Model| -> Vec<_> { model.lines.iter().map(|l| l.map(|v| model.positions[v as usize])).collect() };
    assert_eq!(ends(found), ends(&model));
    assert_eq!((ends(&again.meshes[1]), again.meshes[1].faces.len()), (ends(&wire), 0));
    assert_eq!(corners(found, 0), corners(&model, 1));
}

#[test]
fn what_cannot_be_written_is_an_error() {
    let nan = Model { positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(0.0, f32::NAN, 0.0), Vec3::Z], ..folded_plate() };
    let fails = |meshes: &[Model], objects: &[Object]| glb(meshes, objects, &EDGES).expect_err("it is wrong");
    assert!(matches!(fails(&[nan], &once()), ExportError::NotFinite { mesh: 0, what: "a position" }));
    assert!(matches!(fails(&[], &once()), ExportError::Mesh { object: 0, mesh: 0, meshes: 0 }));
    let far = Object { world_from_mesh: DAffine3::from_translation(DVec3::INFINITY), ..once()[0].clone() };
    assert!(matches!(fails(&[folded_plate()], &[far]), ExportError::NotFinite { .. }));
    let texture = Texture {
        name: "short".into(),
        width: 2,
        height: 2,
        rgba8: vec![0; 4].into(),
        wrap: [Wrap::Repeat; 2],
        smooth: true,
    };
    let short = Model { textures: vec![texture], ..folded_plate() };
    let error = fails(&[short], &once());
    assert!(matches!(&error, ExportError::Texture { name, .. } if name == "short"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// Any classes at all survive, with one material or several.
    #[test]
    fn random_classes_are_loaded_as_they_were_written(
        bits in prop::collection::vec(0usize..4, 3 * 160),
        materials in prop::collection::vec(0u32..3, 160),
        several in any::<bool>(),
    ) {
        let mut model = embedded::sphere(8);
        let faces = model.faces.len();
        prop_assume!(faces <= 160);
        let class = |bits: usize| [Hidden, Silhouette, Hard, RepeatedHard][bits];
        model.face_polygon.clear();
        model.side_visibility = (0..faces).map(|face| [0, 1, 2].map(|side| class(bits[3 * face + side]))).collect();
        if several {
            model.face_material = materials[..faces].to_vec();
            model.materials = vec![Material::default(); 3];
        }
        let again = loaded(&written(&model, &EDGES)).into_model();
        let expected: Vec<_> = order(&model).into_iter().map(|face| model.side_visibility[face]).collect();
        prop_assert_eq!(again.side_visibility, expected);
    }
}
