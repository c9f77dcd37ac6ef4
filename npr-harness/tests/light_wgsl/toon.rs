//! Checks of npr-toon: bands, borders, lights and the painter.

use crate::check::{Allowed, Check, Given, MODELS, SMALL, compare};
use crate::random::{Random, with};
use glam::{DVec2, DVec3, DVec4, Vec3, Vec4};
use npr_toon::border::toon_border_width;
use npr_toon::half_lambert::{HalfLambert, toon_half_lambert};
use npr_toon::normal::toon_piece_centroid;
use npr_toon::painter::{
    Painter, PainterUniform, toon_diffuse, toon_material, toon_overbright, toon_paint, toon_painter_uv,
};
use npr_toon::source::{Light, LightKind, toon_to_light};
use npr_toon::{
    Bands, Highlight, TOON_BANDS_OVERRIDE, ToonUniform, toon_band, toon_band_hard, toon_coverage, toon_half,
    toon_highlight, toon_n_dot_h, toon_n_dot_h_from_dots, toon_n_dot_h_interpolated, toon_n_dot_l,
    toon_n_dot_l_interpolated, toon_shade, toon_width,
};

fn xyz(v: Vec4) -> DVec3 {
    v.truncate().as_dvec3()
}

fn color(rgb: DVec3) -> DVec4 {
    rgb.extend(0.0)
}

/// A vector with the number in all components.
fn one(x: f64) -> DVec4 {
    DVec4::splat(x)
}

/// Bands with any number of tones, some with close thresholds.
fn any_bands(random: &Random, tones: u32) -> Bands {
    let mut at = random.range(-1.0, 0.2);
    let thresholds = (1..tones).map(|_| {
        let here = at;
        at = (at + random.pick(&[1e-6, 0.01, 0.1, 0.3])).max(at.next_up());
        here
    });
    let thresholds = thresholds.collect();
    let highlight = Highlight {
        threshold: random.range(0.3, 0.99),
        color: random.color(),
        strength: random.unit(),
        lit_only: random.one_in(2),
    };
    Bands {
        thresholds,
        tones: (0..tones).map(|_| random.color()).collect(),
        highlight: if random.one_in(4) { None } else { Some(highlight) },
        antialias: !random.one_in(4),
        absolute: random.one_in(4),
    }
}

fn small<M>(_: &M, _: &Given) -> Allowed {
    Allowed::Within(SMALL)
}

/// The bound is exact equality: the reference is in f64, but tones and comparisons of two f32 are exact.
fn equal<M>(_: &M, _: &Given) -> Allowed {
    Allowed::Within(0.0)
}

fn relative<M>(_: &M, _: &Given) -> Allowed {
    Allowed::Relative(SMALL)
}

/// A normal, and the directions to the light and to the eye.
fn vectors<M>(random: &Random, _: &M) -> Given {
    let normal = random.vector();
    let to_light = random.beside(normal);
    [with(normal, 0.0), with(to_light, 0.0), with(random.beside(to_light), 0.0), Vec4::ZERO]
}

/// Vectors as a rasteriser interpolates them: not longer than 1.
fn interpolated<M>(random: &Random, _: &M) -> Given {
    let shorter = with(random.direction() * random.unit(), 0.0);
    [shorter, with(random.direction(), 0.0), Vec4::ZERO, Vec4::ZERO]
}

/// Unit vectors in f32 have an error of about 4e-7, and the half vector is their normalized sum, so the error grows as
/// the sum gets shorter. Below 1e-6 it is zero; inputs are exempt if f32 may be on the other side of that.
fn half_bound<M>(_: &M, g: &Given) -> Allowed {
    let (l, e) = (xyz(g[1]).normalize_or_zero(), xyz(g[2]).normalize_or_zero());
    let length = (l + e).length();
    if length < 5e-7 {
        Allowed::Within(SMALL)
    } else if length > 5e-6 {
        Allowed::Within(SMALL + 4e-7 / length)
    } else {
        Allowed::Anything
    }
}

/// N·L at a threshold, a width, N·H likewise, a width, and the surface's colour.
fn lit(random: &Random, bands: &Bands) -> Given {
    let (nl_width, nh_width) = (random.width(), random.width());
    let n_dot_l = random.near(&bands.thresholds, nl_width);
    let n_dot_h = random.near(&[bands.highlight.map_or(0.5, |highlight| highlight.threshold)], nh_width);
    let at_zero = random.near(&[0.0], nl_width);
    let n_dot_l = if random.one_in(4) { at_zero } else { n_dot_l };
    [Vec4::new(n_dot_l, nl_width, n_dot_h, nh_width), with(random.color(), 0.0), Vec4::ZERO, Vec4::ZERO]
}

