//! What plans by budget promise, held against measurements: errors against what was asked for, and times against a plain
//! pass in the same rounds, on models that the cost table was not made from.
//!
//! `cargo bench -p npr-harness --bench budget -- MODEL…`, with the options of the other benches; built-in models if none
//! are given. Pictures of 640×360. Ends with the shares that keep to their budgets, and names each that does not.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod common;

use npr_harness::budget::{Budget, CostTable, MaxTime, Measure, configurations, within};
use npr_harness::calibrate::calibrate;
use npr_harness::camera::{Camera, Framing};
use npr_harness::chart::survey::Survey;
use npr_harness::error::HarnessError;
use npr_harness::executor::{Executor, Picture};
use npr_harness::measure::{Case, Rounds, time};
use npr_harness::scene::Scene;
use npr_harness::style::style;
use npr_harness::variant::{Setup, plain};
use npr_harness::view::View;
use npr_mesh::embedded;
use std::path::Path;

const STYLES: [&str; 6] = ["cartoon", "toon", "gooch", "ink-image", "toon-shadow", "hatch"];
const VIEWS_DEG: [(f64, f64); 2] = [(30.0, 20.0), (200.0, -10.0)];
const ERRORS: [&str; 3] = ["lines=0.02,tone=0.01", "lines=0.1,tone=0.02", "lines=0.3,tone=0.05,shadows=0.001"];
const TIMES: [f64; 3] = [1.5, 2.5, 5.0];
/// Of what was asked for.
const MOST_TIME: f64 = 1.25;

#[derive(Default)]
struct Tally {
    kept: usize,
    missed: Vec<String>,
    refused: usize,
}

impl Tally {
    fn add(&mut self, what: String, keeps: bool) {
        if keeps { self.kept += 1 } else { self.missed.push(what) }
    }

    fn print(&self, what: &str) {
        let all = self.kept + self.missed.len();
        println!("{what}: {} of {all} kept, {} more refused as out of reach", self.kept, self.refused);
        self.missed.iter().for_each(|missed| println!("  missed: {missed}"));
    }
}

fn main() {
    let arguments = common::arguments(Rounds { rounds: 7, ..Rounds::default() });
    let size = if arguments.size == (1280, 720) { (640, 360) } else { arguments.size };
    let Some(adapter) = common::on_adapter() else { return };
    let executors = [adapter, Executor::Cpu { why: None }];
    let table = calibrate(&executors, &|_| {}).expect("this machine can be measured");
    let models: Vec<(String, Scene)> = if arguments.rest.is_empty() {
        [
            ("cone", embedded::cone(32)),
            ("cylinder", embedded::cylinder(48)),
            ("cube", embedded::cube()),
            ("sphere", embedded::sphere(64)),
            ("fine teapot", embedded::teapot(20)),
        ]
        .map(|(name, model)| (name.to_owned(), Scene::new(model)))
        .into()
    } else {
        arguments.rest.iter().map(|path| (path.clone(), Scene::new(common::load(Path::new(path))))).collect()
    };
    let (mut errors, mut times) = (Tally::default(), Tally::default());
    for (name, scene) in &models {
        let name = Path::new(name).file_stem().map_or(name.clone(), |stem| stem.to_string_lossy().into_owned());
        for (yaw_deg, pitch_deg) in VIEWS_DEG {
            let framing =
                Framing { yaw_rad: yaw_deg.to_radians(), pitch_rad: pitch_deg.to_radians(), ..Framing::default() };
            let camera = Camera::framed(scene.corners(), f64::from(size.0) / f64::from(size.1), &framing);
            for style_name in STYLES {
                let setup = Setup { style: style(style_name).expect("a style of this crate"), samples: 1 };
                let at =
                    Place { scene, setup: &setup, view: View::new(camera, size), executors: &executors, table: &table };
                let what = format!("{name}, {yaw_deg} {pitch_deg}, {style_name}");
                check_errors(&at, &what, &mut errors);
                check_times(&at, &what, &arguments.rounds, &mut times);
            }
        }
    }
    errors.print("errors");
    times.print("times within 1.25 of what was asked for");
}

