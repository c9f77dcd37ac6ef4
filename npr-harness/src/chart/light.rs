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

/// A chart for each kind of shade, since one is no substitute for the other.
pub(super) const CHARTS: [Chart; 2] = [
    chart("light-bands", "Light in bands", |lab| run(lab, "light-bands", &Shade::Toon(Bands::default()))),
    chart("light-gooch", "Gooch's light", |lab| run(lab, "light-gooch", &Shade::Gooch(Gooch::default()))),
];

const fn chart(name: &'static str, title: &'static str, run: fn(&Lab<'_>) -> Result<Vec<Row>, HarnessError>) -> Chart {
    Chart {
        name,
        title,
        error: RMSE,
        about: "A near light, against the same style per pixel with 64 samples: root mean square and largest difference of a \
                channel, of 255.",
        choices: &[],
        run,
    }
}

const RMSE: &str = "RMSE of 255";
/// Samples of the truth along each axis of a pixel.
const TRUE_SAMPLES: u32 = 8;

fn lit(shade: Shade) -> Setup {
    let lamp = StyleLight { light: Light::positional(Vec3::new(-0.9, 1.2, 1.1)), ..StyleLight::KEY };
    let toon = style("toon").expect("a style of this crate");
    Setup { style: Style { shade, lights: vec![lamp], lines: Lines::NONE, ..toon }, samples: 1 }
}

fn run(lab: &Lab<'_>, chart: &str, shade: &Shade) -> Result<Vec<Row>, HarnessError> {
    let base = lit(shade.clone());
    let mut of_shade: Vec<Candidate> = Vec::new();
    for candidate in candidates(Part::Light, &base) {
        // The other ways would not be more accurate with more samples.
        let is_sampled = [NormalUse::PerPixel, NormalUse::PerVertex].contains(&candidate.setup.style.normals);
        of_shade.extend(if is_sampled { candidates_of_samples(&candidate) } else { vec![candidate] });
    }
    let mut all = Vec::new();
    for (number, subject) in lab.subjects.iter().enumerate() {
        let truth = truth(&subject.scene, &View::new(subject.camera, lab.size), &base.style)?;
        let mut judge = |drawn: &Drawn<'_>| {
            let [rmse, worst] = differences(&drawn.image(drawn.view)?, &truth);
            Ok(Some(vec![(RMSE.into(), rmse), ("largest of 255".into(), worst)]))
        };
        let progress = part_of(lab, number, lab.subjects.len());
        all.extend(rows(chart, lab, subject, &of_shade, &mut judge, &progress)?);
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
