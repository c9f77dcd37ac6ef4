//! A ground plane at grazing angles with spheres on it: which depth test draws lines on the plane, and which loses the
//! spheres' outlines.
#![allow(clippy::print_stdout)]

use glam::{DVec3, UVec2};
use npr_imagespace::filter::depth::{BEND, ink_depth_bend, ink_depth_step};
use npr_imagespace::filter::fused::{DepthTest, FilterUniform, FusedFilter, ink_fused_hard};
use npr_imagespace::format::normal::NormalFormat;
use npr_imagespace::format::texel::{
    DepthCode, TexelLayout, ink_texel32_pack, ink_texel32_tap, ink_texel64_pack, ink_texel64_tap,
};
use npr_imagespace::picture::{Taps, filter_picture};

const SIZE: UVec2 = UVec2::new(320, 240);

/// What a pixel shows: its ray, eye-space depth (infinite for nothing), normal, and number of the surface.
#[derive(Clone, Copy)]
struct Seen {
    ray: DVec3,
    depth: f64,
    normal: DVec3,
    surface: u32,
}

/// An eye at the origin that looks down −z, and a plane that its axis meets 10 away at an angle; turned around the axis
/// by a roll, so that the plane's slope runs across the pixels. `parallel` takes the perspective away.
fn scene(grazing_deg: f64, roll_deg: f64, parallel: bool) -> Vec<Seen> {
    let (sin, cos) = grazing_deg.to_radians().sin_cos();
    let (roll_sin, roll_cos) = roll_deg.to_radians().sin_cos();
    let up = DVec3::new(-roll_sin, roll_cos, 0.0);
    let normal = up * cos + DVec3::Z * sin;
    let away = up * sin - DVec3::Z * cos;
    let across = normal.cross(away);
    // Spheres that stand on it: near, far and between, none of them in the middle.
    let spheres: Vec<(DVec3, f64)> = [(-0.6, 0.8, 0.35), (0.5, -1.5, 0.3), (1.0, 4.0, 0.6), (-1.6, 9.0, 0.9)]
        .map(|(x, along, radius)| (DVec3::NEG_Z * 10.0 + across * x + away * along + normal * radius, radius))
        .to_vec();
    let spread = 0.5 * 40f64.to_radians().tan() / 120.0;
    let mut seen = Vec::new();
    for y in 0..SIZE.y {
        for x in 0..SIZE.x {
            let (u, v) = ((f64::from(x) + 0.5 - 160.0) * spread, (120.0 - f64::from(y) - 0.5) * spread);
            let (origin, ray) = if parallel {
                (DVec3::new(10.0 * u, 10.0 * v, 0.0), DVec3::NEG_Z)
            } else {
                (DVec3::ZERO, DVec3::new(u, v, -1.0))
            };
            let mut pixel = Seen { ray, depth: f64::INFINITY, normal, surface: 0 };
            let depth = (DVec3::NEG_Z * 10.0 - origin).dot(normal) / ray.dot(normal);
            if depth > 0.0 && depth < 4000.0 {
                (pixel.depth, pixel.surface) = (depth, 1);
            }
            for (i, &(centre, radius)) in spheres.iter().enumerate() {
                let to = centre - origin;
                let (a, b, c) = (ray.length_squared(), ray.dot(to), to.length_squared() - radius * radius);
                let inside = b * b - a * c;
                let depth = (b - inside.max(0.0).sqrt()) / a;
                if inside > 0.0 && depth > 0.0 && depth < pixel.depth {
                    let normal = (origin + ray * depth - centre) / radius;
                    pixel = Seen { ray, depth, normal, surface: 2 + i as u32 };
                }
            }
            seen.push(pixel);
        }
    }
    seen
}

