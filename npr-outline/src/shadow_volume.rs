//! Shadow volumes of a model, from the same edges as the lines.
//!
//! # What casts
//!
//! A shadow volume is bounded by the casting faces themselves (its near caps), by the quadrilaterals that edges sweep
//! away from the light, and by the faces swept to infinity (its far caps). The number of volumes around a point is the
//! number of casting faces between it and the light, so that for any topology a count above zero is shadow.
//!
//! - Of a *closed* surface, every edge with two faces that are wound consistently, only the faces towards the light
//!   cast. Then an edge sweeps where one of its faces faces the light and the other does not: the contour seen from the
//!   light, by the same test that finds contours for the eye ([`outline_facing`], once for each face).
//! - Elsewhere every face casts by itself, oriented so that it faces the light, and the number of sweeps of an edge is
//!   the sum of the directions in which its faces run over it: 1 at a boundary, 0 where a surface continues, 2 where it
//!   folds over. This depends on no winding and no neighbour, so that no volume is open.
//!
//! Since the orientation of a face is decided once and is the same for all its edges, the volumes are closed, also
//! where a face is within rounding of edge-on.
//!
//! Faces of zero area cast nothing, but are kept, so that the edges around them match. Redundant faces
//! ([`npr_mesh::edges::EdgeOptions::skip_redundant`]) and blended materials cast nothing. A material that alpha cuts
//! out casts the shadow of its whole faces, since volumes have no textures.
//!
//! # Sources
//!
//! - F. C. Crow: *Shadow Algorithms for Computer Graphics*, SIGGRAPH 1977: shadow volumes.
//! - C. Everitt, M. J. Kilgard: *Practical and Robust Stenciled Shadow Volumes for Hardware-Accelerated Rendering*,
//!   2002: counting behind the surface (depth fail), caps at infinity, a projection without far plane.
//! - G. Aldridge, E. Woods: *Robust, geometry-independent shadow volumes*, GRAPHITE 2004, and B. Kim, K. Kim, G. Turk:
//!   *A Shadow-Volume Algorithm for Opaque and Transparent Nonmanifold Casters*, Journal of Graphics Tools 13:3, 2008:
//!   edges that sweep as often as their faces' directions do not cancel out.
//! - D. Card, J. L. Mitchell 2002, "Shadow Outlines": stencil shadows in an NPR renderer.

use crate::contour::outline_facing;
use glam::{DVec3, DVec4, Vec3, Vec4};
use npr_mesh::edges::{Edge, EdgeKind, Edges, NO_FACE};
use npr_mesh::{AlphaMode, Model};

/// In [`VolumeEdge::flags`]: there is a second face.
pub const VOLUME_SECOND: u32 = 1;
/// In [`VolumeEdge::flags`]: the second face runs over the edge in the direction of the first.
pub const VOLUME_SAME_DIRECTION: u32 = 2;
/// In [`VolumeEdge::flags`] and [`VolumeFace::flags`]: the (first) face casts on whichever side the light is.
pub const VOLUME_OPEN: u32 = 4;
/// In [`VolumeEdge::flags`]: the second face casts on whichever side the light is.
pub const VOLUME_SECOND_OPEN: u32 = 8;

/// An edge that may sweep a side of a volume: 64 bytes.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct VolumeEdge {
    /// The end at which the first face's winding enters the edge, world space.
    pub from: [f32; 3],
    /// A sum of `VOLUME_` bits.
    pub flags: u32,
    /// The other end, world space.
    pub to: [f32; 3],
    /// Unused, 0.
    pub padding: u32,
    /// The plane of the first face, for its own winding, relative to [`ShadowCasters::origin`].
    pub plane0: [f32; 4],
    /// The plane of the second face, for its own winding; zeros without one.
    pub plane1: [f32; 4],
}

/// A face that may cap a volume: 64 bytes.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct VolumeFace {
    /// The first corner, world space.
    pub a: [f32; 3],
    /// [`VOLUME_OPEN`] or 0.
    pub flags: u32,
    /// The second corner, world space.
    pub b: [f32; 3],
    /// Unused, 0.
    pub padding0: u32,
    /// The third corner, world space.
    pub c: [f32; 3],
    /// Unused, 0.
    pub padding1: u32,
    /// The plane of the face, as [`VolumeEdge::plane0`].
    pub plane: [f32; 4],
}

