//! The inverted hull: a model's back faces, displaced outwards on the screen and drawn in ink behind its surface, so
//! that a band of ink remains visible around it.
//!
//! The outline that games use most. R. Raskar and M. Cohen enlarge back-facing polygons so that they show behind the
//! front faces (*Image Precision Silhouette Edges*, I3D 1999), and Raskar extends them by quadrilaterals at their edges
//! in hardware (*Hardware Support for Non-photorealistic Rendering*, Graphics Hardware 2001). Engines displace vertices
//! along a normal instead and cull front faces, which is what this module does; no adjacency is needed, and the cost is
//! that of drawing all faces a second time.
//!
//! # Width
//!
//! The displacement has a constant length on the screen: a clip-space offset times w, as for lines ([`crate::segment`]).
//! Its direction is that of the normal in view space, without its component along the view. At a contour of a smooth
//! surface that is perpendicular to the contour's image, off the view's axis too, so the band there is
//! [`HullView::width_px`] wide, all of it outside the surface. (The projected path of the displaced point would not be
//! perpendicular off the axis.) Normals that point nearly along the view have no reliable direction: within
//! [`HULL_LEAST_ASIDE`] the displacement shrinks to 0.
//!
//! Depth is that of the vertex, moved away by [`HULL_BEHIND_WIDTHS`] widths and [`HULL_BEHIND_PX`]. A back face that is
//! displaced along its own normal at constant depth lies behind itself, so that a surface hides its own hull where its
//! back is visible. At a corner the normal is not the face's own, and a face nearly parallel to the picture may be
//! displaced against its normal, or in its own plane; the further distance is for these. The band is hidden by what lies
//! within that distance behind the surface.
//!
//! # What it cannot do
//!
//! - It draws contours and boundaries beside back faces, no creases within the surface, no borders between materials.
//! - Beside a hard edge the band is as wide as the component of the displacement perpendicular to that edge, which is
//!   less than the width. In concave corners it is narrower still, and where neighbouring vertices pass each other,
//!   displaced front faces turn around and appear as specks of ink.
//! - *Open surfaces*: from the front a boundary has no band, since no back face is beside it. From the back the hull is
//!   a copy of the surface, displaced and behind it. A surface that is drawn from the front only does not hide it: from
//!   the back, its hull alone is visible.
//! - Where an object stands on another, the band below it is inside the other and hidden.
//! - With normals of vertices ([`HullNormals::Vertices`]) hard edges tear: see there.
//!
//! In f64, the twin of `hull.wgsl`.

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4, Vec3};
use npr_mesh::edges::Edges;
use npr_mesh::{AlphaMode, Model};
use std::collections::HashSet;

/// WGSL functions: no bindings, no entry points.
pub const HULL_WGSL: &str = include_str!("hull.wgsl");

/// The sine of the angle between a normal and the view below which the displacement is shorter than the width: 0.6°.
///
/// A cube seen along an axis has normals whose component beside the view is rounding; divided by its own length, it
/// would displace vertices by the whole width in a random direction.
pub const HULL_LEAST_ASIDE: f64 = 0.01;

/// How far behind its vertex the hull is, in widths: as far as a face of a right-angled corner (a cube's) can be in front
/// of itself when it is displaced along the corner's normal, which is tan 54.7°, and a little more.
pub const HULL_BEHIND_WIDTHS: f64 = 1.5;

/// How much further behind its vertex the hull is, px at its depth. Above the rounding of depths.
pub const HULL_BEHIND_PX: f64 = 0.5;

/// Along which normal a vertex of the hull is displaced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HullNormals {
    /// One normal for each position, the mean of the normals of all faces there, weighted by their angles: all faces at
    /// a position are displaced alike, and the hull stays as closed as the model.
    #[default]
    Welded,
    /// The vertex' own shading normal, as most engines have it. At a hard edge, where vertices of equal positions have
    /// different normals, the hull's faces are displaced apart, and the band has gaps at corners.
    Vertices,
}

/// A vertex of a hull, 24 bytes.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct HullVertex {
    /// Position, world space.
    pub position: Vec3,
    /// The normal along which it is displaced, of any length. A vertex without one (zero) stays in place.
    pub normal: Vec3,
}

const _: () = assert!(size_of::<HullVertex>() == 24);

/// The hull of a model: 24 bytes a vertex and 12 bytes a face.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hull {
    /// With [`HullNormals::Welded`] one for each position, with [`HullNormals::Vertices`] one for each vertex; those that
    /// faces use, in the order of their first use.
    pub vertices: Vec<HullVertex>,
    /// Three vertices each, counter-clockwise seen from outside, as in the model.
    pub faces: Vec<[u32; 3]>,
}

