//! Comparison of the statistics of real models with those of two other programs.
#![allow(clippy::print_stdout)]

use npr_harness::inspect::inspect;
use std::{fs, path::Path};

#[test]
fn the_counts_of_real_models_are_right() {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    let Ok(table) = fs::read_to_string(folder.join("topology.tsv")) else {
        println!("skipped: no models at {}", folder.display());
        return;
    };
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    let columns: Vec<&str> = lines.next().expect("a line of names").split('\t').collect();
    let mut models = 0;
    let mut faults = Vec::new();
    for line in lines {
        let row: Vec<&str> = line.split('\t').collect();
        let name = row[0];
        let loaded = npr_mesh::load(&folder.join(format!("{name}.obj")), &Default::default()).expect("a good file");
        let warnings = loaded.warnings.clone();
        let counted = serde_json::to_value(inspect(name, &loaded.into_model(), warnings)).expect("plain numbers");
        let slack: u64 =
            row[columns.iter().position(|&c| c == "within_0.01_deg_of_30").expect("there")].parse().expect("a number");
        for (&column, &expected) in columns.iter().zip(&row).skip(1) {
            let expected: u64 = expected.parse().expect("a number");
            let actual = counted[column].as_u64().unwrap_or_else(|| panic!("{column} is not counted"));
            // The order of additions decides on which side of 30° these edges are.
            let slack = if column == "creases_over_30_deg" { slack } else { 0 };
            if actual.abs_diff(expected) > slack {
                faults.push(format!("{name}: {column} is {actual}, not {expected}"));
            }
        }
        models += 1;
    }
    assert!(models > 0, "no model in the table");
    assert!(faults.is_empty(), "{faults:#?}");
}
