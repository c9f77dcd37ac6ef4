//! Smooth and faceted surfaces under a threshold of normals, and models far away.

use crate::camera::{Camera, Framing};
use crate::capabilities::Capabilities;
use crate::check::{Limit as Bound, WITHIN_PX, one_px_style};
use crate::cpu::{self, CpuOptions};
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::image_lines::{ImageInk, Regions};
use crate::picture::Image;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::stability::ink::{
    ahead, beside, black_edges, crossing, curve, drawn, enlarged, faceted, ink, last_above, limit_at, parallel,
    picture_of,
};
use crate::stability::{Axis, Finding, Sweep};
use crate::style::Lines;
use crate::truth::lines::{accuracy, drawn_centreline, true_lines};
use crate::view::View;
use glam::{DVec2, DVec3, UVec2};
use npr_imagespace::filter::fused::FusedFilter;
use npr_imagespace::filter::inker::Inker;
use npr_imagespace::filter::normal::{NORMAL_COS_CARD_MITCHELL, NORMAL_COS_OUTLINING_SKETCH};
use npr_imagespace::filter::printed::ink_printed_inker;
use npr_imagespace::format::printed::{CLEAR, ink_printed_encode};
use npr_imagespace::format::texel::ink_texel64_tap;
use npr_imagespace::picture::{Taps, filter_picture};
use npr_mesh::{Model, embedded};
use npr_outline::LineKind;

pub(super) const FACETS: Sweep = Sweep {
    name: "facets-become-lines",
    technique: "image lines",
    what: "A round surface of flat faces has a line between any two whose normals differ by more than the threshold: one of \
           few segments is crossed by the borders of its tessellation.",
    needs_adapter: false,
    run: facets,
};

pub(super) const DISTANT_BALL: Sweep = Sweep {
    name: "distant-ball",
    technique: "image lines",
    what: "Far away, neighbouring pixels of a smooth surface differ by more than the threshold, and it fills with ink. The \
           inker compares pixels two apart, and lowers its threshold with depth.",
    needs_adapter: false,
    run: distant_ball,
};

pub(super) const MODEL_SIZE: Sweep = Sweep {
    name: "model-size",
    technique: "image lines",
    what: "Lines have the same width at any size of the model, and a filter's are two pixels wide: a small model is a blot.",
    needs_adapter: false,
    run: model_size,
};

/// The sides of a prism, each with a flat normal.
fn prism(sides: u32) -> Model {
    let round = embedded::cylinder(sides);
    faceted(&round.positions, &round.faces[..2 * sides as usize])
}

/// Only borders of normals and of the background.
fn by_normals(normal_cos: f32) -> Lines {
    let filter = FusedFilter { normal_cos: Some(normal_cos), depth: None, regions: false, ..FusedFilter::default() };
    Lines::image(ImageInk { filter, regions: Regions::One, ..ImageInk::default() })
}

fn facets(executor: &Executor) -> Result<Finding, HarnessError> {
    const SIZE: (u32, u32) = (128, 96);
    // From the front, turned a little so that no face is edge-on for every number of sides.
    let camera = Camera { eye: DVec3::new(9.0, 0.0, 99.0), ..parallel(2.6) };
    let view = View::new(camera, SIZE);
    let mut curves = Vec::new();
    for (name, cos) in [("threshold 0.80", NORMAL_COS_OUTLINING_SKETCH), ("threshold 0.85", NORMAL_COS_CARD_MITCHELL)] {
        let mut points = Vec::new();
        for sides in 4..=20 {
            let scene = Scene::new(prism(sides));
            let mut truth = true_lines(&scene, &camera, SIZE, 1e-3);
            truth.segments.retain(|segment| segment.kind == LineKind::Crease);
            let found = drawn_centreline(&ink(executor, &scene, by_normals(cos), view)?, SIZE.0, SIZE.1);
            points.push((f64::from(sides), 100.0 * accuracy(&truth, &found, WITHIN_PX).recall));
        }
        let predicted = (360.0 / f64::from(cos).acos().to_degrees()).floor();
        let what = "largest number of sides between which there are lines";
        let limit = limit_at(what, last_above(&points, 50.0), Bound::AtMost(predicted));
        curves.push(curve(
            name,
            points,
            limit.predicted(predicted, "⌊360° / acos t⌋: sides turn by 360° over their number"),
        ));
    }
    let small = View::new(camera, (104, 96));
    let picture =
        |sides| drawn(executor, &Scene::new(prism(sides)), by_normals(NORMAL_COS_OUTLINING_SKETCH), small, 1.0);
    Ok(Finding {
        parameter: Axis::linear("sides of a prism", ""),
        error: Axis::linear("borders between sides that are lines", "%"),
        curves,
        pictures: vec![(
            "Prisms of 8, 9 and 10 sides by a threshold of normals of 0.80.".into(),
            beside(&[picture(8)?, picture(9)?, picture(10)?]),
        )],
    })
}

