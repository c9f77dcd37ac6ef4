//! Shadow maps on a device.

use super::super::setup::{curve, faceted, limit, limit_at, side_by_side, states_image, stays_within, worst};
use super::super::{Axis, Finding};
use super::counts::{looking, on_ground, shot};
use crate::camera::{Camera, Projection};
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::gpu::{GpuContext, GpuRenderer};
use crate::plan::Plan;
use crate::scene::Scene;
use crate::shadow::ShadowMethod;
use crate::truth::shadows::{ShadowShot, States};
use crate::view::View;
use glam::{DMat4, DVec2, DVec3, Mat4};
use npr_imagespace::shadow::ShadowState;
use npr_mesh::{Material, embedded};

const SIZE: (u32, u32) = (240, 150);
/// The part of pictures that is shown, px.
const PART: (u32, u32) = (41, 10);
const PART_SIZE: (u32, u32) = (158, 130);

/// A device that keeps its pipelines.
pub(super) struct Device<'a> {
    context: &'a GpuContext,
    renderer: GpuRenderer<'a>,
}

impl<'a> Device<'a> {
    pub(super) fn new(context: &'a GpuContext) -> Self {
        Self { context, renderer: GpuRenderer::new(context) }
    }

    /// The shadow states that the device computes.
    fn states(&self, scene: &Scene, shot: &ShadowShot, method: ShadowMethod) -> Result<States, HarnessError> {
        let plan = Plan::new(scene, &shot.style(method), &View::new(shot.camera, SIZE), &self.context.usable())?;
        let targets = self.renderer.targets(&plan.view)?;
        let uploaded = self.renderer.upload(scene, &plan)?;
        self.renderer.draw(scene, &uploaded, &plan, &targets)?;
        let texels = self.renderer.read_texels(&targets)?.expect("the style has lines in the image");
        Ok(States::of_texels(&texels, SIZE))
    }
}

fn map(side: u32) -> ShadowMethod {
    ShadowMethod::Map { side }
}

/// A ring above the ground.
fn ring() -> Scene {
    let place = Mat4::from_translation(glam::Vec3::new(0.0, 1.1, 0.0)) * Mat4::from_rotation_x(1.1);
    on_ground(&embedded::placed(embedded::torus(0.75, 0.2, 32, 16), place, Material::default()), 2.5)
}

fn ring_shot(elevation_deg: f64) -> ShadowShot {
    let (sin, cos) = elevation_deg.to_radians().sin_cos();
    let to_light = DVec3::new(0.8 * cos, sin, 0.6 * cos);
    shot("ring", looking(DVec3::new(0.5, 2.8, 4.6), DVec3::new(-0.3, 0.5, 0.0), 42.0), to_light.extend(0.0))
}

pub(super) fn resolution(device: &Device<'_>) -> Result<Finding, HarnessError> {
    const SIDES: [u32; 6] = [128, 256, 512, 1024, 2048, 4096];
    let scene = ring();
    let shots = [35.0, 50.0, 65.0].map(ring_shot);
    let (mut by_map, mut by_volumes, mut images) = (SIDES.map(|side| (f64::from(side), 0.0)), 0.0, Vec::new());
    for shot in &shots {
        let right = States::by_rays(&scene, shot, SIZE, DVec2::ZERO)?;
        let share = |found: &States| found.difference(&right).share / shots.len() as f64;
        let mut closest = Vec::new();
        for (side, point) in SIDES.into_iter().zip(&mut by_map) {
            let found = device.states(&scene, shot, map(side))?;
            point.1 += share(&found);
            if side == 128 {
                closest.push(states_image(&found, PART, PART_SIZE));
            }
        }
        let found = device.states(&scene, shot, ShadowMethod::Volumes)?;
        by_volumes += share(&found);
        closest.push(states_image(&found, PART, PART_SIZE));
        images = closest;
    }
    let order = (by_map[0].1 / by_map[5].1).log2() / 5.0;
    let volumes = SIDES.map(|side| (f64::from(side), by_volumes)).to_vec();
    let curves = vec![
        curve(
            "shadow map",
            by_map.to_vec(),
            limit(
                "order in which the share of wrong pixels falls with the side, from 128 to 4096",
                order,
                Some((1.0, "borders are displaced by up to half a texel of 2 R / side")),
                Bound::AtLeast(0.7),
            ),
        ),
        curve("volumes", volumes, limit("share of wrong pixels", by_volumes, None, Bound::AtMost(0.001))),
    ];
    Ok(Finding {
        parameter: Axis::logarithmic("side of the shadow map", "texels"),
        error: Axis::logarithmic("share of the pixels with the wrong shadow", ""),
        curves,
        pictures: vec![("a map of 128 texels, and volumes".into(), side_by_side(&images))],
    })
}

