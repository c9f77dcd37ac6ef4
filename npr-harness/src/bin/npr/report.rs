//! `npr report`: everything that the laboratory measures, on one page.

use crate::measured::Measured;
use crate::paths;
use crate::terminal::{progress_bar, say};
use clap::Args;
use npr_harness::error::{HarnessError, PathRole};
use npr_harness::report::{changes, make, page, tables};
use std::path::PathBuf;
use std::time::UNIX_EPOCH;

#[derive(Args)]
pub struct Options {
    /// The folder, which is made if need be. Finished parts of an earlier run are used again.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Measure everything again.
    #[arg(long)]
    fresh: bool,
    /// Also write tables and diagrams for the documentation.
    #[arg(long, value_name = "DIR")]
    docs: Option<PathBuf>,
    /// The charts.csv of an earlier run: what became better or worse.
    #[arg(long, value_name = "OLD.csv")]
    compare: Option<PathBuf>,
    #[command(flatten)]
    measured: Measured,
}

/// Measures, and writes `index.html` and `charts.csv`; false if a check or a limit fails.
pub fn run(options: &Options) -> Result<bool, HarnessError> {
    let measuring = options.measured.options()?;
    paths::check_output_folder(&options.output)?;
    if let Some(docs) = &options.docs {
        paths::check_output_folder(docs)?;
    }
    if let Some(old) = &options.compare {
        paths::check_file(PathRole::Table, old)?;
        // Its faults are known before anything is measured.
        changes(old, &npr_harness::chart::Table::default())?;
    }
    let measuring = make::Options { fresh: options.fresh, build: build(), ..measuring };
    let bar = progress_bar("report");
    let (mut contents, table) = make::run(&options.output, &measuring, &|progress| {
        // A stage is named as soon as it begins.
        if progress.share == 0.0 {
            bar.set_message(progress.stage.to_owned());
        }
        bar.set_position((1000.0 * (progress.number as f64 + progress.share) / progress.stages as f64) as u64);
    })?;
    bar.finish_and_clear();
    if let Some(old) = &options.compare {
        contents.changes = Some(changes(old, &table)?);
    }
    let mut written = vec![
        tables::write(&options.output, "index.html", page(&contents).as_bytes())?,
        tables::write(&options.output, "charts.csv", table.to_csv().as_bytes())?,
        tables::write(&options.output, "limits.csv", &tables::limits_csv(&contents.atlas)?)?,
    ];
    if let Some(docs) = &options.docs {
        written.extend(tables::write_docs(docs, &contents)?);
    }
    for path in written {
        say(format_args!("{}\n", path.display()))?;
    }
    let checks = contents.check.iter().flat_map(|check| &check.rows).filter(|row| !row.pass).count();
    let curves = contents.atlas.iter().filter_map(|entry| entry.found.as_ref().ok()).flat_map(|found| &found.curves);
    let limits = curves.filter(|curve| !curve.limit.bound.holds(curve.limit.measured)).count();
    say(format_args!("{checks} checks failed, {limits} limits exceed their bounds\n"))?;
    Ok(checks + limits == 0)
}

/// What tells builds of the same version apart.
fn build() -> String {
    let program = std::env::current_exe().and_then(std::fs::metadata);
    let changed = program.as_ref().ok().and_then(|program| program.modified().ok()?.duration_since(UNIX_EPOCH).ok());
    format!("program: {:?} bytes, changed {changed:?}", program.map(|program| program.len()).ok())
}
