//! The exact visible lines of a scene, and the accuracy of a picture's lines.
//!
//! This module shares only the list of edges with line drawing: edges are classified in f64 from the corners of their
//! faces, and their visibility is determined by rays, not by a depth buffer.
//!
//! # Definition of a line
//!
//! Boundaries and non-manifold edges are always lines; two-face edges are lines if exactly one face is front-facing or
//! if the surface turns by more than the crease angle. As for drawing ([`npr_outline::contour`]), a polygon is
//! classified by its Newell normal at the mean of its corners, an oppositely wound face is flipped, a face of zero area
//! takes the plane of the neighbour at its longest edge, and a face seen exactly edge-on is front-facing. The triangles
//! of a folded polygon are classified by their own normals, so the folds between them can be silhouettes, but not
//! creases. An edge of one or two faces is a line only where one of them is shown: single-sided faces are not, from behind.
//!
//! Where the file says which edges are lines ([`npr_mesh::SideVisibility`]), that decides: hard edges are lines at any
//! angle, silhouettes are no creases, and hidden edges are no lines. The lines that the file itself draws
//! ([`npr_mesh::Model::lines`]) are lines for every eye.
//!
//! # Definition of visibility
//!
//! A point of an edge is visible if no solid surface lies between it and the eye (in a parallel view: the near plane).
//! The edge's own faces are ignored, including the other triangles of their unfolded polygons: they touch the ray at
//! the point itself, and if one is edge-on, rounding decides whether it is in front. Surfaces nearer to the point than
//! [`BEHIND`] of its distance are ignored too. The other faces at the edge's ends count: at a cusp they hide the line.
//!
//! Solid surfaces are those that occlude in a picture, not the backs of single-sided faces: by their alpha, what is left of
//! cut-outs, and blended ones from alpha 0.5 on. The materials of an edge's own faces do not affect its visibility. Blended
//! surfaces of a lower alpha dim the lines behind them, which are visible here.

mod intersections;

pub use intersections::{MOST_FACES_INTERSECTED, true_intersections};

use crate::camera::Camera;
use crate::picture::Image;
use crate::rays::Hit;
use crate::scene::Scene;
use glam::{DVec2, DVec3, DVec4};
use npr_mesh::edges::{Edge, EdgeKind, Edges, NO_FACE};
use npr_mesh::{SideVisibility, edge_visibility};
use npr_outline::LineKind;
use npr_outline::contour::single_sided_faces;
use std::collections::HashMap;

/// The edge number of a line that is not an edge.
pub const NO_EDGE: u32 = u32::MAX;
/// Surfaces in front of a point by less than this fraction of its eye depth do not occlude it.
///
/// Rounding of the ray is below 1e-12 of the distance. Positions, however, are f32, and surfaces modelled to touch
/// deviate by 1e-7 of the model's size, or ten or more times that at grazing angles. A px at the model's distance is
/// about 1e-3 of it, so this is a hundredth of a px.
pub const BEHIND: f64 = 1e-5;
/// The largest distance between samples of a line, px; visible segments are exact to half of it.
pub const STEP_PX: f64 = 0.25;
/// The margin around the picture in which lines are traced, px: lines just outside still darken pixels inside.
pub const MARGIN_PX: f64 = 2.0;
/// True lines this near to the picture's borders are not required of the picture, px: half of their pixels may lie
/// outside.
pub const BORDER_PX: f64 = 1.0;

/// A segment of an edge that is visible from end to end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrueSegment {
    /// The ends in px, y down, pixel centres at halves. They are equal for an edge that projects to a point.
    pub ends_px: [DVec2; 2],
    /// Why it is a line.
    pub kind: LineKind,
    /// The number of the edge or, after those, of the fold ([`scene_edge`]); [`NO_EDGE`] for an intersection curve of
    /// two faces and for a line that the file draws.
    pub edge: u32,
}

/// The visible lines of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct TrueLines {
    /// In the order of the scene's edges and then of the file's lines, and along each. Within the picture and a margin of [`MARGIN_PX`].
    pub segments: Vec<TrueSegment>,
    /// Width and height of the picture.
    pub size_px: (u32, u32),
}

