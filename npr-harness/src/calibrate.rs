//! Measures the cost table of a machine, for plans by budget.
//!
//! Every variant that a plan may choose is drawn on a coarse and a fine model at two sizes, in rounds with a plain pass.
//! Its cost is fitted to what its median takes, linear in samples and faces, with no negative part. Expected errors are
//! those of the charts, on two built-in scenes.

mod fit;

use crate::budget::{Amounts, CostTable, Entry, Expected, ShadeKey, cost_name};
use crate::camera::Framing;
use crate::chart::{Lab, Row, Subject, built_in_subjects, charts};
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

/// The sizes of the pictures from which costs are found, px.
const SIZES: [(u32, u32); 2] = [(256, 144), (512, 288)];
/// The size of the pictures from which errors are expected, px.
const ERROR_SIZE: (u32, u32) = (320, 180);
/// The widths of lines, px: one for which lines in the image need no disc, and one for which they do.
const WIDTHS_PX: [f32; 2] = [1.0, 3.0];

/// Something whose cost is found.
struct Priced {
    part: Part,
    name: String,
    shade: Option<ShadeKey>,
    setup: Setup,
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
    let expected = expected(executors, &|share| progress(0.7 + 0.3 * share))?;
    let executors = executors.iter().map(Executor::name).collect();
    Ok(CostTable { version: env!("CARGO_PKG_VERSION").into(), executors, entries, expected })
}

/// Everything whose cost is found.
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
                all.push(Priced { part, name, shade, setup: Setup { samples, ..setup } });
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
        let setup = Setup { style: Style { shade, ..plain().style }, samples: 1 };
        all.push(Priced { part: Part::Light, name: crate::budget::PER_PIXEL.into(), shade: key, setup });
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
    // A frame of a ray caster takes longer, and its times differ less.
    let rounds = Rounds { rounds: if executor.is_cpu() { 2 } else { 4 }, ..Rounds::default() };
    let mut points: Vec<Vec<fit::Point>> = priced.iter().map(|_| Vec::new()).collect();
    let steps = (SIZES.len() * 2) as f64;
    for (number, size) in SIZES.into_iter().enumerate() {
        for (which, Subject { scene, camera, .. }) in subjects(size).iter().enumerate() {
            let plan = |setup: &Setup| {
                let view = View { samples: setup.samples, ..View::new(*camera, size) };
                Picture::new(scene, &setup.style, view).plan(executor.capabilities())
            };
            // The plain pass with as many samples, from which what lines and shadows add is told.
            let plains = [1, 2].map(|samples| plan(&Setup { samples, ..plain() }));
            let [one, two] = plains;
            let mut plans: Vec<Plan> = vec![one?, two?];
            let mut of: Vec<usize> = Vec::new();
            for (index, Priced { setup, .. }) in priced.iter().enumerate() {
                match plan(setup) {
                    Ok(plan) => {
                        plans.push(plan);
                        of.push(index);
                    }
                    Err(error) if error.is_device_limit() => {}
                    Err(error) => return Err(error),
                }
            }
            let mut cases: Vec<Case<'_>> = plans.iter().map(|plan| Case::Frame { executor, scene, plan }).collect();
            let done = (2 * number + which) as f64;
            let timed = time(&mut cases, &rounds, &|share| progress((done + share) / steps))?;
            let (plains, timed) = timed.split_at(2);
            for (&index, timed) in of.iter().zip(timed) {
                let Priced { part, setup, .. } = &priced[index];
                let samples = setup.samples;
                let plain = &plains[samples as usize - 1];
                let added = matches!(part, Part::Lines | Part::Shadows);
                let pixels = f64::from(size.0 * size.1);
                points[index].push(fit::Point {
                    amounts: Amounts {
                        samples: pixels * f64::from(samples * samples),
                        faces: scene.face_count() as f64,
                    },
                    ms: if added { timed.wall.longer_than(&plain.wall) } else { timed.wall.spread().median },
                });
            }
        }
    }
    let entry = |(Priced { part, name, shade, setup }, points): (&Priced, Vec<fit::Point>)| {
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

/// The errors that are expected, from charts.
fn expected(executors: &[Executor], progress: &(dyn Fn(f64) + Sync)) -> Result<Vec<Expected>, HarnessError> {
    let on_cpu = [Executor::Cpu { why: None }];
    let subjects = built_in_subjects(ERROR_SIZE, 2);
    // Errors are the same on every executor but for shadows, which the CPU has none of.
    let on_adapter = executors.iter().position(|executor| !executor.is_cpu());
    let rounds = Rounds { rounds: 1, ..Rounds::default() };
    let mut all = Vec::new();
    let names = ["lines", "light", "hatching", "shadows"];
    for (number, name) in names.into_iter().enumerate() {
        let executors = match on_adapter {
            Some(at) if name == "shadows" => &executors[at..=at],
            _ => &on_cpu[..],
        };
        let progress = |share: f64| progress((number as f64 + share) / names.len() as f64);
        let lab =
            Lab { executors, subjects: &subjects, size: ERROR_SIZE, rounds, skipped: &|_| {}, progress: &progress };
        let chart = charts().into_iter().find(|chart| chart.name == name).expect("a chart of this crate");
        let rows = (chart.run)(&lab)?;
        all.extend(errors_of(name, &rows));
    }
    Ok(all)
}

/// What the rows of a chart say of the variants of its part.
fn errors_of(chart: &str, rows: &[Row]) -> Vec<Expected> {
    let (part, shades): (Part, &[(&str, ShadeKey)]) = match chart {
        "lines" => (Part::Lines, &[]),
        "shadows" => (Part::Shadows, &[]),
        "light" => (Part::Light, &[("bands, ", ShadeKey::Toon), ("Gooch, ", ShadeKey::Gooch)]),
        _ => (Part::Strokes, &[("planes, ", ShadeKey::HatchPlanes), ("form, ", ShadeKey::HatchForm)]),
    };
    let unit = if chart == "light" { 255.0 } else { 1.0 };
    let mut all = Vec::new();
    let mut add = |prefix: &str, shade: Option<ShadeKey>| {
        for variant in part.variants() {
            for (samples, ending) in [(1, ""), (2, ", 2 x 2 samples"), (4, ", 4 x 4 samples")] {
                let name = format!("{prefix}{}{ending}", variant.name);
                let found: Vec<f64> =
                    rows.iter().filter(|row| row.variant == name).map(|row| row.errors[0].1).collect();
                if !found.is_empty() {
                    let error = found.iter().sum::<f64>() / found.len() as f64 / unit;
                    all.push(Expected { part, variant: variant.name.into(), shade, samples, error });
                }
            }
        }
    };
    if shades.is_empty() {
        add("", None);
    }
    shades.iter().for_each(|(prefix, shade)| add(prefix, Some(*shade)));
    all
}
