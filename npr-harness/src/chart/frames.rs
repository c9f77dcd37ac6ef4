//! Rows of a chart from frames: each variant drawn, judged and timed on each executor.

use super::table::{Row, Time};
use super::{Lab, Subject};
use crate::error::HarnessError;
use crate::executor::{Executor, Picture};
use crate::measure::{Case, Timed, time};
use crate::picture::Image;
use crate::plan::Plan;
use crate::plan::resources::total_bytes;
use crate::scene::Scene;
use crate::variant::{Part, Setup, plain};
use crate::view::View;

/// A variant of a chart.
#[derive(Clone)]
pub(super) struct Candidate {
    pub(super) name: String,
    pub(super) historical: bool,
    pub(super) setup: Setup,
}

/// The variants of a part that apply to a setup.
pub(super) fn candidates(part: Part, base: &Setup) -> Vec<Candidate> {
    let of = |variant: crate::variant::Variant| {
        let setup = (variant.apply)(base)?;
        Some(Candidate { name: variant.name.into(), historical: variant.historical, setup })
    };
    part.variants().into_iter().filter_map(of).collect()
}

/// What draws the frames of a candidate.
pub(super) struct Drawn<'a> {
    pub(super) executor: &'a Executor,
    pub(super) candidate: &'a Candidate,
    pub(super) view: View,
    pub(super) scene: &'a Scene,
}

impl Drawn<'_> {
    /// A picture of the scene in a view of the same size.
    pub(super) fn image(&self, view: View) -> Result<Image, HarnessError> {
        let view = View { samples: self.candidate.setup.samples, ..view };
        let picture = Picture::new(self.scene, &self.candidate.setup.style, view);
        self.executor.render(&picture, &|_| {})
    }
}

/// Finds the errors of a candidate on an executor; `None` if the executor renders it like another candidate.
pub(super) type Judge<'a> = dyn FnMut(&Drawn<'_>) -> Result<Option<Errors>, HarnessError> + 'a;

/// Errors by name, that of the chart's axis first.
pub(super) type Errors = Vec<(String, f64)>;

/// The rows of a chart for a subject. Every candidate is judged, then all candidates that have errors are timed, with
/// the plain pass of every executor, in the same rounds.
pub(super) fn rows(
    chart: &str,
    lab: &Lab<'_>,
    subject: &Subject,
    candidates: &[Candidate],
    judge: &mut Judge<'_>,
    progress: &dyn Fn(f64),
) -> Result<Vec<Row>, HarnessError> {
    let Subject { name, scene, camera } = subject;
    let view = View::new(*camera, lab.size);
    let plan = |executor: &Executor, setup: &Setup| {
        let view = View { samples: setup.samples, ..view };
        Picture::new(scene, &setup.style, view).plan(executor.capabilities())
    };
    let mut plans: Vec<(&Executor, Plan)> = Vec::new();
    for executor in lab.executors {
        plans.push((executor, plan(executor, &plain())?));
    }
    let mut judged: Vec<(usize, &Candidate, Errors)> = Vec::new();
    let total = (lab.executors.len() * candidates.len()) as f64;
    for (number, executor) in lab.executors.iter().enumerate() {
        for (index, candidate) in candidates.iter().enumerate() {
            let drawn = Drawn { executor, candidate, view, scene };
            let found =
                plan(executor, &candidate.setup).and_then(|plan| Ok(judge(&drawn)?.map(|errors| (plan, errors))));
            match found {
                Ok(Some((plan, errors))) => {
                    plans.push((executor, plan));
                    judged.push((number, candidate, errors));
                }
                Ok(None) => {}
                Err(error) if error.is_device_limit() => {
                    (lab.skipped)(&format!("{chart}: {} on {}: {error}", candidate.name, executor.name()));
                }
                Err(error) => return Err(error),
            }
            progress(0.5 * (number * candidates.len() + index + 1) as f64 / total);
        }
    }
    let mut cases: Vec<Case<'_>> = plans.iter().map(|(executor, plan)| Case::Frame { executor, scene, plan }).collect();
    let timed = time(&mut cases, &lab.rounds, &|share| progress(0.5 + 0.5 * share))?;
    let (plains, timed) = timed.split_at(lab.executors.len());
    let rows = judged.into_iter().zip(timed).zip(&plans[lab.executors.len()..]);
    let mut found = Vec::new();
    for (((number, candidate, errors), timed), (executor, plan)) in rows {
        let resources = plan.resources(scene, &executor.capabilities())?;
        found.push(Row {
            chart: chart.to_owned(),
            variant: candidate.name.clone(),
            historical: candidate.historical,
            executor: executor.name(),
            scene: name.clone(),
            errors,
            time: time_of(timed, &plains[number], &plains[0]),
            bytes: total_bytes(&resources),
        });
    }
    Ok(found)
}

/// Work on the CPU that a chart measures, apart from frames.
pub(super) struct Work<'a> {
    pub(super) name: &'static str,
    pub(super) errors: Vec<(String, f64)>,
    pub(super) bytes: u64,
    pub(super) work: Box<dyn FnMut() + 'a>,
}

/// The rows of a chart of work on the CPU, timed in the same rounds as the plain pass of the first executor.
pub(super) fn rows_of_work(
    chart: &str,
    lab: &Lab<'_>,
    subject: &Subject,
    mut all: Vec<Work<'_>>,
    progress: &dyn Fn(f64),
) -> Result<Vec<Row>, HarnessError> {
    let Subject { name, scene, camera } = subject;
    let Some(executor) = lab.executors.first() else { return Ok(Vec::new()) };
    let setup = plain();
    let plan = Picture::new(scene, &setup.style, View::new(*camera, lab.size)).plan(executor.capabilities())?;
    let mut cases = vec![Case::Frame { executor, scene, plan: &plan }];
    cases.extend(all.iter_mut().map(|work| Case::Work(&mut *work.work)));
    let timed = time(&mut cases, &lab.rounds, progress)?;
    drop(cases);
    let (plain, timed) = timed.split_first().expect("the plain pass is the first case");
    let rows = all.into_iter().zip(timed);
    Ok(rows
        .map(|(work, timed)| Row {
            chart: chart.to_owned(),
            variant: work.name.to_owned(),
            historical: false,
            executor: "cpu".into(),
            scene: name.clone(),
            errors: work.errors,
            time: time_of(timed, plain, plain),
            bytes: work.bytes,
        })
        .collect())
}

fn time_of(timed: &Timed, own_plain: &Timed, plain: &Timed) -> Time {
    Time {
        relative: timed.wall.relative_to(&plain.wall),
        relative_own: timed.wall.relative_to(&own_plain.wall),
        ms: timed.wall.spread(),
        device_ms: timed.device.as_ref().map(|device| device.spread()),
    }
}

/// The progress of one of several equal parts.
pub(super) fn part_of<'a>(lab: &'a Lab<'_>, number: usize, of: usize) -> impl Fn(f64) + 'a {
    move |share| (lab.progress)((number as f64 + share) / of.max(1) as f64)
}
