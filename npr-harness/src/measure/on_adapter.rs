//! Times of frames on adapters.

use super::case::Measurement;
use super::clock::DeviceClock;
use super::{Case, HARDWARE_FRAMES, Rounds};
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::gpu::targets::{InkKind, ink_kind};
use crate::gpu::{GpuContext, GpuRenderer, GpuScene, Targets};
use crate::plan::Plan;
use crate::scene::Scene;
use std::time::Instant;

/// What cases that share render targets have in common: size, samples, and targets for lines in the image.
type TargetKey = ((u32, u32), u32, Option<InkKind>);

/// What the frames on adapters are drawn with.
pub(super) struct Prepared<'a> {
    adapters: Vec<Adapter<'a>>,
    /// Per case: the index of its adapter, its upload, and the index of its targets there.
    cases: Vec<Option<(usize, GpuScene, usize)>>,
}

struct Adapter<'a> {
    context: &'a GpuContext,
    renderer: GpuRenderer<'a>,
    clock: Option<DeviceClock>,
    frames: u32,
    targets: Vec<(TargetKey, Targets)>,
}

impl<'a> Prepared<'a> {
    pub(super) fn new(cases: &[Case<'a>], rounds: &Rounds) -> Result<Self, HarnessError> {
        let mut prepared = Self { adapters: Vec::new(), cases: Vec::new() };
        for case in cases {
            prepared.cases.push(match case {
                &Case::Frame { executor: Executor::Gpu(context), scene, plan } => {
                    let known = prepared.adapters.iter().position(|adapter| std::ptr::eq(adapter.context, &**context));
                    let number = known.unwrap_or_else(|| {
                        prepared.adapters.push(Adapter::new(context, rounds));
                        prepared.adapters.len() - 1
                    });
                    let adapter = &mut prepared.adapters[number];
                    let targets = adapter.targets_for(plan)?;
                    Some((number, adapter.renderer.upload(scene, plan)?, targets))
                }
                _ => None,
            });
        }
        Ok(prepared)
    }

    /// Measures a case on an adapter.
    pub(super) fn measure(&mut self, case: usize, scene: &Scene, plan: &Plan) -> Result<Measurement, HarnessError> {
        let (adapter, uploaded, targets) = self.cases[case].as_ref().expect("the case is of an adapter");
        let Adapter { context, renderer, clock, frames, targets: all } = &self.adapters[*adapter];
        let targets = &all[*targets].1;
        // Encoded before, since they are not part of the frame.
        let marks = clock.as_ref().map(|clock| clock.marks(context));
        let mut marks = marks.into_iter().flatten();
        let start = Instant::now();
        for _ in 0..*frames {
            let frame = renderer.encode(scene, uploaded, plan, targets)?;
            match marks.next() {
                Some([before, after]) => context.queue.submit([before, frame, after]),
                None => context.queue.submit([frame]),
            };
        }
        context.wait()?;
        let wall_ms = start.elapsed().as_secs_f64() * 1e3 / f64::from(*frames);
        let device_ms = match clock {
            Some(clock) => clock.read(context)?,
            None => None,
        };
        Ok(Measurement { wall_ms, device_ms })
    }
}

impl<'a> Adapter<'a> {
    fn new(context: &'a GpuContext, rounds: &Rounds) -> Self {
        let by_default = if context.is_software() { 1 } else { HARDWARE_FRAMES };
        let frames = rounds.frames_a_wait.unwrap_or(by_default).max(1);
        let clock = DeviceClock::new(context, frames);
        Self { context, renderer: GpuRenderer::new(context), clock, frames, targets: Vec::new() }
    }

    /// The index of the render targets for a plan.
    fn targets_for(&mut self, plan: &Plan) -> Result<usize, HarnessError> {
        // Targets for other lines in the image would be created anew at every change of the case.
        let key = (plan.view.size, plan.view.samples, plan.image.as_ref().map(ink_kind));
        let found = self.targets.iter().position(|(other, _)| *other == key);
        Ok(match found {
            Some(number) => number,
            None => {
                self.targets.push((key, self.renderer.targets(&plan.view)?));
                self.targets.len() - 1
            }
        })
    }
}
