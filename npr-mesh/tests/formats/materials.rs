//! Material files: options of textures, alpha, image formats, and names.

use crate::folder::Folder;
use crate::{load_with, warnings};
use glam::Vec2;
use image::{DynamicImage, GrayImage, ImageFormat, Luma, Rgb, RgbImage, Rgba, RgbaImage};
use npr_mesh::{AlphaMode, Limits, LoadOptions, Loaded, Model, Wrap, load};
use std::fs;
use std::io::Cursor;

const SQUARE: &str = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

fn encoded(image: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, format).expect("it can be encoded");
    bytes.into_inner()
}

fn png(image: impl Into<DynamicImage>) -> Vec<u8> {
    encoded(image, ImageFormat::Png)
}

/// Red, green over blue, white.
fn four() -> RgbImage {
    RgbImage::from_fn(2, 2, |x, y| Rgb([[255, 0, 0], [0, 255, 0], [0, 0, 255], [255; 3]][(2 * y + x) as usize]))
}

fn square(mtl: &str, files: &[(&str, Vec<u8>)]) -> Loaded {
    let obj = format!("{SQUARE}usemtl a\nf 1/1 2/2 3/3 4/4\n");
    let mut files = files.to_vec();
    files.push(("m.mtl", format!("newmtl a\n{mtl}\n").into()));
    load_with("m.obj", obj, &files).expect("it loads")
}

fn texels(model: &Model) -> Vec<[u8; 4]> {
    model.textures[0].rgba8.chunks(4).map(|texel| texel.try_into().unwrap()).collect()
}

#[test]
fn scale_and_offset_are_baked_into_texture_coordinates() {
    let files = [("t.png", png(four()))];
    let uvs = |options: &str| square(&format!("map_Kd {options} t.png"), &files).into_model().uvs;
    // v of the file runs upwards, and downwards in the model.
    let expected = |corners: [[f32; 2]; 4]| corners.map(|[u, v]| Vec2::new(u, 1.0 - v)).to_vec();
    assert_eq!(uvs(""), expected([[0., 0.], [1., 0.], [1., 1.], [0., 1.]]));
    assert_eq!(uvs("-s 2 3 1"), expected([[0., 0.], [2., 0.], [2., 3.], [0., 3.]]));
    assert_eq!(uvs("-o .25 .5 0"), expected([[0.25, 0.5], [1.25, 0.5], [1.25, 1.5], [0.25, 1.5]]));
    assert_eq!(uvs("-o .5 0 -s 2 2"), expected([[0.5, 0.], [2.5, 0.], [2.5, 2.], [0.5, 2.]]));
}

#[test]
fn a_vertex_is_split_where_materials_place_their_textures_differently() {
    let obj = format!("{SQUARE}usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 3/3 4/4\n");
    let mtl = "newmtl a\nmap_Kd -s 2 2 t.png\nnewmtl b\nmap_Kd t.png\n";
    let files = [("t.png", png(four())), ("m.mtl", mtl.into())];
    let model = load_with("m.obj", obj, &files).expect("it loads").into_model();
    let uv = |face: usize, corner: usize| model.uvs[model.faces[face][corner] as usize];
    assert_eq!((uv(0, 2), uv(1, 1)), (Vec2::new(2.0, -1.0), Vec2::new(1.0, 0.0)));
    assert_eq!(model.textures.len(), 1, "the image is shared");
}

#[test]
fn what_is_ignored_is_warned_of_once() {
    let line = "map_Kd -bm 1 -t 1 1 1 -clamp on t.png\nmap_Kd -bm 0.5 -s 1 1 1 t.png";
    let loaded = square(line, &[("t.png", png(four()))]);
    let expected = ["the texture option -bm is ignored (2 times)", "the texture option -t is ignored"];
    assert_eq!(warnings(&loaded), expected);
    assert_eq!(loaded.meshes[0].textures[0].wrap, [Wrap::Repeat; 2], "the last statement counts");
    let clamped = square("map_Kd -clamp on t.png", &[("t.png", png(four()))]);
    assert_eq!((clamped.meshes[0].textures[0].wrap, warnings(&clamped).len()), ([Wrap::Clamp; 2], 0));
}

#[test]
fn every_format_of_images_is_read() {
    use ImageFormat::{Bmp, Gif, Jpeg, Png, Tga, Tiff, WebP};
    for (format, name) in [
        (Png, "t.png"),
        (Bmp, "t.bmp"),
        (Tga, "t.tga"),
        (Tga, "T.TGA"),
        (Gif, "t.gif"),
        (WebP, "t.webp"),
        (Tiff, "t.tif"),
        // The bytes decide, except for TGA.
        (Bmp, "t.jpg"),
        (Jpeg, "t.jpg"),
    ] {
        let image =
            if format == Gif { DynamicImage::from(four()).into_rgba8().into() } else { DynamicImage::from(four()) };
        let loaded = square(&format!("map_Kd {name}"), &[(name, encoded(image, format))]);
        assert_eq!(warnings(&loaded), [""; 0], "{name}");
        let model = loaded.into_model();
        if format != Jpeg {
            let expected = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255; 4]];
            assert_eq!(texels(&model), expected, "{name}");
        }
        assert_eq!(model.materials[0].alpha_mode, AlphaMode::Opaque, "{name}");
    }
    let loaded = square("map_Kd t.tga", &[("t.tga", b"no image".to_vec())]);
    assert!(warnings(&loaded)[0].contains("image t.tga"), "{:?}", warnings(&loaded));
}

