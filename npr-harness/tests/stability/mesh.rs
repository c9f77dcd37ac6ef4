//! Limits of meshes: scale, coincident faces, junctions, welding.
