//! `npr stability`: the failure atlas.

use crate::measured::check_names;
use crate::paths;
use crate::terminal::{progress_bar, say};
use clap::Args;
use npr_harness::error::HarnessError;
use npr_harness::report::{Contents, make, page, tables};
use npr_harness::stability::sweeps;
use std::path::PathBuf;

#[derive(Args)]
pub struct Options {
    /// The folder, which is made if need be. Files of the same names are overwritten.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Only these sweeps, by name.
    #[arg(value_name = "NAME")]
    names: Vec<String>,
}

/// Runs the sweeps, and writes diagrams, pictures, a table of limits and a page; false if a limit exceeds its bound.
pub fn run(options: &Options) -> Result<bool, HarnessError> {
    paths::check_output_folder(&options.output)?;
    let mut wanted = sweeps();
    let known: Vec<_> = wanted.iter().map(|sweep| sweep.name).collect();
    check_names("sweep", &options.names, &known)?;
    wanted.retain(|sweep| options.names.is_empty() || options.names.iter().any(|name| name == sweep.name));
    let executors = make::executors()?;
    let bar = progress_bar("sweeps");
    let mut contents = Contents { machine: make::machine(&executors), ..Contents::default() };
    let mut written = Vec::new();
    for (number, sweep) in wanted.iter().enumerate() {
        bar.set_message(sweep.name);
        bar.set_position((number * 1000 / wanted.len()) as u64);
        let entry = make::swept(sweep, &executors)?;
        written.extend(tables::write_sweep(&options.output, &entry)?);
        contents.atlas.push(entry);
    }
    bar.finish_and_clear();
    let mut holds = true;
    for entry in &contents.atlas {
        let found = match &entry.found {
            Ok(found) => found,
            Err(why) => {
                say(format_args!("skipped {}: {why}\n", entry.name))?;
                continue;
            }
        };
        for curve in found.curves.iter().filter(|curve| !curve.limit.bound.holds(curve.limit.measured)) {
            holds = false;
            let limit = &curve.limit;
            say(format_args!("FAIL {}, {}: {} {}\n", entry.name, curve.name, limit.what, limit.measured))?;
        }
    }
    written.push(tables::write(&options.output, "limits.csv", &tables::limits_csv(&contents.atlas)?)?);
    written.push(tables::write(&options.output, "limits.md", tables::limits_markdown(&contents.atlas).as_bytes())?);
    written.push(tables::write(&options.output, "index.html", page(&contents).as_bytes())?);
    for path in written {
        say(format_args!("{}\n", path.display()))?;
    }
    Ok(holds)
}
