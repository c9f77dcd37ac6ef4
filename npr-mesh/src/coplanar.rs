//! Faces that lie in one plane and overlap.
//!
//! Where two faces are at one place, the rounding of depth decides which of them a renderer shows, and the picture is
//! striped. [`separate`] cuts such faces by each other, so that pieces are the same triangle or do not overlap, and keeps
//! of faces at one place those that are visible by a rule:
//!
//! 1. The face that turns its front to the eye is visible.
//! 2. Of several that do, the later in the file is visible, so that a mark on a sheet is whole if it follows the sheet.
//! 3. Faces that are not opaque hide nothing. Both they and the first opaque face below them remain.
//!
//! A face that is hidden from behind only becomes [one-sided](Model::one_sided). One that is hidden from both sides goes.
//! Nothing is moved or offset.
//!
//! Two faces lie in one plane if the corners of one are within [`ROUNDING`] of the other's plane, relative to the largest
//! coordinate of the model. That covers the rounding of a file that was turned in f32; anything farther apart stays.

mod arrangement;
mod box_tree;
mod layers;
mod output;
mod overlap;
mod planes;

pub use output::Separated;

use crate::weld::weld_within;
use crate::{AlphaMode, Model};
use arrangement::{Piece, Pieces, arrange};
use glam::{DVec3, Vec3};
use layers::{Layer, VisibleSides, visible_sides};
use output::{Output, Part};
use overlap::{Flat, Projection, normal_and_height, overlapping};
use planes::Plane;
use std::collections::HashMap;

/// The largest error of a corner, relative to the largest coordinate of a model: four units in the last place of f32.
pub const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;

/// The number of crossings of sides that are computed for one model, for a time of about a second. Faces that overlap in
/// more places stay as they are.
const CROSSINGS: usize = 1 << 18;

/// The model with its coplanar faces separated by the rule above; `None` if no face hides another.
///
/// Pieces of a face have its material, mesh and polygon, stand where it stood in the order of the file, and have corners
/// of their own where it has none, with interpolated normals, texture coordinates and colours. A face that is not
/// opaque is one whose material has another alpha mode than [`AlphaMode::Opaque`].
///
/// Time is linear for models whose faces lie in different planes, n log n in the number of the others, and that of a
/// constrained Delaunay triangulation for each group of overlapping ones.
///
/// ```
/// use npr_mesh::{Model, coplanar, glam::Vec3};
///
/// // A square, cut along one diagonal, and the same square cut along the other.
/// let model = Model {
///     positions: vec![Vec3::ZERO, Vec3::X, Vec3::ONE.with_z(0.0), Vec3::Y],
///     normals: vec![Vec3::Z; 4],
///     faces: vec![[0, 1, 2], [0, 2, 3], [1, 2, 3], [1, 3, 0]],
///     ..Model::default()
/// };
/// let separated = coplanar::separate(&model).expect("faces overlap").model;
/// assert_eq!(separated.faces.len(), 4); // the pieces of the second square
/// assert_eq!(separated.face_polygon, [2, 2, 3, 3]);
/// assert!(coplanar::separate(&separated).is_none());
/// ```
pub fn separate(model: &Model) -> Option<Separated> {
    let groups = Groups::find(model)?;
    let mut output = Output::new();
    let mut budget = CROSSINGS;
    for group in &groups.groups {
        groups.separate(model, group, &mut budget, &mut output);
    }
    output.finish(model)
}

/// Faces with the same corners, and the groups of those that overlap.
struct Groups {
    /// Each in the order of the file.
    stacks: Vec<Vec<u32>>,
    flats: Vec<Flat>,
    /// Groups of stacks that overlap, and stacks of several faces that overlap nothing else.
    groups: Vec<Vec<usize>>,
    rounding: f64,
}