/// The field of view of [`distant_ball`], and the size of its picture.
const BALL_FOV_RAD: f64 = 0.5;
const BALL_SIZE: (u32, u32) = (128, 128);
/// The share of the ball's radius within which it is smooth.
const INNER: f64 = 0.7;

/// Distance of a ball of radius 1 whose radius is some px.
fn ball_distance(radius_px: f64) -> f64 {
    f64::from(BALL_SIZE.1) / 2.0 / (BALL_FOV_RAD / 2.0).tan() / radius_px
}

/// The ball's ink by the inker on bytes, with depths up to `far`.
fn inked_ball(scene: &Scene, inker: &Inker, radius_px: f64, far: f64) -> Result<Vec<u8>, HarnessError> {
    let camera = Camera { eye: DVec3::Z * ball_distance(radius_px), ..ahead(BALL_FOV_RAD, 0.1) };
    let style = one_px_style(Lines::image(ImageInk::default()));
    let plan = Plan::new(scene, &style, &View::new(camera, BALL_SIZE), &Capabilities::RAY_CASTER)?;
    let Some(image) = &plan.image else { return Ok(Vec::new()) };
    let frame = cpu::render(scene, &plan, &CpuOptions::default(), &|_| {});
    let bytes = |&words: &[u32; 2]| {
        let tap = ink_texel64_tap(words);
        if tap.region == 0 {
            return CLEAR;
        }
        ink_printed_encode(tap.normal.as_vec3().normalize_or_zero(), (image.code.depth(tap.depth as u32) / far) as f32)
    };
    let bytes: Vec<[u8; 4]> = frame.texels.iter().map(bytes).collect();
    Ok(filter_picture(&bytes, UVec2::from(BALL_SIZE), Taps::Diagonal, |_, taps| ink_printed_inker(inker, taps) as f32)?)
}

/// The share, %, of the pixels well within a ball that have ink.
fn inner_share(ink: &[u8], radius_px: f64) -> f64 {
    let middle = DVec2::new(f64::from(BALL_SIZE.0), f64::from(BALL_SIZE.1)) / 2.0;
    let at = |pixel: u32| DVec2::new(f64::from(pixel % BALL_SIZE.0), f64::from(pixel / BALL_SIZE.0)) + 0.5;
    let inner: Vec<bool> = ink
        .iter()
        .zip(0u32..)
        .filter(|&(_, pixel)| at(pixel).distance(middle) < INNER * radius_px)
        .map(|(&ink, _)| ink > 127)
        .collect();
    100.0 * inner.iter().filter(|&&ink| ink).count() as f64 / inner.len() as f64
}

/// The radius, px, at which the inker's normal term reaches its threshold on a diagonal through the ball's middle, at the
/// radius within which a tenth of the inner pixels lies outside. The taps are √2 px to either side of the pixel, along the
/// diagonal and across it.
fn predicted_radius(threshold: impl Fn(f64) -> f64) -> f64 {
    let is_ink = |radius_px: f64| {
        let (at, step) = (0.9f64.sqrt() * INNER, 2f64.sqrt() / radius_px);
        let normal = |x: f64, y: f64| DVec3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt()).normalize();
        let similar = |a: DVec3, b: DVec3| (4.0 * (a.dot(b) - threshold(radius_px))).clamp(0.0, 1.0);
        let along = similar(normal(at - step, 0.0), normal(at + step, 0.0));
        let across = similar(normal(at, step), normal(at, -step));
        // Ink where 1 − sat(4 N₀ N₁) > ½.
        along * across < 0.125
    };
    let (mut small, mut large) = (2.5, 1000.0);
    while large - small > 1e-3 {
        let middle = 0.5 * (small + large);
        if is_ink(middle) { small = middle } else { large = middle }
    }
    large
}

