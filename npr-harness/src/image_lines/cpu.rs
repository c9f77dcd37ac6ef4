//! Image-space lines on the CPU: the packed G-buffer value of a pixel, and the ink over the picture.

use super::gbuffer::style::Show;
use super::gbuffer::texel::{self, GBufferTexel, gbuffer_pack};
use super::plan::ImagePlan;
use crate::color::encode_rgb;
use crate::cpu::frame::CpuFrame;
use crate::shadow::ShadowLines;
use crate::shadow::cpu::ShadowAt;
use glam::{DMat3, DVec3, DVec4, UVec2, Vec3};
use npr_imagespace::artist::{ArtistRotation, LineKind, ink_artist_direction, ink_artist_index, ink_artist_texel};
use npr_imagespace::composite::ink_composite;
use npr_imagespace::format::texel::{
    BACKGROUND, TexelLayout, ink_fold_region, ink_texel32_bits, ink_texel32_pack, ink_texel32_tap, ink_texel64_bits,
    ink_texel64_pack, ink_texel64_tap,
};
use npr_imagespace::region::{ink_region_of_color, ink_region_pair};
use npr_imagespace::resample::resample;
use npr_imagespace::shadow::{ShadowState, ink_shadow_background, ink_shadow_normal, ink_shadow_region};

/// The attributes of a surface point that image-space lines use.
pub(crate) struct InkSample<'a> {
    pub(crate) region: u32,
    /// The source of the material's inner lines.
    pub(crate) kind: LineKind,
    /// World space, of any length, on the viewer's side.
    pub(crate) normal: DVec3,
    /// Eye depth.
    pub(crate) depth: f64,
    /// The linear vertex colour, evaluated if inner lines come from vertex colours.
    pub(crate) vertex_color: &'a dyn Fn() -> DVec4,
    /// The linear filtered texture colour, evaluated if inner lines come from a texture.
    pub(crate) texture_color: &'a dyn Fn() -> DVec4,
    /// The bytes of the nearest texel, evaluated if regions come from a texture; `None` without a texture.
    pub(crate) texture_bytes: &'a dyn Fn() -> Option<[u8; 3]>,
    /// How the directions of an artist's lines are rotated.
    pub(crate) rotation: ArtistRotation,
    /// The vector from the eye to the point, or to the middle of its object if directions are rotated per object: of any
    /// length, in world space. Evaluated if inner lines come from an artist's colours.
    pub(crate) from_eye: &'a dyn Fn() -> DVec3,
    /// For each corner of the face: the barycentric weight, the linear vertex colour, and the vector from the eye.
    /// Evaluated if directions are rotated per vertex.
    pub(crate) corners: &'a dyn Fn() -> [(f64, DVec4, DVec3); 3],
    /// The right, up and back axes of the view, in world space.
    pub(crate) view_axes: [DVec3; 3],
    /// The shadow state, evaluated if shadows have lines.
    pub(crate) shadow: &'a dyn Fn() -> ShadowAt,
}

/// The packed G-buffer value of a pixel; `None` is background.
pub(crate) fn texel(image: &ImagePlan, sample: Option<&InkSample<'_>>) -> [u32; 2] {
    let Some(sample) = sample else { return BACKGROUND };
    let (region, normal, shadow) = attributes(image, sample);
    let region = if image.ink.shadows.has_states() {
        let folded = ink_fold_region(region, image.ink.region_max());
        ink_shadow_region(folded, shadow.state as u32, image.ink.layout)
    } else {
        region
    };
    let depth = sample.depth as f32;
    match image.ink.layout {
        TexelLayout::Bits32 => [ink_texel32_pack(normal, region, depth, &image.code), 0],
        TexelLayout::Bits64 => ink_texel64_pack(normal, region, depth, &image.code),
    }
}

/// The packed G-buffer value of the ground: background, with a shadow state where shadows have lines by their states.
pub(crate) fn texel_of_ground(image: &ImagePlan, shadow: ShadowAt) -> [u32; 2] {
    if !image.ink.shadows.has_states() {
        return BACKGROUND;
    }
    let number = ink_shadow_background(shadow.state as u32, image.ink.layout);
    match image.ink.layout {
        TexelLayout::Bits32 => [ink_texel32_bits(Vec3::Y, number, 0), 0],
        TexelLayout::Bits64 => ink_texel64_bits(Vec3::Y, number, 0),
    }
}

/// The unquantised texel of a pixel; `None` is background.
pub(crate) fn gbuffer_texel(image: &ImagePlan, sample: Option<&InkSample<'_>>) -> GBufferTexel {
    let Some(sample) = sample else { return texel::BACKGROUND };
    let (region, normal, shadow) = attributes(image, sample);
    let negated = image.ink.shadows == ShadowLines::Negated && shadow.negated;
    gbuffer_pack(normal, ink_fold_region(region, image.ink.region_max()), sample.depth as f32, negated)
}

/// Region, normal and shadow of a surface point; the normal is negated where the style does so.
fn attributes(image: &ImagePlan, sample: &InkSample<'_>) -> (u32, Vec3, ShadowAt) {
    let kind = sample.kind;
    let shadow = if image.ink.shadows == ShadowLines::None { ShadowAt::default() } else { (sample.shadow)() };
    let negated = image.ink.shadows == ShadowLines::Negated && kind == LineKind::Normals && shadow.negated;
    let normal = ink_shadow_normal(normal(sample).as_vec3(), negated);
    let of_face = sample.region;
    let of_texture = if kind == LineKind::Regions { (sample.texture_bytes)() } else { None };
    let region = of_texture.map_or(of_face, |rgb| ink_region_pair(of_face, ink_region_of_color(rgb)));
    (region, normal, shadow)
}

