//! Budgets as arguments, and the cost table that they need.

use crate::shot::Shot;
use crate::terminal::{progress_bar, tell};
use clap::Args;
use npr_harness::budget::{
    Budget, Choice, Configuration, CostTable, MaxErrors, MaxTime, Measure, configurations, within,
};
use npr_harness::calibrate::calibrate;
use npr_harness::chart::survey::Survey;
use npr_harness::error::HarnessError;
use npr_harness::executor::{Backend, Candidates, Executor, Work};
use npr_harness::plan::{Plan, Reason, part_of_pass};
use npr_harness::scene::Scene;
use npr_harness::variant::{Part, Setup};
use npr_harness::view::View;
use serde_json::json;
use std::fmt::Write;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct BudgetOptions {
    /// Find the cheapest way to make the picture that keeps to these errors on this model in this view: lines, tone or
    /// shadows, such as lines=0.02,tone=0.01. It chooses how lines, light, strokes and shadows are made, the samples and
    /// the executor.
    #[arg(long, value_name = "MEASURE=ERROR,...", conflicts_with = "samples")]
    max_error: Option<MaxErrors>,
    /// Find the most accurate way to make a frame in this time, ms, by a renderer that is kept.
    #[arg(long, value_name = "MS", conflicts_with_all = ["max_plain", "samples"])]
    max_ms: Option<f64>,
    /// The same in multiples of a plain pass: light without bands or lines.
    #[arg(long, value_name = "N", conflicts_with = "samples")]
    max_plain: Option<f64>,
    /// The cost table, from `npr calibrate -o FILE`. Without it the one in the cache is used, and made if there is none.
    #[arg(long, value_name = "FILE")]
    calibration: Option<PathBuf>,
}

/// How a picture is made.
pub struct Settled {
    pub setup: Setup,
    pub view: View,
    pub executor: Executor,
    /// What a budget chose, if there is one.
    pub choice: Option<Choice>,
}

impl BudgetOptions {
    /// The budget, if there is one.
    pub fn budget(&self) -> Result<Option<Budget>, HarnessError> {
        let positive = |what, value: f64| {
            let range = "1e-6..=1e9";
            if (1e-6..=1e9).contains(&value) { Ok(value) } else { Err(HarnessError::Range { what, value, range }) }
        };
        let max_time = match (self.max_ms, self.max_plain) {
            (Some(ms), _) => Some(MaxTime::Ms(positive("the time of a frame", ms)?)),
            (None, Some(plain)) => Some(MaxTime::Plain(positive("the time of a frame", plain)?)),
            (None, None) => None,
        };
        if self.max_error.is_none() && max_time.is_none() {
            return Ok(None);
        }
        Ok(Some(Budget { max_errors: self.max_error.clone().unwrap_or_default(), max_time }))
    }

    /// Settles how the picture of a shot is made: within the budget on an adapter or, unless the backend rules it out, on
    /// the CPU; without one as the style has it, on what is expected to be sooner.
    pub fn settle(&self, scene: &Scene, shot: &Shot, candidates: Candidates) -> Result<Settled, HarnessError> {
        let setup = Setup { style: shot.style.clone(), samples: shot.samples };
        let view = shot.view(scene);
        match self.budget()? {
            Some(budget) => self.chosen(scene, &setup, &view, candidates.choose(), shot.backend, &budget),
            None => {
                let work = Work::new(scene, &setup.style, view.size, setup.samples);
                Ok(Settled { setup, view, executor: candidates.choose_for(&work), choice: None })
            }
        }
    }

