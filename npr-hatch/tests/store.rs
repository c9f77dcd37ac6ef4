//! The file format: round trips, and rejected files.

use npr_hatch::*;
use proptest::prelude::*;

fn parameters() -> TamParameters {
    TamParameters { side: 16, tones: even_tones(3), cross_from: None, ..TamParameters::default() }
}

fn tam() -> Tam {
    draw(&parameters(), None).unwrap().tam
}

fn thresholds() -> Thresholds {
    Thresholds::new(&draw(&parameters(), None).unwrap(), &parameters(), None)
}

const TEXELS: usize = 256 + 64 + 16 + 4 + 1;

/// Files with and without thresholds.
fn files() -> [Vec<u8>; 2] {
    [None, Some(&thresholds())].map(|thresholds| store::to_bytes(&tam(), thresholds).unwrap())
}

/// FNV-1a from its definition.
fn fnv_1a(bytes: &[u8]) -> u64 {
    let mut sum: u64 = 14_695_981_039_346_656_037;
    for &byte in bytes {
        sum = (sum ^ u64::from(byte)).wrapping_mul(1_099_511_628_211);
    }
    sum
}

/// The file with a correct checksum for its content.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    let end = bytes.len().saturating_sub(8);
    let sum = fnv_1a(&bytes[..end]).to_le_bytes();
    bytes.truncate(end);
    bytes.extend(sum);
    bytes
}

/// The equivalent file of version 1, without flags and thresholds.
fn version_1(tam: &Tam) -> Vec<u8> {
    let mut bytes = store::to_bytes(tam, None).unwrap();
    bytes.drain(20..24);
    bytes[8] = 1;
    sealed(bytes)
}

#[test]
fn comes_back() {
    let (tam, thresholds) = (tam(), thresholds());
    let [bare, whole] = files();
    assert_eq!(bare.len(), 24 + 3 * 4 + 3 * TEXELS + 8);
    assert_eq!(store::from_bytes(&bare).unwrap(), store::Stored { tam: tam.clone(), thresholds: None });
    assert_eq!(whole.len(), bare.len() + 2 * TEXELS);
    assert_eq!(store::from_bytes(&whole).unwrap(), store::Stored { tam, thresholds: Some(thresholds) });
    assert_eq!(fnv_1a(b"foobar"), 0x8594_4171_f739_67e8);
    assert_eq!(sealed(whole.clone()), whole);
}

#[test]
fn bytes_are_where_the_table_says() {
    let (tam, thresholds) = (tam(), thresholds());
    let [_, bytes] = files();
    let header = [&b"NPR\0TAM\n"[..], &[2, 0, 0, 0, 16, 0, 0, 0, 3, 0, 0, 0, 1, 0, 0, 0]].concat();
    assert_eq!(bytes[..24], header);
    assert_eq!(bytes[24..28], 0.75_f32.to_le_bytes());
    assert_eq!(bytes[36..36 + 256], *tam.image(0, 0));
    let at = 36 + 3 * TEXELS;
    for (i, threshold) in thresholds.levels.concat().iter().enumerate() {
        assert_eq!(bytes[at + 2 * i..at + 2 * i + 2], threshold.to_le_bytes(), "{i}");
    }
}

/// The checksums of two files that were written by version 1.
#[test]
fn files_of_version_1_are_read() {
    let placement = Placement::BestOf { candidates: 8 };
    for (parameters, checksum) in [
        (TamParameters::default(), 13_926_816_079_277_968_299_u64),
        (TamParameters { side: 128, placement, ..TamParameters::default() }, 15_665_348_023_792_311_422),
    ] {
        let tam = draw(&parameters, None).unwrap().tam;
        let bytes = version_1(&tam);
        assert_eq!(bytes[bytes.len() - 8..], checksum.to_le_bytes());
        assert_eq!(store::from_bytes(&bytes).unwrap(), store::Stored { tam, thresholds: None });
    }
}

