//! Sweeps of meshes: scale, coincident faces, junctions, welding.

mod coincident;
mod junctions;
mod offset;
mod slivers;
mod weld;
mod windings;

use super::Sweep;

pub(super) const SWEEPS: &[Sweep] = &[
    offset::SWEEP,
    coincident::SWEEP,
    coincident::ON_DEVICE,
    junctions::SWEEP,
    weld::SEAMS,
    weld::PLATES,
    windings::SWEEP,
    slivers::SWEEP,
];
