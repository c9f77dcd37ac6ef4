//! Passes on wgpu: filters, steps, discs, and ink over pictures.
//!
//! - [`fused`]: packed texels ([`crate::format::texel`]) to ink, or at once over a picture: nothing is written in
//!   between.
//! - [`separate`]: the same from textures of one's own: normals, depth, region numbers, any of them.
//! - [`printed`]: the filters and the inker of 2002 over an RGBA8 target ([`crate::format::printed`]), on its bytes.
//! - [`step`]: one step of dilation or erosion, hard and soft, from ink to ink.
//! - [`disc`]: the disc of any radius by [`crate::morphology::flood`].
//! - [`lay`]: ink over a picture, also of another size.
//!
//! Each is a struct with `new(&device, ..)` and `record(&device, &mut encoder, ..)`; it holds pipelines and nothing of
//! a frame. Each draws a triangle over its target, so that it needs nothing but render targets:
//! WebGL will do.
//!
//! # Targets
//!
//! Ink pictures are [`INK_FORMAT`]: 0 paper, 1 line. Pictures are targets that the blend unit can write and that
//! show what they hold: `Rgba8Unorm`, `Bgra8Unorm`, `Rgba16Float`, but not those named `Srgb`, in which coverage would
//! blend in linear light. Their alpha is left alone.

pub mod disc;
mod fullscreen;
pub mod fused;
pub mod lay;
pub mod printed;
pub mod separate;
pub mod step;

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

/// Of ink pictures.
pub const INK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// What kind of target a pass is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum InkTarget {
    /// An ink picture, [`INK_FORMAT`]. It is overwritten, with paper outside the area.
    Ink,
    /// A picture of a format, over which lines are laid.
    Picture(wgpu::TextureFormat),
}

/// Where a pass puts its ink.
#[derive(Clone, Copy, Debug)]
pub struct Onto<'a> {
    /// Of the kind and the format that the pass was made for.
    pub view: &'a wgpu::TextureView,
    /// How lines come over a picture; not looked at for an ink picture.
    pub composite: &'a Composite,
    /// Where there may be lines: left, top, width and height in px, within the target. `None` for all of it. A pass
    /// costs what its area does, and where a scene's bounds are known there is none outside them, and a pixel around.
    pub area: Option<[u32; 4]>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    #[test]
    fn modules_name_their_files_and_validate() {
        for file in [disc::DISC, fused::FUSED, lay::LAY, printed::PRINTED, separate::SEPARATE, step::STEP] {
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
