//! Compositing lines over pictures.

use glam::{DVec3, Vec3};
use npr_imagespace::ImageSpaceError;
use npr_imagespace::composite::*;

const GRAY: [u8; 4] = [200, 100, 50, 77];

fn over(ink: u8, how: &Composite) -> [u8; 4] {
    let mut pixels = [GRAY];
    composite_picture(&mut pixels, &[ink], how).unwrap();
    pixels[0]
}

#[test]
fn paper_changes_nothing_and_a_line_covers() {
    let red = Composite::Over { color: Vec3::X, opacity: 1.0 };
    let corrected = Composite::AlphaTested(AlphaTest::CORRECTED);
    for how in [Composite::Multiply, corrected, Composite::default(), red] {
        assert_eq!(over(0, &how), GRAY, "{how:?}");
    }
    for how in [Composite::Multiply, corrected, Composite::default()] {
        assert_eq!(over(255, &how), [0, 0, 0, 77], "{how:?}");
    }
    assert_eq!(over(255, &red), [255, 0, 0, 77]);
    assert_eq!(over(51, &red), [211, 80, 40, 77]);
    assert_eq!(over(255, &Composite::Over { color: Vec3::X, opacity: 0.2 }), [211, 80, 40, 77]);
    assert_eq!(over(51, &Composite::Multiply), [160, 80, 40, 77]);
}

#[test]
fn a_black_line_over_is_the_multiplication() {
    for ink in 0..=255 {
        assert_eq!(over(ink, &Composite::Multiply), over(ink, &Composite::default()));
    }
}

#[test]
fn the_printed_alpha_test_discards_the_lines() {
    let printed = Composite::AlphaTested(AlphaTest::PRINTED);
    assert_eq!(over(255, &printed), GRAY, "the line is not drawn");
    assert!(ink_alpha_passes(0.0, AlphaTest::PRINTED), "the paper is");
    assert!(ink_alpha_passes(0.99, AlphaTest::PRINTED), "(DWORD) 0.5f is 0: all that is not quite a line is");
    // The comparison alone: with 127, the 0.5 that was meant, soft lines pass and full ones do not.
    let meant = AlphaTest { less: false, reference: 127 };
    assert!(!ink_alpha_passes(1.0, meant) && ink_alpha_passes(0.2, meant));
    // LESS and 128: from half a line on.
    let passes = |ink: f64| ink_alpha_passes(ink / 255.0, AlphaTest::CORRECTED);
    assert!(!passes(0.0) && !passes(127.0) && passes(128.0) && passes(255.0));
    assert_eq!(ink_composite(DVec3::ONE, 0.4, &Composite::AlphaTested(AlphaTest::CORRECTED)), DVec3::ONE);
}

#[test]
fn uniforms_have_the_values_of_the_composite() {
    let uniform = CompositeUniform::from(&Composite::AlphaTested(AlphaTest::CORRECTED));
    assert_eq!((uniform.form, uniform.alpha_less, uniform.alpha_reference), (1, 1, 128));
    let uniform = CompositeUniform::from(&Composite::Over { color: Vec3::new(0.1, 0.2, 0.3), opacity: 0.4 });
    assert_eq!((uniform.form, uniform.line), (2, [0.1, 0.2, 0.3, 0.4]));
    assert_eq!(CompositeUniform::from(&Composite::Multiply).form, 0);
}

#[test]
fn pictures_of_two_sizes_are_refused() {
    let refused = composite_picture(&mut [GRAY; 2], &[0; 3], &Composite::Multiply);
    assert_eq!(refused, Err(ImageSpaceError::Pixels { pixels: 2, ink: 3 }));
}

#[test]
fn a_blend_unit_has_the_same_result() {
    let color = DVec3::new(0.8, 0.4, 0.1);
    let soft = Composite::Over { color: Vec3::new(0.2, 0.9, 0.5), opacity: 0.7 };
    let tested = [AlphaTest::PRINTED, AlphaTest::CORRECTED].map(Composite::AlphaTested);
    for how in [Composite::Multiply, tested[0], tested[1], soft, Composite::default()] {
        for ink in (0..=255).map(|ink| f64::from(ink) / 255.0) {
            let premultiplied = ink_premultiplied(ink, &how);
            let blended = premultiplied.truncate() + (1.0 - premultiplied.w) * color;
            assert!(blended.abs_diff_eq(ink_composite(color, ink, &how), 1e-12), "{how:?} {ink}");
        }
    }
}
