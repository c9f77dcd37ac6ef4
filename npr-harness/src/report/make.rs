//! Measures what a report shows, stage by stage.

use super::stages::Stages;
use super::{AtlasEntry, ChartContent, CheckTable, Contents, Found, GalleryPicture, Pair, PngPicture};
use crate::chart::{Chart, Lab, Row, Subject, Table, built_in_subjects, charts, subject_of_file};
use crate::check;
use crate::compare::{compare, difference_image};
use crate::error::HarnessError;
use crate::executor::{Backend, Executor, Picture};
use crate::gallery::{self, still_life_camera};
use crate::measure::Rounds;
use crate::picture::Image;
use crate::scene::Scene;
use crate::stability::{Sweep, sweeps};
use crate::style::style;
use crate::view::View;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;
use std::path::{Path, PathBuf};

/// What is to be measured.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Small pictures, one scene and few rounds.
    pub quick: bool,
    /// The models of charts and checks; the built-in scenes if there are none.
    pub models: Vec<PathBuf>,
    /// How models are loaded.
    pub loading: npr_mesh::LoadOptions,
    /// Nothing kept is used.
    pub fresh: bool,
    /// What else results depend on, such as the build of the program.
    pub build: String,
}

impl Options {
    /// The size of the charts' pictures, px.
    pub fn size(&self) -> (u32, u32) {
        if self.quick { (256, 144) } else { (480, 270) }
    }

    /// How often charts measure.
    pub fn rounds(&self) -> Rounds {
        Rounds { rounds: if self.quick { 5 } else { 7 }, ..Rounds::default() }
    }

    /// The scenes of the charts.
    ///
    /// # Errors
    /// Those of [`npr_mesh::load`].
    pub fn subjects(&self) -> Result<Vec<Subject>, HarnessError> {
        if self.models.is_empty() {
            return Ok(built_in_subjects(self.size(), if self.quick { 1 } else { 3 }));
        }
        let mut subjects: Vec<Subject> = Vec::new();
        for path in &self.models {
            let mut subject = subject_of_file(path, &self.loading, self.size())?;
            // Files of different folders may have one name.
            let is_taken = |name: &str| subjects.iter().any(|known| known.name == name);
            if is_taken(&subject.name) {
                let free = (2..).map(|number| format!("{} {number}", subject.name)).find(|name| !is_taken(name));
                subject.name = free.expect("numbers do not end");
            }
            subjects.push(subject);
        }
        Ok(subjects)
    }

    /// What charts are measured with, in a line.
    pub fn describe(&self, subjects: &[Subject]) -> String {
        let ((width, height), rounds) = (self.size(), self.rounds().rounds);
        let names: Vec<_> = subjects.iter().map(|subject| subject.name.as_str()).collect();
        format!("charts: {width} × {height} px, {rounds} rounds, scenes: {}", names.join(", "))
    }

    /// What results depend on.
    fn key(&self, machine: &[String]) -> String {
        let models = self.models.iter().map(|path| {
            let changed = std::fs::metadata(path).and_then(|found| Ok((found.len(), found.modified()?)));
            format!("{} {:?}", path.display(), changed.ok())
        });
        let lines =
            [format!("npr {}", env!("CARGO_PKG_VERSION")), self.build.clone(), format!("quick: {}", self.quick)];
        let loading = format!("{:?}", self.loading);
        lines.into_iter().chain(machine.iter().cloned()).chain(models).chain([loading]).collect::<Vec<_>>().join("\n")
    }
}

/// The adapters, then the CPU: times are relative to the plain pass of the first.
///
/// # Errors
/// Those of [`Executor::all`].
pub fn executors() -> Result<Vec<Executor>, HarnessError> {
    let (cpu, mut executors): (Vec<_>, Vec<_>) = Executor::all()?.into_iter().partition(Executor::is_cpu);
    executors.extend(cpu);
    Ok(executors)
}

/// The machine and the executors, a line each.
pub fn machine(executors: &[Executor]) -> Vec<String> {
    let processor = std::fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    });
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut lines = vec![format!(
        "{}, {threads} threads, {} {}",
        processor.unwrap_or_else(|| "processor of unknown name".into()),
        std::env::consts::OS,
        std::env::consts::ARCH
    )];
    lines.extend(executors.iter().map(|executor| format!("{}: {}", executor.name(), executor.describe())));
    lines
}