const _: () = assert!(size_of::<VolumeEdge>() == 64 && size_of::<VolumeFace>() == 64);

/// The edges and faces of a model that can cast a shadow.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShadowCasters {
    /// The origin of the planes' coordinates.
    pub origin: Vec3,
    /// The edges that may sweep, at most three for each face.
    pub edges: Vec<VolumeEdge>,
    /// The faces that may cap, at most those of the model.
    pub faces: Vec<VolumeFace>,
    /// Whether some face casts on whichever side the light is; then an edge may sweep twice.
    pub open: bool,
}

/// Whether a face can cast a shadow.
fn casts(model: &Model, edges: &Edges, face: usize) -> bool {
    let blended = model.material_of(face as u32).is_some_and(|material| material.alpha_mode == AlphaMode::Blend);
    !blended && edges.skipped.get(face) != Some(&true)
}

/// Gathers the edges and faces of a model that can cast.
///
/// `edges`: of this model's triangles, found without polygons (an empty `face_polygon`), so that diagonals are among
/// them: a polygon may be warped, and its triangles then face a light differently. Where the model's `face_material` is
/// empty, all faces are opaque.
pub fn shadow_casters(model: &Model, edges: &Edges) -> ShadowCasters {
    let origin = model.bounds().map_or(Vec3::ZERO, |(low, high)| low.midpoint(high));
    let corner = |v: u32| model.positions[v as usize];
    let casting: Vec<bool> = (0..model.faces.len()).map(|face| casts(model, edges, face)).collect();
    let planes: Vec<[f32; 4]> = model.faces.iter().map(|&face| plane(face.map(corner), origin)).collect();
    let open = open_faces(edges, &casting);
    let mut casters =
        ShadowCasters { origin, open: (0..open.len()).any(|f| casting[f] && open[f]), ..Default::default() };
    for (face, &[a, b, c]) in model.faces.iter().enumerate() {
        if casting[face] {
            casters.faces.push(VolumeFace {
                a: corner(a).to_array(),
                flags: if open[face] { VOLUME_OPEN } else { 0 },
                b: corner(b).to_array(),
                padding0: 0,
                c: corner(c).to_array(),
                padding1: 0,
                plane: planes[face],
            });
        }
    }
    let runs = |face: u32, [from, to]: [u32; 2]| {
        let corners = model.faces[face as usize].map(|v| edges.representative[v as usize]);
        (0..3).any(|side| [corners[side], corners[(side + 1) % 3]] == [from, to])
    };
    let mut add = |[from, to]: [u32; 2], first: u32, second: Option<(u32, bool)>| {
        let mut flags = if open[first as usize] { VOLUME_OPEN } else { 0 };
        if let Some((second, same_way)) = second {
            flags |= VOLUME_SECOND;
            flags |= if same_way { VOLUME_SAME_DIRECTION } else { 0 };
            flags |= if open[second as usize] { VOLUME_SECOND_OPEN } else { 0 };
        }
        casters.edges.push(VolumeEdge {
            from: corner(from).to_array(),
            flags,
            to: corner(to).to_array(),
            padding: 0,
            plane0: planes[first as usize],
            plane1: second.map_or([0.0; 4], |(second, _)| planes[second as usize]),
        });
    };
    let mut further = edges.further_faces.iter().peekable();
    for (number, edge) in (0u32..).zip(&edges.edges) {
        let [first, second] = edge.faces();
        let is_casting = |face: u32| face != NO_FACE && casting[face as usize];
        if edge.kind() == EdgeKind::TwoFace && is_casting(first) && is_casting(second) {
            add(edge.ends, first, Some((second, edge.wound_oppositely())));
        } else {
            for face in [first, second].into_iter().filter(|&face| is_casting(face)) {
                let [from, to] = edge.ends;
                add(if runs(face, edge.ends) { [from, to] } else { [to, from] }, face, None);
            }
        }
        while let Some(&(_, face)) = further.next_if(|(of, _)| *of == number) {
            if is_casting(face) {
                let [from, to] = edge.ends;
                add(if runs(face, edge.ends) { [from, to] } else { [to, from] }, face, None);
            }
        }
    }
    casters
}

