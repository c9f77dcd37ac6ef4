//! The command's arguments.

use crate::{calibrate, chart, check, export, figures, inspect, plan, render, report, stability, tam};
use clap::{Parser, Subcommand};
use clap_complete::Shell;

/// Non-photorealistic pictures: outlines and cartoon light, on wgpu and on the CPU.
///
/// Without a command: the gallery of all styles on the built-in scene, into npr-out/.
#[derive(Parser)]
#[command(name = "npr", version)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Option<Command>,
}

#[derive(Subcommand)]
pub enum Command {
    /// A picture of a model (.obj, .gltf, .glb, .ply, .stl).
    Render(render::Options),
    /// How a picture would be made, and why; within a budget of error or time, the way that suits it.
    Plan(plan::Options),
    /// Measures what each way to draw costs on this machine, for budgets.
    Calibrate(calibrate::Options),
    /// What a model is made of.
    Inspect(inspect::Options),
    /// Writes a model as .glb, with the edges that are lines (EXT_mesh_primitive_edge_visibility).
    Export(export::Options),
    /// GPU against CPU reference, lines against exact contours; exit status 1 when a limit is exceeded.
    Check(check::Options),
    /// Accuracy against speed of every variant of every technique: a table and diagrams.
    Chart(chart::Options),
    /// Where each method stops working: diagrams, pictures, a table of limits and a page; exit status 1 when a bound is
    /// exceeded.
    Stability(stability::Options),
    /// Gallery, charts, failure atlas and checks on one page; an interrupted run goes on where it was.
    Report(report::Options),
    /// The figures of the documents, and what their errata change: pictures, style files and a page with captions.
    Figures(figures::Options),
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
