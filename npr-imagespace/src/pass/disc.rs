//! Dilation and erosion by a disc of any radius, by the passes of [`crate::morphology::flood`].
//!
//! The nearest line pixel of each pixel is found along rows, then along columns. Along rows one pass finds it exactly
//! from line pixels stored as bits; along columns there are the passes of [`disc_plan`], whose number grows with the
//! logarithm of the radius. A last pass converts distances to ink, composited over a picture if the pass is made for
//! one. The result is that of [`crate::morphology::flood::flood`] with that plan.
//!
//! The row pass reads 32 px a load up to the radius; from a radius of about a thousand px on it takes most of the time.
//!
//! Erosion is the complement of the dilated complement, as in [`crate::morphology::disc::erode_disc`]: the nearest
//! paper is searched for, and there is none outside the picture, so that the picture's border removes no ink.

use super::fullscreen::{Bound, Fullscreen, Output, uniform};
use super::target::{INK_FORMAT, InkTarget, PassTarget, check_ink, texture_size_px};
use crate::ImageSpaceError;
use crate::composite::Composite;
use crate::morphology::Operation;
use crate::morphology::disc::{Disc, RADIUS_MAX_PX, SITE_PX, WORD_PX};
use crate::morphology::flood::{FloodPlan, disc_plan};
use bytemuck::{Pod, Zeroable};
use std::sync::OnceLock;

pub(super) const DISC: &[(&str, &str)] = &[("pass/disc.wgsl", include_str!("disc.wgsl"))];
/// The format of line pixels as bits.
const WORD_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;
/// The format of steps to the nearest line pixel.
const SITE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;
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

/// Intermediate textures of a disc, to be kept between frames: 8⅛ bytes a pixel, and 1 more once it is used for an opening
/// or a closing.
#[derive(Debug)]
pub struct DiscScratch {
    words: wgpu::TextureView,
    sites: [wgpu::TextureView; 2],
    size: [u32; 2],
    /// Ink between the two halves of an opening or closing, made when there is one.
    ink: OnceLock<wgpu::TextureView>,
}

impl DiscScratch {
    /// For ink pictures of a size in px.
    pub fn new(device: &wgpu::Device, [width, height]: [u32; 2]) -> Self {
        Self {
            words: texture(device, WORD_FORMAT, [width.div_ceil(WORD_PX), height]),
            sites: [(); 2].map(|()| texture(device, SITE_FORMAT, [width.div_ceil(SITE_PX), height])),
            size: [width, height],
            ink: OnceLock::new(),
        }
    }
}

fn texture(device: &wgpu::Device, format: wgpu::TextureFormat, [width, height]: [u32; 2]) -> wgpu::TextureView {
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
}

/// The pipelines of a disc.
#[derive(Debug)]
pub struct DiscPass {
    bits: Fullscreen,
    row: Fullscreen,
    column: Fullscreen,
    resolve: Fullscreen,
    /// The last pass of the first half of an opening or closing.
    resolve_half: Fullscreen,
}

/// One half of an operation.
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
    /// If the radius is not within 0..=[`RADIUS_MAX_PX`]; if a texture is not as [`crate::pass`] says.
    #[expect(clippy::too_many_arguments, reason = "each is a thing of its own")]
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        operation: Operation,
        disc: &Disc,
        ink: &wgpu::TextureView,
        scratch: &DiscScratch,
        target: &PassTarget<'_>,
    ) -> Result<(), ImageSpaceError> {
        if !(0.0..=RADIUS_MAX_PX).contains(&disc.radius_px) {
            return Err(ImageSpaceError::Radius { radius_px: disc.radius_px });
        }
        let size = self.resolve.check(target)?;
        check_ink(ink, Some(size))?;
        if scratch.size != size {
            let what = "the scratch textures";
            return Err(ImageSpaceError::ViewSize { what, size_px: scratch.size.into(), needed_px: size.into() });
        }
        let plan = disc_plan(disc);
        let halves: Vec<_> = operation.halves().map(|eroding| Half { disc, plan: &plan, eroding }).collect();
        if let [first, second] = halves[..] {
            // The first half must be correct as far as the second half reads.
            let reach = plan.row_reach_px();
            let area = target.area.map(|area| grown(area, [reach, reach], size));
            let between = scratch.ink.get_or_init(|| texture(device, INK_FORMAT, scratch.size));
            let target_between = PassTarget { view: between, composite: &Composite::Multiply, area };
            self.record_half(device, encoder, &first, ink, &self.resolve_half, scratch, &target_between);
            self.record_half(device, encoder, &second, between, &self.resolve, scratch, target);
        } else {
            self.record_half(device, encoder, &halves[0], ink, &self.resolve, scratch, target);
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
        target: &PassTarget<'_>,
    ) {
        let size = texture_size_px(ink);
        let reach = half.plan.row_reach_px();
        // A row has no more words than its width takes.
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
            draw.draw(encoder, &draw.group(device, &resources, target.composite), to, area);
        };
        // Each pass must be correct wherever the passes after it read.
        let columns: Vec<_> = half.plan.passes.iter().filter(|pass| pass.along_y).collect();
        let mut areas = vec![target.area];
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
        record(resolve, &scratch.sites[from], 0, 0, target.view, target.area);
    }
}

/// An area grown by `reach` px to each side, within the picture.
fn grown([x, y, width, height]: [u32; 4], reach: [u32; 2], size: [u32; 2]) -> [u32; 4] {
    let along = |from: u32, len: u32, reach: u32, size: u32| {
        let low = from.saturating_sub(reach);
        (low, (from + len).saturating_add(reach).min(size) - low)
    };
    let (left, width) = along(x, width, reach[0], size[0]);
    let (top, height) = along(y, height, reach[1], size[1]);
    [left, top, width, height]
}

/// An area in texels of `px` horizontally adjacent pixels.
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