/// Barycentric coordinates, also beside the face, and a number of divisions.
fn within_a_face<M>(random: &Random, _: &M) -> Given {
    let (second, third) = (random.range(-0.1, 1.1), random.range(-0.1, 1.1));
    let divisions = (random.range(1.0, 65.0)).floor();
    [Vec4::new(1.0 - second - third, second, third, divisions), Vec4::ZERO, Vec4::ZERO, Vec4::ZERO]
}

/// Next to a border between pieces, rounding decides which piece it is.
fn piece_bound<M>(_: &M, g: &Given) -> Allowed {
    let divisions = g[0].w as f64;
    let is_near = |at: f64| (at - at.round()).abs() < 1e-4;
    let borders = [g[0].y, g[0].z, g[0].y + g[0].z].map(|at| f64::from(at) * divisions);
    if borders.into_iter().any(is_near) { Allowed::Anything } else { Allowed::Within(SMALL) }
}

/// Functions without a uniform; inputs lie at the thresholds of the bands.
const FUNCTIONS: &[Check<Bands>] = &[
    Check {
        name: "toon_piece_centroid",
        wgsl: "vec4(toon_piece_centroid(a.xyz, u32(a.w)), 0.0)",
        given: within_a_face,
        rust: |_, g| toon_piece_centroid(xyz(g[0]), g[0].w as u32).extend(0.0),
        allowed: piece_bound,
    },
    Check {
        name: "toon_unit",
        wgsl: "vec4(toon_unit(a.xyz), 0.0)",
        given: vectors,
        rust: |_, g| color(xyz(g[0]).normalize_or_zero()),
        allowed: small,
    },
    Check {
        name: "toon_n_dot_l",
        wgsl: "vec4(toon_n_dot_l(a.xyz, b.xyz))",
        given: vectors,
        rust: |_, g| one(toon_n_dot_l(xyz(g[0]), xyz(g[1]))),
        allowed: small,
    },
    Check {
        name: "toon_n_dot_l_interpolated",
        wgsl: "vec4(toon_n_dot_l_interpolated(a.xyz, b.xyz))",
        given: interpolated,
        rust: |_, g| one(toon_n_dot_l_interpolated(xyz(g[0]), xyz(g[1]))),
        allowed: small,
    },
    Check {
        name: "toon_half",
        wgsl: "vec4(toon_half(b.xyz, c.xyz), 0.0)",
        given: vectors,
        rust: |_, g| color(toon_half(xyz(g[1]), xyz(g[2]))),
        allowed: half_bound,
    },
    Check {
        name: "toon_n_dot_h",
        wgsl: "vec4(toon_n_dot_h(a.xyz, b.xyz, c.xyz))",
        given: vectors,
        rust: |_, g| one(toon_n_dot_h(xyz(g[0]), xyz(g[1]), xyz(g[2]))),
        allowed: half_bound,
    },
    Check {
        name: "toon_n_dot_h_interpolated",
        wgsl: "vec4(toon_n_dot_h_interpolated(a.xyz, b.xyz))",
        given: interpolated,
        rust: |_, g| one(toon_n_dot_h_interpolated(xyz(g[0]), xyz(g[1]))),
        allowed: small,
    },
    Check {
        name: "toon_n_dot_h_from_dots",
        wgsl: "vec4(toon_n_dot_h_from_dots(a.x, a.y, a.z))",
        // Dot products as in a shader, each rounded, so that L.E may be below -1.
        given: |random, bands| {
            let [n, l, e, _] = vectors(random, bands);
            let [n, l, e] = [n, l, e].map(|v| xyz(v).normalize_or(DVec3::X));
            let l_dot_e = (l.dot(e) as f32 * random.pick(&[1.0, 1.0 + f32::EPSILON])).min(1.0);
            [Vec4::new(n.dot(l) as f32, n.dot(e) as f32, l_dot_e, 0.0); 4]
        },
        rust: |_, g| one(toon_n_dot_h_from_dots(f64::from(g[0].x), f64::from(g[0].y), f64::from(g[0].z))),
        // The sum in the numerator is rounded to f32; see `half_bound`.
        allowed: |_, g| {
            let length = (2.0 + 2.0 * f64::from(g[0].z)).max(0.0).sqrt();
            Allowed::Within(if length > 0.0 { SMALL + 1e-7 / length } else { SMALL })
        },
    },
    Check {
        name: "toon_width",
        wgsl: "vec4(toon_width(a.x, a.y))",
        // Within the range whose squares f32 can represent.
        given: |random, _| {
            let part = || random.pick(&[0.0, 1.0, -1.0]) * random.log_range(1e-15, 1e15);
            [Vec4::new(part(), part(), 0.0, 0.0); 4]
        },
        rust: |_, g| one(toon_width(f64::from(g[0].x), f64::from(g[0].y))),
        allowed: relative,
    },
    Check {
        name: "toon_border_width",
        wgsl: "vec4(toon_border_width(a.x, a.y))",
        // Of any size: a number whose square overflows exceeds a limit.
        given: |random, _| {
            let part = || {
                let size = random.log_range(1e-37, 1e37);
                random.pick(&[0.0, size, -random.log_range(1e-5, 1.0), random.log_range(1e-5, 1.0), f32::MAX])
            };
            [Vec4::new(part(), part(), 0.0, 0.0); 4]
        },
        rust: |_, g| one(toon_border_width(f64::from(g[0].x), f64::from(g[0].y))),
        allowed: relative,
    },
    Check {
        name: "toon_coverage",
        wgsl: "vec4(toon_coverage(a.x, b.x, a.y))",
        given: |random, bands| {
            let [a, ..] = lit(random, bands);
            let threshold = if random.one_in(4) { a.x } else { random.near(&[a.x], a.y) };
            [a, Vec4::splat(threshold), Vec4::ZERO, Vec4::ZERO]
        },
        rust: |_, g| one(toon_coverage(f64::from(g[0].x), f64::from(g[1].x), f64::from(g[0].y))),
        // Small widths amplify no errors: x, threshold and width are f32 already, and the difference of two close f32
        // is exact.
        allowed: small,
    },
    Check {
        name: "toon_coverage, up to MIN_WIDTH",
        wgsl: "vec4(toon_coverage(a.x, b.x, a.y))",
        given: |random, bands| {
            let [a, ..] = lit(random, bands);
            let width = random.pick(&[0.0, f32::MIN_POSITIVE, 1e-9, f32::EPSILON]);
            [Vec4::new(a.x, width, 0.0, 0.0), Vec4::splat(random.near(&[a.x], 1e-6)), Vec4::ZERO, Vec4::ZERO]
        },
        rust: |_, g| one(toon_coverage(f64::from(g[0].x), f64::from(g[1].x), f64::from(g[0].y))),
        allowed: equal,
    },
    Check {
        name: "toon_step",
        wgsl: "vec4(toon_step(b.rgb, c.rgb, a.z, a.x, a.y), 0.0)",
        given: |random, bands| {
            let [a, b, ..] = lit(random, bands);
            [a, b, with(random.color(), 0.0), Vec4::ZERO]
        },
        // Bands with one border.
        rust: |_, g| {
            let tones = vec![g[1].truncate(), g[2].truncate()];
            let bands = Bands { thresholds: vec![g[0].z], tones, highlight: None, antialias: true, absolute: false };
            color(toon_band(&bands, f64::from(g[0].x), f64::from(g[0].y)))
        },
        allowed: small,
    },
    Check {
        name: "toon_half_lambert",
        wgsl: "vec4(toon_half_lambert(b.x, b.y, u32(b.z), a.x))",
        given: |random, bands| {
            let [a, ..] = lit(random, bands);
            let how = random.pick(&[HalfLambert::HALF_LIFE, HalfLambert::SOURCE]);
            let (scale, bias) = (random.log_range(0.01, 4.0), random.range(-1.0, 1.0));
            let how = if random.one_in(2) { how } else { HalfLambert { scale, bias, ..how } };
            [a, Vec4::new(how.scale, how.bias, f32::from(u8::from(how.squared)), 0.0), Vec4::ZERO, Vec4::ZERO]
        },
        rust: |_, g| {
            let how = HalfLambert { scale: g[1].x, bias: g[1].y, squared: g[1].z != 0.0 };
            one(toon_half_lambert(&how, f64::from(g[0].x)))
        },
        allowed: small,
    },
];

