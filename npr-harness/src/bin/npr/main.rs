//! `npr`: pictures, tables and checks from the command line.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod backend;
mod budget;
mod calibrate;
mod chart;
mod check;
mod cli;
mod completions;
mod export;
mod figures;
mod framing;
mod gallery;
mod inspect;
mod loading;
mod measured;
mod paths;
mod picture;
mod plan;
mod range;
mod render;
mod report;
mod shot;
mod stability;
mod style;
mod tam;
mod terminal;

use clap::Parser;
use cli::{Cli, Command};
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = Cli::parse();
    let done = match cli.command {
        None => gallery::run(),
        Some(Command::Render(options)) => render::run(&options),
        Some(Command::Plan(options)) => plan::run(&options),
        Some(Command::Calibrate(options)) => calibrate::run(&options),
        Some(Command::Inspect(options)) => inspect::run(&options),
        Some(Command::Export(options)) => export::run(&options),
        Some(Command::Check(options)) => check::run(&options),
        Some(Command::Chart(options)) => chart::run(&options),
        Some(Command::Stability(options)) => stability::run(&options),
        Some(Command::Report(options)) => report::run(&options),
        Some(Command::Figures(options)) => figures::run(&options),
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
