//! Sweeps of lines from edges, fins and hulls.

use super::Sweep;

pub(super) const SWEEPS: &[Sweep] = &[];
