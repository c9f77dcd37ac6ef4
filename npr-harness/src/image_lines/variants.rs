//! The ways to find lines in the image.

use super::gbuffer::style::{Background, GBuffer, GBufferTarget, SeparateTargets};
use super::{ImageInk, InkScale, Regions};
use crate::style::Lines;
use crate::variant::{RequestedLines, Setup, Variant};
use npr_imagespace::composite::Composite;
use npr_imagespace::filter::depth::{DEPTH_ANY_OUTLINING_SKETCH, DEPTH_SUM_CARD_MITCHELL, DepthPlain};
use npr_imagespace::filter::fused::{DepthTest, FusedFilter};
use npr_imagespace::filter::inker::{Inker, InkerForm};
use npr_imagespace::filter::normal::NORMAL_COS_CARD_MITCHELL;
use npr_imagespace::filter::printed::{PrintedDepth, PrintedEdges, PrintedFilter, PrintedNormal};
use npr_imagespace::filter::separate::{SeparateDepth, SeparateDepthTest, SeparateFilter};
use npr_imagespace::format::depth::DepthFormat;
use npr_imagespace::format::normal::NormalFormat;
use npr_imagespace::format::texel::TexelLayout;
use npr_imagespace::morphology::disc::Disc;
use npr_imagespace::picture::Taps;

/// The mean width of lines that are not dilated, pixels of the target in which they are found: one or two.
const FOUND_PX: f32 = 1.5;

/// The width of the lines of an ink, px of the picture, where no G-buffer with steps of its own finds them.
pub(crate) fn width_px(ink: &ImageInk) -> f32 {
    let scale = scale_px(ink.scale);
    (FOUND_PX + 2.0 * ink.dilation.map_or(0.0, |disc| disc.radius_px)) * scale
}

/// The side of a pixel of the target in which lines are found, px of the picture.
fn scale_px(scale: InkScale) -> f32 {
    match scale {
        InkScale::Half => 2.0,
        InkScale::One => 1.0,
        InkScale::Double => 0.5,
    }
}

/// The asked lines, found in the image.
fn found(setup: &Setup, ink: ImageInk) -> Option<Setup> {
    RequestedLines::drawn(setup, |asked| {
        let radius_px = (asked.width_px / scale_px(ink.scale) - FOUND_PX) / 2.0;
        // Lines cannot be thinner than they are found, and half a pixel more needs no disc.
        let dilation = (radius_px >= 0.25).then_some(Disc { radius_px, antialias: true });
        let composite = Composite::Over { color: asked.color, opacity: asked.opacity };
        Some(Lines::image(ImageInk { dilation, composite, ..ink }))
    })
}

fn fused(setup: &Setup, filter: FusedFilter) -> Option<Setup> {
    found(setup, ImageInk { filter, ..ImageInk::default() })
}

/// A filter without tests.
const NONE: FusedFilter = FusedFilter {
    normal_cos: None,
    depth: None,
    regions: false,
    shadows: npr_imagespace::filter::fused::ShadowTest::NoStates,
    taps: Taps::Diagonal,
    softness: 0.0,
};

fn printed(setup: &Setup, filter: PrintedFilter, background: Background) -> Option<Setup> {
    let gbuffer = GBuffer { target: GBufferTarget::Rgba8(filter), background, ..GBuffer::default() };
    found(setup, ImageInk { gbuffer: Some(gbuffer), ..ImageInk::default() })
}

fn inker(setup: &Setup, form: InkerForm) -> Option<Setup> {
    printed(setup, PrintedFilter::Inker(Inker { form, ..Inker::default() }), Background::None)
}

/// Separate targets with a filter of all tests; `None` for normals is 32-bit floats.
fn separate(setup: &Setup, normals: Option<NormalFormat>, depth: DepthFormat) -> Option<Setup> {
    tested(setup, normals, depth, SeparateFilter::default().depth.map(|depth| depth.test))
}