#[test]
fn truncated_and_long_files_are_errors() {
    for bytes in files().into_iter().chain([version_1(&tam())]) {
        for length in 0..bytes.len() {
            let error = store::from_bytes(&bytes[..length]).unwrap_err();
            assert!(matches!(error, HatchError::Magic { .. } | HatchError::Length { .. }), "{length}: {error}");
            // In the shortest file the checksum overlaps the header.
            let error = store::from_bytes(&sealed(bytes[..length].to_vec())).unwrap_err();
            assert!(length < 44 || matches!(error, HatchError::Length { .. }), "{length}: {error}");
        }
        for more in [1, 2, 2 * TEXELS] {
            let long = [bytes.as_slice(), &vec![0; more]].concat();
            assert!(matches!(store::from_bytes(&long), Err(HatchError::Length { .. })));
            assert!(matches!(store::from_bytes(&sealed(long)), Err(HatchError::Length { .. })));
        }
    }
}

#[test]
fn hostile_files_are_errors() {
    for bytes in files() {
        let with = |at: usize, new: &[u8]| {
            let mut bytes = bytes.clone();
            bytes[at..at + new.len()].copy_from_slice(new);
            store::from_bytes(&bytes).unwrap_err()
        };
        assert!(matches!(with(0, b"\x89PNG"), HatchError::Magic { .. }));
        for version in [0, 3, u32::MAX] {
            assert!(matches!(with(8, &version.to_le_bytes()), HatchError::Version { found } if found == version));
        }
        assert!(matches!(with(12, &u32::MAX.to_le_bytes()), HatchError::Side { side: u32::MAX }));
        assert!(matches!(with(12, &0_u32.to_le_bytes()), HatchError::Side { side: 0 }));
        assert!(matches!(with(12, &4096_u32.to_le_bytes()), HatchError::Length { .. }));
        assert!(matches!(with(16, &u32::MAX.to_le_bytes()), HatchError::TonesCount { .. }));
        assert!(matches!(with(16, &0_u32.to_le_bytes()), HatchError::TonesCount { tones: 0 }));
        for flags in [2, 3, 1 << 31, u32::MAX] {
            assert!(matches!(with(20, &flags.to_le_bytes()), HatchError::Flags { found } if found == flags));
        }
        assert!(matches!(with(20, &[1 - bytes[20]]), HatchError::Length { .. }));
        assert!(matches!(with(24, &f32::NAN.to_le_bytes()), HatchError::Tone { index: 0, .. }));
        // A file of version 2 that is marked as version 1.
        assert!(matches!(with(8, &[1]), HatchError::Tone { .. }));
        for (at, &byte) in bytes.iter().enumerate() {
            for bit in 0..8 {
                let error = with(at, &[byte ^ 1 << bit]);
                assert!(at < 36 || matches!(error, HatchError::Checksum { .. }), "{at}: {error}");
            }
        }
    }
}

#[test]
fn what_is_not_nested_is_not_stored() {
    let refused = |map: &Tam| store::to_bytes(map, None).unwrap_err();
    let mut map = tam();
    map.images[5][7] = 0;
    map.images[10][7] = 1;
    map.images[0][7] = 255;
    assert!(matches!(refused(&map), HatchError::NotNested { level: 0, texel: 7, tone: 2 }));
    let mut map = tam();
    map.images[3].pop();
    assert!(matches!(refused(&map), HatchError::ImageSize { image: 3, texels: 3, expected: 4 }));
    map.images.pop();
    assert!(matches!(map.validate(), Err(HatchError::ImageSize { image: 14, expected: 15, .. })));
}

