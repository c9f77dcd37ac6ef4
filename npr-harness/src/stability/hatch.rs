//! Sweeps of hatching.

use super::Sweep;

pub(super) const SWEEPS: &[Sweep] = &[];
