//! A field of directions on any triangle mesh, for strokes that follow the form.
//!
//! ```
//! use glam::Vec3;
//! use npr_hatch::field::{FieldOptions, direction_field};
//!
//! // An open cylinder around y: 16 corners below, 16 above.
//! let ring = |y: f32| (0..16).map(move |i| (Vec3::Z.rotate_y(i as f32 * std::f32::consts::TAU / 16.0), y));
//! let (normals, positions): (Vec<_>, Vec<_>) = ring(-1.0).chain(ring(1.0)).map(|(n, y)| (n, n + Vec3::Y * y)).unzip();
//! let faces: Vec<_> = (0..16).flat_map(|i| { let j = (i + 1) % 16; [[i, j, j + 16], [i, j + 16, i + 16]] }).collect();
//! let alone: Vec<u32> = (0..32).collect();
//! let field = direction_field(&positions, &normals, &faces, &alone, &FieldOptions::default())?;
//! for (tensor, normal) in field.iter().zip(&normals) {
//!     let around = normal.cross(Vec3::Y);
//!     assert!(tensor.direction().dot(around).abs() > 0.999);
//! }
//! # Ok::<(), npr_hatch::HatchError>(())
//! ```
//!
//! # How
//!
//! 1. Curvature, in each face by least squares from the normals at its corners, summed by area over the faces around a
//!    position (Rusinkiewicz 2004). Hard edges, where corners at one position have different normals, are no curvature.
//!    Where a connected part has only facets, or a normal is missing, means of face normals stand in (Max 1999).
//! 2. The curvature is averaged over [`FieldOptions::smoothing`]: bumps that are smaller cancel out.
//! 3. Principal directions, and confidence: the two absolute curvatures are |H| ± r by the mean curvature H and half
//!    their difference r, or the other way round, so apart by 2 min(|H|, r). By this, relative to the larger and to the
//!    part's size, the confidence goes from 0 (planes, spheres, saddles that bend as much either way) to 1
//!    (cylinders).
//! 4. The directions diffuse over the surface, those with confidence holding on; lines are carried from one tangent
//!    plane to the next by the smallest rotation. What they reach within about 20 smoothing lengths takes on their
//!    direction; beyond, the fallback takes over.
//!
//! Lengths are shares of a connected part's size, the root of its area. Both averages are solved coarse to fine, so
//! that the tessellation has little part in them. The fallback aside, the field turns with the model, and it does not
//! depend on its size. The same input gives the same field to the bit.
//!
//! # What to expect
//!
//! Where the mean curvature of a saddle changes its sign, the larger absolute curvature changes over, and the field
//! turns by 90° within a smoothing length or so. And every field on a closed surface that is no torus has singular
//! points. Interpolated tensors pass through a double eigenvalue at both.
//!
//! Smoothing bends lines towards straight ones where principal directions turn fast: with the default, on an ellipsoid
//! of semi-axes 1.5, 1 and 0.7, by up to 4.5° where the smaller curvature is less than 0.7 of the larger one, and by
//! 0.4° in the mean.
//!
//! # Sources
//!
//! - S. Rusinkiewicz: *Estimating Curvatures and Their Derivatives on Triangle Meshes*, 3DPVT 2004.
//! - A. Hertzmann, D. Zorin: *Illustrating Smooth Surfaces*, SIGGRAPH 2000: directions of curvature where they are
//!   certain, smoothed into the rest.
//! - F. Knöppel, K. Crane, U. Pinkall, P. Schröder: *Globally Optimal Direction Fields*, SIGGRAPH 2013: lines as
//!   complex numbers in tangent planes, and their transport.
//! - U. Pinkall, K. Polthier: *Computing Discrete Minimal Surfaces and Their Conjugates*, 1993: cotangent weights.
//! - N. Max: *Weights for Computing Vertex Normals from Facet Normals*, 1999.

mod corner_normals;
mod curvature;
mod diffuse;
mod surface;
mod tangent;
mod tensor;
#[cfg(test)]
mod tests;

use glam::{DVec3, Vec2, Vec3};

use crate::HatchError;
use diffuse::{Hierarchy, Value};
use surface::{NO_NODE, Surface};
use tangent::{Tangent, carry};