#[test]
fn map_d_is_the_alpha_of_the_texture() {
    let gray = |values: [u8; 4]| png(GrayImage::from_fn(2, 2, |x, y| Luma([values[(2 * y + x) as usize]])));
    let alpha = |values: [u8; 4]| png(RgbaImage::from_fn(2, 2, |x, y| Rgba([9, 9, 9, values[(2 * y + x) as usize]])));
    for (bytes, mode) in [
        (gray([0, 255, 255, 0]), AlphaMode::Mask { cutoff: 0.5 }),
        (alpha([0, 255, 255, 0]), AlphaMode::Mask { cutoff: 0.5 }),
        (gray([0, 128, 255, 0]), AlphaMode::Blend),
        (alpha([0, 128, 255, 0]), AlphaMode::Blend),
        (gray([255; 4]), AlphaMode::Opaque),
        (alpha([255; 4]), AlphaMode::Opaque),
    ] {
        let values: Vec<u8> = {
            let image = image::load_from_memory(&bytes).unwrap();
            if image.color().has_alpha() {
                image.into_rgba8().pixels().map(|p| p[3]).collect()
            } else {
                image.into_luma8().into_raw()
            }
        };
        let model =
            square("map_Kd t.png\nmap_d d.png", &[("t.png", png(four())), ("d.png", bytes.clone())]).into_model();
        assert_eq!(model.materials[0].alpha_mode, mode);
        let expected: Vec<_> = four().pixels().zip(&values).map(|(p, &a)| [p[0], p[1], p[2], a]).collect();
        assert_eq!((texels(&model), model.textures.len()), (expected, 1));
        // Without map_Kd the colour is that of Kd.
        let model = square("Kd 1 0 0\nmap_d d.png", &[("d.png", bytes)]).into_model();
        assert_eq!((model.materials[0].alpha_mode, model.materials[0].base_color.to_array()), (mode, [1., 0., 0., 1.]));
        assert_eq!(texels(&model), values.iter().map(|&a| [255, 255, 255, a]).collect::<Vec<_>>());
    }
}

#[test]
fn map_d_of_another_size_or_placement_is_resampled() {
    let mask = png(GrayImage::from_fn(4, 4, |x, _| Luma([if x < 2 { 255 } else { 0 }])));
    let files = [("t.png", png(four())), ("d.png", mask)];
    let model = square("map_Kd -s 2 2 1 t.png\nmap_d d.png", &files).into_model();
    let texture = &model.textures[0];
    assert_eq!((texture.width, texture.height), (4, 4));
    // The colour repeats twice within the mask.
    let row: Vec<_> = texels(&model)[..4].iter().map(|[r, g, _, a]| (*r, *g, *a)).collect();
    assert_eq!(row, [(255, 0, 255), (0, 255, 255), (255, 0, 0), (0, 255, 0)]);
    assert_eq!(model.uvs[2], Vec2::new(1.0, 0.0), "coordinates are those of the mask");
    let loaded = square("map_Kd -s 1.5 1.5 t.png\nmap_d d.png", &files);
    assert!(warnings(&loaded)[0].contains("map_d repeats unlike map_Kd"), "{:?}", warnings(&loaded));
}

#[test]
fn a_missing_map_d_leaves_the_surface_opaque() {
    let loaded = square("map_Kd t.png\nmap_d none.png", &[("t.png", png(four()))]);
    assert!(warnings(&loaded)[0].contains("none.png"), "{:?}", warnings(&loaded));
    assert_eq!(loaded.meshes[0].materials[0].alpha_mode, AlphaMode::Opaque);
}

#[test]
fn opacity_by_d_and_tr() {
    for (mtl, alpha, mode, warned) in [
        ("Tr 1\nd 1", 1.0, AlphaMode::Opaque, true),
        ("d 1\nTr 1.0", 1.0, AlphaMode::Opaque, true),
        ("Tr 1", 1.0, AlphaMode::Opaque, true),
        ("d 0\nTr 0", 1.0, AlphaMode::Opaque, true),
        ("Tr 0", 1.0, AlphaMode::Opaque, false),
        ("Tr 0.25", 0.75, AlphaMode::Blend, false),
        ("d 0.25", 0.25, AlphaMode::Blend, false),
        ("Tr 0.75\nd 0.25", 0.25, AlphaMode::Blend, false),
    ] {
        let loaded = square(&format!("Kd 1 0 0\n{mtl}"), &[]);
        let material = &loaded.meshes[0].materials[0];
        assert_eq!((material.base_color.w, material.alpha_mode), (alpha, mode), "{mtl}");
        assert_eq!(!warnings(&loaded).is_empty(), warned, "{mtl}: {:?}", warnings(&loaded));
    }
}