    fn chosen(
        &self,
        scene: &Scene,
        setup: &Setup,
        view: &View,
        executor: Executor,
        backend: Backend,
        budget: &Budget,
    ) -> Result<Settled, HarnessError> {
        budget.max_errors.check(&setup.style)?;
        let mut executors = candidates(executor, backend);
        let table = match &self.calibration {
            Some(path) => read(path)?,
            None => cached(&executors)?,
        };
        let usable: Vec<String> = executors.iter().map(Executor::name).collect();
        if let Some(missing) = usable.iter().find(|name| !table.executors.contains(name)) {
            let path = self.calibration.clone().unwrap_or_default();
            let what = format!("it has no costs of {missing}, only of {}: npr calibrate", table.executors.join(", "));
            return Err(HarnessError::Calibration { path, what });
        }
        let mut all = configurations(scene, setup, view, &table);
        all.retain(|configuration| usable.contains(&configuration.executor));
        let mut survey = Survey::new(scene, *view, &setup.style, &executors);
        let choice = within(&all, budget, |configuration, measure| survey.measure(configuration, measure))?;
        drop(survey);
        let at = usable.iter().position(|name| *name == choice.chosen.executor).expect("only usable ones were kept");
        let setup = choice.chosen.setup.clone();
        let view = View { samples: setup.samples, ..*view };
        Ok(Settled { setup, view, executor: executors.swap_remove(at), choice: Some(choice) })
    }
}

/// The executors among which a budget may choose: the adapter first, whose plain pass is the unit of time.
pub fn candidates(executor: Executor, backend: Backend) -> Vec<Executor> {
    let also_cpu = backend == Backend::Auto && !executor.is_cpu();
    let mut executors = vec![executor];
    if also_cpu {
        executors.push(Executor::Cpu { why: None });
    }
    executors
}

/// The cost table of the cache, measured if there is none for this version and these executors.
fn cached(executors: &[Executor]) -> Result<CostTable, HarnessError> {
    let path = cache_file(executors);
    if let Some(path) = path.as_deref().filter(|path| path.exists()) {
        match read(path) {
            Ok(table) => return Ok(table),
            // What an interrupted run or an older version left is made anew.
            Err(error) => tell(&format!("npr: {error}; measuring again")),
        }
    }
    match &path {
        Some(path) => tell(&format!(
            "npr: measuring what each way to draw costs here, once, which takes a minute or two; kept in {}",
            path.display()
        )),
        None => tell("npr: measuring what each way to draw costs here, which takes a minute or two"),
    }
    let table = measured(executors)?;
    if let Some(path) = &path
        && let Err(error) = write(path, &table)
    {
        tell(&format!("npr: {error}; the measurement is not kept, npr calibrate -o FILE keeps it elsewhere"));
    }
    Ok(table)
}

/// Measures a cost table, with a progress bar.
pub fn measured(executors: &[Executor]) -> Result<CostTable, HarnessError> {
    let bar = progress_bar("calibrating");
    let table = calibrate(executors, &|share| bar.set_position((1000.0 * share) as u64))?;
    bar.finish_and_clear();
    Ok(table)
}

/// Where the cost table of some executors is kept; `None` where the system names no folder for caches.
pub fn cache_file(executors: &[Executor]) -> Option<PathBuf> {
    let names: Vec<String> = executors.iter().map(Executor::name).collect();
    let name = format!("calibration-{}-{}.json", env!("CARGO_PKG_VERSION"), names.join("+"));
    Some(dirs::cache_dir()?.join("npr").join(name))
}

/// Reads a cost table.
pub fn read(path: &Path) -> Result<CostTable, HarnessError> {
    let wrong = |what: String| HarnessError::Calibration { path: path.to_owned(), what };
    let text = std::fs::read_to_string(path).map_err(|error| wrong(error.to_string()))?;
    let table: CostTable = serde_json::from_str(&text).map_err(|error| wrong(format!("no cost table: {error}")))?;
    if table.version != env!("CARGO_PKG_VERSION") {
        return Err(wrong(format!("it is of version {}, and this is {}", table.version, env!("CARGO_PKG_VERSION"))));
    }
    let costs = table.entries.iter().flat_map(|entry| [entry.cost.fixed_ms, entry.cost.sample_ns, entry.cost.face_ns]);
    let mut numbers = costs.chain(table.expected.iter().map(|expected| expected.error));
    if let Some(number) = numbers.find(|number| !(number.is_finite() && *number >= 0.0)) {
        return Err(wrong(format!("{number} is neither a cost nor an error")));
    }
    if table.executors.is_empty() || table.entries.is_empty() || table.expected.is_empty() {
        return Err(wrong("a cost table without costs or errors".into()));
    }
    Ok(table)
}