/// The slits of the fence: their number, and the distance from one to the next.
const SLITS: u32 = 12;
const APART: f64 = 0.1607;
/// The side of the map. Everything is measured in its texels.
const SIDE: u32 = 128;

/// The left side of a slit.
fn slit_at(number: u32) -> f64 {
    (f64::from(number) - f64::from(SLITS) / 2.0) * APART + 0.013
}

/// A fence with slits of a width, of upright faces in the plane z = 0.
fn fence(width: f64) -> Scene {
    let mut triangles = Vec::new();
    let mut left = -1.2;
    for number in 0..=SLITS {
        let right = if number < SLITS { slit_at(number) } else { 1.2 };
        let corners = [(left, 0.1), (right, 0.1), (right, 1.1), (left, 1.1)];
        let [a, b, c, d] = corners.map(|(x, y)| DVec3::new(x, y, 0.0));
        triangles.extend([[a, b, c], [a, c, d]]);
        left = right + width;
    }
    on_ground(&faceted(&triangles), 2.0)
}

/// Light through the fence from behind, in the plane x = 0, so that slits run along the map's columns.
fn fence_shot() -> ShadowShot {
    let to_light = DVec3::new(0.0, 0.8, -0.6).extend(0.0);
    shot("fence", looking(DVec3::new(0.0, 3.0, 2.4), DVec3::new(0.0, 0.0, 0.6), 34.0), to_light)
}