/// The plane of a triangle as it is wound: a unit normal and −n · a; zeros where it has no area.
fn plane(corners: [Vec3; 3], origin: Vec3) -> [f32; 4] {
    let [a, b, c] = corners.map(|corner| corner.as_dvec3() - origin.as_dvec3());
    // Scaled to a common size, so that no square overflows or underflows.
    let (ab, ac) = (b - a, c - a);
    let size = ab.abs().max_element().max(ac.abs().max_element());
    let normal = (ab / size).cross(ac / size).normalize_or_zero();
    if normal == DVec3::ZERO || !normal.is_finite() {
        return [0.0; 4];
    }
    normal.as_vec3().extend(-normal.dot(a) as f32).to_array()
}

/// For each face whether its connected component is open or inconsistently wound.
fn open_faces(edges: &Edges, casting: &[bool]) -> Vec<bool> {
    let mut above: Vec<u32> = (0..casting.len() as u32).collect();
    fn root(above: &mut [u32], mut face: u32) -> u32 {
        while above[face as usize] != face {
            above[face as usize] = above[above[face as usize] as usize];
            face = above[face as usize];
        }
        face
    }
    let fits = |edge: &Edge| {
        edge.kind() == EdgeKind::TwoFace
            && !edge.wound_oppositely()
            && edge.faces().into_iter().all(|face| casting[face as usize])
    };
    for edge in edges.edges.iter().filter(|edge| fits(edge)) {
        let [a, b] = edge.faces().map(|face| root(&mut above, face));
        above[a.max(b) as usize] = a.min(b);
    }
    let mut open = vec![false; casting.len()];
    let mut open_up = |above: &mut [u32], face: u32| {
        if face != NO_FACE {
            open[root(above, face) as usize] = true;
        }
    };
    for edge in edges.edges.iter().filter(|edge| !fits(edge)) {
        edge.faces().into_iter().for_each(|face| open_up(&mut above, face));
    }
    edges.further_faces.iter().for_each(|&(_, face)| open_up(&mut above, face));
    (0..casting.len() as u32).map(|face| open[root(&mut above, face) as usize]).collect()
}

/// 1 where a face faces the light, −1 where it faces away.
#[inline]
pub fn outline_light_side(plane: [f32; 4], light: Vec4) -> i32 {
    if outline_facing(plane, light) >= 0.0 { 1 } else { -1 }
}

/// How a face casts: 1 facing the light, −1 facing away from it, 0 where it does not cast.
#[inline]
fn outline_casting(plane: [f32; 4], open: bool, light: Vec4) -> i32 {
    let side = outline_light_side(plane, light);
    if open { side } else { side.max(0) }
}

/// The number of sweeps of an edge, −2..=2: from `from` to `to` if positive, else from `to` to `from`.
///
/// `light`: relative to [`ShadowCasters::origin`], a point with w = 1 or the direction to the light with w = 0.
#[inline]
fn outline_sweeps(edge: &VolumeEdge, light: Vec4) -> i32 {
    let mut sweeps = outline_casting(edge.plane0, edge.flags & VOLUME_OPEN != 0, light);
    if edge.flags & VOLUME_SECOND != 0 {
        let second = outline_casting(edge.plane1, edge.flags & VOLUME_SECOND_OPEN != 0, light);
        sweeps += if edge.flags & VOLUME_SAME_DIRECTION != 0 { second } else { -second };
    }
    sweeps
}

/// Whether a stencil count of 8 bits means shadow: 1 to 127 volumes.
///
/// Larger values are negative counts. Exact counts are never negative, but where an edge runs through a pixel's centre
/// a side that was clipped, and so rounded, may miss a pixel that its cap covers.
#[inline]
pub fn outline_in_shadow(count: u8) -> bool {
    (1..128).contains(&count)
}

