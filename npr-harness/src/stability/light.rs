//! Sweeps of bands and tones of light.

mod flicker;
mod highlight;
mod terminator;
mod vertices;

use super::Sweep;

pub(super) const SWEEPS: &[Sweep] =
    &[flicker::SWEEP, vertices::BANDS, vertices::TONES, highlight::SWEEP, terminator::SWEEP];
