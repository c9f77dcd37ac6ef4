//! What can be wrong with what this crate is given.

/// A rule that the input breaks.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OutlineError {
    /// A line's width is negative, infinite or no number.
    #[error("a line width of {width_px} px: it must be finite and not negative")]
    Width {
        /// What was asked for.
        width_px: f32,
    },
    /// A crease angle that is no angle between two faces.
    #[error("a crease angle of {angle_rad} rad: it must lie in 0..=π")]
    CreaseAngle {
        /// What was asked for.
        angle_rad: f32,
    },
    /// More edges than one buffer of the device may hold.
    #[error("{bytes} bytes of edge records exceed the device's limit of {limit} for one buffer")]
    TooManyEdges {
        /// What is needed.
        bytes: u64,
        /// What there is.
        limit: u64,
    },
}
