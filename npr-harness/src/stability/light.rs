//! Sweeps of bands and tones of light.

use super::Sweep;

pub(super) const SWEEPS: &[Sweep] = &[];