#[test]
fn thresholds_that_are_no_order_are_neither_stored_nor_read() {
    let refused = |change: &dyn Fn(&mut Thresholds)| {
        let mut changed = thresholds();
        change(&mut changed);
        store::to_bytes(&tam(), Some(&changed)).unwrap_err()
    };
    // Level 3 has 65535 × 7/8, 5/8, 3/8 and 1/8, rounded.
    let mut level = thresholds().levels[3].clone();
    level.sort_unstable();
    assert_eq!(level, [8192, 24576, 40959, 57343]);
    let error = refused(&|t| t.levels[3].iter_mut().for_each(|value| *value = (*value).max(24576)));
    let expected = HatchError::ThresholdCount { level: 3, threshold: 8192, found: 0, expected: 1 };
    assert_eq!(error.to_string(), expected.to_string());
    assert!(matches!(refused(&|t| t.levels[0][9] ^= 1), HatchError::ThresholdCount { level: 0, .. }));
    assert!(matches!(refused(&|t| t.side = 32), HatchError::ThresholdSide { found: 32, expected: 16 }));
    let size = |change: &dyn Fn(&mut Thresholds)| match refused(change) {
        HatchError::ThresholdSize { level, texels, expected } => (level, texels, expected),
        error => panic!("{error}"),
    };
    assert_eq!(size(&|t| t.levels[2].truncate(15)), (2, 15, 16));
    assert_eq!(size(&|t| t.levels[4].push(0)), (4, 2, 1));
    assert_eq!(size(&|t| t.levels.truncate(4)), (4, 0, 1));
    assert_eq!(size(&|t| t.levels.clear()), (0, 0, 256));
    assert_eq!(size(&|t| t.levels.push(vec![])), (5, 0, 0));
    for side in [0, 3, 8192] {
        let thresholds = Thresholds { side, ..thresholds() };
        assert!(matches!(thresholds.validate(), Err(HatchError::Side { side: found }) if found == side));
    }
    // In a file with a correct checksum.
    let [_, bytes] = files();
    for at in (36 + 3 * TEXELS..bytes.len() - 8).step_by(7) {
        let mut bytes = bytes.clone();
        bytes[at] ^= 16;
        assert!(matches!(store::from_bytes(&sealed(bytes)), Err(HatchError::ThresholdCount { .. })), "{at}");
    }
    // Two exchanged thresholds are another order, which is valid.
    let mut swapped = thresholds();
    swapped.levels[0].swap(1, 200);
    swapped.validate().unwrap();
}

#[test]
fn thresholds_of_any_level_are_an_order() {
    // 1024² texels exceed the number of different thresholds.
    for side in [8, 64, 1024] {
        let parameters = TamParameters { side, tones: vec![0.9], cross_from: None, ..TamParameters::default() };
        let thresholds = Thresholds::new(&draw(&parameters, None).unwrap(), &parameters, None);
        assert_eq!(thresholds.levels.len() as u32, side.ilog2() + 1);
        thresholds.validate().unwrap();
        // Counted in another way, by sorting.
        let mut level = thresholds.levels[0].clone();
        level.sort_unstable();
        let count = level.len() as f64;
        for (i, &value) in level.iter().enumerate() {
            let exact = 65535.0 * (i as f64 + 0.5) / count;
            assert!((f64::from(value) - exact).abs() <= 0.5 + 1e-9, "{side}: {i}");
        }
    }
}

proptest! {
    #[test]
    fn no_file_is_a_panic(mut bytes in prop::collection::vec(any::<u8>(), 0..200), headed in 0_usize..=24) {
        let [_, head] = files();
        bytes.splice(0..0, head[..headed].iter().copied());
        let _ = store::from_bytes(&bytes);
        let _ = store::from_bytes(&sealed(bytes));
    }

    /// With a correct checksum, so that the checks behind it are reached. A file that is accepted is the only
    /// encoding of its content.
    #[test]
    fn changed_files_are_refused_or_as_good(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..5),
        in_header in any::<bool>(),
        with_thresholds in any::<bool>(),
    ) {
        let mut bytes = files()[usize::from(with_thresholds)].clone();
        let end = if in_header { 36 } else { bytes.len() };
        for (at, byte) in changes {
            bytes[at.index(end)] = byte;
        }
        let bytes = sealed(bytes);
        if let Ok(stored) = store::from_bytes(&bytes) {
            prop_assert_eq!(store::to_bytes(&stored.tam, stored.thresholds.as_ref()).unwrap(), bytes);
        }
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

    /// A stroke that fades towards its sides.
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
        // A fully inked picture is a stroke without taper.
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
