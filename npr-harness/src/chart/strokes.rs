//! Hatching: the mean tone of small windows of a surface against the tone asked for.
//!
//! The light's tone is N·L, so the tone asked for in a window is the mean of N·L over it, computed per pixel with several
//! samples. Six tones cannot show tones below the darkest; there that tone is asked for, as in
//! [`crate::truth::hatch::asked`].

use super::frames::{Drawn, candidates, part_of, rows};
use super::{Chart, Lab, Row, Subject};
use crate::capabilities::Capabilities;
use crate::cpu::{self, CpuOptions};
use crate::error::HarnessError;
use crate::executor::{Executor, Picture};
use crate::hatch::{HatchEncoding, HatchGround, HatchMapping, HatchShade};
use crate::picture::Image;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::shade::Shade;
use crate::shade::ramp::{RampShade, RampSource};
use crate::style::{Lines, Style};
use crate::truth::bands::white;
use crate::truth::hatch::{LINEAR, asked, black, hatched, strokes, torus_with_uvs};
use crate::variant::{Part, Setup};
use crate::view::View;
use glam::{DVec3, Vec3};
use npr_toon::normal::NormalUse;
use npr_toon::ramp::{Ramp, RampBlend, RampStop};

/// A chart for each mapping, since one is no substitute for another.
pub(super) const CHARTS: [Chart; 3] = [
    chart("hatching-coordinates", "Hatching by texture coordinates", &["HatchMapping::Coordinates"], |lab| {
        run(lab, "hatching-coordinates", HatchMapping::Coordinates)
    }),
    chart("hatching-planes", "Hatching by three planes", &["HatchMapping::Planes"], |lab| {
        run(lab, "hatching-planes", HatchMapping::Planes)
    }),
    chart("hatching-form", "Hatching along the form", &["HatchMapping::Form"], |lab| {
        run(lab, "hatching-form", HatchMapping::Form)
    }),
];

const fn chart(
    name: &'static str,
    title: &'static str,
    choices: &'static [&'static str],
    run: fn(&Lab<'_>) -> Result<Vec<Row>, HarnessError>,
) -> Chart {
    Chart {
        name,
        title,
        error: TONE,
        about: "Black strokes on white: root mean square error of the mean tone of windows of 16 px, against N·L. Six tones \
                end at 1/7, which counts as right for what is darker.",
        choices,
        run,
    }
}

const TONE: &str = "RMSE of the tone";
/// The side of a window, px. Shorter ones would hold a part of a stroke's period.
const WINDOW_PX: u32 = 16;
/// Samples of N·L along each axis of a pixel; a window has 256 pixels.
const TRUE_SAMPLES: u32 = 2;

fn to_light() -> DVec3 {
    DVec3::new(-0.5, 0.7, 0.6).normalize()
}

fn run(lab: &Lab<'_>, chart: &str, mapping: HatchMapping) -> Result<Vec<Row>, HarnessError> {
    let shade = black(&strokes(1), HatchEncoding::Thresholds, mapping, LINEAR, 0.5);
    let base = Setup { style: hatched(&shade, NormalUse::PerPixel, to_light()), samples: 1 };
    let candidates = candidates(Part::Strokes, &base);
    // Models without coordinates are hatched by planes; where no subject has any, a torus has.
    let has_coordinates = |subject: &&Subject| subject.scene.meshes().iter().any(|mesh| !mesh.model().uvs.is_empty());
    let torus =
        [Subject::framed("torus with coordinates", Scene::new(torus_with_uvs(96, 48)), lab.size, &Default::default())];
    let mut subjects: Vec<&Subject> = lab.subjects.iter().collect();
    if mapping == HatchMapping::Coordinates {
        subjects.retain(has_coordinates);
        if subjects.is_empty() {
            subjects.extend(&torus);
        }
    }
    let mut all = Vec::new();
    for (number, subject) in subjects.iter().enumerate() {
        let truth = truth(&subject.scene, &View::new(subject.camera, lab.size), &base.style)?;
        let mut judge = |drawn: &Drawn<'_>| {
            let Shade::Hatch(shade) = &drawn.candidate.setup.style.shade else { return Ok(None) };
            let [rmse, worst] = differences(shade, &drawn.image(drawn.view)?, &truth);
            Ok(Some(vec![(TONE.into(), rmse), ("largest error of a window".into(), worst)]))
        };
        let progress = part_of(lab, number, subjects.len());
        all.extend(rows(chart, lab, subject, &candidates, &mut judge, &progress)?);
    }
    Ok(all)
}

