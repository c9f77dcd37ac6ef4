//! Model files in; clean triangles, normals and edges out.
//!
//! ```
//! use npr_mesh::{edges, embedded};
//!
//! let model = embedded::cube(); // or, from a file: npr_mesh::load(path, &Default::default())?.model
//! let found =
//!     edges::find(&model.positions, &model.faces, &model.face_polygon, &model.face_material, &Default::default());
//! let creases = found.edges.iter().filter(|edge| found.dihedral_rad(edge) > Some(30f32.to_radians()));
//! assert_eq!(creases.count(), 12); // no diagonals: the cube's faces are squares
//! ```
//!
//! [`Model`] is plain arrays: positions, normals, texture coordinates, triangles. `load` fills them from `.obj`
//! (feature `obj`), `.gltf` and `.glb` (feature `gltf`); [`embedded`] from nothing. Both features are on by default.
//!
//! # Rules
//!
//! - A face is the triple of its corners as loaded. Vertices at exactly equal positions are one vertex for edges, so
//!   that texture and normal seams are no boundaries, and stay apart for shading.
//! - A polygon of n corners becomes n − 2 triangles ([`triangulate`]). The diagonals are no edges, and all triangles of
//!   a polygon have its Newell normal.
//! - What a file has no normals for gets them ([`normals`]): weighted by angle, split at creases.
//! - A coarse model becomes round by its normals ([`pn_triangles`]): what was closed stays closed, and the edges within
//!   a rounded face can be contours.
//! - Non-manifold edges, opposite windings, faces without area and doubled faces each have a rule, see [`edges`]. None
//!   of them makes a line disappear that should be seen.
//! - A file is never trusted: indices, lengths, types and numbers are checked before use, sizes against [`Limits`],
//!   before memory is asked for them, and what is wrong is a [`LoadError`] that names the file, the element and the
//!   fault. What could be repaired or left out is a warning beside the model.
//! - What a model names (materials, textures, buffers) is read from its own folder or below, and from
//!   `LoadOptions::asset_root` if there is one; `..`, absolute names and symbolic links may lead from one place there to
//!   another and nowhere else. Only regular files are read, and nothing from a network.
//! - No size is too small or too large: what is computed of a model at 1e-30 or 1e30 is what it is at 1.
//!
//! # Colours
//!
//! A material's colour and the vertex colours are linear, textures are sRGB-encoded bytes. Their product is taken in
//! linear light and encoded once.
//!
//! # Sources
//!
//! - D. Card, J. L. Mitchell: *Non-Photorealistic Rendering with Pixel and Vertex Shaders*, in *Direct3D ShaderX*,
//!   2002, "Rendering Outlines": unique edges with the normals of their two faces, the negated normal at a boundary.
//! - A. Vlachos, J. Peters, C. Boyd, J. L. Mitchell: *Curved PN Triangles*, I3D 2001: [`pn_triangles`].
//! - M. Newell's teapot: [`embedded::teapot`]. Those of the algorithms are named where they are used.
#![warn(missing_docs)]

pub mod edges;
pub mod embedded;
mod error;
mod limits;
#[cfg(any(feature = "obj", feature = "gltf"))]
mod load;
mod model;
pub mod normals;
pub mod pn_triangles;
pub mod subdivide;
pub mod triangulate;
pub mod weld;

/// The crate of the vectors and matrices in this API.
pub use glam;

pub use error::LoadError;
pub use limits::Limits;
#[cfg(any(feature = "obj", feature = "gltf"))]
pub use load::{LoadOptions, Loaded, Warning, load};
pub use model::{AlphaMode, Material, Model, Texture, Wrap};

/// Compiles the example of the README.
#[cfg(all(doctest, any(feature = "obj", feature = "gltf")))]
#[doc = include_str!("../README.md")]
struct ReadMe;