/// Pixels beside a jump of more than a share of the depth, or beside the background; and pixels of the plane with
/// nothing but the plane within two.
fn truth(seen: &[Seen], share: f64) -> (Vec<usize>, Vec<usize>) {
    let at = |x: i64, y: i64| {
        let inside = x >= 0 && y >= 0 && x < i64::from(SIZE.x) && y < i64::from(SIZE.y);
        inside.then(|| &seen[(y * i64::from(SIZE.x) + x) as usize])
    };
    let (mut lines, mut plain) = (Vec::new(), Vec::new());
    for y in 0..i64::from(SIZE.y) {
        for x in 0..i64::from(SIZE.x) {
            let own = at(x, y).unwrap();
            let jumps = |other: &Seen| {
                other.surface != own.surface
                    && (other.depth.is_infinite() != own.depth.is_infinite()
                        || (other.depth - own.depth).abs() > share * other.depth.max(own.depth))
            };
            let i = (y * i64::from(SIZE.x) + x) as usize;
            if [(1, 0), (0, 1)].iter().any(|&(u, v)| at(x + u, y + v).is_some_and(jumps)) {
                lines.push(i);
            }
            let all = (-2..=2).all(|v| (-2..=2).all(|u| at(x + u, y + v).is_none_or(|other| other.surface == 1)));
            if all {
                plain.push(i);
            }
        }
    }
    (lines, plain)
}

/// Share of the true lines with ink within a pixel, and the number of ink pixels on the plane.
fn judge(seen: &[Seen], ink: &[u8]) -> (f64, usize, usize) {
    let (lines, plain) = truth(seen, 0.02);
    let width = SIZE.x as usize;
    let found = lines.iter().filter(|&&i| {
        let (x, y) = (i % width, i / width);
        (y.saturating_sub(1)..=(y + 1).min(SIZE.y as usize - 1))
            .any(|v| (x.saturating_sub(1)..=(x + 1).min(width - 1)).any(|u| ink[v * width + u] > 0))
    });
    let recall = found.count() as f64 / lines.len().max(1) as f64;
    (recall, plain.iter().filter(|&&i| ink[i] > 0).count(), lines.len())
}

/// The other way: the neighbour's 1/z from the plane through the centre with its normal as a G-buffer holds it.
fn predicted(seen: &[Seen], format: NormalFormat) -> Vec<u8> {
    let stored: Vec<(Seen, DVec3)> =
        seen.iter().map(|pixel| (*pixel, format.decode(format.encode(pixel.normal.as_vec3())).as_dvec3())).collect();
    filter_picture(&stored, SIZE, Taps::Diagonal, |(centre, normal), taps| {
        let across = |(tap, _): (Seen, DVec3)| {
            if centre.surface == 0 || tap.surface == 0 {
                return centre.surface != tap.surface;
            }
            let expected = tap.ray.dot(normal) / centre.ray.dot(normal) / centre.depth;
            let inverse = 1.0 / tap.depth;
            (inverse - expected).abs() > f64::from(BEND) * inverse.max(1.0 / centre.depth)
        };
        f32::from(u8::from(taps.into_iter().any(across)))
    })
    .unwrap()
}

fn packed(seen: &[Seen], layout: TexelLayout, code: &DepthCode, filter: &FusedFilter) -> Vec<u8> {
    let uniform = FilterUniform::new(filter, layout, code).unwrap();
    let taps: Vec<_> = seen
        .iter()
        .map(|pixel| {
            let (normal, region, depth) = (pixel.normal.as_vec3(), pixel.surface.min(1), pixel.depth as f32);
            match layout {
                TexelLayout::Bits32 => ink_texel32_tap(ink_texel32_pack(normal, region, depth, code)),
                TexelLayout::Bits64 => ink_texel64_tap(ink_texel64_pack(normal, region, depth, code)),
            }
        })
        .collect();
    filter_picture(&taps, SIZE, filter.taps, |centre, taps| {
        f32::from(u8::from(ink_fused_hard(&uniform, &centre, &taps)))
    })
    .unwrap()
}

