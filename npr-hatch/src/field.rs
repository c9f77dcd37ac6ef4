//! Direction fields on triangle meshes, for strokes that follow the form.
//!
//! ```
//! use glam::Vec3;
//! use npr_hatch::field::{FieldOptions, direction_field};
//!
//! // An open cylinder around the y axis: 16 vertices at the bottom, 16 at the top.
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
//! # Method
//!
//! 1. The curvature of each face is a least-squares fit to the normals at its corners; a position has the mean over its
//!    faces weighted by area (Rusinkiewicz 2004). Hard edges, where corners at one position have different normals, do not
//!    contribute. Where a connected component consists of flat facets, or a normal is missing, means of face normals are
//!    used instead (Max 1999).
//! 2. The curvature is averaged over [`FieldOptions::smoothing`], so that smaller bumps cancel.
//! 3. The principal directions have a confidence. With the mean curvature H and half the difference r of the principal
//!    curvatures, the absolute principal curvatures are ||H| ± r| and differ by 2 min(|H|, r). By this difference, relative
//!    to the larger of |H| and r and to the size of the component, the confidence goes from 0 (planes, spheres, symmetric
//!    saddles) to 1 (cylinders).
//! 4. The directions are diffused over the surface, weighted by confidence. Lines are transported between tangent planes by
//!    the smallest rotation. Within about 20 smoothing lengths, points of low confidence adopt the surrounding directions;
//!    beyond, the fallback direction is used.
//!
//! Lengths are fractions of the size of a connected component, the square root of its area. Both averages are solved from
//! coarse to fine, so that they hardly depend on the tessellation. Apart from the fallback the field is invariant to
//! rotation and scale. The result is deterministic to the bit.
//!
//! # Limits
//!
//! Where the mean curvature of a saddle changes its sign, the direction of the larger absolute curvature changes, and the
//! field turns by 90° within about one smoothing length. On every closed surface other than a torus a field has singular
//! points. In both cases interpolated tensors pass through a double eigenvalue.
//!
//! Smoothing straightens lines where principal directions turn quickly. With the default, on an ellipsoid with the
//! semi-axes 1.5, 1 and 0.7, the error is at most 4.5° where the smaller curvature is less than 0.7 of the larger, and 0.4°
//! on average.
//!
//! # Sources
//!
//! - S. Rusinkiewicz: *Estimating Curvatures and Their Derivatives on Triangle Meshes*, 3DPVT 2004.
//! - A. Hertzmann, D. Zorin: *Illustrating Smooth Surfaces*, SIGGRAPH 2000: directions of curvature where they are
//!   reliable, smoothed elsewhere.
//! - F. Knöppel, K. Crane, U. Pinkall, P. Schröder: *Globally Optimal Direction Fields*, SIGGRAPH 2013: lines as
//!   complex numbers in tangent planes, and their parallel transport.
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

/// A principal direction of curvature.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PrincipalDirection {
    /// The direction of the larger absolute curvature: around a cylinder.
    #[default]
    Larger,
    /// The direction of the smaller absolute curvature: along a cylinder.
    Smaller,
}

/// Options of [`direction_field`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldOptions {
    /// The length over which curvature and directions are averaged, as a fraction of the square root of the area of the
    /// connected component: 0..=1. At 0 there is no averaging.
    pub smoothing: f32,
    /// The direction of strokes, projected into the surface, where curvature determines none. Any finite vector except 0.
    pub fallback: Vec3,
    /// The principal direction that strokes follow.
    pub principal: PrincipalDirection,
}

impl Default for FieldOptions {
    /// A smoothing of 0.02, the direction of the larger curvature, and a fallback oblique to all axes.
    fn default() -> Self {
        Self { smoothing: 0.02, fallback: Vec3::new(0.48, 0.64, 0.6), principal: PrincipalDirection::Larger }
    }
}

