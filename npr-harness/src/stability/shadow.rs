//! Sweeps of shadows.

use super::Sweep;

pub(super) const SWEEPS: &[Sweep] = &[];
