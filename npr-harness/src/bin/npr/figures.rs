//! `npr figures`: the documents' figures, and pairs that differ in one erratum.

use crate::backend::BackendName;
use crate::paths;
use crate::terminal::{announce, progress_bar, say};
use clap::Args;
use npr_harness::error::HarnessError;
use npr_harness::executor::{Backend, Executor};
use npr_harness::figures::{self, Stage};
use npr_harness::suggest::nearest;
use npr_harness::systems;
use std::path::PathBuf;

#[derive(Args)]
pub struct Options {
    /// The folder, which is made if need be. Files of the same names are overwritten.
    #[arg(short, long, value_name = "DIR", required_unless_present = "systems")]
    output: Option<PathBuf>,
    /// Print a table of all systems of the documents instead: code, style key, figure and test of each.
    #[arg(long, exclusive = true)]
    systems: bool,
    /// Only these figures, by name.
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    /// Where the pictures are made.
    #[arg(long, default_value = "auto")]
    backend: BackendName,
}

/// Draws and writes the figures.
pub fn run(options: &Options) -> Result<bool, HarnessError> {
    let Some(output) = options.output.as_ref().filter(|_| !options.systems) else {
        say(format_args!("{}", systems::table()))?;
        return Ok(true);
    };
    paths::check_output_folder(output)?;
    let mut wanted = figures::all();
    if let Some(unknown) = options.names.iter().find(|name| !wanted.iter().any(|figure| figure.name == **name)) {
        let known: Vec<_> = wanted.iter().map(|figure| figure.name).collect();
        let nearest = nearest(unknown, known.iter().copied()).map(str::to_owned);
        return Err(HarnessError::UnknownFigure { name: unknown.clone(), nearest, known: known.join(", ") });
    }
    wanted.retain(|figure| options.names.is_empty() || options.names.iter().any(|name| name == figure.name));
    let backend: Backend = options.backend.into();
    let mut stage = Stage::default();
    let mut executor = Executor::choose_for(backend, &figures::work(&mut stage, &wanted)?)?;
    announce(&executor);
    let made_by = executor.describe().to_string();
    say(format_args!("on {made_by}\n"))?;
    let bar = progress_bar("figures");
    let count = wanted.len();
    let mut drawn = Vec::new();
    for (number, figure) in wanted.into_iter().enumerate() {
        bar.set_position((number * 1000 / count) as u64);
        drawn.push(figures::draw(&mut executor, backend, &mut stage, figure)?);
    }
    bar.finish_and_clear();
    for path in figures::write(output, &drawn, &made_by)? {
        say(format_args!("{}\n", path.display()))?;
    }
    Ok(true)
}
