//! What can be wrong with what this crate is given.

use glam::UVec2;

/// A rule that the input breaks.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageSpaceError {
    /// A slice does not have one element for each pixel.
    #[error("{len} elements for a picture of {} × {} px", size_px.x, size_px.y)]
    Length {
        /// How many there are.
        len: usize,
        /// Of the picture.
        size_px: UVec2,
    },
    /// A picture and its ink differ in size.
    #[error("{pixels} pixels and {ink} of ink")]
    Pixels {
        /// How many there are.
        pixels: usize,
        /// How many there are.
        ink: usize,
    },
    /// The nearest and farthest depth of a range are not `0 < near < far`.
    #[error(
        "depths from {near} to {far}: they must be 0 < near < far, and far may be infinite only where 1/z is stored"
    )]
    DepthRange {
        /// Eye-space depth.
        near: f32,
        /// Eye-space depth.
        far: f32,
    },
    /// The cosine under which two normals are told apart is not within 0..=1.
    #[error("a normal threshold of {cos}: a cosine within 0..=1 is needed")]
    NormalThreshold {
        /// What was asked for.
        cos: f32,
    },
    /// A depth step that is negative or not finite.
    #[error("a depth step of {step}: it must be finite and not negative")]
    DepthStep {
        /// What was asked for.
        step: f32,
    },
    /// Numbers that turn no depth buffer into depths: one is not finite, or the scale is 0.
    #[error(
        "a depth buffer's scale of {scale}, bias of {bias}, cleared to {clear}: they must be finite, the scale not 0"
    )]
    DepthSource {
        /// What was given.
        scale: f32,
        /// What was given.
        bias: f32,
        /// What was given.
        clear: f32,
    },
    /// A width of the transition from paper to line that is negative or not finite.
    #[error("a softness of {softness}: it must be finite and not negative")]
    Softness {
        /// What was asked for.
        softness: f32,
    },
    /// A radius that is negative, not finite or larger than 32766 px.
    #[error("a radius of {radius_px} px: it must be within 0..=32766")]
    Radius {
        /// What was asked for.
        radius_px: f32,
    },
    /// A threshold of a soft step that is negative or not finite.
    #[error("a step's threshold of {threshold}: it must be finite and not negative")]
    StepThreshold {
        /// What was asked for.
        threshold: f32,
    },
    /// A pair of adjacent faces names a face that there is not.
    #[error("a face {face} of {faces}")]
    Face {
        /// What was named.
        face: u32,
        /// How many there are.
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
        "a picture of format {format:?}: a color format of floats that can be blended is needed, such as Rgba8Unorm"
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