/// The points of the ground in the middle of the strip of light behind each slit, in the picture.
fn strips_px(camera: &Camera, width: f64) -> Vec<(u32, u32, u32)> {
    let size_px = DVec2::new(SIZE.0.into(), SIZE.1.into());
    let clip_from_world: DMat4 = camera.clip_from_world(size_px.x / size_px.y);
    let px = |at: DVec3| {
        let clip = clip_from_world * at.extend(1.0);
        (DVec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * size_px
    };
    let strip = |number: u32| {
        // The foot of the light through the middle of a slit's height of 0.6.
        let [left, right] = [0.0, width].map(|by| px(DVec3::new(slit_at(number) + by, 0.0, 0.45)));
        (left.x.floor().max(0.0) as u32, right.x.ceil() as u32, left.y as u32)
    };
    (0..SLITS).map(strip).collect()
}

pub(super) fn gaps(device: &Device<'_>) -> Result<Finding, HarnessError> {
    const WIDTHS: [f64; 9] = [0.25, 0.5, 0.75, 0.9, 1.0, 1.1, 1.25, 1.5, 2.0];
    let shot = fence_shot();
    let texel = 2.0 * fence(0.01).radius() / f64::from(SIDE);
    let (mut points, mut images) = (Vec::new(), Vec::new());
    for width in WIDTHS {
        let scene = fence(width * texel);
        let found = device.states(&scene, &shot, map(SIDE))?;
        let is_lit = |x: u32, y: u32| found.states[(y * SIZE.0 + x) as usize] == Some(ShadowState::Lit);
        let strips = strips_px(&shot.camera, width * texel);
        let lost = strips.iter().filter(|&&(left, right, y)| !(left..=right).any(|x| is_lit(x, y)));
        points.push((width, lost.count() as f64 / f64::from(SLITS)));
        if width == 0.75 {
            let right = States::by_rays(&scene, &shot, SIZE, DVec2::ZERO)?;
            images = [&found, &right].map(|states| states_image(states, PART, PART_SIZE)).to_vec();
        }
    }
    let measured = stays_within(&points, 0.0);
    let limit = limit_at(
        "least width of a gap from which none is lost, texels",
        measured,
        Some((1.0, "a gap of a texel, 2 R / side, contains a texel's centre")),
        Bound::AtMost(1.15),
    );
    Ok(Finding {
        parameter: Axis::linear("width of the gaps", "texels of the shadow map"),
        error: Axis::linear("share of the gaps through which no light falls", ""),
        curves: vec![curve("shadow map", points, limit)],
        pictures: vec![("gaps of 0.75 texels: by a map, by rays".into(), side_by_side(&images))],
    })
}

/// A wall without thickness that stands on the ground.
fn wall() -> Scene {
    let corners = [(-1.0, 0.0), (1.0, 0.0), (1.0, 0.8), (-1.0, 0.8)].map(|(x, y)| DVec3::new(x, y, 0.0));
    let [a, b, c, d] = corners;
    on_ground(&faceted(&[[a, b, c], [a, c, d]]), 1.6)
}

/// The sine of the light's elevation behind the wall.
const ELEVATION_SIN: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// A parallel view of the ground in front of the wall, of a height across the view.
fn wall_shot(height: f64) -> ShadowShot {
    let to_light = DVec3::new(0.0, 1.0, -1.0).normalize().extend(0.0);
    shot("wall", above(height, height / 3.0), to_light)
}

/// A parallel view from 45° above onto a point of the ground.
fn above(height: f64, z: f64) -> Camera {
    let projection = Projection::Orthographic { height, far: 20.0 };
    let target = DVec3::Z * z;
    Camera { projection, ..looking(target + DVec3::new(0.0, 5.0, 5.0), target, 30.0) }
}

/// The position on the ground at a pixel.
fn on_the_ground(shot: &ShadowShot, x: u32, y: u32) -> DVec3 {
    let size_px = DVec2::new(SIZE.0.into(), SIZE.1.into());
    let (origin, direction) = shot.camera.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5), size_px);
    origin - direction * (origin.y / direction.y)
}

/// The mean distance on the ground from the wall's foot to its shadow, over the middle columns.
fn detached(states: &States, shot: &ShadowShot) -> f64 {
    let columns = SIZE.0 / 3..2 * SIZE.0 / 3;
    let step = on_the_ground(shot, 0, 1).z - on_the_ground(shot, 0, 0).z;
    let is_gap = |x: u32, y: u32| {
        let z = on_the_ground(shot, x, y).z;
        z > 0.0 && states.states[(y * SIZE.0 + x) as usize] == Some(ShadowState::Lit)
    };
    let gap = |x: u32| (0..SIZE.1).filter(|&y| is_gap(x, y)).count() as f64 * step;
    columns.clone().map(gap).sum::<f64>() / f64::from(columns.len() as u32)
}

pub(super) fn bias(device: &Device<'_>) -> Result<Finding, HarnessError> {
    const SIDES: [u32; 6] = [64, 128, 256, 512, 1024, 2048];
    let (scene, shot) = (wall(), wall_shot(0.15));
    let points: Result<Vec<_>, HarnessError> = SIDES
        .map(|side| {
            let found = device.states(&scene, &shot, map(side))?;
            Ok((f64::from(side), detached(&found, &shot) / scene.radius()))
        })
        .into_iter()
        .collect();
    let points = points?;
    let mut images = Vec::new();
    for method in [map(128), ShadowMethod::Volumes] {
        images.push(states_image(&device.states(&scene, &wall_shot(0.7), method)?, PART, PART_SIZE));
    }
    let by_volumes = device.states(&scene, &shot, ShadowMethod::Volumes)?;
    let none = detached(&by_volumes, &shot) / scene.radius();
    let volumes = SIDES.map(|side| (f64::from(side), none)).to_vec();
    let texels = points.iter().map(|(side, gap)| gap * side / 2.0);
    let measured = texels.sum::<f64>() / points.len() as f64;
    let curves = vec![
        curve(
            "shadow map",
            points,
            limit(
                "gap between a wall's foot and its shadow, texels, mean over all sides",
                measured,
                Some((ELEVATION_SIN, "tan e · cos e for a bias of a texel's slope on the wall and a light at e = 45°")),
                Bound::AtMost(0.9),
            ),
        ),
        curve(
            "volumes",
            volumes,
            limit("gap, in radii of the scene", none, Some((0.0, "exact")), Bound::AtMost(0.001)),
        ),
    ];
    Ok(Finding {
        parameter: Axis::logarithmic("side of the shadow map", "texels"),
        error: Axis::logarithmic("gap between a wall's foot and its shadow", "radii of the scene"),
        curves,
        pictures: vec![("a wall's shadow by a map of 128 texels, and by volumes".into(), side_by_side(&images))],
    })
}

