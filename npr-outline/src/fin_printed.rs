//! Fins as printed: a quadrilateral for each edge that the vertex shader widens where the edge is a silhouette (Card &
//! Mitchell 2002, "Rendering Outlines", figure 2 and listing 1).
//!
//! Two of a fin's four corners stay on the edge, two are displaced along the smooth normal. Hidden lines fail the
//! depth test against the scene, which is drawn before. [`crate::segment`] corrects the faults below; this form is
//! kept for comparison. In f64, the twin of `fin_printed.wgsl`.
//!
//! # Contradictions and faults
//!
//! - *Width from clip z.* The listing takes a vertex' depth from the third row of the view-projection matrix, which is
//!   clip z, z = f / (f − n) · (w − n) in the chapter's Direct3D: lines grow thinner towards the near plane and have
//!   no width there. [`FinDepth::Printed`] is that, [`FinDepth::Eye`] takes w instead.
//! - *The text's reversal.* "If the value is less than zero, the vertex offset is set to zero" is the reverse of the
//!   listing and of step 6e. The listing is followed: below zero, the offset is one. [`FinView::reversed`] follows the
//!   text: everything but the silhouette is drawn.
//! - *Products of exactly zero*, of a face seen edge-on or one without area, are not drawn; and since each vertex is
//!   tested by itself, rounded normals can give the two ends of one edge different results, which leaves half a fin.
//! - *Creases are never drawn*, though the text counts them among the outline: only silhouettes and boundaries
//!   have width.
//! - A fin that points at the viewer is seen edge-on (the chapter says so of boundaries): the width on the screen is
//!   that of the displacement only where the smooth normal is perpendicular to the view.

use crate::normal_format::NormalFormat;
use glam::{DMat4, DVec3, DVec4, Vec3};
use npr_mesh::Model;
use npr_mesh::edges::{Edges, NO_FACE};

/// WGSL functions: no bindings, no entry points.
pub const FIN_PRINTED_WGSL: &str = include_str!("fin_printed.wgsl");

/// One corner of a fin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedFin {
    /// Position, world space.
    pub position: Vec3,
    /// The unit smooth normal at a displaced corner; zero at a corner on the edge.
    pub smooth_normal: Vec3,
    /// The unit normal of the edge's first face; zero if that has no area.
    pub n_face0: Vec3,
    /// The unit normal of the second face; at a boundary the negated first.
    pub n_face1: Vec3,
}

/// A vertex buffer of fins.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PrintedFins {
    /// Four an edge, in the order of the edges: at the first end, at the second, the second displaced, the first
    /// displaced.
    pub vertices: Vec<PrintedFin>,
    /// Six an edge: two triangles.
    pub indices: Vec<u32>,
}

/// Makes a fin for every edge of a model.
///
/// The smooth normal of an end is the sum of the model's shading normals at its position, normalised. For an edge with
/// more than two faces the first two are used; where those two are wound oppositely, the second normal is negated.
pub fn printed_fins(model: &Model, edges: &Edges) -> PrintedFins {
    let mut smooth = vec![Vec3::ZERO; model.positions.len()];
    for (normal, &at) in model.normals.iter().zip(&edges.representative) {
        smooth[at as usize] += *normal;
    }
    let mut fins = PrintedFins::default();
    fins.vertices.reserve_exact(4 * edges.edges.len());
    fins.indices.reserve_exact(6 * edges.edges.len());
    for edge in &edges.edges {
        let [first, second] = edge.faces();
        let n_face0 = edges.face_normals[first as usize];
        let n_face1 = match second {
            NO_FACE => -n_face0,
            second if edge.wound_oppositely() => -edges.face_normals[second as usize],
            second => edges.face_normals[second as usize],
        };
        let [a, b] = edge.ends.map(|v| v as usize);
        let base = fins.vertices.len() as u32;
        for (end, displaced) in [(a, false), (b, false), (b, true), (a, true)] {
            let smooth_normal = if displaced { smooth[end].normalize_or_zero() } else { Vec3::ZERO };
            fins.vertices.push(PrintedFin { position: model.positions[end], smooth_normal, n_face0, n_face1 });
        }
        fins.indices.extend([0, 1, 2, 0, 2, 3].map(|corner| base + corner));
    }
    fins
}

