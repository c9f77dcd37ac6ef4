//! `npr chart`: accuracy against speed.

use crate::measured::{Measured, check_names};
use crate::paths;
use crate::terminal::{progress_bar, say};
use clap::Args;
use npr_harness::chart::{Table, charts};
use npr_harness::error::HarnessError;
use npr_harness::report::{make, tables};
use std::path::PathBuf;

#[derive(Args)]
pub struct Options {
    /// The folder, which is made if need be. Files of the same names are overwritten.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Only this chart, by name. May be repeated.
    #[arg(long, value_name = "NAME")]
    chart: Vec<String>,
    #[command(flatten)]
    measured: Measured,
}

/// Measures the charts, and writes a table of all and a diagram of each.
pub fn run(options: &Options) -> Result<bool, HarnessError> {
    let measuring = options.measured.options()?;
    paths::check_output_folder(&options.output)?;
    let mut wanted = charts();
    let known: Vec<_> = wanted.iter().map(|chart| chart.name).collect();
    check_names("chart", &options.chart, &known)?;
    wanted.retain(|chart| options.chart.is_empty() || options.chart.iter().any(|name| name == chart.name));
    let executors = make::executors()?;
    let subjects = measuring.subjects()?;
    let mut table = Table { machine: make::machine(&executors), ..Table::default() };
    table.machine.push(measuring.describe(&subjects));
    for line in &table.machine {
        say(format_args!("{line}\n"))?;
    }
    let bar = progress_bar("charts");
    let count = wanted.len() as f64;
    let mut contents = Vec::new();
    for (number, chart) in wanted.iter().enumerate() {
        bar.set_message(chart.name);
        let tell = |share| bar.set_position((1000.0 * (number as f64 + share) / count) as u64);
        let measured = make::measure(chart, &executors, &subjects, &measuring, &tell)?;
        contents.push(make::content(chart, measured.rows.clone(), &executors));
        table.skipped.extend(measured.skipped);
        table.rows.extend(measured.rows);
    }
    bar.finish_and_clear();
    for skipped in &table.skipped {
        say(format_args!("skipped: {skipped}\n"))?;
    }
    let mut written = vec![
        tables::write(&options.output, "charts.csv", table.to_csv().as_bytes())?,
        tables::write(&options.output, "charts.md", tables::charts_markdown(&contents, &table.machine).as_bytes())?,
    ];
    for chart in &contents {
        written.extend(tables::write_chart(&options.output, chart)?);
    }
    for path in written {
        say(format_args!("{}\n", path.display()))?;
    }
    Ok(true)
}
