//! The filters of 2002 over the RGBA8 target of [`crate::format::printed`], on its bytes.
//!
//! Discontinuities of normals and of depth are decided with integers, both in one pass; the chapter runs one pass for
//! each and multiplies the results. The inker of [`crate::filter::inker`] uses floats, as its source does.

use crate::ImageSpaceError;
use crate::filter::depth::{DEPTH_SUM_CARD_MITCHELL, DepthPlain, depth_code_threshold, ink_depth_plain_codes};
use crate::filter::inker::{Inker, ink_inker};
use crate::filter::normal::{
    NORMAL_COS_CARD_MITCHELL, ink_normal_bytes_edge, ink_normal_bytes_edge_printed, normal_bytes_threshold,
};
use crate::picture::Taps;
use bytemuck::{Pod, Zeroable};

/// A filter of 2002.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PrintedFilter {
    /// Card & Mitchell 2002, listings 9 and 10.
    Edges(PrintedEdges),
    /// "The Evolution of a Cartoon Renderer", listing 4.
    Inker(Inker),
}

/// Discontinuities of normals and depth, hard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedEdges {
    /// Borders of normals.
    pub normal: Option<PrintedNormal>,
    /// Jumps of depth.
    pub depth: Option<PrintedDepth>,
    /// The neighbours that are compared.
    pub taps: Taps,
}

/// How normals are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedNormal {
    /// The cosine below which two differ, 0..=1.
    pub cos: f32,
    /// Whether a texel of zeros is a normal like any other, as printed, instead of background.
    pub printed_background: bool,
}

/// How depth is compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedDepth {
    /// How the four differences are combined.
    pub form: DepthPlain,
    /// The threshold, as a share of the range from near to far.
    pub threshold: f32,
}

impl Default for PrintedFilter {
    fn default() -> Self {
        Self::Edges(PrintedEdges::default())
    }
}

impl Default for PrintedEdges {
    /// Both, with the chapter's thresholds and its errors corrected.
    fn default() -> Self {
        Self {
            normal: Some(PrintedNormal { cos: NORMAL_COS_CARD_MITCHELL, printed_background: false }),
            depth: Some(PrintedDepth { form: DepthPlain::Sum, threshold: DEPTH_SUM_CARD_MITCHELL }),
            taps: Taps::Diagonal,
        }
    }
}

/// [`PrintedEdges`] in steps of bytes: `InkPrinted` of the WGSL, 16 bytes. Which tests are enabled is not in
/// it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct PrintedUniform {
    /// Of [`normal_bytes_threshold`].
    pub normal_threshold: i32,
    /// In codes.
    pub depth_threshold: u32,
    /// Of [`DepthPlain`]: 0 sum, 1 sum as printed, 2 any.
    pub depth_form: u32,
    /// Unused, 0.
    pub padding: u32,
}

impl PrintedUniform {
    /// Checks the filter.
    ///
    /// # Errors
    /// If a threshold is out of its range; [`ImageSpaceError::TapStep`].
    pub fn new(edges: &PrintedEdges) -> Result<Self, ImageSpaceError> {
        edges.taps.validate()?;
        let normal_cos = edges.normal.map_or(0.0, |normal| normal.cos);
        if !(0.0..=1.0).contains(&normal_cos) {
            return Err(ImageSpaceError::NormalThreshold { cos: normal_cos });
        }
        let depth = edges.depth.unwrap_or(PrintedDepth { form: DepthPlain::Sum, threshold: 0.0 });
        if !(depth.threshold >= 0.0 && depth.threshold.is_finite()) {
            return Err(ImageSpaceError::DepthStep { step: depth.threshold });
        }
        Ok(Self {
            normal_threshold: normal_bytes_threshold(normal_cos),
            depth_threshold: depth_code_threshold(depth.threshold, 255),
            depth_form: depth.form as u32,
            padding: 0,
        })
    }
}

/// Whether a pixel is a line. `uniform` is that of `edges`.
pub fn ink_printed_edges(edges: &PrintedEdges, uniform: &PrintedUniform, centre: [u8; 4], taps: [[u8; 4]; 4]) -> bool {
    let rgb = |[x, y, z, _]: [u8; 4]| [x, y, z];
    let depth = |texel: [u8; 4]| u32::from(texel[3]);
    let differs = |normal: PrintedNormal| {
        let differ = if normal.printed_background { ink_normal_bytes_edge_printed } else { ink_normal_bytes_edge };
        differ(rgb(centre), taps.map(rgb), uniform.normal_threshold)
    };
    let jumps = |asked: PrintedDepth| {
        ink_depth_plain_codes(depth(centre), taps.map(depth), asked.form, uniform.depth_threshold)
    };
    edges.normal.is_some_and(differs) || edges.depth.is_some_and(jumps)
}

/// The inker on bytes: ink 0..=1 of a pixel from its four taps.
pub fn ink_printed_inker(inker: &Inker, taps: [[u8; 4]; 4]) -> f64 {
    let decoded = taps.map(|texel| texel.map(|c| f64::from(c) / 255.0));
    let normals = decoded.map(|[x, y, z, _]| glam::DVec3::new(x, y, z) * 2.0 - 1.0);
    ink_inker(inker, normals, decoded.map(|texel| texel[3]))
}
