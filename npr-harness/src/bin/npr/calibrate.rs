//! `npr calibrate`.

use crate::backend::BackendName;
use crate::budget;
use crate::terminal::{announce, say};
use clap::Args;
use npr_harness::error::HarnessError;
use npr_harness::executor::{Backend, Executor};
use std::path::PathBuf;

#[derive(Args)]
pub struct Options {
    /// What is measured: an adapter and the CPU (auto), or one of them.
    #[arg(long, value_enum, default_value = "auto")]
    backend: BackendName,
    /// The cost table as JSON, instead of the cache.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Measures this machine, and keeps what was measured.
pub fn run(options: &Options) -> Result<bool, HarnessError> {
    let backend = Backend::from(options.backend);
    let executor = Executor::choose(backend)?;
    announce(&executor);
    let executors = budget::candidates(executor, backend);
    let Some(path) = options.output.clone().or_else(|| budget::cache_file(&executors)) else {
        return Err(HarnessError::NoCache);
    };
    // What cannot be written is found out before it is measured.
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|source| HarnessError::Write { path: path.clone(), source })?;
    }
    npr_hatch::files::check_writable(&path).map_err(|source| HarnessError::Write { path: path.clone(), source })?;
    let table = budget::measured(&executors)?;
    budget::write(&path, &table)?;
    say(format_args!(
        "{}: {} costs and {} errors, on {}\n",
        path.display(),
        table.entries.len(),
        table.expected.len(),
        table.executors.join(" and ")
    ))?;
    Ok(true)
}
