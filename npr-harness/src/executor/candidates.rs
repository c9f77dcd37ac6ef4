//! Candidate executors, found before the work is known.

use super::{Backend, CpuReason, Executor, GpuPolicy, Work};
use crate::error::HarnessError;

#[cfg(feature = "gpu")]
use crate::gpu::{DeviceLimits, GpuAdapter};

/// The candidate executors. They can be searched on another thread while a model is loaded.
pub struct Candidates(Found);

enum Found {
    Executor(Executor),
    /// The CPU or this adapter, whichever is faster.
    #[cfg(feature = "gpu")]
    Software(GpuAdapter, DeviceLimits),
}

impl Candidates {
    /// Finds adapters, and opens the one that is used for any work.
    ///
    /// # Errors
    /// If an adapter is required, by `backend` or by the environment, and there is none.
    pub fn find(backend: Backend) -> Result<Self, HarnessError> {
        let policy = GpuPolicy::from_env()?;
        if backend == Backend::Cpu {
            return Ok(Self(Found::Executor(Executor::Cpu { why: None })));
        }
        if policy == GpuPolicy::Off {
            return match backend {
                Backend::Gpu => Err(HarnessError::GpuOff),
                _ => Ok(Self::unable("NPR_GPU=off".into())),
            };
        }
        Self::on_device(backend, policy)
    }

    fn unable(why: String) -> Self {
        Self(Found::Executor(Executor::Cpu { why: Some(CpuReason::Unable(why)) }))
    }

    #[cfg(feature = "gpu")]
    fn on_device(backend: Backend, policy: GpuPolicy) -> Result<Self, HarnessError> {
        // A misspelt variable is an error even if no device is opened.
        let limits = DeviceLimits::from_env()?;
        // If a device is required, expected times are not compared.
        let open = backend == Backend::Auto && policy == GpuPolicy::Auto;
        let found = GpuAdapter::find().and_then(|adapter| {
            if open && adapter.is_software() {
                return Ok(Found::Software(adapter, limits));
            }
            Ok(Found::Executor(Executor::Gpu(Box::new(adapter.open(limits)?))))
        });
        match found {
            Ok(found) => Ok(Self(found)),
            Err(error) if policy == GpuPolicy::Required => Err(HarnessError::GpuRequired(error.to_string())),
            Err(error) if backend == Backend::Gpu => Err(error),
            Err(error) => Ok(Self::unable(error.to_string())),
        }
    }

    #[cfg(not(feature = "gpu"))]
    fn on_device(backend: Backend, policy: GpuPolicy) -> Result<Self, HarnessError> {
        if backend == Backend::Gpu || policy == GpuPolicy::Required {
            return Err(HarnessError::NoGpuInBuild);
        }
        Ok(Self::unable("this build has no GPU executor".into()))
    }

    /// Selects the GPU whenever there is an adapter.
    pub fn choose(self) -> Executor {
        match self.0 {
            Found::Executor(executor) => executor,
            #[cfg(feature = "gpu")]
            Found::Software(adapter, limits) => match adapter.open(limits) {
                Ok(context) => Executor::Gpu(Box::new(context)),
                Err(error) => Executor::Cpu { why: Some(CpuReason::Unable(error.to_string())) },
            },
        }
    }

    /// Selects a software adapter only if it is expected to be faster than the CPU.
    pub fn choose_for(self, work: &Work) -> Executor {
        #[cfg(feature = "gpu")]
        if let Found::Software(adapter, _) = &self.0
            && work.is_sooner_on_cpu()
        {
            return Executor::Cpu { why: Some(CpuReason::Sooner { adapter: adapter.describe() }) };
        }
        // In a build without the GPU executor, `work` has no effect.
        let _ = work;
        self.choose()
    }
}
