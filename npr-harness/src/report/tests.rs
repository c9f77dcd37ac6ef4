use super::*;
use crate::chart::{Table, Time};
use crate::measure::Spread;
use std::cell::Cell;
use std::path::PathBuf;

/// A new folder that is deleted when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("npr-report-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a folder can be made");
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn row(variant: &str, error: f64, time: f64) -> Row {
    let spread = Spread { median: time, low: 0.9 * time, high: 1.1 * time };
    Row {
        chart: "lines".into(),
        variant: variant.into(),
        historical: false,
        executor: "cpu".into(),
        scene: "teapot".into(),
        errors: vec![("1 − F1".into(), error), ("pieces, \"short\"".into(), 0.25)],
        time: Time { relative: spread, relative_own: spread, ms: spread, device_ms: None },
        bytes: 1 << 40,
    }
}

fn entry() -> AtlasEntry {
    let axis = |logarithmic| stability::Axis { name: "a".into(), unit: String::new(), logarithmic };
    let limit = stability::Limit {
        what: "value at which it fails".into(),
        measured: f64::INFINITY,
        is_of_parameter: true,
        predicted: Some((0.1 + 0.2, "a | formula".into())),
        bound: check::Limit::AtLeast(1e-300),
        to_be_mended: None,
    };
    let curve = stability::Curve {
        name: "c".into(),
        points: vec![(1.0, f64::NAN), (2.0, f64::INFINITY), (3.0, 1.0 / 3.0)],
        limit,
    };
    let image = Image::filled(3, 2, [1, 2, 3, 255]);
    let pictures = vec![("caption".into(), PngPicture::new(&image, 10).expect("a PNG"))];
    let found = Ok(Found { parameter: axis(true), error: axis(false), curves: vec![curve], pictures });
    AtlasEntry { name: "sweep".into(), technique: "lines".into(), what: "it\nbreaks".into(), found }
}

/// Values that are not equal to themselves, such as NaN, by their text.
fn text(value: &impl std::fmt::Debug) -> String {
    format!("{value:?}")
}

#[test]
fn what_is_kept_is_not_made_again() {
    let folder = Folder::new("kept");
    let stages = Stages::new(&folder.0, "a key").expect("a folder");
    let made = Cell::new(0);
    let make = || {
        made.set(made.get() + 1);
        Ok(entry())
    };
    for _ in 0..3 {
        assert_eq!(text(&stages.get_or("sweep", make).expect("kept")), text(&entry()));
    }
    assert_eq!(made.get(), 1);
    let rows =
        || Ok(make::Measured { skipped: vec!["x".into()], rows: vec![row("v", f64::NAN, 1.5), row("w", -0.0, 2.0)] });
    let first = stages.get_or("rows", rows).expect("kept");
    let again = stages.get_or::<make::Measured>("rows", || panic!("it is kept")).expect("kept");
    assert_eq!(text(&first), text(&again));
    let skipped = AtlasEntry { found: Err("no adapter".into()), ..entry() };
    assert_eq!(stages.get_or("skipped", || Ok(skipped.clone())).expect("kept"), skipped);
    assert_eq!(stages.get::<AtlasEntry>("skipped"), Some(skipped));
    let check = CheckTable { executor: "cpu".into(), skipped: vec![], rows: vec![] };
    assert_eq!(stages.get_or("check", || Ok(check.clone())).expect("kept"), check);
    assert_eq!(stages.get::<CheckTable>("check"), Some(check));
}

#[test]
fn what_is_damaged_or_of_another_run_is_made_again() {
    let folder = Folder::new("damaged");
    let stages = Stages::new(&folder.0, "a key").expect("a folder");
    stages.get_or("s", || Ok(vec![1.5, 2.5])).expect("kept");
    let whole = std::fs::read(stages.path("s")).expect("a file");
    let made_again = |stages: &Stages, value: f64| {
        let made = stages.get_or("s", || Ok(vec![value])).expect("made");
        assert_eq!(made, [value]);
        assert_eq!(stages.get::<Vec<f64>>("s"), Some(vec![value]), "kept");
    };
    // Every part of the file that an interrupted writer could leave.
    for length in 0..whole.len() - 1 {
        std::fs::write(stages.path("s"), &whole[..length]).expect("written");
        let kept = stages.get::<Vec<f64>>("s");
        assert!(kept.is_none() || kept == Some(vec![1.5, 2.5]), "the first {length} bytes are {kept:?}");
    }
    std::fs::write(stages.path("s"), &whole[..whole.len() / 2]).expect("written");
    made_again(&stages, 3.0);
    std::fs::write(stages.path("s"), [0xff; 99]).expect("written");
    made_again(&stages, 4.0);
    // Another key, and another form.
    made_again(&Stages::new(&folder.0, "another key").expect("a folder"), 5.0);
    made_again(&stages, 6.0);
    assert_eq!(stages.get::<Vec<String>>("s"), None);
    stages.forget(["s", "never made"]).expect("removed");
    assert_eq!(stages.get::<Vec<f64>>("s"), None);
    // An error keeps nothing.
    let failed = stages.get_or::<f64>("f", || Err(HarnessError::NoLight));
    assert!(failed.is_err() && !stages.path("f").exists());
}

