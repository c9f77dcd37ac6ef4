use super::*;

/// An image without symmetry, in which neighbouring pixels and channels differ.
fn pattern(width: u32, height: u32) -> Image {
    let rgba8 = (0..height)
        .flat_map(|y| (0..width).flat_map(move |x| [x * 7 + y * 3, x * 3 + y * 11 + 50, x * y + 100, 200 - x - y]))
        .map(|value| (value % 251) as u8)
        .collect();
    Image::new(width, height, rgba8).expect("four bytes a pixel")
}

fn rearranged(image: &Image, from: impl Fn(u32, u32) -> (u32, u32)) -> Image {
    let mut result = image.clone();
    for y in 0..image.height {
        for x in 0..image.width {
            let (from_x, from_y) = from(x, y);
            result.set_pixel(x, y, image.pixel(from_x, from_y));
        }
    }
    result
}

fn at_most(magnitude: u8, count: u64) -> [Tolerance; 1] {
    [Tolerance { magnitude, count }]
}

#[test]
fn an_image_is_equal_to_itself() {
    let image = pattern(17, 11);
    let result = compare(&image, &image.clone(), &[]).expect("same size");
    assert!(result.passes(&[]) && result.passes(&at_most(0, 0)));
    assert_eq!((result.pixels, result.exempt, result.worst, result.worst_at), (187, 0, 0, None));
    assert_eq!((result.histogram[0], result.histogram_all[0]), (187, 187));
}

#[test]
fn one_channel_of_one_pixel_is_noticed() {
    let expected = pattern(17, 11);
    for channel in 0..4 {
        for difference in [1i16, -1, 20] {
            let mut actual = expected.clone();
            let mut color = actual.pixel(5, 7);
            color[channel] = (i16::from(color[channel]) + difference) as u8;
            actual.set_pixel(5, 7, color);
            for (a, b) in [(&expected, &actual), (&actual, &expected)] {
                let result = compare(a, b, &[]).expect("same size");
                assert!(!result.passes(&[]) && !result.passes(&at_most(0, 0)));
                let magnitude = difference.unsigned_abs() as u8;
                assert_eq!((result.worst, result.worst_at, result.over(0)), (magnitude, Some((5, 7)), 1));
                assert!(result.passes(&at_most(magnitude, 0)) && !result.passes(&at_most(magnitude - 1, 0)));
                let shown = difference_image(a, b, &[]).expect("same size");
                let bright = pixels(&shown).filter(|p| p[..3].iter().any(|&c| c >= 64)).count();
                assert_eq!((bright, shown.pixel(4, 7)), (1, [0, 0, 0, 255]));
                assert!(shown.pixel(5, 7)[..3].iter().any(|&c| c >= 64));
            }
        }
    }
}

#[test]
fn shifted_mirrored_and_swapped_images_are_noticed() {
    let image = pattern(16, 16);
    let (w, h) = (image.width, image.height);
    for other in [
        rearranged(&image, |x, y| ((x + 1) % w, y)),
        rearranged(&image, |x, y| (x, (y + 1) % h)),
        rearranged(&image, |x, y| (w - 1 - x, y)),
        rearranged(&image, |x, y| (x, h - 1 - y)),
        rearranged(&image, |x, y| (y, x)),
        Image { rgba8: pixels(&image).flat_map(|p| [p[2], p[1], p[0], p[3]]).collect(), ..image.clone() },
    ] {
        let result = compare(&image, &other, &[]).expect("same size");
        assert!(!result.passes(&[]) && result.over(2) > 100, "{}", result.over(2));
    }
}

#[test]
fn neither_image_is_read_twice() {
    let (black, white) = (Image::filled(9, 5, [0, 0, 0, 0]), Image::filled(9, 5, [255; 4]));
    for (a, b) in [(&black, &white), (&white, &black)] {
        let result = compare(a, b, &[]).expect("same size");
        assert_eq!((result.over(254), result.over(255), result.worst), (45, 0, 255));
        assert_eq!(difference_image(a, b, &[]).expect("same size"), Image::filled(9, 5, [255; 4]));
    }
    // Each pixel is compared only with the same pixel of the other image.
    let mut grey = black.clone();
    (0..45u8).for_each(|i| grey.set_pixel(u32::from(i) % 9, u32::from(i) / 9, [i; 4]));
    let result = compare(&black, &grey, &[]).expect("same size");
    assert!(result.histogram[..45].iter().all(|&n| n == 1));
    assert_eq!((result.worst, result.worst_at), (44, Some((8, 4))));
}

#[test]
fn other_sizes_are_an_error() {
    let image = pattern(6, 4);
    let reshaped = Image { width: 4, height: 6, ..image.clone() };
    let sizes = CompareError::Size { expected: (6, 4), actual: (4, 6) };
    assert_eq!(compare(&image, &reshaped, &[]), Err(sizes));
    assert_eq!(difference_image(&image, &reshaped, &[]), Err(sizes));
    assert_eq!(exempt_mask(&image, &[image.clone(), reshaped], 0), Err(sizes));
    assert_eq!(sizes.to_string(), "the expected image has 6×4 pixels, the actual one 4×6");
    let mask = Err(CompareError::Mask { mask: 23, pixels: 24 });
    assert_eq!(compare(&image, &image, &[true; 23]), mask);
    let broken = Image { height: 5, ..image.clone() };
    assert_eq!(compare(&broken, &broken, &[]), Err(CompareError::Bytes { width: 6, height: 5, bytes: 96 }));
    assert!(matches!(Image::new(6, 4, vec![0; 95]), Err(ImageError::Length { bytes: 95, .. })));
    assert!(Image::new(u32::MAX, u32::MAX, Vec::new()).is_err());
}

