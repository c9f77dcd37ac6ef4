//! Which executor renders: a device, or ray casting on the CPU.

mod candidates;
mod cost;

pub use candidates::Candidates;
pub use cost::Work;

use crate::camera::Camera;
use crate::compare::Image;
use crate::cpu::{self, CpuOptions};
use crate::error::HarnessError;
use crate::plan::{Plan, Reason};
use crate::scene::Scene;
use crate::style::Style;
use std::fmt;

#[cfg(feature = "gpu")]
use crate::gpu::{self, GpuContext, GpuError, REFUSED};
#[cfg(feature = "gpu")]
use crate::plan::LineMethod;

/// Which executor is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// A hardware adapter, else a software adapter or the CPU, whichever is expected to be sooner.
    #[default]
    Auto,
    /// An adapter, hardware or software; an error where there is none, or where it cannot make the picture.
    Gpu,
    /// Ray casting on the CPU.
    Cpu,
}

/// Whether adapters are looked for: the environment variable `NPR_GPU`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GpuPolicy {
    /// If there is one.
    #[default]
    Auto,
    /// None is an error.
    Required,
    /// As if there were none.
    Off,
}

impl GpuPolicy {
    /// Reads `NPR_GPU`: `required`, `auto` (also when it is not set) or `off`.
    ///
    /// # Errors
    /// [`HarnessError::Policy`] for anything else.
    pub fn from_env() -> Result<Self, HarnessError> {
        let value = std::env::var_os("NPR_GPU").unwrap_or_default();
        match value.to_string_lossy().as_ref() {
            "" | "auto" => Ok(Self::Auto),
            "required" => Ok(Self::Required),
            "off" => Ok(Self::Off),
            other => Err(HarnessError::Policy(other.to_owned())),
        }
    }
}

/// Why the CPU renders where it was not asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CpuReason {
    /// The only adapter is a software one, and slower.
    Sooner {
        /// Which adapter.
        adapter: String,
    },
    /// There is no adapter, or none is wanted, or it cannot make the picture.
    Unable(String),
}

impl fmt::Display for CpuReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sooner { adapter } => write!(f, "expected to be sooner than {adapter}"),
            Self::Unable(why) => f.write_str(why),
        }
    }
}

/// What renders pictures.
pub enum Executor {
    /// A device.
    #[cfg(feature = "gpu")]
    Gpu(Box<GpuContext>),
    /// Ray casting on the CPU.
    Cpu {
        /// Why not a device, where one was looked for.
        why: Option<CpuReason>,
    },
}

/// What a picture is made of.
#[derive(Clone, Copy)]
pub struct Picture<'a> {
    /// What is shown.
    pub scene: &'a Scene,
    /// How.
    pub style: &'a Style,
    /// Made of these two and the camera.
    pub plan: &'a Plan,
    /// From where.
    pub camera: &'a Camera,
    /// Width and height, px.
    pub size: (u32, u32),
    /// Along each axis of a pixel.
    pub samples: u32,
}

impl Executor {
    /// Selects an executor, a device wherever there is one: for measurements and comparisons.
    ///
    /// # Errors
    /// If an adapter is required, by `backend` or by the environment, and there is none.
    pub fn choose(backend: Backend) -> Result<Self, HarnessError> {
        Ok(Candidates::find(backend)?.choose())
    }

    /// Selects the executor for some pictures: where `backend` leaves it open, a software adapter only if it is expected to
    /// be sooner than the CPU.
    ///
    /// # Errors
    /// As [`Executor::choose`].
    pub fn choose_for(backend: Backend, work: &Work) -> Result<Self, HarnessError> {
        Ok(Candidates::find(backend)?.choose_for(work))
    }

    /// The CPU, for a picture that a device could not make, and why: not where a device was asked for, by `backend` or by
    /// the environment.
    ///
    /// # Errors
    /// The error itself, else; [`HarnessError::Policy`].
    pub fn instead(backend: Backend, error: HarnessError) -> Result<Self, HarnessError> {
        if backend != Backend::Auto || GpuPolicy::from_env()? != GpuPolicy::Auto {
            return Err(error);
        }
        match &error {
            // A device takes more than the CPU does.
            HarnessError::PictureMemory { .. } => Ok(Self::Cpu { why: Some(CpuReason::Unable(error.to_string())) }),
            #[cfg(feature = "gpu")]
            HarnessError::Gpu(fault) if fault.is_of_the_device() => {
                Ok(Self::Cpu { why: Some(CpuReason::Unable(fault.to_string())) })
            }
            _ => Err(error),
        }
    }

