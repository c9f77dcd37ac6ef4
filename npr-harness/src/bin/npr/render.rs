//! `npr render`.

use crate::backend::BackendName;
use crate::loading::{Loading, load};
use crate::picture::Destination;
use crate::style::{known_style, style_file};
use crate::terminal::{announce, one_line, progress_bar, say, tell};
use clap::Args;
use glam::{DVec3, DVec4};
use npr_harness::camera::{Camera, Framing};
use npr_harness::capabilities::Capabilities;
use npr_harness::error::HarnessError;
use npr_harness::executor::{Backend, Candidates, Executor, Picture, Rendered, Work};
use npr_harness::picture_limits::{MEMORY_BYTES, MOST_SAMPLES, check_picture};
use npr_harness::plan::resources::total_bytes;
use npr_harness::plan::{Reason, Resource, ResourceKind};
use npr_harness::scene::{Mesh, Scene};
use npr_harness::view::View;
use npr_imagespace::artist::LineKind;
use npr_mesh::{Loaded, Warning, pn_triangles};
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Args)]
pub struct Options {
    /// The model.
    input: PathBuf,
    /// The picture: a file that ends in .png, .jpg, .jpeg (quality 95) or .webp (lossless), or - for PNG on standard
    /// output. With -, everything else is written to standard error, and --json is refused.
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
    /// Print the plan: each pass and why, each that was left out and why, on an adapter by which method each is made and
    /// why; and what all of it takes in memory.
    #[arg(long)]
    plan: bool,
    #[command(flatten)]
    loading: Loading,
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

fn listed_resource(Resource { name, kind, count, bytes }: &Resource) -> serde_json::Value {
    let mut listed = json!({"name": name, "count": count, "bytes": bytes});
    let mut add = |key: &str, value: serde_json::Value| listed[key] = value;
    match kind {
        ResourceKind::Target { format, size, samples } => {
            add("kind", json!("target"));
            add("format", json!(format!("{format:?}")));
            add("size", json!(size));
            add("samples", json!(samples));
        }
        ResourceKind::Texture { format, size, levels } => {
            add("kind", json!("texture"));
            add("format", json!(format!("{format:?}")));
            add("size", json!(size));
            add("levels", json!(levels));
        }
        ResourceKind::Buffer { is_bound } => {
            add("kind", json!("buffer"));
            add("is_bound", json!(is_bound));
        }
        ResourceKind::Array => add("kind", json!("array")),
    }
    listed
}

fn elapsed_ms(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

fn checked(what: &'static str, value: f64, low: f64, high: f64, range: &'static str) -> Result<f64, HarnessError> {
    if (low..=high).contains(&value) { Ok(value) } else { Err(HarnessError::Range { what, value, range }) }
}

pub fn run(options: &Options) -> Result<bool, HarnessError> {
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
    let inputs = [Some(&*options.input), style_file(&options.style)];
    let inputs: Vec<&Path> = inputs.into_iter().flatten().collect();
    let destination = Destination::new(&options.output, options.size, &inputs)?;
    if options.json && matches!(destination, Destination::StandardOutput) {
        return Err(HarnessError::StandardOutputTwice);
    }
    options.loading.check([&options.input])?;
    let style = known_style(&options.style)?;
    let backend = Backend::from(options.backend);
    let check = |on_device| check_picture(&style, options.size, samples, on_device, memory as u64);
    // The executor depends on the model, but a picture too large for either is rejected at once.
    check(backend == Backend::Gpu)?;
    // On another thread, so that the model is loaded while the driver starts.
    let looking = std::thread::spawn(move || Candidates::find(backend));
    let start = Instant::now();
    let loaded = load(&options.input, &options.loading)?;
    let loaded_ms = elapsed_ms(start);
    let warn = |warnings: &[Warning]| {
        for warning in warnings {
            tell(&format!("npr: {}", one_line(&format!("{}: warning: {warning}", options.input.display()))));
        }
    };
    warn(&loaded.warnings);
    let start = Instant::now();
    let segments = checked("segments", f64::from(options.segments), 1.0, 1024.0, "1..=1024")? as u32;
    let Loaded { mut meshes, objects, warnings } = loaded;
    if segments > 1 {
        for mesh in &mut meshes {
            *mesh = pn_triangles::tessellate(mesh, segments)?;
        }
    }
    let mut scene = Scene::with_objects(meshes, objects)?;
    let of_edges = scene.meshes().iter().flat_map(|mesh| mesh.edges().warnings());
    // Meshes may have the same to say.
    let mut counted: Vec<Warning> = Vec::new();
    for text in of_edges {
        match counted.iter_mut().find(|known| known.text == text) {
            Some(known) => known.count += 1,
            None => counted.push(text.into()),
        }
    }
    let of_edges = counted;
    warn(&of_edges);
    let warnings = [warnings, of_edges].concat();
    scene.clip = options.clip.map(|plane| scene.plane_here(plane));
    for (material, kind) in &options.inner_lines {
        scene.set_line_kind(material, *kind)?;
    }
    let mut prepared_ms = elapsed_ms(start);
    let start = Instant::now();
    let candidates = looking.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
    let mut executor = candidates.choose_for(&Work::new(&scene, &style, options.size, samples));
    // The part of the device's start that did not overlap loading.
    let device_ms = elapsed_ms(start);
    announce(&executor);
    let start = Instant::now();
    let frame = || Camera::framed(scene.corners(), f64::from(width) / f64::from(height), &framing);
    let mut picture =
        Picture { memory_bytes: memory as u64, ..Picture::new(&scene, &style, View::new(frame(), options.size)) };
    picture.view.samples = samples;
    // The data that planning derives are cached for rendering.
    if executor.is_cpu() {
        scene.while_building_rays(|| picture.plan(Capabilities::RAY_CASTER))?;
    }
    prepared_ms += elapsed_ms(start);
    let start = Instant::now();
    let bar = progress_bar("rendering");
    let tell = |share| bar.set_position((share * 1000.0) as u64);
    let Rendered { image, plan, why_cpu } = executor.render_with_fallback(backend, &picture, &tell)?;
    if why_cpu.is_some() {
        executor = Executor::Cpu { why: why_cpu };
        announce(&executor);
    }
    bar.finish_and_clear();
    destination.write(&image)?;
    let drawn_ms = elapsed_ms(start);
    let (_, counts) = plan.lines(&scene);
    let placed = |count: fn(&Mesh) -> usize| -> usize {
        scene.objects().iter().map(|object| count(scene.mesh_of(object))).sum()
    };
    let resources =
        if options.json || options.plan { plan.resources(&scene, &executor.capabilities())? } else { Vec::new() };
    let (edges, folds) = (placed(|mesh| mesh.edges().edges.len()), placed(|mesh| mesh.edges().folds.len()));
    if options.json {
        let listed = |of: &[Reason]| of.iter().map(|r| json!({"pass": r.pass, "why": r.why})).collect::<Vec<_>>();
        let warnings: Vec<_> = warnings.iter().map(|w| json!({"text": w.text, "count": w.count})).collect();
        say(format_args!(
            "{}\n",
            json!({
                "input": options.input, "output": options.output, "style": style.name,
                "width": width, "height": height, "executor": executor.describe(),
                "objects": scene.objects().len(), "meshes": scene.meshes().len(), "faces": scene.face_count(),
                "edges": edges, "folds": folds,
                "lines": {"silhouette": counts[0], "boundary": counts[1], "crease": counts[2], "material_border": counts[3]},
                "device_ms": device_ms, "load_ms": loaded_ms, "prepare_ms": prepared_ms, "render_ms": drawn_ms,
                "bytes": total_bytes(&resources),
                "resources": resources.iter().map(listed_resource).collect::<Vec<_>>(),
                "passes": listed(&plan.passes), "left_out": listed(&plan.left_out), "methods": listed(&plan.methods),
                "warnings": warnings,
            })
        ))?;
    } else {
        let folds = match folds {
            0 => String::new(),
            folds => format!(" and {folds} folds of polygons"),
        };
        let mut summary = format!(
            "{}: {width} × {height} px, {} faces, {} lines of {} edges{folds}, {:.0} ms to wait for the device, {:.0} ms to load, {:.0} ms to prepare, {:.0} ms to render, on {}\n",
            options.output.display(),
            scene.face_count(),
            counts.iter().sum::<usize>(),
            edges,
            device_ms,
            loaded_ms,
            prepared_ms,
            drawn_ms,
            executor.describe()
        );
        if options.plan {
            summary.push_str(&plan.to_string());
            summary.push_str(&format!("  memory  {:>12} bytes besides the scene\n", total_bytes(&resources)));
            for resource in &resources {
                summary.push_str(&format!("  memory  {resource}\n"));
            }
        }
        destination.summarize(&summary)?;
    }
    Ok(true)
}
