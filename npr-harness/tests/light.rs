//! Comparison of every shade on the GPU with the reference, on difficult surfaces.
#![cfg(feature = "gpu")]
#![allow(clippy::print_stdout)]

mod common;

use common::{cards, device, plain, planned, rendered, waves};
use glam::{DVec3, Mat4, UVec2, Vec3, Vec4};
use npr_gooch::{Gooch, Tones};
use npr_harness::camera::{Camera, Framing, Projection};
use npr_harness::check::{PLACES, Reference, Shot, agrees, magnitude};
use npr_harness::compare::compare;
use npr_harness::cpu::PrimaryHits;
use npr_harness::hatch::{HatchEncoding, HatchGround, HatchMap, HatchMapping, HatchShade, HatchSource, HatchTransfer};
use npr_harness::image_lines::ImageInk;
use npr_harness::lights::{LightFrame, StyleLight, lights_in_world};
use npr_harness::picture::Image;
use npr_harness::scene::Scene;
use npr_harness::shade::Shade;
use npr_harness::shade::lambert::Lambert;
use npr_harness::shade::painter::{PainterShade, Ramp2dSource};
use npr_harness::shade::ramp::{RampShade, RampSource};
use npr_harness::shade::x_toon::{XToon, XToonDetail};
use npr_harness::shadow::{ShadowLines, ShadowStyle};
use npr_harness::style::{Lines, Style, style};
use npr_harness::view::View;
use npr_hatch::TamParameters;
use npr_imagespace::composite::Composite;
use npr_imagespace::format::texel::TexelLayout;
use npr_imagespace::morphology::disc::Disc;
use npr_mesh::{AlphaMode, Material, Wrap, embedded};
use npr_toon::Bands;
use npr_toon::half_lambert::HalfLambert;
use npr_toon::normal::NormalUse;
use npr_toon::ramp::{Ramp, RampBlend, RampStop};
use npr_toon::row::{RampRow, TexelFilter};
use npr_toon::source::{Light, LightKind};
use npr_toon::table::{Corner, Ramp2d, RampTable};

const SIZE: (u32, u32) = (200, 120);

/// A coarse torus, and in front of it cards visible from both sides: textured, with a material whose alpha is below a
/// half, and blended. A cutoff of 0 cuts nothing out of the last.
fn scene(cutoff: f32) -> Scene {
    let modes = [AlphaMode::Opaque, AlphaMode::Opaque, AlphaMode::Blend, AlphaMode::Mask { cutoff }];
    let mut model = cards(4, 0.8, |n| Material {
        texture: (n % 2 == 1).then_some(0),
        ..plain(Vec4::new(0.9, 0.6, 0.3, 0.45 + 0.15 * n as f32), modes[n as usize], true)
    });
    // Scaled normals, so that all ways to use them give different results.
    for (normal, position) in model.normals.iter_mut().zip(&model.positions) {
        *normal = (*normal + 1.6 * Vec3::new(position.y, -position.y, 0.0)).normalize();
    }
    // `append` offsets texture indices.
    for material in &mut model.materials {
        material.texture = material.texture.map(|_| 0);
    }
    model.textures = vec![waves(32, 32, [Wrap::Repeat; 2], true)];
    let torus = embedded::torus(1.0, 0.55, 10, 6);
    let white = plain(Vec4::splat(0.8), AlphaMode::Opaque, false);
    model.append(&embedded::placed(
        torus,
        Mat4::from_translation(Vec3::new(1.9, 0.1, 1.2)) * Mat4::from_rotation_x(0.9),
        white,
    ));
    Scene::new(model)
}

fn camera(scene: &Scene, fov_y_rad: Option<f64>) -> Camera {
    let framing = Framing { yaw_rad: 0.35, pitch_rad: 0.3, fov_y_rad, ..Framing::default() };
    Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &framing)
}

fn stops(blend: RampBlend) -> Ramp {
    let stop = |at, r, g, b| RampStop { at, color: Vec3::new(r, g, b) };
    Ramp { stops: vec![stop(0.0, 0.2, 0.15, 0.4), stop(0.3, 0.5, 0.3, 0.5), stop(0.75, 1.0, 0.95, 0.8)], blend }
}

