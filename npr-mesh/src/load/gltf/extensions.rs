//! The names of extensions.

/// An extension that allows attributes of small integers.
pub const QUANTIZATION: &str = "KHR_mesh_quantization";

/// The extensions of a buffer view that is compressed by meshoptimizer: the second has a further version of the vertex
/// codec and a filter for colours.
pub const MESHOPT: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Which edges the author wants drawn.
pub const EDGE_VISIBILITY: &str = "EXT_mesh_primitive_edge_visibility";

/// Instances of a node's mesh.
pub const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// Textures whose images are WebP files.
pub const WEBP: &str = "EXT_texture_webp";

/// The supported extensions. `KHR_materials_unlit` has no effect here.
pub const EXTENSIONS: [&str; 10] = [
    EDGE_VISIBILITY,
    INSTANCING,
    MESHOPT[0],
    MESHOPT[1],
    WEBP,
    "KHR_materials_emissive_strength",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_unlit",
    QUANTIZATION,
    "KHR_texture_transform",
];
