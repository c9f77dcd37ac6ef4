//! Files: there and back, and what is refused.

use npr_hatch::*;
use proptest::prelude::*;

fn tam() -> Tam {
    draw(&TamParameters { side: 16, tones: even_tones(3), cross_from: None, ..TamParameters::default() }, None)
        .unwrap()
        .tam
}

#[test]
fn comes_back() {
    let tam = tam();
    let bytes = store::to_bytes(&tam).unwrap();
    assert_eq!(bytes.len(), 20 + 3 * 4 + 3 * (256 + 64 + 16 + 4 + 1) + 8);
    assert_eq!(store::from_bytes(&bytes).unwrap(), tam);
}

#[test]
fn truncated_and_long_files_are_errors() {
    let bytes = store::to_bytes(&tam()).unwrap();
    for length in 0..bytes.len() {
        let error = store::from_bytes(&bytes[..length]).unwrap_err();
        assert!(matches!(error, HatchError::Magic { .. } | HatchError::Length { .. }), "{length}: {error}");
    }
    let long = [bytes.as_slice(), &[0]].concat();
    assert!(matches!(store::from_bytes(&long), Err(HatchError::Length { .. })));
}

#[test]
fn hostile_files_are_errors() {
    let bytes = store::to_bytes(&tam()).unwrap();
    let with = |at: usize, new: &[u8]| {
        let mut bytes = bytes.clone();
        bytes[at..at + new.len()].copy_from_slice(new);
        store::from_bytes(&bytes).unwrap_err()
    };
    assert!(matches!(with(0, b"\x89PNG"), HatchError::Magic { .. }));
    assert!(matches!(with(8, &[2]), HatchError::Version { found: 2 }));
    assert!(matches!(with(12, &u32::MAX.to_le_bytes()), HatchError::Side { side: u32::MAX }));
    assert!(matches!(with(12, &0_u32.to_le_bytes()), HatchError::Side { side: 0 }));
    assert!(matches!(with(12, &4096_u32.to_le_bytes()), HatchError::Length { .. }));
    assert!(matches!(with(16, &u32::MAX.to_le_bytes()), HatchError::TonesCount { .. }));
    assert!(matches!(with(16, &0_u32.to_le_bytes()), HatchError::TonesCount { tones: 0 }));
    assert!(matches!(with(20, &f32::NAN.to_le_bytes()), HatchError::Tone { index: 0, .. }));
    // Any other byte that is changed.
    for (at, &byte) in bytes.iter().enumerate().skip(32) {
        assert!(matches!(with(at, &[byte ^ 4]), HatchError::Checksum { .. }), "{at}");
    }
}

#[test]
fn what_is_not_nested_is_not_stored() {
    let mut map = tam();
    map.images[5][7] = 0;
    map.images[10][7] = 1;
    map.images[0][7] = 255;
    assert!(matches!(store::to_bytes(&map), Err(HatchError::NotNested { level: 0, texel: 7, tone: 2 })));
    let mut map = tam();
    map.images[3].pop();
    assert!(matches!(store::to_bytes(&map), Err(HatchError::ImageSize { image: 3, texels: 3, expected: 4 })));
    map.images.pop();
    assert!(matches!(map.validate(), Err(HatchError::ImageSize { image: 14, expected: 15, .. })));
}

proptest! {
    #[test]
    fn no_file_is_a_panic(mut bytes in prop::collection::vec(any::<u8>(), 0..200), is_headed in any::<bool>()) {
        if is_headed {
            let head = store::to_bytes(&tam()).unwrap();
            bytes.splice(0..0, head[..12].iter().copied());
        }
        let _ = store::from_bytes(&bytes);
    }
}

#[cfg(feature = "image")]
mod pictures {
    use image::{DynamicImage, GrayImage, ImageBuffer, Luma, Rgba, RgbaImage};
    use npr_hatch::*;

