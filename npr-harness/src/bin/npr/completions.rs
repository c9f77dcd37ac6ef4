//! `npr completions`.

use crate::cli::Cli;
use crate::terminal::say;
use clap::CommandFactory;
use clap_complete::{Shell, generate};
use npr_harness::error::HarnessError;

pub fn print(shell: Shell) -> Result<bool, HarnessError> {
    // In memory first: `generate` panics where it cannot write.
    let mut script = Vec::new();
    generate(shell, &mut Cli::command(), "npr", &mut script);
    say(format_args!("{}", String::from_utf8_lossy(&script)))?;
    Ok(true)
}