const BANDS: &[Check<Bands>] = &[
    Check {
        name: "toon_band, width 0",
        wgsl: "vec4(toon_band(u, a.x, 0.0), 0.0)",
        given: lit,
        rust: |bands, g| color(toon_band_hard(bands, f64::from(g[0].x))),
        // Also at every threshold, and a rounding error away.
        allowed: equal,
    },
    Check {
        name: "toon_band, width 0, of toon_n_dot_l",
        wgsl: "vec4(toon_band(u, toon_n_dot_l(a.xyz, b.xyz), 0.0), 0.0)",
        given: |random, bands| {
            // N·L is as often within 1e-5 of a threshold as within 1e-4 but not that, and so on.
            let n = random.direction();
            let side = n.any_orthonormal_vector();
            let place = if bands.thresholds.is_empty() { 0.0 } else { random.pick(&bands.thresholds) };
            let off = random.pick(&[-1.0, 1.0]) * random.log_range(5e-6, 1.0);
            let target = (place + off).clamp(-1.0, 1.0);
            let to_light = n * target + side * (1.0 - target * target).sqrt();
            [with(n * random.log_range(1e-3, 1e3), 0.0), with(to_light, 0.0), Vec4::ZERO, Vec4::ZERO]
        },
        rust: |bands, g| color(toon_band_hard(bands, toon_n_dot_l(xyz(g[0]), xyz(g[1])))),
        // Here N·L is computed, so it may be on the other side of a threshold.
        allowed: |bands, g| {
            let n_dot_l = toon_n_dot_l(xyz(g[0]), xyz(g[1]));
            let near = bands.thresholds.iter().any(|&t| (n_dot_l - f64::from(t)).abs() < SMALL);
            if near { Allowed::Anything } else { equal(bands, g) }
        },
    },
    Check {
        name: "toon_band",
        wgsl: "vec4(toon_band(u, a.x, a.y), 0.0)",
        given: lit,
        rust: |bands, g| color(toon_band(bands, f64::from(g[0].x), f64::from(g[0].y))),
        allowed: small,
    },
    Check {
        name: "toon_highlight",
        wgsl: "vec4(toon_highlight(u.highlight.w, u.highlight_strength, u.highlight_lit_only, a.x, a.y, a.z, a.w))",
        given: lit,
        rust: |bands, g| {
            let [n_dot_l, nl_width, n_dot_h, nh_width] = g[0].as_dvec4().to_array();
            one(toon_highlight(bands, n_dot_l, nl_width, n_dot_h, nh_width))
        },
        allowed: small,
    },
    Check {
        name: "toon_shade",
        wgsl: "vec4(toon_shade(u, b.rgb, a.x, a.y, a.z, a.w), 0.0)",
        given: lit,
        rust: |bands, g| {
            let [n_dot_l, nl_width, n_dot_h, nh_width] = g[0].as_dvec4().to_array();
            color(toon_shade(bands, xyz(g[1]), n_dot_l, nl_width, n_dot_h, nh_width))
        },
        allowed: small,
    },
];