fn table(filter: TexelFilter) -> RampTable {
    let ramps = Ramp2d { a: stops(RampBlend::Smooth), b: stops(RampBlend::Smooth), corner: None };
    RampTable::from_ramps(&ramps, UVec2::new(7, 5), filter).expect("a table")
}

fn row(filter: TexelFilter) -> RampRow {
    RampRow::from_ramp(&stops(RampBlend::Smooth), 9, -1.0, 1.0, filter).expect("a row")
}

/// Every encoding with every mapping, and with the other options of strokes.
fn hatchings() -> Vec<(&'static str, Shade, Vec<StyleLight>)> {
    let parameters = TamParameters { side: 64, length: [0.2, 0.5], ..TamParameters::default() };
    let plain = HatchShade {
        map: HatchMap::new(HatchSource::Parameters(parameters)),
        encoding: HatchEncoding::SixTones,
        mapping: HatchMapping::Coordinates,
        transfer: HatchTransfer::Linear { ambient: 0.1 },
        tile: 0.4,
        texel_px: 1.0,
        ink: Vec3::new(0.1, 0.0, 0.3),
        ground: HatchGround::Paper,
    };
    let listing_4 = HatchTransfer::Listing4 { brightness: 6.0 };
    let (thresholds, surface) = (HatchEncoding::Thresholds, HatchGround::Surface);
    let near = StyleLight { light: Light::positional(Vec3::new(2.5, 1.0, 1.5)), frame: LightFrame::World };
    let cases = [
        ("six tones, coordinates", HatchShade { transfer: listing_4, ..plain.clone() }),
        ("six tones, planes", HatchShade { mapping: HatchMapping::Planes, ..plain.clone() }),
        ("six tones, form", HatchShade { mapping: HatchMapping::Form, ground: surface, ..plain.clone() }),
        ("thresholds, coordinates", HatchShade { encoding: thresholds, ground: surface, ..plain.clone() }),
        ("thresholds, planes", HatchShade { encoding: thresholds, mapping: HatchMapping::Planes, ..plain.clone() }),
        (
            "thresholds, form, large texels",
            HatchShade { encoding: thresholds, mapping: HatchMapping::Form, texel_px: 1.7, ..plain },
        ),
    ];
    let lit = |(number, (name, hatch))| {
        (name, Shade::Hatch(hatch), vec![if number % 2 == 0 { StyleLight::KEY } else { near }])
    };
    cases.into_iter().enumerate().map(lit).collect()
}

