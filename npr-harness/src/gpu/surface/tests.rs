use super::super::shader::surface_wgsl;
use super::*;
use crate::geometry::MaterialUniform;
use crate::shade::Shade;
use crate::shadow::gpu::ShadowUniform;
use crate::style::style;
use naga::TypeInner;
use std::mem::offset_of;

#[test]
fn the_uniforms_lie_as_the_shader_has_them() {
    // The hatching shader contains all of the uniforms.
    let Shade::Hatch(shade) = style("hatch").expect("a style of this crate").shade else { panic!("it hatches") };
    let text = surface_wgsl(&Shade::Hatch(shade)).expect("good numbers");
    let module = naga::front::wgsl::parse_str(&text).expect("the shader parses");
    let layout = |name: &str| {
        let (_, ty) = module.types.iter().find(|(_, t)| t.name.as_deref() == Some(name)).expect("it is there");
        let TypeInner::Struct { members, span } = &ty.inner else { panic!("{name} is no struct") };
        let members: Vec<_> = members.iter().map(|m| (m.name.clone().expect("a name"), m.offset as usize)).collect();
        (members, *span as usize)
    };
    let ours = |members: &[(&str, usize)], size: usize| {
        (members.iter().map(|&(name, at)| (name.to_owned(), at)).collect::<Vec<_>>(), size)
    };
    let view = [
        ("clip_from_world", offset_of!(SurfaceUniform, clip_from_world)),
        ("to_eye", offset_of!(SurfaceUniform, to_eye)),
        ("to_eye_dx", offset_of!(SurfaceUniform, to_eye_dx)),
        ("to_eye_dy", offset_of!(SurfaceUniform, to_eye_dy)),
        ("eye", offset_of!(SurfaceUniform, eye)),
        ("clip_px", offset_of!(SurfaceUniform, clip_px)),
    ];
    assert_eq!(layout("SurfaceView"), ours(&view, size_of::<SurfaceUniform>()));
    let material = [
        ("base_color", offset_of!(MaterialUniform, base_color)),
        ("texture_size", offset_of!(MaterialUniform, texture_size)),
        ("last_level", offset_of!(MaterialUniform, last_level)),
        ("cutoff", offset_of!(MaterialUniform, cutoff)),
        ("wrap", offset_of!(MaterialUniform, wrap)),
        ("emissive_size", offset_of!(MaterialUniform, emissive_size)),
        ("emissive", offset_of!(MaterialUniform, emissive)),
    ];
    assert_eq!(layout("SurfaceMaterial"), ours(&material, size_of::<MaterialUniform>()));
    let ink = [
        ("code", offset_of!(InkUniform, code)),
        ("right", offset_of!(InkUniform, right)),
        ("up", offset_of!(InkUniform, up)),
        ("back", offset_of!(InkUniform, back)),
        ("region_max", offset_of!(InkUniform, region_max)),
        ("padding0", offset_of!(InkUniform, padding0)),
        ("padding1", offset_of!(InkUniform, padding1)),
        ("padding2", offset_of!(InkUniform, padding2)),
    ];
    assert_eq!(layout("SurfaceInk"), ours(&ink, size_of::<InkUniform>()));
    let hatch = [
        ("light_tones", offset_of!(HatchUniform, light_tones)),
        ("texels", offset_of!(HatchUniform, texels)),
        ("dark_tones", offset_of!(HatchUniform, dark_tones)),
        ("last_level", offset_of!(HatchUniform, last_level)),
        ("ink", offset_of!(HatchUniform, ink)),
        ("tiles", offset_of!(HatchUniform, tiles)),
        ("paper", offset_of!(HatchUniform, paper)),
        ("brightness", offset_of!(HatchUniform, brightness)),
        ("ambient", offset_of!(HatchUniform, ambient)),
        ("width", offset_of!(HatchUniform, width)),
        ("padding", offset_of!(HatchUniform, padding)),
    ];
    assert_eq!(layout("SurfaceHatch"), ours(&hatch, size_of::<HatchUniform>()));
    let shadow = [
        ("light", offset_of!(ShadowUniform, light)),
        ("light_px", offset_of!(ShadowUniform, light_px)),
        ("world_from_px", offset_of!(ShadowUniform, world_from_px)),
        ("map_from_px", offset_of!(ShadowUniform, map_from_px)),
        ("terminator", offset_of!(ShadowUniform, terminator)),
        ("padding0", offset_of!(ShadowUniform, padding0)),
        ("padding1", offset_of!(ShadowUniform, padding1)),
        ("padding2", offset_of!(ShadowUniform, padding2)),
    ];
    assert_eq!(layout("SurfaceShadow"), ours(&shadow, size_of::<ShadowUniform>()));
}
