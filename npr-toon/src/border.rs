//! How wide a border between two tones is, on surfaces whose light does not change evenly.
//!
//! A border is antialiased over the change of N·L across one pixel ([`crate::toon_width`]), so it is a pixel wide at
//! any distance. That change comes from derivatives, and there are two places where these do not say what happens in
//! the pixel:
//!
//! - *Silhouettes.* Where a surface turns away from the eye N·L changes without bound across a pixel, and of the pixel
//!   only a part is surface. A border as wide as the whole of N·L mixes all tones into one: gray specks along the
//!   outline that come and go as the model moves. The same happens at creases, where a derivative is taken across
//!   pixels of which one lies outside of its triangle, and everywhere on models of a few pixels.
//! - *Flat faces.* Where N·L does not change, a border has no width, and a face whose N·L is at a threshold to within
//!   a rounding breaks into specks of both tones.
//!
//! [`toon_border_width`] therefore stays within [`MIN_BORDER`] and [`MAX_BORDER`]. On a sphere of radius r pixels N·L
//! changes by about 1/r, so borders are a pixel wide from a radius of 2 pixels to one of 16,384; on what is smaller
//! they are narrower, on what is flatter wider.
//!
//! The largest width is measured: three gray tones (the thresholds of [`crate::Bands::default`]) on spheres that move
//! by 1/16 pixel a frame, against the mean over 24 × 24 samples of the part of the pixel that is sphere. What the
//! picture changes from frame to frame more or less than it should, in 1/1000 of white, root mean square (largest):
//!
//! | radius, px | no limit | 1 | 0.5 | 0.25 | 0.125 |
//! | --- | --- | --- | --- | --- | --- |
//! | 2.5 | 12 (130) | 7 (40) | 6 (50) | 11 (110) | 19 (220) |
//! | 4 | 12 (200) | 6 (60) | 4 (30) | 6 (70) | 10 (150) |
//! | 20 | 2.8 (140) | 2.4 (80) | 1.9 (60) | 1.4 (40) | 1.6 (80) |
//! | 200 | 0.6 (170) | 0.5 (130) | 0.5 (110) | 0.5 (100) | 0.4 (60) |
//!
//! 0.5 is the smallest limit that is at no radius notably worse than a larger one.

use crate::toon_width;

/// The narrowest border, in N·L: 2^-14. A rounding of f32 then moves a tone by less than 1/255.
pub const MIN_BORDER: f64 = 1.0 / 16384.0;

/// The widest border, in N·L.
pub const MAX_BORDER: f64 = 0.5;

/// How wide a border is, in units of N·L (or N·H), from the derivatives along x and y, per pixel:
/// [`crate::toon_width`] within [`MIN_BORDER`]..=[`MAX_BORDER`]. Derivatives that are infinite or NaN count as
/// [`MAX_BORDER`] and [`MIN_BORDER`].
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
