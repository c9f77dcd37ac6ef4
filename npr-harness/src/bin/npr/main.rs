//! `npr`: pictures, tables and checks from the command line.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod loading;
mod tam;

use clap::{Args, Parser, Subcommand, ValueEnum};
use glam::{DVec3, DVec4};
use npr_harness::camera::{Camera, Framing};
use npr_harness::error::HarnessError;
use npr_harness::executor::{Backend, Executor};
use npr_harness::picture_limits::{MEMORY_BYTES, MOST_SAMPLES, check_picture};
use npr_harness::plan::Plan;
use npr_harness::scene::Scene;
use npr_harness::style::{Style, style, styles};
use npr_harness::{check, gallery, inspect};
use npr_hatch::files::check_place;
use npr_imagespace::artist::LineKind;
use npr_mesh::{LoadOptions, pn_triangles};
use serde_json::json;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// Non-photorealistic pictures: outlines and cartoon light, on wgpu and on the CPU.
///
/// Without a command: the gallery of all styles on the built-in scene, into npr-out/.
#[derive(Parser)]
#[command(name = "npr", version)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    /// A picture of a model (.obj, .gltf, .glb).
    Render(Render),
    /// What a model is made of.
    Inspect {
        /// The model.
        input: PathBuf,
        /// As JSON.
        #[arg(long)]
        json: bool,
        #[command(flatten)]
        loading: loading::Loading,
    },
    /// GPU against CPU reference, lines against exact contours; exit status 1 when a limit is exceeded.
    Check {
        /// Models; without any, the built-in scene.
        inputs: Vec<PathBuf>,
        /// Only the pictures of this style: one of `npr styles`, or a file.toml. May be repeated.
        #[arg(long)]
        style: Vec<String>,
        /// As JSON.
        #[arg(long)]
        json: bool,
        /// Where expected, actual and difference pictures of failed comparisons go.
        #[arg(long, default_value = "npr-out/check")]
        out: PathBuf,
        #[command(flatten)]
        loading: loading::Loading,
    },
    /// Draws a tonal art map for hatching into a folder, or unpacks one: its images, one file with all, and sheets.
    Tam(tam::Options),
    /// The styles there are.
    Styles,
    /// Prints a style as TOML, to start one's own from.
    Style {
        /// See `npr styles`.
        name: String,
    },
}

#[derive(Args)]
struct Render {
    /// The model.
    input: PathBuf,
    /// The picture, PNG.
    #[arg(short, long)]
    output: PathBuf,
    /// One of `npr styles`, or a file.toml (see `npr style`).
    #[arg(long, default_value = "cartoon")]
    style: String,
    /// Width and height, px.
    #[arg(long, default_value = "1280x720", value_parser = parse_size)]
    size: (u32, u32),
    /// Where the picture is made.
    #[arg(long, value_enum, default_value = "auto")]
    backend: BackendName,
    /// Around the model, degrees to the right from the side of +Z.
    #[arg(long, default_value_t = 30.0, allow_negative_numbers = true)]
    yaw: f64,
    /// Above the horizon, degrees, -90 to 90.
    #[arg(long, default_value_t = 20.0, allow_negative_numbers = true)]
    pitch: f64,
    /// 1 fits the whole model, 2 is twice as far away.
    #[arg(long, default_value_t = 1.0)]
    distance: f64,
    /// Between the upper and the lower border, degrees.
    #[arg(long, default_value_t = 35.0, conflicts_with = "ortho")]
    fov: f64,
    /// A parallel view.
    #[arg(long)]
    ortho: bool,
    /// Samples per pixel along each axis: 2 or more smooth what has no line on it.
    #[arg(long, default_value_t = 1)]
    samples: u32,
    /// What the picture may take of memory while it is made, GiB.
    #[arg(long, value_name = "GIB", default_value_t = MEMORY_BYTES as f64 / f64::from(1 << 30))]
    max_memory: f64,
    /// Round a coarse model: each edge is cut into so many pieces, on the curves that its normals ask for.
    #[arg(long, default_value_t = 1)]
    segments: u32,
    /// Show only where x NX + y NY + z NZ + D >= 0.
    #[arg(long, value_name = "NX,NY,NZ,D", value_parser = parse_plane, allow_hyphen_values = true)]
    clip: Option<DVec4>,
    /// Where a material's inner lines come from, in styles that ask (`artist`): normals, vertex-colors, texture, regions
    /// or none. May be repeated.
    #[arg(long, value_name = "MATERIAL=KIND", value_parser = parse_line_kind)]
    inner_lines: Vec<(String, LineKind)>,
    /// Print what was done as JSON.
    #[arg(long)]
    json: bool,
    /// Print the plan: each pass and why, each that was left out and why.
    #[arg(long)]
    plan: bool,
    #[command(flatten)]
    loading: loading::Loading,
}

