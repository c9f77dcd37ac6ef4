//! Printed fins as a way to draw lines.

use super::PrintedLines;
use crate::style::Lines;
use crate::variant::{RequestedLines, Setup, Variant};

/// Ways to draw lines. What formats of normals change is a chart of its own.
pub(crate) const VARIANTS: &[Variant] = &[
    Variant {
        name: "fins, as printed",
        choices: &["FinDepth::Printed"],
        historical: true,
        in_budget: false,
        apply: |setup| fins(setup, PrintedLines::default()),
    },
    Variant {
        name: "fins, width by distance",
        choices: &["FinDepth::Eye"],
        historical: false,
        in_budget: true,
        apply: |setup| fins(setup, PrintedLines { eye_depth: true, ..PrintedLines::default() }),
    },
];

fn fins(setup: &Setup, fins: PrintedLines) -> Option<Setup> {
    RequestedLines::drawn(setup, |asked| {
        let RequestedLines { width_px, color, opacity, .. } = *asked;
        (opacity == 1.0).then(|| Lines::printed(PrintedLines { width_px, ink: color, ..fins }))
    })
}
