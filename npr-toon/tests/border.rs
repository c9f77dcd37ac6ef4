//! Border widths, and lighting from interpolated normals.

use approx::assert_abs_diff_eq;
use glam::{DVec2, DVec3};
use npr_toon::border::*;
use npr_toon::normal::*;
use npr_toon::*;

#[test]
fn widths_stay_within_limits() {
    assert_eq!(toon_border_width(0.03, -0.04), toon_width(0.03, -0.04));
    assert_eq!(toon_border_width(3.0, -4.0), 0.5);
    assert_eq!(toon_border_width(f64::NEG_INFINITY, 0.0), 0.5);
    assert_eq!(toon_border_width(f64::NAN, 0.0), MIN_BORDER);
    assert_eq!(toon_border_width(0.0, 0.0), 2.0_f64.powi(-14));
}

/// A sphere in orthographic projection along -Z. Positions are in pixels from its centre.
struct Sphere {
    radius: f64,
    to_light: DVec3,
}

impl Sphere {
    fn normal(&self, at: DVec2) -> Option<DVec3> {
        let at = at / self.radius;
        let squared = 1.0 - at.length_squared();
        (squared > 0.0).then(|| at.extend(squared.sqrt()))
    }

    fn n_dot_l(&self, at: DVec2) -> Option<f64> {
        self.normal(at).map(|normal| toon_n_dot_l(normal, self.to_light))
    }

    /// The derivatives of N·L along x and y. The surface continues beyond the outline as its tangent plane, as GPUs
    /// extrapolate triangles.
    fn derivatives(&self, at: DVec2) -> Option<DVec2> {
        let (normal, l) = (self.normal(at)?, self.to_light.normalize());
        Some((l.truncate() - l.z * normal.truncate() / normal.z) / self.radius)
    }
}

fn bands() -> Bands {
    Bands { highlight: None, ..Bands::default() }
}

/// The red component of a pixel with a limited border width, and its mean over the covered part of the pixel.
fn shaded_and_true(sphere: &Sphere, at: DVec2, limit: f64) -> Option<(f64, f64)> {
    let slope = sphere.derivatives(at)?;
    let width = toon_width(slope.x, slope.y).min(limit);
    let shaded = toon_band(&bands(), sphere.n_dot_l(at)?, width).x;
    let (mut sum, mut count) = (0.0, 0.0);
    for i in 0..16 {
        for j in 0..16 {
            let offset = DVec2::new(f64::from(i) + 0.5, f64::from(j) + 0.5) / 16.0 - 0.5;
            if let Some(n_dot_l) = sphere.n_dot_l(at + offset) {
                sum += toon_band_hard(&bands(), n_dot_l).x;
                count += 1.0;
            }
        }
    }
    Some((shaded, sum / count))
}

/// The maximum and the root mean square error of the frame-to-frame change of a pixel while a sphere moves by 1/16 pixel
/// per frame.
fn flicker(radius: f64, limit: f64) -> (f64, f64) {
    let sphere = Sphere { radius, to_light: DVec3::new(-0.5, 0.7, 0.6) };
    let (mut most, mut sum, mut count) = (0.0_f64, 0.0, 0.0);
    let extent = radius as i32 + 2;
    for y in -extent..=extent {
        for x in -extent..=extent {
            let mut before = None;
            for frame in 0..16 {
                let at = DVec2::new(f64::from(x) + f64::from(frame) / 16.0, f64::from(y) + 0.3);
                let now = shaded_and_true(&sphere, at, limit);
                if let (Some((shaded, truth)), Some((shaded_before, truth_before))) = (now, before) {
                    let off: f64 = (shaded - shaded_before) - (truth - truth_before);
                    most = most.max(off.abs());
                    sum += off * off;
                    count += 1.0;
                }
                before = now;
            }
        }
    }
    (most, f64::sqrt(sum / count))
}

#[test]
fn the_width_limit_removes_flicker_on_small_models() {
    let (unlimited, limited) = (flicker(4.0, f64::INFINITY), flicker(4.0, MAX_BORDER));
    assert!(unlimited.0 > 0.15 && unlimited.1 > 0.010, "{unlimited:?}");
    assert!(limited.0 < 0.05 && limited.1 < 0.005, "{limited:?}");
    // With a smaller limit it returns.
    let tight = flicker(4.0, MAX_BORDER / 4.0);
    assert!(tight.0 > 0.1 && tight.1 > 0.008, "{tight:?}");
}

