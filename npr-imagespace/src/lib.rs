//! Lines found in the image: the G-buffer formats that a geometry pass writes, edge filters over them, morphology that
//! widens lines, and their composite over a picture.
//!
//! ```
//! use glam::{UVec2, Vec3};
//! use npr_imagespace::filter::fused::{FilterUniform, FusedFilter, ink_fused};
//! use npr_imagespace::format::texel::{DepthCode, TexelLayout, ink_texel64_pack, ink_texel64_tap};
//! use npr_imagespace::morphology::disc::{Disc, DiscBuffers, dilate_disc};
//! use npr_imagespace::picture::filter_picture;
//!
//! // A surface 4 away, and from the eighth column on another, 5 away: what a geometry pass would write.
//! let size_px = UVec2::new(16, 9);
//! let code = DepthCode::perspective(1.0, f32::INFINITY, TexelLayout::Bits64)?;
//! let depth = |i: u32| if i % 16 < 8 { 4.0 } else { 5.0 };
//! let texels: Vec<_> = (0..16 * 9).map(|i| ink_texel64_pack(Vec3::Z, 1, depth(i), &code)).collect();
//!
//! let filter = FusedFilter::default();
//! let uniform = FilterUniform::new(&filter, TexelLayout::Bits64, &code)?;
//! let ink = filter_picture(&texels, size_px, filter.taps, |centre, taps| {
//!     ink_fused(&uniform, &ink_texel64_tap(centre), &taps.map(ink_texel64_tap)) as f32
//! })?;
//! assert_eq!(ink[16..32], [0, 0, 0, 0, 0, 0, 0, 255, 255, 0, 0, 0, 0, 0, 0, 0]);
//!
//! let (disc, mut thick) = (Disc { radius_px: 1.5, antialias: true }, Vec::new());
//! dilate_disc(&ink, size_px, &disc, &mut DiscBuffers::default(), &mut thick)?;
//! assert_eq!(thick[64..80], [0, 0, 0, 0, 0, 128, 255, 255, 255, 255, 128, 0, 0, 0, 0, 0]);
//! # Ok::<(), npr_imagespace::ImageSpaceError>(())
//! ```
//!
//! Lines from the image need no connectivity and work on any primitive: surfaces that interpenetrate, are cut by a clip
//! plane or are tessellated on the device have lines wherever neighbouring pixels differ.
//!
//! 1. [`mod@format`]: normal, region and depth of a pixel as a G-buffer holds them, encoded and decoded.
//! 2. [`region`], [`artist`], [`shadow`]: further sources of lines: region numbers, directions that no visible surface
//!    has, and the states of light and shadow.
//! 3. [`filter`]: ink where neighbouring pixels differ.
//! 4. [`morphology`]: dilation, erosion, opening and closing of ink.
//! 5. [`composite`], [`resample`]: ink over a picture of the same or of another size.
//!
//! With the feature `wgpu` the module `pass` has all of this as passes over textures.
//!
//! Functions whose names begin with `ink_` are written twice, with the same names and parameters: in Rust, the
//! reference, and in [`WGSL`], over values already loaded. Errors of the papers are stated where they are corrected;
//! the form as printed is kept, where it can run, under a name with `printed` in it.
//!
//! # Exactness
//!
//! Decisions on packed texels and on bytes are made with integers and are the same on every machine: [`filter::fused`]
//! with hard lines, the filters on bytes, the steps of [`morphology`] and all passes but the last of
//! [`morphology::flood`]. Soft ink agrees within 1/255. Decisions on floats may differ where an input is within
//! rounding of its threshold.
//!
//! # Colours
//!
//! Colours are display-referred and are mixed as they are displayed, without conversion to linear light.
//!
//! # Sources
//!
//! - D. Card, J. L. Mitchell: *Non-Photorealistic Rendering with Pixel and Vertex Shaders*, in *Direct3D ShaderX*,
//!   2002, "Image Space Techniques", listings 8–10.
//! - J. L. Mitchell, C. Brennan, D. Card: *Real-Time Image-Space Outlining for Non-Photorealistic Rendering*,
//!   SIGGRAPH 2002 sketch (slides).
//! - *The Evolution of a Cartoon Renderer*, GDNet: the inker, artists' lines, listings 3–5.
//! - T. Saito, T. Takahashi: *Comprehensible Rendering of 3-D Shapes*, SIGGRAPH 1990: the G-buffer that all of these go
//!   back to.
#![warn(missing_docs)]

pub mod artist;
pub mod composite;
mod error;
pub mod filter;
pub mod format;
pub mod morphology;
#[cfg(feature = "wgpu")]
pub mod pass;
pub mod picture;
pub mod region;
pub mod resample;
pub mod shadow;

/// The crate of the vectors and matrices in this API.
pub use glam;
/// The crate of the devices, textures and encoders in this API.
#[cfg(feature = "wgpu")]
pub use wgpu;

pub use error::ImageSpaceError;

/// Makes the library's text, and for the passes the list of its files.
macro_rules! library {
    ($($file:literal,)*) => {
        /// The functions of this crate in WGSL: no bindings, no entry points, every name begins with `ink_`, `INK_` or
        /// `Ink`.
        ///
        /// The concatenation of [`picture::PICTURE_WGSL`], [`format::FORMAT_WGSL`], [`shadow::SHADOW_WGSL`],
        /// [`filter::FILTER_WGSL`], [`morphology::MORPHOLOGY_WGSL`], [`composite::COMPOSITE_WGSL`],
        /// [`resample::RESAMPLE_WGSL`] and [`artist::ARTIST_WGSL`]. Each compiles alone, except the filters, which need
        /// formats and shadows.
        pub const WGSL: &str = concat!($(include_str!($file)),*);

        /// The files of [`WGSL`]: name and text.
        #[cfg(feature = "wgpu")]
        pub(crate) const LIBRARY: &[(&str, &str)] = &[$(($file, include_str!($file))),*];
    };
}

library!(
    "picture.wgsl",
    "format.wgsl",
    "format/printed.wgsl",
    "format/depth.wgsl",
    "format/normal.wgsl",
    "format/texel.wgsl",
    "region.wgsl",
    "shadow.wgsl",
    "filter.wgsl",
    "filter/normal.wgsl",
    "filter/depth.wgsl",
    "filter/region.wgsl",
    "filter/fused.wgsl",
    "filter/inker.wgsl",
    "filter/separate.wgsl",
    "filter/printed.wgsl",
    "morphology.wgsl",
    "morphology/flood.wgsl",
    "composite.wgsl",
    "resample.wgsl",
    "artist.wgsl",
);

/// Compiles the example of the README.
#[cfg(all(doctest, feature = "wgpu"))]
#[doc = include_str!("../README.md")]
struct ReadMe;
