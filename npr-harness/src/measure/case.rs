//! What is measured, and how often.

use crate::executor::Executor;
use crate::plan::Plan;
use crate::scene::Scene;

/// The number of rounds that a bound on time leaves.
pub const LEAST_ROUNDS: usize = 5;

/// Something to measure beside others.
pub enum Case<'a> {
    /// A frame.
    Frame {
        /// What draws it.
        executor: &'a Executor,
        /// The scene.
        scene: &'a Scene,
        /// A plan of the scene for the executor's capabilities.
        plan: &'a Plan,
    },
    /// Work on the CPU. What takes less than some µs must repeat itself.
    Work(&'a mut dyn FnMut()),
}

/// How often cases are measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounds {
    /// The number of rounds that are counted, at least 1.
    pub rounds: usize,
    /// The frames between two waits for an adapter, at least 1; one measurement is their mean. `None` for 1 on a
    /// software adapter, where a wait is short beside a frame, and [`HARDWARE_FRAMES`] on hardware. For work on the CPU
    /// it is the number of calls in a measurement, and `None` means 1.
    pub frames_a_wait: Option<u32>,
    /// No further round begins after this time, ms, for all cases together and without the first round; but
    /// [`LEAST_ROUNDS`] are measured, or [`Self::rounds`] if that is fewer. Infinity for no bound.
    pub most_ms: f64,
}

/// The frames between two waits for a hardware adapter, by default.
pub const HARDWARE_FRAMES: u32 = 8;

impl Default for Rounds {
    fn default() -> Self {
        Self { rounds: 15, frames_a_wait: None, most_ms: f64::INFINITY }
    }
}

/// One measurement, ms.
#[derive(Clone, Copy)]
pub(super) struct Measurement {
    pub(super) wall_ms: f64,
    pub(super) device_ms: Option<f64>,
}
