//! OBJ files: valid files, and rejected files with clear messages.
#![cfg(feature = "obj")]
#![allow(clippy::print_stdout)] // A test that is skipped says so.

use glam::{Vec2, Vec3};
use npr_mesh::{AlphaMode, Limits, LoadError, LoadOptions, Loaded, Object, Wrap, load};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// A temporary folder, which is removed when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("npr-mesh-obj-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        fs::write(&path, bytes).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn try_text(text: impl AsRef<[u8]>) -> Result<Loaded, LoadError> {
    let folder = Folder::new();
    load(&folder.write("model.obj", text), &LoadOptions::default())
}

fn text(text: impl AsRef<[u8]>) -> Loaded {
    let loaded = try_text(text).unwrap();
    let m = &loaded.meshes[0];
    let n = m.positions.len();
    assert_eq!(m.normals.len(), n);
    assert!(m.uvs.is_empty() || m.uvs.len() == n);
    assert!(m.colors.is_empty() || m.colors.len() == n);
    assert_eq!(m.face_material.len(), m.faces.len());
    assert!(m.face_polygon.is_empty() || m.face_polygon.len() == m.faces.len());
    assert!(m.face_polygon.is_sorted());
    assert!(m.faces.iter().flatten().all(|&v| (v as usize) < n));
    assert!(m.face_material.iter().all(|&f| (f as usize) < m.materials.len()));
    loaded
}

fn png() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbaImage::from_pixel(2, 2, image::Rgba([1, 2, 3, 255]))
        .write_to(&mut bytes, image::ImageFormat::Png)
        .unwrap();
    bytes.into_inner()
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

#[test]
fn a_triangle_and_all_ways_to_write_a_corner() {
    let arrays = format!("{TRIANGLE}vt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\n");
    for face in
        ["1 2 3", "1/1 2/2 3/3", "1//1 2//2 3//3", "1/1/1 2/2/2 3/3/3", "-3/-3/-3 -2/-2/-2 -1/-1/-1", "1/ 2/ 3/"]
    {
        let m = text(format!("{arrays}f {face}\n")).into_model();
        assert_eq!(m.faces, [[0, 1, 2]]);
        assert_eq!(m.normals, [Vec3::Z; 3], "{face}");
        assert!(m.face_polygon.is_empty());
        assert_eq!(m.materials, [Default::default()]);
        if face.starts_with("1/1") || face.starts_with('-') {
            assert_eq!(m.uvs, [Vec2::new(0.0, 1.0), Vec2::new(1.0, 1.0), Vec2::new(0.0, 0.0)]);
        }
    }
}

#[test]
fn comments_continued_lines_line_ends_and_byte_order_marks_do_no_harm() {
    let plain = text(format!("{TRIANGLE}f 1 2 3\n")).into_model();
    for same in [
        format!("# a\n####\n{TRIANGLE}f 1 2 3 # behind\n"),
        format!("\u{feff}{TRIANGLE}f 1 2 3"),
        format!("{TRIANGLE}f 1 \\\n 2 \\\r\n 3\n"),
        format!("{TRIANGLE}f 1 2 3\n").replace('\n', "\r\n"),
        format!("{TRIANGLE}f 1 2 3\n").replace('\n', "\r"),
        format!("\t{TRIANGLE}   f\t1\t2  3 \n"),
        format!("{TRIANGLE}g\no \ns off\nusemtl\nmtllib\nvp 1 2\nf 1 2 3\np 1 2 3\np 1\ncstype bezier\n"),
    ] {
        assert_eq!(text(&same).into_model(), plain, "{same:?}");
    }
    let latin1 = [b"# caf\xe9\ng \xff\n", format!("{TRIANGLE}f 1 2 3\n").as_bytes()].concat();
    assert_eq!(text(latin1).into_model(), plain);
}

#[test]
fn polygons_count_n_minus_2_faces_and_are_numbered() {
    let m =
        text("v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 3 1 0\nf 2 5 3\nf 1 2 3 4\nf 1 2 5 3 4\nf 1 1 1\n").into_model();
    assert_eq!(m.faces.len(), 1 + 2 + 3 + 1);
    assert_eq!(m.face_polygon, [0, 1, 1, 2, 2, 2, 3]);
    // Polygons are numbered from the first face on, also across materials.
    let m = text(format!("{TRIANGLE}v 1 1 0\nf 1 2 3\nusemtl a\nf 2 4 3\nf 1 2 4 3\nusemtl b\nf 1 2 3\n")).into_model();
    assert_eq!(m.face_polygon, [0, 1, 2, 2, 3]);
}

