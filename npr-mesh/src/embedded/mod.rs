//! Models that need no file: the Utah teapot, a few solids, and a still life made of them.
//!
//! Right-handed, Y up, without texture coordinates. Each solid comes with one default [`Material`](crate::Material);
//! [`placed`] moves it and gives it another.

mod scene;
mod solids;
mod teapot;

pub use scene::scene;
pub use solids::{cone, cube, cylinder, ground, placed, sphere, torus};
pub use teapot::teapot;
