//! Times of frames on an adapter.

use super::clock::DeviceClock;
use super::{FrameCase, HARDWARE_FRAMES, Measurement, Rounds, Timed, interleaved};
use crate::error::HarnessError;
use crate::gpu::targets::{InkKind, ink_kind};
use crate::gpu::{GpuContext, GpuRenderer, GpuScene, Targets};
use std::time::Instant;

/// What cases that share render targets have in common: size, samples, and targets for lines in the image.
type TargetKey = ((u32, u32), u32, Option<InkKind>);

pub(super) fn time_frames(
    context: &GpuContext,
    cases: &[FrameCase<'_>],
    rounds: &Rounds,
    tell: &dyn Fn(f64),
) -> Result<Vec<Timed>, HarnessError> {
    let by_default = if context.is_software() { 1 } else { HARDWARE_FRAMES };
    let frames = rounds.frames_a_wait.unwrap_or(by_default).max(1);
    let renderer = GpuRenderer::new(context);
    // Targets for other lines in the image would be created anew at every change of the case.
    let mut targets: Vec<(TargetKey, Targets)> = Vec::new();
    let mut prepared: Vec<(GpuScene, usize)> = Vec::new();
    for FrameCase { scene, plan } in cases {
        let key = (plan.view.size, plan.view.samples, plan.image.as_ref().map(ink_kind));
        let found = targets.iter().position(|(other, _)| *other == key);
        let number = match found {
            Some(number) => number,
            None => {
                targets.push((key, renderer.targets(&plan.view)?));
                targets.len() - 1
            }
        };
        prepared.push((renderer.upload(scene, plan)?, number));
    }
    let clock = DeviceClock::new(context, frames);
    interleaved(cases.len(), rounds, tell, |case| {
        let (FrameCase { scene, plan }, (uploaded, number)) = (cases[case], &prepared[case]);
        let targets = &targets[*number].1;
        // Encoded before, since they are not part of the frame.
        let marks = clock.as_ref().map(|clock| clock.marks(context));
        let mut marks = marks.into_iter().flatten();
        let start = Instant::now();
        for _ in 0..frames {
            let frame = renderer.encode(scene, uploaded, plan, targets)?;
            match marks.next() {
                Some([before, after]) => context.queue.submit([before, frame, after]),
                None => context.queue.submit([frame]),
            };
        }
        context.wait()?;
        let wall_ms = start.elapsed().as_secs_f64() * 1e3 / f64::from(frames);
        let device_ms = match &clock {
            Some(clock) => clock.read(context)?,
            None => None,
        };
        Ok(Measurement { wall_ms, device_ms })
    })
}
