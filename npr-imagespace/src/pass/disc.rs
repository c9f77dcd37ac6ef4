//! The disc of any radius, by the passes of [`crate::morphology::flood`].
//!
//! Every pixel learns its nearest line pixel, along the rows and then along the columns. What is nearest along the row
//! is exact in any plan and found in the bits of its lines, at once; the columns take the passes of [`disc_plan`], whose
//! number grows with the logarithm of the radius. A last pass makes it ink, at once over a picture if that is what the
//! pass is made for. The result is that of [`crate::morphology::flood::flood`] with that plan.
//!
//! Along a row 32 px are read at a time, up to the radius: some thousand px make that the largest part.
//!
//! Erosion is the complement of the dilated complement, as in [`crate::morphology::disc::erode_disc`]: the nearest
//! paper is sought, and there is none outside the picture, so that its border eats nothing.

use super::fullscreen::{Bound, Fullscreen, Output, size_px, uniform};
use super::{INK_FORMAT, InkTarget, Onto, check_ink, check_view};
use crate::ImageSpaceError;
use crate::composite::Composite;
use crate::morphology::Operation;
use crate::morphology::disc::{Disc, RADIUS_MOST_PX};
use crate::morphology::flood::{FloodPlan, disc_plan};
use bytemuck::{Pod, Zeroable};

pub(super) const DISC: (&str, &str) = ("pass/disc.wgsl", include_str!("disc.wgsl"));
/// Of lines as bits.
const WORD_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;
/// Pixels in a texel of them.
const WORD_PX: u32 = 32;
/// Of steps to the nearest.
const SITE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;
/// Pixels in a texel of them.
const SITE_PX: u32 = 4;
/// `Pass` of the WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct PassUniform {
    step: i32,
    fan: i32,
    row_reach: i32,
    inverted: u32,
    radius_px: f32,
    antialias: u32,
    padding: [u32; 2],
}

/// Textures that a disc needs on the way, to be kept between frames: 9 bytes a pixel and an eighth.
#[derive(Debug)]
pub struct DiscScratch {
    words: wgpu::TextureView,
    sites: [wgpu::TextureView; 2],
    /// Between the halves of an operation.
    ink: wgpu::TextureView,
}

impl DiscScratch {
    /// For ink pictures of a size in px.
    pub fn new(device: &wgpu::Device, [width, height]: [u32; 2]) -> Self {
        let view = |format, width| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("disc"),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            texture.create_view(&Default::default())
        };
        Self {
            words: view(WORD_FORMAT, width.div_ceil(WORD_PX)),
            sites: [(); 2].map(|()| view(SITE_FORMAT, width.div_ceil(SITE_PX))),
            ink: view(INK_FORMAT, width),
        }
    }
}

/// The pipelines of a disc.
#[derive(Debug)]
pub struct DiscPass {
    bits: Fullscreen,
    row: Fullscreen,
    column: Fullscreen,
    resolve: Fullscreen,
    /// The last of an operation's first half.
    resolve_half: Fullscreen,
}

/// What is done to ink.
#[derive(Clone, Copy, Debug)]
struct Half<'a> {
    disc: &'a Disc,
    plan: &'a FloodPlan,
    eroding: bool,
}

impl DiscPass {
    /// Makes the pipelines.
    ///
    /// # Errors
    /// [`ImageSpaceError::SrgbPicture`], [`ImageSpaceError::PictureFormat`].
    pub fn new(device: &wgpu::Device, target: InkTarget) -> Result<Self, ImageSpaceError> {
        target.check(device)?;
        let pipeline =
            |label, texture, output| Fullscreen::new(device, label, DISC, &[Bound::Uniform, texture], &[], output);
        Ok(Self {
            bits: pipeline("bits", Bound::Float, Output::Whole(WORD_FORMAT)),
            row: pipeline("row", Bound::Whole, Output::Whole(SITE_FORMAT)),
            column: pipeline("column", Bound::Whole, Output::Whole(SITE_FORMAT)),
            resolve: pipeline("resolve", Bound::Whole, Output::Ink(target)),
            resolve_half: pipeline("resolve", Bound::Whole, Output::Ink(InkTarget::Ink)),
        })
    }

