//! Maps that are seen from far away and from nearby.
//!
//! Tones are those of squares with four tiles of the map along them, from several distances; strokes are those on a square
//! that fills the picture.

use super::super::setup::{curve, first_over, frame, front, limit, limit_at, side_by_side, tones, worst};
use super::super::{Axis, Finding, Sweep};
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::hatch::{HatchEncoding, HatchMap, HatchMapping};
use crate::picture::Image;
use crate::scene::Scene;
use crate::style::Style;
use crate::truth::hatch::patch::{PatchView, TILE, Tilted, patch_tones};
use crate::truth::hatch::{LINEAR, black, hatched, strokes};
use crate::view::View;
use glam::DVec3;
use npr_mesh::embedded;
use npr_toon::normal::NormalUse;

pub(super) const TONE: Sweep = Sweep {
    name: "hatch-minification-tone",
    technique: "hatching",
    what: "A map seen from far away keeps its tone: each mip level has it, and a flat tone takes over where there is no \
           room for strokes.",
    needs_adapter: false,
    run: tone_error,
};

pub(super) const CONTRAST: Sweep = Sweep {
    name: "hatch-minification-strokes",
    technique: "hatching",
    what: "Where the whole map covers 8 px, strokes have given way to a flat tone.",
    needs_adapter: false,
    run: contrast,
};

pub(super) const WIDTH: Sweep = Sweep {
    name: "hatch-magnification",
    technique: "hatching",
    what: "Nearer than the finest level strokes grow with the texels, since there are no finer ones.",
    needs_adapter: false,
    run: width,
};

const METHODS: [(&str, HatchEncoding); 2] =
    [("six tones", HatchEncoding::SixTones), ("thresholds", HatchEncoding::Thresholds)];
/// The side of the map's finest level.
const SIDE: f64 = 256.0;
/// Width and height of the picture, px; it is filled by the side of a cube.
const SIZE: u32 = 128;
/// Width and height of the pictures of patches, px.
const PATCH: u32 = 160;
/// The tone at which strokes are measured.
const TONE_OF_STROKES: f64 = 0.6;

/// The tones of the pixels where `texels` of the finest level lie in a pixel.
fn seen(map: &HatchMap, encoding: HatchEncoding, texels: f64, tone: f64) -> Result<Vec<f64>, HarnessError> {
    let view = View::new(front(1.9), (SIZE, SIZE));
    Ok(tones(&frame(&Scene::new(embedded::cube()), &style(map, encoding, texels, tone), view)?))
}

fn style(map: &HatchMap, encoding: HatchEncoding, texels: f64, tone: f64) -> Style {
    // The picture has a height of 1.9, the cube half a diagonal of √3.
    let tile = SIDE / texels * 1.9 / f64::from(SIZE) / 3f64.sqrt();
    let shade = black(map, encoding, HatchMapping::Planes, LINEAR, tile);
    hatched(&shade, NormalUse::PerPixel, DVec3::new((1.0 - tone * tone).sqrt(), 0.0, tone))
}

fn mean(tones: &[f64]) -> f64 {
    tones.iter().sum::<f64>() / tones.len() as f64
}

/// A strip of the square for each scale.
fn picture(map: &HatchMap, encoding: HatchEncoding, texels: &[f64], width: u32) -> Result<Image, HarnessError> {
    let mut images = Vec::new();
    for &texels in texels {
        let style = style(map, encoding, texels * f64::from(SIZE) / 120.0, TONE_OF_STROKES);
        let view = View::new(front(1.9), (width, 120));
        images.push(frame(&Scene::new(embedded::cube()), &style, view)?.image());
    }
    Ok(side_by_side(&images))
}

fn texels_axis() -> Axis {
    Axis::logarithmic("texels of the finest level in a pixel", "")
}

