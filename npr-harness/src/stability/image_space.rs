//! Sweeps of lines found in the image.

mod artist;
mod background;
mod dilation;
mod formats;
mod inker;
mod planes;
mod regions;
mod smooth;

use super::Sweep;

pub(super) const SWEEPS: &[Sweep] = &[
    formats::DEPTH_GAPS,
    formats::DEPTH_RANGE,
    formats::NORMAL_ANGLES,
    planes::GRAZING_PLANE,
    smooth::FACETS,
    smooth::DISTANT_BALL,
    smooth::MODEL_SIZE,
    background::PLUS_Z,
    regions::REGION_CODES,
    inker::INKER_SLOPE,
    inker::INKER_NEAR,
    artist::ARTIST_DISTANCE,
    dilation::DILATION_RADIUS,
];
