//! The errors of this crate.

use glam::{IVec2, UVec2};

/// A rule that an input or a render target breaks.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageSpaceError {
    /// A slice does not have one element for each pixel.
    #[error("{len} elements for a picture of {} × {} px", size_px.x, size_px.y)]
    Length {
        /// Its number of elements.
        len: usize,
        /// Width and height of the picture, px.
        size_px: UVec2,
    },
    /// A picture and its ink differ in size.
    #[error("{pixels} pixels and {ink} values of ink: there must be one for each pixel")]
    Pixels {
        /// Number of pixels.
        pixels: usize,
        /// Number of values of ink.
        ink: usize,
    },
    /// The nearest and farthest depth of a range are not `0 < near < far`.
    #[error(
        "depths from {near} to {far}: they must be 0 < near < far, and far may be infinite only where 1/z is stored"
    )]
    DepthRange {
        /// Nearest eye-space depth, scene units.
        near: f32,
        /// Farthest eye-space depth, scene units.
        far: f32,
    },
    /// The cosine below which two normals differ is not within 0..=1.
    #[error("a normal threshold of {cos}: a cosine within 0..=1 is needed")]
    NormalThreshold {
        /// The value that was given.
        cos: f32,
    },
    /// A step to a filter's tap that is 0 or too long.
    #[error("a step of ({}, {}) px to a tap: it must not be (0, 0), and each part must be within -64..=64", step_px.x, step_px.y)]
    TapStep {
        /// The step that was given, px.
        step_px: IVec2,
    },
    /// A depth step that is negative or not finite.
    #[error("a depth step of {step}: it must be finite and not negative")]
    DepthStep {
        /// The value that was given.
        step: f32,
    },
    /// A conversion from depth-buffer values that has no result: a number is not finite, or the scale is 0.
    #[error(
        "a depth buffer's scale of {scale}, bias of {bias}, cleared to {clear}: they must be finite, the scale not 0"
    )]
    DepthSource {
        /// The scale that was given.
        scale: f32,
        /// The bias that was given.
        bias: f32,
        /// The value of background that was given.
        clear: f32,
    },
    /// A softness, the width of the transition from paper to line, that is negative or not finite.
    #[error("a softness of {softness}: it must be finite and not negative")]
    Softness {
        /// The value that was given.
        softness: f32,
    },
    /// A softness with which the transition around the normal threshold reaches a cosine of 1, so that flat faces would
    /// have ink.
    #[error(
        "a softness of {softness} around a normal threshold of {cos}: flat faces would have ink; at most {most} is possible"
    )]
    NormalSoftness {
        /// The softness that was given.
        softness: f32,
        /// The normal threshold, a cosine.
        cos: f32,
        /// The largest softness: [`crate::filter::normal::normal_softness_max`].
        most: f32,
    },
    /// A softness with which the transition around the depth threshold begins below a difference of 0, so that flat
    /// faces would have ink.
    #[error("a softness of {softness} with a test of depth: flat faces would have ink; at most {most} is possible")]
    DepthSoftness {
        /// The softness that was given.
        softness: f32,
        /// The largest softness: [`crate::filter::depth::DEPTH_SOFTNESS_MAX`].
        most: f32,
    },
    /// A soft inker whose normal threshold is so large, at some depth, that flat faces would have ink.
    #[error("a soft inker with a normal threshold of {cos}: flat faces would have ink; at most {most} is possible")]
    InkerSoftness {
        /// The largest normal threshold over the depths 0..=1, a cosine.
        cos: f32,
        /// The largest possible: [`crate::filter::inker::INKER_SOFT_COS_MAX`].
        most: f32,
    },
    /// A radius that is negative, not finite or larger than 32766 px.
    #[error("a radius of {radius_px} px: it must be within 0..=32766")]
    Radius {
        /// The value that was given.
        radius_px: f32,
    },
    /// A threshold of a soft step that is negative or not finite.
    #[error("a step's threshold of {threshold}: it must be finite and not negative")]
    StepThreshold {
        /// The value that was given.
        threshold: f32,
    },
    /// A pair of adjacent faces has an index beyond the number of faces.
    #[error("a pair of adjacent faces has the index {face}, and there are {faces} faces")]
    Face {
        /// The index.
        face: u32,
        /// The number of faces.
        faces: usize,
    },
    /// A picture format whose stores encode sRGB, in which coverage would blend in linear light.
    #[cfg(feature = "wgpu")]
    #[error("a picture of format {format:?}: stores must not encode sRGB")]
    SrgbPicture {
        /// The format that was given.
        format: wgpu::TextureFormat,
    },
    /// A picture format that the blend unit cannot write.
    #[cfg(feature = "wgpu")]
    #[error(
        "a picture of format {format:?}: a colour format of floats that can be blended is needed, such as Rgba8Unorm"
    )]
    PictureFormat {
        /// The format that was given.
        format: wgpu::TextureFormat,
    },
    /// A texture of another format than the pass reads or writes.
    #[cfg(feature = "wgpu")]
    #[error("{what} of format {format:?}: {needed} is needed")]
    ViewFormat {
        /// Which texture.
        what: &'static str,
        /// Its format.
        format: wgpu::TextureFormat,
        /// The format, or the kind of format, that is needed.
        needed: &'static str,
    },
    /// A texture of another size than the target's.
    #[cfg(feature = "wgpu")]
    #[error("{what} of {} × {} px: {} × {} px are needed", size_px.x, size_px.y, needed_px.x, needed_px.y)]
    ViewSize {
        /// Which texture.
        what: &'static str,
        /// Its width and height, px.
        size_px: UVec2,
        /// The width and height that are needed, px.
        needed_px: UVec2,
    },
    /// A texture with several samples for each pixel.
    #[cfg(feature = "wgpu")]
    #[error("{what} of {samples} samples a pixel: 1 is needed")]
    ViewSamples {
        /// Which texture.
        what: &'static str,
        /// Its samples for each pixel.
        samples: u32,
    },
    /// An area that reaches beyond the target.
    #[cfg(feature = "wgpu")]
    #[error(
        "an area of {} × {} px at {}, {} reaches beyond a target of {} × {} px",
        area[2], area[3], area[0], area[1], size_px.x, size_px.y
    )]
    Area {
        /// Left, top, width and height, px.
        area: [u32; 4],
        /// Width and height of the target, px.
        size_px: UVec2,
    },
    /// A filter that looks for other things, or elsewhere, than the one that the pass was made for.
    #[cfg(feature = "wgpu")]
    #[error("the filter looks for other things than the one that the pass was made for")]
    OtherFilter,
    /// A texture that the filter reads is not given.
    #[cfg(feature = "wgpu")]
    #[error("the filter reads a texture of {what}, and none is given")]
    MissingTexture {
        /// What it holds.
        what: &'static str,
    },
}
