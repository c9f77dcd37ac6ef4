//! The two-light painter, lights and half-Lambert: hand-computed values of the listings, and validation.

use approx::assert_abs_diff_eq;
use glam::{DVec2, DVec3, DVec4, Vec3};
use npr_toon::half_lambert::*;
use npr_toon::painter::*;
use npr_toon::source::*;
use npr_toon::*;
use proptest::prelude::*;

fn lights(of: &[(Vec3, Vec3, f32)]) -> Vec<Light> {
    let light = |&(to_light, color, brightness): &(Vec3, Vec3, f32)| Light {
        color,
        brightness,
        ..Light::directional(to_light)
    };
    of.iter().map(light).collect()
}

#[test]
fn brightness_scales_the_coordinates() {
    // Light A along the normal with brightness 0.5, light B at 60 degrees with brightness 1.5.
    let from_the_side = Vec3::new(3.0_f32.sqrt(), 0.0, 1.0);
    let painter = Painter::new(lights(&[(Vec3::Z * 3.0, Vec3::ONE, 0.5), (from_the_side, Vec3::ONE, 1.5)])).unwrap();
    let uv = toon_painter_uv(&painter, DVec3::ZERO, DVec3::Z * 7.0);
    assert!(uv.abs_diff_eq(DVec2::new(0.5, 0.75), 1e-7), "{uv}");
    // On back-facing surfaces it is not clamped: the ramp does that, as the sampler in the listing does.
    let uv = toon_painter_uv(&painter, DVec3::ZERO, DVec3::NEG_Z);
    assert!(uv.abs_diff_eq(DVec2::new(-0.5, -0.75), 1e-7), "{uv}");
    assert_eq!(toon_diffuse(0.8, 0.5), 0.4);
    // The product equals that of the listing, which scales the light vector.
    let scaled = toon_n_dot_l_interpolated(DVec3::Z, DVec3::new(0.0, 0.6, 0.8) * 0.5);
    assert_eq!(toon_diffuse(toon_n_dot_l_interpolated(DVec3::Z, DVec3::new(0.0, 0.6, 0.8)), 0.5), scaled);
}

#[test]
fn one_light_or_none() {
    let one = Painter::new(lights(&[(Vec3::Z, Vec3::X, 1.0)])).unwrap();
    assert_eq!(toon_painter_uv(&one, DVec3::ZERO, DVec3::Z), DVec2::X);
    let none = Painter::new(vec![]).unwrap();
    assert_eq!(toon_painter_uv(&none, DVec3::ZERO, DVec3::Z), DVec2::ZERO);
    assert_eq!(combined_color(&none.lights), DVec3::ONE);
}

#[test]
fn positional_lights() {
    let place = LightKind::Positional { position: Vec3::new(0.0, 0.0, 5.0) };
    assert!(toon_to_light(place, DVec3::new(0.0, 3.0, 1.0)).abs_diff_eq(DVec3::new(0.0, -0.6, 0.8), 1e-15));
    // At the position of the light, and for zero or NaN normals, the result is 0.
    let painter = Painter::new(vec![Light::positional(Vec3::new(0.0, 0.0, 5.0))]).unwrap();
    assert_eq!(toon_painter_uv(&painter, DVec3::new(0.0, 0.0, 5.0), DVec3::Z), DVec2::ZERO);
    assert_eq!(toon_painter_uv(&painter, DVec3::ZERO, DVec3::ZERO), DVec2::ZERO);
    assert_eq!(toon_painter_uv(&painter, DVec3::ZERO, DVec3::NAN), DVec2::ZERO);
}

#[test]
fn alpha_chooses_the_colour_or_the_texture() {
    let (material, texel) = (DVec4::new(1.0, 0.0, 0.0, 0.6), DVec4::new(0.0, 1.0, 0.0, 0.2));
    assert_eq!(toon_material(material, texel), material);
    // `cnd` is "greater than 1/2".
    for alpha in [0.5, 0.0, f64::NAN] {
        assert_eq!(toon_material(material.truncate().extend(alpha), texel), texel, "{alpha}");
    }
}

#[test]
fn three_quarters_and_twice_is_one_and_a_half() {
    let gray = DVec3::splat;
    assert_eq!(toon_overbright(gray(0.5), DVec3::ONE, 0.75), gray(0.75));
    assert_eq!(toon_overbright(gray(0.5), gray(0.5), 0.75), gray(0.375));
    // Clamped from 2/3 on.
    assert_eq!(toon_overbright(DVec3::new(0.6, 0.7, 1.0), DVec3::ONE, 0.75), DVec3::new(0.6 * 0.75 * 2.0, 1.0, 1.0));
    assert_eq!(toon_overbright(gray(0.3), DVec3::ONE, 0.5), gray(0.3));
    assert_eq!(Painter::LIGHT_SCALE, 0.75);
}