    /// Whether the CPU renders.
    pub fn is_cpu(&self) -> bool {
        matches!(self, Self::Cpu { .. })
    }

    /// One line: what renders, and why not something else.
    pub fn describe(&self) -> String {
        match self {
            #[cfg(feature = "gpu")]
            Self::Gpu(context) => context.describe(),
            Self::Cpu { why: None } => "CPU, ray casting".into(),
            Self::Cpu { why: Some(why) } => format!("CPU, ray casting ({why})"),
        }
    }

    /// By which methods a picture's passes are made, and why; none on the CPU, which has one for each.
    ///
    /// # Errors
    /// What the device cannot do, by name.
    pub fn methods(&self, picture: &Picture<'_>) -> Result<Vec<Reason>, HarnessError> {
        match self {
            #[cfg(feature = "gpu")]
            Self::Gpu(context) => {
                let parallel = matches!(picture.camera.projection, crate::camera::Projection::Orthographic { .. });
                let Picture { scene, plan, size, samples, .. } = *picture;
                Ok(context.for_one_picture().methods(scene, plan, parallel, size, samples)?)
            }
            Self::Cpu { .. } => {
                // In a build without devices nothing depends on it.
                let _ = picture;
                Ok(Vec::new())
            }
        }
    }

    /// Renders a picture.
    ///
    /// `samples`: along each axis of a pixel.
    ///
    /// # Errors
    /// [`HarnessError`].
    #[expect(clippy::too_many_arguments, reason = "each is a thing of its own; a struct would only rename them")]
    pub fn render(
        &self,
        scene: &Scene,
        style: &Style,
        plan: &Plan,
        camera: &Camera,
        size: (u32, u32),
        samples: u32,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Image, HarnessError> {
        self.render_picture(&Picture { scene, style, plan, camera, size, samples }, progress)
    }

    /// Renders a picture, without compute shaders where the driver refuses those that it promised.
    ///
    /// # Errors
    /// [`HarnessError`].
    pub fn render_picture(
        &self,
        picture: &Picture<'_>,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Image, HarnessError> {
        let Picture { scene, style, plan, camera, size, samples } = *picture;
        match self {
            #[cfg(feature = "gpu")]
            Self::Gpu(context) => {
                // What is known beforehand is said before anything is allocated.
                self.methods(picture)?;
                let render = |capabilities| {
                    gpu::render(context, capabilities, scene, style, plan, camera, size, samples, LineMethod::Auto)
                };
                let capabilities = context.for_one_picture();
                let compute = capabilities.compute;
                match render(capabilities) {
                    // What drivers promise and refuse all the same is mostly compute shaders.
                    Err(GpuError::Device { .. } | GpuError::Outline(_)) if compute => {
                        // What else it reported is of the same attempt.
                        let _ = context.wait();
                        let image = render(context.capabilities.clone().without_compute(REFUSED))?;
                        context.note_refusal();
                        Ok(image)
                    }
                    done => Ok(done?),
                }
            }
            Self::Cpu { .. } => {
                let options = CpuOptions { samples, ..Default::default() };
                Ok(cpu::render(scene, style, plan, camera, size, &options, progress).image())
            }
        }
    }

    /// Renders a picture, on the CPU where the device cannot and `backend` and the environment leave that open; then also
    /// says why. After a device was lost, or had no memory left, the CPU renders further pictures too.
    ///
    /// # Errors
    /// [`HarnessError`].
    pub fn render_or_instead(
        &mut self,
        backend: Backend,
        picture: &Picture<'_>,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<(Image, Option<CpuReason>), HarnessError> {
        let error = match self.render_picture(picture, progress) {
            Ok(image) => return Ok((image, None)),
            Err(error) => error,
        };
        #[cfg(feature = "gpu")]
        let is_final = matches!(&error, HarnessError::Gpu(fault) if fault.is_final());
        #[cfg(not(feature = "gpu"))]
        let is_final = false;
        let cpu = Self::instead(backend, error)?;
        let image = cpu.render_picture(picture, progress)?;
        let why = match &cpu {
            Self::Cpu { why } => why.clone(),
            #[cfg(feature = "gpu")]
            Self::Gpu(_) => None,
        };
        if is_final {
            *self = cpu;
        }
        Ok((image, why))
    }
}
