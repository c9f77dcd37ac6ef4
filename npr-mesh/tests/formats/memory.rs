//! Models in memory, and the files that they refer to.

use crate::{load_alone, load_with, warnings};
use image::{ImageFormat, Rgb, RgbImage};
use npr_mesh::{Limits, LoadError, LoadOptions, load, load_bytes};
use std::cell::RefCell;
use std::io::{self, Cursor};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n";

fn png() -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    RgbImage::from_pixel(1, 1, Rgb([1, 2, 3])).write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

#[test]
fn formats_by_name_and_by_extension() {
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for name in ["obj", "OBJ", ".obj", "a.Obj", "some/folder/a.obj", "a.stl.obj"] {
        assert_eq!(load_alone(name, obj).expect("it loads").meshes[0].faces.len(), 1, "{name}");
    }
    for name in ["", "a", "a.fbx", "obj.zip", "/"] {
        let error = load_alone(name, obj).unwrap_err();
        assert!(matches!(error, LoadError::UnknownFormat { .. }), "{name}: {error}");
        assert!([".obj", ".gltf", ".glb", ".ply", ".stl"].iter().all(|e| error.to_string().contains(e)), "{error}");
    }
}

#[test]
fn the_resolver_is_asked_for_names_relative_to_the_model() {
    let asked = RefCell::new(Vec::new());
    let resolver = |name: &str| {
        asked.borrow_mut().push(name.to_owned());
        match name {
            "sub/m.mtl" => Ok(b"newmtl a\nmap_Kd .\\art\\..\\t.png\n".to_vec()),
            "t.png" => Ok(png()),
            _ => Err(io::ErrorKind::NotFound.into()),
        }
    };
    let obj = format!("mtllib ./sub\\x/..\\m.mtl\n{TRIANGLE}");
    let loaded = load_bytes("archive/a.obj", obj.into(), &resolver, &LoadOptions::default()).expect("it loads");
    assert_eq!((warnings(&loaded), loaded.meshes[0].textures.len()), (vec![], 1));
    assert_eq!(*asked.borrow(), ["sub/m.mtl", "sub/t.png", "t.png"]);
}

#[test]
fn names_that_lead_outside_are_never_asked_for() {
    let resolver = |name: &str| match name {
        "m.mtl" => {
            Ok(b"newmtl a\nmap_Kd ../t.png\nnewmtl b\nmap_Kd sub/../../t.png\nnewmtl c\nmap_Kd ..\\t.png\n".to_vec())
        }
        other => panic!("{other} is asked for"),
    };
    let obj = format!("mtllib m.mtl\nmtllib ../m.mtl\n{TRIANGLE}usemtl b\nf 1/1 2/1 3/1\nusemtl c\nf 1/1 2/1 3/1\n");
    let loaded = load_bytes("a.obj", obj.into(), &resolver, &LoadOptions::default()).expect("it loads");
    let outside = warnings(&loaded).iter().filter(|line| line.contains("leads out of the model's folder")).count();
    assert_eq!(outside, 4, "{:?}", warnings(&loaded));
    // Of an absolute name, the last part alone is asked for, as on a disk.
    let absolute =
        load_with("a.obj", format!("mtllib C:\\x\\m.mtl\n{TRIANGLE}"), &[("m.mtl", b"newmtl a\nKd 1 0 0\n".to_vec())]);
    assert_eq!(absolute.expect("it loads").meshes[0].materials[0].base_color.x, 1.0);
}

#[test]
fn buffers_and_images_of_gltf_come_from_the_resolver() {
    let positions: Vec<u8> = [0f32, 0., 0., 1., 0., 0., 0., 1., 0.].iter().flat_map(|x| x.to_le_bytes()).collect();
    let gltf = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}], "images": [{"uri": "art/a%20b.png"}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": "my%20data.bin"}]}"#;
    let files = [("my data.bin", positions.clone()), ("art/a b.png", png())];
    let loaded = load_with("scene.gltf", gltf, &files).expect("it loads");
    assert_eq!((loaded.meshes[0].faces.len(), loaded.meshes[0].textures.len()), (1, 1));
    let error = load_with("scene.gltf", gltf, &files[1..]).unwrap_err();
    assert!(error.to_string().starts_with("scene.gltf: ") && error.to_string().contains("my data.bin"), "{error}");
    let error = load_with("scene.gltf", gltf.replace("my%20data", "%2e%2e/data"), &files).unwrap_err();
    assert!(error.to_string().contains("leads out"), "{error}");
}

#[test]
fn errors_of_the_resolver_are_told() {
    let resolver = |_: &str| Err(io::Error::other("the archive is broken"));
    let obj = format!("mtllib m.mtl\n{TRIANGLE}");
    let loaded = load_bytes("a.obj", obj.into(), &resolver, &LoadOptions::default()).expect("it loads");
    assert!(
        warnings(&loaded).iter().any(|line| line.contains("m.mtl: the archive is broken")),
        "{:?}",
        warnings(&loaded)
    );
}

#[test]
fn limits_hold_in_memory() {
    let options =
        |file_bytes| LoadOptions { limits: Limits { file_bytes, ..Limits::default() }, ..LoadOptions::default() };
    let obj = format!("mtllib m.mtl\n{TRIANGLE}");
    let length = obj.len() as u64;
    let resolver = |_: &str| Ok(vec![b' '; 1000]);
    let load = |most| load_bytes("a.obj", obj.clone().into(), &resolver, &options(most));
    assert!(matches!(load(length - 1), Err(LoadError::TooLarge { count, .. }) if count == length));
    assert!(matches!(load(999), Err(LoadError::TooLarge { count: 1000, limit: 999, .. })));
    assert!(load(1000).is_ok());
}

#[test]
fn a_model_in_memory_is_that_on_the_disk() {
    let folder = crate::folder::Folder::new();
    let files = [("m.mtl", b"newmtl a\nmap_Kd -s 2 2 art/t.png\n".to_vec()), ("art/t.png", png())];
    for (name, bytes) in &files {
        folder.write(name, bytes);
    }
    let obj = format!("mtllib m.mtl\n{TRIANGLE}l 1 2\n");
    let path = folder.write("a.obj", &obj);
    let on_disk = load(&path, &LoadOptions::default()).expect("it loads");
    assert_eq!(load_with("a.obj", obj, &files).expect("it loads"), on_disk);
}
