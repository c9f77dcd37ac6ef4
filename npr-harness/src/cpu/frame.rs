//! What the CPU executor makes, and what can be asked of it.

use crate::color::to_bytes;
use crate::picture::Image;
use glam::{DVec2, DVec4};

/// Options of a frame on the CPU that its plan does not know: they change how it is sampled, not what it shows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CpuOptions {
    /// Where surfaces are sampled relative to the pixels' centres, px: what changes with it is where the reference is
    /// sensitive. Lines stay where they are, since their coverage is no sample; whether they are hidden is decided by
    /// the moved samples. The printed fins, which have no coverage, are sampled like surfaces.
    pub shift_px: DVec2,
    /// Faces end so far before their boundaries, px: what is then seen between two faces that lie side by side without
    /// being joined is what a device may show there, whose corners are rounded.
    pub boundary_inset_px: f64,
    /// At most so many threads; 0 for as many as the machine has.
    pub threads: usize,
}

/// A picture in f64, before it is rounded to bytes, and the depth buffer under it.
#[derive(Clone, Debug)]
pub struct CpuFrame {
    /// Px.
    pub width: u32,
    /// Px.
    pub height: u32,
    /// Per pixel, rows from the top: display-referred RGBA, 0..=1.
    pub color: Vec<DVec4>,
    /// Per pixel the depth buffer's value, 0 where there is nothing.
    pub depth: Vec<f64>,
    /// Per pixel of the ink normal, region and depth, packed, where lines are found in the image; else empty.
    pub texels: Vec<[u32; 2]>,
}

impl CpuFrame {
    /// Rounded to bytes.
    pub fn image(&self) -> Image {
        let rgba8 = self.color.iter().flat_map(|&c| to_bytes(c)).collect();
        Image::new(self.width, self.height, rgba8).expect("four bytes a pixel")
    }

    /// The mean of each pixel's samples, in display space, as coverage is blended there; of the depth, the nearest.
    /// `samples`: along each axis; the frame is that many times as wide and as high as the result.
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
        Self { width, height, color, depth, texels: Vec::new() }
    }
}
