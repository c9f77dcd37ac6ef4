//! Where pictures are made: on a device if there is one, else on the CPU.

use crate::camera::Camera;
use crate::compare::Image;
use crate::cpu::{self, CpuOptions};
use crate::error::HarnessError;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::style::Style;

#[cfg(feature = "gpu")]
use crate::gpu::{self, GpuContext};
#[cfg(feature = "gpu")]
use crate::plan::LineMethod;

/// What is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// A hardware adapter, else a software one, else the CPU.
    #[default]
    Auto,
    /// An adapter, or an error.
    Gpu,
    /// Rays.
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
        match std::env::var("NPR_GPU").as_deref() {
            Err(_) | Ok("" | "auto") => Ok(Self::Auto),
            Ok("required") => Ok(Self::Required),
            Ok("off") => Ok(Self::Off),
            Ok(other) => Err(HarnessError::Policy(other.to_owned())),
        }
    }
}

/// An executor, chosen.
pub enum Executor {
    /// On a device.
    #[cfg(feature = "gpu")]
    Gpu(Box<GpuContext>),
    /// With rays.
    Cpu {
        /// Why not on a device, if one was looked for.
        why: Option<String>,
    },
}

impl Executor {
    /// Chooses.
    ///
    /// # Errors
    /// If an adapter is required, by `backend` or by the environment, and there is none.
    pub fn choose(backend: Backend) -> Result<Self, HarnessError> {
        let policy = GpuPolicy::from_env()?;
        if backend == Backend::Cpu {
            return Ok(Self::Cpu { why: None });
        }
        if policy == GpuPolicy::Off {
            return match backend {
                Backend::Gpu => Err(HarnessError::GpuRequired("adapters are off: NPR_GPU=off".into())),
                _ => Ok(Self::Cpu { why: Some("NPR_GPU=off".into()) }),
            };
        }
        Self::on_device(backend, policy)
    }

    #[cfg(feature = "gpu")]
    fn on_device(backend: Backend, policy: GpuPolicy) -> Result<Self, HarnessError> {
        match GpuContext::new() {
            Ok(context) => Ok(Self::Gpu(Box::new(context))),
            Err(error) if policy == GpuPolicy::Required => Err(HarnessError::GpuRequired(error.to_string())),
            Err(error) if backend == Backend::Gpu => Err(error.into()),
            Err(error) => Ok(Self::Cpu { why: Some(error.to_string()) }),
        }
    }

    #[cfg(not(feature = "gpu"))]
    fn on_device(backend: Backend, policy: GpuPolicy) -> Result<Self, HarnessError> {
        if backend == Backend::Gpu || policy == GpuPolicy::Required {
            return Err(HarnessError::NoGpuInBuild);
        }
        Ok(Self::Cpu { why: Some("this build has no GPU executor".into()) })
    }

    /// The CPU, where it may make a picture that a device could not make, and why it does: not where a device was asked
    /// for, by `backend` or by the environment.
    ///
    /// # Errors
    /// The error itself, else; [`HarnessError::Policy`].
    pub fn instead(backend: Backend, error: HarnessError) -> Result<Self, HarnessError> {
        if backend != Backend::Auto || GpuPolicy::from_env()? != GpuPolicy::Auto {
            return Err(error);
        }
        match &error {
            #[cfg(feature = "gpu")]
            HarnessError::Gpu(fault) if fault.is_of_the_device() => Ok(Self::Cpu { why: Some(fault.to_string()) }),
            _ => Err(error),
        }
    }

    /// Whether pictures are made with rays.
    pub fn is_cpu(&self) -> bool {
        matches!(self, Self::Cpu { .. })
    }

    /// One line: where pictures are made, and why not elsewhere.
    pub fn describe(&self) -> String {
        match self {
            #[cfg(feature = "gpu")]
            Self::Gpu(context) => context.describe(),
            Self::Cpu { why: None } => "CPU, ray casting".into(),
            Self::Cpu { why: Some(why) } => format!("CPU, ray casting ({why})"),
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
        match self {
            #[cfg(feature = "gpu")]
            Self::Gpu(context) => {
                Ok(gpu::render(context, scene, style, plan, camera, size, samples, LineMethod::Auto)?)
            }
            Self::Cpu { .. } => {
                let options = CpuOptions { samples, ..Default::default() };
                Ok(cpu::render(scene, style, plan, camera, size, &options, progress).image())
            }
        }
    }
}