/// The normal for line detection in world space, of any length; zero if there is none.
fn normal(sample: &InkSample<'_>) -> DVec3 {
    let index_of_color = |linear: DVec4| ink_artist_index(encode_rgb(linear.truncate()).as_vec3());
    let index = match sample.kind {
        LineKind::Normals => return sample.normal,
        LineKind::Regions | LineKind::None => return DVec3::ZERO,
        LineKind::VertexColor if sample.rotation == ArtistRotation::PerVertex => {
            let direction = |(weight, color, from_eye)| weight * artist_normal(index_of_color(color), from_eye, sample);
            return (sample.corners)().map(direction).into_iter().sum();
        }
        LineKind::VertexColor => index_of_color((sample.vertex_color)()),
        LineKind::Texture => {
            let linear = (sample.texture_color)();
            ink_artist_texel(encode_rgb(linear.truncate()).as_vec3().extend(linear.w as f32))
        }
    };
    artist_normal(index, (sample.from_eye)(), sample)
}

/// The world-space direction for an index and a world-space vector from the eye.
fn artist_normal(index: u32, from_eye: DVec3, sample: &InkSample<'_>) -> DVec3 {
    let [right, up, back] = sample.view_axes;
    let world_from_view = DMat3::from_cols(right, up, back);
    let from_eye = (world_from_view.transpose() * from_eye).as_vec3();
    world_from_view * ink_artist_direction(index, from_eye).as_dvec3()
}

/// A perturbation of a pixel by the rounding of a rasteriser.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Perturbation {
    /// A value unlike its neighbours: background on a surface, or a surface on background.
    Other,
    /// The same surface with another shadow state.
    State(ShadowState),
}

impl Perturbation {
    fn on(self, texel: [u32; 2], layout: TexelLayout) -> [u32; 2] {
        match self {
            Self::Other if texel == BACKGROUND => [u32::MAX; 2],
            Self::Other => BACKGROUND,
            Self::State(_) if texel == BACKGROUND => BACKGROUND,
            Self::State(state) => {
                let shadowed = |region: u32| ink_shadow_region(region & !layout.shadow_bits(), state as u32, layout);
                match layout {
                    TexelLayout::Bits32 => {
                        let tap = ink_texel32_tap(texel[0]);
                        [ink_texel32_bits(tap.normal.as_vec3(), shadowed(tap.region), tap.depth as u32), 0]
                    }
                    TexelLayout::Bits64 => {
                        let tap = ink_texel64_tap(texel);
                        ink_texel64_bits(tap.normal.as_vec3(), shadowed(tap.region), tap.depth as u32)
                    }
                }
            }
        }
    }
}

/// Draws the lines of a frame after perturbing some of its pixels.
pub(crate) fn perturbed(image: &ImagePlan, blank: &CpuFrame, pixels: &[usize], perturbation: Perturbation) -> CpuFrame {
    let mut frame = blank.clone();
    let size = image.size;
    for &pixel in pixels {
        let (x, y) = (pixel as u32 % frame.width, pixel as u32 / frame.width);
        let along = |at: u32, of: u32, ink: u32| at * ink / of..((at + 1) * ink).div_ceil(of);
        for row in along(y, frame.height, size.1) {
            for column in along(x, frame.width, size.0) {
                let at = row as usize * size.0 as usize + column as usize;
                if let Some(gbuffer) = &image.gbuffer {
                    let texel = &mut frame.gbuffer[at];
                    let is_background = *texel == texel::BACKGROUND;
                    let unlike = gbuffer_pack(Vec3::NEG_ONE, image.ink.region_max(), gbuffer.range.near, false);
                    *texel = if is_background { unlike } else { texel::BACKGROUND };
                    continue;
                }
                let texel = &mut frame.texels[at];
                *texel = perturbation.on(*texel, image.ink.layout);
            }
        }
    }
    draw_ink(image, &mut frame);
    frame
}

/// Finds lines in the frame's G-buffer and draws them over the frame.
pub(crate) fn draw_ink(image: &ImagePlan, frame: &mut CpuFrame) {
    let size = image.size;
    let picture = UVec2::new(frame.width, frame.height);
    if let Some(gbuffer) = image.gbuffer.as_ref().filter(|gbuffer| gbuffer.gbuffer.show != Show::Lines) {
        gbuffer.show(frame);
        return;
    }
    for lines in image.passes() {
        let ink = match &image.gbuffer {
            Some(gbuffer) => lines.dilated(gbuffer.ink(&frame.gbuffer, UVec2::from(size)), UVec2::from(size)),
            None => image.ink(lines, &frame.texels),
        };
        let ink = if size == (frame.width, frame.height) {
            ink
        } else {
            resample(&ink, UVec2::from(size), picture).expect("one ink for each of its pixels")
        };
        for (color, ink) in frame.color.iter_mut().zip(ink) {
            if ink > 0 {
                let inked = ink_composite(color.truncate(), f64::from(ink) / 255.0, &lines.composite);
                *color = inked.extend(color.w);
            }
        }
    }
}