/// Writes a cost table, and the folders to it.
pub fn write(path: &Path, table: &CostTable) -> Result<(), HarnessError> {
    let failed = |source| HarnessError::Write { path: path.to_owned(), source };
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(failed)?;
    }
    npr_hatch::files::write_file(path, serde_json::to_string_pretty(table)?.as_bytes()).map_err(failed)
}

fn errors(of: &[(Measure, f64)]) -> String {
    let each = of.iter().map(|(measure, error)| format!("{measure} {error:.4}"));
    let all = each.collect::<Vec<_>>().join(", ");
    if all.is_empty() { "nothing that errs".into() } else { all }
}

fn short(configuration: &Configuration) -> String {
    let parts = configuration.variants.iter().map(|(part, variant)| format!("{} {variant}", part.name()));
    format!(
        "{:.2} plain passes ({:.1} ms), {}: {}, on {}",
        configuration.cost_plain,
        configuration.cost_ms,
        errors(&configuration.errors),
        parts.collect::<Vec<_>>().join("; "),
        configuration.executor
    )
}

/// What a part of a configuration is expected to cost and to err.
fn expected(configuration: &Configuration, part: Part) -> String {
    let per_plain = configuration.cost_ms / configuration.cost_plain;
    let measure = Measure::of_part(part);
    let cost = configuration.costs_ms.iter().find(|(of, _)| *of == part).map(|(_, ms)| ms);
    let error = configuration.errors.iter().find(|(of, _)| Some(*of) == measure);
    let cost = cost.map(|ms| format!("{:.2} plain passes ({ms:.1} ms)", ms / per_plain)).unwrap_or_default();
    let error = error.map(|(measure, error)| format!(", {measure} off by {error:.4}")).unwrap_or_default();
    cost + &error
}

/// What was chosen, for people: each part with its passes in the plan and why they are there, what it is expected to cost
/// and to err, and what lies beside it.
pub fn summary(choice: &Choice, plan: &Plan) -> String {
    let Choice { chosen, measured, cheaper, better, of } = choice;
    let mut text = format!("  chosen  of {of} ways, on {}\n", chosen.executor);
    let is_hatched = chosen.variants.iter().any(|(part, _)| *part == Part::Strokes);
    for &(part, variant) in &chosen.variants {
        let _ = writeln!(text, "  part    {:<10} {variant:<32} {}", part.name(), expected(chosen, part));
        for Reason { pass, why } in plan.passes.iter().filter(|reason| part_of_pass(reason.pass, is_hatched) == part) {
            let _ = writeln!(text, "            {pass:<36} {why}");
        }
    }
    let _ = writeln!(
        text,
        "  expect  {:.2} plain passes ({:.1} ms), {}",
        chosen.cost_plain,
        chosen.cost_ms,
        errors(&chosen.errors)
    );
    if !measured.is_empty() {
        let _ = writeln!(text, "  here    {}, measured on this model in this view", errors(measured));
    }
    let beside = |other: &Option<Configuration>| other.as_ref().map_or_else(|| "nothing".to_owned(), short);
    let _ = writeln!(text, "  cheaper {}", beside(cheaper));
    let _ = writeln!(text, "  better  {}", beside(better));
    text
}

/// What was chosen, as JSON.
pub fn listed(choice: &Choice) -> serde_json::Value {
    let errors = |of: &[(Measure, f64)]| -> serde_json::Map<String, serde_json::Value> {
        of.iter().map(|(measure, error)| (measure.name().to_owned(), json!(error))).collect()
    };
    let of = |configuration: &Configuration| {
        let variants: serde_json::Map<String, serde_json::Value> =
            configuration.variants.iter().map(|(part, variant)| (part.name().to_owned(), json!(variant))).collect();
        let costs: serde_json::Map<String, serde_json::Value> =
            configuration.costs_ms.iter().map(|(part, ms)| (part.name().to_owned(), json!(ms))).collect();
        json!({
            "executor": configuration.executor, "variants": variants, "parts_ms": costs,
            "ms": configuration.cost_ms, "plain_passes": configuration.cost_plain,
            "expected_errors": errors(&configuration.errors),
        })
    };
    json!({
        "of": choice.of, "chosen": of(&choice.chosen), "measured_errors": errors(&choice.measured),
        "cheaper": choice.cheaper.as_ref().map(of), "better": choice.better.as_ref().map(of),
    })
}