#[derive(Clone, Copy, ValueEnum)]
enum BackendName {
    Auto,
    Gpu,
    Cpu,
}

fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let number = |part: &str| part.parse::<u32>().map_err(|_| format!("{part:?} is not a number of pixels"));
    let (width, height) = text.split_once(['x', 'X']).ok_or("expected WIDTHxHEIGHT, such as 1280x720")?;
    Ok((number(width)?, number(height)?))
}

fn parse_plane(text: &str) -> Result<DVec4, String> {
    let number = |part: &str| part.trim().parse::<f64>().map_err(|_| format!("{part:?} is not a number"));
    let numbers = text.split(',').map(number).collect::<Result<Vec<_>, _>>()?;
    let plane = <[f64; 4]>::try_from(numbers).map_err(|_| "expected four numbers: NX,NY,NZ,D")?;
    let plane = DVec4::from(plane);
    if plane.is_finite() && plane.truncate() != DVec3::ZERO { Ok(plane) } else { Err("no plane".into()) }
}

fn parse_line_kind(text: &str) -> Result<(String, LineKind), String> {
    let (material, kind) = text.rsplit_once('=').ok_or("expected MATERIAL=KIND")?;
    let kind = match kind {
        "normals" => LineKind::Normals,
        "vertex-colors" => LineKind::VertexColor,
        "texture" => LineKind::Texture,
        "regions" => LineKind::Regions,
        "none" => LineKind::None,
        other => return Err(format!("{other:?} is none of normals, vertex-colors, texture, regions, none")),
    };
    Ok((material.to_owned(), kind))
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let done = match cli.command {
        None => run_gallery(),
        Some(Command::Render(options)) => run_render(&options),
        Some(Command::Inspect { input, json, loading }) => run_inspect(&input, json, &loading.options()),
        Some(Command::Check { inputs, style, json, out, loading }) => {
            run_check(&inputs, &loading.options(), &style, json, &out)
        }
        Some(Command::Tam(options)) => tam::run(&options),
        Some(Command::Styles) => {
            for style in styles() {
                println!("{:<16}{}", style.name, style.about);
            }
            Ok(true)
        }
        Some(Command::Style { name }) => run_style(&name),
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("npr: {}", one_line(&error.to_string()));
            ExitCode::FAILURE
        }
    }
}

/// Names in files may hold anything; no line break of theirs, and nothing that commands a terminal, is printed.
fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// A bar on a terminal, nothing elsewhere.
fn progress_bar(what: &str) -> indicatif::ProgressBar {
    if !std::io::stderr().is_terminal() {
        return indicatif::ProgressBar::hidden();
    }
    let bar = indicatif::ProgressBar::new(1000);
    if let Ok(style) = indicatif::ProgressStyle::with_template("{msg:24} {bar:40} {percent:>3}% {eta}") {
        bar.set_style(style);
    }
    bar.set_message(what.to_owned());
    bar
}

fn spinner(what: &str) -> indicatif::ProgressBar {
    if !std::io::stderr().is_terminal() {
        return indicatif::ProgressBar::hidden();
    }
    let bar = indicatif::ProgressBar::new_spinner();
    bar.set_message(what.to_owned());
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    bar
}

fn load(path: &Path, options: &LoadOptions) -> Result<npr_mesh::Loaded, HarnessError> {
    let bar = spinner(&format!("reading {}", path.display()));
    let loaded = npr_mesh::load(path, options)?;
    bar.finish_and_clear();
    Ok(loaded)
}

