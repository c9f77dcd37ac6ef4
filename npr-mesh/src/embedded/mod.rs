//! Built-in models: the Utah teapot, simple solids, and a still life made of them.
//!
//! Right-handed, Y up, without texture coordinates. Each solid has one default [`Material`](crate::Material);
//! [`placed`] transforms it and assigns another material.

mod scene;
mod solids;
mod teapot;

pub use scene::scene;
pub use solids::{cone, cube, cylinder, ground, placed, sphere, torus};
pub use teapot::teapot;