pub use tensor::LineTensor;

/// Along which of the two principal directions strokes run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Principal {
    /// That of the larger absolute curvature: round a cylinder.
    #[default]
    Most,
    /// That of the smaller one: along a cylinder.
    Least,
}

/// How a field is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldOptions {
    /// Over what length curvature and directions are averaged, as a share of the root of the connected part's area:
    /// 0..=1. At 0 each vertex speaks for itself.
    pub smoothing: f32,
    /// What strokes follow where the form says nothing, projected into the surface: any finite length but 0.
    pub fallback: Vec3,
    /// Along or across.
    pub principal: Principal,
}

impl Default for FieldOptions {
    /// A smoothing of 0.02, and a fallback oblique to all axes.
    fn default() -> Self {
        Self { smoothing: 0.02, fallback: Vec3::new(0.48, 0.64, 0.6), principal: Principal::Most }
    }
}

impl FieldOptions {
    /// Which rule is broken, if one is; the first found.
    pub fn validate(&self) -> Result<(), HatchError> {
        let Self { smoothing, fallback, .. } = *self;
        if !(0.0..=1.0).contains(&smoothing) {
            return Err(HatchError::Range { name: "smoothing", value: smoothing, low: 0.0, high: 1.0 });
        }
        if corner_normals::unit(fallback) == DVec3::ZERO {
            return Err(HatchError::Direction { value: fallback.to_array() });
        }
        Ok(())
    }
}

/// The share of each curvature in the larger one at which the confidence is half: a0 in a⁴ / (a⁴ + a0⁴).
const APART: f32 = 0.2;
/// The difference of absolute curvatures, times the part's size, at which the confidence is half. A cylinder twice as
/// long as its radius has 3.5.
const CURVED: f32 = 0.5;
/// The confidence of the fallback: directions reach 1 / √ of this, 20, smoothing lengths.
const FLOOR: f32 = 0.0025;

/// Per vertex the direction of strokes, a unit tangent direction as a tensor.
///
/// - `positions`, and `normals` for shading: per vertex; normals of any length.
/// - `faces`: three vertices each.
/// - `representative`: per vertex the one that stands for all at its position. The field is one at all of them: it goes
///   on across seams of texture coordinates, and where normals differ it bends over the edge with the surface. (The
///   fallback is projected into each vertex's own plane.)
///
/// Every tensor is finite and has the trace 1, whatever the numbers. Faces without an area or with corners that are not
/// finite do not count, and a vertex that is in no other has the fallback; so has a normal that is zero or not finite,
/// where nothing can be said about its plane, the fallback itself.
///
/// Errors: slices of unequal length, indices out of range, options that [`FieldOptions::validate`] refuses.
pub fn direction_field(
    positions: &[Vec3],
    normals: &[Vec3],
    faces: &[[u32; 3]],
    representative: &[u32],
    options: &FieldOptions,
) -> Result<Vec<LineTensor>, HatchError> {
    options.validate()?;
    check_lengths(positions.len(), &[("normals", normals.len()), ("representative", representative.len())])?;
    check_indices(positions.len(), faces, representative)?;
    let surface = Surface::new(positions, faces, representative);
    let corner_normals = corner_normals::corner_normals(&surface, positions, normals, faces);
    let corners = |face: u32| faces[face as usize].map(|v| positions[v as usize].as_dvec3());
    let hierarchy = Hierarchy::new(&surface, tangents(&surface, &corner_normals), corners);
    let tangents = &hierarchy.levels[0].tangents;

    let given = surface.faces.iter().map(|face| corners(face.given)).zip(corner_normals);
    let curvature = curvature::curvature(&surface, tangents, given);
    let known: Vec<_> = curvature.into_iter().map(|value| (1.0, value)).collect();
    let curvature = hierarchy.diffuse(&known, options.smoothing, 0.0);
    let known: Vec<_> = curvature.into_iter().map(|value| principal(value, options.principal)).collect();
    let lines = hierarchy.diffuse(&known, options.smoothing, FLOOR);

    let fallback = corner_normals::unit(options.fallback).as_vec3();
    let of_vertex = |(&node, &normal): (&u32, &Vec3)| {
        let node = (node != NO_NODE).then(|| (&tangents[node as usize], lines[node as usize]));
        LineTensor::from_direction(at_vertex(node, corner_normals::unit(normal).as_vec3(), fallback))
    };
    Ok(surface.node_of.iter().zip(normals).map(of_vertex).collect())
}

