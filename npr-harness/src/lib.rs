//! Scene, style and frame, on wgpu and on the CPU, checked against each other.
#![warn(missing_docs)]

pub mod band_truth;
pub mod camera;
pub mod check;
pub mod color;
pub mod compare;
pub mod cpu;
pub mod error;
pub mod executor;
pub mod gallery;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod hatch;
pub mod hatch_truth;
pub mod image_ink;
pub mod inspect;
pub mod light;
pub mod line_truth;
pub mod normal_use;
pub mod picture_limits;
pub mod plan;
pub mod rays;
pub mod scene;
pub mod shadow;
pub mod shadow_truth;
pub mod style;
pub mod texture;
