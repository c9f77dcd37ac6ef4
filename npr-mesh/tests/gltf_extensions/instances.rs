//! `EXT_mesh_gpu_instancing`, and transforms in f64.

use crate::doc::{Doc, PRIMITIVE};
use crate::{assert_fails, load_with, loaded, warnings};
use glam::{DAffine3, DQuat, DVec3, Vec3, dvec3};
use npr_mesh::{Limits, LoadError};
use serde_json::{Value, json};
use std::f64::consts::FRAC_PI_2;

/// A square whose node has instances with these attributes.
fn instanced(doc: Doc, attributes: Value) -> Doc {
    doc.set(
        "/nodes/0",
        json!({"mesh": 0, "name": "tree", "extensions": {"EXT_mesh_gpu_instancing": {"attributes": attributes}}}),
    )
    .set("/extensionsUsed", json!(["EXT_mesh_gpu_instancing"]))
    .set("/extensionsRequired", json!(["EXT_mesh_gpu_instancing"]))
}

fn assert_near(found: &DAffine3, expected: &DAffine3) {
    let (a, b) = (found.to_cols_array(), expected.to_cols_array());
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}\nexpected {expected:?}");
}

#[test]
fn instances_are_placed_within_their_node() {
    let mut doc = Doc::square();
    let translation = doc.floats("VEC3", &[1., 0., 0., 0., 2., 0., 0., 0., 3.]);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let rotation = doc.floats("VEC4", &[0., 0., 0., 2., 0., 0., half, half, half, 0., 0., half]);
    let scale = doc.floats("VEC3", &[1., 1., 1., 2., 3., 4., -1., 1., 1.]);
    let ids = doc.floats("SCALAR", &[7., 8., 9.]);
    let attributes = json!({"TRANSLATION": translation, "ROTATION": rotation, "SCALE": scale, "_ID": ids});
    let doc = instanced(doc, attributes)
        .set("/nodes/0/translation", json!([10, 0, 0]))
        .set("/nodes/0/scale", json!([2, 2, 2]));
    let file = loaded(&doc);
    assert!(file.warnings.is_empty(), "{:?}", file.warnings);
    assert_eq!((file.meshes.len(), file.objects.len()), (1, 3));
    assert!(file.objects.iter().all(|object| object.name == "tree" && object.mesh == 0));
    let node = DAffine3::from_translation(dvec3(10., 0., 0.)) * DAffine3::from_scale(DVec3::splat(2.0));
    let expected = [
        DAffine3::from_translation(DVec3::X),
        DAffine3::from_translation(2.0 * DVec3::Y)
            * DAffine3::from_quat(DQuat::from_rotation_z(FRAC_PI_2))
            * DAffine3::from_scale(dvec3(2., 3., 4.)),
        DAffine3::from_translation(3.0 * DVec3::Z)
            * DAffine3::from_quat(DQuat::from_rotation_x(FRAC_PI_2))
            * DAffine3::from_scale(dvec3(-1., 1., 1.)),
    ];
    for (object, expected) in file.objects.iter().zip(expected) {
        assert_near(&object.world_from_mesh, &(node * expected));
    }
    assert_eq!(file.into_model().faces.len(), 6);
}

#[test]
fn rotations_may_be_normalised_integers() {
    for (component, one, bytes) in [(5120, 127u16, 1), (5122, 32767, 2)] {
        let mut doc = Doc::square();
        let values: Vec<u8> =
            [0, 0, 0, one, one, 0, 0, 0].iter().flat_map(|v: &u16| v.to_le_bytes()[..bytes].to_vec()).collect();
        let rotation =
            doc.add(&values, json!({"componentType": component, "normalized": true, "type": "VEC4", "count": 2}));
        let file = loaded(&instanced(doc.clone(), json!({"ROTATION": rotation})));
        assert_near(&file.objects[0].world_from_mesh, &DAffine3::IDENTITY);
        let half_turn = DAffine3::from_scale(dvec3(1., -1., -1.));
        assert_near(&file.objects[1].world_from_mesh, &half_turn);
        let unnormalised = doc.set(&format!("/accessors/{rotation}/normalized"), json!(false));
        assert_fails(&instanced(unnormalised, json!({"ROTATION": rotation})), "integers are not allowed here");
    }
}

