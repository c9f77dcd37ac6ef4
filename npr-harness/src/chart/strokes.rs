//! Hatching: the mean tone of small windows of a surface against the tone asked for.
//!
//! The light's tone is N·L, so the tone asked for in a window is the mean of N·L over it, computed per pixel with several
//! samples. Six tones cannot show tones below the darkest; there that tone is asked for, as in
//! [`crate::truth::hatch::asked`].

use super::frames::{Candidate, Drawn, candidates, part_of, rows};
use super::{Chart, Lab, Row, Subject};
use crate::capabilities::Capabilities;
use crate::cpu::{self, CpuOptions};
use crate::error::HarnessError;
use crate::hatch::{HatchEncoding, HatchMapping};
use crate::picture::Image;
use crate::plan::Plan;
use crate::shade::Shade;
use crate::shade::ramp::{RampShade, RampSource};
use crate::style::{Lines, Style};
use crate::truth::hatch::{LINEAR, MAPPINGS, asked, black, hatched, strokes};
use crate::variant::{Part, Setup};
use crate::view::View;
use glam::{DVec3, Vec3};
use npr_toon::normal::NormalUse;
use npr_toon::ramp::{Ramp, RampBlend, RampStop};

pub(super) const CHART: Chart = Chart {
    name: "hatching",
    title: "Hatching",
    error: TONE,
    about: "Black strokes on white: root mean square error of the mean tone of windows of 16 px, against N·L. Six tones \
            end at 1/7, which counts as right for what is darker.",
    choices: &["HatchMapping::Coordinates", "HatchMapping::Planes", "HatchMapping::Form"],
    run,
};

const TONE: &str = "RMSE of the tone";
/// The side of a window, px. Shorter ones would hold a part of a stroke's period.
const WINDOW_PX: u32 = 16;
const TRUE_SAMPLES: u32 = 4;

fn to_light() -> DVec3 {
    DVec3::new(-0.5, 0.7, 0.6).normalize()
}

fn run(lab: &Lab<'_>) -> Result<Vec<Row>, HarnessError> {
    let map = strokes(1);
    let mut all = Vec::new();
    for (number, subject) in lab.subjects.iter().enumerate() {
        let truth = windows(&lit(subject, lab.size)?);
        let mut of_subject: Vec<Candidate> = Vec::new();
        for mapping in MAPPINGS {
            // Without coordinates it is the same as planes.
            let has_coordinates = subject.scene.meshes().iter().any(|mesh| !mesh.model().uvs.is_empty());
            if mapping == HatchMapping::Coordinates && !has_coordinates {
                continue;
            }
            let name = match mapping {
                HatchMapping::Coordinates => "coordinates",
                HatchMapping::Planes => "planes",
                HatchMapping::Form => "form",
            };
            let shade = black(&map, HatchEncoding::Thresholds, mapping, LINEAR, 0.5);
            let base = Setup { style: hatched(&shade, NormalUse::PerPixel, to_light()), samples: 1 };
            let named = candidates(Part::Strokes, &base).into_iter();
            of_subject.extend(named.map(|c| Candidate { name: format!("{name}, {}", c.name), ..c }));
        }
        let mut judge = |drawn: &Drawn<'_>| {
            let Shade::Hatch(shade) = &drawn.candidate.setup.style.shade else { return Ok(None) };
            let shown = windows(&drawn.image(drawn.view)?);
            let (mut sum, mut worst, mut count) = (0.0, 0.0f64, 0u32);
            for (&tone, &light) in shown.iter().zip(&truth) {
                let Some(light) = light.on_surface else { continue };
                let [low, high] = asked(shade, light);
                let error = (tone.mean - tone.mean.clamp(low, high)).abs();
                sum += error * error;
                worst = worst.max(error);
                count += 1;
            }
            let errors = [(TONE, (sum / f64::from(count.max(1))).sqrt()), ("largest error of a window", worst)];
            Ok(Some(errors.map(|(name, value)| (name.to_owned(), value)).into()))
        };
        let progress = part_of(lab, number, lab.subjects.len());
        all.extend(rows(CHART.name, lab, subject, &of_subject, &mut judge, &progress)?);
    }
    Ok(all)
}

/// A window of a picture.
#[derive(Clone, Copy)]
struct Window {
    /// The mean of its green channel, 0..=1.
    mean: f64,
    /// The mean of N·L, if surfaces fill it: in [`lit`]'s picture, where blue marks them.
    on_surface: Option<f64>,
}

fn windows(image: &Image) -> Vec<Window> {
    let window = |x0: u32, y0: u32| {
        let mut sums = [0.0; 3];
        for y in y0..y0 + WINDOW_PX {
            for x in x0..x0 + WINDOW_PX {
                let pixel = image.pixel(x, y);
                (0..3).for_each(|channel| sums[channel] += f64::from(pixel[channel]) / 255.0);
            }
        }
        let [red, green, blue] = sums.map(|sum| sum / f64::from(WINDOW_PX * WINDOW_PX));
        let _ = red;
        Window { mean: green, on_surface: (blue == 0.0).then_some(green) }
    };
    let columns = (0..image.width / WINDOW_PX).map(|x| x * WINDOW_PX);
    (0..image.height / WINDOW_PX).flat_map(|y| columns.clone().map(move |x| window(x, y * WINDOW_PX))).collect()
}

/// N·L as the green of surfaces without blue, on white.
fn lit(subject: &Subject, size: (u32, u32)) -> Result<Image, HarnessError> {
    let light = [(0.0, Vec3::ZERO), (1.0, Vec3::Y)].map(|(at, color)| RampStop { at, color });
    let ramp = RampSource::Stops(Ramp { stops: light.to_vec(), blend: RampBlend::Smooth });
    let shade = black(&strokes(1), HatchEncoding::Thresholds, HatchMapping::Planes, LINEAR, 1.0);
    let base = hatched(&shade, NormalUse::PerPixel, to_light());
    let style = Style { shade: Shade::Ramp(RampShade { ramp, half_lambert: None }), lines: Lines::NONE, ..base };
    // White, so that the colour is that of the ramp.
    let white = crate::scene::Scene::new(crate::truth::bands::white(subject.scene.flattened().single().model()));
    let view = View { samples: TRUE_SAMPLES, ..View::new(subject.camera, size) };
    let plan = Plan::new(&white, &style, &view, &Capabilities::RAY_CASTER)?;
    Ok(cpu::render(&white, &plan, &CpuOptions::default(), &|_| {}).image())
}
