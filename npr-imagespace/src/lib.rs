//! stub
#![warn(missing_docs)]
pub mod artist;
pub mod composite;
mod error;
pub mod filter;
pub mod format;
pub mod morphology;
pub mod picture;
pub mod region;
pub use error::ImageSpaceError;
/// The functions.
pub const WGSL: &str = concat!(
    include_str!("picture.wgsl"),
    include_str!("format.wgsl"),
    include_str!("format/printed.wgsl"),
    include_str!("format/depth.wgsl"),
    include_str!("format/normal.wgsl"),
    include_str!("format/texel.wgsl"),
    include_str!("filter.wgsl"),
    include_str!("filter/normal.wgsl"),
    include_str!("filter/depth.wgsl"),
    include_str!("filter/region.wgsl"),
    include_str!("filter/fused.wgsl"),
    include_str!("filter/inker.wgsl"),
    include_str!("morphology.wgsl"),
    include_str!("morphology/flood.wgsl"),
    include_str!("composite.wgsl"),
    include_str!("artist.wgsl"),
);
