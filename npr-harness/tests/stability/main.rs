//! Each limit of the failure atlas, held to its bound. A test's name says what fails and where.
#![allow(clippy::print_stdout)]

mod hatch;
mod image_space;
mod light;
mod mesh;
mod outline;
mod shadow;

use npr_harness::executor::{Backend, Executor};
use npr_harness::stability::{Finding, sweeps};
use std::collections::BTreeSet;

/// Measures a sweep and asserts that the limits of the named curves, which are all that it has, are within their bounds.
fn holds(sweep: &str, curves: &[&str]) -> Option<Finding> {
    let sweep = sweeps().into_iter().find(|known| known.name == sweep).expect("a sweep of the atlas");
    let backend = if sweep.needs_adapter { Backend::Auto } else { Backend::Cpu };
    let executor = Executor::choose(backend).expect("an executor");
    if sweep.needs_adapter && executor.is_cpu() {
        println!("skipped, there is no adapter: {}", sweep.name);
        return None;
    }
    let finding = (sweep.run)(&executor).expect("the sweep runs");
    let found: BTreeSet<&str> = finding.curves.iter().map(|curve| curve.name.as_str()).collect();
    assert_eq!(found, curves.iter().copied().collect(), "curves of {}", sweep.name);
    for curve in &finding.curves {
        let limit = &curve.limit;
        assert!(limit.measured.is_finite(), "{}, {}: {limit:?}", sweep.name, curve.name);
        assert!(limit.bound.holds(limit.measured), "{}, {}: {limit:?}", sweep.name, curve.name);
    }
    Some(finding)
}

/// Asserts that what was measured on a curve is within a factor of what its formula predicts.
fn predicts(finding: &Finding, curve: &str, factor: f64) {
    let limit = &finding.curves.iter().find(|known| known.name == curve).expect("a curve of the sweep").limit;
    let (predicted, _) = limit.predicted.as_ref().expect("a prediction");
    let ratio = limit.measured / predicted;
    assert!((1.0 / factor..=factor).contains(&ratio), "{curve}: {ratio} of what is predicted: {limit:?}");
}

/// A sweep that no test names would have bounds that nothing holds.
#[test]
fn every_sweep_has_a_test() {
    let tests = [
        include_str!("outline.rs"),
        include_str!("image_space.rs"),
        include_str!("light.rs"),
        include_str!("hatch.rs"),
        include_str!("shadow.rs"),
        include_str!("mesh.rs"),
    ]
    .concat();
    for sweep in sweeps() {
        assert!(tests.contains(&format!("holds(\"{}\"", sweep.name)), "no test of {}", sweep.name);
    }
}
