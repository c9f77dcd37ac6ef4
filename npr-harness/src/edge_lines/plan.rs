//! The part of a plan that is about lines along edges.

use crate::error::HarnessError;
use crate::scene::Scene;
use crate::schema::{within, within_colors};
use glam::DVec4;
use npr_outline::contour::{ContourEdges, ContourOptions, contour_edges};
use npr_outline::line_style::LineStyle;
use std::sync::Arc;

/// Not quite black: the ink of the styles of this crate.
pub const INK: [f32; 4] = [0.10, 0.09, 0.11, 1.0];

/// Lines along edges.
#[derive(Clone, Debug)]
pub struct EdgeLinePlan {
    /// The edges that can be lines.
    pub contours: Arc<ContourEdges>,
    /// Their widths in px of the picture, and their ink.
    pub style: LineStyle,
    /// How a device finds them.
    pub method: EdgeLineMethod,
}

/// How a device finds lines among the edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeLineMethod {
    /// A scan on the CPU.
    OnCpu,
    /// A compute pass, whose findings an indirect draw takes.
    OnDevice,
}

/// The key of the contours among what is derived of a scene: the crease angle.
#[derive(PartialEq)]
struct ContoursKey(f32);

impl EdgeLinePlan {
    /// `method`: chosen by the bytes that the edges take on a device.
    pub(crate) fn new(
        scene: &Scene,
        style: &LineStyle,
        crease_angle_rad: f32,
        method: impl FnOnce(u64) -> EdgeLineMethod,
    ) -> Result<Self, HarnessError> {
        style.validate()?;
        let contours = scene.derived.get(ContoursKey(crease_angle_rad), || {
            let options = ContourOptions { crease_angle_rad, material_borders: false };
            contour_edges(&scene.model, &scene.edges, &options)
        })?;
        let method = method(contours.device_bytes(&scene.model.positions));
        Ok(Self { contours, style: *style, method })
    }

    /// The edges that are lines for an eye, and how many there are of each [`LineKind`](npr_outline::LineKind).
    pub fn lines(&self, eye: DVec4) -> (Vec<u32>, [usize; 4]) {
        let (mut lines, mut counts) = (Vec::new(), [0; 4]);
        self.contours.scan(eye, &mut lines);
        let eye = self.contours.local_eye(eye);
        for kind in lines.iter().filter_map(|&line| self.contours.kind(line as usize, eye)) {
            counts[kind as usize] += 1;
        }
        (lines, counts)
    }
}

/// Whether widths and colours are in their ranges.
pub(crate) fn validate(style: &LineStyle) -> Result<(), HarnessError> {
    for &width_px in &style.width_px {
        // Wider ones take as long as there are pixels, each.
        within("a line's width", width_px, 0.0, 256.0, "0..=256 px")?;
    }
    within_colors("a component of the lines' ink", &style.ink)
}
