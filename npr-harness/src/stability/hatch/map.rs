//! The tones of a map's levels.

use super::super::setup::{curve, limit, side_by_side};
use super::super::{Axis, Finding, Sweep};
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::picture::Image;
use npr_hatch::{Tam, TamParameters, Thresholds, draw};

pub(super) const SWEEP: Sweep = Sweep {
    name: "hatch-map-tones",
    technique: "hatching",
    what: "A mip level of a few texels has too few thresholds for every tone; strokes drawn with reduced pressure keep the \
           tones of the six images.",
    needs_adapter: false,
    run: measure,
};

/// A level of a tone, each texel as a square that makes it as large as the others.
fn level(tam: &Tam, tone: usize, level: usize, size: u32) -> Image {
    let side = tam.level_side(level);
    let texels = tam.image(tone, level);
    let gray = |x: u32, y: u32| texels[(y * side / size * side + x * side / size) as usize];
    let pixel = |x: u32, y: u32| [gray(x, y), gray(x, y), gray(x, y), 255];
    let rgba8 = (0..size).flat_map(|y| (0..size).flat_map(move |x| pixel(x, y))).collect();
    Image::new(size, size, rgba8).expect("four bytes a pixel")
}

fn measure(_: &Executor) -> Result<Finding, HarnessError> {
    let parameters = TamParameters::default();
    let drawing = draw(&parameters, None)?;
    let thresholds = Thresholds::new(&drawing, &parameters, None);
    let tam = &drawing.tam;
    let (mut six, mut one) = (Vec::new(), Vec::new());
    for number in (0..tam.levels()).rev() {
        let side = f64::from(tam.level_side(number));
        let error = |tone: usize| (tam.mean(tone, number) - f64::from(tam.tones[tone])).abs();
        six.push((side, (0..tam.tones.len()).map(error).fold(0.0, f64::max)));
        let texels = &thresholds.levels[number];
        let error = |tone: u32| {
            let tone = f64::from(tone) / 1000.0;
            let ink = texels.iter().filter(|&&texel| f64::from(texel) > tone * 65535.0).count();
            (1.0 - tone - ink as f64 / texels.len() as f64).abs()
        };
        one.push((side, (0..=1000).map(error).fold(0.0, f64::max)));
    }
    let at =
        |points: &[(f64, f64)], side: f64| points.iter().find(|point| point.0 == side).map_or(0.0, |point| point.1);
    // The strokes give way to a flat tone between the levels of 16 and of 8 texels.
    let what = "largest error of a tone, of the coarsest level that is shown, 16 × 16 texels";
    let predicted = (0.5 / 256.0, "half a texel of n²: every texel has another threshold");
    let curves = vec![
        curve("thresholds", one.clone(), limit(what, at(&one, 16.0), Some(predicted), Bound::AtMost(0.0025))),
        curve("six tones", six.clone(), limit(what, at(&six, 16.0), None, Bound::AtMost(0.0005))),
    ];
    let images: Vec<Image> = [3, 4, 5, 6].map(|number| level(tam, 2, number, 64)).to_vec();
    Ok(Finding {
        parameter: Axis::logarithmic("side of the level", "texels"),
        error: Axis::logarithmic("largest error of the mean tone", ""),
        curves,
        pictures: vec![("levels of 32, 16, 8 and 4 texels of one tone".into(), side_by_side(&images))],
    })
}
