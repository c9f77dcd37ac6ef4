//! Charts and limits as Markdown and CSV, and their diagrams as files.

use super::{AtlasEntry, ChartContent, Found, atlas_diagram, chart_diagram};
use crate::chart::front::{dominated, front};
use crate::check::Limit;
use crate::error::HarnessError;
use crate::plot::{curves, number, png, scatter};
use npr_hatch::files::write_file;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// The charts that a README shows.
const README_CHARTS: [&str; 3] = ["lines", "dilation-16", "shadows"];
/// Pixels of PNG diagrams for each CSS pixel.
const PNG_SCALE: f32 = 1.5;

/// Writes a file of text or bytes into `dir`, and returns its path.
///
/// # Errors
/// [`HarnessError::Write`].
pub fn write(dir: &Path, name: &str, bytes: &[u8]) -> Result<PathBuf, HarnessError> {
    let path = dir.join(name);
    let failed = |source| HarnessError::Write { path: path.clone(), source };
    std::fs::create_dir_all(dir).map_err(failed)?;
    write_file(&path, bytes).map_err(failed)?;
    Ok(path)
}

/// Writes the diagram of a chart: NAME.svg and NAME.png.
///
/// # Errors
/// [`HarnessError::Write`], [`HarnessError::Plot`].
pub fn write_chart(dir: &Path, chart: &ChartContent) -> Result<Vec<PathBuf>, HarnessError> {
    let diagram = crate::plot::Scatter { title: chart.title.clone(), ..chart_diagram(chart) };
    diagram_files(dir, &chart.name, &scatter(&diagram))
}

/// Writes the diagram of a sweep, NAME.svg and NAME.png, and its pictures, NAME-1.png and so on. A sweep that was skipped
/// has none.
///
/// # Errors
/// [`HarnessError::Write`], [`HarnessError::Plot`].
pub fn write_sweep(dir: &Path, entry: &AtlasEntry) -> Result<Vec<PathBuf>, HarnessError> {
    let Ok(found) = &entry.found else { return Ok(Vec::new()) };
    let diagram = crate::plot::Curves { title: entry.name.replace('-', " "), ..atlas_diagram(found) };
    let mut paths = diagram_files(dir, &entry.name, &curves(&diagram))?;
    for (n, (_, picture)) in found.pictures.iter().enumerate() {
        paths.push(write(dir, &format!("{}-{}.png", entry.name, n + 1), &picture.png)?);
    }
    Ok(paths)
}

fn diagram_files(dir: &Path, name: &str, svg: &str) -> Result<Vec<PathBuf>, HarnessError> {
    let picture = png(svg, PNG_SCALE)?;
    Ok(vec![write(dir, &format!("{name}.svg"), svg.as_bytes())?, write(dir, &format!("{name}.png"), &picture)?])
}

/// A field of a Markdown table.
fn field(text: &str) -> String {
    text.replace('|', "\\|").replace(['\r', '\n'], " ")
}

/// The heading of the table of each chart in [`charts_markdown`].
pub const CHART_COLUMNS: &str = "| variant | executor | error | relative time | quartiles | bytes | standing |\n| --- | --- | --- | --- | --- | --- | --- |\n";

/// The charts as Markdown: a heading and a table for each.
pub fn charts_markdown(charts: &[ChartContent], machine: &[String]) -> String {
    let mut text = String::from(
        "# Accuracy and speed\n\nMade by `npr report --docs`. Each row is a variant on an executor, over all scenes of the \
         run. Time is that of a frame relative to a plain pass of the first executor, measured in the same rounds: the median \
         and the quartiles.\n\n",
    );
    // Writing to a String cannot fail.
    for line in machine {
        let _ = writeln!(text, "- {line}");
    }
    for chart in charts {
        let points = &chart.points;
        let (front, dominated) = (front(points), dominated(points));
        let _ = writeln!(text, "\n## {}\n\n{} Error: {}.\n", chart.title, chart.about, chart.error);
        text.push_str(CHART_COLUMNS);
        for (n, point) in points.iter().enumerate() {
            let standing = match dominated.iter().find(|dominated| dominated.point == n) {
                Some(found) => {
                    let by = &points[found.by];
                    let on = if by.executor == point.executor { String::new() } else { format!(" on {}", by.executor) };
                    format!("dominated by {}{on}{}", by.variant, if found.clearly { "" } else { ", times overlap" })
                }
                None if front.contains(&n) => "front".into(),
                None => "no error".into(),
            };
            let historical = if point.historical { " (historical)" } else { "" };
            let _ = writeln!(
                text,
                "| {}{historical} | {} | {} | {} | {} to {} | {} | {} |",
                field(&point.variant),
                field(&point.executor),
                super::html::number(point.error()),
                number(point.relative.median),
                number(point.relative.low),
                number(point.relative.high),
                point.bytes,
                field(&standing)
            );
        }
    }
    text
}

