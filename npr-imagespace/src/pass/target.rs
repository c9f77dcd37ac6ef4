//! Targets of passes, and what is refused of them.

use crate::ImageSpaceError;
use crate::composite::Composite;

/// A shader module from several files, given as name and text: their names at its head, and a line before each.
pub(super) fn assemble(files: &[(&str, &str)]) -> String {
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
    pub(super) fn format(self) -> wgpu::TextureFormat {
        match self {
            Self::Ink => INK_FORMAT,
            Self::Picture(format) => format,
        }
    }

    /// Refuses formats of pictures that lines cannot be composited over.
    pub(super) fn check(self, device: &wgpu::Device) -> Result<(), ImageSpaceError> {
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
pub(super) fn check_view(
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

pub(super) fn check_samples_and_size(
    what: &'static str,
    view: &wgpu::TextureView,
    size_px: Option<[u32; 2]>,
) -> Result<(), ImageSpaceError> {
    let samples = view.texture().sample_count();
    if samples != 1 {
        return Err(ImageSpaceError::ViewSamples { what, samples });
    }
    let found = texture_size_px(view);
    match size_px {
        Some(needed) if needed != found => {
            Err(ImageSpaceError::ViewSize { what, size_px: found.into(), needed_px: needed.into() })
        }
        _ => Ok(()),
    }
}

/// Refuses ink of another format, with more than one sample, or of another size if one is given.
pub(super) fn check_ink(ink: &wgpu::TextureView, size_px: Option<[u32; 2]>) -> Result<(), ImageSpaceError> {
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
    pub(super) fn check(&self, target: InkTarget) -> Result<[u32; 2], ImageSpaceError> {
        let needed = match target {
            InkTarget::Ink => "R8Unorm",
            InkTarget::Picture(_) => "the one that the pass was made for",
        };
        check_view("a target", self.view, target.format(), needed, None)?;
        let size = texture_size_px(self.view);
        if let Some(area @ [x, y, width, height]) = self.area
            && !(x.checked_add(width).is_some_and(|right| right <= size[0])
                && y.checked_add(height).is_some_and(|bottom| bottom <= size[1]))
        {
            return Err(ImageSpaceError::Area { area, size_px: size.into() });
        }
        Ok(size)
    }
}

/// Width and height of the texture of a view.
pub(super) fn texture_size_px(view: &wgpu::TextureView) -> [u32; 2] {
    [view.texture().width(), view.texture().height()]
}
