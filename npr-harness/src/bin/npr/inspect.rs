//! `npr inspect`.

use crate::loading::{Loading, load};
use crate::terminal::say;
use clap::Args;
use npr_harness::error::HarnessError;
use npr_harness::inspect::inspect_loaded;
use npr_mesh::weld::Weld;
use std::path::PathBuf;

#[derive(Args)]
pub struct Options {
    /// The model.
    input: PathBuf,
    /// As JSON.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    loading: Loading,
}

pub fn run(options: &Options) -> Result<bool, HarnessError> {
    let input = &options.input;
    options.loading.check([input])?;
    let loaded = load(input, &options.loading)?;
    let name = input.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    // Without the flag, the topology is that of the file.
    let weld = options.loading.weld().unwrap_or(Weld::Exact);
    let inspection = inspect_loaded(&name, loaded, weld);
    if options.json {
        say(format_args!("{}\n", serde_json::to_string_pretty(&inspection)?))?;
    } else {
        say(format_args!("{inspection}\n"))?;
    }
    Ok(true)
}
