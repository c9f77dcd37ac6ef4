//! Thick lines: dilation by a disc, and by repeated steps of small kernels, against the Euclidean disc.
//!
//! The truth is made from the picture of the same lines undilated: a pixel is ink if a line pixel lies within the radius.

use super::frames::{Candidate, Drawn, part_of, rows};
use super::{Chart, Lab, Row};
use crate::check::one_px_style;
use crate::error::HarnessError;
use crate::image_lines::ImageInk;
use crate::image_lines::gbuffer::style::{GBuffer, InkStep, MOST_STEPS, StepKind};
use crate::picture::Image;
use crate::style::Lines;
use crate::truth::lines::darkness;
use crate::variant::Setup;
use npr_imagespace::morphology::disc::Disc;
use npr_imagespace::morphology::{Kernel, Operation};

/// A chart for each radius, since lines of one width are no substitute for those of another.
pub(super) const CHARTS: [Chart; 3] = [
    chart("dilation-1", "Dilation by 1 px", |lab| run(lab, "dilation-1", 1)),
    chart("dilation-4", "Dilation by 4 px", |lab| run(lab, "dilation-4", 4)),
    chart("dilation-16", "Dilation by 16 px", |lab| run(lab, "dilation-16", 16)),
];

const fn chart(name: &'static str, title: &'static str, run: fn(&Lab<'_>) -> Result<Vec<Row>, HarnessError>) -> Chart {
    Chart {
        name,
        title,
        error: SHARE,
        about: "Lines widened by a disc or by repeated steps of a kernel: pixels that differ from the Euclidean disc, as a \
                share of the disc's ink.",
        choices: &["Kernel::Cross", "Kernel::Square", "Kernel::Diagonal"],
        run,
    }
}

const SHARE: &str = "wrong pixels, share of the ink";

fn run(lab: &Lab<'_>, chart: &str, radius_px: u32) -> Result<Vec<Row>, HarnessError> {
    let disc = |antialias| ink(Some(Disc { radius_px: radius_px as f32, antialias }), None);
    let steps = |kernel| ink(None, Some(InkStep { kind: StepKind::Hard(Operation::Dilate, kernel), times: radius_px }));
    let candidates = [
        ("disc", disc(false)),
        ("antialiased disc", disc(true)),
        ("cross, repeated", steps(Kernel::Cross)),
        ("square, repeated", steps(Kernel::Square)),
        ("diagonals, repeated", steps(Kernel::Diagonal)),
    ]
    .map(|(name, setup)| Candidate { name: name.into(), historical: false, setup });
    let thin = Candidate { name: String::new(), historical: false, setup: ink(None, None) };
    let mut all = Vec::new();
    for (number, subject) in lab.subjects.iter().enumerate() {
        let mut judge = |drawn: &Drawn<'_>| {
            let undilated = Drawn { candidate: &thin, ..*drawn }.image(drawn.view)?;
            Ok(Some(errors(&drawn.image(drawn.view)?, &undilated, radius_px)))
        };
        let progress = part_of(lab, number, lab.subjects.len());
        all.extend(rows(chart, lab, subject, &candidates, &mut judge, &progress)?);
    }
    Ok(all)
}

/// Lines from the target of 2002, which every device can render to, dilated.
fn ink(dilation: Option<Disc>, step: Option<InkStep>) -> Setup {
    let mut steps = [None; MOST_STEPS];
    steps[0] = step;
    let gbuffer = Some(GBuffer { steps, ..GBuffer::default() });
    Setup { style: one_px_style(Lines::image(ImageInk { gbuffer, dilation, ..ImageInk::default() })), samples: 1 }
}

fn errors(image: &Image, undilated: &Image, radius_px: u32) -> Vec<(String, f64)> {
    let truth = dilated(undilated, radius_px);
    let (mut wrong, mut ink, mut coverage) = (0u32, 0u32, 0.0);
    for (dark, &is_ink) in darkness(image).into_iter().zip(&truth) {
        wrong += u32::from((dark >= 0.999) != is_ink);
        ink += u32::from(is_ink);
        coverage += (dark - f64::from(u8::from(is_ink))).abs();
    }
    let of_ink = f64::from(ink.max(1));
    [(SHARE, f64::from(wrong) / of_ink), ("difference in coverage, share of the ink", coverage / of_ink)]
        .map(|(name, value)| (name.to_owned(), value))
        .into()
}

/// Whether a line pixel lies within a radius of each pixel, by its definition.
fn dilated(image: &Image, radius_px: u32) -> Vec<bool> {
    let (width, height) = (image.width as i32, image.height as i32);
    let radius = radius_px as i32;
    let mut ink = vec![false; (width * height) as usize];
    // Per row of the disc: half its width.
    let half = |dy: i32| f64::from(radius * radius - dy * dy).sqrt() as i32;
    for (at, dark) in (0i32..).zip(darkness(image)) {
        if dark < 0.5 {
            continue;
        }
        let (x, y) = (at % width, at / width);
        for dy in -radius..=radius {
            if (0..height).contains(&(y + dy)) {
                let (from, to) = ((x - half(dy)).max(0), (x + half(dy)).min(width - 1));
                let row = (y + dy) * width;
                ink[(row + from) as usize..=(row + to) as usize].fill(true);
            }
        }
    }
    ink
}
