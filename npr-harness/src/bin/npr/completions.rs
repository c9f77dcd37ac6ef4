//! `npr completions`.

use crate::cli::Cli;
use crate::terminal::say;
use clap::CommandFactory;
use clap_complete::{Shell, generate};
use npr_harness::error::HarnessError;

pub fn print(shell: Shell) -> Result<bool, HarnessError> {
    // Written to memory first, because `generate` panics on write errors.
    let mut script = Vec::new();
    generate(shell, &mut Cli::command(), "npr", &mut script);
    say(format_args!("{}", String::from_utf8_lossy(&script)))?;
    Ok(true)
}
