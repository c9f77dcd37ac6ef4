//! Accuracy of shadows and their outlines: shadow states of pixels against shadow rays, lines against shadow borders.

use super::{ROUNDED_PX, SHIFT_PX};
use crate::camera::{Camera, Framing, Projection};
use crate::capabilities::Capabilities;
use crate::cpu::{self, CpuOptions, PrimaryHits, Seen};
use crate::error::HarnessError;
#[cfg(feature = "gpu")]
use crate::gpu::{GpuContext, GpuRenderer};
use crate::image_lines::ImageInk;
use crate::lights::{LightFrame, StyleLight, casting_light};
use crate::picture::Image;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::shade::Shade;
use crate::shadow::cpu::ShadowAt;
use crate::shadow::plan::casts;
use crate::shadow::{ShadowLines, ShadowMethod, ShadowStyle};
#[cfg(feature = "gpu")]
use crate::shadow::{ShadowTechnique, VolumeMethod};
use crate::style::{Lines, Style, style};
use crate::view::View;
use glam::{DVec2, DVec3, UVec2, Vec3};
use npr_imagespace::composite::Composite;
use npr_imagespace::format::texel::{TexelLayout, ink_texel64_tap};
use npr_imagespace::shadow::{ShadowState, ink_shadow_state};
use npr_outline::segment::MAX_SLOPE;
use npr_toon::source::{Light, LightKind};

/// A light and a view.
#[derive(Clone, Debug)]
pub struct ShadowShot {
    /// The name of the light and view, as printed.
    pub name: &'static str,
    /// The light.
    pub light: StyleLight,
    /// The view.
    pub camera: Camera,
}

/// Eight lights and views around a model: distant and near lights, perspective and parallel views, front and back
/// lighting, two of them with the eye in shadow (which [`eye_is_in_shadow`] tests for a model).
pub fn shots(scene: &Scene, aspect: f64) -> Vec<ShadowShot> {
    let far = |to_light: [f32; 3]| Light::directional(Vec3::from(to_light));
    let near = |position: [f32; 3]| Light::positional(Vec3::from(position));
    let case = |name, light, (yaw_deg, pitch_deg, fov_y_deg): (f64, f64, Option<f64>)| ShadowShot {
        name,
        light: StyleLight { light, frame: LightFrame::View },
        camera: Camera::framed(
            scene.corners(),
            aspect,
            &Framing {
                yaw_rad: yaw_deg.to_radians(),
                pitch_rad: pitch_deg.to_radians(),
                fov_y_rad: fov_y_deg.map(f64::to_radians),
                ..Framing::default()
            },
        ),
    };
    vec![
        case("left", far([-0.75, 0.95, 0.35]), (30.0, 20.0, Some(35.0))),
        case("right, low", far([0.9, 0.25, 0.4]), (150.0, -10.0, Some(35.0))),
        case("above", far([0.1, 1.0, 0.05]), (270.0, 50.0, Some(60.0))),
        case("parallel", far([-0.6, 0.5, 0.7]), (200.0, 35.0, None)),
        case("lamp", near([-1.4, 1.2, 0.8]), (75.0, 25.0, Some(35.0))),
        case("lamp, parallel", near([1.1, 1.5, 0.4]), (-40.0, 10.0, None)),
        behind(scene, case("behind", far([0.0, 0.0, -1.0]), (10.0, 12.0, Some(35.0)))),
        behind(scene, case("lamp behind", near([0.0, 0.0, -2.2]), (-60.0, 15.0, Some(45.0)))),
    ]
}

/// Rotates a light behind the model as far to the side as the eye stays in shadow, so that some visible surfaces are
/// lit.
fn behind(scene: &Scene, shot: ShadowShot) -> ShadowShot {
    let turned = |angle_deg: f64, around: u32| {
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        let aside = DVec2::from_angle(f64::from(around) / 16.0 * std::f64::consts::TAU) * sin;
        let to_light = DVec3::new(aside.x, aside.y, -cos).as_vec3();
        let place = match shot.light.light.place {
            LightKind::Directional { .. } => LightKind::Directional { to_light },
            LightKind::Positional { position } => LightKind::Positional { position: to_light * position.length() },
        };
        ShadowShot { light: StyleLight { light: Light { place, ..shot.light.light }, ..shot.light }, ..shot.clone() }
    };
    let angles = (0..40u32).rev().map(|step| 2.0 * f64::from(step));
    let mut all = angles.flat_map(|angle_deg| (0..16).map(move |around| (angle_deg, around)));
    let found = all.find(|&(angle_deg, around)| eye_is_in_shadow(scene, &turned(angle_deg, around)));
    found.map_or(shot.clone(), |(angle_deg, around)| turned(angle_deg, around))
}

