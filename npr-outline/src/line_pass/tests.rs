use super::*;
use crate::fin_pass::FinUniform;
use std::mem::offset_of;

/// Name and offset of each member of a struct, and its size, in the layout of naga.
fn layout(source: &str, name: &str) -> (Vec<(String, usize)>, usize) {
    let module = naga::front::wgsl::parse_str(source).unwrap();
    let (_, found) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).expect("the struct is there");
    let naga::TypeInner::Struct { members, span } = &found.inner else { panic!("{name} is no struct") };
    (members.iter().map(|m| (m.name.clone().unwrap(), m.offset as usize)).collect(), *span as usize)
}

/// Lists a Rust struct's fields like [`layout`].
macro_rules! fields {
    ($ty:ty: $($field:ident),*) => {
        (vec![$((stringify!($field).to_string(), offset_of!($ty, $field))),*], size_of::<$ty>())
    };
}

#[test]
fn uniforms_are_laid_out_as_in_the_shaders() {
    assert_eq!(
        layout(WGSL, "OutlineView"),
        fields!(OutlineUniform: clip_from_world, viewport_px, depth_per_px, width_px, ink, local_eye, edge_count,
            always_count, row_stride, authored_px, single_sided)
    );
    assert_eq!(
        layout(&crate::fin_pass::wgsl(), "FinPrintedView"),
        fields!(FinUniform: clip_from_world, eye, thickness, ink, near, far, as_printed, reversed)
    );
}

#[test]
fn records_are_laid_out_as_the_vertex_attributes() {
    let (offsets, size) = fields!(LineRecord: end0, kind_traits, end1, normal0, normal1);
    assert_eq!(RECORD_LAYOUT.array_stride as usize, size);
    let of_layout: Vec<usize> = RECORD_LAYOUT.attributes.iter().map(|a| a.offset as usize).collect();
    assert_eq!(of_layout, offsets.iter().map(|(_, offset)| *offset).collect::<Vec<_>>());
    // The entry point's arguments, in the order of their locations, have the fields' names and types.
    let module = naga::front::wgsl::parse_str(&record_wgsl(false)).unwrap();
    let entry = module.entry_points.iter().find(|entry| entry.name == "vs_record").unwrap();
    let located: Vec<_> = entry
        .function
        .arguments
        .iter()
        .filter_map(|argument| match argument.binding {
            Some(naga::Binding::Location { location, .. }) => {
                Some((location, argument.name.clone().unwrap(), &module.types[argument.ty].inner))
            }
            _ => None,
        })
        .collect();
    assert_eq!(located.len(), offsets.len());
    for (i, (location, name, ty)) in located.into_iter().enumerate() {
        assert_eq!((location as usize, &name), (i, &offsets[i].0));
        let expected = match RECORD_LAYOUT.attributes[i].format {
            wgpu::VertexFormat::Float32x3 => {
                naga::TypeInner::Vector { size: naga::VectorSize::Tri, scalar: naga::Scalar::F32 }
            }
            _ => naga::TypeInner::Scalar(naga::Scalar::U32),
        };
        assert_eq!(*ty, expected, "{name}");
    }
}