#[test]
fn wrong_instances_are_errors() {
    let mut doc = Doc::square();
    let three = doc.floats("VEC3", &[0.; 9]);
    let two = doc.floats("VEC3", &[1.; 6]);
    let zeros = doc.floats("VEC4", &[0.; 12]);
    let nan = doc.floats("VEC3", &[f32::NAN; 3]);
    let shorts = doc.add(&[0; 24], json!({"componentType": 5122, "type": "VEC3", "count": 3}));
    let extension = "node 0: EXT_mesh_gpu_instancing: ";
    for (attributes, fault) in [
        (json!({"TRANSLATION": three, "SCALE": two}), "2 elements of SCALE, 3 of TRANSLATION".to_owned()),
        (json!({"_ID": two, "TRANSLATION": three}), "3 elements of TRANSLATION, 2 of _ID".to_owned()),
        (json!({"ROTATION": zeros}), format!("{extension}the rotation of instance 0 has no length")),
        (json!({"TRANSLATION": zeros}), "TRANSLATION: accessor 6: 4 numbers in an element, expected 3".to_owned()),
        (json!({"TRANSLATION": shorts}), "signed 16-bit integers are not allowed here".to_owned()),
        (json!({"TRANSLATION": 99}), "node 0: TRANSLATION: accessor 99 does not exist".to_owned()),
        (
            json!({"TRANSLATION": nan}),
            "node 0: in world space the position of its mesh's vertex 0 is not finite".to_owned(),
        ),
        (json!({}), format!("{extension}no attribute")),
    ] {
        assert_fails(&instanced(doc.clone(), attributes), &fault);
    }
    let none = doc.add(&[], json!({"componentType": 5126, "type": "VEC3", "count": 0}));
    assert_fails(&instanced(doc, json!({"TRANSLATION": none})), "no triangle in it");
}

#[test]
fn limits_count_instances() {
    let mut doc = Doc::square();
    // No data: as many instances as one likes, all in one place.
    let many = json!({"componentType": 5126, "type": "VEC3", "count": 4_000_000_000u32});
    doc.json["accessors"].as_array_mut().expect("accessors").push(many);
    let doc = instanced(doc, json!({"TRANSLATION": 4}));
    assert_fails(&doc, "4000000000 primitives, more than the limit of 1000000");
    let with = |count: u32, limits: Limits| load_with(&doc.clone().set("/accessors/4/count", json!(count)), limits);
    let limits = Limits { instances: 5, vertices: 20, faces: 10, ..Limits::default() };
    assert_eq!(with(5, limits).expect("as many as allowed").objects.len(), 5);
    for (limits, what) in [
        (Limits { instances: 4, ..limits }, "primitives"),
        (Limits { vertices: 19, ..limits }, "vertices"),
        (Limits { faces: 9, ..limits }, "faces"),
    ] {
        let error = with(5, limits).expect_err(what);
        assert!(matches!(error, LoadError::TooLarge { what: found, .. } if found == what), "{error}");
    }
}

#[test]
fn a_skinned_mesh_has_no_instances() {
    let mut doc = Doc::square();
    let joints = doc.add(&[0; 16], json!({"componentType": 5121, "type": "VEC4", "count": 4}));
    let weights = doc.floats("VEC4", &[1., 0., 0., 0.].repeat(4));
    let two = doc.floats("VEC3", &[1.; 6]);
    let doc = instanced(doc, json!({"TRANSLATION": two}))
        .set(&format!("{PRIMITIVE}/attributes/JOINTS_0"), json!(joints))
        .set(&format!("{PRIMITIVE}/attributes/WEIGHTS_0"), json!(weights))
        .set("/skins", json!([{"joints": [0]}]))
        .set("/nodes/0/skin", json!(0));
    let file = loaded(&doc);
    assert_eq!(file.objects.len(), 1);
    assert_eq!(warnings(&file), ["node 0: EXT_mesh_gpu_instancing is ignored, since its mesh has a skin"]);
}

