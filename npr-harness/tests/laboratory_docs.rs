//! The form of docs/charts.md and docs/limits.md, which `npr report --docs docs` writes. Their numbers are those of the
//! machine that they name.

use npr_harness::chart::charts;
use npr_harness::report::tables::{CHART_COLUMNS, LIMIT_COLUMNS};
use npr_harness::stability::sweeps;

fn document(name: &str) -> String {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs").join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The fields of a row of a Markdown table.
fn fields(row: &str) -> Vec<String> {
    let hidden = row.replace("\\|", "\u{1}");
    let inner = hidden.trim().trim_start_matches('|').trim_end_matches('|');
    inner.split('|').map(|field| field.trim().replace('\u{1}', "|")).collect()
}

#[test]
fn every_chart_has_a_table_of_its_points() {
    let text = document("charts.md");
    for chart in charts() {
        let heading = format!("## {}\n", chart.title);
        let section = text.split(&heading).nth(1).unwrap_or_else(|| panic!("no heading {:?}", chart.title));
        let section = section.split("\n## ").next().unwrap_or_default();
        assert!(section.contains(chart.error), "{}: the error is not named", chart.name);
        let table = section.split(CHART_COLUMNS).nth(1).unwrap_or_else(|| panic!("{}: other columns", chart.name));
        let rows: Vec<_> = table.lines().take_while(|line| line.starts_with('|')).map(fields).collect();
        assert!(rows.len() > 1, "{}: {} rows", chart.name, rows.len());
        for row in &rows {
            assert_eq!(row.len(), 7, "{}: {row:?}", chart.name);
            assert!(!row[0].is_empty() && !row[1].is_empty(), "{}: {row:?}", chart.name);
            let standing = &row[6];
            let is_known = standing == "front" || standing == "no error" || standing.starts_with("dominated by ");
            assert!(is_known, "{}: {row:?}", chart.name);
        }
        assert!(rows.iter().any(|row| row[6] == "front"), "{}: nothing is on the front", chart.name);
    }
}

#[test]
fn every_sweep_has_its_limits() {
    let text = document("limits.md");
    let rows: Vec<_> = text.lines().filter(|line| line.starts_with('|')).map(fields).collect();
    assert_eq!(rows[0], LIMIT_COLUMNS);
    for row in &rows {
        assert_eq!(row.len(), LIMIT_COLUMNS.len(), "{row:?}");
    }
    for sweep in sweeps() {
        let of: Vec<_> = rows.iter().filter(|row| row[0] == sweep.name).collect();
        assert!(!of.is_empty(), "no limits of {}", sweep.name);
        for row in of {
            assert_eq!(row[1], sweep.technique);
            // A sweep that was skipped says so; another one has a measured value and a bound.
            let is_whole = !row[4].is_empty() && (row[7].starts_with('≤') || row[7].starts_with('≥'));
            assert!(is_whole || row[3].starts_with("skipped: "), "{row:?}");
        }
    }
    let known: Vec<_> = sweeps().iter().map(|sweep| sweep.name.to_owned()).collect();
    for row in &rows[2..] {
        assert!(known.contains(&row[0]), "there is no sweep {}", row[0]);
    }
}
