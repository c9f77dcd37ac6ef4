//! What is done with any bytes, by the fuzz targets and by the test of the stored corpus.
//!
//! Each function takes bytes as a file's and goes all the way that a command would go with the file: an error is a
//! good end, a panic is none, and neither is a number that is not finite.

use npr_harness::camera::{Camera, Framing};
use npr_harness::capabilities::Capabilities;
use npr_harness::cpu::{self, CpuOptions};
use npr_harness::hatch::HatchSource;
use npr_harness::plan::Plan;
use npr_harness::scene::Scene;
use npr_harness::shade::Shade;
use npr_harness::style::{Style, styles};
use npr_harness::view::View;
use npr_hatch::{sheet, store};
use npr_mesh::export::ExportOptions;
use npr_mesh::{Loaded, Model, embedded};
use std::path::{Path, PathBuf};

/// Larger models are loaded and looked at, but not drawn.
const MOST_FACES: usize = 2_000;
/// Px.
const SIZE: (u32, u32) = (24, 16);

/// As a model's `.obj`.
pub fn obj(bytes: &[u8]) {
    model(bytes, "obj");
}

/// As a model's `.glb`, or `.gltf` where they do not begin like one.
pub fn gltf(bytes: &[u8]) {
    model(bytes, if bytes.starts_with(b"glTF") { "glb" } else { "gltf" });
}

/// As a model's `.ply`.
pub fn ply(bytes: &[u8]) {
    model(bytes, "ply");
}

/// As a model's `.stl`.
pub fn stl(bytes: &[u8]) {
    model(bytes, "stl");
}

/// As a material file of two materials, `a` and `b`, whose textures are all there.
pub fn mtl(bytes: &[u8]) {
    const OBJ: &str = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
                       usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 3/3 4/4\n";
    // Two texels each: red and half transparent green; white and black.
    const COLORED: &[u8] = b"\0\0\x02\0\0\0\0\0\0\0\0\0\x02\0\x01\0\x20\x08\0\0\xff\xff\0\xff\0\x80";
    const GRAY: &[u8] = b"\0\0\x03\0\0\0\0\0\0\0\0\0\x02\0\x01\0\x08\0\xff\0";
    let resolver = |name: &str| match name {
        "m.mtl" => Ok(bytes.to_vec()),
        name if name.len().is_multiple_of(2) => Ok(COLORED.to_vec()),
        _ => Ok(GRAY.to_vec()),
    };
    if let Ok(loaded) = npr_mesh::load_bytes("m.obj", OBJ.into(), &resolver, &Default::default()) {
        check(loaded, bytes);
    }
}