/// The agreement of drawn lines with the true ones.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineAccuracy {
    /// The fraction of the drawn points that are near a true line, 0..=1; 1 if nothing is drawn.
    pub precision: f64,
    /// The fraction of the true lines' length that is near a drawn point, 0..=1; 1 if there are no lines.
    pub recall: f64,
    /// Their harmonic mean, 0..=1.
    pub f1: f64,
    /// The number of points of the drawn centreline.
    pub drawn_px: u64,
    /// The length of the true lines at least [`BORDER_PX`] within the picture.
    pub true_length_px: f64,
    /// The largest distance that counts as near.
    pub within_px: f64,
    /// The mean distance from a true line of the drawn points near it; at best 0.25 for points at pixel centres, except
    /// for lines along the grid.
    pub mean_distance_px: f64,
}

/// An oriented plane: a normal of any length, and a point.
#[derive(Clone, Copy)]
struct Plane {
    normal: DVec3,
    point: DVec3,
}

impl Plane {
    fn faces(&self, eye: DVec4) -> bool {
        self.normal.dot(eye.truncate() - self.point * eye.w) >= 0.0
    }
}

/// The visible lines of a scene.
///
/// - `size`: the size of the picture, px.
/// - `crease_angle_rad`: edges whose faces meet at more than this angle are lines, 0..=π.
///
/// Casts a ray for every [`STEP_PX`] of line, including hidden ones. The result does not depend on the number of
/// threads.
pub fn true_lines(scene: &Scene, camera: &Camera, size: (u32, u32), crease_angle_rad: f64) -> TrueLines {
    true_lines_of_steps(scene, camera, size, crease_angle_rad, 0.0)
}

/// As [`true_lines`], without the silhouettes and boundaries whose next surface behind is less than `least_step`
/// deeper, world units: a picture shows these only by a difference of normals.
///
/// Creases are kept even if they are silhouettes or the border of a third face.
pub fn true_lines_of_steps(
    scene: &Scene,
    camera: &Camera,
    size: (u32, u32),
    crease_angle_rad: f64,
    least_step: f64,
) -> TrueLines {
    let planes = face_planes(scene);
    let eye = camera.homogeneous_eye();
    let numbers = 0..(scene.single().edges().edges.len() + scene.single().edges().folds.len()) as u32;
    let lines: Vec<(u32, LineKind)> = numbers
        .filter_map(|number| Some((number, line_kind(scene, number, &planes, eye, crease_angle_rad)?)))
        .collect();
    let visibility = Visibility::new(scene, camera, size);
    let step_of = |number: u32, kind: LineKind| {
        if kind == LineKind::Boundary || !is_crease(scene, number, &planes, crease_angle_rad) {
            least_step
        } else {
            0.0
        }
    };
    // Built before the threads need it, so that they do not wait for each other.
    scene.build_rays();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let share = lines.len().div_ceil(threads).max(1);
    let segments = std::thread::scope(|scope| {
        let visibility = &visibility;
        let follow = |share: &[(u32, LineKind)]| -> Vec<TrueSegment> {
            share.iter().flat_map(|&(edge, kind)| visibility.visible_pieces(edge, kind, step_of(edge, kind))).collect()
        };
        // Some platforms have only the calling thread.
        if threads == 1 {
            return follow(&lines);
        }
        let running: Vec<_> = lines.chunks(share).map(|share| scope.spawn(move || follow(share))).collect();
        running.into_iter().flat_map(|thread| thread.join().expect("following lines does not panic")).collect()
    });
    let mut segments: Vec<TrueSegment> = segments;
    let model = scene.single().model();
    for &ends in &model.lines {
        let ends = ends.map(|vertex| model.positions[vertex as usize].as_dvec3());
        segments.extend(visibility.authored_pieces(ends));
    }
    TrueLines { segments, size_px: size }
}

/// The planes of the faces; the normal is zero if a degenerate face has no suitable neighbour.
struct FacePlanes {
    /// The planes of the faces' polygons, which determine creases.
    of_polygons: Vec<Plane>,
    /// The same, except that triangles of folded polygons have their own planes; they determine silhouettes.
    of_sides: Vec<Plane>,
    /// What the file says of each edge; empty if it says nothing.
    visibility: Vec<SideVisibility>,
    /// Per face whether it is shown from one side only; empty if none is.
    single_sided: Vec<bool>,
}

