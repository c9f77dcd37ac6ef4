//! Sweeps of lines found in the image.

use super::Sweep;

pub(super) const SWEEPS: &[Sweep] = &[];
