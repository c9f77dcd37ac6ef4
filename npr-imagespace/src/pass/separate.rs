//! The filters over separate textures: see [`crate::filter::separate`] for what they decide, and how the numbers
//! of a depth buffer are read.

use super::fullscreen::{Bound, Fullscreen, Output, TAPS, flag, tap_constants, uniform};
use super::target::{InkTarget, PassTarget, check_samples_and_size};
use crate::ImageSpaceError;
use crate::filter::separate::{SeparateDepthTest, SeparateFilter, SeparateUniform};
use crate::picture::Taps;

pub(super) const SEPARATE: &[(&str, &str)] = &[TAPS, ("pass/separate.wgsl", include_str!("separate.wgsl"))];

/// The textures of a G-buffer, all of the target's size. Those of tests that the filter does not have may be `None`.
#[derive(Clone, Copy, Debug, Default)]
pub struct SeparateTextures<'a> {
    /// Any format of floats with three channels or more, without sRGB.
    pub normal: Option<&'a wgpu::TextureView>,
    /// Any format of floats, the first channel; or a depth buffer, `Depth32Float` or the depth alone of another.
    pub depth: Option<&'a wgpu::TextureView>,
    /// Any format of unsigned integers, the first channel: `R8Uint`, `R16Uint`, `R32Uint`.
    pub region: Option<&'a wgpu::TextureView>,
}

/// Which formats a texture may have.
#[derive(Clone, Copy)]
struct Accept {
    needed: &'static str,
    accepts: fn(wgpu::TextureFormat, wgpu::Features) -> bool,
}

const NORMALS: Accept = Accept {
    needed: "a format of floats with three channels or more, and not sRGB,",
    accepts: |format, features| is_float(format, features) && format.components() >= 3 && !format.is_srgb(),
};
const DEPTHS: Accept = Accept {
    needed: "a format of floats or of depth",
    accepts: |format, features| format.has_depth_aspect() || is_float(format, features),
};
const REGIONS: Accept = Accept {
    needed: "a format of unsigned integers",
    accepts: |format, features| format.sample_type(None, Some(features)) == Some(wgpu::TextureSampleType::Uint),
};

fn is_float(format: wgpu::TextureFormat, features: wgpu::Features) -> bool {
    matches!(format.sample_type(None, Some(features)), Some(wgpu::TextureSampleType::Float { .. }))
}

/// The tests that a pipeline is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Kind {
    normal: bool,
    /// 0 none, 1 second differences, 2 first differences, 3 plain.
    depth: u8,
    region: bool,
    taps: Taps,
    soft: bool,
}

impl From<&SeparateFilter> for Kind {
    fn from(filter: &SeparateFilter) -> Self {
        let depth = filter.depth.map_or(0, |depth| match depth.test {
            SeparateDepthTest::Bend { .. } => 1,
            SeparateDepthTest::Step { .. } => 2,
            SeparateDepthTest::Plain { .. } => 3,
        });
        Self {
            normal: filter.normal.is_some(),
            depth,
            region: filter.regions,
            taps: filter.taps,
            soft: filter.softness > 0.0,
        }
    }
}

/// The pipeline of a filter, for its tests, its taps, and hard or soft lines.
#[derive(Debug)]
pub struct SeparatePass {
    draw: Fullscreen,
    kind: Kind,
    /// Placeholders for textures that are not read: one texel of floats, one of integers.
    none: [wgpu::TextureView; 2],
    nearest: wgpu::Sampler,
}

impl SeparatePass {
    /// Makes the pipeline.
    ///
    /// # Errors
    /// [`ImageSpaceError::SrgbPicture`], [`ImageSpaceError::PictureFormat`], [`ImageSpaceError::TapStep`].
    pub fn new(device: &wgpu::Device, filter: &SeparateFilter, target: InkTarget) -> Result<Self, ImageSpaceError> {
        target.check(device)?;
        let kind = Kind::from(filter);
        kind.taps.validate()?;
        let [x0, y0, x1, y1] = tap_constants(kind.taps);
        let constants = [
            flag("with_normal", kind.normal),
            flag("with_region", kind.region),
            ("depth_test", f64::from(kind.depth)),
            flag("soft", kind.soft),
            x0,
            y0,
            x1,
            y1,
        ];
        let bound = [Bound::Uniform, Bound::Float, Bound::Float, Bound::Whole, Bound::Nearest];
        let none = [wgpu::TextureFormat::R8Unorm, wgpu::TextureFormat::R8Uint].map(|format| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("placeholder"),
                size: wgpu::Extent3d::default(),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            texture.create_view(&Default::default())
        });
        Ok(Self {
            draw: Fullscreen::new(device, "separate", SEPARATE, &bound, &constants, Output::Ink(target)),
            kind,
            none,
            nearest: device.create_sampler(&wgpu::SamplerDescriptor { label: Some("nearest"), ..Default::default() }),
        })
    }

    /// Records filtering the textures.
    ///
    /// # Errors
    /// If a threshold is out of its range, or a depth buffer's numbers make no depths; [`ImageSpaceError::OtherFilter`]
    /// if the filter looks for anything else than what the pass was made for; [`ImageSpaceError::MissingTexture`] if it
    /// reads a texture that is not given; if a texture is not as [`crate::pass`] and [`SeparateTextures`] say.
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        filter: &SeparateFilter,
        textures: &SeparateTextures<'_>,
        target: &PassTarget<'_>,
    ) -> Result<(), ImageSpaceError> {
        let what = SeparateUniform::new(filter)?;
        if Kind::from(filter) != self.kind {
            return Err(ImageSpaceError::OtherFilter);
        }
        let size = self.draw.check(target)?;
        let what = uniform(device, bytemuck::bytes_of(&what));
        let texture =
            |what, asked: bool, given: Option<&wgpu::TextureView>, none: &wgpu::TextureView, accept: Accept| {
                if !asked {
                    return Ok(none.clone());
                }
                let given = given.ok_or(ImageSpaceError::MissingTexture { what })?;
                let format = given.texture().format();
                if !(accept.accepts)(format, device.features()) {
                    return Err(ImageSpaceError::ViewFormat { what, format, needed: accept.needed });
                }
                check_samples_and_size(what, given, Some(size))?;
                Ok(given.clone())
            };
        let [no_float, no_whole] = &self.none;
        let views = [
            texture("normals", self.kind.normal, textures.normal, no_float, NORMALS)?,
            texture("depths", self.kind.depth != 0, textures.depth, no_float, DEPTHS)?,
            texture("region numbers", self.kind.region, textures.region, no_whole, REGIONS)?,
        ];
        let [normal, depth, region] = views.each_ref().map(wgpu::BindingResource::TextureView);
        let nearest = wgpu::BindingResource::Sampler(&self.nearest);
        self.draw.record(device, encoder, &[what.as_entire_binding(), normal, depth, region, nearest], target);
        Ok(())
    }
}
