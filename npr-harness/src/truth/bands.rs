//! Accuracy of band borders, against 256 samples per pixel.
//!
//! The reference renders N·L at 16 × 16 times the resolution of the picture. From it follow, for pixel positions in
//! steps of 1/16 px, the true mean tone of each pixel, and the positions of borders and silhouettes. The picture is
//! rendered by the same executor, with one sample per pixel, so that only its borders cause errors, or with several
//! samples.
//!
//! # Definition of flicker
//!
//! While a border moves over a pixel, the pixel's tone changes from one tone to another, at once or gradually. For any
//! border that does not reverse, the sum and the mean of these changes are the same. Flicker is the deviation from the
//! true change: the mean of |change − true change| ([`BandAccuracy::excess`]). The mean of the changes themselves is
//! [`BandAccuracy::change`].

use crate::camera::Camera;
use crate::capabilities::Capabilities;
use crate::cpu::{self, CpuFrame, CpuOptions};
use crate::error::HarnessError;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::shade::Shade;
use crate::shade::ramp::{RampShade, RampSource};
use crate::style::{Style, style};
use crate::view::View;
use glam::{DVec2, DVec3, Vec3};
use npr_mesh::Model;
use npr_toon::ramp::{Ramp, RampBlend, RampStop};
use npr_toon::{Bands, toon_band_hard};

/// Samples per pixel along each axis, and steps of the pan per pixel.
const FINE: usize = 16;
/// The number of steps of the pan.
const STEPS: usize = 64;
/// Pixels within this distance of a border and farther than this from any silhouette are evaluated, px.
const NEAR_PX: f64 = 2.0;
/// A larger difference of N·L between two samples 1/16 px apart is a crease, not a band border.
const LARGEST_STEP: f64 = 0.05;

/// Which pixels are evaluated, in addition to lying within 2 px of a border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Where {
    /// More than 2 px from any silhouette.
    AwayFromSilhouettes,
    /// Also more than 2 px from any crease, where one surface ends and another, with different lighting, begins. Band
    /// borders cannot smooth that step; lines cover it.
    AndFromCreases,
}

/// Errors of hard and of antialiased bands. Values are relative to a component's range of 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BandAccuracy {
    /// The number of pixels evaluated, over all steps.
    pub pixels: usize,
    /// Root mean square error: hard, antialiased.
    pub rmse: [f64; 2],
    /// Largest error: hard, antialiased.
    pub worst: [f64; 2],
    /// Mean change from one step to the next: hard, antialiased, true.
    pub change: [f64; 3],
    /// Mean of |change − true change|: hard, antialiased.
    pub excess: [f64; 2],
}

/// A white copy of the model, whose tones are those of the bands.
pub fn white(model: &Model) -> Model {
    let mut model = model.clone();
    model.colors.clear();
    for material in &mut model.materials {
        material.texture = None;
        material.alpha_mode = npr_mesh::AlphaMode::Opaque;
        material.base_color = glam::Vec4::ONE;
        material.emissive = Vec3::ZERO;
    }
    model
}

impl BandAccuracy {
    /// The root mean square error of antialiased borders, relative to that of hard ones.
    pub fn rmse_ratio(&self) -> f64 {
        self.rmse[1] / self.rmse[0]
    }

    /// The change per step of antialiased borders, relative to that of hard ones.
    pub fn change_ratio(&self) -> f64 {
        self.change[1] / self.change[0]
    }

    /// The flicker of antialiased borders, relative to that of hard ones.
    pub fn excess_ratio(&self) -> f64 {
        self.excess[1] / self.excess[0]
    }
}