impl PrintedFins {
    /// The fins with face normals rounded as by a format.
    pub fn quantised(&self, format: NormalFormat) -> Self {
        let mut fins = self.clone();
        for vertex in &mut fins.vertices {
            vertex.n_face0 = format.quantised(vertex.n_face0);
            vertex.n_face1 = format.quantised(vertex.n_face1);
        }
        fins
    }
}

/// The depth that a fin's displacement is proportional to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FinDepth {
    /// Clip z of a Direct3D projection of 2002, 0 at the near plane and w at the far plane, as listing 1 takes it.
    Printed {
        /// Distance of the near plane, above 0.
        near: f64,
        /// Distance of the far plane, beyond the near one.
        far: f64,
    },
    /// The distance from the eye's plane, w: the same width at any distance.
    Eye,
}

/// The view that fins are drawn for. Perspective: in a parallel view w is no distance, and the listing has no eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FinView {
    /// To clip space (x right, y up, z reversed: w at the near plane, towards 0 with distance).
    pub clip_from_world: DMat4,
    /// The eye, world space.
    pub eye: DVec3,
    /// Displacement over depth, the listing's c10. A width of `n` px across the view is `n` times
    /// 2 tan(fov/2) / height.
    pub thickness: f64,
    /// The depth that [`FinView::thickness`] is multiplied with.
    pub depth: FinDepth,
    /// Whether the text is followed, which displaces where the listing does not and the reverse.
    pub reversed: bool,
}

/// Whether the listing displaces a vertex: 1 where the product of the two normals' dot products with the view vector,
/// from the eye to the vertex, is below zero, and 0 elsewhere; `reversed`, as the text has it, 0 where it is below zero.
fn fin_printed_flag(position: DVec3, n_face0: DVec3, n_face1: DVec3, eye: DVec3, reversed: bool) -> f64 {
    let view = (position - eye).normalize_or_zero();
    if (view.dot(n_face0) * view.dot(n_face1) < 0.0) != reversed { 1.0 } else { 0.0 }
}

/// The depth at a vertex with clip-space w.
pub fn fin_printed_depth(w: f64, depth: FinDepth) -> f64 {
    match depth {
        FinDepth::Printed { near, far } => far / (far - near) * (w - near),
        FinDepth::Eye => w,
    }
}

/// Listing 1: a vertex in clip space, displaced along its smooth normal where its edge is a silhouette.
fn fin_printed_vertex(vertex: &PrintedFin, view: &FinView) -> DVec4 {
    let position = vertex.position.as_dvec3();
    let flag =
        fin_printed_flag(position, vertex.n_face0.as_dvec3(), vertex.n_face1.as_dvec3(), view.eye, view.reversed);
    let clip = view.clip_from_world * position.extend(1.0);
    let thickness = fin_printed_depth(clip.w, view.depth) * view.thickness;
    view.clip_from_world * (position + vertex.smooth_normal.as_dvec3() * (thickness * flag)).extend(1.0)
}

/// The triangles, in clip space, of all fins that have any width.
pub fn fin_printed_triangles(fins: &PrintedFins, view: &FinView) -> Vec<[DVec4; 3]> {
    let mut triangles = Vec::new();
    for fin in fins.vertices.chunks_exact(4) {
        let [a, b, c, d] = std::array::from_fn(|corner| fin_printed_vertex(&fin[corner], view));
        // Where the two ends disagree, or a smooth normal is zero, a triangle is left of the quadrilateral.
        for [p, q, r] in [[a, b, c], [a, c, d]] {
            if p != q && q != r && r != p {
                triangles.push([p, q, r]);
            }
        }
    }
    triangles
}

/// Visits the pixels that fins cover and the scene does not hide: [`raster::rasterise`](crate::raster::rasterise)
/// without depths.
pub fn rasterise(
    triangles: &[[DVec4; 3]],
    viewport: [u32; 2],
    depth_at: impl Fn(u32, u32) -> f64,
    mut visit: impl FnMut(u32, u32),
) {
    crate::raster::rasterise(triangles, viewport, depth_at, |x, y, _| visit(x, y));
}

#[cfg(test)]
mod tests;
