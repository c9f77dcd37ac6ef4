//! The width of the antialiased border between two tones, limited where screen-space derivatives are unreliable.
//!
//! A border is antialiased over the change of N·L across one pixel ([`crate::toon_width`]), so it is one pixel wide at
//! any distance. The change is estimated from derivatives, which are unreliable in two cases:
//!
//! - *Silhouettes.* Where a surface turns away from the eye, N·L changes without bound across a pixel that the surface
//!   covers only in part. A border as wide as the whole range of N·L mixes all tones, which gives gray specks along the
//!   outline that flicker as the model moves. The same happens at creases, where a derivative is taken between pixels of
//!   which one lies outside its triangle, and on models that cover only a few pixels.
//! - *Flat faces.* Where N·L is constant the border has no width, and on a face whose N·L equals a threshold up to
//!   rounding, pixels of both tones alternate.
//!
//! [`toon_border_width`] therefore limits the width to [`MIN_BORDER`]..=[`MAX_BORDER`]. On a sphere with a radius of r
//! pixels N·L changes by about 1/r per pixel, so borders are one pixel wide for radii from 2 to 16,384 pixels, narrower on
//! smaller spheres and wider on larger ones.
//!
//! The upper limit is a measured optimum. The table lists the error of the frame-to-frame change of a pixel, in 1/1000 of
//! white, as root mean square (maximum), by the limit on the width: three gray tones (the thresholds of
//! [`crate::Bands::default`]) on spheres that move by 1/16 pixel per frame, compared with the mean of 24 × 24 samples over
//! the covered part of the pixel.
//!
//! | radius, px | no limit | 1 | 0.5 | 0.25 | 0.125 |
//! | --- | --- | --- | --- | --- | --- |
//! | 2.5 | 12 (130) | 7 (40) | 6 (50) | 11 (110) | 19 (220) |
//! | 4 | 12 (200) | 6 (60) | 4 (30) | 6 (70) | 10 (150) |
//! | 20 | 2.8 (140) | 2.4 (80) | 1.9 (60) | 1.4 (40) | 1.6 (80) |
//! | 200 | 0.6 (170) | 0.5 (130) | 0.5 (110) | 0.5 (100) | 0.4 (60) |
//!
//! 0.5 is the smallest limit that is at no radius notably worse than a larger limit.

use crate::toon_width;

/// The minimum width of a border in units of N·L: 2^-14. An f32 rounding error of N·L then changes a tone by less than
/// 1/255.
pub const MIN_BORDER: f64 = 1.0 / 16384.0;

/// The maximum width of a border in units of N·L.
pub const MAX_BORDER: f64 = 0.5;

/// The width of a border in units of N·L (or N·H), from the derivatives along x and y per pixel: [`crate::toon_width`]
/// clamped to [`MIN_BORDER`]..=[`MAX_BORDER`]. Infinite derivatives give [`MAX_BORDER`], NaN gives [`MIN_BORDER`].
///
/// ```
/// use npr_toon::border::{MAX_BORDER, MIN_BORDER, toon_border_width};
/// assert_eq!(toon_border_width(0.03, 0.04), 0.05);
/// assert_eq!(toon_border_width(f64::INFINITY, 0.0), MAX_BORDER);
/// assert_eq!(toon_border_width(0.0, 0.0), MIN_BORDER);
/// ```
pub fn toon_border_width(along_x: f64, along_y: f64) -> f64 {
    let width = toon_width(along_x, along_y);
    if width > MIN_BORDER { width.min(MAX_BORDER) } else { MIN_BORDER }
}