/// The homogeneous position of a point swept away from the light to infinity: a direction, w = 0.
///
/// `light`: world space, a point with w = 1 or the direction to the light with w = 0.
#[inline]
pub fn outline_swept(point: DVec3, light: DVec4) -> DVec4 {
    (point * light.w - light.truncate()).extend(0.0)
}

impl ShadowCasters {
    /// The light in the coordinates of the planes. `light` is a world-space point with w = 1 or direction with w = 0.
    fn local_light(&self, light: DVec4) -> Vec4 {
        (light - self.origin.as_dvec3().extend(0.0) * light.w).as_vec4()
    }

    /// Gathers the edges that sweep and the faces that cap for a light. `edges` and `faces` are cleared first.
    ///
    /// `light`: world space, a point with w = 1 or the direction to the light with w = 0.
    pub fn scan(&self, light: DVec4, edges: &mut Vec<VolumeEdge>, faces: &mut Vec<VolumeFace>) {
        let light = self.local_light(light);
        edges.clear();
        edges.extend(self.edges.iter().filter(|edge| outline_sweeps(edge, light) != 0));
        faces.clear();
        faces.extend(
            self.faces.iter().filter(|face| outline_casting(face.plane, face.flags & VOLUME_OPEN != 0, light) != 0),
        );
    }

    /// The triangles of a light's volumes, three corners each: first those of sides and of caps of faces
    /// towards the light, wound counter-clockwise seen from outside; then the caps of faces away from the light with
    /// their own winding, which count with the opposite sign. A corner is a position with w = 1, or with w = 0 one that
    /// is swept to infinity ([`outline_swept`]).
    ///
    /// At most 12 corners for each edge record and 6 for each face. `light`: as for [`ShadowCasters::scan`].
    pub fn triangles(&self, light: DVec4) -> (Vec<[f32; 4]>, Vec<[f32; 4]>) {
        let local = self.local_light(light);
        let (mut towards, mut away) = (Vec::new(), Vec::new());
        let near = |[x, y, z]: [f32; 3]| [x, y, z, 1.0];
        let far = |[x, y, z]: [f32; 3]| [x, y, z, 0.0];
        for edge in &self.edges {
            let sweeps = outline_sweeps(edge, local);
            let (from, to) = if sweeps > 0 { (edge.from, edge.to) } else { (edge.to, edge.from) };
            for _ in 0..sweeps.abs() {
                towards.extend([near(to), near(from), far(from)]);
                if light.w != 0.0 {
                    towards.extend([near(to), far(from), far(to)]);
                }
            }
        }
        for VolumeFace { a, b, c, flags, plane, .. } in self.faces.iter().copied() {
            let casting = outline_casting(plane, flags & VOLUME_OPEN != 0, local);
            if casting == 0 {
                continue;
            }
            let of = if casting > 0 { &mut towards } else { &mut away };
            of.extend([a, b, c].map(near));
            if light.w != 0.0 {
                of.extend([a, c, b].map(far));
            }
        }
        (towards, away)
    }

    /// The number of volumes around the point at infinity in a direction: the number of casting faces that the ray from
    /// the light in that direction crosses.
    ///
    /// In a parallel view the caps at infinity are seen edge-on and are not rasterised; this is their count, the same
    /// for every pixel. 0 for a directional light, whose volumes end in a point. A sum over all faces; `light`: as for
    /// [`ShadowCasters::scan`].
    pub fn endless(&self, light: DVec4, direction: DVec3) -> u32 {
        if light.w == 0.0 {
            return 0;
        }
        let local = self.local_light(light);
        let is_hit = |face: &&VolumeFace| {
            let [a, b, c] = [face.a, face.b, face.c].map(|corner| Vec3::from(corner).as_dvec3() - light.truncate());
            let sides = [(a, b), (b, c), (c, a)].map(|(p, q)| p.cross(q).dot(direction));
            let towards = (a.cross(b) + b.cross(c) + c.cross(a)).dot(a) * sides[0];
            (sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0)) && towards > 0.0
        };
        let casting = |face: &&VolumeFace| outline_casting(face.plane, face.flags & VOLUME_OPEN != 0, local) != 0;
        self.faces.iter().filter(casting).filter(is_hit).count() as u32
    }
}

#[cfg(test)]
mod tests;
