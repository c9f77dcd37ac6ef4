//! Sweeps of lines from edges, fins and hulls.

mod density;
mod flicker;
mod fragments;
mod hull_corners;
mod normals;
mod thin;
mod widths;

use super::Sweep;

pub(super) const SWEEPS: &[Sweep] = &[
    normals::SILHOUETTE_NORMALS,
    normals::TORN_FINS,
    widths::WIDTH_DISTANCE,
    widths::WIDTH_TILT,
    widths::NEAR_PLANE,
    hull_corners::HULL_CORNERS,
    thin::THIN_BARS,
    density::LINE_DENSITY,
    fragments::CONTOUR_NOISE,
    flicker::FLICKER,
];
