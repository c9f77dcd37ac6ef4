//! The failure atlas: for each method, a sweep of the parameter that breaks it.
//!
//! A sweep varies one parameter, measures an error at each value, and states its limits: the value at which the method
//! stops working, beside the value that a formula predicts where there is one, and beside a bound that a test holds it
//! to. The bound is the measured limit with a margin for other machines, so the test fails when the method gets worse.
//!
//! All sweeps are deterministic. They render with the CPU executor, apart from those of methods that only adapters have.

mod hatch;
mod image_space;
mod ink;
mod light;
mod mesh;
mod outline;
mod setup;
mod shadow;
mod sweep;

pub use sweep::{Axis, Curve, Finding, Limit, Sweep};

/// All sweeps.
pub fn sweeps() -> Vec<Sweep> {
    [outline::SWEEPS, image_space::SWEEPS, light::SWEEPS, hatch::SWEEPS, shadow::SWEEPS, mesh::SWEEPS].concat()
}