impl Hull {
    /// Gathers the faces of a model that are in the hull, and the normals along which their corners are displaced.
    ///
    /// - Faces skipped as duplicates, or with two corners at one position, are left out, and so are those of blended and cut-out materials, through which the
    ///   hull behind them would be visible. They do not contribute to normals.
    /// - Faces without area contribute no normal, but are part of the hull: they fill the gap beside a T-junction.
    /// - Where the faces at a position cancel out, or have no area, the welded normal is zero. Shading normals that are
    ///   not finite count as zero.
    /// - The front of a face is that of its winding. A face that is wound oppositely to its neighbours is drawn where
    ///   they are not, and reduces their welded normals.
    ///
    /// `edges`: of this model, whose vertices of equal positions and face normals are used. Temporarily takes 28 bytes
    /// for each vertex of the model.
    pub fn new(model: &Model, edges: &Edges, normals: HullNormals) -> Self {
        let mut duplicates = HashSet::new();
        if edges.skipped.contains(&true) {
            duplicates.extend(edges.overlaps.iter().map(|pair| pair[1]));
        }
        let fills_gap = |face: usize| {
            let [a, b, c] = model.faces[face].map(|vertex| edges.representative[vertex as usize]);
            a != b && b != c && c != a && !duplicates.contains(&(face as u32))
        };
        let is_in = |&(face, _): &(usize, &[u32; 3])| {
            (edges.skipped.get(face) != Some(&true) || fills_gap(face))
                && model.material_of(face as u32).is_none_or(|material| material.alpha_mode == AlphaMode::Opaque)
        };
        let faces = || model.faces.iter().enumerate().filter(is_in);
        let source = |vertex: u32| match normals {
            HullNormals::Welded => edges.representative[vertex as usize],
            HullNormals::Vertices => vertex,
        };
        let mut sums = Vec::new();
        if normals == HullNormals::Welded {
            sums = vec![DVec3::ZERO; model.positions.len()];
            for (face, corners) in faces() {
                let normal = edges.face_normals[face].as_dvec3();
                let angles_rad = corner_angles_rad(corners.map(|vertex| model.positions[vertex as usize].as_dvec3()));
                for (&vertex, angle_rad) in corners.iter().zip(angles_rad) {
                    sums[source(vertex) as usize] += normal * angle_rad;
                }
            }
        }
        let vertex = |from: u32| {
            let normal = match normals {
                HullNormals::Welded => mean(sums[from as usize]),
                HullNormals::Vertices => {
                    Some(model.normals[from as usize]).filter(|n| n.is_finite()).unwrap_or_default()
                }
            };
            HullVertex { position: model.positions[from as usize], normal }
        };
        let mut hull = Self::default();
        let mut numbers = vec![u32::MAX; model.positions.len()];
        hull.faces.reserve_exact(faces().count());
        for (_, corners) in faces() {
            hull.faces.push(corners.map(|corner| {
                let from = source(corner);
                let number = &mut numbers[from as usize];
                if *number == u32::MAX {
                    *number = hull.vertices.len() as u32;
                    hull.vertices.push(vertex(from));
                }
                *number
            }));
        }
        hull
    }
}

/// The unit vector of a sum of unit normals and angles; zero where rounding is all that is left of it.
fn mean(sum: DVec3) -> Vec3 {
    if sum.length() > 1e-6 { sum.normalize().as_vec3() } else { Vec3::ZERO }
}

/// The angles of a triangle at its corners.
fn corner_angles_rad([a, b, c]: [DVec3; 3]) -> [f64; 3] {
    let angle = |from: DVec3, to: DVec3| from.cross(to).length().atan2(from.dot(to));
    [angle(b - a, c - a), angle(c - b, a - b), angle(a - c, b - c)]
}

/// The view that a hull is drawn for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HullView {
    /// To clip space (x right, y up, z reversed: w at the near plane, towards 0 with distance).
    pub clip_from_world: DMat4,
    /// Normals to view space (x right, y up, z towards the viewer), up to their length: the rotation of the view, times
    /// the inverse transpose of a model's own transform if `clip_from_world` has one.
    pub view_from_normal: DMat3,
    /// Width and height of the picture in px, which are square.
    pub viewport_px: DVec2,
    /// As [`crate::segment::LineView::depth_per_px`]: depth-buffer units of one px along the view, depth · x + y.
    pub depth_per_px: DVec2,
    /// How far the hull extends beyond the surface on the screen, px. Not negative.
    pub width_px: f64,
    /// Whether `clip_from_world` has a reflection, which turns the winding of front faces around on the screen.
    pub mirrored: bool,
}

/// The displacement of a vertex on the screen, px; y up.
pub fn hull_offset(normal: DVec3, view: &HullView) -> DVec2 {
    let turned = view.view_from_normal * normal;
    let squared = turned.length_squared();
    if squared == 0.0 {
        return DVec2::ZERO;
    }
    let aside = turned.truncate() / squared.sqrt();
    aside * (view.width_px / aside.length().max(HULL_LEAST_ASIDE))
}

/// A vertex of the hull in clip space, displaced.
pub fn hull_vertex(position: DVec3, normal: DVec3, view: &HullView) -> DVec4 {
    let clip = view.clip_from_world * position.extend(1.0);
    let offset = hull_offset(normal, view) * (2.0 / view.viewport_px) * clip.w;
    let behind_px = HULL_BEHIND_WIDTHS * view.width_px + HULL_BEHIND_PX;
    // In perspective, depth is divided by distance; in a parallel view it is linear.
    let z = (clip.z - behind_px * view.depth_per_px.y * clip.w) / (1.0 + behind_px * view.depth_per_px.x);
    DVec4::new(clip.x + offset.x, clip.y + offset.y, z, clip.w)
}

/// The triangles of a hull that are drawn, in clip space: those whose displaced back is visible.
pub fn hull_triangles(hull: &Hull, view: &HullView) -> Vec<[DVec4; 3]> {
    let displaced = |v: &HullVertex| hull_vertex(v.position.as_dvec3(), v.normal.as_dvec3(), view);
    let vertices: Vec<DVec4> = hull.vertices.iter().map(displaced).collect();
    let triangles = hull.faces.iter().map(|face| face.map(|vertex| vertices[vertex as usize]));
    triangles.filter(|triangle| hull_winding(triangle) * if view.mirrored { -1.0 } else { 1.0 } < 0.0).collect()
}

/// Positive for a triangle whose part in front of the eye is counter-clockwise on the screen, whether or not it reaches
/// behind the eye.
fn hull_winding([a, b, c]: &[DVec4; 3]) -> f64 {
    let flat = |corner: &DVec4| DVec3::new(corner.x, corner.y, corner.w);
    flat(a).dot(flat(b).cross(flat(c)))
}

#[cfg(test)]
mod tests;