/// A city of squares at UTM coordinates by its nodes, and the same at the origin.
#[test]
fn transforms_are_composed_in_the_precision_of_the_file() {
    let origin = dvec3(500_000.123, 0.0, 5_400_000.456);
    let city = |origin: DVec3| {
        let house = |number: u32| json!({"mesh": 0, "translation": [0.1 * f64::from(number), 0.7, 0.3], "rotation": [0, 0.6, 0, 0.8], "scale": [0.1, 0.1, 0.1]});
        let mut nodes: Vec<Value> = (0..10).map(house).collect();
        nodes.push(json!({"children": (0..10).collect::<Vec<_>>(), "translation": origin.to_array()}));
        let to_left = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., -500_000.123, 0., 0., 1.];
        nodes.push(json!({"children": [10], "matrix": to_left}));
        loaded(&Doc::square().set("/nodes", Value::Array(nodes)).set("/scenes/0/nodes", json!([11])))
    };
    let (far, near) = (city(origin), city(dvec3(500_000.123, 0.0, 0.0)));
    assert_eq!(far.objects.len(), 10);
    for (far, near) in far.objects.iter().zip(&near.objects) {
        let moved = far.world_from_mesh.translation - dvec3(0.0, 0.0, 5_400_000.456);
        assert!(moved.distance(near.world_from_mesh.translation) < 2e-9, "{moved}");
        assert_eq!(far.world_from_mesh.matrix3, near.world_from_mesh.matrix3);
    }
    // 0.1 is not the nearest f32.
    let near = city(dvec3(500_000.123, 0.0, 0.0));
    assert!((near.objects[1].world_from_mesh.translation.x - 0.1).abs() < 1e-9);
}

/// A skin places its vertices in world space, which is f32 within the mesh but not for the object.
#[test]
fn a_skinned_mesh_far_away_keeps_its_digits() {
    let skinned = |origin: DVec3| {
        let mut doc = Doc::square();
        let joints = doc.add(&[0; 16], json!({"componentType": 5121, "type": "VEC4", "count": 4}));
        let weights = doc.floats("VEC4", &[1., 0., 0., 0.].repeat(4));
        let translation = (origin + dvec3(0.25, 0.0, 0.0)).to_array();
        let doc = doc
            .set("/accessors/0/min", json!([0, 0, 0]))
            .set("/accessors/0/max", json!([1, 1, 0]))
            .set(&format!("{PRIMITIVE}/attributes/JOINTS_0"), json!(joints))
            .set(&format!("{PRIMITIVE}/attributes/WEIGHTS_0"), json!(weights))
            .set("/skins", json!([{"joints": [1]}]))
            .set("/nodes", json!([{"mesh": 0, "skin": 0}, {"translation": translation, "scale": [0.1, 0.1, 0.1]}]));
        loaded(&doc)
    };
    let corners = |origin: DVec3| {
        let file = skinned(origin);
        let world = file.objects[0].world_from_mesh;
        let corner = |position: &Vec3| world.transform_point3(position.as_dvec3()) - origin;
        (world.translation, file.meshes[0].positions.iter().map(corner).collect::<Vec<_>>())
    };
    let (near, expected) = corners(DVec3::ZERO);
    assert_eq!((near, expected[2].as_vec3()), (DVec3::ZERO, Vec3::new(0.35, 0.1, 0.0)));
    let (far, found) = corners(dvec3(500_000.123, 7.0, 5_400_000.456));
    assert!(far.x > 499_999.0);
    assert!(found.iter().zip(&expected).all(|(a, b)| a.distance(*b) < 1e-7), "{found:?}");
}
