//! What became better or worse since an earlier run, from the CSV files of charts ([`crate::chart::Table::to_csv`]).

use crate::chart::Table;
use crate::chart::table::Row;
use crate::error::HarnessError;
use npr_hatch::files::read_file;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// No table is larger, bytes.
const MOST_BYTES: u64 = 256 << 20;

/// What differs between two runs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changes {
    /// The earlier run: its versions and machines.
    pub old: Vec<String>,
    /// The differences: worse first, then better, then added and removed.
    pub changes: Vec<Change>,
    /// The number of values that were compared.
    pub compared: usize,
}

/// A difference.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Which way.
    pub direction: Direction,
    /// The chart.
    pub chart: String,
    /// The variant.
    pub variant: String,
    /// The executor.
    pub executor: String,
    /// The scene.
    pub scene: String,
    /// The error, or "relative time".
    pub what: String,
    /// The earlier value.
    pub old: Option<f64>,
    /// The present value.
    pub new: Option<f64>,
}

/// The way that a value went.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Direction {
    /// A larger error, or a longer time.
    Worse,
    /// A smaller error, or a shorter time.
    Better,
    /// Measured now only.
    Added,
    /// Measured earlier only.
    Removed,
}

/// Chart, variant, executor, scene, and the error; the error is empty for the time.
type Key = [String; 5];

/// A value with the range within which it is the same.
#[derive(Clone, Copy)]
struct Value {
    value: f64,
    low: f64,
    high: f64,
}

/// Compares the CSV file of an earlier run with a table. An error differs if it is not the same number; a time, relative
/// to the plain pass, differs if the ranges between the quartiles have no common value.
///
/// # Errors
/// [`HarnessError::Read`], and [`HarnessError::Csv`] with the line and the column of what is wrong.
pub fn changes(path: &Path, new: &Table) -> Result<Changes, HarnessError> {
    let bytes = read_file(path, MOST_BYTES).map_err(|source| HarnessError::Read { path: path.to_owned(), source })?;
    let (old, about) = parse(path, &bytes)?;
    let new: BTreeMap<Key, Value> = new.rows.iter().flat_map(values).collect();
    let mut found = Changes { old: about.into_iter().collect(), ..Changes::default() };
    let keys: BTreeSet<&Key> = old.keys().chain(new.keys()).collect();
    for key in keys {
        let (before, after) = (old.get(key), new.get(key));
        let direction = match (before, after) {
            (Some(before), Some(after)) => {
                found.compared += 1;
                if after.low > before.high {
                    Direction::Worse
                } else if after.high < before.low {
                    Direction::Better
                } else {
                    continue;
                }
            }
            (None, _) => Direction::Added,
            (_, None) => Direction::Removed,
        };
        let [chart, variant, executor, scene, error] = key.clone();
        let what = if error.is_empty() { "relative time".into() } else { error };
        let (old, new) = (before.map(|v| v.value), after.map(|v| v.value));
        found.changes.push(Change { direction, chart, variant, executor, scene, what, old, new });
    }
    found.changes.sort_by_key(|change| change.direction);
    Ok(found)
}

fn values(row: &Row) -> Vec<(Key, Value)> {
    let key = |error: &str| [&row.chart, &row.variant, &row.executor, &row.scene, error].map(|name| name.to_string());
    let exact = |value: f64| Value { value, low: value, high: value };
    let time = row.time.relative;
    let errors = row.errors.iter().map(|(name, value)| (key(name), exact(*value)));
    errors.chain([(key(""), Value { value: time.median, low: time.low, high: time.high })]).collect()
}

/// The columns that are read.
const COLUMNS: [&str; 11] = [
    "chart",
    "variant",
    "executor",
    "scene",
    "error",
    "value",
    "relative",
    "relative_low",
    "relative_high",
    "version",
    "machine",
];

/// The values of a file, and its versions and machines.
fn parse(path: &Path, bytes: &[u8]) -> Result<(BTreeMap<Key, Value>, BTreeSet<String>), HarnessError> {
    let fault = |line: u64, column: &str, message: String| HarnessError::Csv {
        path: path.to_owned(),
        line,
        column: column.to_owned(),
        message,
    };
    // The parser counts a line when it has read its end, which for CR LF is after the start of the next record.
    let line_of = |position: Option<&csv::Position>| {
        let start = position.map_or(0, |position| position.byte() as usize).min(bytes.len());
        let content = bytes[start..].iter().position(|byte| !b"\r\n".contains(byte)).unwrap_or(0);
        1 + bytes[..start + content].iter().filter(|byte| **byte == b'\n').count() as u64
    };
    let of_parser = |error: csv::Error| {
        let column = match error.kind() {
            csv::ErrorKind::Utf8 { err, .. } => COLUMNS.get(err.field()).copied().unwrap_or(""),
            _ => "",
        };
        fault(line_of(error.position()), column, error.to_string())
    };
    let mut reader = csv::Reader::from_reader(bytes);
    let headers = reader.headers().map_err(of_parser)?.clone();
    let mut places = [0; COLUMNS.len()];
    for (place, name) in places.iter_mut().zip(COLUMNS) {
        let found = headers.iter().position(|header| header == name);
        *place = found.ok_or_else(|| fault(1, name, "there is no such column".into()))?;
    }
    let (mut values, mut about) = (BTreeMap::new(), BTreeSet::new());
    for record in reader.records() {
        let record = record.map_err(of_parser)?;
        let line = line_of(record.position());
        let field = |column: usize| record.get(places[column]).unwrap_or_default();
        let number = |column: usize| {
            let text = field(column);
            text.parse::<f64>().map_err(|_| fault(line, COLUMNS[column], format!("{text:?} is no number")))
        };
        let key = |error: &str| [field(0), field(1), field(2), field(3), error].map(str::to_owned);
        let value = number(5)?;
        let error = field(4);
        if error.is_empty() {
            return Err(fault(line, COLUMNS[4], "the name of the error is empty".into()));
        }
        if values.insert(key(error), Value { value, low: value, high: value }).is_some() {
            return Err(fault(
                line,
                COLUMNS[4],
                format!("{error:?} of this variant, executor and scene is there twice"),
            ));
        }
        values.insert(key(""), Value { value: number(6)?, low: number(7)?, high: number(8)? });
        about.insert(format!("version {}, {}", field(9), field(10)));
    }
    Ok((values, about))
}