#[test]
fn at_the_outline_tones_are_not_mixed_into_one() {
    // 1/10,000 pixel inside the outline, in the lightest band.
    let sphere = Sphere { radius: 50.0, to_light: DVec3::new(0.6, 0.0, 0.8) };
    let at = DVec2::new(49.9999, 0.0);
    let (slope, n_dot_l) = (sphere.derivatives(at).unwrap(), sphere.n_dot_l(at).unwrap());
    assert_eq!(toon_band_hard(&bands(), n_dot_l).x, 1.0);
    // Without a limit, close to the mean of the darkest and the lightest tone.
    assert_abs_diff_eq!(toon_band(&bands(), n_dot_l, toon_width(slope.x, slope.y)).x, 0.75, epsilon = 0.02);
    assert!(toon_band(&bands(), n_dot_l, toon_border_width(slope.x, slope.y)).x > 0.9);
}

#[test]
fn borders_are_a_pixel_wide_at_any_distance() {
    // Along the line from the centre to the light, the transition from dark to lit is one pixel wide.
    for radius in [4.0, 20.0, 300.0, 5000.0] {
        let sphere = Sphere { radius, to_light: DVec3::X };
        let bands = Bands { thresholds: vec![0.3], tones: vec![glam::Vec3::ZERO, glam::Vec3::ONE], ..bands() };
        let gray = |x: f64| {
            let at = DVec2::new(x, 0.0);
            let slope = sphere.derivatives(at).unwrap();
            toon_band(&bands, sphere.n_dot_l(at).unwrap(), toon_border_width(slope.x, slope.y)).x
        };
        let border = f64::from(0.3_f32) * radius;
        assert_abs_diff_eq!(gray(border), 0.5, epsilon = 1e-9);
        assert_abs_diff_eq!(gray(border + 0.25), 0.75, epsilon = 1e-3);
        assert_eq!((gray(border - 0.51), gray(border + 0.51)), (0.0, 1.0), "{radius}");
    }
}

#[test]
fn a_flat_face_at_a_threshold_has_one_tone() {
    // N·L within a few f32 rounding errors of the threshold.
    let width = toon_border_width(0.0, 0.0);
    let bands = bands();
    let tones = (-4..=4).map(|step| f64::from(0.55_f32) + f64::from(step) * f64::from(f32::EPSILON));
    let (soft, hard): (Vec<_>, Vec<_>) =
        tones.map(|n_dot_l| (toon_band(&bands, n_dot_l, width).x, toon_band_hard(&bands, n_dot_l).x)).unzip();
    let spread = |of: &[f64]| of.iter().fold(0.0_f64, |most, &x| most.max((x - of[0]).abs()));
    assert!(spread(&soft) < 1.0 / 255.0 && spread(&hard) > 0.1);
}

#[test]
fn interpolated_normals_are_too_short() {
    // Two normals at an angle of 60 degrees, and a light in the direction of their mean.
    let (sin, cos) = (0.5, 3.0_f64.sqrt() / 2.0);
    let normals = [DVec3::new(-sin, 0.0, cos), DVec3::new(sin, 0.0, cos) * 7.0, DVec3::Z];
    let across = |normal_use, weights| toon_n_dot_l_across(normal_use, DVec3::Z, normals, [DVec3::Z * 3.0; 3], weights);
    let middle = [0.5, 0.5, 0.0];
    assert_abs_diff_eq!(across(NormalUse::PerPixel, middle), 1.0, epsilon = 1e-15);
    assert_abs_diff_eq!(across(NormalUse::Interpolated, middle), cos, epsilon = 1e-15);
    assert_abs_diff_eq!(across(NormalUse::PerVertex, middle), cos, epsilon = 1e-15);
    // Card & Mitchell's bright band begins 22.5 degrees from the light instead of 36.9.
    assert_abs_diff_eq!((0.8 / cos).acos().to_degrees(), 22.52, epsilon = 0.01);
    // At a vertex all variants agree.
    for normal_use in [NormalUse::PerVertex, NormalUse::Interpolated, NormalUse::PerPixel] {
        assert_abs_diff_eq!(across(normal_use, [0.0, 1.0, 0.0]), cos, epsilon = 1e-15);
    }
}

#[test]
fn lighting_per_vertex_misses_a_light_close_to_a_face() {
    // A light close to the centre of a flat triangle: N·L is small at every corner.
    let corners = [DVec3::new(-1.0, 0.0, 0.0), DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.0, 2.0, 0.0)];
    let centre = corners.iter().sum::<DVec3>() / 3.0;
    let to_lights = corners.map(|corner| centre + DVec3::Z * 0.1 - corner);
    let across = |normal_use| toon_n_dot_l_across(normal_use, DVec3::Z, [DVec3::Z; 3], to_lights, [1.0 / 3.0; 3]);
    assert!(across(NormalUse::PerVertex) < 0.1);
    assert!(across(NormalUse::Interpolated) < 0.1);
    assert!(across(NormalUse::PerPixel) > 0.8);
    assert_eq!(toon_n_dot_l_across(NormalUse::PerPixel, DVec3::Z, [DVec3::ZERO; 3], to_lights, [1.0 / 3.0; 3]), 0.0);
}
