//! Broken, odd and hostile files, each with what is to come of it: a model and its warnings, or an error.
//!
//! To look at the files: `NPR_CORPUS=folder cargo test -p npr-mesh --test hostile -- --ignored write_the_corpus`.
#![cfg(all(feature = "obj", feature = "gltf"))]
#![allow(clippy::print_stdout)]

mod case;
mod gltf;
mod images;
mod limits;
mod obj;
mod variants;

use case::Case;
use std::path::PathBuf;
use std::time::Duration;

/// For one file, on a machine that has other things to do.
const LONGEST: Duration = Duration::from_secs(20);

/// A folder of its own, gone when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("npr-mesh-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a folder");
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn corpus() -> Vec<Case> {
    let cases: Vec<Case> =
        [obj::cases(), images::cases(), gltf::cases(), limits::cases()].into_iter().flatten().collect();
    let mut names: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
    names.sort_unstable();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "names are given once");
    cases.into_iter().filter(Case::is_possible).collect()
}

#[test]
fn every_file_has_the_outcome_stated() {
    let folder = Folder::new("hostile");
    let cases = corpus();
    let mut wrong = Vec::new();
    let mut slowest = (Duration::ZERO, "");
    for case in &cases {
        let (taken, outcome) = case.run(&folder.0);
        slowest = slowest.max((taken, &case.name));
        if let Err(fault) = outcome {
            wrong.push(format!("{}: {fault}", case.name));
        }
        if taken > LONGEST {
            wrong.push(format!("{}: took {taken:?}", case.name));
        }
        // Some are large.
        let _ = std::fs::remove_dir_all(folder.0.join(&case.name));
    }
    println!("{} files, the slowest {} in {:?}", cases.len(), slowest.1, slowest.0);
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
    assert!(cases.len() >= 150, "{}", cases.len());
}

#[test]
#[ignore = "writes the files into the folder that NPR_CORPUS names"]
fn write_the_corpus() {
    let folder = PathBuf::from(std::env::var_os("NPR_CORPUS").expect("NPR_CORPUS names a folder"));
    for case in corpus() {
        println!("{}", case.write(&folder).display());
    }
}