#[test]
fn faces_of_two_corners_are_left_out_with_a_warning() {
    let loaded = text(format!("{TRIANGLE}f 1 2\nf 1\nf\nf 1 2 3\n"));
    assert_eq!(loaded.meshes[0].faces.len(), 1);
    assert!(loaded.warnings.iter().any(|w| w.text.starts_with("3 faces")), "{:?}", loaded.warnings);
}

#[test]
fn materials_that_no_file_defines_are_one_warning() {
    let warning = |count: usize| {
        let uses = (0..count).map(|number| format!("usemtl m{number}\nf 1 2 3\n")).collect::<String>();
        let mut warnings = text(format!("{TRIANGLE}{uses}")).warnings;
        warnings.retain(|warning| warning.text.contains("material"));
        warnings.into_iter().map(|warning| warning.to_string()).collect::<Vec<_>>()
    };
    assert_eq!(warning(1), ["no material file defines \"m0\": the default material stands for it"]);
    let several = |listed: &str| format!("no material file defines {listed}: the default material stands for them");
    assert_eq!(warning(3), [several("\"m0\", \"m1\" and \"m2\" (3 materials)")]);
    assert_eq!(warning(9), [several("\"m0\", \"m1\", \"m2\" and 6 more (9 materials)")]);
}

#[test]
fn an_absent_normal_or_texture_coordinate_is_not_the_one_before() {
    let m = text(format!("{TRIANGLE}v 0 0 1\nvt 0.5 0.25\nvn 1 0 0\nf 1/1/1 2/1/1 3/1/1\nf 1//1 2 4/1\nf 1/0/0 2 3\n"))
        .into_model();
    let corner = |face: usize, k: usize| m.faces[face][k] as usize;
    assert_eq!(m.normals[corner(0, 0)], Vec3::X);
    assert_eq!(m.uvs[corner(0, 0)], Vec2::new(0.5, 0.75));
    assert_eq!(m.normals[corner(1, 0)], Vec3::X);
    assert_eq!(m.uvs[corner(1, 0)], Vec2::ZERO);
    assert_ne!(m.normals[corner(1, 1)], Vec3::X);
    assert_eq!(m.uvs[corner(1, 2)], Vec2::new(0.5, 0.75));
    assert_ne!(m.normals[corner(2, 0)], Vec3::X);
}

#[test]
fn vertex_colours_become_linear_and_vertices_without_are_white() {
    let m = text("v 0 0 0 1 0.5 0\nv 1 0 0\nv 0 1 0 0 0 0\nf 1 2 3\n").into_model();
    assert!((m.colors[0].y - 0.214_041).abs() < 1e-5);
    assert_eq!(m.colors[1].to_array(), [1.0; 4]);
    assert_eq!(m.colors[2].to_array(), [0.0, 0.0, 0.0, 1.0]);
    let bytes = text("v 0 0 0 255 0 0\nv 1 0 0 0 255 0\nv 0 1 0 0 0 255\nf 1 2 3\n");
    assert_eq!(bytes.meshes[0].colors[0].to_array(), [1.0, 0.0, 0.0, 1.0]);
    assert!(
        bytes.warnings.iter().any(|w| w.text == "vertex colours above 1 are taken as 0..=255"),
        "{:?}",
        bytes.warnings
    );
    assert!(matches!(try_text("v 0 0 0 x y z\nf 1 1 1\n"), Err(LoadError::Malformed { .. })));
}