/// A wall whose shadow ends at z = 1 on the ground in the middle, and farther to the right, so that its border crosses texels.
fn wall_for(elevation_tan: f64) -> Scene {
    let corners = [(-1.0, 0.0), (1.0, 0.0), (1.0, 1.3), (-1.0, 0.7)];
    let [a, b, c, d] = corners.map(|(x, y)| DVec3::new(x, y * elevation_tan, 0.0));
    on_ground(&faceted(&[[a, b, c], [a, c, d]]), 1.6)
}

/// The largest distance on the ground of a shadow's end from where it belongs, over the middle columns.
fn end_error(states: &States, shot: &ShadowShot) -> f64 {
    let step = on_the_ground(shot, 0, 1).z - on_the_ground(shot, 0, 0).z;
    let error = |x: u32| {
        let far = (0..SIZE.1).filter(|&y| {
            on_the_ground(shot, x, y).z > 0.4 && states.states[(y * SIZE.0 + x) as usize] == Some(ShadowState::Cast)
        });
        let right = 1.0 + 0.3 * on_the_ground(shot, x, 0).x;
        (0.4 + far.count() as f64 * step - right).abs()
    };
    (SIZE.0 / 3..2 * SIZE.0 / 3).map(error).fold(0.0, f64::max)
}

pub(super) fn grazing(device: &Device<'_>) -> Result<Finding, HarnessError> {
    const ELEVATIONS_DEG: [f64; 6] = [9.0, 12.0, 16.0, 22.0, 35.0, 50.0];
    let (mut by_map, mut by_volumes, mut images) = (Vec::new(), Vec::new(), Vec::new());
    let mut predicted = 0.0;
    for elevation_deg in ELEVATIONS_DEG {
        let (sin, cos) = f64::to_radians(elevation_deg).sin_cos();
        let scene = wall_for(sin / cos);
        let light = DVec3::new(0.0, sin, -cos).extend(0.0);
        let shot = shot("wall", above(1.3, 0.9), light);
        for (points, method) in [(&mut by_map, map(SIDE)), (&mut by_volumes, ShadowMethod::Volumes)] {
            let found = device.states(&scene, &shot, method)?;
            points.push((elevation_deg, end_error(&found, &shot)));
            if elevation_deg == ELEVATIONS_DEG[0] {
                images.push(states_image(&found, PART, PART_SIZE));
            }
        }
        if elevation_deg == ELEVATIONS_DEG[0] {
            predicted = scene.radius() / f64::from(SIDE) / sin;
        }
    }
    let (at, most) = (by_map[0].1, worst(&by_volumes));
    let curves = vec![
        curve(
            "shadow map of 128 texels",
            by_map,
            limit(
                "error of a shadow's end by a light at 9°, in lengths of the shadow",
                at,
                Some((predicted, "half a texel, R / side, over sin e")),
                Bound::AtMost(0.13),
            ),
        ),
        // A pixel is 0.012 of the length.
        curve("volumes", by_volumes, limit("largest error at any elevation", most, None, Bound::AtMost(0.02))),
    ];
    Ok(Finding {
        parameter: Axis::logarithmic("elevation of the light above the ground", "degrees"),
        error: Axis::logarithmic("error of a shadow's end", "lengths of the shadow"),
        curves,
        pictures: vec![("a light at 9°: a map of 128 texels, volumes".into(), side_by_side(&images))],
    })
}
