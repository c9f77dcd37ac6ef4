//! Selection of the executor that renders: the GPU, or ray casting on the CPU.

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

/// The reason given where compute shaders are not used although the driver reports support.
#[cfg(feature = "gpu")]
const REFUSED: &str = "the driver refused the compute shaders that it had promised";

/// The executor that is requested.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// A hardware adapter; else a software adapter or the CPU, whichever is expected to be faster.
    #[default]
    Auto,
    /// An adapter, hardware or software; an error if there is none, or if it cannot render the picture.
    Gpu,
    /// Ray casting on the CPU.
    Cpu,
}

/// Whether an adapter is used: the environment variable `NPR_GPU`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GpuPolicy {
    /// An adapter is used if there is one.
    #[default]
    Auto,
    /// It is an error if there is no adapter.
    Required,
    /// Adapters are ignored.
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

/// The reason why the CPU renders although it was not requested.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CpuReason {
    /// The only adapter is a software one, and slower.
    Sooner {
        /// The adapter.
        adapter: String,
    },
    /// There is no adapter, adapters are disabled, or the adapter cannot render the picture.
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

/// An executor, which renders pictures.
pub enum Executor {
    /// A GPU device.
    #[cfg(feature = "gpu")]
    Gpu(Box<GpuContext>),
    /// Ray casting on the CPU.
    Cpu {
        /// The reason for not using the GPU, if it was considered.
        why: Option<CpuReason>,
    },
}

/// The inputs of a picture.
#[derive(Clone, Copy)]
pub struct Picture<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The style.
    pub style: &'a Style,
    /// The camera, the size and the samples per pixel.
    pub view: View,
    /// The memory that rendering may use in addition to the scene, bytes.
    pub memory_bytes: u64,
}

impl<'a> Picture<'a> {
    /// A picture with the memory limit [`MEMORY_BYTES`].
    pub fn new(scene: &'a Scene, style: &'a Style, view: View) -> Self {
        Self { scene, style, view, memory_bytes: MEMORY_BYTES }
    }

    /// Plans the picture for an executor with these capabilities.
    ///
    /// # Errors
    /// Those of [`Plan::new`].
    pub fn plan(&self, capabilities: Capabilities) -> Result<Plan, HarnessError> {
        let capabilities = Capabilities { memory_bytes: self.memory_bytes, ..capabilities };
        Plan::new(self.scene, self.style, &self.view, &capabilities)
    }
}

/// A rendered picture and how it was rendered.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// The picture.
    pub image: Image,
    /// The plan that was executed.
    pub plan: Plan,
    /// The reason why the CPU rendered it, if the GPU could not.
    pub why_cpu: Option<CpuReason>,
}

impl Executor {
    /// Selects an executor for measurements and comparisons: the GPU whenever there is an adapter.
    ///
    /// # Errors
    /// If an adapter is required, by `backend` or by the environment, and there is none.
    pub fn choose(backend: Backend) -> Result<Self, HarnessError> {
        Ok(Candidates::find(backend)?.choose())
    }

    /// Selects the executor for some pictures. If `backend` does not decide, a software adapter is used only if it is
    /// expected to be faster than the CPU.
    ///
    /// # Errors
    /// As [`Executor::choose`].
    pub fn choose_for(backend: Backend, work: &Work) -> Result<Self, HarnessError> {
        Ok(Candidates::find(backend)?.choose_for(work))
    }

    /// Opens an adapter, with the limits set in the environment ([`DeviceLimits::from_env`](gpu::DeviceLimits::from_env)).
    /// `NPR_GPU` is ignored.
    ///
    /// # Errors
    /// [`HarnessError::NoDevice`], [`HarnessError::GpuLimits`].
    #[cfg(feature = "gpu")]
    pub fn on_adapter(adapter: &gpu::GpuAdapter) -> Result<Self, HarnessError> {
        Ok(Self::Gpu(Box::new(adapter.open(gpu::DeviceLimits::from_env()?)?)))
    }

    /// Every executor that the environment allows: the CPU, then each adapter of
    /// [`GpuAdapter::all`](crate::gpu::GpuAdapter::all) unless `NPR_GPU=off`.
    ///
    /// # Errors
    /// If `NPR_GPU=required` and there is no adapter; if an adapter cannot be opened.
    pub fn all() -> Result<Vec<Self>, HarnessError> {
        let policy = GpuPolicy::from_env()?;
        let mut executors = vec![Self::Cpu { why: None }];
        if policy != GpuPolicy::Off {
            executors.extend(Self::adapters()?);
        }
        if policy == GpuPolicy::Required && executors.len() == 1 {
            // Names the adapters that were considered.
            return Self::choose(Backend::Gpu).map(|executor| vec![executor]);
        }
        Ok(executors)
    }

    #[cfg(feature = "gpu")]
    fn adapters() -> Result<Vec<Self>, HarnessError> {
        gpu::GpuAdapter::all().iter().map(Self::on_adapter).collect()
    }

    #[cfg(not(feature = "gpu"))]
    fn adapters() -> Result<Vec<Self>, HarnessError> {
        Ok(Vec::new())
    }

    /// Falls back to the CPU for a picture that the GPU could not render because of `error`, unless `backend` or the
    /// environment requires the GPU.
    ///
    /// # Errors
    /// `error` itself, if there is no fallback; [`HarnessError::Policy`].
    pub fn fallback(backend: Backend, error: HarnessError) -> Result<Self, HarnessError> {
        if backend != Backend::Auto || GpuPolicy::from_env()? != GpuPolicy::Auto {
            return Err(error);
        }
        match &error {
            // The GPU executor needs more memory than the CPU.
            HarnessError::PictureMemory { .. } => Ok(Self::Cpu { why: Some(CpuReason::Unable(error.to_string())) }),
            fault if fault.is_of_the_device() => Ok(Self::Cpu { why: Some(CpuReason::Unable(fault.to_string())) }),
            _ => Err(error),
        }
    }

    /// Whether the CPU renders.
    pub fn is_cpu(&self) -> bool {
        matches!(self, Self::Cpu { .. })
    }

    /// One line: the executor, and the reason for not using another.
    pub fn describe(&self) -> String {
        match self {
            #[cfg(feature = "gpu")]
            Self::Gpu(context) => context.describe(),
            Self::Cpu { why: None } => "CPU, ray casting".into(),
            Self::Cpu { why: Some(why) } => format!("CPU, ray casting ({why})"),
        }
    }

    /// A short name for files and charts: `cpu`, or API and adapter, such as `vulkan-llvmpipe`
    /// ([`GpuContext::name`](crate::gpu::GpuContext::name)).
    pub fn name(&self) -> String {
        match self {
            #[cfg(feature = "gpu")]
            Self::Gpu(context) => context.name(),
            Self::Cpu { .. } => "cpu".into(),
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

    /// Executes a plan that was made for its capabilities. If the driver rejects compute shaders although it reports
    /// support, the plan is executed without them.
    ///
    /// # Errors
    /// [`HarnessError`].
    pub fn execute(&self, scene: &Scene, plan: &Plan, progress: &(dyn Fn(f64) + Sync)) -> Result<Image, HarnessError> {
        match self {
            #[cfg(feature = "gpu")]
            Self::Gpu(context) => match gpu::render(context, scene, plan) {
                Err(HarnessError::Device { .. } | HarnessError::Outline(_)) if plan.computes() => {
                    // Clears further errors of the same attempt.
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

    /// Plans and renders a picture, on the CPU if the GPU cannot and `backend` and the environment allow it. After a
    /// device was lost or ran out of memory, the CPU renders further pictures too.
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
                    // The driver has just rejected compute shaders.
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