/// A window of a picture.
#[derive(Clone, Copy)]
pub(super) struct Window {
    /// The mean of its green channel, 0..=1: the tone, or N·L.
    mean: f64,
    /// Whether it is free of blue, which in [`truth`]'s picture means that surfaces fill it.
    is_surface: bool,
}

fn windows(image: &Image) -> Vec<Window> {
    let window = |x0: u32, y0: u32| {
        let pixels = (y0..y0 + WINDOW_PX).flat_map(|y| (x0..x0 + WINDOW_PX).map(move |x| image.pixel(x, y)));
        let (mut green, mut blue) = (0.0, 0.0);
        for [_, g, b, _] in pixels {
            green += f64::from(g) / 255.0;
            blue += f64::from(b);
        }
        Window { mean: green / f64::from(WINDOW_PX * WINDOW_PX), is_surface: blue == 0.0 }
    };
    let columns = (0..image.width / WINDOW_PX).map(|x| x * WINDOW_PX);
    (0..image.height / WINDOW_PX).flat_map(|y| columns.clone().map(move |x| window(x, y * WINDOW_PX))).collect()
}

/// The root mean square and the largest error of the tone of windows that surfaces fill.
fn differences(shade: &HatchShade, image: &Image, truth: &[Window]) -> [f64; 2] {
    let (mut sum, mut worst, mut count) = (0.0, 0.0f64, 0u32);
    for (tone, light) in windows(image).into_iter().zip(truth) {
        if !light.is_surface {
            continue;
        }
        let [low, high] = asked(shade, light.mean);
        let error = (tone.mean - tone.mean.clamp(low, high)).abs();
        sum += error * error;
        worst = worst.max(error);
        count += 1;
    }
    [(sum / f64::from(count.max(1))).sqrt(), worst]
}

/// The error of a hatched setup's tone, drawn in black on white with a tone of N·L.
pub(super) fn error_of_style(
    executor: &Executor,
    scene: &Scene,
    view: View,
    setup: &Setup,
    truth: &[Window],
) -> Result<f64, HarnessError> {
    let Shade::Hatch(shade) = &setup.style.shade else { return Ok(0.0) };
    let shade = HatchShade { ink: Vec3::ZERO, ground: HatchGround::Paper, transfer: LINEAR, ..shade.clone() };
    let style = Style {
        paper: Vec3::ONE,
        shade: Shade::Hatch(shade.clone()),
        shadow: None,
        lines: Lines::NONE,
        ..setup.style.clone()
    };
    let view = View { samples: setup.samples, ..view };
    let image = executor.render(&Picture::new(scene, &style, view), &|_| {})?;
    Ok(differences(&shade, &image, truth)[0])
}

/// The windows of N·L of a style's lights: the green of surfaces without blue, on white.
pub(super) fn truth(scene: &Scene, view: &View, style: &Style) -> Result<Vec<Window>, HarnessError> {
    let light = [(0.0, Vec3::ZERO), (1.0, Vec3::Y)].map(|(at, color)| RampStop { at, color });
    let ramp = RampSource::Stops(Ramp { stops: light.to_vec(), blend: RampBlend::Smooth });
    let style = Style {
        paper: Vec3::ONE,
        shade: Shade::Ramp(RampShade { ramp, half_lambert: None }),
        normals: NormalUse::PerPixel,
        shadow: None,
        lines: Lines::NONE,
        ..style.clone()
    };
    // White, so that the colour is that of the ramp.
    let white = Scene::new(white(scene.flattened().single().model()));
    let view = View { samples: TRUE_SAMPLES, ..*view };
    let plan = Plan::new(&white, &style, &view, &Capabilities::RAY_CASTER)?;
    Ok(windows(&cpu::render(&white, &plan, &CpuOptions::default(), &|_| {}).image()))
}