fn announce(executor: &Executor) {
    if let Executor::Cpu { why: Some(why) } = executor {
        eprintln!("npr: rendering on the CPU: {}", one_line(why));
    }
}

fn run_gallery() -> Result<bool, HarnessError> {
    let executor = Executor::choose(Backend::Auto)?;
    announce(&executor);
    println!("on {}", executor.describe());
    let bar = progress_bar("gallery");
    let rows = gallery::render(&executor, Path::new("npr-out"), &|share| bar.set_position((share * 1000.0) as u64))?;
    bar.finish_and_clear();
    print!("{}", gallery::table(&rows));
    Ok(true)
}

fn checked(what: &'static str, value: f64, low: f64, high: f64, range: &'static str) -> Result<f64, HarnessError> {
    if (low..=high).contains(&value) { Ok(value) } else { Err(HarnessError::Range { what, value, range }) }
}

fn run_render(options: &Render) -> Result<bool, HarnessError> {
    let start = Instant::now();
    let (width, height) = options.size;
    let most = f64::from(MOST_SAMPLES);
    let samples = checked("samples", f64::from(options.samples), 1.0, most, "1..=64")? as u32;
    let memory = checked("memory", options.max_memory, 0.0, 1e6, "0..=1e6 GiB")? * f64::from(1 << 30);
    let framing = Framing {
        yaw_rad: checked("yaw", options.yaw, -1e6, 1e6, "-1e6..=1e6 degrees")?.to_radians(),
        pitch_rad: checked("pitch", options.pitch, -90.0, 90.0, "-90..=90 degrees")?.to_radians(),
        distance: checked("distance", options.distance, 1e-3, 1e3, "0.001..=1000")?,
        fov_y_rad: if options.ortho {
            None
        } else {
            Some(checked("field of view", options.fov, 1.0, 170.0, "1..=170 degrees")?.to_radians())
        },
    };
    let style = known_style(&options.style)?;
    check_output(&options.output, &[&options.input, Path::new(&options.style)])?;
    let backend = match options.backend {
        BackendName::Auto => Backend::Auto,
        BackendName::Gpu => Backend::Gpu,
        BackendName::Cpu => Backend::Cpu,
    };
    let mut executor = Executor::choose(backend)?;
    let check = |executor: &Executor| check_picture(&style, options.size, samples, !executor.is_cpu(), memory as u64);
    check(&executor)?;
    announce(&executor);
    let loaded = load(&options.input, &options.loading.options())?;
    let loaded_ms = start.elapsed().as_secs_f64() * 1e3;
    for warning in &loaded.warnings {
        eprintln!("npr: {}", one_line(&format!("{}: warning: {warning}", options.input.display())));
    }
    let segments = checked("segments", f64::from(options.segments), 1.0, 1024.0, "1..=1024")? as u32;
    let model = if segments > 1 { pn_triangles::tessellate(&loaded.model, segments)? } else { loaded.model };
    let mut scene = Scene::new(model);
    let mut warnings = loaded.warnings;
    for warning in scene.edges.warnings() {
        eprintln!("npr: {}", one_line(&format!("{}: warning: {warning}", options.input.display())));
        warnings.push(warning);
    }
    scene.clip = options.clip.map(|plane| scene.plane_here(plane));
    for (material, kind) in &options.inner_lines {
        scene.set_line_kind(material, *kind)?;
    }
    let decide = || {
        let camera = Camera::framed(scene.corners(), f64::from(width) / f64::from(height), &framing);
        Plan::new(&scene, &style, &camera).map(|plan| (camera, plan))
    };
    let (camera, plan) = if executor.is_cpu() { scene.while_building_rays(decide) } else { decide() }?;
    let prepared_ms = start.elapsed().as_secs_f64() * 1e3 - loaded_ms;
    let drawing = Instant::now();
    let bar = progress_bar("rendering");
    let render = |executor: &Executor| {
        let tell = |share| bar.set_position((share * 1000.0) as u64);
        executor.render(&scene, &style, &plan, &camera, options.size, samples, &tell)
    };
    let image = match render(&executor) {
        Ok(image) => image,
        Err(error) => {
            executor = Executor::instead(backend, error)?;
            check(&executor)?;
            announce(&executor);
            render(&executor)?
        }
    };
    bar.finish_and_clear();
    image.save_png(&options.output)?;
    let drawn_ms = drawing.elapsed().as_secs_f64() * 1e3;
    let (_, counts) = plan.lines(camera.homogeneous_eye());
    if options.json {
        let passes: Vec<_> = plan.passes.iter().map(|r| json!({"pass": r.pass, "why": r.why})).collect();
        let left_out: Vec<_> = plan.left_out.iter().map(|r| json!({"pass": r.pass, "why": r.why})).collect();
        println!(
            "{}",
            json!({
                "input": options.input, "output": options.output, "style": style.name,
                "width": width, "height": height, "executor": executor.describe(),
                "faces": scene.model.faces.len(), "edges": scene.edges.edges.len(), "folds": scene.edges.folds.len(),
                "lines": {"silhouette": counts[0], "boundary": counts[1], "crease": counts[2], "material_border": counts[3]},
                "load_ms": loaded_ms, "prepare_ms": prepared_ms, "render_ms": drawn_ms,
                "passes": passes, "left_out": left_out, "warnings": warnings,
            })
        );
    } else {
        let folds = match scene.edges.folds.len() {
            0 => String::new(),
            folds => format!(" and {folds} folds of polygons"),
        };
        println!(
            "{}: {width} × {height} px, {} faces, {} lines of {} edges{folds}, {:.0} ms to load, {:.0} ms to prepare, {:.0} ms to render, on {}",
            options.output.display(),
            scene.model.faces.len(),
            counts.iter().sum::<usize>(),
            scene.edges.edges.len(),
            loaded_ms,
            prepared_ms,
            drawn_ms,
            executor.describe()
        );
        if options.plan {
            print!("{plan}");
        }
    }
    Ok(true)
}

