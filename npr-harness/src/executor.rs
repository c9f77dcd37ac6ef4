//! Which executor renders: a device, or ray casting on the CPU.

mod candidates;
mod cost;

pub use candidates::Candidates;
pub use cost::Work;

use crate::capabilities::Capabilities;
use crate::cpu::{self, CpuOptions};
use crate::error::HarnessError;
use crate::picture::Image;
use crate::picture_limits::MEMORY_BYTES;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::style::Style;
use crate::view::View;
use std::fmt;

#[cfg(feature = "gpu")]
use crate::gpu::{self, GpuContext};

/// Why compute shaders are not used that were promised.
#[cfg(feature = "gpu")]
const REFUSED: &str = "the driver refused the compute shaders that it had promised";

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
    /// The scene.
    pub scene: &'a Scene,
    /// The style.
    pub style: &'a Style,
    /// The camera, the size and the samples.
    pub view: View,
    /// How much memory it may take besides the scene, bytes.
    pub memory_bytes: u64,
}

impl<'a> Picture<'a> {
    /// A picture that may take [`MEMORY_BYTES`].
    pub fn new(scene: &'a Scene, style: &'a Style, view: View) -> Self {
        Self { scene, style, view, memory_bytes: MEMORY_BYTES }
    }

    /// The plan of the picture for an executor that can do so much.
    ///
    /// # Errors
    /// Those of [`Plan::new`].
    pub fn plan(&self, capabilities: Capabilities) -> Result<Plan, HarnessError> {
        let capabilities = Capabilities { memory_bytes: self.memory_bytes, ..capabilities };
        Plan::new(self.scene, self.style, &self.view, &capabilities)
    }
}

/// A picture, and how it was made.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// The picture.
    pub image: Image,
    /// The plan that was executed.
    pub plan: Plan,
    /// The reason for which the CPU made it, if a device could not.
    pub why_cpu: Option<CpuReason>,
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
    pub fn fallback(backend: Backend, error: HarnessError) -> Result<Self, HarnessError> {
        if backend != Backend::Auto || GpuPolicy::from_env()? != GpuPolicy::Auto {
            return Err(error);
        }
        match &error {
            // A device takes more than the CPU does.
            HarnessError::PictureMemory { .. } => Ok(Self::Cpu { why: Some(CpuReason::Unable(error.to_string())) }),
            fault if fault.is_of_the_device() => Ok(Self::Cpu { why: Some(CpuReason::Unable(fault.to_string())) }),
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

    /// The capabilities that plans for this executor are made with.
    pub fn capabilities(&self) -> Capabilities {
        match self {
            #[cfg(feature = "gpu")]
            Self::Gpu(context) => context.usable(),
            Self::Cpu { .. } => Capabilities::RAY_CASTER,
        }
    }

    /// Executes a plan that was made for its capabilities; without compute shaders where the driver refuses those that it
    /// promised.
    ///
    /// # Errors
    /// [`HarnessError`].
    pub fn execute(&self, scene: &Scene, plan: &Plan, progress: &(dyn Fn(f64) + Sync)) -> Result<Image, HarnessError> {
        match self {
            #[cfg(feature = "gpu")]
            Self::Gpu(context) => match gpu::render(context, scene, plan) {
                Err(HarnessError::Device { .. } | HarnessError::Outline(_)) if plan.computes() => {
                    // What else it reported is of the same attempt.
                    let _ = context.wait();
                    let image = gpu::render(context, scene, &plan.without_compute(REFUSED))?;
                    context.note_refusal();
                    Ok(image)
                }
                done => done,
            },
            Self::Cpu { .. } => Ok(cpu::render(scene, plan, &CpuOptions::default(), progress).image()),
        }
    }

    /// Plans and renders a picture.
    ///
    /// # Errors
    /// [`HarnessError`].
    pub fn render(&self, picture: &Picture<'_>, progress: &(dyn Fn(f64) + Sync)) -> Result<Image, HarnessError> {
        self.execute(picture.scene, &picture.plan(self.capabilities())?, progress)
    }

    /// Plans and renders a picture, on the CPU where the device cannot and `backend` and the environment leave that open.
    /// After a device was lost, or had no memory left, the CPU renders further pictures too.
    ///
    /// # Errors
    /// [`HarnessError`].
    pub fn render_with_fallback(
        &mut self,
        backend: Backend,
        picture: &Picture<'_>,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Rendered, HarnessError> {
        let plan = picture.plan(self.capabilities());
        let rendered = plan.and_then(|plan| {
            let image = self.execute(picture.scene, &plan, progress)?;
            Ok(Rendered { image, plan, why_cpu: None })
        });
        let error = match rendered {
            Ok(rendered) => {
                #[cfg(feature = "gpu")]
                if rendered.plan.computes() && !self.capabilities().compute {
                    // The driver refused just now.
                    return Ok(Rendered { plan: rendered.plan.without_compute(REFUSED), ..rendered });
                }
                return Ok(rendered);
            }
            Err(error) if self.is_cpu() => return Err(error),
            Err(error) => error,
        };
        let is_final = error.is_final();
        let cpu = Self::fallback(backend, error)?;
        let plan = picture.plan(cpu.capabilities())?;
        let image = cpu.execute(picture.scene, &plan, progress)?;
        let why_cpu = match &cpu {
            Self::Cpu { why } => why.clone(),
            #[cfg(feature = "gpu")]
            Self::Gpu(_) => None,
        };
        if is_final {
            *self = cpu;
        }
        Ok(Rendered { image, plan, why_cpu })
    }
}