impl Groups {
    fn find(model: &Model) -> Option<Self> {
        let (low, high) = model.bounds()?;
        let (low, high) = (low.as_dvec3(), high.as_dvec3());
        let rounding = ROUNDING * low.abs().max(high.abs()).max_element();
        let (center, size) = (low.midpoint(high), (high - low).length());
        let flat = |face: u32| Flat::new(corners_of(model, face), rounding);
        let plane = |face: u32| {
            let corners = corners_of(model, face);
            let (normal, height) = normal_and_height(corners)?;
            let distance = normal.dot((corners[0] - center) / size);
            (height > rounding).then(|| Plane { normal, distance, error: rounding / height })
        };
        let planes: Vec<Option<Plane>> = (0..model.faces.len() as u32).map(plane).collect();
        let candidates = planes::shared(&planes);
        drop(planes);

        let mut stack_of: HashMap<[[u32; 3]; 3], usize> = HashMap::with_capacity(candidates.len());
        let (mut stacks, mut flats): (Vec<Vec<u32>>, Vec<Flat>) = Default::default();
        for face in candidates {
            let Some(flat) = flat(face) else { continue };
            // Zero is added, since -0 is 0.
            let bits = |v: u32| (model.positions[v as usize] + Vec3::ZERO).to_array().map(f32::to_bits);
            let mut key = model.faces[face as usize].map(bits);
            key.sort_unstable();
            let stack = *stack_of.entry(key).or_insert(stacks.len());
            if stack == stacks.len() {
                stacks.push(Vec::new());
                flats.push(flat);
            }
            stacks[stack].push(face);
        }
        drop(stack_of);

        let mut parents: Vec<usize> = (0..stacks.len()).collect();
        overlapping(&flats, rounding, |a, b| {
            let (a, b) = (root(&mut parents, a), root(&mut parents, b));
            parents[a.max(b)] = a.min(b);
        });
        let mut of_root: Vec<Vec<usize>> = vec![Vec::new(); stacks.len()];
        for stack in 0..stacks.len() {
            of_root[root(&mut parents, stack)].push(stack);
        }
        let is_shared = |group: &Vec<usize>| group.len() > 1 || group.iter().any(|&stack| stacks[stack].len() > 1);
        let groups: Vec<Vec<usize>> = of_root.into_iter().filter(is_shared).collect();
        (!groups.is_empty()).then_some(Self { stacks, flats, groups, rounding })
    }

    /// Cuts the faces of a group and selects what is visible of them.
    fn separate(&self, model: &Model, group: &[usize], budget: &mut usize, output: &mut Output) {
        // The plane of the triangle with the largest height is the most certain.
        let Some(plane) = (group.iter().map(|&stack| self.flats[stack])).max_by(|a, b| a.height.total_cmp(&b.height))
        else {
            return;
        };
        let along = Projection::new(plane.normal);
        let faces_of = |stacks: &mut dyn Iterator<Item = usize>| {
            let mut faces: Vec<u32> = stacks.flat_map(|stack| &self.stacks[stack]).copied().collect();
            faces.sort_unstable();
            faces
        };
        let faces = faces_of(&mut group.iter().copied());
        let covered_triangles = if let [stack] = *group {
            let [a, b, c] = self.flats[stack].corners;
            vec![CoveredTriangle::new(model, plane.normal, [a, b, c], faces.clone())]
        } else {
            let corners: Vec<DVec3> =
                group.iter().flat_map(|&stack| corners_of(model, self.stacks[stack][0])).collect();
            let (mut points, triangles) = joined(&corners, 2.0 * self.rounding);
            let Some(Pieces { added, pieces }) = arrange(&points, &triangles, along, self.rounding, budget) else {
                return;
            };
            // Rounded here, once for all faces of a piece.
            points.extend(added.iter().map(|point| point.as_vec3().as_dvec3()));
            let covered = |Piece { corners, of }: &Piece| {
                let faces = faces_of(&mut of.iter().map(|&at| group[at as usize]));
                CoveredTriangle::new(model, plane.normal, corners.map(|point| points[point as usize]), faces)
            };
            pieces.iter().map(covered).collect()
        };
        // Where nothing hides anything that would be shown, all stay as they are.
        if covered_triangles.iter().all(|triangle| triangle.is_unchanged(model)) {
            return;
        }
        let is_cut = group.len() > 1;
        faces.iter().for_each(|&face| output.change(face, is_cut));
        covered_triangles.iter().for_each(|triangle| triangle.select(model, along, is_cut, output));
    }
}