#[test]
fn materials_colours_alpha_and_textures() {
    let folder = Folder::new();
    fs::create_dir(folder.0.join("maps")).unwrap();
    folder.write("maps/a b.png", png());
    folder.write("maps/c.png", png());
    folder.write(
        "m.mtl",
        "Kd 1 1 1\nnewmtl one\nKd 1 0.5 0\nd 0.25\nmap_Kd maps/a b.png\n\n\
         newmtl two\r\nTr 0.5\r\nmap_Kd -s 1 1 1 -clamp on maps\\c.png\r\n\
         newmtl three\nKd spectral x.rfl\nKd 0.5\nmap_Kd nowhere.png\nmap_d x.png\nillum x\nNs\n",
    );
    let path = folder.write(
        "m.obj",
        format!(
            "mtllib m.mtl\nmtllib m.mtl missing.mtl\n{TRIANGLE}usemtl one\nf 1 2 3\n\
             usemtl two\nf 1 2 3\nusemtl three\nf 1 2 3\nusemtl one\nf 3 2 1\n"
        ),
    );
    let loaded = load(&path, &LoadOptions::default()).unwrap();
    let (model, warnings) = (&loaded.meshes[0], &loaded.warnings);
    assert_eq!(model.face_material, [0, 1, 2, 0]);
    let [one, two, three] = &model.materials[..] else { panic!("{:?}", model.materials) };
    assert_eq!(one.base_color.to_array(), [1.0, 0.214_041_14, 0.0, 0.25]);
    assert_eq!((one.alpha_mode, one.texture, one.double_sided), (AlphaMode::Blend, Some(0), true));
    assert_eq!(two.base_color.to_array(), [1.0, 1.0, 1.0, 0.5]);
    assert_eq!(two.texture, Some(1));
    assert_eq!(model.textures[1].wrap, [Wrap::Clamp; 2]);
    assert_eq!((model.textures[0].width, &model.textures[0].rgba8[..4]), (2, &[1, 2, 3, 255][..]));
    assert_eq!((three.alpha_mode, three.texture), (AlphaMode::Opaque, None));
    for part in ["missing.mtl", "nowhere.png", "x.png", "spectral"] {
        assert!(warnings.iter().any(|w| w.text.contains(part)), "{part} in {warnings:?}");
    }
}

#[test]
fn emission_is_encoded_like_the_colour() {
    let folder = Folder::new();
    folder.write(
        "m.mtl",
        "newmtl one\nKe 1 0.5 0\nnewmtl two\nKe 2\nnewmtl three\nKe a b c\nnewmtl four\nmap_Ke a.png\nKe 1 1 1\n",
    );
    let faces = ["one", "two", "three", "four"].map(|name| format!("usemtl {name}\nf 1 2 3\n")).concat();
    let path = folder.write("m.obj", format!("mtllib m.mtl\n{TRIANGLE}{faces}"));
    let loaded = load(&path, &LoadOptions::default()).unwrap();
    let emissive: Vec<Vec3> = loaded.meshes[0].materials.iter().map(|m| m.emissive).collect();
    assert_eq!(emissive, [Vec3::new(1.0, 0.214_041_14, 0.0), Vec3::ONE, Vec3::ZERO, Vec3::ZERO]);
    for part in ["material \"three\": Ke \"a b c\" is not understood", "material \"four\": map_Ke is not supported"] {
        assert!(loaded.warnings.iter().any(|w| w.text.starts_with(part)), "{part} in {:?}", loaded.warnings);
    }
}

#[test]
fn faces_without_a_material_have_material_0_and_unknown_ones_are_named() {
    let folder = Folder::new();
    folder.write("m.mtl", "newmtl red\nKd 1 0 0\n");
    let path =
        folder.write("m.obj", format!("{TRIANGLE}f 1 2 3\nmtllib m.mtl\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 2 3\n"));
    let loaded = load(&path, &LoadOptions::default()).unwrap();
    let (model, warnings) = (&loaded.meshes[0], &loaded.warnings);
    assert_eq!(model.face_material, [0, 1, 0]);
    assert_eq!(model.materials[0], Default::default());
    assert_eq!(model.materials[1].name, "red");
    assert!(warnings.iter().any(|w| w.text.contains("blue")), "{warnings:?}");
}

#[test]
fn groups_share_vertices_and_materials_keep_positions_equal() {
    let m = text(format!("{TRIANGLE}v 1 1 0\no a\nf 1 2 3\ng b\nf 2 4 3\n")).into_model();
    assert_eq!(m.positions.len(), 4);
    let m = text(format!("{TRIANGLE}v 1 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 2 4 3\n")).into_model();
    assert_eq!(m.normals, vec![Vec3::Z; m.positions.len()]);
}