/// Says before anything is computed what could not be written, and spares what is read.
fn check_output(output: &Path, inputs: &[&Path]) -> Result<(), HarnessError> {
    check_place(output).map_err(|source| HarnessError::Write { path: output.to_owned(), source })?;
    let is_output = |input: &&Path| {
        let real = |path: &Path| std::fs::canonicalize(path).ok();
        real(input).is_some_and(|input| Some(input) == real(output))
    };
    if inputs.iter().any(is_output) {
        return Err(HarnessError::Overwrites { path: output.to_owned() });
    }
    Ok(())
}

fn run_style(name: &str) -> Result<bool, HarnessError> {
    print!("{}", known_style(name)?.to_toml()?);
    Ok(true)
}

/// What ends in `.toml` is a file.
fn known_style(name: &str) -> Result<Style, HarnessError> {
    let path = Path::new(name);
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
        return Ok(Style::read(path)?);
    }
    style(name).ok_or_else(|| HarnessError::UnknownStyle {
        name: name.to_owned(),
        known: styles().into_iter().map(|s| s.name).collect::<Vec<_>>().join(", "),
    })
}

fn run_inspect(input: &Path, as_json: bool, options: &LoadOptions) -> Result<bool, HarnessError> {
    let loaded = load(input, options)?;
    let name = input.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let inspection = inspect::inspect(&name, &loaded.model, loaded.warnings);
    if as_json {
        println!("{}", serde_json::to_string_pretty(&inspection)?);
    } else {
        print!("{inspection}");
    }
    Ok(true)
}

fn run_check(
    inputs: &[PathBuf],
    loading: &LoadOptions,
    styles: &[String],
    as_json: bool,
    out: &Path,
) -> Result<bool, HarnessError> {
    let executor = Executor::choose(Backend::Auto)?;
    announce(&executor);
    let styles = styles.iter().map(|name| known_style(name)).collect::<Result<Vec<_>, _>>()?;
    let bar = progress_bar("checking");
    if !as_json {
        println!("on {}", executor.describe());
    }
    let tell = |metric: &check::Metric| {
        if !as_json {
            bar.suspend(|| println!("{metric}"));
        }
    };
    let report = check::run(&executor, inputs, loading, &styles, out, &tell, &|share| {
        bar.set_position((share * 1000.0) as u64)
    })?;
    bar.finish_and_clear();
    if as_json {
        println!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        print!("{}", report.summary());
    }
    Ok(report.passed())
}