impl FacePlanes {
    /// Whether an eye sees one of the faces of an edge, if nothing is in front.
    fn shows(&self, edge: &Edge, eye: DVec4) -> bool {
        let is_shown =
            |face: u32| self.single_sided.get(face as usize) != Some(&true) || self.of_sides[face as usize].faces(eye);
        edge.kind() == EdgeKind::NonManifold || edge.faces().into_iter().any(|face| face != NO_FACE && is_shown(face))
    }
}

fn face_planes(scene: &Scene) -> FacePlanes {
    let model = scene.single().model();
    let own: Vec<Plane> = model
        .faces
        .iter()
        .map(|face| {
            let [a, b, c] = face.map(|v| model.positions[v as usize].as_dvec3());
            Plane { normal: (b - a).cross(c - a), point: a }
        })
        .collect();
    let mut planes = own.clone();
    if !model.face_polygon.is_empty() {
        let mut start = 0;
        for polygon in model.face_polygon.chunk_by(|a, b| a == b) {
            let range = start..start + polygon.len();
            start = range.end;
            let normal = own[range.clone()].iter().map(|plane| plane.normal).sum();
            let corners = model.faces[range.clone()].iter().flatten();
            let sum: DVec3 = corners.map(|&v| model.positions[v as usize].as_dvec3()).sum();
            planes[range.clone()].fill(Plane { normal, point: sum / (3 * range.len()) as f64 });
        }
    }
    if planes.iter().any(|plane| plane.normal == DVec3::ZERO) {
        borrow_planes(scene, &mut planes);
    }
    let mut of_sides = planes.clone();
    for face in scene.single().edges().folds.iter().flat_map(Edge::faces).map(|face| face as usize) {
        if own[face].normal != DVec3::ZERO {
            of_sides[face] = own[face];
        }
    }
    let visibility = edge_visibility(model, scene.single().edges());
    let single_sided = single_sided_faces(model, scene.single().edges(), None);
    FacePlanes { of_polygons: planes, of_sides, visibility, single_sided }
}

/// Assigns faces of zero area the plane of the neighbour at their longest edge, flipped to match the winding.
fn borrow_planes(scene: &Scene, planes: &mut [Plane]) {
    let mut lenders = HashMap::<u32, (f64, u32, bool)>::new();
    for edge in scene.single().edges().edges.iter().filter(|edge| edge.kind() == EdgeKind::TwoFace) {
        let [p, q] = edge.ends.map(|v| scene.single().model().positions[v as usize].as_dvec3());
        let length = p.distance(q);
        let [first, second] = edge.faces();
        for (face, other) in [(first, second), (second, first)] {
            if planes[face as usize].normal == DVec3::ZERO
                && lenders.get(&face).is_none_or(|&(longest, ..)| length > longest)
            {
                lenders.insert(face, (length, other, edge.wound_oppositely()));
            }
        }
    }
    let lent: Vec<(u32, Plane)> = lenders
        .keys()
        .filter_map(|&face| {
            let (mut at, mut turned) = (face, false);
            // The neighbour of a sliver may be a sliver, even in a cycle.
            for _ in 0..lenders.len() {
                let &(_, lender, oppositely) = lenders.get(&at)?;
                (at, turned) = (lender, turned ^ oppositely);
                let Plane { normal, point } = planes[at as usize];
                if normal != DVec3::ZERO {
                    return Some((face, Plane { normal: if turned { -normal } else { normal }, point }));
                }
            }
            None
        })
        .collect();
    for (face, plane) in lent {
        planes[face as usize] = plane;
    }
}

