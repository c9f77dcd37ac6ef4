//! Textures of both formats.

use crate::case::{Case, fails, loads};
use crate::obj::TRIANGLE;
use image::{ImageFormat, Rgba, RgbaImage};
use npr_mesh::{Limits, LoadOptions};
use std::io::Cursor;

pub fn picture(width: u32, height: u32, format: ImageFormat) -> Vec<u8> {
    let image = RgbaImage::from_fn(width, height, |x, y| Rgba([x as u8, y as u8, 7, 255]));
    let mut bytes = Cursor::new(Vec::new());
    match format {
        ImageFormat::Jpeg => image::DynamicImage::from(image).into_rgb8().write_to(&mut bytes, format),
        _ => image.write_to(&mut bytes, format),
    }
    .expect("encoded");
    bytes.into_inner()
}

fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xEDB8_8320 } else { crc >> 1 })
    })
}

/// A PNG file whose header states another size.
pub fn png_that_says(width: u32, height: u32) -> Vec<u8> {
    let mut png = picture(2, 2, ImageFormat::Png);
    png[16..20].copy_from_slice(&width.to_be_bytes());
    png[20..24].copy_from_slice(&height.to_be_bytes());
    let crc = crc(&png[12..29]);
    png[29..33].copy_from_slice(&crc.to_be_bytes());
    png
}

fn texture(name: &str, line: &str, warnings: &[&str]) -> Case {
    let text = format!("mtllib m.mtl\n{TRIANGLE}vt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
    Case::new(&format!("texture-{name}"), "m.obj", text, loads(1, warnings))
        .with("m.mtl", format!("newmtl a\nmap_Kd {line}\n"))
}

pub fn cases() -> Vec<Case> {
    let png = || picture(2, 2, ImageFormat::Png);
    let jpeg = picture(16, 16, ImageFormat::Jpeg);
    let outside = "leads out of the model's folder";
    let named = |name: &str, line: &str| texture(name, line, &[]).with("t.png", png());
    let broken = |name: &str, bytes: Vec<u8>| texture(name, "t.png", &["image t.png"]).with("t.png", bytes);
    let failing = |case: Case, parts: &[&str]| Case { expect: fails(parts), ..case };
    let limited =
        |case: Case, limits: Limits| Case { options: LoadOptions { limits, ..LoadOptions::default() }, ..case };
    let two = |limits| {
        let text = format!("mtllib m.mtl\n{TRIANGLE}vt 0 0\nusemtl a\nf 1/1 2/1 3/1\nusemtl b\nf 1/1 2/1 3/1\n");
        let name = if limits == Limits::default() { "texture-two" } else { "texture-two-over-the-limit" };
        let case = Case::new(name, "m.obj", text, loads(2, &[]))
            .with("m.mtl", "newmtl a\nmap_Kd t.png\nnewmtl b\nmap_Kd u.png\n")
            .with("t.png", png())
            .with("u.png", png());
        limited(case, limits)
    };
    vec![
        named("plain", "t.png"),
        texture(
            "options",
            "-blendu on -o 1 2 3 -s 1 -mm 0 1 -clamp on -bm 1.0 t.png",
            &["option -blendu is ignored", "option -mm is ignored", "option -bm is ignored"],
        )
        .with("t.png", png()),
        named("quoted", "\"t.png\""),
        named("dot", "./t.png"),
        named("absolute-elsewhere", "/home/somebody/t.png"),
        named("drive-elsewhere", "D:\\art\\t.png"),
        named("case-of-the-option", "-CLAMP").with("-CLAMP", png()),
        texture("spaces", "my texture.png", &[]).with("my texture.png", png()),
        texture("options-only", "-o 1 2 3", &["/3: "]),
        texture("option-cut-off", "-clamp", &["map_Kd names no file"]),
        texture("missing", "none.png", &["none.png"]),
        texture("long-name", &"x".repeat(100_000), &["texture"]),
        texture("folder", "sub", &["not a regular file"]).with("sub/x", ""),
        texture("parent", "../secret.png", &[outside]).with("../secret.png", png()),
        texture("parent-backslash", "..\\secret-2.png", &[outside]).with("../secret-2.png", png()),
        texture("device", "../../../../../../../dev/urandom", &[outside]),
        texture("link-outside", "t.png", &[outside]).with("../secret-3.png", png()).link("t.png", "../secret-3.png"),
        Case { pipe: Some("t.png".to_owned()), ..texture("pipe", "t.png", &["not a regular file"]) },
        texture("asset-root", "wood/t.png", &[]).with("../assets-5/wood/t.png", png()).asset_root("../assets-5"),
        texture("asset-root-parent", "../assets-6/t.png", &[])
            .with("../assets-6/t.png", png())
            .asset_root("../assets-6"),
        texture("in-the-folder-of-the-material", "x", &[]).with("x", png()),
        named("jpeg-named-png", "j.png").with("j.png", jpeg.clone()),
        broken("empty", Vec::new()),
        broken("garbage", b"not an image".to_vec()),
        broken("cut-off", png()[..40].to_vec()),
        broken("jpeg-cut-off", jpeg[..jpeg.len() / 3].to_vec()),
        broken("gif", b"GIF89a\x01\0\x01\0\0\0\0;".to_vec()),
        broken("no-texels", png_that_says(0, 0)),
        broken("wrong-checksum", {
            let mut bytes = png();
            bytes[29] ^= 1;
            bytes
        }),
        broken("says-too-much", png_that_says(4000, 4000)),
        failing(
            texture("bomb", "t.png", &[]).with("t.png", png_that_says(60_000, 60_000)),
            &["t.png", "texels in an image"],
        ),
        broken("bomb-largest", png_that_says(i32::MAX as u32, 1 << 20)),
        two(Limits::default()),
        failing(two(Limits { texels_in_all: 7, ..Limits::default() }), &["8 texels in all images", "limit of 7"]),
    ]
}
