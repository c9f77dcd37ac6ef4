//! The passes on whatever graphics adapter there is, against the CPU twins.
//!
//! `NPR_GPU=required` fails without an adapter, `off` uses none, anything else skips, saying so, where there is none.
#![cfg(feature = "wgpu")]
#![allow(clippy::print_stdout)]

#[path = "gpu/composite.rs"]
mod composite;
#[path = "gpu/device.rs"]
mod device;
#[path = "gpu/discs.rs"]
mod discs;
#[path = "gpu/fused.rs"]
mod fused;
#[path = "gpu/inputs.rs"]
mod inputs;
#[path = "gpu/printed.rs"]
mod printed;
#[path = "gpu/refusals.rs"]
mod refusals;
#[path = "gpu/separate.rs"]
mod separate;
#[path = "gpu/steps.rs"]
mod steps;
#[path = "gpu/targets.rs"]
mod targets;
#[path = "gpu/texel.rs"]
mod texel;