/// The kind of line that an edge is for an eye, if any.
fn line_kind(scene: &Scene, number: u32, planes: &FacePlanes, eye: DVec4, crease_angle_rad: f64) -> Option<LineKind> {
    let edge = scene_edge(scene, number);
    if planes.visibility.get(number as usize) == Some(&SideVisibility::Hidden) {
        return None;
    }
    let [first, second] = edge.faces();
    if !planes.shows(edge, eye) {
        return None;
    }
    if second == NO_FACE {
        return Some(LineKind::Boundary);
    }
    let [plane0, plane1] = wound_alike(edge, &planes.of_sides, [first, second]);
    if plane0.faces(eye) != plane1.faces(eye) && !edge.is_surrounded() {
        return Some(LineKind::Silhouette);
    }
    is_crease(scene, number, planes, crease_angle_rad).then_some(LineKind::Crease)
}

/// An edge of the scene or, for numbers after those, a fold.
pub fn scene_edge(scene: &Scene, number: u32) -> &Edge {
    let Edges { edges, folds, .. } = scene.single().edges();
    edges.get(number as usize).unwrap_or_else(|| &folds[number as usize - edges.len()])
}

/// The planes of an edge's two faces, the second flipped to match the winding of the first.
fn wound_alike(edge: &Edge, planes: &[Plane], [first, second]: [u32; 2]) -> [Plane; 2] {
    let (plane0, mut plane1) = (planes[first as usize], planes[second as usize]);
    if edge.wound_oppositely() {
        plane1.normal = -plane1.normal;
    }
    [plane0, plane1]
}

/// Whether the surface turns by more than an angle at an edge, or a third face meets it.
fn is_crease(scene: &Scene, number: u32, planes: &FacePlanes, crease_angle_rad: f64) -> bool {
    let edge = scene_edge(scene, number);
    let faces = edge.faces();
    if faces[1] == NO_FACE || number as usize >= scene.single().edges().edges.len() {
        return false;
    }
    match planes.visibility.get(number as usize) {
        Some(SideVisibility::Hard) => return true,
        Some(SideVisibility::Silhouette) => return false,
        _ => {}
    }
    let [plane0, plane1] = wound_alike(edge, &planes.of_polygons, faces);
    // Well conditioned at any angle, and 0 if a normal is missing.
    let turn_rad = plane0.normal.cross(plane1.normal).length().atan2(plane0.normal.dot(plane1.normal));
    edge.kind() == EdgeKind::NonManifold || turn_rad > crease_angle_rad
}

/// A scene and a camera.
struct Visibility<'a> {
    scene: &'a Scene,
    camera: &'a Camera,
    size_px: DVec2,
    /// The faces of all folded polygons, ascending.
    folded_faces: Vec<u32>,
}

impl<'a> Visibility<'a> {
    fn new(scene: &'a Scene, camera: &'a Camera, size: (u32, u32)) -> Self {
        let mut folded_faces: Vec<u32> = scene.single().edges().folds.iter().flat_map(Edge::faces).collect();
        folded_faces.sort_unstable();
        Self { scene, camera, size_px: DVec2::new(size.0.into(), size.1.into()), folded_faces }
    }

    fn visible_pieces(&self, number: u32, kind: LineKind, least_step: f64) -> Vec<TrueSegment> {
        let edge = scene_edge(self.scene, number);
        let ends = edge.ends.map(|v| self.scene.single().model().positions[v as usize].as_dvec3());
        let further = &self.scene.single().edges().further_faces;
        let start = further.partition_point(|of| of.0 < number);
        let further = further[start..].iter().take_while(|of| of.0 == number);
        let own = |face: u32| self.is_own(face, edge) || further.clone().any(|of| self.same_polygon(of.1, face));
        let seen =
            |point| self.sees_past(point, own) && (least_step <= 0.0 || self.step_behind(point, own) >= least_step);
        let pieces = self.seen_pieces(ends, seen);
        pieces.into_iter().map(|ends_px| TrueSegment { ends_px, kind, edge: number }).collect()
    }

    /// The visible segments of a line that the file draws, which has no faces of its own.
    fn authored_pieces(&self, ends: [DVec3; 2]) -> Vec<TrueSegment> {
        if ends[0] == ends[1] {
            return Vec::new();
        }
        let pieces = self.seen_pieces(ends, |point| self.sees_past(point, |_| false));
        let segment = |ends_px| TrueSegment { ends_px, kind: LineKind::Authored, edge: NO_EDGE };
        pieces.into_iter().map(segment).collect()
    }

