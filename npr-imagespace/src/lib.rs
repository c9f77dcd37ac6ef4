//! Lines found in the image: what a geometry pass writes for it, the filters, thicker lines, and how they come over
//! the picture.
//!
//! ```
//! use glam::{UVec2, Vec3};
//! use npr_imagespace::filter::fused::{FilterUniform, FusedFilter, ink_fused};
//! use npr_imagespace::format::texel::{DepthCode, TexelLayout, ink_wide_pack, ink_wide_tap};
//! use npr_imagespace::morphology::disc::{Disc, DiscBuffers, dilate_disc};
//! use npr_imagespace::picture::filter_picture;
//!
//! // A surface 4 away, and from the eighth column on another, 5 away: what a geometry pass would write.
//! let size_px = UVec2::new(16, 9);
//! let code = DepthCode::perspective(1.0, f32::INFINITY, TexelLayout::Wide)?;
//! let depth = |i: u32| if i % 16 < 8 { 4.0 } else { 5.0 };
//! let texels: Vec<_> = (0..16 * 9).map(|i| ink_wide_pack(Vec3::Z, 1, depth(i), &code)).collect();
//!
//! let filter = FusedFilter::default();
//! let uniform = FilterUniform::new(&filter, TexelLayout::Wide, &code)?;
//! let ink = filter_picture(&texels, size_px, filter.taps, |centre, taps| {
//!     ink_fused(&uniform, &ink_wide_tap(centre), &taps.map(ink_wide_tap)) as f32
//! })?;
//! assert_eq!(ink[16..32], [0, 0, 0, 0, 0, 0, 0, 255, 255, 0, 0, 0, 0, 0, 0, 0]);
//!
//! let (brush, mut thick) = (Disc { radius_px: 1.5, antialias: true }, Vec::new());
//! dilate_disc(&ink, size_px, &brush, &mut DiscBuffers::default(), &mut thick)?;
//! assert_eq!(thick[64..80], [0, 0, 0, 0, 0, 128, 255, 255, 255, 255, 128, 0, 0, 0, 0, 0]);
//! # Ok::<(), npr_imagespace::ImageSpaceError>(())
//! ```
//!
//! The half of outline drawing that works on any primitive, well-formed or not: what interpenetrates, is cut by a clip
//! plane or tessellated on the way has its lines where its pictures differ.
//!
//! 1. [`mod@format`]: normal, region and depth of a pixel as a G-buffer holds them, encoded and decoded.
//! 2. [`region`], [`artist`]: what else than the surface's own normals draws lines: numbers of regions, and directions
//!    that no visible surface has.
//!    [`shadow`]: whether they lie in shadow.
//! 3. [`filter`]: where neighbouring pixels differ there is ink.
//! 4. [`morphology`]: thicker, thinner, opened and closed.
//! 5. [`composite`], [`resample`]: ink over a picture, also of another size.
//!
//! With the feature `wgpu` the module `pass` has all of this as passes over textures.
//!
//! The same functions under the same names, `ink_`, stand here twice: in Rust, the reference, and in [`WGSL`], over
//! values already loaded. What the papers got wrong is told where it is mended, and kept under a name that says
//! `printed` where it can run.
//!
//! # What is exact
//!
//! A decision on packed texels or on bytes is one of whole numbers, and the same on every machine: [`filter::fused`],
//! hard; the filters on bytes; the steps of [`morphology`] and all but the last of [`morphology::flood`]. Soft ink is
//! the same within 1/255. Decisions on floats may differ where an input is within a rounding of its threshold.
//!
//! # Colours
//!
//! Display-referred: what is mixed is what is shown.
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
        /// The functions of this crate in WGSL: no bindings, no entry points, every name begins with `ink_`, `INK_` or `Ink`.
        ///
        /// It is all parts in a row: [`picture::PICTURE_WGSL`], [`format::FORMAT_WGSL`], [`shadow::SHADOW_WGSL`],
        /// [`filter::FILTER_WGSL`], [`morphology::MORPHOLOGY_WGSL`], [`composite::COMPOSITE_WGSL`], [`resample::RESAMPLE_WGSL`]
        /// and [`artist::ARTIST_WGSL`]. Each stands alone, but for the filters, which need the formats and the shadows.
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