#[test]
fn listing_2_by_hand() {
    // Material (0.8, 0.4, 0.2) on the shade 0.6, under a light of (1, 0.75, 0.5): 0.8 * 0.6 * 1 * 1.5 = 0.72, and so on.
    let painter = Painter::new(lights(&[(Vec3::Z, Vec3::new(1.0, 0.75, 0.5), 1.0)])).unwrap();
    let color = toon_paint(&painter, DVec3::splat(0.6), DVec4::new(0.8, 0.4, 0.2, 0.9));
    assert!(color.abs_diff_eq(DVec4::new(0.72, 0.27, 0.09, 0.9), 1e-12), "{color}");
}

#[test]
fn one_colour_for_all_lights() {
    let (red, blue) = (Vec3::X, Vec3::Z);
    assert_eq!(combined_color(&lights(&[(Vec3::Z, red, 1.0), (Vec3::X, blue, 1.0)])), DVec3::new(0.5, 0.0, 0.5));
    assert_eq!(combined_color(&lights(&[(Vec3::Z, red, 1.5), (Vec3::X, blue, 0.5)])), DVec3::new(0.75, 0.0, 0.25));
    assert_eq!(combined_color(&lights(&[(Vec3::Z, red, 0.3), (Vec3::X, blue, 0.0)])), DVec3::X);
    assert_eq!(combined_color(&lights(&[(Vec3::Z, red, 0.0)])), DVec3::ONE);
}

#[test]
fn aggregate_of_two() {
    let at = DVec3::ZERO;
    let right_angle = aggregate(&lights(&[(Vec3::X, Vec3::ONE, 3.0), (Vec3::Y, Vec3::ONE, 4.0)]), at);
    assert!(right_angle.to_light.abs_diff_eq(DVec3::new(0.6, 0.8, 0.0), 1e-15));
    assert_eq!(right_angle.brightness, 5.0);
    let against = aggregate(&lights(&[(Vec3::X, Vec3::X, 1.0), (Vec3::NEG_X, Vec3::Y, 1.0)]), at);
    assert_eq!(against, Aggregate { to_light: DVec3::ZERO, brightness: 0.0, color: DVec3::new(0.5, 0.5, 0.0) });
    assert_eq!(aggregate(&[], at).color, DVec3::ONE);
}

#[test]
fn half_lambert_by_hand() {
    let (half, source) = (HalfLambert::default(), HalfLambert::SOURCE);
    for (n_dot_l, plain, squared) in [(-1.0, 0.0, 0.0), (-0.5, 0.25, 0.0625), (0.0, 0.5, 0.25), (1.0, 1.0, 1.0)] {
        assert_eq!(toon_half_lambert(&half, n_dot_l), plain);
        assert_eq!(toon_half_lambert(&source, n_dot_l), squared);
    }
    // Values below 0 are clamped before they are squared.
    let low = HalfLambert { scale: 1.0, bias: 0.0, squared: true };
    assert_eq!(toon_half_lambert(&low, -0.5), 0.0);
    assert_eq!(toon_half_lambert(&half, f64::NAN), 0.0);
    for (scale, bias) in [(0.0, 0.5), (-1.0, 0.5), (f32::NAN, 0.5), (0.5, f32::INFINITY)] {
        let parameters = HalfLambert { scale, bias, squared: false };
        assert!(matches!(parameters.validate(), Err(ToonError::HalfLambert { .. })), "{scale} {bias}");
    }
    assert_eq!(source.validate(), Ok(()));
}