/// Whether an occluder lies between the eye and the light.
pub fn eye_is_in_shadow(scene: &Scene, shot: &ShadowShot) -> bool {
    if matches!(shot.camera.projection, Projection::Orthographic { .. }) {
        return false;
    }
    let light = casting_light(&[shot.light], scene, &shot.camera);
    let way = light.truncate() - shot.camera.eye * light.w;
    let range = (0.0, if light.w == 0.0 { f64::INFINITY } else { 1.0 });
    scene.any(shot.camera.eye, way, range, |hit| casts(scene, hit))
}

impl ShadowShot {
    /// A style with lines of objects in black and of shadows in red, on white.
    pub fn style(&self, method: ShadowMethod) -> Style {
        let red = Composite::Over { color: Vec3::X, opacity: 1.0 };
        let ink = ImageInk { shadows: ShadowLines::Separate { composite: red, dilation: None }, ..ImageInk::default() };
        Style {
            shade: Shade::Paper,
            paper: Vec3::ONE,
            lights: vec![self.light],
            shadow: Some(ShadowStyle { method, ..ShadowStyle::default() }),
            lines: Lines::image(ink),
            ..style("shadow-lines").expect("a style of this crate")
        }
    }
}

/// The shadow states of a picture's pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct States {
    /// Px.
    pub size: (u32, u32),
    /// `None` for background.
    pub states: Vec<Option<ShadowState>>,
}

/// The difference of shadow states from a reference.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StatesDifference {
    /// The fraction of all pixels that show a surface in both and differ.
    pub share: f64,
    /// The largest distance of such a pixel from the nearest state border in the reference, px.
    pub farthest_px: f64,
    /// The fraction of all pixels that are lit in the reference, but not here, and lie more than 2 px from a border:
    /// shadow acne.
    pub acne: f64,
    /// The same for pixels in a cast shadow that are lit here: detached shadows (peter-panning).
    pub loose: f64,
}

impl States {
    /// The states in a 64-bit packed G-buffer.
    pub fn of_texels(texels: &[[u32; 2]], size: (u32, u32)) -> Self {
        let layout = TexelLayout::Bits64;
        let state = |&texel: &[u32; 2]| {
            let region = ink_texel64_tap(texel).region;
            (region != 0).then(|| ink_shadow_state(region, layout))
        };
        Self { size, states: texels.iter().map(state).collect() }
    }

    /// The states by shadow rays, for the shot's own style with any method, sampled at an offset from the pixel
    /// centres.
    ///
    /// # Errors
    /// Those of [`Plan::new`].
    pub fn by_rays(scene: &Scene, shot: &ShadowShot, size: (u32, u32), shift_px: DVec2) -> Result<Self, HarnessError> {
        let style = shot.style(ShadowMethod::Volumes);
        let plan = Plan::new(scene, &style, &View::new(shot.camera, size), &Capabilities::RAY_CASTER)?;
        let options = CpuOptions { shift_px, ..CpuOptions::default() };
        let frame = cpu::render(scene, &plan, &options, &|_| {});
        Ok(Self::of_texels(&frame.texels, size))
    }

    fn is_inside(&self, x: i64, y: i64) -> bool {
        (0..i64::from(self.size.0)).contains(&x) && (0..i64::from(self.size.1)).contains(&y)
    }

    fn at(&self, x: i64, y: i64) -> Option<ShadowState> {
        self.states[(y * i64::from(self.size.0) + x) as usize]
    }

    /// The distance of a pixel from the nearest border between states of surfaces, or from the surface's own border,
    /// px; at most `most`.
    fn border_px(&self, x: i64, y: i64, most: i64) -> f64 {
        let mut nearest = most as f64;
        for dy in -most..=most {
            for dx in -most..=most {
                let (x, y) = (x + dx, y + dy);
                let differs = |(i, j)| self.is_inside(x + i, y + j) && self.at(x + i, y + j) != self.at(x, y);
                if self.is_inside(x, y) && [(1, 0), (0, 1)].into_iter().any(differs) {
                    // The border lies between this pixel and the next.
                    nearest = nearest.min(((dx * dx + dy * dy) as f64).sqrt());
                }
            }
        }
        nearest
    }

    /// The difference from a reference.
    ///
    /// # Panics
    /// If the sizes differ.
    pub fn difference(&self, reference: &Self) -> StatesDifference {
        assert_eq!(self.size, reference.size);
        const MOST: i64 = 12;
        let mut found = StatesDifference::default();
        let one = 1.0 / self.states.len().max(1) as f64;
        for y in 0..i64::from(self.size.1) {
            for x in 0..i64::from(self.size.0) {
                let (Some(here), Some(there)) = (self.at(x, y), reference.at(x, y)) else { continue };
                if here == there {
                    continue;
                }
                let border_px = reference.border_px(x, y, MOST);
                found.share += one;
                found.farthest_px = found.farthest_px.max(border_px);
                if border_px > 2.0 {
                    match (there, here) {
                        (ShadowState::Lit, _) => found.acne += one,
                        (ShadowState::Cast, ShadowState::Lit) => found.loose += one,
                        _ => {}
                    }
                }
            }
        }
        found
    }
}

