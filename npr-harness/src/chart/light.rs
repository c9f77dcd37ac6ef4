//! Light on surfaces, per pixel, vertex or face and with one or several samples, against a supersampled truth.
//!
//! The truth is the same style lit per pixel, with hard borders, at [`TRUE_SAMPLES`]² samples a pixel. The light is near:
//! that of a distant one, interpolated between vertices, equals that of interpolated normals.

use super::frames::{Candidate, Drawn, candidates, part_of, rows};
use super::{Chart, Lab, Row};
use crate::capabilities::Capabilities;
use crate::cpu::{self, CpuOptions};
use crate::error::HarnessError;
use crate::lights::StyleLight;
use crate::picture::Image;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::shade::Shade;
use crate::style::{Lines, Style, style};
use crate::variant::{Part, Setup};
use crate::view::View;
use glam::Vec3;
use npr_gooch::Gooch;
use npr_toon::Bands;
use npr_toon::normal::NormalUse;
use npr_toon::source::Light;

pub(super) const CHART: Chart = Chart {
    name: "light",
    title: "Light",
    error: RMSE,
    about: "Bands and Gooch's tones of a near light, against the same style per pixel with 64 samples: root mean square \
            and largest difference of a channel, of 255.",
    choices: &[],
    run,
};

const RMSE: &str = "RMSE of 255";
/// Samples of the truth along each axis of a pixel.
const TRUE_SAMPLES: u32 = 8;

/// The shades that are lit.
fn shades() -> [(&'static str, Shade); 2] {
    [("bands", Shade::Toon(Bands::default())), ("Gooch", Shade::Gooch(Gooch::default()))]
}

fn lit(shade: Shade) -> Setup {
    let lamp = StyleLight { light: Light::positional(Vec3::new(-0.9, 1.2, 1.1)), ..StyleLight::KEY };
    let toon = style("toon").expect("a style of this crate");
    Setup { style: Style { shade, lights: vec![lamp], lines: Lines::NONE, ..toon }, samples: 1 }
}

fn run(lab: &Lab<'_>) -> Result<Vec<Row>, HarnessError> {
    let mut all = Vec::new();
    for (number, subject) in lab.subjects.iter().enumerate() {
        for (which, (name, shade)) in shades().into_iter().enumerate() {
            let base = lit(shade);
            let truth = truth(&subject.scene, &View::new(subject.camera, lab.size), &base.style)?;
            let mut of_shade: Vec<Candidate> = Vec::new();
            for candidate in candidates(Part::Light, &base) {
                // The other ways would not be more accurate with more samples.
                let is_sampled = [NormalUse::PerPixel, NormalUse::PerVertex].contains(&candidate.setup.style.normals);
                let all = if is_sampled { candidates_of_samples(&candidate) } else { vec![candidate] };
                of_shade.extend(all.into_iter().map(|c| Candidate { name: format!("{name}, {}", c.name), ..c }));
            }
            let mut judge = |drawn: &Drawn<'_>| {
                let [rmse, worst] = differences(&drawn.image(drawn.view)?, &truth);
                Ok(Some(vec![(RMSE.into(), rmse), ("largest of 255".into(), worst)]))
            };
            let progress = part_of(lab, number * shades().len() + which, lab.subjects.len() * shades().len());
            all.extend(rows(CHART.name, lab, subject, &of_shade, &mut judge, &progress)?);
        }
    }
    Ok(all)
}

/// A candidate with each number of samples.
fn candidates_of_samples(candidate: &Candidate) -> Vec<Candidate> {
    let with = |samples: Candidate| {
        let name = match samples.setup.samples {
            1 => candidate.name.clone(),
            _ => format!("{}, {}", candidate.name, samples.name),
        };
        Candidate { name, historical: candidate.historical, ..samples }
    };
    candidates(Part::Samples, &candidate.setup).into_iter().map(with).collect()
}

/// The picture that light is compared with.
pub(super) fn truth(scene: &Scene, view: &View, style: &Style) -> Result<Image, HarnessError> {
    let shade = match &style.shade {
        Shade::Toon(bands) => Shade::Toon(Bands { antialias: false, ..bands.clone() }),
        other => other.clone(),
    };
    let style = Style { shade, normals: NormalUse::PerPixel, ..style.clone() };
    let view = View { samples: TRUE_SAMPLES, ..*view };
    let plan = Plan::new(scene, &style, &view, &Capabilities::RAY_CASTER)?;
    Ok(cpu::render(scene, &plan, &CpuOptions::default(), &|_| {}).image())
}

/// Root mean square and largest difference of a channel, of 255.
pub(super) fn differences(image: &Image, truth: &Image) -> [f64; 2] {
    let differences = image
        .rgba8
        .chunks_exact(4)
        .zip(truth.rgba8.chunks_exact(4))
        .flat_map(|(a, b)| [0, 1, 2].map(|channel| f64::from(a[channel]) - f64::from(b[channel])));
    let (mut sum, mut count, mut worst) = (0.0, 0u32, 0.0f64);
    for difference in differences {
        sum += difference * difference;
        count += 1;
        worst = worst.max(difference.abs());
    }
    [(sum / f64::from(count.max(1))).sqrt(), worst]
}
