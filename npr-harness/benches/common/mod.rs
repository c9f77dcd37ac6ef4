//! Arguments of the benches, and frames of several styles timed relative to the first.
#![allow(dead_code, reason = "each bench uses a part of it")]

use npr_harness::camera::{Camera, Framing};
use npr_harness::executor::{Backend, Executor};
use npr_harness::measure::{FrameCase, Rounds, Samples, Spread, time_frames};
use npr_harness::plan::Plan;
use npr_harness::scene::Scene;
use npr_harness::style::Style;
use npr_harness::view::View;
use npr_mesh::Model;
use std::path::{Path, PathBuf};

/// The arguments of a bench: `--size WIDTHxHEIGHT`, px; `--model FILE`; `--frames N`, the frames between two waits for
/// the adapter; `--rounds N`; and what else there is.
pub struct Arguments {
    pub size: (u32, u32),
    pub model: Option<PathBuf>,
    pub rounds: Rounds,
    pub rest: Vec<String>,
}

/// The rounds of most benches.
pub const ROUNDS: Rounds = Rounds { rounds: 25, frames_a_wait: None, most_ms: f64::INFINITY };

/// Reads the arguments; ends the process with a message if they are wrong.
pub fn arguments(rounds: Rounds) -> Arguments {
    parsed(rounds, std::env::args().skip(1)).unwrap_or_else(|error| {
        eprintln!("{error}");
        std::process::exit(2)
    })
}

fn parsed(rounds: Rounds, mut arguments: impl Iterator<Item = String>) -> Result<Arguments, String> {
    let mut read = Arguments { size: (1280, 720), model: None, rounds, rest: Vec::new() };
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().ok_or_else(|| format!("{argument}: a value is missing"));
        let number = |text: String| match text.parse::<u32>() {
            Ok(number) if number > 0 => Ok(number),
            _ => Err(format!("{text:?} is not a number of at least 1")),
        };
        match argument.as_str() {
            // Cargo adds this argument.
            "--bench" => {}
            "--size" => {
                let text = value()?;
                let (width, height) = text.split_once('x').ok_or("--size: expected WIDTHxHEIGHT, such as 1280x720")?;
                read.size = (number(width.into())?, number(height.into())?);
            }
            "--model" => read.model = Some(value()?.into()),
            "--frames" => read.rounds.frames_a_wait = Some(number(value()?)?),
            "--rounds" => read.rounds.rounds = number(value()?)? as usize,
            option if option.starts_with("--") => return Err(format!("{option}: no such option")),
            _ => read.rest.push(argument),
        }
    }
    Ok(read)
}

/// A model of the folder that the environment variable `NPR_MODELS` names, by default one beside the checkout; `None`
/// if it is not there.
pub fn shared(file: &str) -> Option<Model> {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data");
    let folder = std::env::var_os("NPR_MODELS").unwrap_or_else(|| beside.into());
    let path = Path::new(&folder).join(file);
    path.exists().then(|| load(&path))
}

pub fn load(path: &Path) -> Model {
    match npr_mesh::load(path, &Default::default()) {
        Ok(loaded) => loaded.into_model(),
        Err(error) => panic!("{}: {error}", path.display()),
    }
}

/// An adapter's executor; `None` with a message if there is none.
pub fn on_adapter() -> Option<Executor> {
    match Executor::choose(Backend::Gpu) {
        Ok(executor) => {
            println!("on {}: {}", executor.name(), executor.describe());
            Some(executor)
        }
        Err(error) => {
            println!("skipped: {error}");
            None
        }
    }
}

/// The model of the arguments; without one the bunny if it is there, else the built-in scene. `change` is applied to it.
pub fn scene(arguments: &Arguments, change: impl Fn(&mut Model)) -> (Scene, Camera) {
    let bunny = || shared("stanford-bunny.obj").map(|bunny| ("bunny".to_owned(), bunny));
    let (name, mut model) = match &arguments.model {
        Some(path) => (path.display().to_string(), load(path)),
        None => bunny().unwrap_or_else(|| ("built-in scene".to_owned(), npr_mesh::embedded::scene())),
    };
    change(&mut model);
    let (scene, (width, height)) = (Scene::new(model), arguments.size);
    let camera = Camera::framed(scene.corners(), f64::from(width) / f64::from(height), &Framing::default());
    println!("{name}, {} faces, {width} × {height} px", scene.face_count());
    (scene, camera)
}

/// A timed case: its name, its style, and samples along each axis of a pixel. The methods are those that the plan
/// selects for the adapter's capabilities after `change`.
pub struct Case<'a> {
    pub name: &'a str,
    pub style: Style,
    pub samples: u32,
    pub change: fn(&mut Plan),
}

impl<'a> Case<'a> {
    /// A case with one sample per pixel and the plan's default methods.
    pub fn new(name: &'a str, style: Style) -> Self {
        Self { name, style, samples: 1, change: |_| {} }
    }
}

/// Prints the least and the median wall time of interleaved rounds, and ratios to the first case within a round: their
/// median, and their quartiles in brackets. Beside it device time, where the adapter has timestamps.
pub fn compare(executor: &Executor, scene: &Scene, camera: &Camera, arguments: &Arguments, cases: &[Case<'_>]) {
    let plan = |Case { style, samples, change, .. }: &Case<'_>| {
        let view = View { samples: *samples, ..View::new(*camera, arguments.size) };
        let mut plan = Plan::new(scene, style, &view, &executor.capabilities()).expect("the styles are valid");
        change(&mut plan);
        plan
    };
    let plans: Vec<Plan> = cases.iter().map(plan).collect();
    let frames: Vec<_> = plans.iter().map(|plan| FrameCase { scene, plan }).collect();
    let timed = time_frames(executor, &frames, &arguments.rounds, &|_| {}).expect("the frames are drawn");
    println!("ms: least, median; ratio to {}: median (quartiles)", cases[0].name);
    println!("{:36} {:^37}   device time", "", "wall time");
    let columns = |samples: &Samples, plain: &Samples| {
        let Spread { median, low, high } = samples.relative_to(plain);
        format!("{:9.2} {:9.2} {median:6.3} ({low:.3}–{high:.3})", samples.least_ms(), samples.spread().median)
    };
    for (timed_case, Case { name, .. }) in timed.iter().zip(cases) {
        let device = match (&timed_case.device, &timed[0].device) {
            (Some(device), Some(plain)) => columns(device, plain),
            _ => "no timestamps".into(),
        };
        println!("{name:36} {:37}   {device}", columns(&timed_case.wall, &timed[0].wall));
    }
}