#[test]
fn names_with_spaces_several_and_quoted() {
    let red = b"newmtl a\nKd 1 0 0\n".to_vec();
    for (line, name) in [
        ("my own.mtl", "my own.mtl"),
        ("\"my own.mtl\"", "my own.mtl"),
        ("other.mtl my own.mtl", "my own.mtl"),
        ("my own.mtl another one.mtl", "another one.mtl"),
        ("\"other one.mtl\" sub/m.mtl", "sub/m.mtl"),
        ("other.mtl sub\\m.mtl", "sub/m.mtl"),
    ] {
        let obj = format!("{}usemtl a\nf 1 2 3\n", SQUARE.replace("m.mtl", line));
        let loaded = load_with("m.obj", obj, &[(name, red.clone())]).expect("it loads");
        assert_eq!(loaded.meshes[0].materials[1 - 1].base_color.to_array(), [1.0, 0.0, 0.0, 1.0], "{line}");
    }
    let loaded = square("map_Kd my own t.png", &[("my own t.png", png(four()))]);
    assert_eq!((warnings(&loaded), loaded.meshes[0].textures.len()), (vec![], 1));
    let loaded = square("map_Kd", &[]);
    assert_eq!(warnings(&loaded), ["material \"a\": map_Kd names no file"]);
}

#[test]
fn a_file_is_found_by_another_case_as_a_last_resort() {
    let folder = Folder::new();
    folder.write("Art/T2.PNG", png(four()));
    folder.write("M.MTL", "newmtl a\nmap_Kd art\\t2.png\n");
    let model = folder.write("m.obj", format!("{SQUARE}usemtl a\nf 1/1 2/2 3/3\n"));
    let loaded = load(&model, &LoadOptions::default()).expect("it loads");
    assert_eq!((warnings(&loaded), loaded.meshes[0].textures.len()), (vec![], 1));
    // The exact name comes first.
    if !folder.0.join("art").exists() {
        folder.write("art/t2.png", png(RgbImage::from_pixel(1, 1, Rgb([1, 2, 3]))));
        let loaded = load(&model, &LoadOptions::default()).expect("it loads");
        assert_eq!(texels(&loaded.meshes[0])[0], [1, 2, 3, 255]);
    }
}

#[cfg(unix)]
#[test]
fn another_case_leads_nowhere_outside() {
    let folder = Folder::new();
    folder.write("secret/T.PNG", png(four()));
    fs::create_dir_all(folder.0.join("model")).unwrap();
    std::os::unix::fs::symlink("../secret", folder.0.join("model/Link")).unwrap();
    std::os::unix::fs::symlink("../secret/T.PNG", folder.0.join("model/L.PNG")).unwrap();
    for name in ["link/t.png", "Link/t.png", "l.png", "../SECRET/t.png"] {
        folder.write("model/m.mtl", format!("newmtl a\nmap_Kd {name}\n"));
        let model = folder.write("model/m.obj", format!("{SQUARE}usemtl a\nf 1/1 2/2 3/3\n"));
        let loaded = load(&model, &LoadOptions::default()).expect("it loads");
        assert_eq!(
            (loaded.meshes[0].textures.len(), warnings(&loaded).len()),
            (0, 1),
            "{name}: {:?}",
            warnings(&loaded)
        );
    }
}

#[test]
fn an_image_that_is_too_large_is_named_with_its_model() {
    let folder = Folder::new();
    folder.write("wall.png", png(four()));
    folder.write("m.mtl", "newmtl a\nmap_Kd wall.png\n");
    let model = folder.write("room.obj", format!("{SQUARE}usemtl a\nf 1/1 2/2 3/3\n"));
    let options = LoadOptions { limits: Limits { texels: 3, ..Limits::default() }, ..LoadOptions::default() };
    let error = load(&model, &options).unwrap_err().to_string();
    assert!(error.contains("room.obj: image wall.png: 4 texels in an image, more than the limit of 3"), "{error}");
}

#[test]
fn joined_images_of_unlike_shapes_are_within_the_limits() {
    let wide = png(RgbImage::from_pixel(3000, 1, Rgb([255, 0, 0])));
    let tall = png(GrayImage::from_pixel(1, 3000, Luma([128])));
    let files = [("t.png", wide), ("d.png", tall)];
    let obj = format!("{SQUARE}usemtl a\nf 1/1 2/2 3/3 4/4\n");
    let all = |mtl: &str| [&files[..], &[("m.mtl", format!("newmtl a\n{mtl}\n").into())]].concat();
    let resolver = |name: &str| {
        let found = all("map_Kd t.png\nmap_d d.png").into_iter().find(|(known, _)| *known == name);
        found.map(|(_, bytes)| bytes).ok_or_else(|| std::io::ErrorKind::NotFound.into())
    };
    let options = LoadOptions { limits: Limits { texels: 1 << 20, ..Limits::default() }, ..LoadOptions::default() };
    let error = npr_mesh::load_bytes("m.obj", obj.into(), &resolver, &options).unwrap_err();
    assert!(error.to_string().contains("9000000 texels in an image"), "{error}");
}
