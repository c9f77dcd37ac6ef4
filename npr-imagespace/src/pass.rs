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
mod target;

pub use target::{INK_FORMAT, InkTarget, PassTarget};

#[cfg(test)]
mod tests {
    use super::*;
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    #[test]
    fn modules_name_their_files_and_validate() {
        for files in [disc::DISC, fused::FUSED, composite::COMPOSITE, printed::PRINTED, separate::SEPARATE, step::STEP]
        {
            let source = fullscreen::module_source(files);
            let (head, rest) = source.split_once('\n').unwrap();
            let names: Vec<_> = head.strip_prefix("// Made of: ").unwrap().split(", ").collect();
            let own: Vec<_> = files.iter().map(|(name, _)| *name).collect();
            assert_eq!(names.len(), crate::LIBRARY.len() + 1 + own.len());
            assert_eq!(names[crate::LIBRARY.len()], "pass/fullscreen.wgsl");
            assert_eq!(names[crate::LIBRARY.len() + 1..], own);
            let before_each: Vec<_> = rest.lines().filter_map(|line| line.strip_prefix("// ---- ")).collect();
            assert_eq!(names, before_each);
            let module = naga::front::wgsl::parse_str(&source).unwrap();
            Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module).unwrap();
        }
    }
}
