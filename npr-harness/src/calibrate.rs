//! Measures the cost table of a machine, for plans by budget.
//!
//! Every variant that a plan may choose is drawn on a coarse and a fine model at two sizes. Its cost is fitted to the ratios
//! of its times to those of a plain pass in the same rounds, linear in samples and faces, with no negative part. Expected
//! errors are means over two built-in scenes.

mod fit;

use crate::budget::{Amounts, CostTable, Entry, Expected, Measure, ShadeKey, cost_name};
use crate::camera::Framing;
use crate::chart::survey::Survey;
use crate::chart::{Subject, built_in_subjects};
use crate::error::HarnessError;
use crate::executor::{Executor, Picture};
use crate::hatch::{HatchEncoding, HatchMapping};
use crate::measure::{Case, Rounds, time};
use crate::plan::Plan;
use crate::scene::Scene;
use crate::shade::Shade;
use crate::shade::lambert::Lambert;
use crate::style::{Lines, Style, style};
use crate::truth::hatch::{LINEAR, MAPPINGS, black, strokes};
use crate::variant::{Part, Setup, plain};
use crate::view::View;
use npr_mesh::embedded;
use npr_outline::line_style::{LineStyle, widths_px};
use npr_toon::normal::NormalUse;

/// The sizes of the pictures from which the costs of an adapter are found, px. In smaller ones most of a frame is what a
/// frame takes at any size.
const SIZES: [(u32, u32); 2] = [(320, 180), (960, 540)];
/// Those of the CPU, which takes as long for each sample in any of them.
const CPU_SIZES: [(u32, u32); 2] = [(208, 117), (416, 234)];
/// The size of the pictures from which errors are expected, px.
const ERROR_SIZE: (u32, u32) = (320, 180);
/// The widths of lines, px: one for which lines in the image need no disc, and one for which they do.
const WIDTHS_PX: [f32; 2] = [1.0, 3.0];

/// The number of variants that are measured in the same rounds, with plain passes among them: few, so that what slows
/// the machine for a while slows both.
const CHUNK: usize = 12;

/// A variant whose cost is measured.
struct Priced {
    part: Part,
    name: String,
    shade: Option<ShadeKey>,
    setup: Setup,
    /// The style that it is a variant of.
    asked: Style,
}

/// Measures the cost table of some executors, the unit of time first. `progress` is called with the share that is done,
/// 0..=1.
///
/// # Errors
/// [`HarnessError`].
pub fn calibrate(executors: &[Executor], progress: &(dyn Fn(f64) + Sync)) -> Result<CostTable, HarnessError> {
    let priced = priced();
    let mut entries = Vec::new();
    for (number, executor) in executors.iter().enumerate() {
        let share = |done: f64| progress(0.7 * (number as f64 + done) / executors.len() as f64);
        entries.extend(costs(executor, &priced, &share)?);
    }
    let expected = expected(executors, &priced, &|share| progress(0.7 + 0.3 * share))?;
    let executors = executors.iter().map(Executor::name).collect();
    Ok(CostTable { version: env!("CARGO_PKG_VERSION").into(), executors, entries, expected })
}

/// All variants whose costs are measured.
fn priced() -> Vec<Priced> {
    let mut all: Vec<Priced> = Vec::new();
    let mut add = |part: Part, shade: Option<ShadeKey>, base: &Setup, samples: u32| {
        for variant in part.variants().into_iter().filter(|variant| variant.in_budget) {
            let Some(setup) = (variant.apply)(base) else { continue };
            let name = cost_name(part, variant.name, &setup).into_owned();
            let is_known = |known: &Priced| {
                (known.part, &known.name, known.shade, known.setup.samples) == (part, &name, shade, samples)
            };
            if !all.iter().any(is_known) {
                let asked = base.style.clone();
                all.push(Priced { part, name, shade, setup: Setup { samples, ..setup }, asked });
            }
        }
    };
    for samples in [1, 2] {
        for width in WIDTHS_PX {
            let lines =
                Lines::edges(LineStyle { width_px: widths_px(width, width, width, 0.0), ink: [0.0, 0.0, 0.0, 1.0] });
            add(Part::Lines, None, &Setup { style: Style { lines, ..plain().style }, samples }, samples);
        }
        let shadow = Some(Default::default());
        add(Part::Shadows, None, &Setup { style: Style { shadow, ..plain().style }, samples }, samples);
        for shade in shades() {
            let key = ShadeKey::of(&shade.shade);
            let part = if matches!(shade.shade, Shade::Hatch(_)) { Part::Strokes } else { Part::Light };
            add(part, Some(key), &Setup { style: shade, samples }, samples);
        }
    }
    // Surfaces that are not painted or lit have no variants.
    for shade in [Shade::Paper, Shade::Normals] {
        let key = Some(ShadeKey::of(&shade));
        let asked = Style { shade, ..plain().style };
        let setup = Setup { style: asked.clone(), samples: 1 };
        all.push(Priced { part: Part::Light, name: crate::budget::PER_PIXEL.into(), shade: key, setup, asked });
    }
    all
}