/// Measures `bands`, without their highlight, on a scene made of a [`white`] model, over a pan by 4 px to the right,
/// for both values of [`Where`]. `samples` is the number of samples along each axis of a pixel for the antialiased
/// borders; the hard ones have one. Takes 10 KB per pixel.
///
/// # Errors
/// An error if a number of the bands is out of range.
pub fn band_accuracy(
    scene: &Scene,
    camera: &Camera,
    (width, height): (u32, u32),
    bands: &Bands,
    samples: u32,
) -> Result<[BandAccuracy; 2], HarnessError> {
    let of = |shade| Style { shade, ..style("toon").expect("a style of this crate") };
    let n_dot_l = [(-1.0, Vec3::ZERO), (1.0, Vec3::ONE)].map(|(at, color)| RampStop { at, color });
    let n_dot_l = Ramp { stops: n_dot_l.to_vec(), blend: RampBlend::Smooth };
    let n_dot_l = of(Shade::Ramp(RampShade { ramp: RampSource::Stops(n_dot_l), half_lambert: None }));
    let drawn = |style: &Style, size, shift_px, samples| {
        let view = View { camera: *camera, size, samples };
        // The memory limit is for single pictures of users; callers of this function know its needs.
        let capabilities = Capabilities { memory_bytes: u64::MAX, ..Capabilities::RAY_CASTER };
        let plan = Plan::new(scene, style, &view, &capabilities)?;
        let options = CpuOptions { shift_px, ..Default::default() };
        Ok::<_, HarnessError>(cpu::render(scene, &plan, &options, &|_| {}))
    };
    let fine = drawn(&n_dot_l, (width * FINE as u32, height * FINE as u32), DVec2::ZERO, 1)?;
    let truth = Truth::new(&fine, camera, bands);
    drop(fine);
    let hard = of(Shade::Toon(Bands { highlight: None, antialias: false, ..bands.clone() }));
    let smooth = of(Shade::Toon(Bands { highlight: None, antialias: true, ..bands.clone() }));
    let mut sums = [Sums::default(); 2];
    let mut before: Option<[Vec<f64>; 3]> = None;
    for step in 0..=STEPS {
        let shift_px = DVec2::new(step as f64 / FINE as f64, 0.0);
        let tones = |frame: CpuFrame| -> Vec<f64> { frame.color.iter().map(|c| mean(c.truncate())).collect() };
        let now = [
            tones(drawn(&hard, (width, height), shift_px, 1)?),
            tones(drawn(&smooth, (width, height), shift_px, samples)?),
            truth.picture(step),
        ];
        for (sums, place) in sums.iter_mut().zip([Where::AwayFromSilhouettes, Where::AndFromCreases]) {
            let judged = truth.judged(step, place);
            for pixel in (0..judged.len()).filter(|&pixel| judged[pixel]) {
                let values = |of: &[Vec<f64>; 3]| [0, 1, 2].map(|which| of[which][pixel]);
                sums.add(values(&now), before.as_ref().map(values));
            }
        }
        before = Some(now);
    }
    Ok(sums.map(Sums::accuracy))
}

#[derive(Clone, Copy, Default)]
struct Sums {
    pixels: usize,
    pairs: usize,
    square: [f64; 2],
    worst: [f64; 2],
    change: [f64; 3],
    excess: [f64; 2],
}

impl Sums {
    /// Adds a pixel's tones, hard, antialiased and true, in this step and in the previous one.
    fn add(&mut self, now: [f64; 3], before: Option<[f64; 3]>) {
        self.pixels += 1;
        for which in 0..2 {
            let error = now[which] - now[2];
            self.square[which] += error * error;
            self.worst[which] = self.worst[which].max(error.abs());
        }
        let Some(before) = before else { return };
        self.pairs += 1;
        let change = [0, 1, 2].map(|which| now[which] - before[which]);
        for (sum, change) in self.change.iter_mut().zip(change) {
            *sum += change.abs();
        }
        for which in 0..2 {
            self.excess[which] += (change[which] - change[2]).abs();
        }
    }

    fn accuracy(self) -> BandAccuracy {
        let (pixels, pairs) = (self.pixels.max(1) as f64, self.pairs.max(1) as f64);
        BandAccuracy {
            pixels: self.pixels,
            rmse: self.square.map(|sum| (sum / pixels).sqrt()),
            worst: self.worst,
            change: self.change.map(|sum| sum / pairs),
            excess: self.excess.map(|sum| sum / pairs),
        }
    }
}

fn mean(color: DVec3) -> f64 {
    color.element_sum() / 3.0
}

/// The data derived from the fine samples.
struct Truth {
    /// The width of the picture, px.
    width: usize,
    height: usize,
    /// Per fine sample: its tone, 1 for background.
    tone: Vec<f32>,
    /// Positions of borders, of silhouettes and of creases, in fine samples.
    borders: Vec<(u32, u32)>,
    silhouettes: Vec<(u32, u32)>,
    creases: Vec<(u32, u32)>,
}

