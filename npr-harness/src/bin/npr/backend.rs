//! The argument `--backend`.

use clap::ValueEnum;
use npr_harness::executor::Backend;

#[derive(Clone, Copy, ValueEnum)]
pub enum BackendName {
    Auto,
    Gpu,
    Cpu,
}

impl From<BackendName> for Backend {
    fn from(name: BackendName) -> Self {
        match name {
            BackendName::Auto => Self::Auto,
            BackendName::Gpu => Self::Gpu,
            BackendName::Cpu => Self::Cpu,
        }
    }
}