#[test]
fn changes_are_of_errors_and_of_times_beyond_both_spreads() {
    let folder = Folder::new("changes");
    let path = folder.0.join("old.csv");
    let table = |rows| Table { machine: vec!["m, 2 threads".into()], rows, ..Table::default() };
    let old =
        table(vec![row("same", 0.1, 1.0), row("worse", 0.1, 1.0), row("slower", 0.1, 1.0), row("gone", 0.1, 1.0)]);
    std::fs::write(&path, old.to_csv()).expect("written");
    assert_eq!(changes(&path, &old).expect("a table").changes, [], "with itself");
    // 1.2 is within both spreads, 1.23 is not.
    let new = table(vec![
        row("same", 0.1, 1.2),
        row("worse", 0.1 + 1e-15, 0.5),
        row("slower", 0.1, 1.23),
        row("new", 0.1, 1.0),
    ]);
    let found = changes(&path, &new).expect("a table");
    assert_eq!(found.compared, 9);
    assert_eq!(found.old.len(), 1);
    assert!(found.old[0].contains("m, 2 threads"));
    let of = |direction| {
        let of = found.changes.iter().filter(|change| change.direction == direction);
        of.map(|change| (change.variant.as_str(), change.what.as_str())).collect::<Vec<_>>()
    };
    assert_eq!(of(Direction::Worse), [("slower", "relative time"), ("worse", "1 − F1")]);
    assert_eq!(of(Direction::Better), [("worse", "relative time")]);
    assert_eq!(of(Direction::Added).len(), 3);
    assert_eq!(of(Direction::Removed).len(), 3);
}

#[test]
fn a_faulty_table_is_refused_with_line_and_column() {
    let folder = Folder::new("faulty");
    let path = folder.0.join("old.csv");
    let good = Table { rows: vec![row("a", 0.1, 1.0), row("b", 0.1, 1.0)], ..Table::default() }.to_csv();
    let cases: [(&str, &str, &str); 7] = [
        ("relative_low", "relative_lo", ":1: column \"relative_low\": there is no such column"),
        ("teapot,1 − F1,0.1,", "teapot,1 − F1,O.1,", ":2: column \"value\": \"O.1\" is no number"),
        (",1,0.9,1.1,1,1,", ",1,,1.1,1,1,", ":2: column \"relative_low\": \"\" is no number"),
        ("lines,b,", "lines,b,b,", ":4:"),
        ("lines,b,", "lines,a,", ":4: column \"error\": \"1 − F1\" of this variant, executor and scene is there twice"),
        ("teapot,1 − F1,", "teapot,,", ":2: column \"error\": the name of the error is empty"),
        ("lines,a,cpu", "lines,\u{0}a,cpu,x", ":2:"),
    ];
    for (what, by, said) in cases {
        assert!(good.contains(what), "{what} of {good}");
        std::fs::write(&path, good.replacen(what, by, 1)).expect("written");
        let error = changes(&path, &Table::default()).expect_err(what).to_string();
        assert!(error.contains(&format!("old.csv{said}")), "{error}");
    }
    let mut bytes = good.into_bytes();
    let at = bytes.iter().position(|byte| *byte == b'\n').expect("a line") + 1;
    bytes[at] = 0xff;
    std::fs::write(&path, bytes).expect("written");
    let error = changes(&path, &Table::default()).expect_err("not UTF-8").to_string();
    assert!(error.contains("old.csv:2: column \"chart\""), "{error}");
    assert!(matches!(changes(&folder.0, &Table::default()), Err(HarnessError::Read { .. })));
}

#[test]
fn tables_keep_their_form_whatever_texts_are_in_them() {
    let entries = [entry(), AtlasEntry { name: "other".into(), found: Err("no\nadapter".into()), ..entry() }];
    let markdown = tables::limits_markdown(&entries);
    let rows: Vec<_> = markdown.lines().filter(|line| line.starts_with('|')).collect();
    assert_eq!(rows.len(), 4);
    for row in rows {
        let fields = row.replace("\\|", "").matches('|').count() - 1;
        assert_eq!(fields, tables::LIMIT_COLUMNS.len(), "{row}");
    }
    let csv = tables::limits_csv(&entries).expect("written");
    let mut reader = csv::Reader::from_reader(&csv[..]);
    assert_eq!(reader.headers().expect("a line"), tables::LIMIT_COLUMNS.as_slice());
    assert_eq!(reader.records().filter(Result::is_ok).count(), 2);
}

#[test]
fn pictures_are_reduced_to_the_width_and_keep_their_shape() {
    let image = Image::filled(900, 300, [10, 20, 30, 255]);
    let reduced = PngPicture::new(&image, 300).expect("a PNG");
    assert_eq!((reduced.width, reduced.height), (300, 100));
    let decoded = image::load_from_memory(&reduced.png).expect("a PNG").to_rgba8();
    assert_eq!(decoded.dimensions(), (300, 100));
    assert!(decoded.pixels().all(|pixel| pixel.0 == [10, 20, 30, 255]));
}