/// A style of each kind of shade that is lit or hatched, without lines.
fn shades() -> Vec<Style> {
    let named = ["toon", "wash", "wrapped", "two-lights", "x-toon", "gooch"];
    let of = |name: &str| Style { lines: Lines::NONE, shadow: None, ..style(name).expect("a style of this crate") };
    let mut all: Vec<Style> = named.map(of).into();
    all.push(Style { shade: Shade::Lambert(Lambert { ambient: 0.25 }), ..plain().style });
    let map = strokes(1);
    all.extend(MAPPINGS.map(|mapping: HatchMapping| {
        let shade = Shade::Hatch(black(&map, HatchEncoding::SixTones, mapping, LINEAR, 0.5));
        Style { shade, normals: NormalUse::PerPixel, ..of("toon") }
    }));
    all
}

/// A coarse and a fine model, of different shares of the picture.
fn subjects(size: (u32, u32)) -> [Subject; 2] {
    let framed = |name, model, distance| {
        Subject::framed(name, Scene::new(model), size, &Framing { distance, pitch_rad: 0.3, ..Framing::default() })
    };
    [framed("coarse", embedded::torus(1.0, 0.4, 24, 12), 1.0), framed("fine", embedded::torus(1.0, 0.4, 200, 90), 1.0)]
}

/// The costs of everything on an executor.
fn costs(executor: &Executor, priced: &[Priced], progress: &dyn Fn(f64)) -> Result<Vec<Entry>, HarnessError> {
    // A ray caster takes as long for each sample, so that pictures of one sample tell all; and what lines or shadows add
    // is little beside its rays, so that it takes more rounds to see it.
    let rounds = Rounds { rounds: if executor.is_cpu() { 5 } else { 3 }, ..Rounds::default() };
    let mut points: Vec<Vec<fit::Point>> = priced.iter().map(|_| Vec::new()).collect();
    let steps = (SIZES.len() * 2) as f64;
    let sizes = if executor.is_cpu() { CPU_SIZES } else { SIZES };
    for (number, size) in sizes.into_iter().enumerate() {
        for (which, Subject { scene, camera, .. }) in subjects(size).iter().enumerate() {
            let plan = |setup: &Setup| {
                let view = View { samples: setup.samples, ..View::new(*camera, size) };
                Picture::new(scene, &setup.style, view).plan(executor.capabilities())
            };
            let mut measured: Vec<(usize, f64)> = Vec::new();
            let mut plain_ms = f64::INFINITY;
            let chunks = priced.len().div_ceil(CHUNK);
            for chunk in 0..chunks {
                let done = ((2 * number + which) * chunks + chunk) as f64 / (steps * chunks as f64);
                progress(done);
                // The plain passes with as many samples, from which what lines and shadows add is told.
                let mut plans: Vec<Plan> = Vec::new();
                for samples in [1, 2] {
                    plans.push(plan(&Setup { samples, ..plain() })?);
                }
                let mut of: Vec<usize> = Vec::new();
                let indices = chunk * CHUNK..((chunk + 1) * CHUNK).min(priced.len());
                for index in indices {
                    if executor.is_cpu() && priced[index].setup.samples > 1 {
                        continue;
                    }
                    match plan(&priced[index].setup) {
                        Ok(plan) => {
                            plans.push(plan);
                            of.push(index);
                        }
                        Err(error) if error.is_device_limit() => {}
                        Err(error) => return Err(error),
                    }
                }
                let mut cases: Vec<Case<'_>> = plans.iter().map(|plan| Case::Frame { executor, scene, plan }).collect();
                let timed = time(&mut cases, &rounds, &|_| {})?;
                let (plains, timed) = timed.split_at(2);
                let plain = &plains[0].wall;
                plain_ms = plain_ms.min(plain.spread().median);
                for (&index, timed) in of.iter().zip(timed) {
                    let Priced { part, setup, .. } = &priced[index];
                    let relative = timed.wall.relative_to(plain).median;
                    let without = match part {
                        Part::Lines | Part::Shadows if setup.samples == 1 => 1.0,
                        Part::Lines | Part::Shadows => plains[1].wall.relative_to(plain).median,
                        _ => 0.0,
                    };
                    measured.push((index, relative - without));
                }
            }
            // Ratios within rounds, in units of the plain pass where it was least disturbed.
            for (index, relative) in measured {
                let samples = priced[index].setup.samples;
                let pixels = f64::from(size.0 * size.1) * f64::from(samples * samples);
                let amounts = Amounts { samples: pixels, faces: scene.face_count() as f64 };
                points[index].push(fit::Point { amounts, ms: relative * plain_ms });
            }
        }
    }
    let entry = |(Priced { part, name, shade, setup, .. }, points): (&Priced, Vec<fit::Point>)| {
        (!points.is_empty()).then(|| Entry {
            executor: executor.name(),
            part: *part,
            variant: name.clone(),
            shade: *shade,
            samples: setup.samples,
            cost: fit::cost(&points),
        })
    };
    Ok(priced.iter().zip(points).filter_map(entry).collect())
}

