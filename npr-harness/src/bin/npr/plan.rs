//! `npr plan`.

use crate::budget::{self, BudgetOptions, Settled};
use crate::shot::{Prepared, ShotOptions};
use crate::terminal::{announce, say};
use clap::Args;
use npr_harness::error::HarnessError;
use npr_harness::executor::{Candidates, Picture};
use npr_harness::plan::resources::total_bytes;
use npr_harness::plan::{Plan, Reason, Resource, ResourceKind};
use serde_json::json;

#[derive(Args)]
pub struct Options {
    #[command(flatten)]
    shot: ShotOptions,
    #[command(flatten)]
    budget: BudgetOptions,
    /// As JSON.
    #[arg(long)]
    json: bool,
}

/// Prints how a picture would be made: within a budget, or as the style has it.
pub fn run(options: &Options) -> Result<bool, HarnessError> {
    options.budget.budget()?;
    let shot = options.shot.check()?;
    let backend = shot.backend;
    let looking = std::thread::spawn(move || Candidates::find(backend));
    let Prepared { scene, .. } = options.shot.prepare()?;
    let candidates = looking.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
    let Settled { setup, view, executor, choice } = options.budget.settle(&scene, &shot, candidates)?;
    announce(&executor);
    let picture = Picture { memory_bytes: shot.memory_bytes, ..Picture::new(&scene, &setup.style, view) };
    let plan = picture.plan(executor.capabilities())?;
    let resources = plan.resources(&scene, &executor.capabilities())?;
    if options.json {
        say(format_args!(
            "{}\n",
            json!({
                "input": options.shot.input, "style": setup.style.name, "executor": executor.describe(),
                "samples": setup.samples, "budget": choice.as_ref().map(budget::listed),
                "passes": listed(&plan.passes), "left_out": listed(&plan.left_out), "methods": listed(&plan.methods),
                "bytes": total_bytes(&resources),
                "resources": resources.iter().map(listed_resource).collect::<Vec<_>>(),
            })
        ))?;
        return Ok(true);
    }
    let mut text = format!("on {}\n", executor.describe());
    if let Some(choice) = &choice {
        text.push_str(&budget::summary(choice, &plan));
    }
    // The passes stand with their parts already.
    if choice.is_some() {
        let left_out = Plan { passes: Vec::new(), ..plan.clone() };
        text.push_str(&left_out.to_string());
    } else {
        text.push_str(&plan.to_string());
    }
    text.push_str(&memory(&resources));
    say(format_args!("{text}"))?;
    Ok(true)
}

/// Passes or methods as JSON.
pub fn listed(of: &[Reason]) -> Vec<serde_json::Value> {
    of.iter().map(|reason| json!({"pass": reason.pass, "why": reason.why})).collect()
}

/// What resources take in memory, a line each after that of all.
pub fn memory(resources: &[Resource]) -> String {
    let each: String = resources.iter().map(|resource| format!("  memory  {resource}\n")).collect();
    format!("  memory  {:>12} bytes besides the scene\n{each}", total_bytes(resources))
}

/// A resource as JSON.
pub fn listed_resource(Resource { name, kind, count, bytes }: &Resource) -> serde_json::Value {
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
