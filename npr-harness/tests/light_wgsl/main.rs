//! Comparison of the WGSL of npr-toon, npr-gooch and npr-hatch on a GPU with the Rust functions of the same names, in
//! f64, on the same seeded inputs.
//!
//! Inputs are f32, so both functions get exactly the same numbers, and only the arithmetic is compared. Each test
//! prints a table: the number of inputs, the number of exempt ones (the reason is in the check's comment), the largest
//! error, and the largest error relative to its bound.
#![cfg(feature = "gpu")]
#![allow(clippy::print_stdout)]

mod check;
#[path = "../common/mod.rs"]
mod common;
mod gooch;
mod hatch;
mod hatch_lookup;
mod images;
mod pixels;
mod ramps;
mod random;
mod toon;

use npr_harness::executor::Executor;
use npr_harness::gpu::GpuContext;

/// The GPU, or `None` with a message if there is no adapter and `NPR_GPU` does not require one.
fn device() -> Option<Box<GpuContext>> {
    match common::device()? {
        Executor::Gpu(gpu) => Some(gpu),
        Executor::Cpu { .. } => None,
    }
}

/// Every function of the libraries must be called by some check.
#[test]
fn every_function_is_run() {
    let calls = [
        gooch::calls(),
        hatch::calls(),
        hatch_lookup::calls(),
        toon::calls(),
        ramps::calls(),
        images::calls(),
        pixels::calls(),
    ]
    .concat();
    let hatch = [npr_hatch::WGSL, npr_hatch::LOOKUP_WGSL].concat();
    for library in [npr_toon::WGSL, npr_gooch::WGSL, &hatch] {
        for (_, function) in naga::front::wgsl::parse_str(library).expect("it is valid").functions.iter() {
            let name = function.name.as_deref().expect("functions have names");
            assert!(calls.iter().any(|call| call.contains(&format!("{name}("))), "{name} is not run");
        }
    }
}