fn distant_ball(_: &Executor) -> Result<Finding, HarnessError> {
    let scene = Scene::new(embedded::sphere(96));
    let radii_px = [4.0, 5.0, 6.0, 7.0, 8.0, 10.0, 12.0, 14.0, 17.0, 20.0, 25.0, 32.0, 40.0];
    let far = ball_distance(radii_px[0]);
    let constant = Inker { normal_fall: 0.0, ..Inker::default() };
    let cases = [
        ("constant threshold 0.9", constant, far),
        ("0.9 − 0.25 depth, as printed", Inker::default(), far),
        ("the same, far plane four times as far", Inker::default(), 4.0 * far),
    ];
    let mut curves = Vec::new();
    for (name, inker, far) in cases {
        let mut points = Vec::new();
        for radius_px in radii_px {
            points.push((radius_px, inner_share(&inked_ball(&scene, &inker, radius_px, far)?, radius_px)));
        }
        let predicted = predicted_radius(|radius_px| {
            let depth = ball_distance(radius_px) / far;
            f64::from(inker.normal_cos) - f64::from(inker.normal_fall) * depth.min(1.0)
        });
        let measured = crossing(&points, 10.0);
        let limit = limit_at(
            "radius of a ball below which a tenth of its inside is ink, px",
            measured,
            Bound::AtMost(1.1 * predicted),
        );
        let formula =
            "N₀ N₁ = ⅛ for normals √2 px to either side, on a diagonal at √0.9 · 0.7 of the radius (listing 4)";
        curves.push(curve(name, points, limit.predicted(predicted, formula)));
    }
    let picture = |inker: &Inker| -> Result<Image, HarnessError> {
        let ink = inked_ball(&scene, inker, 10.0, far)?;
        Ok(enlarged(&picture_of(&ink, BALL_SIZE.0), [51, 51, 26, 26], 6))
    };
    let pictures = [picture(&constant)?, picture(&Inker::default())?];
    Ok(Finding {
        parameter: Axis::logarithmic("radius of a ball", "px"),
        error: Axis::linear("its inside inked", "%"),
        curves,
        pictures: vec![(
            "A ball of 10 px radius, enlarged six times: the inker with a constant threshold, and with one that falls with \
             depth."
                .into(),
            beside(&pictures),
        )],
    })
}

fn model_size(executor: &Executor) -> Result<Finding, HarnessError> {
    const SIZE: (u32, u32) = (208, 208);
    let scene = Scene::new(embedded::teapot(5));
    let view_of = |size_px: f64| {
        let fit = Framing { distance: 0.9 * f64::from(SIZE.1) / size_px, fov_y_rad: None, ..Framing::default() };
        View::new(Camera::framed(scene.corners(), 1.0, &fit), SIZE)
    };
    let methods = [("image lines", Lines::image(ImageInk::default())), ("edge lines", black_edges(1.0))];
    let sizes_px = [12.0, 16.0, 24.0, 32.0, 48.0, 64.0, 96.0, 128.0, 180.0];
    // The area that the model covers, px, and the length of its lines, which grow with its size and with its square.
    let covered = |view: View| -> Result<f64, HarnessError> {
        let plan = Plan::new(&scene, &one_px_style(Lines::NONE), &view, &Capabilities::RAY_CASTER)?;
        let frame = cpu::render(&scene, &plan, &CpuOptions::default(), &|_| {});
        Ok(frame.depth.iter().filter(|&&depth| depth > 0.0).count() as f64)
    };
    let largest = sizes_px[sizes_px.len() - 1];
    let lines = true_lines(&scene, &view_of(largest).camera, SIZE, std::f64::consts::FRAC_PI_4);
    let length: f64 = lines.samples().iter().map(|sample| sample.1).sum();
    let line_share = length * largest / covered(view_of(largest))?;
    let mut points = vec![Vec::new(); methods.len()];
    for size_px in sizes_px {
        let view = view_of(size_px);
        let area = covered(view)?;
        for ((_, lines), points) in methods.iter().zip(&mut points) {
            let ink = ink(executor, &scene, *lines, view)?.iter().sum::<f64>();
            points.push((size_px, 100.0 * ink / area));
        }
    }
    let curves = methods.iter().zip(points).map(|((name, _), points)| {
        let what = "size of a teapot below which its ink is half of its area, px";
        let measured = crossing(&points, 50.0);
        let (width_px, bound) = match *name {
            "image lines" => (2.0, 83.0),
            _ => (1.0, 28.0),
        };
        let formula =
            "2 · width · length of the lines · size / area, both at 180 px: 2 px for filters, 1 px for edge lines";
        let limit = limit_at(what, measured, Bound::AtMost(bound));
        curve(name, points, limit.predicted(2.0 * width_px * line_share, formula))
    });
    let curves = curves.collect();
    let picture = |size_px: f64, lines| -> Result<Image, HarnessError> {
        let picture = drawn(executor, &scene, lines, view_of(size_px), 0.8)?;
        Ok(enlarged(&picture, [88, 88, 32, 32], 4))
    };
    Ok(Finding {
        parameter: Axis::logarithmic("size of a teapot", "px"),
        error: Axis::linear("ink over the area of the model", "%"),
        curves,
        pictures: vec![(
            "A teapot 24 px wide, enlarged four times: lines in the image, and along edges.".into(),
            beside(&[picture(24.0, methods[0].1)?, picture(24.0, methods[1].1)?]),
        )],
    })
}