/// Up to two lights, near or far, and the range of points.
fn any_painter(random: &Random) -> Painter {
    let count = random.below(3);
    let light = |_| {
        let place = if random.one_in(2) {
            LightKind::Directional { to_light: random.direction() * random.log_range(1e-3, 1e3) }
        } else {
            LightKind::Positional { position: random.direction() * random.log_range(0.1, 1e4) }
        };
        Light { place, color: random.color(), brightness: random.pick(&[0.0, 1.0, random.range(0.0, 2.0)]) }
    };
    let lights = (0..count).map(light).collect();
    Painter { lights, light_scale: random.pick(&[Painter::LIGHT_SCALE, 0.5, random.unit()]) }
}

/// A point, sometimes at or near a light, and a normal.
fn point(random: &Random, painter: &Painter) -> Given {
    let light = painter.lights.first().map(|light| light.place);
    let position = if let Some(LightKind::Positional { position }) = light { position } else { Vec3::ZERO };
    let at = match random.below(6) {
        0 => position,
        1 => position + random.direction() * random.log_range(1e-5, 1.0),
        2 => random.direction() * 1e4,
        _ => random.direction() * random.range(0.0, 5.0),
    };
    [with(at, 0.0), with(random.vector(), 0.0), Vec4::ZERO, Vec4::ZERO]
}

fn surface(random: &Random, _: &Painter) -> Given {
    let any = || with(random.color(), random.pick(&[0.0, 0.5, 0.5_f32.next_up(), random.unit()]));
    [any(), any(), any(), Vec4::ZERO]
}

