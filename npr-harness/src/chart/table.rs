//! The rows of charts, and their CSV file.

use crate::measure::Spread;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::Write;

/// A measured variant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The chart.
    pub chart: String,
    /// The variant.
    pub variant: String,
    /// Whether it serves comparison alone ([`crate::variant::Variant::historical`]).
    pub historical: bool,
    /// The executor.
    pub executor: String,
    /// The scene.
    pub scene: String,
    /// The errors by name; the first is that of the chart's axis.
    pub errors: Vec<(String, f64)>,
    /// The time.
    pub time: Time,
    /// Memory that its plan takes, bytes.
    pub bytes: u64,
}

/// The time of a variant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Time {
    /// The ratio to the plain pass of the run's first executor.
    pub relative: Spread,
    /// The ratio to the plain pass of its own executor.
    pub relative_own: Spread,
    /// Ms.
    pub ms: Spread,
    /// By the device's timestamps, ms, where it has them.
    pub device_ms: Option<Spread>,
}

/// The rows of a run, and where it ran.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// The machine and the adapters, a line each.
    pub machine: Vec<String>,
    /// The variants that an executor could not make, and why.
    pub skipped: Vec<String>,
    /// The rows.
    pub rows: Vec<Row>,
}

/// A point of a chart: a variant on an executor, over all scenes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// The variant.
    pub variant: String,
    /// Whether it serves comparison alone.
    pub historical: bool,
    /// The executor.
    pub executor: String,
    /// The mean error over the scenes, by name.
    pub errors: Vec<(String, f64)>,
    /// The geometric mean of the relative times over the scenes, and of their quartiles.
    pub relative: Spread,
    /// The most memory of a scene, bytes.
    pub bytes: u64,
    /// The number of scenes.
    pub scenes: usize,
}

impl Point {
    /// The error on the chart's axis.
    pub fn error(&self) -> f64 {
        self.errors.first().map_or(f64::NAN, |error| error.1)
    }
}

impl Table {
    /// The points of a chart, in the order of their first rows.
    pub fn points(&self, chart: &str) -> Vec<Point> {
        let mut order: Vec<(&str, &str)> = Vec::new();
        let mut of: BTreeMap<(&str, &str), Vec<&Row>> = BTreeMap::new();
        for row in self.rows.iter().filter(|row| row.chart == chart) {
            let key = (row.variant.as_str(), row.executor.as_str());
            if !of.contains_key(&key) {
                order.push(key);
            }
            of.entry(key).or_default().push(row);
        }
        order.into_iter().map(|key| point(&of[&key])).collect()
    }

    /// The whole table as CSV (RFC 4180): a line for each row and error, and the machine in a column.
    pub fn to_csv(&self) -> String {
        let mut text = String::from(
            "chart,variant,executor,scene,error,value,relative,relative_low,relative_high,relative_own,ms,ms_low,ms_high,\
             device_ms,bytes,historical,version,machine\r\n",
        );
        let machine = quoted(&self.machine.join("; "));
        for row in &self.rows {
            let Time { relative, relative_own, ms, device_ms } = row.time;
            for (error, value) in &row.errors {
                let names = [&row.chart, &row.variant, &row.executor, &row.scene, error].map(|name| quoted(name));
                let device = device_ms.map(|ms| ms.median.to_string()).unwrap_or_default();
                let _ = write!(
                    text,
                    "{},{value},{},{},{},{},{},{},{},{device},{},{},{},{machine}\r\n",
                    names.join(","),
                    relative.median,
                    relative.low,
                    relative.high,
                    relative_own.median,
                    ms.median,
                    ms.low,
                    ms.high,
                    row.bytes,
                    row.historical,
                    env!("CARGO_PKG_VERSION"),
                );
            }
        }
        text
    }
}

/// A field of CSV.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\r', '\n']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

fn point(rows: &[&Row]) -> Point {
    let count = rows.len() as f64;
    let first = rows[0];
    let mean = |name: &str| {
        let values: Vec<f64> = rows
            .iter()
            .filter_map(|row| row.errors.iter().find(|error| error.0 == name))
            .map(|error| error.1)
            .collect();
        values.iter().sum::<f64>() / values.len() as f64
    };
    let geometric = |of: fn(&Spread) -> f64| {
        (rows.iter().map(|row| of(&row.time.relative).max(f64::MIN_POSITIVE).ln()).sum::<f64>() / count).exp()
    };
    Point {
        variant: first.variant.clone(),
        historical: first.historical,
        executor: first.executor.clone(),
        errors: first.errors.iter().map(|(name, _)| (name.clone(), mean(name))).collect(),
        relative: Spread {
            median: geometric(|spread| spread.median),
            low: geometric(|spread| spread.low),
            high: geometric(|spread| spread.high),
        },
        bytes: rows.iter().map(|row| row.bytes).max().unwrap_or(0),
        scenes: rows.len(),
    }
}
