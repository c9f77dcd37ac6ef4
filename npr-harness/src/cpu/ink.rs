//! Lines in the image on the CPU: the texels that a geometry pass would write, and the ink over the picture.

use super::shadow::ShadowAt;
use super::{CpuFrame, FrameContext};
use crate::color::encode_rgb;
use crate::image_ink::ImagePlan;
use crate::rays::Hit;
use crate::shadow::ShadowLines;
use glam::{DMat3, DVec3, UVec2, Vec3};
use npr_imagespace::artist::{LineKind, ink_artist_direction, ink_artist_index, ink_artist_texel};
use npr_imagespace::composite::ink_composite;
use npr_imagespace::format::texel::{
    BACKGROUND, TexelLayout, ink_fold_region, ink_narrow_pack, ink_narrow_tap, ink_narrow_word, ink_wide_pack,
    ink_wide_tap, ink_wide_words,
};
use npr_imagespace::region::{ink_region_of_color, ink_region_pair};
use npr_imagespace::resample::resample;
use npr_imagespace::shadow::{ShadowState, ink_shadow_normal, ink_shadow_region};

impl FrameContext<'_> {
    /// What a geometry pass writes for a pixel.
    pub(super) fn texel(&self, hit: Option<&Hit>, x: u32, y: u32) -> [u32; 2] {
        let (Some(image), Some(hit)) = (&self.plan.image, hit) else { return BACKGROUND };
        let kind = self.line_kind(hit);
        let shadow = if image.ink.shadows == ShadowLines::None { ShadowAt::default() } else { self.shadow_at(hit) };
        let negated = image.ink.shadows == ShadowLines::Negated && kind == LineKind::Normals && shadow.negated;
        let normal = ink_shadow_normal(self.texel_normal(hit, kind, x, y).as_vec3(), negated);
        let of_face = image.face_region[hit.face as usize];
        let region = match (kind, self.texture_bytes(hit, kind)) {
            (LineKind::Regions, Some(rgb)) => ink_region_pair(of_face, ink_region_of_color(rgb)),
            _ => of_face,
        };
        let region = if image.ink.shadows.has_states() {
            let folded = ink_fold_region(region, image.ink.region_most());
            ink_shadow_region(folded, shadow.state as u32, image.ink.layout)
        } else {
            region
        };
        match image.ink.layout {
            TexelLayout::Narrow => [ink_narrow_pack(normal, region, hit.t as f32, &image.code), 0],
            TexelLayout::Wide => ink_wide_pack(normal, region, hit.t as f32, &image.code),
        }
    }

    /// World space, of any length; zero for no normal.
    fn texel_normal(&self, hit: &Hit, kind: LineKind, x: u32, y: u32) -> DVec3 {
        let index = match kind {
            LineKind::Normals => return self.interpolate(hit, hit.barycentric).normal,
            LineKind::Regions | LineKind::None => return DVec3::ZERO,
            LineKind::VertexColor => ink_artist_index(encode_rgb(self.vertex_color(hit).truncate()).as_vec3()),
            LineKind::Texture => {
                let linear = self.texture_color(hit, x, y);
                ink_artist_texel(encode_rgb(linear.truncate()).as_vec3().extend(linear.w as f32))
            }
        };
        let world_from_view = DMat3::from_cols_array_2d(&self.camera.axes().map(|axis| axis.to_array()));
        let direction = self.rays.through(self.sample_point(f64::from(x), f64::from(y))).1;
        let eye_to_point: Vec3 = (world_from_view.transpose() * direction).as_vec3();
        world_from_view * ink_artist_direction(index, eye_to_point).as_dvec3()
    }

    /// The colour of the texel under a hit, not filtered, of materials whose regions a texture says.
    fn texture_bytes(&self, hit: &Hit, kind: LineKind) -> Option<[u8; 3]> {
        let texture = self.material(hit).texture?;
        (kind == LineKind::Regions)
            .then(|| self.textures[texture as usize].nearest_bytes(self.interpolate_uv(hit, hit.barycentric)))
    }
}

/// What a pixel may show instead, to a rasteriser that rounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Blot {
    /// What differs from all around it: background where there is a surface, a surface where there is background.
    Other,
    /// The same surface in another state of shadow.
    State(ShadowState),
}

impl Blot {
    fn on(self, texel: [u32; 2], layout: TexelLayout) -> [u32; 2] {
        match self {
            Self::Other if texel == BACKGROUND => [u32::MAX; 2],
            Self::Other => BACKGROUND,
            Self::State(_) if texel == BACKGROUND => BACKGROUND,
            Self::State(state) => {
                let shadowed = |region: u32| ink_shadow_region(region & !layout.shadow_bits(), state as u32, layout);
                match layout {
                    TexelLayout::Narrow => {
                        let tap = ink_narrow_tap(texel[0]);
                        [ink_narrow_word(tap.normal.as_vec3(), shadowed(tap.region), tap.depth as u32), 0]
                    }
                    TexelLayout::Wide => {
                        let tap = ink_wide_tap(texel);
                        ink_wide_words(tap.normal.as_vec3(), shadowed(tap.region), tap.depth as u32)
                    }
                }
            }
        }
    }
}

/// The frame's lines over it, were some of the picture's pixels blotted.
pub(crate) fn blotted(image: &ImagePlan, blank: &CpuFrame, pixels: &[usize], blot: Blot) -> CpuFrame {
    let mut frame = blank.clone();
    let size = image.ink.scale.size((frame.width, frame.height));
    for &pixel in pixels {
        let (x, y) = (pixel as u32 % frame.width, pixel as u32 / frame.width);
        let along = |at: u32, of: u32, ink: u32| at * ink / of..((at + 1) * ink).div_ceil(of);
        for row in along(y, frame.height, size.1) {
            for column in along(x, frame.width, size.0) {
                let texel = &mut frame.texels[row as usize * size.0 as usize + column as usize];
                *texel = blot.on(*texel, image.ink.layout);
            }
        }
    }
    draw_ink(image, &mut frame);
    frame
}

/// Draws the frame's lines over it, from its texels.
pub(super) fn draw_ink(image: &ImagePlan, frame: &mut CpuFrame) {
    let size = image.ink.scale.size((frame.width, frame.height));
    let picture = UVec2::new(frame.width, frame.height);
    for lines in image.passes() {
        let ink = image.ink(lines, &frame.texels, size);
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
