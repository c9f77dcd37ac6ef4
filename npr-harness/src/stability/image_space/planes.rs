//! False lines on planes that are seen at grazing angles.

use crate::camera::Camera;
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::image_lines::{ImageInk, Regions};
use crate::scene::Scene;
use crate::stability::ink::{ahead, beside, crossing, curve, drawn, geometric, limit, limit_at, worst};
use crate::stability::{Axis, Finding, Sweep};
use crate::style::Lines;
use crate::view::View;
use glam::{DVec3, Mat4, UVec2, Vec3};
use npr_imagespace::filter::depth::{BEND, DEPTH_SUM_CARD_MITCHELL, DepthPlain};
use npr_imagespace::filter::fused::{DepthTest, FilterUniform, FusedFilter, ink_fused};
use npr_imagespace::filter::printed::{PrintedDepth, PrintedEdges, PrintedUniform, ink_printed_edges};
use npr_imagespace::format::printed::ink_printed_encode;
use npr_imagespace::format::texel::{DepthCode, TexelLayout, ink_texel64_pack, ink_texel64_tap};
use npr_imagespace::picture::filter_picture;
use npr_mesh::Material;
use npr_mesh::embedded::{self, placed};

pub(super) const GRAZING_PLANE: Sweep = Sweep {
    name: "grazing-plane",
    technique: "image lines",
    what: "On a plane seen at a grazing angle depth changes from pixel to pixel by more than a threshold, and a filter of \
           differences inks all of it. The reciprocal of a plane's depth is linear on the screen, and its second difference \
           is 0.",
    needs_adapter: false,
    run: grazing_plane,
};

/// The window around the optical axis that is filtered.
const WINDOW: UVec2 = UVec2::new(24, 8);
/// The size of a pixel at distance 1: a picture of 240 rows with a field of view of 35°.
fn px() -> f64 {
    2.0 * 17.5f64.to_radians().tan() / 240.0
}
/// The plane's depth on the optical axis.
const DEPTH: f64 = 10.0;

/// The depths of a plane around the axis; infinite beyond its horizon.
fn depths(angle_deg: f64) -> Vec<f64> {
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    let row = |y: u32| {
        let down = (f64::from(y) + 0.5 - 0.5 * f64::from(WINDOW.y)) * px();
        let towards = sin + cos * down;
        if towards > 0.0 { DEPTH * sin / towards } else { f64::INFINITY }
    };
    (0..WINDOW.y).flat_map(|y| std::iter::repeat_n(row(y), WINDOW.x as usize)).collect()
}

/// The share of the middle rows that is inked, %: none of their taps lies outside the window.
fn share(ink: &[u8]) -> f64 {
    let rows = &ink[3 * WINDOW.x as usize..5 * WINDOW.x as usize];
    100.0 * rows.iter().filter(|&&ink| ink > 127).count() as f64 / rows.len() as f64
}

fn fused(plain: bool) -> FusedFilter {
    FusedFilter {
        normal_cos: None,
        depth: Some(DepthTest { step: BEND, plain }),
        regions: false,
        ..FusedFilter::default()
    }
}

fn fused_share(filter: &FusedFilter, depths: &[f64]) -> Result<f64, HarnessError> {
    let code = DepthCode::perspective(1.0, f32::INFINITY, TexelLayout::Bits64)?;
    let uniform = FilterUniform::new(filter, TexelLayout::Bits64, &code)?;
    let texels: Vec<_> = depths.iter().map(|&depth| ink_texel64_pack(Vec3::Z, 1, depth as f32, &code)).collect();
    let ink = filter_picture(&texels, WINDOW, filter.taps, |centre, taps| {
        ink_fused(&uniform, &ink_texel64_tap(centre), &taps.map(ink_texel64_tap)) as f32
    })?;
    Ok(share(&ink))
}

/// The range of the printed filter's depths, in multiples of [`DEPTH`].
const SPAN: f64 = 4.0;

