//! The view of a picture: camera, size and samples.

use crate::camera::{Camera, Projection};
use glam::DVec2;

/// The camera, the size of the picture, and the samples per pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The camera.
    pub camera: Camera,
    /// Width and height of the picture, px.
    pub size: (u32, u32),
    /// Samples per pixel along each axis, at least 1. The picture is rendered that many times as large, with lines
    /// wider by the same factor, and averaged. Image-space lines are found at the picture's own size.
    pub samples: u32,
}

impl View {
    /// A view with one sample per pixel.
    pub fn new(camera: Camera, size: (u32, u32)) -> Self {
        Self { camera, size, samples: 1 }
    }

    /// Width and height of the grid of samples, px.
    pub fn sampled_size(&self) -> (u32, u32) {
        let samples = self.samples.max(1);
        (self.size.0.saturating_mul(samples), self.size.1.saturating_mul(samples))
    }

    /// [`Self::sampled_size`] as a vector.
    pub fn sampled_size_px(&self) -> DVec2 {
        size_px(self.sampled_size())
    }

    /// Whether all rays are parallel.
    pub fn is_parallel(&self) -> bool {
        matches!(self.camera.projection, Projection::Orthographic { .. })
    }
}

/// A size as a vector.
pub(crate) fn size_px((width, height): (u32, u32)) -> DVec2 {
    DVec2::new(width.into(), height.into())
}