const PAINTER: &[Check<Painter>] = &[
    Check {
        name: "toon_to_light",
        wgsl: "vec4(toon_to_light(b, a.xyz), 0.0)",
        given: |random, painter| {
            let [at, normal, ..] = point(random, painter);
            let position = random.pick(&[at, with(random.direction() * 3.0, 0.0)]).truncate();
            let place = if random.one_in(2) { with(normal.truncate(), 0.0) } else { with(position, 1.0) };
            [at, place, Vec4::ZERO, Vec4::ZERO]
        },
        rust: |_, g| {
            let v = g[1].truncate();
            let positional = LightKind::Positional { position: v };
            let place = if g[1].w == 0.0 { LightKind::Directional { to_light: v } } else { positional };
            color(toon_to_light(place, xyz(g[0])))
        },
        allowed: small,
    },
    Check {
        name: "toon_diffuse",
        wgsl: "vec4(toon_diffuse(a.x, a.y))",
        given: |random, _| [Vec4::new(random.range(-1.0, 1.0), random.range(0.0, 2.0), 0.0, 0.0); 4],
        rust: |_, g| one(toon_diffuse(f64::from(g[0].x), f64::from(g[0].y))),
        allowed: small,
    },
    Check {
        name: "toon_painter_uv",
        wgsl: "vec4(toon_painter_uv(u, a.xyz, b.xyz), 0.0, 0.0)",
        given: point,
        rust: |painter, g| {
            let uv: DVec2 = toon_painter_uv(painter, xyz(g[0]), xyz(g[1]));
            uv.extend(0.0).extend(0.0)
        },
        allowed: small,
    },
    Check {
        name: "toon_material",
        wgsl: "toon_material(a, b)",
        given: surface,
        rust: |_, g| toon_material(g[0].as_dvec4(), g[1].as_dvec4()),
        allowed: equal,
    },
    Check {
        name: "toon_overbright",
        wgsl: "vec4(toon_overbright(a.rgb, b.rgb, c.w), 0.0)",
        given: surface,
        rust: |_, g| color(toon_overbright(xyz(g[0]), xyz(g[1]), f64::from(g[2].w))),
        allowed: small,
    },
    Check {
        name: "toon_paint",
        wgsl: "toon_paint(u, a.rgb, b)",
        given: surface,
        rust: |painter, g| toon_paint(painter, xyz(g[0]), g[1].as_dvec4()),
        allowed: small,
    },
];

pub fn calls() -> Vec<&'static str> {
    let bands = FUNCTIONS.iter().chain(BANDS).map(|check| check.wgsl);
    bands.chain(PAINTER.iter().map(|check| check.wgsl)).collect()
}

fn pack(bands: &Bands) -> ToonUniform {
    ToonUniform::new(bands).expect("they are valid")
}

#[test]
fn bands_are_their_reference() {
    let Some(gpu) = crate::device() else { return };
    let random = Random::new(3);
    let presets =
        [Bands::hard_shading(), Bands::three_diffuse_bands(), Bands::diffuse_and_specular(), Bands::default()];
    let others = (presets.len()..MODELS).map(|number| any_bands(&random, number as u32 % 8 + 1));
    let models: Vec<_> = presets.into_iter().chain(others).collect();
    for checks in [FUNCTIONS, BANDS] {
        compare(&gpu, npr_toon::WGSL, "ToonBands", &[], &models, pack, checks);
    }
}

#[test]
fn bands_with_their_number_set_are_their_reference() {
    let Some(gpu) = crate::device() else { return };
    for count in [1, 3] {
        println!("{TOON_BANDS_OVERRIDE} = {count}");
        let random = Random::new(4);
        let models: Vec<_> = (0..MODELS).map(|_| any_bands(&random, count)).collect();
        let constants = [(TOON_BANDS_OVERRIDE, f64::from(count))];
        compare(&gpu, npr_toon::WGSL, "ToonBands", &constants, &models, pack, BANDS);
    }
}

#[test]
fn the_painter_is_its_reference() {
    let Some(gpu) = crate::device() else { return };
    let random = Random::new(5);
    let models: Vec<_> = (0..MODELS).map(|_| any_painter(&random)).collect();
    let pack = |painter: &Painter| PainterUniform::new(painter).expect("it is valid");
    compare(&gpu, npr_toon::WGSL, "ToonPainter", &[], &models, pack, PAINTER);
}
