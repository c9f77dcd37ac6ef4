//! The output of the CPU executor, and its options.

use crate::color::to_bytes;
use crate::image_lines::gbuffer::texel::GBufferTexel;
use crate::picture::Image;
use glam::{DVec2, DVec4};
use npr_outline::segment::VEIL_LAYERS;

/// The nearest [`VEIL_LAYERS`] blended surfaces with an alpha below 0.5 at a pixel: their depths in the depth buffer, 0
/// where there is none, and their alphas.
pub(crate) type Veils = [DVec4; 2];

const _: () = assert!(VEIL_LAYERS == 4);

/// Options of a CPU frame that are not part of its plan: they change how the scene is sampled, not what is rendered.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CpuOptions {
    /// The offset of the surface samples from the pixel centres, px; pixels whose colour changes with it are those
    /// where the reference is sensitive to sampling. Lines do not move, since their coverage is analytic, but their
    /// visibility is tested against the moved samples. Inverted hulls and printed fins, which have no coverage, are
    /// sampled like surfaces.
    pub shift_px: DVec2,
    /// Shrinks faces by this distance at mesh boundaries, px. The surface that then shows between two adjacent faces
    /// that are not connected may also show on a GPU, which rounds the corners.
    pub boundary_inset_px: f64,
    /// The maximum number of threads; 0 for as many as the machine has.
    pub threads: usize,
}

/// A picture in f64, before it is rounded to bytes, and its depth buffer.
#[derive(Clone, Debug)]
pub struct CpuFrame {
    /// The width of the picture, px.
    pub width: u32,
    /// The height of the picture, px.
    pub height: u32,
    /// Per pixel, in rows from the top: display-referred RGBA, 0..=1.
    pub color: Vec<DVec4>,
    /// Per pixel: the value of the depth buffer, 0 for background.
    pub depth: Vec<f64>,
    /// Per pixel of the ink: packed normal, region and depth, if lines are found in the image; else empty.
    pub texels: Vec<[u32; 2]>,
    /// The same unquantised, if the style has a G-buffer of its own; else empty.
    pub gbuffer: Vec<GBufferTexel>,
}

impl CpuFrame {
    /// The picture, rounded to bytes.
    pub fn image(&self) -> Image {
        let rgba8 = self.color.iter().flat_map(|&c| to_bytes(c)).collect();
        Image::new(self.width, self.height, rgba8).expect("four bytes a pixel")
    }

    /// Averages the samples of each pixel in display space, where coverage is blended too, and takes the nearest depth.
    /// `samples` is the number of samples per pixel along each axis; the frame is that many times as wide and high as
    /// the result.
    pub(crate) fn resolved(&self, samples: u32) -> Self {
        let (width, height) = (self.width / samples, self.height / samples);
        let mut color = Vec::with_capacity(width as usize * height as usize);
        let mut depth = Vec::with_capacity(color.capacity());
        for y in 0..height {
            for x in 0..width {
                let (mut sum, mut nearest) = (DVec4::ZERO, 0.0f64);
                for sub in 0..samples * samples {
                    let row = (y * samples + sub / samples) as usize * self.width as usize;
                    let at = row + (x * samples + sub % samples) as usize;
                    sum += self.color[at];
                    nearest = nearest.max(self.depth[at]);
                }
                color.push(sum / f64::from(samples * samples));
                depth.push(nearest);
            }
        }
        Self { width, height, color, depth, texels: Vec::new(), gbuffer: Vec::new() }
    }
}