    /// The visible segments, px, of a world-space line, within the picture and its margin.
    fn seen_pieces(&self, ends: [DVec3; 2], seen: impl Fn(DVec3) -> bool) -> Vec<[DVec2; 2]> {
        let Some(world) = self.clip(ends) else { return Vec::new() };
        let [(from, depth0), (to, depth1)] = world.map(|end| self.project(end));
        let cells = (from.distance(to) / STEP_PX).ceil().max(1.0) as u32;
        // The projection of a line's midpoint is not the midpoint of its projection in perspective.
        let (w0, w1) = if self.is_parallel() { (1.0, 1.0) } else { (depth0, depth1) };
        let on_line = |fraction: f64| world[0].lerp(world[1], fraction * w0 / (w1 + fraction * (w0 - w1)));
        let on_screen = |cell: u32| from.lerp(to, f64::from(cell) / f64::from(cells));
        let mut pieces = Vec::new();
        let mut since = None;
        for cell in 0..=cells {
            let seen = cell < cells && seen(on_line((f64::from(cell) + 0.5) / f64::from(cells)));
            match (since, seen) {
                (None, true) => since = Some(cell),
                (Some(start), false) => {
                    pieces.push([on_screen(start), on_screen(cell)]);
                    since = None;
                }
                _ => {}
            }
        }
        pieces
    }

    fn is_parallel(&self) -> bool {
        self.camera.homogeneous_eye().w == 0.0
    }

    /// Right, up and eye depth, world units.
    fn in_view(&self, point: DVec3) -> DVec3 {
        let [right, up, back] = self.camera.axes();
        let from_eye = point - self.camera.eye;
        DVec3::new(right.dot(from_eye), up.dot(from_eye), -back.dot(from_eye))
    }

    /// Half of the picture's width and height in world units, at eye depth 1 in perspective.
    fn half_extent(&self) -> DVec2 {
        let half_height = match self.camera.projection {
            crate::camera::Projection::Perspective { fov_y_rad } => (fov_y_rad / 2.0).tan(),
            crate::camera::Projection::Orthographic { height, .. } => height / 2.0,
        };
        DVec2::new(self.size_px.x / self.size_px.y, 1.0) * half_height
    }

    /// A point's position in px, and its eye depth.
    fn project(&self, point: DVec3) -> (DVec2, f64) {
        let view = self.in_view(point);
        let scale = if self.is_parallel() { 1.0 } else { view.z };
        let ndc = view.truncate() / (self.half_extent() * scale);
        (DVec2::new(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y) * self.size_px, view.z)
    }

    /// The part of an edge beyond the near plane and within the picture and its margin, in world space.
    fn clip(&self, ends: [DVec3; 2]) -> Option<[DVec3; 2]> {
        let half = self.half_extent() * (DVec2::ONE + 2.0 * MARGIN_PX / self.size_px);
        let inside = |point: DVec3| {
            let view = self.in_view(point);
            let scale = if self.is_parallel() { 1.0 } else { view.z };
            let (x, y) = (half.x * scale, half.y * scale);
            [view.z - self.camera.near, x - view.x, x + view.x, y - view.y, y + view.y]
        };
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for (a, b) in inside(ends[0]).into_iter().zip(inside(ends[1])) {
            match (a < 0.0, b < 0.0) {
                (true, true) => return None,
                (true, false) => from = from.max(a / (a - b)),
                (false, true) => to = to.min(a / (a - b)),
                (false, false) => {}
            }
        }
        (from <= to).then(|| [ends[0].lerp(ends[1], from), ends[0].lerp(ends[1], to)])
    }

    /// Whether only the faces `own` occlude a point, if any.
    fn sees_past(&self, point: DVec3, own: impl Fn(u32) -> bool) -> bool {
        let depth = self.in_view(point).z;
        let origin = self.origin_of_sight(point, depth);
        let range = (self.camera.near / depth, 1.0 - BEHIND);
        !self.scene.any(origin, point - origin, range, |hit| self.is_solid(hit) && !own(hit.face))
    }