    fn folder(name: &str) -> std::path::PathBuf {
        let folder = std::env::temp_dir().join(format!("npr-hatch-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        folder
    }

    #[test]
    fn images_come_back() {
        let (tam, folder) = (super::tam(), folder("images"));
        let paths = png::write_images(&tam, &folder).unwrap();
        assert_eq!(paths.len(), tam.images.len());
        for (path, texels) in paths.iter().zip(&tam.images) {
            assert_eq!(image::open(path).unwrap().to_luma8().as_raw(), texels);
        }
        png::write_gray16(folder.join("sixteen.png"), 2, 1, &[7, 65535]).unwrap();
        assert_eq!(image::open(folder.join("sixteen.png")).unwrap().to_luma16().as_raw(), &[7, 65535]);
        std::fs::remove_dir_all(folder).unwrap();
    }

    /// A stroke that fades toward its sides.
    fn brush() -> DynamicImage {
        let dark = |y: u32| 255 - (255.0 * (1.0 - ((f64::from(y) + 0.5) / 8.0 - 1.0).powi(2))) as u8;
        DynamicImage::ImageLuma8(GrayImage::from_fn(40, 16, |_, y| Luma([dark(y)])))
    }

    #[test]
    fn a_pictures_depth_makes_no_difference() {
        let eight = brush();
        let first = StrokeImage::from_picture(&eight).unwrap();
        assert_eq!(StrokeImage::from_picture(&DynamicImage::ImageLuma16(eight.to_luma16())).unwrap(), first);
        assert_eq!(StrokeImage::from_picture(&DynamicImage::ImageRgb8(eight.to_rgb8())).unwrap(), first);
        let (path, folder) = ("brush.png", folder("brush"));
        eight.to_luma16().save(folder.join(path)).unwrap();
        assert_eq!(StrokeImage::load(folder.join(path)).unwrap(), first);
        std::fs::write(folder.join(path), b"no picture").unwrap();
        assert!(matches!(StrokeImage::load(folder.join(path)), Err(HatchError::Image { .. })));
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_map_of_pictures_has_its_tones() {
        let brush = StrokeImage::from_picture(&brush()).unwrap();
        let parameters = TamParameters { side: 128, width_px: 3.0, ..TamParameters::default() };
        let tam = draw(&parameters, Some(&brush)).unwrap().tam;
        tam.validate().unwrap();
        for (tone, level) in (0..6).flat_map(|tone| [0, 1].map(|level| (tone, level))) {
            assert!((tam.mean(tone, level) - f64::from(tam.tones[tone])).abs() < 0.005, "{tone}, {level}");
        }
        // A picture of plain ink is a stroke that does not taper.
        let plain = StrokeImage::from_ink(3, 5, &[65535; 15]).unwrap();
        let parameters = TamParameters { taper: 0.0, bow: 0.0, ..parameters };
        let (a, b) = (draw(&parameters, Some(&plain)).unwrap(), draw(&parameters, None).unwrap());
        let off = a.tam.image(0, 0).iter().zip(b.tam.image(0, 0)).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(off <= Some(2), "{off:?}");
    }

    #[test]
    fn pictures_without_ink_are_errors() {
        let white = DynamicImage::ImageLuma8(GrayImage::from_pixel(4, 4, Luma([255])));
        assert!(matches!(StrokeImage::from_picture(&white), Err(HatchError::NoInk { width: 4, height: 4 })));
        let clear = DynamicImage::ImageRgba8(RgbaImage::from_pixel(4, 4, Rgba([0, 0, 0, 0])));
        assert!(matches!(StrokeImage::from_picture(&clear), Err(HatchError::NoInk { .. })));
        let empty = DynamicImage::ImageLuma16(ImageBuffer::new(0, 0));
        assert!(matches!(StrokeImage::from_picture(&empty), Err(HatchError::Texels { texels: 0, .. })));
        assert!(matches!(StrokeImage::from_ink(2, 2, &[1; 3]), Err(HatchError::Texels { texels: 3, .. })));
        assert!(matches!(StrokeImage::from_ink(u32::MAX, u32::MAX, &[]), Err(HatchError::Texels { .. })));
    }

    #[test]
    fn a_picture_with_hardly_any_ink_is_out_of_reach() {
        let faint = StrokeImage::from_ink(2, 2, &[6000; 4]).unwrap();
        let parameters = TamParameters { side: 64, ..TamParameters::default() };
        assert!(matches!(draw(&parameters, Some(&faint)), Err(HatchError::Unreachable { tone: 0, .. })));
    }
}
