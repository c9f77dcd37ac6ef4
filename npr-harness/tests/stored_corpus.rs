//! Runs the fuzz targets' code on the stored corpus and on random changes of it, with a stable compiler.
//!
//! `NPR_FUZZ_SECONDS` is the time for changed files, for all kinds together (2 by default); the changes are the
//! same in each run. `fuzz/README.md` describes the targets.

#[path = "../../fuzz/src/lib.rs"]
mod entries;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

type Entry = fn(&[u8]);

const TARGETS: [(&str, Entry); 8] = [
    ("obj", entries::obj),
    ("gltf", entries::gltf),
    ("style", entries::style),
    ("tam", entries::tam),
    ("ply", entries::ply),
    ("stl", entries::stl),
    ("mtl", entries::mtl),
    ("memory", entries::memory),
];

/// The largest file allowed in the corpus, bytes.
const MOST_BYTES: usize = 8192;

fn corpus(target: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../fuzz/corpus")).join(target);
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<_> = entries
        .map(|entry| {
            let path = entry.expect("an entry").path();
            let bytes = std::fs::read(&path).expect("a file");
            assert!(bytes.len() <= MOST_BYTES, "{}: {} bytes", path.display(), bytes.len());
            (path, bytes)
        })
        .collect();
    files.sort();
    assert!(files.len() >= 2, "{} has hardly any files", folder.display());
    files
}

fn store(target: &str) {
    let (_, entry) = TARGETS.into_iter().find(|(name, _)| *name == target).expect("a target");
    for (path, bytes) in corpus(target) {
        let start = Instant::now();
        let done = catch_unwind(|| entry(&bytes));
        assert!(done.is_ok(), "{} ends in a panic", path.display());
        assert!(start.elapsed() < Duration::from_secs(20), "{} takes {:?}", path.display(), start.elapsed());
    }
}

#[test]
fn stored_obj_files() {
    store("obj");
}

#[test]
fn stored_gltf_files() {
    store("gltf");
}

#[test]
fn stored_styles() {
    store("style");
}

#[test]
fn stored_tonal_art_maps() {
    store("tam");
}

#[test]
fn stored_ply_files() {
    store("ply");
}

#[test]
fn stored_stl_files() {
    store("stl");
}

#[test]
fn stored_material_files() {
    store("mtl");
}

#[test]
fn stored_models_in_memory() {
    store("memory");
}

/// The kinds share the time equally. If one panics, the file remains in the temporary folder and is named.
#[test]
fn changed_files_of_every_kind() {
    let seconds = std::env::var("NPR_FUZZ_SECONDS").map_or(2.0, |text| text.parse().expect("a number of seconds"));
    let share = Duration::from_secs_f64(seconds / TARGETS.len() as f64);
    for (target, entry) in TARGETS {
        let files: Vec<Vec<u8>> = corpus(target).into_iter().map(|(_, bytes)| bytes).collect();
        let mut random = Random(0x9e37_79b9_7f4a_7c15);
        let (start, mut tried) = (Instant::now(), 0u64);
        while start.elapsed() < share {
            let bytes = changed(&files, &mut random);
            let began = Instant::now();
            let done = catch_unwind(AssertUnwindSafe(|| entry(&bytes)));
            tried += 1;
            if done.is_err() || began.elapsed() > Duration::from_secs(20) {
                let kept = std::env::temp_dir().join(format!("npr-fuzz-{target}-{tried}"));
                std::fs::write(&kept, &bytes).expect("written");
                panic!("{target}, the {tried}-th changed file, after {:?}: {}", began.elapsed(), kept.display());
            }
        }
        assert!(tried > 0, "no time for {target}");
    }
}

/// SplitMix64 (Steele, Lea & Flood 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count.max(1) as u64) as usize
    }
}

/// One of the files with one to eight changes.
fn changed(files: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    const NUMBERS: [&[u8]; 12] = [
        b"0",
        b"-1",
        b"1",
        b"4294967295",
        b"4294967296",
        b"18446744073709551615",
        b"-9223372036854775808",
        b"1e30",
        b"1e-45",
        b"-3.4e38",
        b"nan",
        b"inf",
    ];
    const WORDS: [u32; 6] = [0, u32::MAX, 0x7f80_0000, 0x7fc0_0000, 1, 0x8000_0000];
    let mut bytes = files[random.below(files.len())].clone();
    for _ in 0..=random.below(8) {
        let at = random.below(bytes.len() + 1);
        let length = random.below((bytes.len() - at).min(64) + 1);
        match random.below(8) {
            0 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
            1 if at < bytes.len() => bytes[at] = random.next() as u8,
            2 => drop(bytes.drain(at..at + length)),
            3 => {
                let other = &files[random.below(files.len())];
                let from = random.below(other.len() + 1);
                let to = from + random.below((other.len() - from).min(64) + 1);
                bytes.splice(at..at, other[from..to].iter().copied());
            }
            4 => bytes.truncate(at),
            // Replaces a number in the text by another.
            5 => {
                let is_of_number = |byte: &u8| byte.is_ascii_digit() || b"+-.".contains(byte);
                if let Some(from) = bytes[at..].iter().position(is_of_number).map(|offset| at + offset) {
                    let to =
                        bytes[from..].iter().position(|byte| !is_of_number(byte)).map_or(bytes.len(), |n| from + n);
                    bytes.splice(from..to, NUMBERS[random.below(NUMBERS.len())].iter().copied());
                }
            }
            // Replaces four bytes by an unusual number.
            6 if at + 4 <= bytes.len() => {
                bytes[at..at + 4].copy_from_slice(&WORDS[random.below(WORDS.len())].to_le_bytes());
            }
            _ => {
                let copy = bytes[at..at + length].to_vec();
                bytes.splice(at..at, copy);
            }
        }
    }
    bytes.truncate(MOST_BYTES);
    bytes
}