    /// Records an operation by a disc over `ink`, of format [`INK_FORMAT`] and the target's size; `scratch` is made for
    /// that size. Line pixels are those with ink 128 and more.
    ///
    /// # Errors
    /// If the radius is not within 0..=[`RADIUS_MOST_PX`]; if a texture is not as [`crate::pass`] says.
    #[expect(clippy::too_many_arguments, reason = "each is a thing of its own")]
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        operation: Operation,
        disc: &Disc,
        ink: &wgpu::TextureView,
        scratch: &DiscScratch,
        onto: &Onto<'_>,
    ) -> Result<(), ImageSpaceError> {
        if !(0.0..=RADIUS_MOST_PX).contains(&disc.radius_px) {
            return Err(ImageSpaceError::Radius { radius_px: disc.radius_px });
        }
        let size = self.resolve.check(onto)?;
        check_ink(ink, Some(size))?;
        check_view("the scratch textures", &scratch.ink, INK_FORMAT, "R8Unorm", Some(size))?;
        let plan = disc_plan(disc);
        let halves: Vec<_> = operation.halves().map(|eroding| Half { disc, plan: &plan, eroding }).collect();
        if let [first, second] = halves[..] {
            // As far as the second half will read.
            let reach = plan.row_reach_px();
            let area = onto.area.map(|area| grown(area, [reach, reach], size));
            let between = Onto { view: &scratch.ink, composite: &Composite::Multiply, area };
            self.record_half(device, encoder, &first, ink, &self.resolve_half, scratch, &between);
            self.record_half(device, encoder, &second, &scratch.ink, &self.resolve, scratch, onto);
        } else {
            self.record_half(device, encoder, &halves[0], ink, &self.resolve, scratch, onto);
        }
        Ok(())
    }

    #[expect(clippy::too_many_arguments, reason = "each is a thing of its own")]
    fn record_half(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        half: &Half<'_>,
        ink: &wgpu::TextureView,
        resolve: &Fullscreen,
        scratch: &DiscScratch,
        onto: &Onto<'_>,
    ) {
        let size = size_px(ink);
        let reach = half.plan.row_reach_px();
        // A longer row has no more.
        let words = reach.min(size[0]).div_ceil(WORD_PX);
        let mut record = |draw: &Fullscreen, from, step: u32, fan: u32, to, area| {
            let what = PassUniform {
                step: step as i32,
                fan: fan as i32,
                row_reach: reach as i32,
                inverted: u32::from(half.eroding),
                radius_px: half.disc.radius_px,
                antialias: u32::from(half.disc.antialias),
                padding: [0; 2],
            };
            let what = uniform(device, bytemuck::bytes_of(&what));
            let resources = [what.as_entire_binding(), wgpu::BindingResource::TextureView(from)];
            draw.draw(encoder, &draw.group(device, &resources, onto.composite), to, area);
        };
        // Each pass is to be right wherever those after it read.
        let columns: Vec<_> = half.plan.passes.iter().filter(|pass| pass.along_y).collect();
        let mut areas = vec![onto.area];
        for pass in columns.iter().rev() {
            areas.push(areas[areas.len() - 1].map(|area| grown(area, [0, pass.step * pass.fan], size)));
        }
        let texels = |area: Option<[u32; 4]>, px| area.map(|area| in_texels(area, px));
        let mut area = areas.pop().flatten();
        let read = area.map(|area| grown(area, [(words + 1) * WORD_PX, 0], size));
        record(&self.bits, ink, 0, 0, &scratch.words, texels(read, WORD_PX));
        record(&self.row, &scratch.words, 0, words, &scratch.sites[0], texels(area, SITE_PX));
        let [mut from, mut to] = [0, 1];
        for pass in columns {
            area = areas.pop().flatten();
            record(&self.column, &scratch.sites[from], pass.step, pass.fan, &scratch.sites[to], texels(area, SITE_PX));
            [from, to] = [to, from];
        }
        record(resolve, &scratch.sites[from], 0, 0, onto.view, onto.area);
    }
}

/// An area and so many px around it, within the picture.
fn grown([x, y, width, height]: [u32; 4], reach: [u32; 2], size: [u32; 2]) -> [u32; 4] {
    let along = |from: u32, len: u32, reach: u32, size: u32| {
        let low = from.saturating_sub(reach);
        (low, (from + len).saturating_add(reach).min(size) - low)
    };
    let (left, width) = along(x, width, reach[0], size[0]);
    let (top, height) = along(y, height, reach[1], size[1]);
    [left, top, width, height]
}

/// An area in texels of so many px side by side.
fn in_texels([x, y, width, height]: [u32; 4], px: u32) -> [u32; 4] {
    let left = x / px;
    [left, y, (x + width).div_ceil(px) - left, height]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pass::fullscreen::module_source;
    use std::mem::offset_of;

    #[test]
    fn the_uniform_has_the_layout_of_the_shader() {
        let module = naga::front::wgsl::parse_str(&module_source(DISC)).expect("it is valid");
        let (_, found) = module.types.iter().find(|(_, t)| t.name.as_deref() == Some("Pass")).expect("it has it");
        let naga::TypeInner::Struct { members, span } = &found.inner else { panic!("it is no struct") };
        let offsets: Vec<_> = members[..6].iter().map(|m| (m.name.as_deref().unwrap(), m.offset as usize)).collect();
        assert_eq!(
            offsets,
            [
                ("step", offset_of!(PassUniform, step)),
                ("fan", offset_of!(PassUniform, fan)),
                ("row_reach", offset_of!(PassUniform, row_reach)),
                ("inverted", offset_of!(PassUniform, inverted)),
                ("radius_px", offset_of!(PassUniform, radius_px)),
                ("antialias", offset_of!(PassUniform, antialias)),
            ]
        );
        assert_eq!(*span as usize, size_of::<PassUniform>());
    }
}