    fn origin_of_sight(&self, point: DVec3, depth: f64) -> DVec3 {
        if self.is_parallel() { point + self.camera.axes()[2] * depth } else { self.camera.eye }
    }

    fn is_solid(&self, hit: &Hit) -> bool {
        (hit.front || self.scene.shows_back(hit.object, hit.face)) && self.scene.hides_at(hit)
    }

    /// The depth from a point of the faces `own` to the next surface behind it, world units; infinite if there is none.
    fn step_behind(&self, point: DVec3, own: impl Fn(u32) -> bool) -> f64 {
        let depth = self.in_view(point).z;
        let origin = self.origin_of_sight(point, depth);
        let range = (1.0 + BEHIND, f64::INFINITY);
        let is_next = |hit: &Hit| self.is_solid(hit) && !own(hit.face);
        let next = self.scene.closest(origin, point - origin, range, is_next);
        next.map_or(f64::INFINITY, |hit| (hit.t - 1.0) * depth)
    }

    fn same_polygon(&self, a: u32, b: u32) -> bool {
        let of = &self.scene.single().model().face_polygon;
        a == b || (!of.is_empty() && of[a as usize] == of[b as usize])
    }

    /// Whether a face has the edge, or belongs to the unfolded polygon of a face that has it.
    fn is_own(&self, face: u32, edge: &Edge) -> bool {
        let model = self.scene.single().model();
        let corners = model.faces[face as usize].map(|v| self.scene.single().edges().representative[v as usize]);
        edge.ends.iter().all(|end| corners.contains(end))
            || edge.faces().iter().any(|&own| {
                own != NO_FACE && self.same_polygon(own, face) && self.folded_faces.binary_search(&face).is_err()
            })
    }
}

/// The darkness of each pixel of black lines on white, in rows from the top: 0 paper, 1 ink.
pub fn darkness(image: &Image) -> Vec<f64> {
    image.rgba8.chunks_exact(4).map(|p| 1.0 - f64::from(p[1]) / 255.0).collect()
}

/// The centreline of antialiased lines 1 px wide: the centres of the pixels that are at least half dark.
///
/// Across such a line, one of any two adjacent pixels is at least half dark, so the points are at most a pixel's
/// diagonal apart, and each is within half a px of the line.
///
/// - `darkness`: per pixel, in rows from the top, 0 (paper) to 1 (ink). Rounding to bytes is allowed for.
///
/// # Panics
/// If `darkness` does not have `width * height` elements.
pub fn drawn_centreline(darkness: &[f64], width: u32, height: u32) -> Vec<DVec2> {
    assert_eq!(darkness.len(), width as usize * height as usize);
    const HALF: f64 = 0.5 - 0.5 / 255.0;
    (0u32..height)
        .flat_map(|y| (0..width).map(move |x| DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)))
        .zip(darkness)
        .filter(|&(_, &dark)| dark >= HALF)
        .map(|(center, _)| center)
        .collect()
}

impl TrueLines {
    /// Evenly spaced points along the visible lines that are required of a picture: the position, the length that the
    /// point represents (at most [`STEP_PX`]), and the segment's index. Points within [`BORDER_PX`] of a border are
    /// skipped.
    pub fn samples(&self) -> Vec<(DVec2, f64, usize)> {
        let high = DVec2::new(self.size_px.0.into(), self.size_px.1.into()) - BORDER_PX;
        let mut samples = Vec::new();
        for (number, TrueSegment { ends_px: [from, to], .. }) in self.segments.iter().enumerate() {
            let length = from.distance(*to);
            let count = (length / STEP_PX).ceil() as u32;
            for i in 0..count {
                let point = from.lerp(*to, (f64::from(i) + 0.5) / f64::from(count));
                if point.cmpge(DVec2::splat(BORDER_PX)).all() && point.cmple(high).all() {
                    samples.push((point, length / f64::from(count), number));
                }
            }
        }
        samples
    }
}