#[test]
fn the_count_of_a_tolerance_is_its_limit() {
    let expected = Image::filled(10, 10, [100; 4]);
    let mut actual = expected.clone();
    (0..3).for_each(|x| actual.set_pixel(x, 0, [103, 100, 100, 100]));
    let result = compare(&expected, &actual, &[]).expect("same size");
    assert!(result.passes(&at_most(2, 3)) && !result.passes(&at_most(2, 2)));
    assert!(result.passes(&at_most(3, 0)) && result.passes(&at_most(255, 0)));
    // All tolerances must be met.
    let both = |count| [at_most(0, 50)[0], at_most(2, count)[0]];
    assert!(result.passes(&both(3)) && !result.passes(&both(2)));
    actual.set_pixel(3, 0, [100, 100, 100, 97]);
    assert!(!compare(&expected, &actual, &[]).expect("same size").passes(&at_most(2, 3)));
}

#[test]
fn exempt_pixels_hide_themselves_only() {
    let reference = pattern(8, 8);
    let mut shifted = [reference.clone(), reference.clone()];
    shifted[0].set_pixel(2, 3, [0; 4]);
    let mut slightly = reference.pixel(6, 6);
    slightly[3] += 4;
    shifted[1].set_pixel(6, 6, slightly);
    let mask = exempt_mask(&reference, &shifted, 4).expect("same size");
    assert_eq!(mask.iter().enumerate().filter(|(_, m)| **m).map(|(i, _)| i).collect::<Vec<_>>(), [3 * 8 + 2]);
    assert_eq!(exempt_mask(&reference, &shifted, 3).expect("same size").iter().filter(|m| **m).count(), 2);
    assert_eq!(exempt_mask(&reference, &[], 0), Ok(vec![false; 64]));

    let mut actual = reference.clone();
    actual.set_pixel(2, 3, [1; 4]);
    let result = compare(&reference, &actual, &mask).expect("same size");
    assert!(result.passes(&[]));
    assert_eq!((result.exempt, result.over(0), result.over_all(0), result.worst_at), (1, 0, 1, None));
    assert_eq!(result.exempt_share(), 1.0 / 64.0);
    for beside in [(1, 3), (3, 3), (2, 2), (2, 4)] {
        let mut actual = actual.clone();
        actual.set_pixel(beside.0, beside.1, [1; 4]);
        let result = compare(&reference, &actual, &mask).expect("same size");
        assert!(!result.passes(&[]));
        assert_eq!((result.over(0), result.worst_at), (1, Some(beside)));
    }
    let shown = difference_image(&reference, &reference, &mask).expect("same size");
    assert_eq!((shown.pixel(2, 3), shown.pixel(3, 3)), ([0, 32, 48, 255], [0, 0, 0, 255]));
}

/// A new folder that is deleted when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        Self(std::env::temp_dir().join(format!("npr-compare-{name}-{}", std::process::id())))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn what_is_left_behind_can_be_read_again() {
    let folder = Folder::new("files");
    let (expected, mut actual) = (pattern(12, 9), pattern(12, 9));
    actual.set_pixel(0, 0, [9, 9, 9, 0]);
    let paths = leave_behind(&folder.0, "a/b <cube>", &expected, &actual, &[]).expect("written");
    assert_eq!(paths[0], folder.0.join("a_b__cube_-expected.png"));
    // Colours under alpha 0 survive too.
    assert_eq!(Image::load_png(&paths[0]).expect("read"), expected);
    assert_eq!(Image::load_png(&paths[1]).expect("read"), actual);
    assert_eq!(
        Image::load_png(&paths[2]).expect("read"),
        difference_image(&expected, &actual, &[]).expect("same size")
    );
    let comparison = compare(&expected, &actual, &[]).expect("same size");
    let row = ReportRow { name: "<b>&\"'".to_owned(), images: paths, comparison, tolerances: at_most(3, 0).to_vec() };
    let page = fs::read_to_string(html_report(&folder.0, &[row]).expect("written")).expect("read");
    assert!(page.contains("&lt;b&gt;&amp;&quot;&#39;") && !page.contains("<b>&\""));
    assert!(page.contains("1 of 1 failed") && page.contains("over 3: 1 of at most 0"));
    assert_eq!(page.matches("data:image/png;base64,iVBORw0KGgo").count(), 3);
    assert!(!page.contains("http"));
    // No temporary file remains.
    assert_eq!(fs::read_dir(&folder.0).expect("a folder").count(), 4);

    let other = Image::filled(3, 3, [0; 4]);
    let error = leave_behind(&folder.0, "sizes", &expected, &other, &[]);
    assert!(matches!(error, Err(HarnessError::Compare(CompareError::Size { .. }))));
    assert!(folder.0.join("sizes-actual.png").exists());
}

#[test]
fn files_that_are_none_are_named() {
    let folder = Folder::new("errors");
    let missing = folder.0.join("missing.png");
    assert!(matches!(Image::load_png(&missing), Err(ImageError::Read { path, .. }) if path == missing));
    let written = Image::filled(1, 1, [0; 4]).save_png(&missing);
    assert!(matches!(written, Err(ImageError::Write { path, .. }) if path == missing));
    fs::create_dir_all(&folder.0).expect("a folder");
    fs::write(&missing, b"no picture").expect("written");
    assert!(matches!(Image::load_png(&missing), Err(ImageError::Decode { path, .. }) if path == missing));
}