/// Name, shade, lights.
fn cases() -> Vec<(&'static str, Shade, Vec<StyleLight>)> {
    let key = StyleLight::KEY;
    let dim = StyleLight { light: Light { brightness: 0.7, color: Vec3::new(1.0, 0.8, 0.6), ..key.light }, ..key };
    let lamp = StyleLight {
        light: Light {
            brightness: 1.3,
            color: Vec3::new(0.7, 0.8, 1.0),
            ..Light::positional(Vec3::new(0.6, -0.2, 0.7))
        },
        frame: LightFrame::View,
    };
    let there = StyleLight { light: Light::positional(Vec3::new(2.5, 1.0, 1.5)), frame: LightFrame::World };
    let ramp = |ramp, half_lambert| Shade::Ramp(RampShade { ramp, half_lambert });
    let painter = |ramp, material_by_alpha| Shade::Painter(PainterShade { ramp, light_scale: 0.6, material_by_alpha });
    let corner = Some(Corner { threshold: 0.9, color: Vec3::new(1.0, 0.9, 0.9) });
    let hard = || Ramp2dSource::Ramps(Ramp2d { a: stops(RampBlend::Hard), b: stops(RampBlend::Hard), corner });
    let smooth = stops(RampBlend::Smooth);
    let twice = Ramp2dSource::Ramps(Ramp2d { a: smooth.clone(), b: stops(RampBlend::Hard), corner: None });
    let aliased = Bands { antialias: false, ..Bands::default() };
    let half = Some(HalfLambert::HALF_LIFE);
    let x_toon = |detail| {
        let abstracted = Ramp { stops: vec![RampStop { at: -1.0, color: Vec3::splat(0.9) }], blend: RampBlend::Hard };
        Shade::XToon(XToon { detailed: stops(RampBlend::Hard), abstracted, detail })
    };
    vec![
        ("Lambert, one lamp", Shade::Lambert(Lambert { ambient: 0.2 }), vec![lamp]),
        ("bands", Shade::Toon(Bands::default()), vec![key]),
        ("bands, dim", Shade::Toon(Bands { highlight: None, ..Bands::default() }), vec![dim]),
        ("bands, a lamp", Shade::Toon(Bands::default()), vec![there]),
        ("bands, two lights as one", Shade::Toon(Bands::default()), vec![dim, lamp]),
        ("bands, absolute", Shade::Toon(Bands { absolute: true, ..Bands::default() }), vec![dim]),
        ("bands, aliased", Shade::Toon(aliased), vec![key]),
        ("hard ramp", ramp(RampSource::Stops(stops(RampBlend::Hard)), None), vec![key]),
        ("smooth ramp, half-Lambert", ramp(RampSource::Stops(smooth), half), vec![lamp]),
        (
            "hard ramp, squared half-Lambert",
            ramp(RampSource::Stops(stops(RampBlend::Hard)), Some(HalfLambert::SOURCE)),
            vec![dim],
        ),
        ("row, nearest", ramp(RampSource::Image(row(TexelFilter::Nearest)), None), vec![key]),
        ("row, linear", ramp(RampSource::Image(row(TexelFilter::Linear)), None), vec![there]),
        ("two lights, hard", painter(hard(), false), vec![dim, lamp]),
        ("two lights, by alpha", painter(hard(), true), vec![lamp, key]),
        ("two lights, smooth and hard", painter(twice, false), vec![there, dim]),
        ("table, nearest", painter(Ramp2dSource::Image(table(TexelFilter::Nearest)), false), vec![key, dim]),
        ("table, linear", painter(Ramp2dSource::Image(table(TexelFilter::Linear)), false), vec![lamp, there]),
        ("painter, one light", painter(hard(), false), vec![dim]),
        ("X-Toon by depth", x_toon(XToonDetail::Depth { from: 0.1, to: 0.8 }), vec![key]),
        ("X-Toon by silhouette", x_toon(XToonDetail::Silhouette { exponent: 1.5 }), vec![lamp]),
        ("Gooch", Shade::Gooch(Gooch::default()), vec![key]),
        ("Gooch, a lamp", Shade::Gooch(Gooch { tones: Tones::SwappedShares, ..Gooch::default() }), vec![lamp]),
    ]
}

fn of(shade: Shade, lights: Vec<StyleLight>, normals: NormalUse, lines: Lines) -> Style {
    Style { shade, lights, normals, lines, ..style("toon").expect("a style of this crate") }
}

/// Each shade with each use of normals agrees with its reference and with no other case's.
#[test]
fn every_light_model_is_the_same_on_both() {
    the_same_on_both(cases(), None);
}

#[test]
fn strokes_are_the_same_on_both() {
    the_same_on_both(hatchings(), None);
}

/// Some of the shades, with a light that casts shadows, and with each kind of shadow lines.
#[test]
fn shadows_are_the_same_on_both() {
    let shadow = Some(ShadowStyle { terminator: 0.1, ..ShadowStyle::default() });
    let some = cases().into_iter().step_by(3).chain(hatchings().into_iter().step_by(4));
    let normals = ("normals", Shade::Normals, vec![StyleLight::KEY]);
    the_same_on_both(some.chain([normals]).collect(), shadow);
}

