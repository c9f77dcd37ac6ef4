//! Shadow volumes of a model, from the same edges as the lines.
//!
//! # What casts
//!
//! A shadow volume is bounded by the casting faces themselves (its near caps), by the quadrilaterals that edges sweep
//! away from the light, and by the faces swept to infinity (its far caps). The number of volumes around a point is the
//! number of casting faces between it and the light, so that for any topology a count above zero is shadow.
//!
//! - Of a *closed* surface, every edge with two faces that are wound consistently and outwards, only the faces towards
//!   the light cast. Then an edge sweeps where one of its faces faces the light and the other does not: the contour seen from the
//!   light, by the same test that finds contours for the eye ([`outline_facing`], once for each face).
//! - Elsewhere every face casts by itself, oriented so that it faces the light, and the number of sweeps of an edge is
//!   the sum of the directions in which its faces run over it: 1 at a boundary, 0 where a surface continues, 2 where it
//!   folds over. This depends on no winding and no neighbour, so that no volume is open.
//!
//! Since the orientation of a face is decided once and is the same for all its edges, the volumes are closed, also
//! where a face is within rounding of edge-on.
//!
//! Faces of zero area cast nothing, but are kept, so that the edges around them match. Redundant faces
//! ([`npr_mesh::edges::EdgeOptions::skip_redundant`]) cast nothing, nor do blended materials whose colour has an alpha
//! below 0.5. A material whose alpha varies, by a cutoff or a texture, casts the shadow of its whole faces or none, since
//! volumes have no textures.
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
use npr_mesh::edges::{Edge, EdgeKind, EdgeOptions, Edges, FOLD_RAD, NO_FACE, runs_along};
use npr_mesh::weld::Weld;
use npr_mesh::{AlphaMode, Material, Model};

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

/// The edges and faces of a model that can cast a shadow: 12 bytes a position, 29 a face and 16 an edge, from which the
/// records of a device are made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShadowCasters {
    /// The origin of the planes' coordinates.
    pub origin: Vec3,
    /// Whether some face casts on whichever side the light is; then an edge may sweep twice.
    pub open: bool,
    positions: Vec<Vec3>,
    /// The faces that may cap, at most those of the model, each with its plane, and whether it casts on whichever side
    /// the light is.
    faces: Vec<[u32; 3]>,
    planes: Vec<[f32; 4]>,
    open_faces: Vec<bool>,
    /// The edges that may sweep, at most three for each face.
    edges: Vec<CastingEdge>,
}

/// An edge between casting faces, counted as [`ShadowCasters::faces`] has them.
#[derive(Clone, Copy, Debug, PartialEq)]
struct CastingEdge {
    /// In the direction in which the first face runs over it.
    ends: [u32; 2],
    first: u32,
    /// The second face, [`SAME_DIRECTION`] added where it runs over the edge in the same direction; [`NO_FACE`] without.
    second: u32,
}

/// Above the bits of a face's number.
const SAME_DIRECTION: u32 = 1 << 30;

/// A blended material with a lower alpha casts no shadow.
const LEAST_CASTING_ALPHA: f32 = 0.5;

/// How the edges for [`shadow_casters`] are best found: faces without area are kept, since volumes are closed exactly
/// where all faces have their corners in common, and so are faces that overlap at an edge, each of which casts by itself.
pub const EDGES: EdgeOptions = EdgeOptions {
    skip_without_area: false,
    merge_overlaps: false,
    weld: Weld::Rounding,
    skip_redundant: true,
    share_junctions: true,
    fold_rad: FOLD_RAD,
};

/// Whether a face can cast a shadow.
fn casts(model: &Model, edges: &Edges, face: usize) -> bool {
    let lets_through =
        |material: &Material| material.alpha_mode == AlphaMode::Blend && material.base_color.w < LEAST_CASTING_ALPHA;
    !model.material_of(face as u32).is_some_and(lets_through) && edges.skipped.get(face) != Some(&true)
}