/// The state of a run, for a progress bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress<'a> {
    /// The stage.
    pub stage: &'a str,
    /// The number of the stage, from 0.
    pub number: usize,
    /// The number of stages.
    pub stages: usize,
    /// The share of the stage that is done, 0..=1.
    pub share: f64,
}

/// The styles that two executors are shown with.
const PAIRS: [&str; 4] = ["cartoon", "hatch", "gooch", "toon-shadow"];
/// The width of the page's pictures, px.
const MOST_WIDTH: u32 = 640;

enum Stage {
    Gallery,
    Chart(Chart),
    Sweep(Sweep),
    Check,
    Pair(&'static str),
}

impl Stage {
    /// The name, also of the stage's file.
    fn name(&self) -> String {
        match self {
            Self::Gallery => "gallery".into(),
            Self::Chart(chart) => format!("chart-{}", chart.name),
            Self::Sweep(sweep) => format!("sweep-{}", sweep.name),
            Self::Check => "check".into(),
            Self::Pair(style) => format!("pair-{style}"),
        }
    }
}

fn stages() -> Vec<Stage> {
    let charts = charts().into_iter().map(Stage::Chart);
    let sweeps = sweeps().into_iter().map(Stage::Sweep);
    let pairs = PAIRS.into_iter().map(Stage::Pair);
    [Stage::Gallery].into_iter().chain(charts).chain(sweeps).chain([Stage::Check]).chain(pairs).collect()
}

/// Measures a report; results of finished stages are kept in `dir/stages`, and pictures of the gallery in `dir/gallery`.
///
/// # Errors
/// The first error of a stage. What was finished before is kept.
pub fn run(
    dir: &Path,
    options: &Options,
    progress: &(dyn Fn(Progress<'_>) + Sync),
) -> Result<(Contents, Table), HarnessError> {
    let executors = executors()?;
    let mut machine = machine(&executors);
    let kept = Stages::new(&dir.join("stages"), &options.key(&machine))?;
    let all = stages();
    if options.fresh {
        let names: Vec<_> = all.iter().map(Stage::name).collect();
        kept.forget(names.iter().map(String::as_str))?;
    }
    let subjects = options.subjects()?;
    machine.push(options.describe(&subjects));
    let mut contents = Contents { machine: machine.clone(), ..Contents::default() };
    let mut table = Table { machine, ..Table::default() };
    for (number, stage) in all.iter().enumerate() {
        let name = stage.name();
        let tell = |share| progress(Progress { stage: &name, number, stages: all.len(), share });
        tell(0.0);
        match stage {
            Stage::Gallery => {
                contents.gallery = kept.get_or(&name, || pictures(&dir.join("gallery"), &tell))?;
            }
            Stage::Chart(chart) => {
                let measured: Measured =
                    kept.get_or(&name, || measure(chart, &executors, &subjects, options, &tell))?;
                contents.charts.push(content(chart, measured.rows.clone(), &executors));
                table.skipped.extend(measured.skipped);
                table.rows.extend(measured.rows);
            }
            Stage::Sweep(sweep) => contents.atlas.push(kept.get_or(&name, || swept(sweep, &executors))?),
            Stage::Check => {
                contents.check = Some(kept.get_or(&name, || checked(dir, options, &tell))?);
            }
            Stage::Pair(style) => match executors.iter().find(|executor| !executor.is_cpu()) {
                None => contents.skipped.push(format!("{style} by two executors: there is no adapter")),
                Some(device) => contents.pairs.push(kept.get_or(&name, || pair(style, device))?),
            },
        }
    }
    contents.skipped.extend(table.skipped.iter().cloned());
    Ok((contents, table))
}

/// The gallery, rendered into `dir`.
fn pictures(dir: &Path, progress: &(dyn Fn(f64) + Sync)) -> Result<Vec<GalleryPicture>, HarnessError> {
    let mut executor = Executor::choose_for(Backend::Auto, &gallery::work())?;
    let rows = gallery::render(&mut executor, Backend::Auto, dir, progress)?;
    let picture = |row: gallery::Row| {
        let image = Image::load_png(&row.path)?;
        Ok(GalleryPicture {
            name: row.path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
            about: row.about,
            passes: row.passes.into_iter().map(str::to_owned).collect(),
            time_ms: row.time_ms,
            picture: PngPicture::new(&image, MOST_WIDTH)?,
        })
    };
    rows.into_iter().map(picture).collect()
}

/// The rows of a chart, and what was skipped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// The variants that an executor could not make, and why.
    pub skipped: Vec<String>,
    /// The rows.
    pub rows: Vec<Row>,
}

/// Measures a chart.
///
/// # Errors
/// Those of the chart.
pub fn measure(
    chart: &Chart,
    executors: &[Executor],
    subjects: &[Subject],
    options: &Options,
    progress: &(dyn Fn(f64) + Sync),
) -> Result<Measured, HarnessError> {
    let skipped = RefCell::new(Vec::new());
    let lab = Lab {
        executors,
        subjects,
        size: options.size(),
        rounds: options.rounds(),
        skipped: &|what| skipped.borrow_mut().push(what.to_owned()),
        progress,
    };
    let rows = (chart.run)(&lab)?;
    Ok(Measured { skipped: skipped.into_inner(), rows })
}

/// A chart with its rows.
pub fn content(chart: &Chart, rows: Vec<Row>, executors: &[Executor]) -> ChartContent {
    let table = Table { rows, ..Table::default() };
    let points = table.points(chart.name);
    let Chart { name, title, error, about, .. } = *chart;
    ChartContent {
        name: name.into(),
        title: title.into(),
        error: error.into(),
        about: about.into(),
        executors: executors.iter().map(Executor::name).collect(),
        rows: table.rows,
        points,
    }
}

/// Runs a sweep on the CPU, or on the first adapter if it needs one.
///
/// # Errors
/// Those of the sweep.
pub fn swept(sweep: &Sweep, executors: &[Executor]) -> Result<AtlasEntry, HarnessError> {
    let fits = |executor: &&Executor| executor.is_cpu() != sweep.needs_adapter;
    let found = match executors.iter().find(fits) {
        Some(executor) => Ok(Found::new((sweep.run)(executor)?)?),
        None => Err("it needs an adapter, and there is none".to_owned()),
    };
    let (name, technique, what) = (sweep.name.into(), sweep.technique.into(), sweep.what.into());
    Ok(AtlasEntry { name, technique, what, found })
}

/// The checks; in a quick report only of some styles' pictures.
fn checked(dir: &Path, options: &Options, progress: &(dyn Fn(f64) + Sync)) -> Result<CheckTable, HarnessError> {
    let styles: Vec<_> =
        if options.quick { ["cartoon", "gooch"].into_iter().filter_map(style).collect() } else { vec![] };
    let executor = Executor::choose(Backend::Auto)?;
    let out = dir.join("check");
    let report = check::run(&executor, &options.models, &options.loading, &styles, &out, &|_| {}, progress)?;
    Ok(report.into())
}

/// The built-in scene by an adapter and by the CPU.
fn pair(name: &str, device: &Executor) -> Result<Pair, HarnessError> {
    let style = style(name).expect("a style of this crate");
    let scene = Scene::new(npr_mesh::embedded::scene());
    let picture = Picture::new(&scene, &style, View::new(still_life_camera(), PAIR_SIZE));
    let cpu = Executor::Cpu { why: None };
    let [by_cpu, by_device] = [&cpu, device].map(|executor| executor.render(&picture, &|_| {}));
    let (by_cpu, by_device) = (by_cpu?, by_device?);
    let comparison = compare(&by_cpu, &by_device, &[])?;
    Ok(Pair {
        style: name.into(),
        executors: [cpu.name(), device.name()],
        difference: PngPicture::new(&difference_image(&by_cpu, &by_device, &[])?, MOST_WIDTH)?,
        pictures: [PngPicture::new(&by_cpu, MOST_WIDTH)?, PngPicture::new(&by_device, MOST_WIDTH)?],
        differing: comparison.over(0),
        pixels: comparison.pixels,
        worst: comparison.worst,
    })
}

/// The size of compared pictures, px: the page shows them unreduced.
const PAIR_SIZE: (u32, u32) = (640, 360);
