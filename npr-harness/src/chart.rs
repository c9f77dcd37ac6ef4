//! Accuracy against speed: every variant of every technique, measured on the same scenes in one run.
//!
//! A chart has one point for a variant on an executor. Its error is defined in each chart's module, against the truth.
//! Its time is a ratio to a [plain pass](crate::variant::plain) of the same scene and size, both measured in the same interleaved
//! rounds, so that charts from different machines can be laid side by side.
//!
//! Variants come from [`crate::variant`], so a new one is in the charts by being declared.

mod dilation;
mod encodings;
mod frames;
pub mod front;
mod lab;
mod light;
mod lines;
mod shadows;
mod silhouettes;
mod strokes;
pub mod survey;
pub mod table;
mod tonal_art_maps;
mod width;

pub use lab::{Chart, Lab, Subject, built_in_subjects, subject_of_file};
pub use table::{Row, Table, Time};

/// All charts.
pub fn charts() -> Vec<Chart> {
    let first = [lines::CHART, width::CHART, silhouettes::CHART, encodings::CHART];
    let last = [tonal_art_maps::CHART, shadows::CHART];
    [&first[..], &dilation::CHARTS, &light::CHARTS, &strokes::CHARTS, &last].concat()
}