/// Compares drawn points with the true lines.
///
/// - `drawn`: px, as from [`drawn_centreline`].
/// - `within_px`: the distance within which they agree, above 0, at most [`MARGIN_PX`], beyond which lines outside the
///   picture are unknown.
pub fn accuracy(truth: &TrueLines, drawn: &[DVec2], within_px: f64) -> LineAccuracy {
    let distances = distances_to_lines(truth, drawn, within_px);
    let near: Vec<f64> = distances.into_iter().filter(|&distance| distance <= within_px).collect();
    let found = are_near(drawn, truth.samples().iter().map(|sample| sample.0), within_px);
    let (mut length, mut found_length) = (0.0, 0.0);
    for ((_, piece, _), found) in truth.samples().into_iter().zip(found) {
        length += piece;
        found_length += if found { piece } else { 0.0 };
    }
    let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 1.0 };
    let precision = share(near.len() as f64, drawn.len() as f64);
    let recall = share(found_length, length);
    LineAccuracy {
        precision,
        recall,
        f1: if precision + recall > 0.0 { 2.0 * precision * recall / (precision + recall) } else { 0.0 },
        drawn_px: drawn.len() as u64,
        true_length_px: length,
        within_px,
        mean_distance_px: near.iter().sum::<f64>() / near.len().max(1) as f64,
    }
}

/// For each point: the distance in px to the nearest true line, infinite beyond `reach_px`.
pub fn distances_to_lines(truth: &TrueLines, points: &[DVec2], reach_px: f64) -> Vec<f64> {
    // A segment is inserted in pieces, since the bounding box of a long slanted one covers most of the picture.
    const PIECE_PX: f64 = 4.0;
    let mut grid: HashMap<(i64, i64), Vec<u32>> = HashMap::new();
    for (number, TrueSegment { ends_px: [from, to], .. }) in (0u32..).zip(&truth.segments) {
        let pieces = (from.distance(*to) / PIECE_PX).ceil().max(1.0) as u32;
        for i in 0..pieces {
            let [a, b] = [i, i + 1].map(|i| from.lerp(*to, f64::from(i) / f64::from(pieces)));
            let (low, high) = (cell(a.min(b) - reach_px), cell(a.max(b) + reach_px));
            for y in low.1..=high.1 {
                for x in low.0..=high.0 {
                    let entries = grid.entry((x, y)).or_default();
                    if entries.last() != Some(&number) {
                        entries.push(number);
                    }
                }
            }
        }
    }
    let distance = |point: DVec2| {
        let candidates = grid.get(&cell(point)).into_iter().flatten();
        let nearest = candidates
            .map(|&number| distance_to_segment(point, truth.segments[number as usize].ends_px))
            .fold(f64::INFINITY, f64::min);
        if nearest <= reach_px { nearest } else { f64::INFINITY }
    };
    points.iter().map(|&point| distance(point)).collect()
}

/// For each point of `asked`: whether one of the `points` is within `reach_px`.
pub fn are_near(points: &[DVec2], asked: impl Iterator<Item = DVec2>, reach_px: f64) -> Vec<bool> {
    let mut grid: HashMap<(i64, i64), Vec<DVec2>> = HashMap::new();
    for &point in points {
        grid.entry(cell(point)).or_default().push(point);
    }
    let is_near = |asked: DVec2| {
        let (low, high) = (cell(asked - reach_px), cell(asked + reach_px));
        (low.1..=high.1).any(|y| {
            (low.0..=high.0)
                .any(|x| grid.get(&(x, y)).is_some_and(|points| points.iter().any(|p| p.distance(asked) <= reach_px)))
        })
    };
    asked.map(is_near).collect()
}

/// The cell of the search grid that contains a point; the cells' size, in px, only affects speed.
fn cell(point: DVec2) -> (i64, i64) {
    const CELL_PX: f64 = 2.0;
    ((point.x / CELL_PX).floor() as i64, (point.y / CELL_PX).floor() as i64)
}

fn distance_to_segment(point: DVec2, [from, to]: [DVec2; 2]) -> f64 {
    let span = to - from;
    let squared = span.length_squared();
    let along = if squared > 0.0 { ((point - from).dot(span) / squared).clamp(0.0, 1.0) } else { 0.0 };
    (from + span * along).distance(point)
}

#[cfg(test)]
mod tests;
