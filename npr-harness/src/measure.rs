//! How long frames take, and other work: interleaved rounds, and ratios within each round.
//!
//! Every round measures each case once, and the first round, which compiles pipelines and fills caches, is not counted.
//! What else a machine does slows all cases of a round, so the ratio of two cases within a round is steadier than either
//! of their times: report [`Samples::relative_to`], and times only to say how long a frame is.
//!
//! # Wall time and device time
//!
//! On an adapter a frame has two times. Wall time includes everything that a program waits for: recording commands on
//! the CPU, submitting them, the frame, and the wait for it, which several frames share on hardware
//! ([`Rounds::frames_a_wait`]). Device time is what lies between two timestamps of the adapter, one before the frame's
//! commands and one after. It excludes recording and waiting, and uploads of uniforms and instances, which the queue
//! makes before the commands.
//!
//! Mesa's software rasterisers write a timestamp when the fragments before it are done, but compute passes that only
//! write buffers leave them nothing to wait for: there, device time is too short for plans that find lines or bound
//! shadow volumes on the device. Wall time is the time to show for software adapters.

mod case;
#[cfg(feature = "gpu")]
mod clock;
#[cfg(feature = "gpu")]
mod on_adapter;
#[cfg(test)]
mod tests;

pub use case::{Case, HARDWARE_FRAMES, LEAST_ROUNDS, Rounds};

use crate::cpu::{self, CpuOptions};
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::plan::Plan;
use crate::scene::Scene;
use case::Measurement;
use serde::{Deserialize, Serialize};
use std::hint::black_box;
use std::time::Instant;

/// The median and the quartiles of some values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// The median.
    pub median: f64,
    /// The lower quartile.
    pub low: f64,
    /// The upper quartile.
    pub high: f64,
}

impl Spread {
    /// The spread of at least one value; between two values quantiles are interpolated linearly.
    ///
    /// # Panics
    /// If there are no values.
    pub fn of(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().checked_sub(1).expect("a spread is of at least one value");
        let quantile = |share: f64| {
            let position = share * last as f64;
            let below = position as usize;
            let above = (below + 1).min(last);
            sorted[below] + (sorted[above] - sorted[below]) * (position - below as f64)
        };
        Self { median: quantile(0.5), low: quantile(0.25), high: quantile(0.75) }
    }
}

/// The times of one case, ms for each frame, in the order of the rounds.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples(Vec<f64>);

impl Samples {
    /// Times in the order of the rounds, ms.
    ///
    /// # Panics
    /// If there are none.
    pub fn new(times_ms: Vec<f64>) -> Self {
        assert!(!times_ms.is_empty(), "samples are of at least one round");
        Self(times_ms)
    }

    /// The times in the order of the rounds, ms.
    pub fn times_ms(&self) -> &[f64] {
        &self.0
    }

    /// The shortest time, ms.
    pub fn least_ms(&self) -> f64 {
        self.0.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// The median and the quartiles of the times, ms.
    pub fn spread(&self) -> Spread {
        Spread::of(&self.0)
    }

    /// The median and the quartiles of the ratios to `plain` within each round. What slows a round slows both, so that
    /// it cancels.
    ///
    /// # Panics
    /// If the two have different numbers of rounds, which means that they are not of the same call.
    pub fn relative_to(&self, plain: &Self) -> Spread {
        assert_eq!(self.0.len(), plain.0.len(), "ratios are of cases of the same rounds");
        let ratios: Vec<f64> = self.0.iter().zip(&plain.0).map(|(time, plain)| time / plain).collect();
        Spread::of(&ratios)
    }
}

/// A frame to measure.
#[derive(Clone, Copy)]
pub struct FrameCase<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// A plan of the scene for the executor's capabilities.
    pub plan: &'a Plan,
}

/// The times of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Timed {
    /// Wall time.
    pub wall: Samples,
    /// Device time. `None` on the CPU; on an adapter that cannot write timestamps between passes; and where one of the
    /// timestamps of the case was not later than the one before.
    pub device: Option<Samples>,
}

