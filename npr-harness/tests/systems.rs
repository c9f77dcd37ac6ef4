//! The table of the documents' systems: what it names is there, and `docs/systems.md` is what the command prints.

use npr_harness::figures::all;
use npr_harness::systems::{SYSTEMS, System, table};
use std::path::Path;

/// A file of the workspace, or `None` outside of it.
fn read(file: &str) -> Option<String> {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(file)).ok()
}

/// What is wrong with a row.
fn fault(system: &System) -> Option<String> {
    let System { number, code: (file, item), key, figure, test: (test_file, test), .. } = *system;
    let declared = |text: &str, item: &str| {
        ["fn ", "struct ", "enum "].iter().any(|kind| {
            text.match_indices(&format!("{kind}{item}")).any(|(at, found)| {
                !text[at + found.len()..].starts_with(|next: char| next.is_alphanumeric() || next == '_')
            })
        })
    };
    let Some(text) = read(file) else { return Some(format!("{number}: there is no {file}")) };
    if !declared(&text, item) {
        return Some(format!("{number}: {file} has no {item}"));
    }
    match key {
        Ok(key) => {
            let styles = read("docs/styles.md").unwrap_or_default();
            if !styles.contains(&format!("`{key}`")) && !styles.contains(key) {
                return Some(format!("{number}: docs/styles.md has no {key}"));
            }
        }
        Err(why) if why.len() < 10 => return Some(format!("{number}: no key, and no reason")),
        Err(_) => {}
    }
    if !all().iter().any(|known| known.name == figure) {
        return Some(format!("{number}: no figure is called {figure}"));
    }
    let text = read(test_file).unwrap_or_default();
    let is_test = text.split("#[test]").skip(1).any(|rest| declared(rest.split('{').next().unwrap_or(""), test));
    if !is_test {
        return Some(format!("{number}: {test_file} has no test {test}"));
    }
    None
}

#[test]
fn every_system_has_code_a_style_key_a_figure_and_a_test() {
    let numbers: Vec<_> = SYSTEMS.iter().map(|system| system.number).collect();
    assert_eq!(numbers, (1..=45).collect::<Vec<_>>());
    let faults: Vec<_> = SYSTEMS.iter().filter_map(fault).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn rows_without_one_of_them_are_found() {
    let good = SYSTEMS[0];
    for wrong in [
        System { code: ("npr-mesh/src/edges.rs", "fin"), ..good },
        System { code: ("npr-mesh/src/none.rs", "find"), ..good },
        System { key: Ok("[lines.none]"), ..good },
        System { key: Err("none"), ..good },
        System { figure: "none", ..good },
        System { test: (good.test.0, "a_boundary_has_the_negated_norma"), ..good },
        System { test: ("npr-mesh/src/edges.rs", "find"), ..good },
    ] {
        assert!(fault(&wrong).is_some(), "{wrong:?}");
    }
}

#[test]
fn the_table_in_docs_is_what_the_command_prints() {
    let Some(text) = read("docs/systems.md") else {
        panic!("there is no docs/systems.md: npr figures --systems writes it")
    };
    assert!(text == table(), "docs/systems.md is not what `npr figures --systems` prints");
}