/// A picture, and what makes it.
struct Place<'a> {
    scene: &'a Scene,
    setup: &'a Setup,
    view: View,
    executors: &'a [Executor],
    table: &'a CostTable,
}

/// Holds what a budget of errors chooses against errors in the whole picture on the executor that was chosen.
fn check_errors(at: &Place<'_>, what: &str, tally: &mut Tally) {
    let Place { scene, setup, view, executors, table } = *at;
    let all = configurations(scene, setup, &view, table);
    let mut survey = Survey::new(scene, view, &setup.style, executors);
    let mut full = Survey::new(scene, view, &setup.style, executors).in_full();
    for asked in ERRORS {
        let budget = Budget { max_errors: asked.parse().expect("a budget"), ..Budget::default() };
        match within(&all, &budget, |configuration, measure| survey.measure(configuration, measure)) {
            Ok(choice) => {
                let measured: Vec<(Measure, f64, f64)> = (budget.max_errors.0.iter())
                    .map(|&(of, most)| (of, full.measure(&choice.chosen, of).expect("it was drawn before"), most))
                    .collect();
                let names: Vec<&str> = choice.chosen.variants.iter().map(|(_, name)| *name).collect();
                let found: Vec<String> =
                    measured.iter().map(|(of, error, most)| format!("{of} {error:.4} of {most}")).collect();
                let said = format!("{what}, {asked}: {}; {}", names.join(", "), found.join(", "));
                println!("{said}, {:.2} plain passes", choice.chosen.cost_plain);
                tally.add(said, measured.iter().all(|(_, error, most)| error <= most));
            }
            Err(HarnessError::NoSuchAccuracy { measure, asked, least, .. }) => {
                println!("{what}: {measure} {asked} is out of reach, the least is {least:.4}");
                tally.refused += 1;
            }
            Err(error) => panic!("{what}: {error}"),
        }
    }
}

/// Holds what budgets of time choose against the time it takes, beside a plain pass of the first executor.
fn check_times(at: &Place<'_>, what: &str, rounds: &Rounds, tally: &mut Tally) {
    let Place { scene, setup, view, executors, table } = *at;
    let all = configurations(scene, setup, &view, table);
    let plan = |executor: &Executor, setup: &Setup| {
        let view = View { samples: setup.samples, ..view };
        Picture::new(scene, &setup.style, view).plan(executor.capabilities()).expect("it fits")
    };
    let mut chosen = Vec::new();
    for asked in TIMES {
        let budget = Budget { max_time: Some(MaxTime::Plain(asked)), ..Budget::default() };
        match within(&all, &budget, |_, _| unreachable!("no error is asked for")) {
            Ok(choice) => chosen.push((asked, choice.chosen)),
            Err(HarnessError::NoSuchSpeed { .. }) => tally.refused += 1,
            Err(error) => panic!("{what}: {error}"),
        }
    }
    let plain_plan = plan(&executors[0], &plain());
    let of = |name: &str| executors.iter().find(|executor| executor.name() == name).expect("one of the table's");
    let plans: Vec<_> = chosen.iter().map(|(_, c)| (of(&c.executor), plan(of(&c.executor), &c.setup))).collect();
    let mut cases = vec![Case::Frame { executor: &executors[0], scene, plan: &plain_plan }];
    cases.extend(plans.iter().map(|(executor, plan)| Case::Frame { executor, scene, plan }));
    let timed = time(&mut cases, rounds, &|_| {}).expect("the frames are drawn");
    for ((asked, configuration), timed_one) in chosen.iter().zip(&timed[1..]) {
        let took = timed_one.wall.relative_to(&timed[0].wall).median;
        let names: Vec<&str> = configuration.variants.iter().map(|(_, name)| *name).collect();
        let expected = configuration.cost_plain;
        let said = format!(
            "{what}, {asked} plain passes: {} on {}; {took:.2}, expected {expected:.2}",
            names.join(", "),
            configuration.executor
        );
        println!("{said}");
        tally.add(said, took <= MOST_TIME * asked);
    }
}
