//! The fused filter over packed texels: see [`crate::filter::fused`] for what it decides.

use super::fullscreen::{Bound, Fullscreen, Output, TAPS, flag, tap_constants, uniform};
use super::target::{InkTarget, PassTarget, check_view};
use crate::ImageSpaceError;
use crate::filter::fused::{FilterUniform, FusedFilter};
use crate::format::texel::{DepthCode, TexelLayout};
use crate::picture::Taps;

pub(super) const FUSED: &[(&str, &str)] = &[TAPS, ("pass/fused.wgsl", include_str!("fused.wgsl"))];

/// The format of a texture of packed texels. It must be cleared to 0, which is background.
pub fn texel_format(layout: TexelLayout) -> wgpu::TextureFormat {
    match layout {
        TexelLayout::Bits32 => wgpu::TextureFormat::R32Uint,
        TexelLayout::Bits64 => wgpu::TextureFormat::Rg32Uint,
    }
}

/// The filter's pipeline, for a layout, and hard or soft lines.
#[derive(Debug)]
pub struct FusedPass {
    draw: Fullscreen,
    layout: TexelLayout,
    taps: Taps,
    soft: bool,
}

impl FusedPass {
    /// Makes the pipeline for a filter's taps, hard if its softness is 0.
    ///
    /// # Errors
    /// [`ImageSpaceError::SrgbPicture`], [`ImageSpaceError::PictureFormat`], [`ImageSpaceError::TapStep`].
    pub fn new(
        device: &wgpu::Device,
        filter: &FusedFilter,
        layout: TexelLayout,
        target: InkTarget,
    ) -> Result<Self, ImageSpaceError> {
        target.check(device)?;
        let soft = filter.softness > 0.0;
        filter.taps.validate()?;
        let [x0, y0, x1, y1] = tap_constants(filter.taps);
        let constants = [flag("narrow", layout == TexelLayout::Bits32), flag("soft", soft), x0, y0, x1, y1];
        let bound = [Bound::Uniform, Bound::Whole];
        Ok(Self {
            draw: Fullscreen::new(device, "fused", FUSED, &bound, &constants, Output::Ink(target)),
            layout,
            taps: filter.taps,
            soft,
        })
    }

    /// Records filtering `texels`, of format [`texel_format`] and the target's size.
    ///
    /// # Errors
    /// If a threshold is out of its range; [`ImageSpaceError::OtherFilter`] if the filter's taps are others than the
    /// pass was made for, or it is soft and the pass hard or the reverse; if a texture is not as [`crate::pass`] says.
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        filter: &FusedFilter,
        code: &DepthCode,
        texels: &wgpu::TextureView,
        target: &PassTarget<'_>,
    ) -> Result<(), ImageSpaceError> {
        let what = FilterUniform::new(filter, self.layout, code)?;
        if (filter.taps, filter.softness > 0.0) != (self.taps, self.soft) {
            return Err(ImageSpaceError::OtherFilter);
        }
        let size = self.draw.check(target)?;
        let needed = match self.layout {
            TexelLayout::Bits32 => "R32Uint",
            TexelLayout::Bits64 => "Rg32Uint",
        };
        check_view("packed texels", texels, texel_format(self.layout), needed, Some(size))?;
        let what = uniform(device, bytemuck::bytes_of(&what));
        let resources = [what.as_entire_binding(), wgpu::BindingResource::TextureView(texels)];
        self.draw.record(device, encoder, &resources, target);
        Ok(())
    }
}
