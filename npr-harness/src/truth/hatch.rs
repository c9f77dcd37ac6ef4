//! Accuracy of hatching: its tone, and its stability on a surface, in f64, on the CPU executor.
//!
//! - [`patch`]: flat squares of one tone, from several distances and at several tilts.
//! - [`sphere`]: spheres of several tessellations against the tone of the exact sphere.
//! - [`stability`]: two pictures from cameras that differ a little, compared at the same points of the surface.
//!
//! Everything is hatched in black on white, without lines, with a light that is fixed to the model, so that a picture's
//! colour is its tone and moving the camera changes no tone.

pub mod patch;
pub mod sphere;
pub mod stability;

use crate::hatch::{HatchEncoding, HatchGround, HatchMap, HatchMapping, HatchShade, HatchSource, HatchTransfer};
use crate::lights::{LightFrame, StyleLight};
use crate::shade::Shade;
use crate::style::{Lines, Style, style};
use glam::{DVec3, Vec2, Vec3};
use npr_hatch::TamParameters;
use npr_mesh::{Material, Model};
use npr_toon::normal::NormalUse;
use npr_toon::source::Light;
use std::f64::consts::TAU;

/// All encodings of a map.
pub const ENCODINGS: [HatchEncoding; 2] = [HatchEncoding::SixTones, HatchEncoding::Thresholds];
/// All mappings of a map.
pub const MAPPINGS: [HatchMapping; 3] = [HatchMapping::Coordinates, HatchMapping::Planes, HatchMapping::Form];
/// Tones equal to N·L.
pub const LINEAR: HatchTransfer = HatchTransfer::Linear { ambient: 0.0 };
/// Linear with some ambient light, so that there are strokes on the whole surface and no area is black.
pub const LIT: HatchTransfer = HatchTransfer::Linear { ambient: 0.15 };
/// Listing 4 with the brightness that makes tones equal to N·L, except for the darkest.
pub const LISTING_4: HatchTransfer = HatchTransfer::Listing4 { brightness: 7.0 };

/// The default strokes, drawn from a seed.
pub fn strokes(seed: u64) -> HatchMap {
    HatchMap::new(HatchSource::Parameters(TamParameters { seed, ..TamParameters::default() }))
}

/// Black strokes with texels of the size of pixels and a map of side `tile`, in halves of the model's diagonal.
pub fn black(
    map: &HatchMap,
    encoding: HatchEncoding,
    mapping: HatchMapping,
    transfer: HatchTransfer,
    tile: f64,
) -> HatchShade {
    HatchShade {
        map: map.clone(),
        encoding,
        mapping,
        transfer,
        tile: tile as f32,
        texel_px: 1.0,
        ink: Vec3::ZERO,
        ground: HatchGround::Paper,
    }
}

/// A style with only strokes, on white, with a light from a direction in the model's axes.
pub fn hatched(shade: &HatchShade, normals: NormalUse, to_light: DVec3) -> Style {
    let light = Light::directional(to_light.as_vec3());
    Style {
        paper: Vec3::ONE,
        shade: Shade::Hatch(shade.clone()),
        normals,
        mesh_normals: false,
        lights: vec![StyleLight { light, frame: LightFrame::World }],
        lines: Lines::NONE,
        ..style("toon").expect("a style of this crate")
    }
}

/// The range of tones that count as correct for a diffuse term of `light`. Its ends differ where six tones cannot
/// represent a tone below the darkest one: that is as dark as one layer gets, while the product of several layers
/// reaches the tone itself.
pub fn asked(shade: &HatchShade, light: f64) -> [f64; 2] {
    let light = light.clamp(0.0, 1.0);
    let clamped = light.max(1.0 / 7.0);
    match (shade.encoding, shade.transfer) {
        (_, HatchTransfer::Listing4 { .. }) => [clamped; 2],
        (HatchEncoding::SixTones, HatchTransfer::Linear { .. }) => [light, clamped],
        (HatchEncoding::Thresholds, HatchTransfer::Linear { .. }) => [light; 2],
    }
}

/// A torus around the Y axis, with major radius 1 and minor radius 0.4 and with texture coordinates: three tiles around
/// the axis and one around the tube, so that there is no seam.
pub fn torus_with_uvs(around_axis: u32, around_tube: u32) -> Model {
    let mut model = Model { materials: vec![Material::default()], ..Model::default() };
    for j in 0..=around_tube {
        for i in 0..=around_axis {
            // The last step equals step 0 exactly.
            let angle = |step: u32, steps: u32| TAU * f64::from(step % steps) / f64::from(steps);
            let ((sin, cos), tube) = (angle(i, around_axis).sin_cos(), angle(j, around_tube));
            let outwards = DVec3::new(cos, 0.0, -sin);
            let normal = outwards * tube.cos() + DVec3::Y * tube.sin();
            model.positions.push((outwards + normal * 0.4).as_vec3());
            model.normals.push(normal.as_vec3());
            model.uvs.push(Vec2::new(3.0 * i as f32 / around_axis as f32, 1.0 - j as f32 / around_tube as f32));
        }
    }
    for j in 0..around_tube {
        for i in 0..around_axis {
            let (here, above) = (j * (around_axis + 1) + i, (j + 1) * (around_axis + 1) + i);
            model.faces.extend([[here, here + 1, above + 1], [here, above + 1, above]]);
        }
    }
    model.face_material = vec![0; model.faces.len()];
    model
}