impl Truth {
    fn new(fine: &CpuFrame, camera: &Camera, bands: &Bands) -> Self {
        let (columns, rows) = (fine.width as usize, fine.height as usize);
        // The largest change of depth between two samples on a slope of 1 in 64 px; a larger one is a depth step.
        let view = camera.line_view(DVec2::new(f64::from(fine.width), f64::from(fine.height)));
        let light = |at: usize| 2.0 * fine.color[at].x - 1.0;
        let band = |at: usize| bands.thresholds.iter().filter(|&&t| light(at) >= f64::from(t)).count();
        let paper = f64::from(style("toon").expect("a style of this crate").paper.element_sum()) / 3.0;
        let tone = (0..fine.depth.len())
            .map(|at| if fine.depth[at] > 0.0 { mean(toon_band_hard(bands, light(at))) } else { paper } as f32)
            .collect();
        let (mut borders, mut silhouettes, mut creases) = (Vec::new(), Vec::new(), Vec::new());
        for y in 0..rows {
            for x in 0..columns {
                let here = y * columns + x;
                for beside in [(x + 1 < columns).then_some(here + 1), (y + 1 < rows).then_some(here + columns)] {
                    let Some(beside) = beside else { continue };
                    let (a, b) = (fine.depth[here], fine.depth[beside]);
                    if a == 0.0 && b == 0.0 {
                        continue;
                    }
                    let per_px = a.max(b) * view.depth_per_px.x + view.depth_per_px.y;
                    if a == 0.0 || b == 0.0 || (a - b).abs() > 64.0 * per_px {
                        silhouettes.push((x as u32, y as u32));
                    } else if (light(here) - light(beside)).abs() >= LARGEST_STEP {
                        creases.push((x as u32, y as u32));
                    } else if band(here) != band(beside) {
                        borders.push((x as u32, y as u32));
                    }
                }
            }
        }
        Self { width: columns / FINE, height: rows / FINE, tone, borders, silhouettes, creases }
    }

    /// The mean tones of the pixels after a step of the pan; 0 for pixels outside the sampled area.
    fn picture(&self, step: usize) -> Vec<f64> {
        let columns = self.width * FINE;
        let pixel = |x: usize, y: usize| {
            let first = x * FINE + step;
            if first + FINE > columns {
                return 0.0;
            }
            let rows = (y * FINE..(y + 1) * FINE).map(|row| &self.tone[row * columns + first..][..FINE]);
            rows.flatten().map(|&tone| f64::from(tone)).sum::<f64>() / (FINE * FINE) as f64
        };
        (0..self.height).flat_map(|y| (0..self.width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect()
    }

    /// Which pixels are evaluated after a step of the pan.
    fn judged(&self, step: usize, place: Where) -> Vec<bool> {
        let near = |places: &[(u32, u32)]| {
            let mut near = vec![false; self.width * self.height];
            let px = |at: u32| (f64::from(at) + 1.0) / FINE as f64;
            for &(x, y) in places {
                // The position of the step between the two samples in the panned picture.
                let at = DVec2::new(px(x) - step as f64 / FINE as f64, px(y));
                let (low, high) = ((at - NEAR_PX - 0.5).ceil().max(DVec2::ZERO), (at + NEAR_PX - 0.5).floor());
                for row in low.y as i64..=(high.y as i64).min(self.height as i64 - 1) {
                    for column in low.x as i64..=(high.x as i64).min(self.width as i64 - 1) {
                        let centre = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
                        near[row as usize * self.width + column as usize] |= centre.distance(at) <= NEAR_PX;
                    }
                }
            }
            near
        };
        let mut judged = near(&self.borders);
        let not_near = [&self.silhouettes, &self.creases];
        for places in &not_near[..if place == Where::AndFromCreases { 2 } else { 1 }] {
            for (judged, near) in judged.iter_mut().zip(near(places)) {
                *judged &= !near;
            }
        }
        // Pixels that the pan moves into the picture were not sampled.
        let margin = STEPS / FINE + 1;
        for row in judged.chunks_exact_mut(self.width) {
            let inside = self.width.saturating_sub(margin);
            row[inside..].fill(false);
        }
        judged
    }
}
