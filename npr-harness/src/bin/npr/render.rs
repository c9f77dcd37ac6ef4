//! `npr render`.

use crate::budget::{self, BudgetOptions, Settled};
use crate::picture::Destination;
use crate::plan::{listed, listed_resource, memory};
use crate::shot::{Prepared, ShotOptions, elapsed_ms};
use crate::terminal::{announce, progress_bar, say};
use clap::Args;
use npr_harness::capabilities::Capabilities;
use npr_harness::error::HarnessError;
use npr_harness::executor::{Candidates, Executor, Picture, Rendered};
use npr_harness::plan::resources::total_bytes;
use npr_harness::scene::Mesh;
use serde_json::json;
use std::path::PathBuf;
use std::time::Instant;

#[derive(Args)]
pub struct Options {
    #[command(flatten)]
    shot: ShotOptions,
    /// The picture: a file that ends in .png, .jpg, .jpeg (quality 95) or .webp (lossless), or - for PNG on standard
    /// output. With -, everything else is written to standard error, and --json is refused.
    #[arg(short, long)]
    output: PathBuf,
    /// Print what was done as JSON.
    #[arg(long)]
    json: bool,
    /// Print the plan: each pass and why, each that was left out and why, on an adapter by which method each is made and
    /// why; and what all of it takes in memory.
    #[arg(long)]
    plan: bool,
    #[command(flatten)]
    budget: BudgetOptions,
}

pub fn run(options: &Options) -> Result<bool, HarnessError> {
    let (width, height) = options.shot.size;
    let destination = Destination::new(&options.output, options.shot.size, &options.shot.inputs())?;
    if options.json && matches!(destination, Destination::StandardOutput) {
        return Err(HarnessError::StandardOutputTwice);
    }
    options.budget.budget()?;
    let shot = options.shot.check()?;
    let backend = shot.backend;
    // On another thread, so that the model is loaded while the driver starts.
    let looking = std::thread::spawn(move || Candidates::find(backend));
    let Prepared { scene, warnings, loaded_ms, mut prepared_ms } = options.shot.prepare()?;
    let start = Instant::now();
    let candidates = looking.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
    // The part of the device's start that did not overlap loading.
    let device_ms = elapsed_ms(start);
    let start = Instant::now();
    let Settled { setup, view, mut executor, choice } = options.budget.settle(&scene, &shot, candidates)?;
    announce(&executor);
    let style = &setup.style;
    let picture = Picture { memory_bytes: shot.memory_bytes, ..Picture::new(&scene, style, view) };
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
        let warnings: Vec<_> = warnings.iter().map(|w| json!({"text": w.text, "count": w.count})).collect();
        say(format_args!(
            "{}\n",
            json!({
                "input": options.shot.input, "output": options.output, "style": style.name,
                "width": width, "height": height, "executor": executor.describe(),
                "objects": scene.objects().len(), "meshes": scene.meshes().len(), "faces": scene.face_count(),
                "edges": edges, "folds": folds,
                "lines": {"silhouette": counts[0], "boundary": counts[1], "crease": counts[2], "material_border": counts[3], "authored": counts[4]},
                "device_ms": device_ms, "load_ms": loaded_ms, "prepare_ms": prepared_ms, "render_ms": drawn_ms,
                "bytes": total_bytes(&resources),
                "resources": resources.iter().map(listed_resource).collect::<Vec<_>>(),
                "budget": choice.as_ref().map(budget::listed),
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
        if let Some(choice) = &choice {
            summary.push_str(&budget::summary(choice, &plan));
        }
        if options.plan {
            summary.push_str(&plan.to_string());
            summary.push_str(&memory(&resources));
        }
        destination.summarize(&summary)?;
    }
    Ok(true)
}
