//! The settings of a G-buffer in a style.

use crate::error::HarnessError;
use crate::schema::within;
use crate::texel_format::TexelFormat;
use npr_imagespace::filter::depth::{DEPTH_SUM_CARD_MITCHELL, DepthPlain};
use npr_imagespace::filter::inker::Inker;
use npr_imagespace::filter::normal::NORMAL_COS_CARD_MITCHELL;
use npr_imagespace::filter::printed::{PrintedDepth, PrintedEdges, PrintedFilter, PrintedNormal, PrintedUniform};
use npr_imagespace::filter::separate::{SeparateDepthTest, SeparateFilter, SeparateUniform};
use npr_imagespace::format::depth::DepthFormat;
use npr_imagespace::format::normal::NormalFormat;
use npr_imagespace::morphology::{Kernel, Operation};

/// The largest number of different steps of morphology.
pub const MOST_STEPS: usize = 4;
/// The largest number of times that a step is repeated.
pub const MOST_TIMES: u32 = 64;

/// A G-buffer, and what is done with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GBuffer {
    /// The formats, and the filter over them.
    pub target: GBufferTarget,
    /// What stands where there is no surface.
    pub background: Background,
    /// Where the depths of fixed-point formats end, in multiples of the scene's farthest depth, 1..=1e6: a far plane.
    pub far: f32,
    /// Whether depth is negated where normals are ([`crate::shadow::ShadowLines::Negated`]), as on the slides of
    /// Mitchell, Brennan & Card. This needs [`GBufferTarget::Separate`] with a depth format that has a sign, and a test
    /// on plain differences.
    pub negated_depth: bool,
    /// Steps of morphology on the ink, in this order.
    pub steps: [Option<InkStep>; MOST_STEPS],
    /// What the picture shows.
    pub show: Show,
}

/// Formats and filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GBufferTarget {
    /// Normals and depth in one target of 8-bit RGBA, compared as bytes: Card & Mitchell 2002, listings 8 to 10, and the
    /// inker of "The Evolution of a Cartoon Renderer". There are no regions in it. Depths run from the scene's nearest
    /// to its farthest.
    Rgba8(PrintedFilter),
    /// A target each for normals, depth and regions, as on the slides of Mitchell, Brennan & Card.
    Separate(SeparateTargets),
}

/// Three targets and their filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeparateTargets {
    /// The filter. Plain tests compare shares of the range from the scene's nearest to its farthest depth, the others
    /// eye depth. The plan sets whether the view is parallel.
    pub filter: SeparateFilter,
    /// How normals are stored; `None` as floats of 32 bits.
    pub normals: Option<NormalFormat>,
    /// How depth is stored.
    pub depth: DepthFormat,
    /// Whether regions are colours that differ where the sums of their channels do, as printed; else they are numbers.
    pub region_sums: bool,
}

/// What a G-buffer is cleared to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Background {
    /// No normal, which differs from every normal.
    #[default]
    None,
    /// The normal +z of world space, as in Card & Mitchell 2002.
    PlusZ,
}

/// What the picture shows of a G-buffer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Show {
    /// Lines, composited over the picture.
    #[default]
    Lines,
    /// Normals as stored, (n + 1) / 2, instead of the picture; black where there is none.
    Normals,
    /// Depth as stored, black at the scene's nearest and white at its farthest point, instead of the picture. A negated
    /// depth is black.
    Depth,
    /// A colour for each region, instead of the picture; background is white.
    Regions,
}

/// A step of morphology, and how often it is done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InkStep {
    /// The step.
    pub kind: StepKind,
    /// How often, 1..=[`MOST_TIMES`].
    pub times: u32,
}

/// A step of morphology.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepKind {
    /// Hard dilation, erosion, opening or closing. Repeated, all steps of one direction come first.
    Hard(Operation, Kernel),
    /// The soft dilation of the slides ([`npr_imagespace::morphology::ink_dilate_soft_cross`]).
    SoftCross,
    /// The smoothed dilation of listing 5's text ([`npr_imagespace::morphology::ink_dilate_soft_diagonal`]), with its
    /// threshold.
    SoftDiagonal(f32),
    /// The same as printed ([`npr_imagespace::morphology::ink_dilate_soft_diagonal_printed`]).
    SoftDiagonalPrinted(f32),
}

