//! The filters and the inker of 2002 over an RGBA8 target: see [`crate::filter::printed`] for what they decide, and
//! [`crate::format::printed`] for what the target holds.

use super::fullscreen::{Bound, Fullscreen, Output, TAPS, flag, tap_constants, uniform};
use super::target::{InkTarget, PassTarget, check_view};
use crate::ImageSpaceError;
use crate::composite::AlphaTest;
use crate::filter::inker::InkerUniform;
use crate::filter::printed::{PrintedFilter, PrintedUniform};
use crate::picture::Taps;

pub(super) const PRINTED: &[(&str, &str)] = &[TAPS, ("pass/printed.wgsl", include_str!("printed.wgsl"))];

/// The tests that a pipeline is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// Whether normals are tested, with `true` for background as printed, and whether depth is tested.
    Edges {
        normal: Option<bool>,
        depth: bool,
        taps: Taps,
        co_issued: Option<AlphaTest>,
    },
    Inker {
        taps: Taps,
    },
}

impl From<&PrintedFilter> for Kind {
    fn from(filter: &PrintedFilter) -> Self {
        match filter {
            PrintedFilter::Edges(edges) => Self::Edges {
                normal: edges.normal.map(|normal| normal.printed_background),
                depth: edges.depth.is_some(),
                taps: edges.taps,
                co_issued: edges.co_issued,
            },
            PrintedFilter::Inker(inker) => Self::Inker { taps: inker.taps },
        }
    }
}

/// The pipeline of a filter, for its tests and taps.
#[derive(Debug)]
pub struct PrintedPass {
    draw: Fullscreen,
    kind: Kind,
}

impl PrintedPass {
    /// Makes the pipeline.
    ///
    /// # Errors
    /// [`ImageSpaceError::SrgbPicture`], [`ImageSpaceError::PictureFormat`], [`ImageSpaceError::TapStep`].
    pub fn new(device: &wgpu::Device, filter: &PrintedFilter, target: InkTarget) -> Result<Self, ImageSpaceError> {
        target.check(device)?;
        let kind = Kind::from(filter);
        let (label, normal, depth, taps, co_issued) = match kind {
            Kind::Edges { normal, depth, taps, co_issued } => ("printed", normal, depth, taps, co_issued),
            Kind::Inker { taps } => ("inker", None, false, taps, None),
        };
        let test = co_issued.unwrap_or(AlphaTest::CORRECTED);
        taps.validate()?;
        let [x0, y0, x1, y1] = tap_constants(taps);
        let constants = [
            flag("with_normal", normal.is_some()),
            flag("printed_background", normal == Some(true)),
            flag("with_depth", depth),
            flag("co_issued", co_issued.is_some()),
            flag("alpha_less", test.less),
            ("alpha_reference", f64::from(test.reference)),
            x0,
            y0,
            x1,
            y1,
        ];
        let bound = [Bound::Uniform, Bound::Float];
        Ok(Self { draw: Fullscreen::new(device, label, PRINTED, &bound, &constants, Output::Ink(target)), kind })
    }

    /// Records filtering `texels`, of format `Rgba8Unorm` and the target's size.
    ///
    /// # Errors
    /// If a threshold is out of its range, or the inker is not valid ([`Inker::validate`](crate::filter::inker::Inker::validate)); [`ImageSpaceError::OtherFilter`] if the filter
    /// looks for anything else than what the pass was made for; if a texture is not as [`crate::pass`] says.
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        filter: &PrintedFilter,
        texels: &wgpu::TextureView,
        target: &PassTarget<'_>,
    ) -> Result<(), ImageSpaceError> {
        if Kind::from(filter) != self.kind {
            return Err(ImageSpaceError::OtherFilter);
        }
        let size = self.draw.check(target)?;
        check_view("texels", texels, wgpu::TextureFormat::Rgba8Unorm, "Rgba8Unorm", Some(size))?;
        let what = match filter {
            PrintedFilter::Edges(edges) => uniform(device, bytemuck::bytes_of(&PrintedUniform::new(edges)?)),
            PrintedFilter::Inker(inker) => {
                inker.validate()?;
                uniform(device, bytemuck::bytes_of(&InkerUniform::from(inker)))
            }
        };
        let resources = [what.as_entire_binding(), wgpu::BindingResource::TextureView(texels)];
        self.draw.record(device, encoder, &resources, target);
        Ok(())
    }
}