fn printed_share(form: DepthPlain, depths: &[f64]) -> Result<f64, HarnessError> {
    let depth = PrintedDepth { form, threshold: DEPTH_SUM_CARD_MITCHELL };
    let edges = PrintedEdges { normal: None, depth: Some(depth), ..PrintedEdges::default() };
    let uniform = PrintedUniform::new(&edges)?;
    let fraction = |depth: f64| (depth / (SPAN * DEPTH)).min(1.0) as f32;
    let texels: Vec<_> = depths.iter().map(|&depth| ink_printed_encode(Vec3::Z, fraction(depth))).collect();
    let ink = filter_picture(&texels, WINDOW, edges.taps, |centre, taps| {
        f32::from(u8::from(ink_printed_edges(&edges, &uniform, centre, taps)))
    })?;
    Ok(share(&ink))
}

fn grazing_plane(executor: &Executor) -> Result<Finding, HarnessError> {
    let angles_deg = geometric(1.0, 60.0, 40);
    let sweep = |measure: &dyn Fn(&[f64]) -> Result<f64, HarnessError>| {
        angles_deg.iter().map(|&angle| Ok((angle, measure(&depths(angle))?))).collect::<Result<Vec<_>, HarnessError>>()
    };
    let what = "angle between plane and view below which the plane is ink, degrees";
    let mut curves = Vec::new();

    let points = sweep(&|depths| fused_share(&fused(true), depths))?;
    let predicted = (px() / f64::from(BEND)).atan().to_degrees();
    let formula = "atan(pixel / threshold): 1/z changes by pixel · cot(angle) of itself from row to row";
    let plain = limit_at(what, crossing(&points, 50.0), Bound::AtMost(1.01 * predicted)).predicted(predicted, formula);
    curves.push(curve("first differences of 1/z", points, plain));

    for (name, form, counted) in
        [("sum of 2002, corrected", DepthPlain::Sum, 4.0), ("sum as printed", DepthPlain::SumPrinted, 2.0)]
    {
        let points = sweep(&|depths| printed_share(form, depths))?;
        // The threshold is rounded up to whole steps of 8 bits.
        let threshold = (f64::from(DEPTH_SUM_CARD_MITCHELL) * 255.0).ceil() / 255.0;
        let predicted = (counted * px() / (SPAN * threshold)).atan().to_degrees();
        let formula = "atan(taps · z · pixel / (range · threshold)), a threshold of 6/255";
        let limit =
            limit_at(what, crossing(&points, 50.0), Bound::AtMost(1.1 * predicted)).predicted(predicted, formula);
        curves.push(curve(name, points, limit));
    }

    let points = sweep(&|depths| fused_share(&fused(false), depths))?;
    let bends = limit("largest share of a plane that is ink, at any angle, %", worst(&points), Bound::AtMost(0.0));
    curves.push(curve("second differences of 1/z", points, bends));

    let mut model = embedded::ground(40.0);
    model.append(&placed(embedded::sphere(48), Mat4::from_translation(Vec3::new(0.0, 1.0, 0.0)), Material::default()));
    let scene = Scene::new(model);
    let camera = Camera { eye: DVec3::new(0.0, 1.8, 14.0), target: DVec3::new(0.0, 0.6, 0.0), ..ahead(0.4, 0.1) };
    let picture = |plain| {
        let ink = ImageInk { filter: fused(plain), regions: Regions::One, ..ImageInk::default() };
        drawn(executor, &scene, Lines::image(ink), View::new(camera, (158, 110)), 1.0)
    };
    Ok(Finding {
        parameter: Axis::logarithmic("angle between plane and view", "degrees"),
        error: Axis::linear("plane inked", "%"),
        curves,
        pictures: vec![(
            "A ball on the ground, by depth alone: first differences, and second differences of 1/z.".into(),
            beside(&[picture(true)?, picture(false)?]),
        )],
    })
}
