//! Loads model files into meshes, plain arrays of clean triangles with normals, and finds their edges.
//!
//! ```
//! use npr_mesh::{edges, embedded};
//!
//! let model = embedded::cube(); // or, from a file: npr_mesh::load(path, &Default::default())?.into_model()
//! let found =
//!     edges::find(&model.positions, &model.faces, &model.face_polygon, &model.face_material, &Default::default());
//! let creases = found.edges.iter().filter(|edge| found.dihedral_rad(edge) > Some(30f32.to_radians()));
//! assert_eq!(creases.count(), 12); // the diagonals of the cube's squares are not edges
//! ```
//!
//! [`Model`] consists of plain arrays: positions, normals, texture coordinates, triangles. `load` reads `.obj`
//! (feature `obj`), `.gltf` and `.glb` (feature `gltf`), `.ply` (feature `ply`) and `.stl` (feature `stl`): the meshes of
//! the file, each once as a `Model` of its own, and the [`Object`]s that place them. `load_bytes` does so in memory.
//! `Loaded::into_model` puts all objects into one model in world space. With the feature `export`, `export::glb` writes
//! models. [`embedded`] has built-in models. The features of formats are enabled by default.
//!
//! # Rules
//!
//! - A face is the triple of its corners as loaded. For edges and computed normals, vertices that only rounding separates,
//!   within 8 units in the last place of the mesh's largest coordinate, are one vertex ([`weld`]), so that texture and
//!   normal seams are not boundaries. For shading they remain separate. `LoadOptions::weld` overrides the distance.
//! - A polygon of n corners becomes n − 2 triangles ([`triangulate`]). Diagonals are not edges, and all triangles of
//!   a polygon have its Newell normal.
//! - Missing normals are computed within each mesh ([`normals`]): weighted by angle, and split at creases, or by the
//!   smoothing groups of an OBJ file.
//! - Coarse models can be smoothed by their normals ([`pn_triangles`]): closed surfaces remain closed, and edges
//!   within a smoothed face can be contours.
//! - Lines that a file has besides its faces are kept ([`Model::lines`]), and so is what it says of the edges of its faces
//!   ([`Model::side_visibility`]). Points are not.
//! - A mesh that several nodes place is loaded once. Skinned nodes and nodes with other morph weights have a mesh of
//!   their own.
//! - Faces are counter-clockwise seen from outside in the space of their mesh. A mirroring transform does not turn a
//!   mesh inside out: [`Model::transformed`] reverses the faces.
//! - Of faces that overlap in one plane the one turned to the eye is seen, then the later in the file ([`coplanar`], which
//!   is not applied when a file is loaded).
//! - There is a rule for non-manifold edges, opposite windings, T-junctions, faces without area and faces that overlap, see
//!   [`edges`]. None of them removes a line that should be visible, and none depends on the order of the faces but where
//!   it says so. For statistics of a file none applies ([`edges::EdgeOptions::of_file`]).
//! - Transforms of nodes, instances and joints are composed in f64. [`Object::world_from_mesh`] keeps them, so that a city
//!   at large coordinates has the digits of the file; `Loaded::into_model_near` subtracts its origin before it narrows
//!   them to f32.
//! - Files are not trusted: indices, lengths, types and numbers are checked before use, and sizes are checked against
//!   [`Limits`] before memory is allocated. A violation is a [`LoadError`] that names the file, the element and the
//!   fault. Repaired or skipped elements are reported as warnings.
//! - Files that a model refers to (materials, textures, buffers) are read only from the model's own folder and its
//!   subfolders, and from `LoadOptions::asset_root`. `..`, absolute names and symbolic links must not leave these
//!   folders. Only regular files are read, and nothing from a network.
//! - Results do not depend on the scale of the model: sizes of 1e-30 or 1e30 work like 1.
//! - Results do not depend on the distance from the origin, as far as the file has digits. Where the centre of an OBJ, PLY
//!   or STL model is at least four times its diagonal away, an offset is subtracted in f64 before positions become f32,
//!   and the object carries it as its translation. Where the file's numbers have lost digits, a warning tells the step.
//!
//! # Colours
//!
//! Material colours, vertex colours and emission are linear, textures are sRGB-encoded bytes. They are multiplied in
//! linear light and encoded once. What a surface emits is added to its shaded colour after that: display-referred, and
//! unchanged by light and shadow. OBJ and PLY files have sRGB-encoded colours, which are converted.
//!
//! # Sources
//!
//! - D. Card, J. L. Mitchell: *Non-Photorealistic Rendering with Pixel and Vertex Shaders*, in *Direct3D ShaderX*,
//!   2002, "Rendering Outlines": unique edges with the normals of their two faces, the negated normal at a boundary.
//! - A. Vlachos, J. Peters, C. Boyd, J. L. Mitchell: *Curved PN Triangles*, I3D 2001: [`pn_triangles`].
//! - M. Newell's teapot: [`embedded::teapot`]. Sources of algorithms are cited where they are used.
#![warn(missing_docs)]

pub mod coplanar;
mod edge_visibility;
pub mod edges;
pub mod embedded;
mod error;
#[cfg(feature = "export")]
pub mod export;
mod limits;
#[cfg(any(feature = "obj", feature = "gltf", feature = "ply", feature = "stl"))]
mod load;
mod model;
pub mod normals;
mod object;
pub mod pn_triangles;
mod side_visibility;
pub mod subdivide;
mod transform;
pub mod triangulate;
mod up;
pub mod weld;

/// The vector and matrix types in this API.
pub use glam;

pub use edge_visibility::edge_visibility;
pub use error::LoadError;
pub use limits::Limits;
#[cfg(any(feature = "obj", feature = "gltf", feature = "ply", feature = "stl"))]
pub use load::{LoadOptions, Loaded, Resolver, Warning, load, load_bytes};
pub use model::{AlphaMode, Material, Model, Texture, Wrap};
pub use object::Object;
pub use side_visibility::SideVisibility;
pub use up::UpAxis;

/// Compiles the example of the README.
#[cfg(all(doctest, any(feature = "obj", feature = "gltf", feature = "ply", feature = "stl")))]
#[doc = include_str!("../README.md")]
struct ReadMe;