/// As a model in memory and the files that it refers to: the first byte tells the format, and each name that is asked
/// for a part of the bytes.
pub fn memory(bytes: &[u8]) {
    let Some((&format, bytes)) = bytes.split_first() else { return };
    let resolver = |name: &str| {
        assert!(
            !name.is_empty() && name.split('/').all(|part| !["", ".", ".."].contains(&part)) && !name.contains('\\'),
            "{name:?} is asked for"
        );
        let from = name.bytes().fold(0usize, |sum, byte| sum.wrapping_mul(7).wrapping_add(byte.into()));
        match from % 5 {
            0 => Err(std::io::ErrorKind::NotFound.into()),
            1 => Err(std::io::Error::other("broken")),
            _ => Ok(bytes[from % (bytes.len() + 1)..].to_vec()),
        }
    };
    let name = ["obj", "a.gltf", "sub/a.glb", "a.ply", "a.STL", "none"][usize::from(format) % 6];
    match npr_mesh::load_bytes(name, bytes.to_vec(), &resolver, &Default::default()) {
        Ok(loaded) => check(loaded, bytes),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

fn model(bytes: &[u8], ending: &str) {
    let folder = folder();
    let path = folder.join(format!("model.{ending}"));
    std::fs::write(&path, bytes).expect("there is space");
    let loaded = npr_mesh::load(&path, &Default::default());
    std::fs::remove_file(&path).expect("it was there");
    let _ = std::fs::remove_dir(&folder);
    if let Ok(loaded) = loaded {
        check(loaded, bytes);
    }
}

/// Checks what was loaded from some bytes, and draws it.
fn check(loaded: Loaded, bytes: &[u8]) {
    loaded.meshes.iter().for_each(sound);
    let options = ExportOptions { edges: Some(0.8) };
    npr_mesh::export::glb(&loaded.meshes, &loaded.objects, &options).expect("what was read can be written");
    let (local, origin) = loaded.clone().into_model_near();
    assert!(origin.is_finite() && local.positions.iter().all(|position| position.is_finite()), "the local model");
    assert!(
        !loaded.objects.is_empty() && loaded.objects.iter().all(|object| object.mesh < loaded.meshes.len()),
        "objects"
    );
    let faces: usize = loaded.objects.iter().map(|object| loaded.meshes[object.mesh].faces.len()).sum();
    if faces > MOST_FACES {
        return;
    }
    let all = styles();
    // Which style, and from where, is up to the bytes, so that the same bytes do the same.
    let sum = bytes.iter().fold(0usize, |sum, &byte| sum.wrapping_mul(31).wrapping_add(byte.into()));
    let style = &all[sum % all.len()];
    if !is_quick(style) {
        return;
    }
    draw(&Scene::from(loaded), style, sum);
}

/// What everything after a loader relies on.
fn sound(model: &Model) {
    let vertices = model.positions.len();
    assert!(!model.faces.is_empty() || !model.lines.is_empty(), "a model without faces and lines");
    assert!(model.lines.iter().flatten().all(|&vertex| (vertex as usize) < vertices), "indices of lines");
    let sides = model.side_visibility.len();
    assert!(sides == 0 || sides == model.faces.len(), "sides");
    assert!(model.positions.iter().all(|p| p.is_finite()), "positions");
    assert!(model.normals.len() == vertices, "{} normals of {vertices} vertices", model.normals.len());
    assert!(model.normals.iter().all(|n| n.is_normalized()), "normals");
    assert!(model.uvs.is_empty() || model.uvs.len() == vertices, "coordinates");
    assert!(model.uvs.iter().all(|uv| uv.is_finite()), "coordinates");
    assert!(model.colors.is_empty() || model.colors.len() == vertices, "colours");
    assert!(model.colors.iter().all(|color| color.is_finite()), "colours");
    assert!(model.faces.iter().flatten().all(|&vertex| (vertex as usize) < vertices), "indices");
    assert!(model.face_material.len() == model.faces.len(), "materials of faces");
    assert!(model.face_material.iter().all(|&number| (number as usize) < model.materials.len()), "materials");
    for of_faces in [&model.face_mesh, &model.face_polygon] {
        assert!(of_faces.is_empty() || of_faces.len() == model.faces.len(), "meshes or polygons of faces");
    }
    assert!(model.face_polygon.is_sorted(), "polygons");
    for material in &model.materials {
        assert!(material.base_color.is_finite(), "a material's colour");
        assert!(material.emissive.is_finite() && material.emissive.min_element() >= 0.0, "a material's emission");
        for texture in [material.texture, material.emissive_texture].into_iter().flatten() {
            assert!((texture as usize) < model.textures.len(), "a texture");
        }
    }
    for texture in &model.textures {
        let texels = texture.width as usize * texture.height as usize;
        assert!(texels > 0 && texture.rgba8.len() == 4 * texels, "a texture's texels");
    }
}

/// As a style's file, drawn on a small model.
pub fn style(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let path = Path::new("/there/is/no/such/folder/style.toml");
    let Ok(style) = Style::from_toml(text, path) else { return };
    let again = style.to_toml().expect("what was read can be written");
    let again = Style::from_toml(&again, path).unwrap_or_else(|error| panic!("{error}:\n{again}"));
    assert!(again == style, "{again:?}\nis not\n{style:?}");
    if is_quick(&style) {
        draw(&Scene::new(embedded::cube()), &style, bytes.len());
    }
}

/// Whether it draws no map, or a small one.
fn is_quick(style: &Style) -> bool {
    let Shade::Hatch(hatch) = &style.shade else { return true };
    match hatch.map.source() {
        HatchSource::Parameters(parameters) => parameters.side <= 32 && parameters.tones.len() <= 8,
        _ => false,
    }
}

/// As a file with a tonal art map; also with the checksum put right, which no mutation would hit.
pub fn tam(bytes: &[u8]) {
    one_tam(bytes);
    if let Some((content, _)) = bytes.split_last_chunk::<8>() {
        let sum = content
            .iter()
            .fold(0xcbf2_9ce4_8422_2325, |sum: u64, &byte| (sum ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3));
        one_tam(&[content, &sum.to_le_bytes()].concat());
    }
}

fn one_tam(bytes: &[u8]) {
    let Ok(stored) = store::from_bytes(bytes) else { return };
    let again = store::to_bytes(&stored.tam, stored.thresholds.as_ref()).expect("what was read can be written");
    assert!(store::from_bytes(&again).is_ok_and(|again| again == stored), "it is not what was read");
    let _ = (sheet::contact(&stored.tam), sheet::tiled(&stored.tam), stored.thresholds.as_ref().map(sheet::ramp));
    let _ = stored.tam.pack_tones(0);
}

fn draw(scene: &Scene, style: &Style, number: usize) {
    let fov_y_rad = if number.is_multiple_of(3) { None } else { Some(0.6) };
    let framing = Framing { fov_y_rad, yaw_rad: number as f64 % 6.0, ..Framing::default() };
    let camera = Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &framing);
    let Ok(plan) = Plan::new(scene, style, &View::new(camera, SIZE), &Capabilities::RAY_CASTER) else { return };
    let options = CpuOptions { threads: 1, ..CpuOptions::default() };
    let frame = cpu::render(scene, &plan, &options, &|_| {});
    assert!(frame.color.iter().all(|color| color.is_finite()), "a colour that is not finite");
    assert!(frame.depth.iter().all(|depth| depth.is_finite()), "a depth that is not finite");
}

/// In memory, where there is such a place; one for each process.
fn folder() -> PathBuf {
    let memory = Path::new("/dev/shm");
    let place = if memory.is_dir() { memory.to_owned() } else { std::env::temp_dir() };
    let folder = place.join(format!("npr-fuzz-{}-{:?}", std::process::id(), std::thread::current().id()));
    std::fs::create_dir_all(&folder).expect("a folder can be made");
    folder
}
