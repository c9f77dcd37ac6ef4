//! Sweeps of shadows.

mod counts;
mod eye;
#[cfg(feature = "gpu")]
mod maps;
mod open;

use super::{Finding, Sweep};
use crate::error::HarnessError;
use crate::executor::Executor;

pub(super) const SWEEPS: &[Sweep] = &[eye::INSIDE, eye::LIGHT_DISTANCE, open::SWEEP, RESOLUTION, GAPS, BIAS, GRAZING];

const RESOLUTION: Sweep = Sweep {
    name: "shadow-map-resolution",
    technique: "shadows",
    what: "The borders of shadows from a map are as coarse as its texels; those of volumes are exact.",
    needs_adapter: true,
    run: |executor| on_device(executor, Measurement::Resolution),
};

const GAPS: Sweep = Sweep {
    name: "shadow-map-gaps",
    technique: "shadows",
    what: "Light that falls through a gap narrower than a texel of the shadow map is seen only where a texel's centre \
           happens to lie in the gap.",
    needs_adapter: true,
    run: |executor| on_device(executor, Measurement::Gaps),
};

const BIAS: Sweep = Sweep {
    name: "shadow-map-bias",
    technique: "shadows",
    what: "The bias that keeps surfaces from shadowing themselves detaches a shadow from the foot of what casts it.",
    needs_adapter: true,
    run: |executor| on_device(executor, Measurement::Bias),
};

const GRAZING: Sweep = Sweep {
    name: "shadow-grazing-light",
    technique: "shadows",
    what: "The lower the light, the longer the texels of a shadow map on the ground, and the coarser the end of a shadow.",
    needs_adapter: true,
    run: |executor| on_device(executor, Measurement::Grazing),
};

/// What is measured on a device.
#[derive(Clone, Copy)]
#[cfg_attr(not(feature = "gpu"), allow(dead_code, reason = "for devices"))]
enum Measurement {
    Resolution,
    Gaps,
    Bias,
    Grazing,
}

/// # Errors
/// [`HarnessError::RayPlan`] on the CPU, which casts rays.
fn on_device(executor: &Executor, of: Measurement) -> Result<Finding, HarnessError> {
    match executor {
        #[cfg(feature = "gpu")]
        Executor::Gpu(context) => {
            let device = maps::Device::new(context);
            match of {
                Measurement::Resolution => maps::resolution(&device),
                Measurement::Gaps => maps::gaps(&device),
                Measurement::Bias => maps::bias(&device),
                Measurement::Grazing => maps::grazing(&device),
            }
        }
        Executor::Cpu { .. } => {
            let _ = of;
            Err(HarnessError::RayPlan)
        }
    }
}
