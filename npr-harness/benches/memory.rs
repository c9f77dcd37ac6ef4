//! The peak memory for a picture of a model: whole processes of the command, on Linux.
//!
//! `cargo bench -p npr-harness --bench memory -- MODEL [STYLE …]`; by default the styles `cartoon` and `toon-shadow`.
//! Prints rows of a Markdown table.
#![allow(clippy::print_stdout)]

use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

fn main() {
    // Cargo adds an argument of its own.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let Some((model, styles)) = arguments.split_first() else { return println!("skipped: no model is given") };
    let styles: Vec<&str> = styles.iter().map(String::as_str).collect();
    let styles = if styles.is_empty() { vec!["cartoon", "toon-shadow"] } else { styles };
    println!("| style at 1280×720 | executor | peak MB | ms |\n| --- | --- | --- | --- |");
    for style in styles {
        for backend in ["gpu", "cpu"] {
            match peak(model, style, backend) {
                Ok((bytes, time)) => {
                    println!("| `{style}` | {backend} | {} | {} |", bytes / 1_000_000, time.as_millis())
                }
                Err(error) => println!("| `{style}` | {backend} | {error} | |"),
            }
        }
    }
}

/// The largest resident set of a rendering process, bytes, and its running time.
fn peak(model: &str, style: &str, backend: &str) -> Result<(u64, Duration), std::io::Error> {
    let start = Instant::now();
    let mut process = Command::new(env!("CARGO_BIN_EXE_npr"))
        .args(["render", model, "-o", "-", "--style", style, "--backend", backend, "--size", "1280x720"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()?;
    let status = format!("/proc/{}/status", process.id());
    let mut largest = 0;
    while process.try_wait()?.is_none() {
        // The kernel tracks the maximum; the last value read before the end is nearly that of the whole process.
        if let Some(bytes) = fs::read_to_string(&status).ok().and_then(|text| high_water_mark(&text)) {
            largest = bytes;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    Ok((largest, start.elapsed()))
}

fn high_water_mark(status: &str) -> Option<u64> {
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix(" kB")?.trim().parse::<u64>().ok().map(|kib| kib * 1024)
}
