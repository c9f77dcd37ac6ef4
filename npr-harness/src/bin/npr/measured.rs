//! What charts and reports measure, as arguments.

use crate::loading::Loading;
use clap::Args;
use npr_harness::error::HarnessError;
use npr_harness::report::make;
use npr_harness::suggest::nearest;
use std::path::PathBuf;

#[derive(Args)]
pub struct Measured {
    /// Small pictures, one scene, few rounds and few checks.
    #[arg(long)]
    quick: bool,
    /// Models for charts and checks; without any, built-in scenes.
    #[arg(value_name = "MODEL")]
    models: Vec<PathBuf>,
    #[command(flatten)]
    loading: Loading,
}

impl Measured {
    /// Checks the arguments, and makes the options of a run that uses what an earlier one kept.
    pub fn options(&self) -> Result<make::Options, HarnessError> {
        self.loading.check(&self.models)?;
        Ok(make::Options {
            quick: self.quick,
            models: self.models.clone(),
            loading: self.loading.options(),
            ..make::Options::default()
        })
    }
}

/// Checks that all names that were asked for are known.
pub fn check_names(kind: &'static str, asked: &[String], known: &[&str]) -> Result<(), HarnessError> {
    let Some(unknown) = asked.iter().find(|name| !known.contains(&name.as_str())) else { return Ok(()) };
    let nearest = nearest(unknown, known.iter().copied()).map(str::to_owned);
    Err(HarnessError::UnknownMeasurement { kind, name: unknown.clone(), nearest, known: known.join(", ") })
}