/// A triangle that several faces cover.
struct CoveredTriangle {
    /// Counter-clockwise seen against the normal of the plane.
    corners: [DVec3; 3],
    /// In the order of the file.
    faces: Vec<u32>,
    layers: Vec<Layer>,
    visible: Vec<VisibleSides>,
    /// Whether several faces are visible from one side, through each other.
    is_shared: bool,
}

impl CoveredTriangle {
    fn new(model: &Model, normal: DVec3, corners: [DVec3; 3], faces: Vec<u32>) -> Self {
        let layers = layers(model, &faces, normal);
        let visible = visible_sides(&layers);
        let is_up = |layer: &Layer, visible: &VisibleSides| if layer.front { visible.front } else { visible.back };
        let up = layers.iter().zip(&visible).filter(|(layer, visible)| is_up(layer, visible)).count();
        let of_all = visible.iter().filter(|visible| visible.front).count()
            + visible.iter().filter(|visible| visible.back).count();
        let [a, b, c] = corners;
        let is_counter_clockwise = (b - a).cross(c - a).dot(normal) > 0.0;
        let corners = if is_counter_clockwise { [a, b, c] } else { [a, c, b] };
        Self { corners, faces, layers, visible, is_shared: up > 1 || of_all - up > 1 }
    }

    /// Whether all faces are visible as they would be alone, and none through another.
    fn is_unchanged(&self, model: &Model) -> bool {
        let alone = |face: u32| VisibleSides { front: true, back: model.shows_back(face) };
        !self.is_shared && self.faces.iter().zip(&self.visible).all(|(&face, &visible)| visible == alone(face))
    }

    /// Adds what is visible of the faces to the result.
    fn select(&self, model: &Model, along: Projection, is_cut: bool, output: &mut Output) {
        for ((&face, layer), &visible) in self.faces.iter().zip(&self.layers).zip(&self.visible) {
            if !(is_cut || self.is_shared) {
                output.keep(face, visible);
                continue;
            }
            // Faces that are visible through each other have equal corners in the same order, so that depths are equal.
            let is_turned = self.is_shared && !layer.front && visible.front && visible.back;
            let [a, b, c] = self.corners;
            let corners = if layer.front { [a, b, c] } else { [a, c, b] };
            output.add_piece(model, face, along, Part { corners, visible, is_turned });
        }
    }
}

fn corners_of(model: &Model, face: u32) -> [DVec3; 3] {
    model.faces[face as usize].map(|vertex| model.positions[vertex as usize].as_dvec3())
}

/// What decides which of some faces is visible, in their order.
fn layers(model: &Model, faces: &[u32], normal: DVec3) -> Vec<Layer> {
    let layer = |&face: &u32| {
        let [a, b, c] = corners_of(model, face);
        let material = model.material_of(face);
        Layer {
            front: (b - a).cross(c - a).dot(normal) > 0.0,
            double_sided: model.shows_back(face),
            opaque: material.is_none_or(|material| material.alpha_mode == AlphaMode::Opaque),
        }
    };
    faces.iter().map(layer).collect()
}

/// Joins corners within a distance: the points that are left, and the triangles of each three corners.
fn joined(corners: &[DVec3], distance: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let positions: Vec<Vec3> = corners.iter().map(|corner| corner.as_vec3()).collect();
    let representative = weld_within(&positions, distance as f32);
    let (mut numbers, mut points) = (HashMap::new(), Vec::new());
    let mut number = |vertex: u32| {
        *numbers.entry(vertex).or_insert_with(|| {
            points.push(corners[vertex as usize]);
            points.len() as u32 - 1
        })
    };
    let triangles = representative.as_chunks::<3>().0.iter().map(|triangle| triangle.map(&mut number)).collect();
    (points, triangles)
}

/// The root of a union-find forest, with path halving.
fn root(parents: &mut [usize], mut at: usize) -> usize {
    while parents[at] != at {
        parents[at] = parents[parents[at]];
        at = parents[at];
    }
    at
}

#[cfg(test)]
mod tests;
