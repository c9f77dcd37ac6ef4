//! `npr`: pictures, tables and checks from the command line.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod check;
mod completions;
mod gallery;
mod inspect;
mod loading;
mod paths;
mod picture;
mod render;
mod style;
mod tam;
mod terminal;

use clap::{Parser, Subcommand};
use clap_complete::Shell;
use std::process::ExitCode;

/// Non-photorealistic pictures: outlines and cartoon light, on wgpu and on the CPU.
///
/// Without a command: the gallery of all styles on the built-in scene, into npr-out/.
#[derive(Parser)]
#[command(name = "npr", version)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    /// A picture of a model (.obj, .gltf, .glb).
    Render(render::Options),
    /// What a model is made of.
    Inspect(inspect::Options),
    /// GPU against CPU reference, lines against exact contours; exit status 1 when a limit is exceeded.
    Check(check::Options),
    /// Draws a tonal art map for hatching into a folder, or unpacks one: its images, one file with all, and sheets.
    Tam(tam::Options),
    /// The styles there are.
    Styles,
    /// Prints a style as TOML, to start one's own from.
    Style {
        /// See `npr styles`.
        name: String,
    },
    /// Prints a script that completes the command's arguments in a shell.
    Completions {
        /// Which shell.
        shell: Shell,
    },
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let done = match cli.command {
        None => gallery::run(),
        Some(Command::Render(options)) => render::run(&options),
        Some(Command::Inspect(options)) => inspect::run(&options),
        Some(Command::Check(options)) => check::run(&options),
        Some(Command::Tam(options)) => tam::run(&options),
        Some(Command::Styles) => style::list(),
        Some(Command::Style { name }) => style::print(&name),
        Some(Command::Completions { shell }) => completions::print(shell),
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            terminal::tell(&format!("npr: {}", terminal::one_line(&error.to_string())));
            ExitCode::FAILURE
        }
    }
}
