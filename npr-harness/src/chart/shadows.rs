//! Shadows: pixels in another shadow state than shadow rays give.
//!
//! The lights and views are those of [`crate::truth::shadows::shots`], half of them.

use super::frames::{Candidate, Drawn, candidates, part_of, rows};
use super::{Chart, Lab, Row};
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::style::{Lines, style};
use crate::truth::pieces::pieces;
use crate::truth::shadows::{ShadowShot, States, shots};
use crate::variant::{Part, Setup};
use glam::DVec2;

pub(super) const CHART: Chart = Chart {
    name: "shadows",
    title: "Shadows",
    error: SHARE,
    about: "Share of the pixels that are lit or shadowed wrongly, against shadow rays, over four lights and views. The CPU \
            follows such rays, so it has no error here by definition.",
    choices: &["VolumeMethod::OnCpu", "VolumeMethod::OnDevice"],
    run,
};

const SHARE: &str = "share of wrong pixels";
/// Every other shot.
const STEP: usize = 2;

fn run(lab: &Lab<'_>) -> Result<Vec<Row>, HarnessError> {
    let toon = style("toon-shadow").expect("a style of this crate");
    let base = Setup { style: crate::style::Style { lines: Lines::NONE, ..toon }, samples: 1 };
    let candidates: Vec<Candidate> = candidates(Part::Shadows, &base);
    let aspect = f64::from(lab.size.0) / f64::from(lab.size.1);
    let mut all = Vec::new();
    for (number, subject) in lab.subjects.iter().enumerate() {
        let shots: Vec<ShadowShot> = shots(&subject.scene, aspect).into_iter().step_by(STEP).collect();
        let mut truths = Vec::new();
        for shot in &shots {
            truths.push(States::by_rays(&subject.scene, shot, lab.size, DVec2::ZERO)?);
        }
        let mut judge = |drawn: &Drawn<'_>| {
            match drawn.executor {
                // Rays, whatever the method.
                Executor::Cpu { .. } if drawn.candidate.name != candidates[0].name => Ok(None),
                Executor::Cpu { .. } => Ok(Some(errors(&[], lab.size))),
                #[cfg(feature = "gpu")]
                Executor::Gpu(context) => {
                    let Some(shadow) = drawn.candidate.setup.style.shadow else { return Ok(None) };
                    let method = shadow.method;
                    let mut pairs = Vec::new();
                    for (shot, truth) in shots.iter().zip(&truths) {
                        let scene = &subject.scene;
                        let states =
                            crate::truth::shadows::states_on_device(context, scene, shot, method, None, lab.size);
                        match states {
                            Ok(states) => pairs.push((states, truth)),
                            // A map does not take every light, nor a device every volume.
                            Err(HarnessError::ShadowMapLight { .. } | HarnessError::ParallelVolumes) => {}
                            Err(error) => return Err(error),
                        }
                    }
                    Ok(Some(errors(&pairs, lab.size)))
                }
            }
        };
        let progress = part_of(lab, number, lab.subjects.len());
        let mut of_subject = rows(CHART.name, lab, subject, &candidates, &mut judge, &progress)?;
        of_subject.iter_mut().filter(|row| row.executor == "cpu").for_each(|row| row.variant = "rays".into());
        all.extend(of_subject);
    }
    Ok(all)
}

fn errors(pairs: &[(States, &States)], size: (u32, u32)) -> Vec<(String, f64)> {
    let (mut share, mut acne, mut loose, mut specks) = (0.0, 0.0, 0.0, 0.0);
    let count = pairs.len().max(1) as f64;
    for (actual, truth) in pairs {
        let found = actual.difference(truth);
        let wrong: Vec<f64> = (actual.states.iter().zip(&truth.states))
            .map(|(a, b)| f64::from(u8::from(a.is_some() && b.is_some() && a != b)))
            .collect();
        share += found.share / count;
        acne += found.acne / count;
        loose += found.loose / count;
        specks += found.share * pieces(&wrong, size).short_share / count;
    }
    [(SHARE, share), ("acne", acne), ("detached", loose), ("in specks under 6 px", specks)]
        .map(|(name, value)| (name.to_owned(), value))
        .into()
}
