//! Invalid, unusual and hostile files, each with its expected result: a model with warnings, or an error.
//!
//! To write the files to a folder: `NPR_CORPUS=folder cargo test -p npr-mesh --test hostile -- --ignored
//! write_the_corpus`.
#![cfg(all(feature = "obj", feature = "gltf"))]
#![allow(clippy::print_stdout)]

mod case;
mod doc;
mod gltf;
mod images;
mod limits;
mod obj;
mod variants;

use case::Case;
use std::path::PathBuf;
use std::time::Duration;

/// The time limit per file on a busy machine.
const LONGEST: Duration = Duration::from_secs(20);

/// A temporary folder, which is removed when dropped.
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
        // Removed at once, since some cases are large.
        let _ = std::fs::remove_dir_all(folder.0.join(&case.name));
    }
    println!("{} files, the slowest {} in {:?}", cases.len(), slowest.1, slowest.0);
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
    assert!(cases.len() >= 150, "{}", cases.len());
}

/// The corpus with bytes changed, removed, inserted and repeated. `NPR_MUTATIONS` is the number of files; the seed is
/// fixed.
#[test]
fn broken_copies_give_a_sound_model_or_an_error() {
    let wanted = std::env::var("NPR_MUTATIONS").ok().and_then(|n| n.parse().ok()).unwrap_or(3000u32);
    let folder = Folder::new("mutated");
    let cases: Vec<Case> = corpus()
        .into_iter()
        .filter(|case| case.files[0].1.len() < 20_000 && case.links.is_empty() && case.pipe.is_none())
        .collect();
    let mut state = 1u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) as usize) % below.max(1)
    };
    let words: [&[u8]; 16] = [
        b"0",
        b"-1",
        b"4294967295",
        b"1e400",
        b"nan",
        b"\\\n",
        b"\r",
        b"f 1 2 3\n",
        b"\"",
        b"{}",
        b"null",
        b"5126",
        b"[",
        b"\xff",
        b"\0\0\x80\x7f",
        b"\xff\xff\xff\xff",
    ];
    for number in 0..wanted {
        let case = &cases[random(cases.len())];
        let mut bytes = case.files[0].1.clone();
        for _ in 0..1 + random(4) {
            let at = random(bytes.len() + 1);
            let end = (at + random(12)).min(bytes.len());
            let word = words[random(words.len())];
            match random(5) {
                0 if at < bytes.len() => bytes[at] = random(256) as u8,
                1 => drop(bytes.splice(at..at, word.iter().copied())),
                2 => drop(bytes.splice(at..end, word.iter().copied())),
                3 => drop(bytes.drain(at..end)),
                _ => {
                    let again = bytes[at..end].to_vec();
                    drop(bytes.splice(at..at, again));
                }
            }
        }
        let ending = case.files[0].0.rsplit('.').next().expect("an ending").to_owned();
        let path = folder.0.join(format!("m.{ending}"));
        std::fs::write(&path, &bytes).expect("written");
        let start = std::time::Instant::now();
        if let Ok(loaded) = npr_mesh::load(&path, &case.options)
            && let Err(fault) = case::sound(loaded)
        {
            panic!("copy {number} of {}: {fault}: {}", case.name, bytes.escape_ascii());
        }
        assert!(start.elapsed() < LONGEST, "copy {number} of {}: {}", case.name, bytes.escape_ascii());
    }
}

#[test]
#[ignore = "writes the files into the folder that NPR_CORPUS names"]
fn write_the_corpus() {
    let folder = PathBuf::from(std::env::var_os("NPR_CORPUS").expect("NPR_CORPUS names a folder"));
    for case in corpus() {
        println!("{}", case.write(&folder).display());
    }
}