#[test]
fn invalid_painters_are_rejected() {
    let painter = |lights| Painter::new(lights).map(|_| ());
    let white = Light::directional(Vec3::Z);
    assert_eq!(painter(vec![white; 3]), Err(ToonError::TooManyLights { lights: 3, max: 2 }));
    assert_eq!(
        painter(vec![white, Light::directional(Vec3::ZERO)]),
        Err(ToonError::LightDirection { index: 1, value: Vec3::ZERO })
    );
    // The squared length is not a normal f32.
    for length in [1e-20, 1e20, f32::INFINITY, f32::NAN] {
        let direction = painter(vec![Light::directional(Vec3::X * length)]);
        assert!(matches!(direction, Err(ToonError::LightDirection { index: 0, .. })), "{length}");
    }
    let nowhere = painter(vec![Light::positional(Vec3::new(0.0, f32::NAN, 0.0))]);
    assert!(matches!(nowhere, Err(ToonError::LightPosition { index: 0, .. })));
    // The squared distance overflows f32.
    let far = painter(vec![Light::positional(Vec3::Y * 1e20)]);
    assert!(matches!(far, Err(ToonError::LightPosition { index: 0, .. })));
    assert_eq!(painter(vec![Light::positional(Vec3::Y * 1e18)]), Ok(()));
    let color = Vec3::new(1.0, -0.5, 0.0);
    assert_eq!(painter(vec![Light { color, ..white }]), Err(ToonError::LightColor { index: 0, value: color }));
    let dim = |brightness| painter(vec![white, Light { brightness, ..white }]);
    assert_eq!(dim(-0.5), Err(ToonError::LightBrightness { index: 1, value: -0.5 }));
    assert!(matches!(dim(f32::NAN), Err(ToonError::LightBrightness { .. })));
    assert_eq!(dim(0.0), Ok(()));
    let scaled = |light_scale| Painter { lights: vec![white], light_scale }.validate();
    assert_eq!(scaled(-1.0), Err(ToonError::LightScale { value: -1.0 }));
    assert!(matches!(scaled(f32::NAN), Err(ToonError::LightScale { .. })));
}

#[test]
fn packs_lights() {
    let sun = Light { brightness: 0.5, ..Light::directional(Vec3::Y) };
    let lamp = Light { color: Vec3::X, ..Light::positional(Vec3::new(1.0, 2.0, 3.0)) };
    let uniform = PainterUniform::new(&Painter::new(vec![sun, lamp]).unwrap()).unwrap();
    assert_eq!((uniform.light_a, uniform.light_b), ([0.0, 1.0, 0.0, 0.0], [1.0, 2.0, 3.0, 1.0]));
    assert_eq!(uniform.brightness, [0.5, 1.0]);
    assert_eq!(uniform.light_color, [1.0, 1.0 / 3.0, 1.0 / 3.0, 0.75]);
    let one = PainterUniform::new(&Painter::new(vec![sun]).unwrap()).unwrap();
    assert_eq!((one.light_b, one.brightness), ([0.0; 4], [0.5, 0.0]));
}

fn vector() -> impl Strategy<Value = Vec3> {
    let part = -1.0_f32..1.0;
    (part.clone(), part.clone(), part)
        .prop_map(|(x, y, z)| Vec3::new(x, y, z))
        .prop_filter("has a direction", |v| v.length() > 0.01)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// The sum of unclamped diffuse terms equals the diffuse term of the aggregate for every normal.
    #[test]
    fn the_aggregate_is_exact_for_unclamped_light(
        of in prop::collection::vec((vector(), 0.0_f32..2.0), 1..5), normal in vector(), at in vector(),
    ) {
        let lights: Vec<_> = of.iter().enumerate().map(|(i, &(v, brightness))| {
            let light = if i % 2 == 0 { Light::directional(v) } else { Light::positional(v * 9.0) };
            Light { brightness, ..light }
        }).collect();
        let (normal, at) = (normal.as_dvec3(), at.as_dvec3());
        let each = lights.iter().map(|l| f64::from(l.brightness) * toon_n_dot_l(normal, toon_to_light(l.place, at)));
        let one = aggregate(&lights, at);
        prop_assert!((each.sum::<f64>() - one.brightness * toon_n_dot_l(normal, one.to_light)).abs() < 1e-9);
    }

    #[test]
    fn half_lambert_rises_from_0_to_1(a in -1.0..1.0_f64, more in 0.0..1.0_f64, squared in any::<bool>()) {
        let parameters = HalfLambert { squared, ..HalfLambert::default() };
        let (low, high) = (toon_half_lambert(&parameters, a), toon_half_lambert(&parameters, a + more));
        prop_assert!((0.0..=1.0).contains(&low) && (low..=1.0).contains(&high));
    }
}

#[test]
fn the_source_engine_keeps_a_quarter_at_the_terminator() {
    let lit = toon_half_lambert(&HalfLambert::SOURCE, toon_n_dot_l(DVec3::X, DVec3::Y));
    assert_abs_diff_eq!(lit, 0.25, epsilon = 1e-15);
}
