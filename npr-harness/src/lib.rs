//! Scene, style and frame, on wgpu and on the CPU, checked against each other.
#![warn(missing_docs)]

pub mod camera;
pub mod color;
pub mod compare;
pub mod cpu;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod inspect;
pub mod plan;
pub mod rays;
pub mod scene;
pub mod style;
pub mod texture;