fn tone_error(_: &Executor) -> Result<Finding, HarnessError> {
    let (map, mut curves) = (strokes(1), Vec::new());
    for (name, encoding) in METHODS {
        let mut points = Vec::new();
        let shade = black(&map, encoding, HatchMapping::Planes, LINEAR, TILE);
        for distance in [1.0, 1.37, 2.1, 2.9, 4.3, 6.1, 8.7, 13.0] {
            let view = PatchView { tilted: Tilted::Camera, tilt_deg: 30.0, distance };
            let found = patch_tones(&shade, view, &[2.0 / 7.0, 0.5, 0.8], PATCH, 2000)?;
            // Four tiles along nine tenths of the picture.
            let texels = 4.0 * SIDE / (0.9 * f64::from(PATCH)) * distance;
            points.push((texels, found.iter().map(|tone| tone.error().abs()).fold(0.0, f64::max)));
        }
        let measured = worst(&points);
        let what = "largest error of the mean tone at any distance";
        curves.push(curve(name, points, limit(what, measured, None, Bound::AtMost(0.006))));
    }
    Ok(Finding {
        parameter: texels_axis(),
        error: Axis::linear("error of the mean tone", ""),
        curves,
        pictures: vec![(
            "2, 8, 16, 20, 24 and 32 texels in a pixel".into(),
            picture(&map, HatchEncoding::Thresholds, &[2.0, 8.0, 16.0, 20.0, 24.0, 32.0], 51)?,
        )],
    })
}

fn contrast(_: &Executor) -> Result<Finding, HarnessError> {
    let deviation = |tones: &[f64]| {
        let mean = mean(tones);
        (tones.iter().map(|tone| (tone - mean).powi(2)).sum::<f64>() / tones.len() as f64).sqrt()
    };
    let (map, mut curves) = (strokes(1), Vec::new());
    for (name, encoding) in METHODS {
        let mut points = Vec::new();
        let most = deviation(&seen(&map, encoding, 1.0, TONE_OF_STROKES)?);
        for texels in [1.0, 2.0, 4.0, 8.0, 12.0, 16.0, 20.0, 24.0, 28.0, 30.0, 32.0, 40.0] {
            points.push((texels, 1.0 - deviation(&seen(&map, encoding, texels, TONE_OF_STROKES)?) / most));
        }
        let measured = first_over(&points, 0.999);
        let what = "texels in a pixel from which there are no strokes";
        let predicted = (SIDE / 8.0, "the side of the map over 8 px, from where on the weight of the flat tone is 1");
        curves.push(curve(name, points, limit_at(what, measured, Some(predicted), Bound::AtLeast(31.0))));
    }
    Ok(Finding {
        parameter: texels_axis(),
        error: Axis::linear("contrast that is lost, relative to one texel in a pixel", ""),
        curves,
        pictures: vec![(
            "8, 16, 24 and 32 texels in a pixel".into(),
            picture(&map, HatchEncoding::SixTones, &[8.0, 16.0, 24.0, 32.0], 78)?,
        )],
    })
}

/// The width of strokes: twice their area over the length of their borders, which is 4/π times less than the number of
/// borders along rows and columns for borders in all directions, and equal to it along an axis.
fn width_px(tones: &[f64]) -> f64 {
    let side = SIZE as usize;
    let is_ink = |x: usize, y: usize| tones[y * side + x] < 0.5;
    let (mut ink, mut borders) = (0.0, 0.0);
    for y in 1..side {
        for x in 1..side {
            ink += f64::from(u8::from(is_ink(x, y)));
            // Strokes of light tones run along the rows.
            borders += f64::from(u8::from(is_ink(x, y) != is_ink(x, y - 1)));
        }
    }
    2.0 * ink / borders
}

fn width(_: &Executor) -> Result<Finding, HarnessError> {
    const LIGHT: f64 = 6.0 / 7.0;
    let (map, mut curves) = (strokes(1), Vec::new());
    for (name, encoding) in METHODS {
        let mut points = Vec::new();
        for px in [0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0] {
            points.push((px, width_px(&seen(&map, encoding, 1.0 / px, LIGHT)?)));
        }
        let at_one = points[1].1;
        let measured = first_over(&points, 2.0 * at_one);
        let what = "pixels in a texel at which strokes are twice as wide as the map's";
        let predicted = (2.0, "the width in texels is fixed at the finest level: 1 px a texel, times 2");
        curves.push(curve(name, points, limit_at(what, measured, Some(predicted), Bound::AtLeast(1.9))));
    }
    Ok(Finding {
        parameter: Axis::logarithmic("pixels in a texel of the finest level", ""),
        error: Axis::logarithmic("width of strokes", "px"),
        curves,
        pictures: vec![(
            "1, 4 and 12 px in a texel".into(),
            picture(&map, HatchEncoding::SixTones, &[1.0, 0.25, 1.0 / 12.0], 104)?,
        )],
    })
}
