//! `npr check`.

use crate::loading::Loading;
use crate::paths;
use crate::style::known_style;
use crate::terminal::{announce, progress_bar, say};
use clap::Args;
use npr_harness::check;
use npr_harness::error::HarnessError;
use npr_harness::executor::{Backend, Executor};
use std::path::PathBuf;

#[derive(Args)]
pub struct Options {
    /// Models; without any, the built-in scene.
    inputs: Vec<PathBuf>,
    /// Only the pictures of this style: one of `npr styles`, or a file.toml. May be repeated.
    #[arg(long)]
    style: Vec<String>,
    /// As JSON.
    #[arg(long)]
    json: bool,
    /// Where expected, actual and difference pictures of failed comparisons go.
    #[arg(long, default_value = "npr-out/check")]
    out: PathBuf,
    #[command(flatten)]
    loading: Loading,
}

pub fn run(options: &Options) -> Result<bool, HarnessError> {
    options.loading.check(&options.inputs)?;
    paths::check_output_folder(&options.out)?;
    let styles = options.style.iter().map(|name| known_style(name)).collect::<Result<Vec<_>, _>>()?;
    let executor = Executor::choose(Backend::Auto)?;
    announce(&executor);
    let bar = progress_bar("checking");
    if !options.json {
        say(format_args!("on {}\n", executor.describe()))?;
    }
    let tell = |metric: &check::Metric| {
        if !options.json {
            // A write error is ignored here, because the write at the end reports it.
            let _ = bar.suspend(|| say(format_args!("{metric}\n")));
        }
    };
    let loading = options.loading.options();
    let report = check::run(&executor, &options.inputs, &loading, &styles, &options.out, &tell, &|share| {
        bar.set_position((share * 1000.0) as u64)
    })?;
    bar.finish_and_clear();
    if options.json {
        say(format_args!("{}\n", serde_json::to_string_pretty(&report)?))?;
    } else {
        say(format_args!("{}", report.summary()))?;
    }
    Ok(report.passed())
}