impl Default for GBuffer {
    /// Card & Mitchell 2002, listings 8 to 10, corrected.
    fn default() -> Self {
        Self {
            target: GBufferTarget::Rgba8(PrintedFilter::Edges(PrintedEdges {
                normal: Some(PrintedNormal { cos: NORMAL_COS_CARD_MITCHELL, printed_background: false }),
                depth: Some(PrintedDepth { form: DepthPlain::Sum, threshold: DEPTH_SUM_CARD_MITCHELL }),
                ..PrintedEdges::default()
            })),
            background: Background::None,
            far: 1.0,
            negated_depth: false,
            steps: [None; MOST_STEPS],
            show: Show::Lines,
        }
    }
}

impl GBuffer {
    /// Whether the depth test compares plain values.
    pub(crate) fn is_plain(&self) -> bool {
        match &self.target {
            GBufferTarget::Rgba8(_) => true,
            GBufferTarget::Separate(separate) => {
                separate.filter.depth.is_some_and(|depth| matches!(depth.test, SeparateDepthTest::Plain { .. }))
            }
        }
    }

    /// The formats of the encoded targets that the filter reads: one of RGBA bytes, or those of normals, depths and
    /// regions.
    pub(crate) fn encoded(&self) -> [Option<TexelFormat>; 3] {
        match &self.target {
            GBufferTarget::Rgba8(_) => [Some(TexelFormat::Rgba8Unorm), None, None],
            GBufferTarget::Separate(SeparateTargets { filter, .. }) => [
                filter.normal.is_some().then_some(TexelFormat::Rgba32Float),
                filter.depth.is_some().then_some(TexelFormat::R32Float),
                filter.regions.then_some(TexelFormat::R32Uint),
            ],
        }
    }

    /// Whether there are steps of morphology.
    pub(crate) fn has_steps(&self) -> bool {
        self.steps.iter().any(Option::is_some)
    }

    /// Whether the inker finds lines.
    pub(crate) fn has_inker(&self) -> bool {
        matches!(self.target, GBufferTarget::Rgba8(PrintedFilter::Inker(_)))
    }

    /// Whether lines are tested by the alpha of the co-issued reading of listings 9 and 10.
    pub(crate) fn is_co_issued(&self) -> bool {
        matches!(self.target, GBufferTarget::Rgba8(PrintedFilter::Edges(PrintedEdges { co_issued: Some(_), .. })))
    }

    /// Checks the numbers, and that all of it can work together. `negated` says that the style negates normals in
    /// shadow.
    pub(crate) fn validate(&self, negated: bool) -> Result<(), HarnessError> {
        match &self.target {
            GBufferTarget::Rgba8(PrintedFilter::Edges(edges)) => {
                PrintedUniform::new(edges)?;
            }
            GBufferTarget::Rgba8(PrintedFilter::Inker(inker)) => {
                let Inker { form: _, normal_cos, normal_fall, depth_delta, softness, taps } = *inker;
                within("the inker's cosine", normal_cos, 0.0, 1.0, "0..=1")?;
                within("the fall of the inker's cosine", normal_fall, 0.0, 1.0, "0..=1")?;
                within("the inker's difference of depth", depth_delta, 0.0, 1.0, "0..=1")?;
                within("the inker's softness", softness, 0.0, 1.0, "0..=1")?;
                taps.validate()?;
                inker.validate()?;
            }
            GBufferTarget::Separate(separate) => {
                SeparateUniform::new(&separate.filter)?;
            }
        }
        within("a G-buffer's far plane", self.far, 1.0, 1e6, "1..=1e6 times the farthest depth")?;
        let has_sign = match &self.target {
            GBufferTarget::Separate(separate) => matches!(separate.depth, DepthFormat::Half | DepthFormat::Float),
            GBufferTarget::Rgba8(_) => false,
        };
        if self.negated_depth && !negated {
            return Err(HarnessError::GBuffer {
                what: "negated depth",
                needs: "negated normals (shadows = \"negated\")",
            });
        }
        if self.negated_depth && !(has_sign && self.is_plain()) {
            let needs = "separate targets, a depth format with a sign, and a test on plain differences";
            return Err(HarnessError::GBuffer { what: "negated depth", needs });
        }
        for InkStep { kind, times } in self.steps.iter().flatten() {
            within("the repetitions of a step", *times as f32, 1.0, MOST_TIMES as f32, "1..=64")?;
            if let StepKind::SoftDiagonal(threshold) | StepKind::SoftDiagonalPrinted(threshold) = *kind {
                within("the threshold of a smoothed dilation", threshold, 0.0, 1.0, "0..=1")?;
            }
        }
        Ok(())
    }
}