/// The errors that are expected: means over the built-in scenes, as a [`Survey`] measures them.
fn expected(executors: &[Executor], priced: &[Priced], progress: &dyn Fn(f64)) -> Result<Vec<Expected>, HarnessError> {
    let cpu = Executor::Cpu { why: None };
    // Errors are the same on every executor but for shadows, which the CPU has none of.
    let on_adapter = executors.iter().find(|executor| !executor.is_cpu());
    let subjects = built_in_subjects(ERROR_SIZE, 2);
    let mut all = Vec::new();
    for Priced { part, name, shade, setup, .. } in priced {
        // What errs like another shade is not measured apart.
        if shade.is_some_and(|shade| shade.errs_like() != shade || shade == ShadeKey::Paper) {
            continue;
        }
        // More samples do not change shadows, and lines hardly.
        let samples: &[u32] = match (part, setup.samples) {
            (Part::Light | Part::Strokes, 2) => &[2, 4],
            (_, 1) => &[1],
            _ => &[],
        };
        for &samples in samples {
            let setup = Setup { samples, ..setup.clone() };
            all.push((setup, Expected { part: *part, variant: name.clone(), shade: *shade, samples, error: 0.0 }));
        }
    }
    let count = (all.len() * subjects.len()) as f64;
    for (number, Subject { scene, camera, .. }) in subjects.iter().enumerate() {
        let view = View::new(*camera, ERROR_SIZE);
        // A survey for each kind of shade, which keeps its truths.
        let mut surveys: Vec<((Part, Option<ShadeKey>), Survey<'_>)> = Vec::new();
        for (index, (setup, expected)) in all.iter_mut().enumerate() {
            progress((number * (count as usize / subjects.len()) + index) as f64 / count);
            let measure = Measure::of_part(expected.part).expect("samples are no part of the list");
            let executor = on_adapter.filter(|_| measure == Measure::Shadows).unwrap_or(&cpu);
            let key = (expected.part, expected.shade);
            let asked = priced.iter().find(|priced| (priced.part, priced.shade) == key).expect("it is of one of them");
            let at = surveys.iter().position(|(known, _)| *known == key).unwrap_or_else(|| {
                surveys.push((key, Survey::new(scene, view, &asked.asked, executors)));
                surveys.len() - 1
            });
            expected.error += surveys[at].1.error(setup, executor, measure)? / subjects.len() as f64;
        }
    }
    Ok(all.into_iter().map(|(_, expected)| expected).collect())
}
