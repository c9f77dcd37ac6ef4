//! Renders models as inked cartoons, technical illustrations or hatchings, on a graphics device through wgpu or on the CPU,
//! and checks the two against each other.
//!
//! # From a file to a picture
//!
//! 1. A [`scene::Scene`] is meshes and the objects that place them, from a file by `Scene::from(npr_mesh::load(…)?)` or from
//!    models in memory. A mesh is prepared once, however often it is placed; [`scene::Scene::place`] moves an object.
//! 2. A [`style::Style`] says how surfaces are shaded and hatched, whether a light casts shadows, and which lines are drawn:
//!    one of [`style::styles`], or a TOML file by [`style::Style::read`].
//! 3. A [`view::View`] is a [`camera::Camera`] and the size and samples of the picture.
//! 4. A [`plan::Plan`] resolves all of that for the [`capabilities::Capabilities`] of an executor: passes, formats, methods,
//!    memory, each with the reason for it. Executors follow the plan and never read the style.
//! 5. An [`executor::Executor`] makes an [`picture::Image`]. [`gpu::GpuRenderer`] keeps pipelines and uploads for sequences;
//!    [`cpu`] casts rays in f64 and is the reference.
//!
//! # The modules
//!
//! | for | modules |
//! | --- | --- |
//! | what is shown | [`scene`], [`camera`], [`view`], [`outliers`], [`ground`], [`lights`], [`facets`], [`texture`], [`color`] |
//! | how it looks | [`style`], and a module for each technique: [`shade`], [`hatch`], [`edge_lines`], [`printed_fins`], [`hull_lines`], [`image_lines`], [`shadow`] |
//! | rendering | [`plan`], [`variant`], [`budget`], [`capabilities`], [`picture_limits`], [`executor`], [`gpu`], [`cpu`], [`rays`], [`picture`] |
//! | measuring | [`truth`], what is exactly right; [`compare`]; [`check`]; [`chart`], accuracy against speed; [`measure`], times of frames; [`stability`], where methods fail; [`plot`]; [`report`] |
//! | the command | [`gallery`], [`inspect`], [`suggest`], [`error`] |
//!
//! # Features
//!
//! - `gpu`: the wgpu executor.
//! - `laboratory`: the diagrams ([`plot`]) and the page ([`report`]) of what is measured. Measuring does not need it.
//! - `cli`: the command `npr`, and with it the parser of its arguments and its progress bars. A library needs neither.
//!
//! # WebAssembly
//!
//! The library compiles for `wasm32-unknown-unknown`, with and without `gpu`. At run time that target has no threads, no
//! clock, no files and nothing that can block:
//!
//! - The CPU executor renders on the calling thread. A number of threads above 1 ([`cpu::CpuOptions`]) panics.
//! - What reads or writes files, such as [`style::Style::read`] or [`picture::Image::save_png`], returns an error.
//!   [`style::Style::from_toml`] takes text.
//! - [`gallery::render`], [`check::run`] and the functions of [`measure`] panic, for the clock and for files.
//! - [`executor::Executor::choose`] with [`executor::Backend::Auto`] or [`executor::Backend::Gpu`], and whatever reads a
//!   picture back from a device, would block until the browser has answered, and panic; [`executor::Backend::Cpu`] does not.
#![warn(missing_docs)]

pub mod budget;
pub mod calibrate;
pub mod camera;
pub mod capabilities;
pub mod chart;
pub mod check;
pub mod color;
pub mod compare;
pub mod cpu;
mod derived;
pub mod edge_lines;
pub mod error;
pub mod executor;
pub mod facets;
pub mod figures;
pub mod gallery;
mod geometry;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod ground;
pub mod hatch;
pub mod hull_lines;
pub mod image_lines;
pub mod inspect;
pub mod lights;
pub mod measure;
pub mod outliers;
pub mod picture;
pub mod picture_limits;
pub mod plan;
#[cfg(feature = "laboratory")]
pub mod plot;
pub mod printed_fins;
pub mod rays;
#[cfg(feature = "laboratory")]
pub mod report;
pub mod scene;
mod schema;
#[cfg_attr(not(feature = "gpu"), allow(dead_code, unused_imports, reason = "what shades give to a device"))]
pub mod shade;
pub mod shadow;
pub mod stability;
pub mod style;
pub mod suggest;
pub mod systems;
pub mod texel_format;
pub mod texture;
pub mod truth;
pub mod variant;
pub mod view;

/// The crate of the vectors and matrices in this API.
pub use glam;
/// The crate of Gooch shading, whose types styles have.
pub use npr_gooch;
/// The crate of hatching, whose types styles have.
pub use npr_hatch;
/// The crate of lines in the image, whose types styles have.
pub use npr_imagespace;
/// The crate of models, which scenes are made of.
pub use npr_mesh;
/// The crate of lines from edges, whose types plans have.
pub use npr_outline;
/// The crate of banded light, whose types styles have.
pub use npr_toon;
/// The crate of the devices, textures and encoders in this API.
#[cfg(feature = "gpu")]
pub use wgpu;

/// Compiles the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadMe;
