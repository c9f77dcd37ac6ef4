//! Sweeps of hatching.

mod direction;
mod map;
mod scale;
mod tones;
mod vertices;

use super::Sweep;

pub(super) const SWEEPS: &[Sweep] =
    &[vertices::SWEEP, tones::SWEEP, scale::TONE, scale::CONTRAST, scale::WIDTH, map::SWEEP, direction::SWEEP];