#[test]
fn objects_are_meshes_and_materials_are_not() {
    let m = text(format!("{TRIANGLE}o one\nusemtl a\nf 1 2 3\nusemtl b\nf 3 2 1\no two\nf 1 2 3\n")).into_model();
    assert_eq!(m.face_mesh, [0, 0, 1]);
    assert!(text(format!("{TRIANGLE}o one\nf 1 2 3\n")).into_model().face_mesh.is_empty());
    // Whatever its groups, a file is one mesh and one object.
    let loaded = text(format!("{TRIANGLE}o one\nf 1 2 3\no two\nf 1 2 3\n"));
    let object = Object { name: String::new(), mesh: 0, world_from_mesh: glam::DAffine3::IDENTITY };
    assert_eq!((loaded.meshes.len(), &loaded.objects[..]), (1, &[object][..]));
    assert_eq!(loaded.into_model().face_mesh, [0, 1]);
}

#[test]
fn a_position_with_many_normals_takes_no_quadratic_time() {
    let mut file = TRIANGLE.to_owned();
    for i in 0..60_000 {
        file += &format!("vn 1 0 {i}\nf 1//{0} 2//{0} 3//{0}\n", i + 1);
    }
    assert_eq!(text(file).into_model().positions.len(), 180_000);
}

fn fault(result: Result<Loaded, LoadError>) -> String {
    let error = result.unwrap_err();
    let message = error.to_string();
    assert!(message.contains(".obj"), "names the file: {message}");
    message
}

#[test]
fn bad_files_are_refused_with_the_line() {
    for (body, part) in [
        ("v 0 0\n", "line 1: a vertex of 2 coordinates"),
        ("v 0 0 0\nf 1 1 2\n", "line 2: a face uses vertex 2 of 1"),
        ("v 0 0 0\nf 1 1 -2\n", "line 2: a face uses vertex -2"),
        ("v 0 0 0\nf 1 1 0\n", "line 2: a face corner without a vertex"),
        ("v 0 0 0\nf 1/1 1 1\n", "texture coordinate 1 of 0"),
        ("v 0 0 0\nvt 0 0\nf 1/-5 1 1\n", "texture coordinate -5"),
        ("v 0 0 0\nvn 0 0 1\nf 1//9 1 1\n", "normal 9 of 1"),
        ("v 0 0 0\nf 1 1 x\n", "line 2"),
        ("v 0 0 0\nf 1 1 1/1/1/1\n", "line 2"),
        ("v 0 0 0\nf 1 1 99999999999999999999\n", "too large"),
        ("v 0 0 0\nf 1 1 -9223372036854775808\n", "too large"),
        ("v 0 0 0\nf 1 1 -\n", "no number"),
        ("v 0 0 NaN\nv 1 0 0\nf 1 2 2\n", "line 1: vertex (0, 0, NaN) is not finite"),
        ("\n\\\n\nv NaN 0 1e99\nv 0 0 1e99\nv 1 0 0\nf 2 3 3\n", "line 5: vertex (0, 0, inf) is not finite"),
        ("v a b c\nf 1 1 1\n", "line 1: a vertex coordinate that is no number"),
        ("v 0 0 0 0\nf 1 1 1\n", "line 1: a vertex weight of 0, scaling"),
        ("v 0 0 0\nvn 0 0\nf 1 1 1\n", "line 2: a normal that is not three numbers"),
        ("v 0 0 0\nf 1 1 1\0\n", "not a text file"),
    ] {
        let message = fault(try_text(body));
        assert!(message.contains(part), "{message:?} for {body:?}");
    }
    // Vertices that no face uses may be any number.
    assert_eq!(text("v NaN inf 0\nv 0 0 0\nf 2 2 2\n").into_model().faces.len(), 1);
}

#[test]
fn files_that_are_not_there_or_have_nothing_in_them() {
    let folder = Folder::new();
    let options = LoadOptions::default();
    let missing = load(&folder.0.join("none.obj"), &options);
    assert!(matches!(missing, Err(LoadError::Read { .. })));
    fault(missing);
    let directory = folder.0.join("folder.obj");
    fs::create_dir(&directory).unwrap();
    assert!(fault(load(&directory, &options)).contains("not a regular file"));
    for empty in ["", "# nothing\n", "\n\n\n", "v 0 0 0\n", "v 0 0 0\nf 1 1\n", "hello\\", "\\\n\\\n"] {
        assert!(matches!(try_text(empty), Err(LoadError::Empty { .. })), "{empty:?}");
    }
    let mut state = 7u32;
    let garbage: Vec<u8> = (0..5000)
        .map(|_| {
            state = state.wrapping_mul(1664525).wrapping_add(1013904223);
            (state >> 24) as u8
        })
        .collect();
    fault(try_text(&garbage));
    fault(try_text(garbage.iter().map(|b| *b | 1).collect::<Vec<_>>()));
}