fn tested(
    setup: &Setup,
    normals: Option<NormalFormat>,
    depth: DepthFormat,
    test: Option<SeparateDepthTest>,
) -> Option<Setup> {
    let default = SeparateFilter::default();
    let test = test.zip(default.depth).map(|(test, depth)| SeparateDepth { test, ..depth });
    let targets =
        SeparateTargets { filter: SeparateFilter { depth: test, ..default }, normals, depth, region_sums: false };
    let gbuffer = GBuffer { target: GBufferTarget::Separate(targets), ..GBuffer::default() };
    found(setup, ImageInk { gbuffer: Some(gbuffer), ..ImageInk::default() })
}

fn plain(setup: &Setup, form: DepthPlain) -> Option<Setup> {
    let test = SeparateDepthTest::Plain { form, threshold: DEPTH_SUM_CARD_MITCHELL };
    tested(setup, None, DepthFormat::Float, Some(test))
}

/// A way that a plan may choose.
const fn way(name: &'static str, choices: &'static [&'static str], apply: fn(&Setup) -> Option<Setup>) -> Variant {
    Variant { name, choices, historical: false, in_budget: true, apply }
}

/// A way of a style's own G-buffer, which is drawn by a pass of its own and encoded by another: a plan has no reason to
/// choose it.
const fn own(name: &'static str, choices: &'static [&'static str], apply: fn(&Setup) -> Option<Setup>) -> Variant {
    Variant { in_budget: false, ..way(name, choices, apply) }
}

/// A way with an error in print.
const fn historical(
    name: &'static str,
    choices: &'static [&'static str],
    apply: fn(&Setup) -> Option<Setup>,
) -> Variant {
    Variant { historical: true, ..own(name, choices, apply) }
}

/// Ways to draw lines.
pub(crate) const VARIANTS: &[Variant] = &[
    way("image, 64 bits", &["TexelLayout::Bits64", "InkScale::One", "Regions::Patch", "Taps::Diagonal"], |setup| {
        fused(setup, FusedFilter::default())
    }),
    way("image, 32 bits", &["TexelLayout::Bits32"], |setup| {
        found(setup, ImageInk { layout: TexelLayout::Bits32, ..ImageInk::default() })
    }),
    way("image, taps in a cross", &["Taps::Cross"], |setup| {
        fused(setup, FusedFilter { taps: Taps::Cross, ..FusedFilter::default() })
    }),
    way("image, soft", &[], |setup| fused(setup, FusedFilter { softness: 0.05, ..FusedFilter::default() })),
    way("image, half size", &["InkScale::Half"], |setup| {
        found(setup, ImageInk { scale: InkScale::Half, ..ImageInk::default() })
    }),
    way("image, double size", &["InkScale::Double"], |setup| {
        found(setup, ImageInk { scale: InkScale::Double, ..ImageInk::default() })
    }),
    way("image, regions by material", &["Regions::Material"], |setup| {
        found(setup, ImageInk { regions: Regions::Material, ..ImageInk::default() })
    }),
    way("image, regions by mesh", &["Regions::Mesh"], |setup| {
        found(setup, ImageInk { regions: Regions::Mesh, ..ImageInk::default() })
    }),
    way("image, one region", &["Regions::One"], |setup| {
        found(setup, ImageInk { regions: Regions::One, ..ImageInk::default() })
    }),
    way("image, normals alone", &[], |setup| {
        fused(setup, FusedFilter { normal_cos: FusedFilter::default().normal_cos, ..NONE })
    }),
    way("image, second differences of depth alone", &[], |setup| {
        fused(setup, FusedFilter { depth: Some(DepthTest::default()), ..NONE })
    }),
    way("image, first differences of depth alone", &[], |setup| {
        let depth = Some(DepthTest { step: DEPTH_ANY_OUTLINING_SKETCH, plain: true });
        fused(setup, FusedFilter { depth, ..NONE })
    }),
    way("image, regions alone", &[], |setup| fused(setup, FusedFilter { regions: true, ..NONE })),
    historical("2002, as printed", &["PrintedFilter::Edges", "GBufferTarget::Rgba8", "Background::PlusZ"], |setup| {
        let normal = PrintedNormal { cos: NORMAL_COS_CARD_MITCHELL, printed_background: true };
        let depth = PrintedDepth { form: DepthPlain::SumPrinted, threshold: DEPTH_SUM_CARD_MITCHELL };
        let edges = PrintedEdges { normal: Some(normal), depth: Some(depth), ..PrintedEdges::default() };
        printed(setup, PrintedFilter::Edges(edges), Background::PlusZ)
    }),
    own("2002, corrected", &["Background::None"], |setup| {
        printed(setup, PrintedFilter::Edges(PrintedEdges::default()), Background::None)
    }),
    historical("inker, as printed", &["InkerForm::Printed", "PrintedFilter::Inker"], |setup| {
        inker(setup, InkerForm::Printed)
    }),
    historical("inker, instruction added", &["InkerForm::Corrected"], |setup| inker(setup, InkerForm::Corrected)),
    own("inker, two thresholds", &["InkerForm::Explicit"], |setup| inker(setup, InkerForm::Explicit)),
    own("separate, floats", &["GBufferTarget::Separate", "DepthFormat::Float", "SeparateDepthTest::Bend"], |setup| {
        separate(setup, None, DepthFormat::Float)
    }),
    own("separate, normals of 3 bytes", &["npr_imagespace::NormalFormat::Biased8"], |setup| {
        separate(setup, Some(NormalFormat::Biased8), DepthFormat::Float)
    }),
    own("separate, normals of 10 bits", &["npr_imagespace::NormalFormat::Oct5"], |setup| {
        separate(setup, Some(NormalFormat::Oct5), DepthFormat::Float)
    }),
    own("separate, normals of 16 bits", &["npr_imagespace::NormalFormat::Oct8"], |setup| {
        separate(setup, Some(NormalFormat::Oct8), DepthFormat::Float)
    }),
    own("separate, normals of 32 bits", &["npr_imagespace::NormalFormat::Oct16"], |setup| {
        separate(setup, Some(NormalFormat::Oct16), DepthFormat::Float)
    }),
    own("separate, normals of half floats", &["npr_imagespace::NormalFormat::Half"], |setup| {
        separate(setup, Some(NormalFormat::Half), DepthFormat::Float)
    }),
    own("separate, depth of 8 bits", &["DepthFormat::Unorm8"], |setup| separate(setup, None, DepthFormat::Unorm8)),
    own("separate, depth of 16 bits", &["DepthFormat::Unorm16"], |setup| separate(setup, None, DepthFormat::Unorm16)),
    own("separate, depth in 2 bytes", &["DepthFormat::Packed2x8"], |setup| {
        separate(setup, None, DepthFormat::Packed2x8)
    }),
    own("separate, depth in 4 bytes", &["DepthFormat::Packed4x8"], |setup| {
        separate(setup, None, DepthFormat::Packed4x8)
    }),
    own("separate, depth of half floats", &["DepthFormat::Half"], |setup| separate(setup, None, DepthFormat::Half)),
    own("separate, relative first differences", &["SeparateDepthTest::Step"], |setup| {
        let test = SeparateDepthTest::Step { step: DEPTH_ANY_OUTLINING_SKETCH };
        tested(setup, None, DepthFormat::Float, Some(test))
    }),
    own("separate, sum of first differences", &["SeparateDepthTest::Plain", "DepthPlain::Sum"], |setup| {
        plain(setup, DepthPlain::Sum)
    }),
    historical("separate, sum of two first differences", &["DepthPlain::SumPrinted"], |setup| {
        plain(setup, DepthPlain::SumPrinted)
    }),
    own("separate, largest first difference", &["DepthPlain::Any"], |setup| plain(setup, DepthPlain::Any)),
];
