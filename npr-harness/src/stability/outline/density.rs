//! Lines closer together than a pixel.

use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::picture::Image;
use crate::scene::Scene;
use crate::stability::ink::{beside, curve, drawn, limit, parallel};
use crate::stability::{Axis, Finding, Sweep};
use crate::style::Lines;
use crate::truth::lines::darkness;
use crate::view::View;
use glam::{DVec2, Vec3};
use npr_mesh::{Material, Model};
use npr_outline::line_style::{LineStyle, widths_px};

pub(super) const LINE_DENSITY: Sweep = Sweep {
    name: "line-density",
    technique: "lines from edges",
    what: "Of the lines that share a pixel the one that covers most of it is drawn, so that pieces of one line do not darken \
           their joints. Lines beside each other within a pixel are too pale.",
    needs_adapter: false,
    run: line_density,
};

const SIZE_PX: u32 = 48;

/// The angle of the lines to the columns of the picture.
const TURN_RAD: f64 = 0.4;

/// A sheet of strips of two materials by turns, one world unit a px, with borders at a pitch across it.
fn strips(pitch_px: f64) -> Model {
    const HALF_PX: f64 = 35.0;
    let count = (2.0 * HALF_PX / pitch_px) as u32;
    let turned = DVec2::from_angle(TURN_RAD);
    let mut sheet = Model { materials: vec![Material::default(); 2], ..Model::default() };
    for border in 0..=count {
        let across = f64::from(border) * pitch_px - HALF_PX;
        for along in [-HALF_PX, HALF_PX] {
            sheet.positions.push(turned.rotate(DVec2::new(across, along)).extend(0.0).as_vec3());
            sheet.normals.push(Vec3::Z);
        }
    }
    for strip in 0..count {
        let first = 2 * strip;
        sheet.faces.extend([[first, first + 2, first + 1], [first + 1, first + 2, first + 3]]);
        sheet.face_material.extend([strip % 2; 2]);
        sheet.face_polygon.extend([strip; 2]);
    }
    sheet
}

/// Lines along the borders of materials that cover half of the sheet.
fn half_covering(pitch_px: f64) -> Lines {
    let width_px = widths_px(0.0, 0.0, 0.0, (pitch_px / 2.0) as f32);
    Lines::edges(LineStyle { width_px, ink: [0.0, 0.0, 0.0, 1.0] })
}

fn line_density(executor: &Executor) -> Result<Finding, HarnessError> {
    let picture = |pitch_px: f64, samples: u32| -> Result<Image, HarnessError> {
        let view = View { samples, ..View::new(parallel(f64::from(SIZE_PX)), (SIZE_PX, SIZE_PX)) };
        drawn(executor, &Scene::new(strips(pitch_px)), half_covering(pitch_px), view, 1.0)
    };
    let tone = |picture: &Image| {
        let ink = darkness(picture);
        ink.iter().sum::<f64>() / ink.len() as f64
    };
    let mut curves = Vec::new();
    for (name, samples) in [("edge lines", 1), ("edge lines, 4 × 4 samples", 4)] {
        let mut points = Vec::new();
        for pitch_px in [0.25, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0, 8.0] {
            points.push((pitch_px, 100.0 * (1.0 - tone(&picture(pitch_px, samples)?) / 0.5)));
        }
        let what = "tone that is missing at a pitch of ¼ px, %";
        let limit = if samples == 1 {
            let predicted = 100.0 * (1.0 - points[0].0 / TURN_RAD.cos());
            limit(what, points[0].1, Bound::AtMost(74.5)).predicted(
                predicted,
                "1 − (p / 2) / cos φ / ½: the share of a pixel that one line through its middle covers",
            )
        } else {
            limit(what, points[0].1, Bound::AtMost(14.0))
        };
        curves.push(curve(name, points, limit));
    }
    Ok(Finding {
        parameter: Axis::logarithmic("pitch of lines that cover half of a sheet", "px"),
        error: Axis::linear("tone missing", "%"),
        curves,
        pictures: vec![(
            "Lines that cover half of a sheet, at pitches of 8, 2, ½ and ¼ px: the closer, the paler.".into(),
            beside(&[picture(8.0, 1)?, picture(2.0, 1)?, picture(0.5, 1)?, picture(0.25, 1)?]),
        )],
    })
}