fn the_same_on_both(cases: Vec<(&'static str, Shade, Vec<StyleLight>)>, shadow: Option<ShadowStyle>) {
    let Some(executor) = device() else { return };
    // The shadow of a cut-out comes from a map, which is not exact.
    let scene = scene(if shadow.is_some() { 0.0 } else { 0.3 });
    for fov_y_rad in [Some(0.7), None] {
        let camera = camera(&scene, fov_y_rad);
        let hits = PrimaryHits::kept(&scene, View::new(camera, SIZE), PLACES);
        let mut before = None;
        for (number, (name, shade, lights)) in cases.clone().into_iter().enumerate() {
            // In a parallel view, at most one use of normals for each case.
            let all = [
                NormalUse::PerPixel,
                NormalUse::Interpolated,
                NormalUse::PerVertex,
                NormalUse::PerFace,
                NormalUse::PerSubdividedFace(3),
            ];
            let used = |which: &usize| fov_y_rad.is_some() || (which + 3) % 6 == number % 6;
            for normals in (0..all.len()).filter(used).map(|which| all[which]) {
                let red = Composite::Over { color: Vec3::X, opacity: 0.5 };
                let shadows = match number % 4 {
                    0 => ShadowLines::Lines,
                    1 => ShadowLines::Negated,
                    2 => ShadowLines::Separate {
                        composite: red,
                        dilation: Some(Disc { radius_px: 1.5, antialias: true }),
                    },
                    _ => ShadowLines::None,
                };
                let layout = if number % 5 == 2 { TexelLayout::Bits32 } else { TexelLayout::Bits64 };
                let lines = match shadow {
                    None if number.is_multiple_of(4) => Lines::image(ImageInk::default()),
                    None => Lines::NONE,
                    Some(_) => Lines::image(ImageInk { shadows, layout, ..ImageInk::default() }),
                };
                // This shade supports only normals at pixels.
                let normals = if shade == Shade::Normals { NormalUse::PerPixel } else { normals };
                let style = Style { shadow, ..of(shade.clone(), lights.clone(), normals, lines) };
                let plan = planned(&scene, &style, &camera, SIZE);
                let actual = rendered(&executor, &scene, &style, &camera, SIZE);
                let shot = Shot { hits: &hits, style: &style, plan: &plan };
                let mut reference = Reference::new(shot).expect("pictures");
                let magnitude = magnitude(&plan);
                let against = |reference: &Reference<'_>, actual: &Image| {
                    compare(&reference.image, actual, &reference.exempt).expect("one size")
                };
                let mut compared = against(&reference, &actual);
                if !agrees(&compared, magnitude) {
                    reference.look_closer().expect("pictures");
                    compared = against(&reference, &actual);
                }
                let (worst, share) = (compared.worst, compared.exempt_share());
                println!("{name}, {normals:?}: {worst} of 255, {:.2} % exempt", share * 100.0);
                assert!(agrees(&compared, magnitude), "{name}, {normals:?}: {worst}, {share}");
                // With a distant light, N·L of interpolated normals equals interpolated N·L of the vertices.
                let other =
                    before.replace(actual).filter(|_| normals != NormalUse::PerVertex && shade != Shade::Normals);
                if let Some(before) = other {
                    assert!(against(&reference, &before).worst > magnitude, "{name}, {normals:?}: as the one before");
                }
            }
        }
    }
}

#[test]
fn lights_are_where_their_frame_says() {
    let scene = Scene::new(embedded::placed(
        embedded::cube(),
        Mat4::from_translation(Vec3::new(1.0, 2.0, 3.0)),
        Material::default(),
    ));
    let camera = Camera {
        eye: DVec3::new(11.0, 2.0, 3.0),
        target: DVec3::new(1.0, 2.0, 3.0),
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y_rad: 0.5 },
        near: 0.1,
    };
    let place = |light: Light, frame| {
        let lights = vec![StyleLight { light, frame }];
        lights_in_world(&lights, 1, &scene, &camera)[0].place
    };
    // The eye is at +X: right is -Z, back is +X. Half the box's diagonal is √3.
    let direction = |to_light: Vec3| LightKind::Directional { to_light };
    assert_eq!(place(Light::directional(Vec3::Z * 3.0), LightFrame::View), direction(Vec3::X));
    assert_eq!(place(Light::directional(Vec3::X), LightFrame::View), direction(Vec3::NEG_Z));
    assert_eq!(place(Light::directional(Vec3::X * 2.0), LightFrame::World), direction(Vec3::X));
    let LightKind::Positional { position } = place(Light::positional(Vec3::Z), LightFrame::View) else { panic!() };
    assert!(position.abs_diff_eq(Vec3::new(1.0 + 3f32.sqrt(), 2.0, 3.0), 1e-6), "{position}");
    let at = Vec3::new(4.0, 5.0, 6.0);
    assert_eq!(place(Light::positional(at), LightFrame::World), LightKind::Positional { position: at });
    // Two lights that cancel out have no direction, which is not an error.
    let both = [Vec3::X, Vec3::NEG_X].map(|v| StyleLight { light: Light::directional(v), frame: LightFrame::World });
    let toon = of(Shade::Toon(Bands::default()), both.to_vec(), NormalUse::PerPixel, Lines::NONE);
    assert_eq!(lights_in_world(&toon.lights, 1, &scene, &camera)[0].place, direction(Vec3::ZERO));
    planned(&scene, &toon, &camera, SIZE);
}
