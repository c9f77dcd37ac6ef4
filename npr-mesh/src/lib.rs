//! Model files in; clean triangles, normals and edges out.
#![warn(missing_docs)]

pub mod edges;
pub mod embedded;
mod error;
mod limits;
#[cfg(any(feature = "obj", feature = "gltf"))]
mod load;
mod model;
pub mod normals;
pub mod subdivide;
pub mod triangulate;
pub mod weld;

pub use error::LoadError;
pub use limits::Limits;
#[cfg(any(feature = "obj", feature = "gltf"))]
pub use load::{LoadOptions, Loaded, load};
pub use model::{AlphaMode, Material, Model, Texture, Wrap};
