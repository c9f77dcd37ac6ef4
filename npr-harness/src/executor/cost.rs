//! How long the CPU and a software adapter are expected to take, to choose between them.
//!
//! Both run on the same cores, so the number of these hardly matters. A device has to be opened and its pipelines compiled,
//! whatever is drawn; ray casting has to build a hierarchy over all faces, whatever is seen of them.
//!
//! The numbers are milliseconds measured on two cores with Mesa 22.3's lavapipe, whole processes less the loading of
//! models; where both are near each other, either will do.

use crate::scene::Scene;
use crate::shadow::ShadowMethod;
use crate::style::{Shade, Style};

/// What there is to do for pictures of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Work {
    /// How many faces the scene has.
    pub faces: f64,
    /// Samples of all pictures that are only lit.
    pub plain_samples: f64,
    /// Samples of all pictures in which strokes are looked up.
    pub hatched_samples: f64,
    /// Samples of all pictures in which shadows are cast by volumes.
    pub shadowed_samples: f64,
    /// Pictures.
    pub pictures: f64,
}

impl Work {
    /// Of one picture.
    ///
    /// `samples`: along each axis of a pixel.
    pub fn new(scene: &Scene, style: &Style, (width, height): (u32, u32), samples: u32) -> Self {
        let count = f64::from(width) * f64::from(height) * f64::from(samples).powi(2);
        let volumes = style.shadow.is_some_and(|shadow| shadow.method == ShadowMethod::Volumes);
        let mut work = Self { faces: scene.model.faces.len() as f64, pictures: 1.0, ..Self::default() };
        if matches!(style.shade, Shade::Hatch(_)) {
            work.hatched_samples = count;
        } else {
            work.plain_samples = count;
        }
        if volumes {
            work.shadowed_samples = count;
        }
        work
    }

    /// With one more picture of the same scene.
    pub fn and(self, other: Self) -> Self {
        Self {
            faces: self.faces.max(other.faces),
            plain_samples: self.plain_samples + other.plain_samples,
            hatched_samples: self.hatched_samples + other.hatched_samples,
            shadowed_samples: self.shadowed_samples + other.shadowed_samples,
            pictures: self.pictures + other.pictures,
        }
    }

    /// Whether the CPU is expected to take no longer than a software adapter.
    pub fn is_sooner_on_cpu(&self) -> bool {
        self.cpu_ms() <= self.software_adapter_ms()
    }

    /// On the CPU, ms.
    pub fn cpu_ms(&self) -> f64 {
        7e-4 * self.faces + 1.1e-4 * self.plain_samples + 2.5e-4 * self.hatched_samples + 1e-4 * self.shadowed_samples
    }

    /// On a software adapter, from its start on, ms.
    pub fn software_adapter_ms(&self) -> f64 {
        120.0
            + 15.0 * self.pictures
            + 2e-4 * self.faces * self.pictures
            + 3e-5 * self.plain_samples
            + 1.5e-4 * self.hatched_samples
            + 1e-4 * self.shadowed_samples
    }
}