impl FieldOptions {
    /// Checks all fields and returns the first violation.
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

/// The ratio min(|H|, r) / max(|H|, r) at which the confidence is 1/2.
const HALF_CONFIDENCE_RATIO: f32 = 0.2;
/// The difference of the absolute principal curvatures, times the size of the component, at which the confidence is 1/2. A
/// cylinder twice as long as its radius has 3.5.
const HALF_CONFIDENCE_CURVATURE: f32 = 0.5;
/// The confidence of the fallback: directions spread over 1 / √FLOOR = 20 smoothing lengths.
const FLOOR: f32 = 0.0025;

/// Per vertex the direction of strokes: a unit vector in the tangent plane, as a tensor.
///
/// - `positions`, `normals`: per vertex. Normals may have any length.
/// - `faces`: three vertices each.
/// - `representative`: per vertex, a common vertex for all vertices at its position, which share one line of the field. The
///   field is continuous across texture seams, and follows the surface over hard edges. The fallback is projected into each
///   vertex's own plane.
///
/// Every tensor is finite and has a trace of 1, for any input. Faces with zero area or non-finite corners are ignored.
/// Vertices without other faces have the fallback direction, projected unless their normal is zero or not finite.
///
/// Errors: slices of different lengths, indices out of range, and those of [`FieldOptions::validate`].
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

/// Per node the tangent plane of the mean of the normals at its corners.
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
    // Where the normals of two back-to-back sides cancel, the first normal is used.
    let unit = |(sum, first): (DVec3, DVec3)| {
        let sum = sum.normalize_or(first);
        Tangent::new(sum.as_vec3().normalize_or(Vec3::Z))
    };
    sums.into_iter().zip(first).map(unit).collect()
}

/// The confidence and the line of a principal direction of this curvature.
fn principal(curvature: Value, principal: PrincipalDirection) -> (f32, Value) {
    let (mean, half) = (curvature.scalar.abs(), curvature.line.length());
    let (less, more) = (mean.min(half), mean.max(half));
    let Some(line) = curvature.line.try_normalize().filter(|_| more > 0.0 && more.is_finite()) else {
        return (0.0, Value::default());
    };
    // The line is that of the larger signed curvature, which for a negative mean has the smaller absolute value.
    let sign = if (curvature.scalar < 0.0) == (principal == PrincipalDirection::Larger) { -1.0 } else { 1.0 };
    let confidence = saturate(less / more / HALF_CONFIDENCE_RATIO) * saturate(2.0 * less / HALF_CONFIDENCE_CURVATURE);
    (confidence, Value { scalar: 1.0, line: line * sign })
}

/// x⁴ / (1 + x⁴): 0 at 0, 1/2 at 1, and close to 1 above 2.
fn saturate(x: f32) -> f32 {
    let x = x.min(100.0);
    let x = x * x * x * x;
    x / (1.0 + x)
}

/// The unit direction at a vertex: the line of its node, transported into the plane of the vertex, plus the fallback
/// weighted by the missing confidence.
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
    // Squared, so that the fallback hardly affects directions of high confidence.
    line += tangent.line(fallback) * missing * missing;
    tangent.direction(line).unwrap_or(tangent.u)
}

/// Checks that per-vertex arrays have the length of the positions.
pub(crate) fn check_lengths(vertices: usize, arrays: &[(&'static str, usize)]) -> Result<(), HatchError> {
    match arrays.iter().find(|(_, found)| *found != vertices) {
        Some(&(name, found)) => Err(HatchError::PerVertex { name, found, vertices }),
        None => Ok(()),
    }
}

/// Checks that all indices are in range.
pub(crate) fn check_indices(vertices: usize, faces: &[[u32; 3]], representative: &[u32]) -> Result<(), HatchError> {
    let corners = faces.iter().enumerate().flat_map(|(index, face)| face.map(|vertex| ("faces", index, vertex)));
    let representatives = representative.iter().enumerate().map(|(index, &vertex)| ("representative", index, vertex));
    match corners.chain(representatives).find(|&(.., vertex)| vertex as usize >= vertices) {
        Some((name, index, vertex)) => Err(HatchError::NoVertex { name, index, vertex, vertices }),
        None => Ok(()),
    }
}