#[test]
fn a_slanted_plane_is_no_line_and_what_stands_on_it_is() {
    let bend = FusedFilter { normal_cos: None, regions: false, ..Default::default() };
    let cross = FusedFilter { taps: Taps::Cross, ..bend };
    let plain = FusedFilter { depth: Some(DepthTest { plain: true, ..Default::default() }), ..bend };
    println!("false line pixels on the plane, and recall of the spheres' outlines");
    for grazing_deg in [0.5, 1.0, 2.0, 5.0, 10.0] {
        for roll_deg in [0.0, 30.0, 45.0] {
            let seen = scene(grazing_deg, roll_deg, false);
            let depths: Vec<f32> = seen.iter().map(|pixel| pixel.depth as f32).collect();
            let float = filter_picture(&depths, SIZE, Taps::Diagonal, |centre, taps| {
                ink_depth_bend(centre, taps, f64::from(BEND), false, 0.0, 0.5) as f32
            })
            .unwrap();
            let step = filter_picture(&depths, SIZE, Taps::Diagonal, |centre, taps| {
                f32::from(u8::from(ink_depth_step(centre, taps, f64::from(BEND))))
            })
            .unwrap();
            let nearest = depths.iter().copied().fold(f32::INFINITY, f32::min);
            let codes = [TexelLayout::Bits32, TexelLayout::Bits64]
                .map(|layout| DepthCode::perspective(0.9 * nearest, f32::INFINITY, layout).unwrap());
            let results = [
                ("bend, f32", float, true),
                ("bend, wide", packed(&seen, TexelLayout::Bits64, &codes[1], &bend), true),
                ("bend, wide, cross", packed(&seen, TexelLayout::Bits64, &codes[1], &cross), true),
                ("bend, narrow", packed(&seen, TexelLayout::Bits32, &codes[0], &bend), true),
                ("step, f32", step, false),
                ("step, wide", packed(&seen, TexelLayout::Bits64, &codes[1], &plain), false),
                ("predicted, exact normals", predicted(&seen, NormalFormat::Oct16), false),
                ("predicted, 2 x 8", predicted(&seen, NormalFormat::Oct8), false),
            ];
            for (name, ink, required) in results {
                let (recall, wrong, lines) = judge(&seen, &ink);
                println!("  {grazing_deg}° roll {roll_deg}° {name}: {wrong} false, recall {recall:.3} of {lines}");
                if required {
                    assert_eq!(wrong, 0, "{grazing_deg}° {roll_deg}° {name}");
                    assert!(recall >= 0.98, "{grazing_deg}° {roll_deg}° {name}: {recall}");
                }
                if name == "step, f32" && grazing_deg <= 2.0 && roll_deg == 0.0 {
                    assert!(wrong > 1000, "the plain test does not fail: what is the other for?");
                }
            }
        }
    }
}

#[test]
fn a_slanted_plane_is_no_line_in_a_parallel_view_either() {
    for grazing_deg in [1.0, 3.0, 10.0, 40.0] {
        let seen = scene(grazing_deg, 20.0, true);
        let depths: Vec<f32> = seen.iter().map(|pixel| pixel.depth as f32).collect();
        let finite = depths.iter().copied().filter(|depth| depth.is_finite());
        let (near, far) = finite.fold((f32::INFINITY, 0f32), |(near, far), depth| (near.min(depth), far.max(depth)));
        // Reciprocals are not linear here: the test for a perspective view fails.
        let ink = |parallel: bool| {
            filter_picture(&depths, SIZE, Taps::Diagonal, |centre, taps| {
                ink_depth_bend(centre, taps, if parallel { 0.1 } else { 0.01 }, parallel, 0.0, 0.5) as f32
            })
            .unwrap()
        };
        let (recall, wrong, lines) = judge(&seen, &ink(true));
        println!("{grazing_deg}°, f32: {wrong} false, recall {recall:.3} of {lines}");
        assert!(wrong == 0 && recall >= 0.98, "{grazing_deg}° {recall}");
        let filter = FusedFilter {
            normal_cos: None,
            regions: false,
            depth: Some(DepthTest { step: 0.1, plain: false }),
            ..Default::default()
        };
        let code = DepthCode::parallel(0.9 * near, 1.1 * far, TexelLayout::Bits64).unwrap();
        let (recall, wrong, _) = judge(&seen, &packed(&seen, TexelLayout::Bits64, &code, &filter));
        assert!(wrong == 0 && recall >= 0.98, "{grazing_deg}° wide: {wrong} {recall}");
    }
}
