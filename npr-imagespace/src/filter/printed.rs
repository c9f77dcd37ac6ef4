//! The filters of 2002 over the RGBA8 target of [`crate::format::printed`], on its bytes.
//!
//! Discontinuities of normals and of depth are decided with integers, both in one pass; the chapter runs one pass for
//! each and multiplies the results. The inker of [`crate::filter::inker`] uses floats, as its source does.

use crate::ImageSpaceError;
use crate::composite::AlphaTest;
use crate::filter::depth::{
    DEPTH_SUM_CARD_MITCHELL, DepthPlain, depth_code_threshold, ink_depth_plain_codes, ink_depth_plain_measure,
};
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
    /// An alpha test of the edge images, whose alpha is that of the co-issued reading ([`ink_printed_co_issued`]).
    /// `None` for the sequential one, in which alpha is that of the final colour; the composite tests it then
    /// ([`crate::composite::Composite::AlphaTested`]).
    pub co_issued: Option<AlphaTest>,
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
            co_issued: None,
        }
    }
}

/// [`PrintedEdges`] in steps of bytes: `InkPrinted` of the WGSL, 16 bytes. Which tests are enabled is not in
/// it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct PrintedUniform {
    /// Of [`normal_bytes_threshold`].
    pub normal_threshold: i32,
    /// In codes.
    pub depth_threshold: u32,
    /// Of [`DepthPlain`]: 0 sum, 1 sum as printed, 2 any.
    pub depth_form: u32,
    /// The threshold of depth in codes, unrounded.
    pub depth_codes: f32,
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
            depth_codes: depth.threshold * 255.0,
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
    match edges.co_issued {
        None => edges.normal.is_some_and(differs) || edges.depth.is_some_and(jumps),
        Some(test) => {
            // The first three taps, the last of them twice.
            let three = [taps[0], taps[1], taps[2], taps[2]];
            let first_differ = |normal: PrintedNormal| {
                let differ =
                    if normal.printed_background { ink_normal_bytes_edge_printed } else { ink_normal_bytes_edge };
                differ(rgb(centre), three.map(rgb), uniform.normal_threshold)
            };
            let sum = |asked: PrintedDepth| ink_depth_plain_measure(depth(centre), taps.map(depth), asked.form);
            edges.normal.is_some_and(|n| ink_printed_co_issued(differs(n), u32::from(!first_differ(n)) * 255, test))
                || edges.depth.is_some_and(|d| {
                    let alpha = (sum(d) as f32 - uniform.depth_codes + 0.5).clamp(0.0, 255.0) as u32;
                    ink_printed_co_issued(jumps(d), alpha, test)
                })
        }
    }
}

/// Whether a line of an edge image passes an alpha test where its alpha, 0..=255, is that of the co-issued reading.
///
/// Listings 9 and 10 end in an instruction that is paired with `mov r0.a, r0.r`. If both halves of a pair read before
/// either writes, alpha is what red was before: in listing 9 the comparison with three of the four taps, in listing 10
/// the sum of differences less its threshold.
pub fn ink_printed_co_issued(is_line: bool, alpha: u32, test: AlphaTest) -> bool {
    let passes = if test.less { alpha < u32::from(test.reference) } else { alpha > u32::from(test.reference) };
    is_line && passes
}

/// The inker on bytes: ink 0..=1 of a pixel from its four taps.
pub fn ink_printed_inker(inker: &Inker, taps: [[u8; 4]; 4]) -> f64 {
    let decoded = taps.map(|texel| texel.map(|c| f64::from(c) / 255.0));
    let normals = decoded.map(|[x, y, z, _]| glam::DVec3::new(x, y, z) * 2.0 - 1.0);
    ink_inker(inker, normals, decoded.map(|texel| texel[3]))
}
