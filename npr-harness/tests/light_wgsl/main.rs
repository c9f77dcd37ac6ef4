//! The WGSL of npr-toon, npr-gooch and npr-hatch, run on a device, against the Rust functions of the same names, which
//! are in f64, on the same seeded inputs.
//!
//! Inputs are f32, so a function and its twin are given exactly the same numbers; what is measured is the arithmetic
//! alone. Each test prints a table: how many inputs, how many of them allow any result and why (in the check's own
//! comment), the largest difference, and the largest share of what is allowed.
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

/// The device, or `None`, having said so, where `NPR_GPU` allows that there is none.
fn device() -> Option<Box<GpuContext>> {
    match common::device()? {
        Executor::Gpu(gpu) => Some(gpu),
        Executor::Cpu { .. } => None,
    }
}

/// Every function of the libraries is called by some check, so that a new one cannot be forgotten.
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
