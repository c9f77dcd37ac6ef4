//! Sweeps of meshes: scale, coincident faces, junctions, welding.

use super::Sweep;

pub(super) const SWEEPS: &[Sweep] = &[];