/// Per node the plane of the mean of its corners' normals.
fn tangents(surface: &Surface, corner_normals: &[[DVec3; 3]]) -> Vec<Tangent> {
    let mut sums = vec![DVec3::ZERO; surface.nodes()];
    let mut first = vec![DVec3::ZERO; surface.nodes()];
    for (face, corners) in surface.faces.iter().zip(corner_normals) {
        let size = surface.size_at(face);
        for (&node, &normal) in face.nodes.iter().zip(corners) {
            sums[node as usize] += normal * (face.area / (size * size));
            if first[node as usize] == DVec3::ZERO {
                first[node as usize] = normal;
            }
        }
    }
    // Back to back, the sides cancel: then the first one counts.
    let unit = |(sum, first): (DVec3, DVec3)| {
        let sum = sum.normalize_or(first);
        Tangent::new(sum.as_vec3().normalize_or(Vec3::Z))
    };
    sums.into_iter().zip(first).map(unit).collect()
}

/// From curvature to the line that strokes follow, and how sure that is.
fn principal(curvature: Value, principal: Principal) -> (f32, Value) {
    let (mean, half) = (curvature.scalar.abs(), curvature.line.length());
    let (less, more) = (mean.min(half), mean.max(half));
    let Some(line) = curvature.line.try_normalize().filter(|_| more > 0.0 && more.is_finite()) else {
        return (0.0, Value::default());
    };
    // The line is that of the larger signed curvature; where both are mostly negative the other one is larger.
    let sign = if (curvature.scalar < 0.0) == (principal == Principal::Most) { -1.0 } else { 1.0 };
    let confidence = saturate(less / more / APART) * saturate(2.0 * less / CURVED);
    (confidence, Value { scalar: 1.0, line: line * sign })
}

/// 0 at 0, half at 1, nearly 1 beyond 2.
fn saturate(x: f32) -> f32 {
    let x = x.min(100.0);
    let x = x * x * x * x;
    x / (1.0 + x)
}

/// The unit direction at a vertex: its node's line carried into its own plane, and of the fallback what that lacks.
fn at_vertex(node: Option<(&Tangent, Value)>, normal: Vec3, fallback: Vec3) -> Vec3 {
    let Some(normal) = normal.try_normalize().or(node.map(|(tangent, _)| tangent.normal)) else { return fallback };
    let tangent = Tangent::new(normal);
    let mut line = Vec2::ZERO;
    let mut missing = 1.0;
    if let Some((from, value)) = node {
        missing = (1.0 - value.scalar).clamp(0.0, 1.0);
        if let Some(direction) = from.direction(value.line) {
            let carried = tangent.line(carry(direction, from.normal, normal));
            line = carried.normalize_or_zero() * value.line.length();
        }
    }
    // Squared, so that what is all but known stays what it is.
    line += tangent.line(fallback) * missing * missing;
    tangent.direction(line).unwrap_or(tangent.u)
}

/// Per vertex arrays must have the positions' length.
pub(crate) fn check_lengths(vertices: usize, arrays: &[(&'static str, usize)]) -> Result<(), HatchError> {
    match arrays.iter().find(|(_, found)| *found != vertices) {
        Some(&(name, found)) => Err(HatchError::PerVertex { name, found, vertices }),
        None => Ok(()),
    }
}

/// Every index must be one of a vertex.
pub(crate) fn check_indices(vertices: usize, faces: &[[u32; 3]], representative: &[u32]) -> Result<(), HatchError> {
    let corners = faces.iter().enumerate().flat_map(|(index, face)| face.map(|vertex| ("faces", index, vertex)));
    let standing = representative.iter().enumerate().map(|(index, &vertex)| ("representative", index, vertex));
    match corners.chain(standing).find(|&(.., vertex)| vertex as usize >= vertices) {
        Some((name, index, vertex)) => Err(HatchError::NoVertex { name, index, vertex, vertices }),
        None => Ok(()),
    }
}