/// Measures frames of an executor, in the order of the cases, as [`time`] does.
///
/// # Errors
/// The first error of a case, which ends the measurement.
pub fn time_frames(
    executor: &Executor,
    cases: &[FrameCase<'_>],
    rounds: &Rounds,
    tell: &dyn Fn(f64),
) -> Result<Vec<Timed>, HarnessError> {
    let mut cases: Vec<Case<'_>> =
        cases.iter().map(|&FrameCase { scene, plan }| Case::Frame { executor, scene, plan }).collect();
    time(&mut cases, rounds, tell)
}

/// Measures work on the CPU, in the order given, as [`time`] does.
pub fn time_work(work: &mut [&mut dyn FnMut()], rounds: &Rounds) -> Vec<Samples> {
    let mut cases: Vec<Case<'_>> = work.iter_mut().map(|work| Case::Work(&mut **work)).collect();
    let timed = time(&mut cases, rounds, &|_| {}).expect("only frames have errors");
    timed.into_iter().map(|timed| timed.wall).collect()
}

/// Measures cases of any kind and on several executors, in their order. `tell` is called with the fraction done, 0..=1.
///
/// On each adapter one renderer draws all of its cases; scenes are uploaded before the first round, one upload a case, and
/// cases of the same size and samples share render targets, unless they find lines in the image in targets of different
/// formats. On the CPU, hierarchies are built before, and each frame casts all of its rays.
///
/// # Errors
/// The first error of a case, which ends the measurement.
pub fn time(cases: &mut [Case<'_>], rounds: &Rounds, tell: &dyn Fn(f64)) -> Result<Vec<Timed>, HarnessError> {
    #[cfg(feature = "gpu")]
    let mut on_adapters = on_adapter::Prepared::new(cases, rounds)?;
    for case in &*cases {
        if let Case::Frame { executor: Executor::Cpu { .. }, scene, .. } = case {
            scene.build_rays();
        }
    }
    let options = CpuOptions::default();
    let calls = rounds.frames_a_wait.unwrap_or(1).max(1);
    interleaved(cases.len(), rounds, tell, |number| {
        let wall_ms = match &mut cases[number] {
            Case::Work(work) => mean_ms(calls, work),
            Case::Frame { executor: Executor::Cpu { .. }, scene, plan } => mean_ms(calls, || {
                black_box(cpu::render(scene, plan, &options, &|_| {}));
            }),
            #[cfg(feature = "gpu")]
            Case::Frame { executor: Executor::Gpu(_), scene, plan } => return on_adapters.measure(number, scene, plan),
        };
        Ok(Measurement { wall_ms, device_ms: None })
    })
}

/// The mean time of some calls, ms.
fn mean_ms(calls: u32, mut work: impl FnMut()) -> f64 {
    let start = Instant::now();
    (0..calls).for_each(|_| work());
    start.elapsed().as_secs_f64() * 1e3 / f64::from(calls)
}

/// Measures each of some cases in every round.
fn interleaved<E>(
    cases: usize,
    rounds: &Rounds,
    tell: &dyn Fn(f64),
    mut measure: impl FnMut(usize) -> Result<Measurement, E>,
) -> Result<Vec<Timed>, E> {
    let count = rounds.rounds.max(1);
    let least = count.min(LEAST_ROUNDS);
    let mut measured = vec![Vec::with_capacity(count); cases];
    let mut start = Instant::now();
    for round in 0..=count {
        if round > least && start.elapsed().as_secs_f64() * 1e3 >= rounds.most_ms {
            break;
        }
        for (case, measured) in measured.iter_mut().enumerate() {
            let measurement = measure(case)?;
            if round > 0 {
                measured.push(measurement);
            }
            tell((round * cases + case + 1) as f64 / ((count + 1) * cases) as f64);
        }
        if round == 0 {
            start = Instant::now();
        }
    }
    tell(1.0);
    let timed = |measured: Vec<Measurement>| Timed {
        wall: Samples::new(measured.iter().map(|measurement| measurement.wall_ms).collect()),
        device: measured.iter().map(|measurement| measurement.device_ms).collect::<Option<_>>().map(Samples::new),
    };
    Ok(measured.into_iter().map(timed).collect())
}