#[test]
fn an_asset_root_that_is_no_folder_is_an_error() {
    let folder = Folder::new();
    let path = folder.write("m.obj", format!("{TRIANGLE}f 1 2 3\n"));
    for root in [path.clone(), folder.0.join("none")] {
        let options = LoadOptions { asset_root: Some(root.clone()), ..LoadOptions::default() };
        let error = load(&path, &options).unwrap_err().to_string();
        assert!(error.contains(&*root.to_string_lossy()), "{error}");
    }
}

#[test]
fn limits_hold() {
    let folder = Folder::new();
    let path = folder.write("m.obj", format!("{TRIANGLE}v 1 1 0\nf 1 2 4 3\n"));
    let all = Limits::default();
    for (limits, what) in [
        (Limits { file_bytes: 10, ..all }, "bytes"),
        (Limits { vertices: 3, ..all }, "vertices"),
        (Limits { faces: 1, ..all }, "faces"),
        (Limits { polygon_corners: 3, ..all }, "corners"),
    ] {
        let options = LoadOptions { limits, ..LoadOptions::default() };
        let error = load(&path, &options).unwrap_err();
        assert!(matches!(error, LoadError::TooLarge { .. }) && error.to_string().contains(what), "{error}");
    }
}

// ---- models that are not part of the repository ----

/// `None`, with a message, if the folder of test models does not exist.
fn shared(name: &str) -> Option<PathBuf> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    if folder.is_dir() {
        return Some(folder.join(name));
    }
    println!("skipped: no folder {}", folder.display());
    None
}

#[test]
fn known_models_have_their_face_counts() {
    let Some(table) = shared("topology.tsv") else { return };
    let table = fs::read_to_string(table).unwrap();
    let mut models = 0;
    for row in table.lines().filter(|l| !l.starts_with('#')).skip(1) {
        let columns: Vec<_> = row.split('\t').collect();
        let loaded = load(&shared(&format!("{}.obj", columns[0])).unwrap(), &LoadOptions::default()).unwrap();
        let (model, warnings) = (&loaded.meshes[0], &loaded.warnings);
        assert_eq!(model.faces.len().to_string(), columns[1], "{}", columns[0]);
        assert!(warnings.iter().all(|w| w.text == "no normals: they are made from the faces"), "{warnings:?}");
        assert!(model.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-6));
        models += 1;
    }
    assert!(models >= 9);
}

#[test]
fn spot_has_its_seams_and_its_texture() {
    let Some(path) = shared("spot.obj") else { return };
    let options = LoadOptions { normal_crease_angle_rad: std::f32::consts::PI, ..LoadOptions::default() };
    let model = load(&path, &options).unwrap().into_model();
    assert_eq!(model.positions.len(), 3225);
    assert_eq!(model.uvs.len(), 3225);
    assert_eq!(model.materials.len(), 1);
    assert_eq!(model.materials[0].base_color.to_array(), [1.0; 4]);
    assert_eq!((model.textures[0].width, model.textures[0].height), (1024, 1024));
}

#[test]
fn suzanne_keeps_the_normals_of_the_file() {
    let Some(path) = shared("suzanne.obj") else { return };
    let model = load(&path, &LoadOptions::default()).unwrap().into_model();
    let file = fs::read_to_string(path).unwrap();
    let given: Vec<Vec3> = file
        .lines()
        .filter_map(|l| l.strip_prefix("vn "))
        .map(|l| Vec3::from_slice(&l.split_whitespace().map(|w| w.parse().unwrap()).collect::<Vec<f32>>()).normalize())
        .collect();
    assert_eq!(model.positions.len(), 507);
    for normal in &model.normals {
        assert!(given.iter().any(|g| g.distance(*normal) < 1e-5));
    }
    assert_eq!(model.face_polygon.last(), Some(&499));
}
