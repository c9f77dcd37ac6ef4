//! X-Toon: bands whose contrast depends on depth or on the nearness to the silhouette.
//!
//! P. Barla, J. Thollot, L. Markosian: *X-Toon: An Extended Toon Shader*, NPAR 2006. The 1D toon texture is extended by
//! an axis of detail D: at 1 the surface is shaded by one ramp, at 0 by a more abstract one, in between by both. The
//! paper's texture has any number of rows; here it has two, each computed from its stops, and is interpolated linearly
//! between them, so that borders are antialiased as those of other ramps.

use crate::ToonError;
use crate::light::saturate;
use crate::ramp::{Ramp, toon_ramp};
use glam::DVec3;

/// What the detail D depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case", deny_unknown_fields))]
pub enum Detail {
    /// The eye depth: D falls from 1 at `near` to 0 at `far` with the logarithm of the depth (section 3.2).
    Depth {
        /// Above 0, in the unit of the depths.
        near: f32,
        /// Above `near`.
        far: f32,
    },
    /// The angle to the viewer: D = |N·V|^exponent, 0 at the silhouette (section 3.3).
    Silhouette {
        /// Above 0. The larger it is, the wider is what counts as near the silhouette.
        exponent: f32,
    },
}

impl Detail {
    /// Checks that depths ascend from above 0, or that the exponent is above 0, and that the numbers are finite.
    pub fn validate(&self) -> Result<(), ToonError> {
        match *self {
            Self::Depth { near, far } if near > 0.0 && far > near && far.is_finite() => Ok(()),
            Self::Depth { near, far } => Err(ToonError::DetailDepths { near, far }),
            Self::Silhouette { exponent } if exponent > 0.0 && exponent.is_finite() => Ok(()),
            Self::Silhouette { exponent } => Err(ToonError::DetailExponent { exponent }),
        }
    }
}

/// The detail at an eye depth: 1 up to `near`, 0 from `far` on, and 1 − log(depth / near) / log(far / near) in between.
/// NaN gives 1.
///
/// ```
/// use npr_toon::x_toon::toon_depth_detail;
/// assert_eq!(toon_depth_detail(2.0, 1.0, 4.0), 0.5);
/// assert_eq!(toon_depth_detail(9.0, 1.0, 4.0), 0.0);
/// ```
pub fn toon_depth_detail(depth: f64, near: f64, far: f64) -> f64 {
    saturate(1.0 - (depth.max(near) / near).ln() / (far / near).ln())
}

/// The detail of a surface whose normal has the cosine `n_dot_v` with the direction to the viewer: |N·V|^exponent.
pub fn toon_silhouette_detail(n_dot_v: f64, exponent: f64) -> f64 {
    saturate(n_dot_v.abs()).powf(exponent)
}

/// The colour at a diffuse term `x`: that of `detailed` at detail 1, that of `abstracted` at 0. `width`: as for
/// [`toon_ramp`].
pub fn toon_x_toon(detailed: &Ramp, abstracted: &Ramp, x: f64, width: f64, detail: f64) -> DVec3 {
    toon_ramp(abstracted, x, width).lerp(toon_ramp(detailed, x, width), detail)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ramp::{RampBlend, RampStop};
    use glam::Vec3;

    #[test]
    fn depth_detail_falls_with_the_logarithm() {
        let at = |depth| toon_depth_detail(depth, 2.0, 32.0);
        for (depth, detail) in [(0.5, 1.0), (2.0, 1.0), (4.0, 0.75), (8.0, 0.5), (16.0, 0.25), (32.0, 0.0), (99.0, 0.0)]
        {
            assert!((at(depth) - detail).abs() < 1e-12, "{depth}: {}", at(depth));
        }
        assert_eq!(at(f64::NAN), 1.0, "what has no depth is not far away");
    }

    #[test]
    fn silhouette_detail_is_0_edge_on_and_1_face_on() {
        assert_eq!([0.0, 0.5, 1.0, -0.5].map(|n| toon_silhouette_detail(n, 2.0)), [0.0, 0.25, 1.0, 0.25]);
        // Rounded cosines can be a little above 1.
        assert_eq!(toon_silhouette_detail(1.0 + 1e-9, 3.0), 1.0);
    }

    #[test]
    fn the_ends_of_the_detail_are_the_two_ramps() {
        let ramp = |low: f32, high: f32| Ramp {
            stops: [(-1.0, low), (0.2, high)].map(|(at, v)| RampStop { at, color: Vec3::splat(v) }).to_vec(),
            blend: RampBlend::Hard,
        };
        let (detailed, abstracted) = (ramp(0.25, 1.0), ramp(0.5, 0.75));
        for x in [-0.5, 0.1, 0.3] {
            assert_eq!(toon_x_toon(&detailed, &abstracted, x, 0.1, 1.0), toon_ramp(&detailed, x, 0.1));
            assert_eq!(toon_x_toon(&detailed, &abstracted, x, 0.1, 0.0), toon_ramp(&abstracted, x, 0.1));
        }
        assert_eq!(toon_x_toon(&detailed, &abstracted, -0.5, 0.0, 0.5), DVec3::splat(0.375));
    }

    #[test]
    fn what_has_no_detail_is_refused() {
        let depth = |near, far| Detail::Depth { near, far }.validate();
        assert_eq!(depth(1.0, 2.0), Ok(()));
        for (near, far) in [(0.0, 1.0), (-1.0, 1.0), (2.0, 2.0), (2.0, 1.0), (1.0, f32::INFINITY), (f32::NAN, 1.0)] {
            assert!(matches!(depth(near, far), Err(ToonError::DetailDepths { .. })), "{near} {far}");
        }
        for exponent in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            let refused = Detail::Silhouette { exponent }.validate();
            assert!(matches!(refused, Err(ToonError::DetailExponent { .. })), "{exponent}");
        }
    }
}
