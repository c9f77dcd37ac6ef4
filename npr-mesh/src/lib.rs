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
//! (feature `obj`), `.gltf` and `.glb` (feature `gltf`): the meshes of the file, each once as a `Model` of its own, and
//! the [`Object`]s that place them. `Loaded::into_model` puts all objects into one model in world space. [`embedded`]
//! has built-in models. Both features are enabled by default.
//!
//! # Rules
//!
//! - A face is the triple of its corners as loaded. For edges and computed normals, vertices that only rounding separates,
//!   within 8 units in the last place of the mesh's largest coordinate, are one vertex ([`weld`]), so that texture and
//!   normal seams are not boundaries. For shading they remain separate. `LoadOptions::weld` overrides the distance.
//! - A polygon of n corners becomes n − 2 triangles ([`triangulate`]). Diagonals are not edges, and all triangles of
//!   a polygon have its Newell normal.
//! - Missing normals are computed within each mesh ([`normals`]): weighted by angle, and split at creases.
//! - Coarse models can be smoothed by their normals ([`pn_triangles`]): closed surfaces remain closed, and edges
//!   within a smoothed face can be contours.
//! - A mesh that several nodes place is loaded once. Skinned nodes and nodes with other morph weights have a mesh of
//!   their own.
//! - Faces are counter-clockwise seen from outside in the space of their mesh. A mirroring transform does not turn a
//!   mesh inside out: [`Model::transformed`] reverses the faces.
//! - There is a rule for non-manifold edges, opposite windings, T-junctions, faces without area and faces that overlap, see
//!   [`edges`]. None of them removes a line that should be visible, and none depends on the order of the faces but where
//!   it says so. For statistics of a file none applies ([`edges::EdgeOptions::of_file`]).
//! - Files are not trusted: indices, lengths, types and numbers are checked before use, and sizes are checked against
//!   [`Limits`] before memory is allocated. A violation is a [`LoadError`] that names the file, the element and the
//!   fault. Repaired or skipped elements are reported as warnings.
//! - Files that a model refers to (materials, textures, buffers) are read only from the model's own folder and its
//!   subfolders, and from `LoadOptions::asset_root`. `..`, absolute names and symbolic links must not leave these
//!   folders. Only regular files are read, and nothing from a network.
//! - Results do not depend on the scale of the model: sizes of 1e-30 or 1e30 work like 1.
//!
//! # Colours
//!
//! Material colours and vertex colours are linear, textures are sRGB-encoded bytes. They are multiplied in linear
//! light and encoded once.
//!
//! # Sources
//!
//! - D. Card, J. L. Mitchell: *Non-Photorealistic Rendering with Pixel and Vertex Shaders*, in *Direct3D ShaderX*,
//!   2002, "Rendering Outlines": unique edges with the normals of their two faces, the negated normal at a boundary.
//! - A. Vlachos, J. Peters, C. Boyd, J. L. Mitchell: *Curved PN Triangles*, I3D 2001: [`pn_triangles`].
//! - M. Newell's teapot: [`embedded::teapot`]. Sources of algorithms are cited where they are used.
#![warn(missing_docs)]

pub mod edges;
pub mod embedded;
mod error;
mod limits;
#[cfg(any(feature = "obj", feature = "gltf"))]
mod load;
mod model;
pub mod normals;
mod object;
pub mod pn_triangles;
pub mod subdivide;
mod transform;
pub mod triangulate;
pub mod weld;

/// The vector and matrix types in this API.
pub use glam;

pub use error::LoadError;
pub use limits::Limits;
#[cfg(any(feature = "obj", feature = "gltf"))]
pub use load::{LoadOptions, Loaded, Warning, load};
pub use model::{AlphaMode, Material, Model, Texture, Wrap};
pub use object::Object;

/// Compiles the example of the README.
#[cfg(all(doctest, any(feature = "obj", feature = "gltf")))]
#[doc = include_str!("../README.md")]
struct ReadMe;