/// The states that a GPU computes. `volumes` overrides the plan's choice of who selects what bounds the volumes.
///
/// # Errors
/// [`HarnessError`].
#[cfg(feature = "gpu")]
pub fn states_on_device(
    context: &GpuContext,
    scene: &Scene,
    shot: &ShadowShot,
    method: ShadowMethod,
    volumes: Option<VolumeMethod>,
    size: (u32, u32),
) -> Result<States, HarnessError> {
    let style = shot.style(method);
    let mut plan = Plan::new(scene, &style, &View::new(shot.camera, size), &context.usable())?;
    if let (Some(volumes), Some(ShadowTechnique::Volumes { method, .. })) =
        (volumes, plan.shadow.as_mut().map(|shadow| &mut shadow.technique))
    {
        *method = volumes;
    }
    let renderer = GpuRenderer::new(context);
    let targets = renderer.targets(&plan.view)?;
    let uploaded = renderer.upload(scene, &plan)?;
    renderer.draw(scene, &uploaded, &plan, &targets)?;
    let texels = renderer.read_texels(&targets)?.expect("the style has lines in the image");
    Ok(States::of_texels(&texels, size))
}

/// The largest distance, from an edge in the reference, of the pixels that differ. Pixels with an edge through their
/// centre are excluded: those whose state changes, or whose depth changes by more than a slope of [`MAX_SLOPE`]
/// explains, when the reference's sample is shifted by [`SHIFT_PX`], or by [`ROUNDED_PX`], to which GPUs round corners.
/// A GPU may show the neighbouring surface or state there.
///
/// # Errors
/// Those of [`Plan::new`].
pub fn farthest_px(scene: &Scene, shot: &ShadowShot, actual: &States, reference: &States) -> Result<f64, HarnessError> {
    let at_once = actual.difference(reference).farthest_px;
    // All differing pixels are near an edge.
    if at_once <= 2.0 {
        return Ok(at_once);
    }
    let style = shot.style(ShadowMethod::Volumes);
    let (width, height) = reference.size;
    let plan = Plan::new(scene, &style, &View::new(shot.camera, reference.size), &Capabilities::RAY_CASTER)?;
    let render = |shift_px| {
        let options = CpuOptions { shift_px, ..CpuOptions::default() };
        cpu::render(scene, &plan, &options, &|_| {})
    };
    let here = render(DVec2::ZERO).depth;
    let view = shot.camera.line_view(DVec2::new(width.into(), height.into()));
    let mut kept = actual.clone();
    for (by_px, directions) in [(SHIFT_PX, 8u8), (ROUNDED_PX, 16)] {
        for direction in 0..directions {
            let angle = f64::from(direction) / f64::from(directions) * std::f64::consts::TAU;
            let moved = render(by_px * DVec2::from_angle(angle));
            let states = States::of_texels(&moved.texels, reference.size).states;
            for (pixel, kept) in kept.states.iter_mut().enumerate() {
                let (a, b) = (here[pixel], moved.depth[pixel]);
                let per_px = a.max(b) * view.depth_per_px.x + view.depth_per_px.y;
                let another = (a - b).abs() > MAX_SLOPE * by_px * per_px;
                *kept = kept.filter(|_| !another && states[pixel] == reference.states[pixel]);
            }
        }
    }
    Ok(kept.difference(reference).farthest_px)
}