/// Gathers the edges and faces of a model that can cast. An edge between two faces whose planes are the same numbers
/// cannot.
///
/// `edges`: of this model's triangles, found without polygons (an empty `face_polygon`), so that diagonals are among
/// them: a polygon may be warped, and its triangles then face a light differently. Best found with [`EDGES`]; every face
/// that is not skipped must be at all of its edges. Where the model's `face_material` is empty, all faces are opaque.
pub fn shadow_casters(model: &Model, edges: &Edges) -> ShadowCasters {
    let origin = model.bounds().map_or(Vec3::ZERO, |(low, high)| low.midpoint(high));
    let casting: Vec<bool> = (0..model.faces.len()).map(|face| casts(model, edges, face)).collect();
    let open = open_faces(model, edges, &casting);
    let count = casting.iter().filter(|casting| **casting).count();
    let mut casters = ShadowCasters { origin, positions: model.positions.clone(), ..Default::default() };
    casters.faces.reserve_exact(count);
    casters.planes.reserve_exact(count);
    casters.open_faces.reserve_exact(count);
    // Per face of the model its number among those that cast.
    let mut number = vec![NO_FACE; model.faces.len()];
    for face in (0..model.faces.len()).filter(|&face| casting[face]) {
        number[face] = casters.faces.len() as u32;
        // The corners that the edges have, so that caps and sides meet exactly.
        casters.faces.push(model.faces[face].map(|v| edges.representative[v as usize]));
        casters.planes.push(plane(model.faces[face].map(|v| model.positions[v as usize]), origin));
        casters.open_faces.push(open[face]);
    }
    casters.open = casters.open_faces.contains(&true);
    let runs = |face: u32, [from, to]: [u32; 2]| {
        let corners = model.faces[face as usize].map(|v| edges.representative[v as usize]);
        runs_along(&model.positions, corners, [from, to])
    };
    casters.edges.reserve(edges.edges.len());
    let single = |face: u32, [from, to]: [u32; 2]| CastingEdge {
        ends: if runs(face, [from, to]) { [from, to] } else { [to, from] },
        first: number[face as usize],
        second: NO_FACE,
    };
    let mut further = edges.further_faces.iter().peekable();
    for (of_edge, edge) in (0u32..).zip(&edges.edges) {
        let [first, second] = edge.faces();
        let is_casting = |face: u32| face != NO_FACE && casting[face as usize];
        if edge.kind() == EdgeKind::TwoFace && is_casting(first) && is_casting(second) {
            let same = if edge.wound_oppositely() { SAME_DIRECTION } else { 0 };
            let [first, second] = [first, second].map(|face| number[face as usize]);
            // Faces in exactly one plane turn alike to every light, so that their edge never sweeps.
            if same == 0 && casters.planes[first as usize] == casters.planes[second as usize] {
                continue;
            }
            casters.edges.push(CastingEdge { ends: edge.ends, first, second: second | same });
        } else {
            casters.edges.extend([first, second].into_iter().filter(|&f| is_casting(f)).map(|f| single(f, edge.ends)));
        }
        while let Some(&(_, face)) = further.next_if(|(of, _)| *of == of_edge) {
            if is_casting(face) {
                casters.edges.push(single(face, edge.ends));
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

/// For each face whether its connected component is open, inconsistently wound or wound inwards.
fn open_faces(model: &Model, edges: &Edges, casting: &[bool]) -> Vec<bool> {
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
    let mut volumes = vec![0.0; casting.len()];
    let origin = model.faces.first().map_or(DVec3::ZERO, |face| model.positions[face[0] as usize].as_dvec3());
    for (number, face) in (0u32..).zip(&model.faces).filter(|&(number, _)| casting[number as usize]) {
        let [a, b, c] = face.map(|vertex| model.positions[vertex as usize].as_dvec3() - origin);
        volumes[root(&mut above, number) as usize] += a.dot(b.cross(c));
    }
    open.iter_mut().zip(volumes).for_each(|(open, volume)| *open |= volume < 0.0);
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
/// `flags` and planes: as of [`VolumeEdge`]. `light`: relative to [`ShadowCasters::origin`], a point with w = 1 or the
/// direction to the light with w = 0.
#[inline]
fn outline_sweeps(flags: u32, plane0: [f32; 4], plane1: [f32; 4], light: Vec4) -> i32 {
    let mut sweeps = outline_casting(plane0, flags & VOLUME_OPEN != 0, light);
    if flags & VOLUME_SECOND != 0 {
        let second = outline_casting(plane1, flags & VOLUME_SECOND_OPEN != 0, light);
        sweeps += if flags & VOLUME_SAME_DIRECTION != 0 { second } else { -second };
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

    /// The records of the edges.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = VolumeEdge> + '_ {
        self.edges.iter().map(|edge| {
            let CastingEdge { ends, first, second } = *edge;
            let mut flags = if self.open_faces[first as usize] { VOLUME_OPEN } else { 0 };
            let mut plane1 = [0.0; 4];
            if second != NO_FACE {
                let face = (second & !SAME_DIRECTION) as usize;
                plane1 = self.planes[face];
                flags |= VOLUME_SECOND;
                flags |= if second & SAME_DIRECTION != 0 { VOLUME_SAME_DIRECTION } else { 0 };
                flags |= if self.open_faces[face] { VOLUME_SECOND_OPEN } else { 0 };
            }
            let [from, to] = ends.map(|v| self.positions[v as usize].to_array());
            VolumeEdge { from, flags, to, padding: 0, plane0: self.planes[first as usize], plane1 }
        })
    }

    /// The records of the faces.
    pub fn faces(&self) -> impl ExactSizeIterator<Item = VolumeFace> + '_ {
        self.faces.iter().zip(&self.planes).zip(&self.open_faces).map(|((face, &plane), &open)| {
            let [a, b, c] = face.map(|v| self.positions[v as usize].to_array());
            VolumeFace { a, flags: if open { VOLUME_OPEN } else { 0 }, b, padding0: 0, c, padding1: 0, plane }
        })
    }

    /// Gathers the edges that sweep and the faces that cap for a light. `edges` and `faces` are cleared first.
    ///
    /// `light`: world space, a point with w = 1 or the direction to the light with w = 0.
    pub fn scan(&self, light: DVec4, edges: &mut Vec<VolumeEdge>, faces: &mut Vec<VolumeFace>) {
        let light = self.local_light(light);
        let sweeps = |edge: &VolumeEdge| outline_sweeps(edge.flags, edge.plane0, edge.plane1, light);
        edges.clear();
        edges.extend(self.edges().filter(|edge| sweeps(edge) != 0));
        faces.clear();
        faces
            .extend(self.faces().filter(|face| outline_casting(face.plane, face.flags & VOLUME_OPEN != 0, light) != 0));
    }

    /// The triangles of a light's volumes, three corners each, and how many corners there are of the first kind: first
    /// those of sides and of caps of faces towards the light, wound counter-clockwise seen from outside; then the caps of
    /// faces away from the light with their own winding, which count with the opposite sign. A corner is a position with
    /// w = 1, or with w = 0 one that is swept to infinity ([`outline_swept`]).
    ///
    /// At most 12 corners for each edge and 6 for each face. `light`: as for [`ShadowCasters::scan`].
    pub fn triangles(&self, light: DVec4) -> (Vec<[f32; 4]>, usize) {
        let local = self.local_light(light);
        // How each face casts, once, since it is in three edges.
        let planes = self.planes.iter().zip(&self.open_faces);
        let casting: Vec<i8> = planes.map(|(&plane, &open)| outline_casting(plane, open, local) as i8).collect();
        // As `outline_sweeps`.
        let sweeps = |edge: &CastingEdge| match edge.second {
            NO_FACE => casting[edge.first as usize],
            second => {
                let of_second = casting[(second & !SAME_DIRECTION) as usize];
                casting[edge.first as usize] + if second & SAME_DIRECTION != 0 { of_second } else { -of_second }
            }
        };
        let of_light = if light.w != 0.0 { 6 } else { 3 };
        let swept: usize = self.edges.iter().map(|edge| usize::from(sweeps(edge).unsigned_abs())).sum();
        let capping = |turn: i8| casting.iter().filter(|&&casting| casting == turn).count();
        let towards = of_light * (swept + capping(1));
        // In one piece, since it may be most of what a picture takes of memory.
        let mut corners = Vec::with_capacity(towards + of_light * capping(-1));
        let near = |v: u32| self.positions[v as usize].extend(1.0).to_array();
        let far = |v: u32| self.positions[v as usize].extend(0.0).to_array();
        for edge in &self.edges {
            let times = sweeps(edge);
            let [a, b] = edge.ends;
            let (from, to) = if times > 0 { (a, b) } else { (b, a) };
            for _ in 0..times.unsigned_abs() {
                corners.extend([near(to), near(from), far(from)]);
                if light.w != 0.0 {
                    corners.extend([near(to), far(from), far(to)]);
                }
            }
        }
        for turn in [1, -1] {
            for (&[a, b, c], _) in self.faces.iter().zip(&casting).filter(|(_, casting)| **casting == turn) {
                corners.extend([a, b, c].map(near));
                if light.w != 0.0 {
                    corners.extend([a, c, b].map(far));
                }
            }
        }
        (corners, towards)
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
        let is_hit = |face: &VolumeFace| {
            let [a, b, c] = [face.a, face.b, face.c].map(|corner| Vec3::from(corner).as_dvec3() - light.truncate());
            let sides = [(a, b), (b, c), (c, a)].map(|(p, q)| p.cross(q).dot(direction));
            let towards = (a.cross(b) + b.cross(c) + c.cross(a)).dot(a) * sides[0];
            (sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0)) && towards > 0.0
        };
        let casting = |face: &VolumeFace| outline_casting(face.plane, face.flags & VOLUME_OPEN != 0, local) != 0;
        self.faces().filter(casting).filter(is_hit).count() as u32
    }
}

#[cfg(test)]
mod tests;
