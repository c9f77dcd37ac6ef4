//! Passes on wgpu: edge filters, morphology, and compositing over pictures.
//!
//! - [`fused`]: the fused filter over packed texels ([`crate::format::texel`]), written as ink or composited over a
//!   picture in the same pass.
//! - [`separate`]: the filters over separate textures of normals, depth and region numbers.
//! - [`printed`]: the filters and the inker of 2002 over the bytes of an RGBA8 target ([`crate::format::printed`]).
//! - [`step`]: one step of dilation or erosion, hard and soft, from ink to ink.
//! - [`disc`]: dilation and erosion by a disc of any radius by [`crate::morphology::flood`].
//! - [`mod@composite`]: composites ink of any size over a picture.
//!
//! Each is a struct with `new(&device, ..)` and `record(&device, &mut encoder, ..)`; it has pipelines and no
//! state of a frame. Each draws a triangle over its target and needs render targets only, so that all run on WebGL2.
//!
//! # Targets
//!
//! Ink pictures are [`INK_FORMAT`]: 0 paper, 1 line. Pictures are of colour formats that can be blended and whose
//! stores do not encode sRGB: `Rgba8Unorm`, `Bgra8Unorm`, `Rgba16Float`. With an `Srgb` format coverage would blend in
//! linear light; a view without `Srgb` of such a texture is accepted. The alpha of pictures is not written.
//!
//! All textures have one sample a pixel, and views show their first level and layer. Unless a pass says otherwise, what
//! it reads has the size of its target. A pass that is given anything else records nothing and returns an error.

pub mod composite;
pub mod disc;
mod fullscreen;
pub mod fused;
pub mod printed;
pub mod separate;
pub mod step;

use crate::ImageSpaceError;
use crate::composite::Composite;

/// A shader module from several files, given as name and text: their names at its head, and a line before each.
fn assemble(files: &[(&str, &str)]) -> String {
    let names: Vec<_> = files.iter().map(|(name, _)| *name).collect();
    let mut source = format!("// Made of: {}\n", names.join(", "));
    for (name, text) in files {
        source += &format!("\n// ---- {name}\n{text}");
    }
    source
}

/// The format of ink pictures: 0 paper, 1 line.
pub const INK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// The kind of target that a pass is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum InkTarget {
    /// An ink picture, [`INK_FORMAT`]. It is overwritten, with paper outside the area.
    Ink,
    /// A picture of a format, over which lines are composited.
    Picture(wgpu::TextureFormat),
}

impl InkTarget {
    /// The format of the target's views.
    fn format(self) -> wgpu::TextureFormat {
        match self {
            Self::Ink => INK_FORMAT,
            Self::Picture(format) => format,
        }
    }

    /// Refuses formats of pictures that lines cannot be composited over.
    fn check(self, device: &wgpu::Device) -> Result<(), ImageSpaceError> {
        let Self::Picture(format) = self else { return Ok(()) };
        if format.is_srgb() {
            return Err(ImageSpaceError::SrgbPicture { format });
        }
        let features = format.guaranteed_format_features(device.features());
        let known = features.flags.contains(wgpu::TextureFormatFeatureFlags::BLENDABLE);
        // What an adapter blends besides is not known here.
        let specific = device.features().contains(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES);
        let is_float =
            matches!(format.sample_type(None, Some(device.features())), Some(wgpu::TextureSampleType::Float { .. }));
        if !is_float || format.has_depth_aspect() || !(known || specific) {
            return Err(ImageSpaceError::PictureFormat { format });
        }
        Ok(())
    }
}

/// Refuses a texture of another format, with more than one sample a pixel, or, if `size_px` is given, of another size.
/// A view of an sRGB texture may be one without sRGB, which cannot be seen here.
fn check_view(
    what: &'static str,
    view: &wgpu::TextureView,
    format: wgpu::TextureFormat,
    needed: &'static str,
    size_px: Option<[u32; 2]>,
) -> Result<(), ImageSpaceError> {
    let found = view.texture().format();
    if found.remove_srgb_suffix() != format.remove_srgb_suffix() {
        return Err(ImageSpaceError::ViewFormat { what, format: found, needed });
    }
    check_samples_and_size(what, view, size_px)
}

fn check_samples_and_size(
    what: &'static str,
    view: &wgpu::TextureView,
    size_px: Option<[u32; 2]>,
) -> Result<(), ImageSpaceError> {
    let samples = view.texture().sample_count();
    if samples != 1 {
        return Err(ImageSpaceError::ViewSamples { what, samples });
    }
    let found = fullscreen::size_px(view);
    match size_px {
        Some(needed) if needed != found => {
            Err(ImageSpaceError::ViewSize { what, size_px: found.into(), needed_px: needed.into() })
        }
        _ => Ok(()),
    }
}

/// Refuses ink of another format, with more than one sample, or of another size if one is given.
fn check_ink(ink: &wgpu::TextureView, size_px: Option<[u32; 2]>) -> Result<(), ImageSpaceError> {
    check_view("ink", ink, INK_FORMAT, "R8Unorm", size_px)
}

/// The target of a pass.
#[derive(Clone, Copy, Debug)]
pub struct PassTarget<'a> {
    /// A view of the kind and the format that the pass was made for.
    pub view: &'a wgpu::TextureView,
    /// How lines are composited over a picture; ignored for an ink picture.
    pub composite: &'a Composite,
    /// The area in which lines are drawn: left, top, width and height, px, within the target; `None` for all of it. The
    /// cost is proportional to the area. There are no lines farther than one pixel outside a scene's bounds.
    pub area: Option<[u32; 4]>,
}

impl PassTarget<'_> {
    /// Refuses a view that is none of the target that a pass was made for, and areas beyond it. Returns its size, px.
    fn check(&self, target: InkTarget) -> Result<[u32; 2], ImageSpaceError> {
        let needed = match target {
            InkTarget::Ink => "R8Unorm",
            InkTarget::Picture(_) => "the one that the pass was made for",
        };
        check_view("a target", self.view, target.format(), needed, None)?;
        let size = fullscreen::size_px(self.view);
        if let Some(area @ [x, y, width, height]) = self.area
            && !(x.checked_add(width).is_some_and(|right| right <= size[0])
                && y.checked_add(height).is_some_and(|bottom| bottom <= size[1]))
        {
            return Err(ImageSpaceError::Area { area, size_px: size.into() });
        }
        Ok(size)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    #[test]
    fn modules_name_their_files_and_validate() {
        for file in [disc::DISC, fused::FUSED, composite::COMPOSITE, printed::PRINTED, separate::SEPARATE, step::STEP] {
            let source = fullscreen::module_source(file);
            let (head, rest) = source.split_once('\n').unwrap();
            let names: Vec<_> = head.strip_prefix("// Made of: ").unwrap().split(", ").collect();
            assert_eq!(names.len(), crate::LIBRARY.len() + 2);
            assert_eq!(names[names.len() - 2..], ["pass/fullscreen.wgsl", file.0]);
            let before_each: Vec<_> = rest.lines().filter_map(|line| line.strip_prefix("// ---- ")).collect();
            assert_eq!(names, before_each);
            let module = naga::front::wgsl::parse_str(&source).unwrap();
            Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module).unwrap();
        }
    }
}