/// The columns of limits.
pub const LIMIT_COLUMNS: [&str; 9] =
    ["sweep", "technique", "method", "limit", "measured", "predicted", "formula", "bound", "to be mended"];

/// The limits of the atlas, a row for each method; a skipped sweep has one row that says why.
fn limit_rows(entries: &[AtlasEntry], number: fn(f64) -> String) -> Vec<[String; 9]> {
    let mut rows = Vec::new();
    for entry in entries {
        let names = [entry.name.clone(), entry.technique.clone()];
        let Found { curves, .. } = match &entry.found {
            Ok(found) => found,
            Err(why) => {
                let [name, technique] = names;
                let nothing = String::new;
                let skipped = format!("skipped: {why}");
                let rest = [nothing(), nothing(), nothing(), nothing(), nothing()];
                let [measured, predicted, formula, bound, mended] = rest;
                rows.push([name, technique, nothing(), skipped, measured, predicted, formula, bound, mended]);
                continue;
            }
        };
        for curve in curves {
            let limit = &curve.limit;
            let (predicted, formula) = limit
                .predicted
                .as_ref()
                .map_or_else(Default::default, |(value, formula)| (number(*value), formula.clone()));
            let bound = match limit.bound {
                Limit::AtLeast(value) => format!("≥ {}", number(value)),
                Limit::AtMost(value) => format!("≤ {}", number(value)),
            };
            let mended = limit.to_be_mended.clone().unwrap_or_default();
            let [name, technique] = names.clone();
            let measured = number(limit.measured);
            let (method, what) = (curve.name.clone(), limit.what.clone());
            rows.push([name, technique, method, what, measured, predicted, formula, bound, mended]);
        }
    }
    rows
}

/// The limits of the atlas as Markdown.
pub fn limits_markdown(entries: &[AtlasEntry]) -> String {
    let mut text = String::from(
        "# Limits\n\nMade by `npr report --docs`: where each method stops working, beside the value that a formula predicts and \
         the bound that a test holds it to.\n\n",
    );
    let _ = writeln!(text, "| {} |\n|{}", LIMIT_COLUMNS.join(" | "), " --- |".repeat(LIMIT_COLUMNS.len()));
    for row in limit_rows(entries, super::html::number) {
        let _ = writeln!(text, "| {} |", row.map(|text| field(&text)).join(" | "));
    }
    text
}

/// The limits of the atlas as CSV.
///
/// # Errors
/// None in practice; [`HarnessError::Write`] for a writer that fails.
pub fn limits_csv(entries: &[AtlasEntry]) -> Result<Vec<u8>, HarnessError> {
    let failed = |error: csv::Error| HarnessError::Write { path: "limits.csv".into(), source: error.into() };
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(LIMIT_COLUMNS).map_err(failed)?;
    for row in limit_rows(entries, |value| value.to_string()) {
        writer.write_record(&row).map_err(failed)?;
    }
    writer.into_inner().map_err(|error| HarnessError::Write { path: "limits.csv".into(), source: error.into_error() })
}

/// Writes `charts.md`, `limits.md`, and the diagrams of three charts and of the first sweep for a README.
///
/// # Errors
/// [`HarnessError::Write`], [`HarnessError::Plot`].
pub fn write_docs(dir: &Path, contents: &super::Contents) -> Result<Vec<PathBuf>, HarnessError> {
    let mut paths = vec![
        write(dir, "charts.md", charts_markdown(&contents.charts, &contents.machine).as_bytes())?,
        write(dir, "limits.md", limits_markdown(&contents.atlas).as_bytes())?,
    ];
    for chart in contents.charts.iter().filter(|chart| README_CHARTS.contains(&chart.name.as_str())) {
        let diagram = crate::plot::Scatter { title: chart.title.clone(), ..chart_diagram(chart) };
        paths.push(write(dir, &format!("chart-{}.png", chart.name), &png(&scatter(&diagram), 1.0)?)?);
    }
    let found = contents.atlas.iter().find_map(|entry| Some((entry, entry.found.as_ref().ok()?)));
    if let Some((entry, found)) = found {
        let diagram = crate::plot::Curves { title: entry.name.replace('-', " "), ..atlas_diagram(found) };
        paths.push(write(dir, "limits.png", &png(&curves(&diagram), 1.0)?)?);
    }
    Ok(paths)
}
