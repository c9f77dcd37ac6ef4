//! The errors of this crate.

/// A rule that an input or a render target breaks.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OutlineError {
    /// A line width that is negative or not finite.
    #[error("a line width of {width_px} px: it must be finite and not negative")]
    Width {
        /// The width, px.
        width_px: f32,
    },
    /// A crease angle outside 0..=π.
    #[error("a crease angle of {angle_rad} rad: it must lie in 0..=π")]
    CreaseAngle {
        /// The angle, radians.
        angle_rad: f32,
    },
    /// A model of more faces than an edge can number.
    #[error("{faces} faces: lines along edges can be found in up to {} of them", crate::contour::MOST_FACES)]
    TooManyFaces {
        /// The number of faces.
        faces: usize,
    },
    /// More edges than fit into one buffer of the device.
    #[error("{bytes} bytes of edge records exceed the device's limit of {limit} for one buffer")]
    TooManyEdges {
        /// The bytes that are needed.
        bytes: u64,
        /// The device's limit, bytes.
        limit: u64,
    },
    /// More vertices or faces of a hull than fit into one buffer of the device.
    #[error("{bytes} bytes of a hull's vertices or faces exceed the device's limit of {limit} for one buffer")]
    HullTooLarge {
        /// The bytes that are needed.
        bytes: u64,
        /// The device's limit, bytes.
        limit: u64,
    },
    /// A colour format whose stores encode sRGB, in which coverage would blend in linear light.
    #[cfg(feature = "wgpu")]
    #[error("a colour target of format {format:?}: stores must not encode sRGB")]
    SrgbTarget {
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
    /// A texture of another size than the others, or than the view's.
    #[cfg(feature = "wgpu")]
    #[error("{what} of {} × {} px: {} × {} px are needed", size_px[0], size_px[1], needed_px[0], needed_px[1])]
    ViewSize {
        /// Which texture.
        what: &'static str,
        /// Its width and height, px.
        size_px: [u32; 2],
        /// The width and height that are needed, px.
        needed_px: [u32; 2],
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
        area[2], area[3], area[0], area[1], size_px[0], size_px[1]
    )]
    Area {
        /// Left, top, width and height, px.
        area: [u32; 4],
        /// Width and height of the target, px.
        size_px: [u32; 2],
    },
    /// A matrix whose depth grows with distance, where reversed depth is needed: 1 at the near plane, falling with
    /// distance.
    #[cfg(feature = "wgpu")]
    #[error(
        "clip_from_world maps nearer points to smaller depths ({nearer} before {farther}): reversed depth is needed"
    )]
    StandardDepth {
        /// Depth of the nearer of two points.
        nearer: f64,
        /// Depth of the farther one.
        farther: f64,
    },
    /// A matrix with a far plane, for a pass that clips there what reaches to infinity.
    #[cfg(feature = "wgpu")]
    #[error(
        "clip_from_world has a far plane at a clip-space w of {far}: a matrix without one, or a pass without depth clipping, is needed"
    )]
    FarPlane {
        /// Clip-space w at the far plane; infinite in a parallel view, whose w is the same everywhere.
        far: f64,
    },
}
