//! A G-buffer on the CPU: its texels' encoding, the filters over it, and the steps of morphology.

use super::plan::GBufferPlan;
use super::style::{GBufferTarget, InkStep, Show, StepKind};
use super::texel::GBufferTexel;
use crate::cpu::frame::CpuFrame;
use glam::UVec2;
use npr_imagespace::filter::printed::{PrintedFilter, PrintedUniform, ink_printed_edges, ink_printed_inker};
use npr_imagespace::filter::separate::filter_separate;
use npr_imagespace::morphology::{
    ink_dilate_soft_cross, ink_dilate_soft_diagonal, ink_dilate_soft_diagonal_printed, ping_pong,
};
use npr_imagespace::picture::{Taps, filter_picture, ink_store};

/// Panic message for what the style's validation excludes.
const CHECKED: &str = "the plan was checked, and there is a texel for each pixel";

impl GBufferPlan {
    /// The reference implementation: the ink of a picture, after all steps.
    ///
    /// # Panics
    /// If `texels` does not have one element per pixel.
    pub fn ink(&self, texels: &[GBufferTexel], size_px: UVec2) -> Vec<u8> {
        let found = match &self.gbuffer.target {
            GBufferTarget::Rgba8(filter) => {
                let bytes: Vec<_> = texels.iter().map(|&texel| self.rgba8(texel)).collect();
                match filter {
                    PrintedFilter::Edges(edges) => {
                        let uniform = PrintedUniform::new(edges).expect(CHECKED);
                        filter_picture(&bytes, size_px, edges.taps, |centre, taps| {
                            f32::from(u8::from(ink_printed_edges(edges, &uniform, centre, taps)))
                        })
                    }
                    PrintedFilter::Inker(inker) => {
                        filter_picture(&bytes, size_px, inker.taps, |_, taps| ink_printed_inker(inker, taps) as f32)
                    }
                }
            }
            GBufferTarget::Separate(separate) => {
                let stored: Vec<_> = texels.iter().map(|&texel| self.separate(texel)).collect();
                filter_separate(&separate.filter, &stored, size_px)
            }
        };
        let steps = self.gbuffer.steps.iter().flatten();
        steps.fold(found.expect(CHECKED), |ink, step| stepped(ink, step, size_px))
    }

    /// Replaces the picture by what the style shows of the G-buffer.
    pub(crate) fn show(&self, frame: &mut CpuFrame) {
        let color = match self.gbuffer.show {
            Show::Lines => return,
            Show::Normals => Self::normal_color,
            Show::Depth => Self::depth_color,
            Show::Regions => Self::region_color,
        };
        for (pixel, &texel) in frame.color.iter_mut().zip(&frame.gbuffer) {
            *pixel = color(self, texel).extend(1.0);
        }
    }
}

/// The ink after one step and its repetitions.
fn stepped(ink: Vec<u8>, InkStep { kind, times }: &InkStep, size_px: UVec2) -> Vec<u8> {
    let soft = |taps: Taps, step: &dyn Fn(f64, [f64; 4]) -> f64| {
        (0..*times).fold(ink.clone(), |ink, _| soft_step(&ink, size_px, taps, step))
    };
    match *kind {
        StepKind::Hard(operation, kernel) => ping_pong(&ink, size_px, kernel, operation, *times).expect(CHECKED),
        StepKind::SoftCross => soft(Taps::Cross, &ink_dilate_soft_cross),
        StepKind::SoftDiagonal(threshold) => {
            soft(Taps::Diagonal, &|_, taps| ink_dilate_soft_diagonal(taps, threshold.into()))
        }
        StepKind::SoftDiagonalPrinted(threshold) => {
            soft(Taps::Diagonal, &|_, taps| ink_dilate_soft_diagonal_printed(taps, threshold.into()))
        }
    }
}

/// A soft step. Outside the picture there is paper.
fn soft_step(ink: &[u8], size_px: UVec2, taps: Taps, step: &dyn Fn(f64, [f64; 4]) -> f64) -> Vec<u8> {
    let [width, height] = size_px.as_ivec2().to_array();
    let at = |x: i32, y: i32| {
        if !(0..width).contains(&x) || !(0..height).contains(&y) {
            return 0.0;
        }
        f64::from(ink[(y * width + x) as usize]) / 255.0
    };
    let offsets = taps.offsets();
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    pixels.map(|(x, y)| ink_store(step(at(x, y), offsets.map(|o| at(x + o.x, y + o.y))) as f32)).collect()
}
