//! `npr completions`.

use crate::Cli;
use clap::CommandFactory;
use clap_complete::{Shell, generate};

pub fn print(shell: Shell) {
    // In memory first: `generate` panics where it cannot write.
    let mut script = Vec::new();
    generate(shell, &mut Cli::command(), "npr", &mut script);
    print!("{}", String::from_utf8_lossy(&script));
}
