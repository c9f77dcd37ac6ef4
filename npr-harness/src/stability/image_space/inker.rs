//! The inker of "The Evolution of a Cartoon Renderer" in floating point.

use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::figures::Setting;
use crate::image_lines::ImageInk;
use crate::image_lines::gbuffer::style::{GBuffer, GBufferTarget};
use crate::picture::Image;
use crate::stability::ink::{beside, curve, drawn, geometric, last_above, limit_at, picture_of};
use crate::stability::{Axis, Finding, Sweep};
use crate::style::Lines;
use crate::view::View;
use glam::DVec3;
use npr_imagespace::filter::inker::{DEPTH_DELTA, Inker, InkerForm, ink_inker};
use npr_imagespace::filter::printed::PrintedFilter;

pub(super) const INKER_SLOPE: Sweep = Sweep {
    name: "inker-slope",
    technique: "image lines",
    what: "Listing 4 adds two squared differences of depth to a half and inks what exceeds a half: in floating point every \
           slanted face. As printed one of them is not squared, so that its sign decides.",
    needs_adapter: false,
    run: inker_slope,
};

pub(super) const INKER_NEAR: Sweep = Sweep {
    name: "inker-near",
    technique: "image lines",
    what: "The inker's normal term is below 1 on a flat face that is near, because its threshold falls with depth, and the \
           sum with the constants of depth makes it ink.",
    needs_adapter: false,
    run: inker_near,
};

/// The ink, %, of a flat face with normals along z, whose opposite taps differ in depth.
fn flat_ink(form: InkerForm, depth: f64, differences: [f64; 2]) -> f64 {
    let inker = Inker { form, ..Inker::default() };
    let [d0, d1] = differences;
    100.0 * ink_inker(&inker, [DVec3::Z; 4], [depth, depth, depth - d0, depth - d1])
}

/// The built-in solids, inked by a form on bytes.
fn solids(executor: &Executor, form: InkerForm) -> Result<Image, HarnessError> {
    let target = GBufferTarget::Rgba8(PrintedFilter::Inker(Inker { form, ..Inker::default() }));
    let ink = ImageInk { gbuffer: Some(GBuffer { target, far: 2.0, ..GBuffer::default() }), ..ImageInk::default() };
    let view = View::new(Setting::Objects.camera(), (158, 106));
    drawn(executor, &Setting::Objects.scene(), Lines::image(ink), view, 1.0)
}

fn inker_slope(executor: &Executor) -> Result<Finding, HarnessError> {
    // Depths that are exact in f64, so that a plane's differences are equal.
    let slopes = geometric(1e-6, 1.0, 121);
    let cases = [
        ("as printed, depth falling", InkerForm::Printed, 1.0),
        ("as printed, depth rising", InkerForm::Printed, -1.0),
        ("instruction added", InkerForm::Corrected, 1.0),
        ("two thresholds", InkerForm::Explicit, 1.0),
    ];
    let curves = cases.map(|(name, form, sign)| {
        let points: Vec<_> =
            slopes.iter().map(|&slope| (slope, flat_ink(form, 0.5, [sign * slope, sign * slope]))).collect();
        // The smallest slope from which on all are ink.
        let first = points.iter().find(|point| point.1 > 50.0).map_or(1.0, |point| point.0);
        let what = "smallest difference of depth between opposite taps that is ink, of the range";
        let limit = match name {
            "as printed, depth falling" => limit_at(what, first, Bound::AtLeast(0.2))
                .predicted(0.5f64.sqrt() - 0.5, "d² + d = ¼: the sum of listing 4 without the second square"),
            "as printed, depth rising" => limit_at(
                "smallest difference of depth between opposite taps that is ink, of the range: there is none",
                first,
                Bound::AtLeast(1.0),
            ),
            "instruction added" => limit_at(what, first, Bound::AtMost(1e-6)),
            _ => limit_at(what, first, Bound::AtLeast(0.03))
                .predicted(f64::from(DEPTH_DELTA) / 2f64.sqrt(), "2 d² = δ², δ = √(1/512)"),
        };
        curve(name, points, limit)
    });
    let forms = [InkerForm::Corrected, InkerForm::Explicit];
    let pictures = forms.into_iter().map(|form| solids(executor, form)).collect::<Result<Vec<_>, _>>()?;
    Ok(Finding {
        parameter: Axis::logarithmic("difference of depth between opposite taps, of the range", ""),
        error: Axis::linear("ink on a plane", "%"),
        curves: curves.into(),
        pictures: vec![(
            "Solids by listing 4 with the missing instruction added, and with two thresholds.".into(),
            beside(&pictures),
        )],
    })
}

fn inker_near(_: &Executor) -> Result<Finding, HarnessError> {
    let cases = [
        ("as printed", InkerForm::Printed),
        ("instruction added", InkerForm::Corrected),
        ("two thresholds", InkerForm::Explicit),
    ];
    let curves = cases.map(|(name, form)| {
        let points: Vec<_> =
            (0..=200).map(|i| f64::from(i) * 0.001).map(|depth| (depth, flat_ink(form, depth, [0.0; 2]))).collect();
        let measured = last_above(&points, 50.0);
        let what = "encoded depth up to which a flat face that looks at the viewer is ink";
        let limit = match form {
            InkerForm::Printed => limit_at(what, measured, Bound::AtMost(0.034)).predicted(
                0.75f64.sqrt() / 2.0 - 0.4,
                "4 (0.4 + z)² = ¾: the normal term of listing 4 and its constants",
            ),
            InkerForm::Corrected => limit_at(what, measured, Bound::AtMost(0.1))
                .predicted(0.1, "4 (0.4 + z)² = 1: the normal term of listing 4, with both constants"),
            InkerForm::Explicit => limit_at(what, measured, Bound::AtMost(0.0005)),
        };
        curve(name, points, limit)
    });
    Ok(Finding {
        parameter: Axis::linear("encoded depth of a flat face", ""),
        error: Axis::linear("ink", "%"),
        curves: curves.into(),
        pictures: vec![(
            "Flat faces of all depths from 0 (left) to 0.15 of the range: as printed, with the instruction added, and with \
             two thresholds."
                .into(),
            beside(&[InkerForm::Printed, InkerForm::Corrected, InkerForm::Explicit].map(faces_of_all_depths)),
        )],
    })
}

/// The ink of flat faces, nearest at the left.
fn faces_of_all_depths(form: InkerForm) -> Image {
    const SIZE: (u32, u32) = (104, 40);
    let ink_at = |pixel: u32| {
        let depth = 0.15 * f64::from(pixel % SIZE.0) / f64::from(SIZE.0);
        // A frame shows where the faces end.
        let (x, y) = (pixel % SIZE.0, pixel / SIZE.0);
        let is_frame = x == 0 || y == 0 || x == SIZE.0 - 1 || y == SIZE.1 - 1;
        if is_frame || flat_ink(form, depth, [0.0; 2]) > 50.0 { 255 } else { 0 }
    };
    picture_of(&(0..SIZE.0 * SIZE.1).map(ink_at).collect::<Vec<u8>>(), SIZE.0)
}