/// Points on the borders between lit and cast-shadow areas, px; exact to half a subsample.
///
/// They lie between neighbouring samples of a grid of `samples`² per pixel, of which one is lit and the other in a cast
/// shadow, and both on one surface: each within two grid steps of the plane of the other's face. Otherwise the border
/// is that of an object.
///
/// # Errors
/// Those of [`Plan::new`].
pub fn true_borders(
    scene: &Scene,
    shot: &ShadowShot,
    style: &Style,
    size: (u32, u32),
    samples: u32,
) -> Result<Vec<DVec2>, HarnessError> {
    let fine = (size.0 * samples, size.1 * samples);
    let view = View::new(shot.camera, fine);
    let plan = Plan::new(scene, style, &view, &Capabilities::RAY_CASTER)?;
    let seen = cpu::seen(&PrimaryHits::new(scene, view), &plan, &CpuOptions::default());
    let fine_px = DVec2::new(fine.0.into(), fine.1.into());
    let plane = |face: u32| {
        let [a, b, c] = scene.single().model().faces[face as usize]
            .map(|v| scene.single().model().positions[v as usize].as_dvec3());
        ((b - a).cross(c - a).normalize_or_zero(), a)
    };
    // The distance of a sample from the plane of another's face.
    let off = |face: u32, other: DVec3| {
        let (normal, on) = plane(face);
        normal.dot(other - on).abs()
    };
    let step = |at: DVec3| {
        let depth = (at - shot.camera.eye).dot(-shot.camera.axes()[2]);
        let (o, d) = shot.camera.ray(fine_px / 2.0, fine_px);
        let (p, e) = shot.camera.ray(fine_px / 2.0 + DVec2::X, fine_px);
        (o + d * depth).distance(p + e * depth)
    };
    let mut borders = Vec::new();
    for y in 0..fine.1 {
        for x in 0..fine.0 {
            let Some(Seen { shadow: ShadowAt { state, .. }, face, at, .. }) = seen[(y * fine.0 + x) as usize] else {
                continue;
            };
            for (dx, dy) in [(1, 0), (0, 1)] {
                if x + dx >= fine.0 || y + dy >= fine.1 {
                    continue;
                }
                let Some(Seen { shadow: ShadowAt { state: other, .. }, face: of, at: there, .. }) =
                    seen[((y + dy) * fine.0 + x + dx) as usize]
                else {
                    continue;
                };
                let pair = [state, other];
                if !(pair.contains(&ShadowState::Lit) && pair.contains(&ShadowState::Cast)) {
                    continue;
                }
                let most = 2.0 * step(at);
                if off(face, there) <= most && off(of, at) <= most {
                    let middle = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)
                        + DVec2::new(f64::from(dx), f64::from(dy)) / 2.0;
                    borders.push(middle / f64::from(samples));
                }
            }
        }
    }
    Ok(borders)
}

/// Precision and recall of shadow lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowLineAccuracy {
    /// The fraction of the pixels with only shadow lines that are within the distance of a border; 1 without any.
    pub precision: f64,
    /// The fraction of the border points with a line pixel, of a shadow or of an object that ends there, within the
    /// distance; 1 without any.
    pub recall: f64,
    /// The number of pixels and of points.
    pub counts: (usize, usize),
}

/// Measures the lines of a picture in [`ShadowShot::style`].
pub fn line_accuracy(picture: &Image, borders: &[DVec2], within_px: f64) -> ShadowLineAccuracy {
    let (width, height) = (picture.width, picture.height);
    let is_line = |pixel: &[u8]| pixel[1] < 128;
    let is_shadows = |pixel: &[u8]| is_line(pixel) && pixel[0] > 128;
    let pixels: Vec<&[u8]> = picture.rgba8.chunks_exact(4).collect();
    let reach = within_px.ceil() as i64 + 1;
    // The border points, by the pixel that contains them.
    let mut by_pixel = vec![Vec::new(); pixels.len()];
    let cell = |point: DVec2| {
        let at = point.floor().clamp(DVec2::ZERO, DVec2::new(width.into(), height.into()) - 1.0).as_uvec2();
        (at.y * width + at.x) as usize
    };
    for &point in borders {
        by_pixel[cell(point)].push(point);
    }
    let around = |at: UVec2| {
        let range = |at: u32, size: u32| {
            (i64::from(at) - reach).max(0) as u32..(i64::from(at) + reach + 1).min(size.into()) as u32
        };
        range(at.y, height).flat_map(move |y| range(at.x, width).map(move |x| UVec2::new(x, y)))
    };
    let centre = |at: UVec2| at.as_dvec2() + 0.5;
    let index = |at: UVec2| (at.y * width + at.x) as usize;
    let (mut drawn, mut right) = (0, 0);
    for (number, pixel) in pixels.iter().enumerate() {
        if is_shadows(pixel) {
            let at = UVec2::new(number as u32 % width, number as u32 / width);
            drawn += 1;
            let near = |point: &DVec2| point.distance(centre(at)) <= within_px;
            right += usize::from(around(at).any(|beside| by_pixel[index(beside)].iter().any(near)));
        }
    }
    let found = borders.iter().filter(|&&point| {
        let at = UVec2::new(cell(point) as u32 % width, cell(point) as u32 / width);
        around(at).any(|beside| is_line(pixels[index(beside)]) && centre(beside).distance(point) <= within_px)
    });
    let found = found.count();
    let share = |part: usize, whole: usize| if whole == 0 { 1.0 } else { part as f64 / whole as f64 };
    ShadowLineAccuracy {
        precision: share(right, drawn),
        recall: share(found, borders.len()),
        counts: (drawn, borders.len()),
    }
}
