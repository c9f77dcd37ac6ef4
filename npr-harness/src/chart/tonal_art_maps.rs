//! Making a tonal art map: how near the tones of its levels are to those asked for, and what it takes.

use super::frames::{Work, part_of, rows_of_work};
use super::{Chart, Lab, Row};
use crate::error::HarnessError;
use npr_hatch::{Placement, TamParameters, Thresholds, draw};
use std::hint::black_box;

pub(super) const CHART: Chart = Chart {
    name: "tonal-art-maps",
    title: "Making a tonal art map",
    error: TONE,
    about: "Root mean square error of the mean tone over tones and levels, of maps of 128 texels and their mips down to 8: strokes \
            placed by a sequence, or each the best of random candidates, and the thresholds that encode all tones.",
    choices: &["Placement::Sequence", "Placement::BestOf"],
    run,
};

const TONE: &str = "RMSE of the tone";
const SIDE: u32 = 128;
/// The number of coarsest levels that are not measured: sides of 4, 2 and 1 texels are too few for the tones.
const SMALLEST: usize = 3;

fn run(lab: &Lab<'_>) -> Result<Vec<Row>, HarnessError> {
    // Maps do not depend on the scene.
    let Some(subject) = lab.subjects.first() else { return Ok(Vec::new()) };
    let placed = |placement| TamParameters { side: SIDE, placement, ..TamParameters::default() };
    let best_of = |candidates| placed(Placement::BestOf { candidates });
    let maps = [
        ("a sequence", placed(Placement::Sequence)),
        ("best of 1", best_of(1)),
        ("best of 4", best_of(4)),
        ("best of 16", best_of(16)),
        ("best of 64", best_of(64)),
    ];
    let parameters = placed(Placement::Sequence);
    let drawing = draw(&parameters, None)?;
    let mut all = Vec::new();
    for (name, parameters) in maps {
        let tam = draw(&parameters, None)?.tam;
        let texels = |level| u64::from(tam.level_side(level)).pow(2);
        let bytes = tam.tones.len() as u64 * (0..tam.levels()).map(texels).sum::<u64>();
        let errors = errors(&parameters, tam.levels(), |tone, level| tam.mean(tone, level));
        let make = move || {
            black_box(draw(&parameters, None).is_ok());
        };
        all.push(Work { name, errors, bytes, work: Box::new(make) });
    }
    let thresholds = Thresholds::new(&drawing, &parameters, None);
    let paper = |tone: usize, level: usize| {
        // A texel is ink if its threshold is above the tone.
        let texels = &thresholds.levels[level];
        let is_paper = |&&texel: &&u16| f64::from(texel) / 65535.0 <= f64::from(parameters.tones[tone]);
        texels.iter().filter(is_paper).count() as f64 / texels.len() as f64
    };
    let errors = errors(&parameters, thresholds.levels.len(), paper);
    let bytes = 2 * thresholds.levels.iter().map(|level| level.len() as u64).sum::<u64>();
    let make = || {
        black_box(Thresholds::new(&drawing, &parameters, None));
    };
    all.push(Work { name: "thresholds of a sequence", errors, bytes, work: Box::new(make) });
    rows_of_work(CHART.name, lab, subject, all, &part_of(lab, 0, 1))
}

/// The errors of the mean tones, over tones and levels.
fn errors(parameters: &TamParameters, levels: usize, mean: impl Fn(usize, usize) -> f64) -> Vec<(String, f64)> {
    let tones = parameters.tones.iter().enumerate();
    let errors: Vec<f64> = tones
        .flat_map(|(tone, &asked)| (0..levels - SMALLEST).map(move |level| (tone, level, f64::from(asked))))
        .map(|(tone, level, asked)| mean(tone, level) - asked)
        .collect();
    let rmse = (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt();
    let worst = errors.iter().fold(0.0f64, |worst, error| worst.max(error.abs()));
    vec![(TONE.into(), rmse), ("largest error".into(), worst)]
}
