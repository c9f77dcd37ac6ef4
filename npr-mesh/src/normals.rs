//! Computes missing vertex normals.

mod duplicates;

use crate::Model;
use crate::weld::{Rounding, Weld};
use glam::{DVec3, Vec3};

/// Computes a normal for every vertex without one, and normalises the given normals.
///
/// A normal is missing if it is exactly zero or not finite, or if [`Model::normals`] is too short.
///
/// Faces at one position that share an edge there belong to one smooth group if the angle between their normals is at
/// most `crease_angle_rad` (0..=π), transitively. The normal of a group is the sum of its faces' unit normals
/// weighted with the face's angle at the position (G. Thürmer, C. Wüthrich, "Computing Vertex Normals from Polygonal
/// Facets", 1998), which does not depend on the triangulation. A vertex whose faces are in several groups is split:
/// the lowest group keeps the vertex, and the others get copies, which are appended to all vertex arrays.
///
/// - Vertices that only rounding separates are at one position ([`crate::weld`]), so seams do not affect normals.
/// - If the normals of all faces at a position are within half the crease angle of their mean, the faces are one
///   group even if some share no edge.
/// - Faces of one polygon ([`Model::face_polygon`]) have the polygon's normal and, if it has one, are in one group.
/// - Faces that are there more than once, in any winding and cut along any diagonal, count once.
/// - Two faces of opposite winding are compared with one normal negated; each then gets the normal of the group on
///   its own front side.
/// - A face whose height is within the rounding of its coordinates, as for [`crate::edges`], or that has two corners at
///   one position, does not contribute. Two faces on both sides of it
///   are compared as if they were adjacent. It gets the normal of a neighbour, of any face at the position, or +Y.
///
/// Afterwards all normals are finite and of unit length. The time is approximately linear; the memory is about 60
/// bytes per face.
pub fn fill_missing(model: &mut Model, crease_angle_rad: f32) {
    fill_missing_welded(model, crease_angle_rad, Weld::default());
}

/// As [`fill_missing`], with a rule of its own for which vertices are at one position.
pub fn fill_missing_welded(model: &mut Model, crease_angle_rad: f32, weld: Weld) {
    fill_missing_in_groups(model, crease_angle_rad, &[], weld);
}

/// The group of faces for which the crease angle decides.
pub(crate) const UNSTATED: u32 = u32::MAX;

/// [`fill_missing_welded`] with a smoothing group for each face, as in OBJ files. Empty means [`UNSTATED`] for all.
///
/// All faces of a group at one position are one smooth group whatever their angle, faces of group 0 are flat, and
/// faces of different groups share no normal. Between faces of group [`UNSTATED`] the crease angle decides.
pub(crate) fn fill_missing_in_groups(model: &mut Model, crease_angle_rad: f32, groups: &[u32], weld: Weld) {
    debug_assert!(groups.is_empty() || groups.len() == model.faces.len());
    let missing = normalize_given(model);
    if !model.faces.iter().flatten().any(|&v| missing[v as usize]) {
        return;
    }
    let mut representative = weld.representatives(&model.positions, &model.faces);
    let mut wanted = vec![false; representative.len()];
    for (vertex, _) in missing.iter().enumerate().filter(|(_, m)| **m) {
        wanted[representative[vertex] as usize] = true;
    }
    let rounding = Rounding::new(&model.positions, &model.faces);
    let mut shapes = face_shapes(model, &rounding);
    let duplicates = duplicates::duplicates(&model.faces, &model.face_polygon, &representative);
    for (shape, _) in shapes.iter_mut().zip(&duplicates).filter(|(_, duplicate)| **duplicate) {
        shape.angles_rad = [0.0; 3];
    }
    // A tolerance, so that rounding of positions does not separate faces that meet at exactly the crease angle.
    let widest = (f64::from(crease_angle_rad).clamp(0.0, std::f64::consts::PI) + 1e-5).min(std::f64::consts::PI);
    let (least_cos, half_cos) = (widest.cos() - 1e-12, (0.5 * widest).cos());
    let means = smooth_means(model, &representative, &shapes, half_cos, groups);
    for (vertex, normal) in model.normals.iter_mut().enumerate().filter(|(vertex, _)| missing[*vertex]) {
        let mean = means[representative[vertex] as usize].as_vec3();
        if mean != Vec3::ZERO {
            *normal = mean;
            wanted[representative[vertex] as usize] = false;
        }
    }
    drop(means);
    let (first_corner, corners) = corners_by_position(model, &representative, &wanted);
    let mut fan = Fan::default();
    for here in 0..wanted.len() {
        let around = &corners[first_corner[here] as usize..first_corner[here + 1] as usize];
        if !around.is_empty() {
            fan.group(model, &representative, &shapes, here as u32, around, (least_cos, groups));
            fan.sum_up(&shapes, around);
            fan.assign(model, &mut representative, &missing, around);
        }
    }
    // Vertices were added one by one, for which the arrays may have doubled.
    model.positions.shrink_to_fit();
    model.normals.shrink_to_fit();
    model.uvs.shrink_to_fit();
    model.colors.shrink_to_fit();
}

/// Normalises the given normals. Returns per vertex whether its normal is missing; missing normals are set to +Y.
fn normalize_given(model: &mut Model) -> Vec<bool> {
    model.normals.resize(model.positions.len(), Vec3::ZERO);
    model
        .normals
        .iter_mut()
        .map(|normal| {
            let exact = normal.as_dvec3();
            let length_squared = exact.length_squared();
            if length_squared == 0.0 || !normal.is_finite() {
                *normal = Vec3::Y;
                return true;
            }
            if (length_squared - 1.0).abs() > 1e-6 {
                *normal = (exact / length_squared.sqrt()).as_vec3();
            }
            false
        })
        .collect()
}

struct FaceShape {
    /// The unit normal of the whole polygon; zero without area.
    normal: DVec3,
    /// The angles at the corners of the triangle.
    angles_rad: [f32; 3],
    /// Whether the normal is more than rounding error.
    sound: bool,
}

/// Quantities of a triangle, independent of its polygon.
#[derive(Clone, Copy, Default)]
struct Measures {
    /// The cross product of two sides, whose length is twice the area.
    area: DVec3,
    /// The dot products of the sides at the first and at the second corner.
    dots: [f64; 2],
    longest_squared: f64,
    shortest_squared: f64,
    /// The largest absolute coordinate.
    magnitude: f32,
}

fn measure(model: &Model, face: &[u32; 3]) -> Measures {
    let [a, b, c] = face.map(|v| model.positions[v as usize]);
    // In f64 the products of f32 coordinates neither overflow nor underflow.
    let (ab, ac) = (b.as_dvec3() - a.as_dvec3(), c.as_dvec3() - a.as_dvec3());
    let bc = ac - ab;
    let (ab2, ac2, bc2) = (ab.length_squared(), ac.length_squared(), bc.length_squared());
    Measures {
        area: ab.cross(ac),
        dots: [ab.dot(ac), -ab.dot(bc)],
        longest_squared: ab2.max(ac2).max(bc2),
        shortest_squared: ab2.min(ac2).min(bc2),
        magnitude: a.abs().max(b.abs()).max(c.abs()).max_element(),
    }
}

/// Processes blocks, first all measures and then all angles, so that divisions and square roots are pipelined.
fn face_shapes(model: &Model, rounding: &Rounding) -> Vec<FaceShape> {
    const BLOCK: usize = 64;
    let mut measures = [Measures::default(); BLOCK];
    let mut shapes: Vec<FaceShape> = Vec::with_capacity(model.faces.len());
    // The last polygon in `shapes`: its first face, and its area vector, longest edge and magnitude so far.
    let mut polygon = (0, DVec3::ZERO, 0.0f64, 0.0f32);
    for block in model.faces.chunks(BLOCK) {
        let measures = &mut measures[..block.len()];
        for (measures, face) in measures.iter_mut().zip(block) {
            *measures = measure(model, face);
        }
        let before = shapes.len();
        shapes.extend(measures.iter().map(|measures| {
            // The cross product of any two sides has the same length, so one square root serves all angles.
            let length = measures.area.length();
            let [at_a, at_b] = measures.dots.map(|dot| angle_rad(length, dot));
            let at_c = if measures.shortest_squared > 0.0 { std::f64::consts::PI - at_a - at_b } else { 0.0 };
            FaceShape {
                normal: if length > 0.0 && length.is_finite() { measures.area / length } else { DVec3::ZERO },
                angles_rad: [at_a as f32, at_b as f32, at_c.max(0.0) as f32],
                sound: is_sound(length, measures.longest_squared, measures.magnitude, rounding),
            }
        }));
        if model.face_polygon.is_empty() {
            continue;
        }
        for (face, measures) in (before..).zip(&*measures) {
            let goes_on = face > 0 && model.face_polygon[face] == model.face_polygon[face - 1];
            let (first, area, longest_squared, magnitude) =
                if goes_on { polygon } else { (face, DVec3::ZERO, 0.0, 0.0) };
            polygon = (
                first,
                area + measures.area,
                longest_squared.max(measures.longest_squared),
                magnitude.max(measures.magnitude),
            );
            let ends = model.face_polygon.get(face + 1) != Some(&model.face_polygon[face]);
            if ends && first < face {
                let (_, area, longest_squared, magnitude) = polygon;
                let length = area.length();
                for shape in &mut shapes[first..=face] {
                    shape.normal = if length > 0.0 && length.is_finite() { area / length } else { DVec3::ZERO };
                    shape.sound = is_sound(length, longest_squared, magnitude, rounding);
                }
            }
        }
    }
    shapes
}

/// Whether a normal is more than rounding error: whether the height, twice the area over the longest edge, exceeds what
/// rounding of the coordinates accounts for, and half a unit in their last place in any case.
fn is_sound(length: f64, longest_squared: f64, magnitude: f32, rounding: &Rounding) -> bool {
    let least = f64::from(rounding.of(magnitude)).max(f64::from(magnitude) * f64::from(f32::EPSILON) * 0.5);
    length.is_finite() && length > least * longest_squared.sqrt()
}

/// The angle between two vectors from the length of their cross product and their dot product; 0 if both are zero.
///
/// M. Abramowitz, I. Stegun, "Handbook of Mathematical Functions", 4.4.49, with an error of at most 2e-8.
#[inline]
fn angle_rad(cross_length: f64, dot: f64) -> f64 {
    let (short, long) = (cross_length.min(dot.abs()), cross_length.max(dot.abs()));
    let x = if long > 0.0 { short / long } else { 0.0 };
    const TERMS: [f64; 9] = [
        0.002_866_225_7,
        -0.016_165_736_7,
        0.042_909_613_8,
        -0.075_289_640_0,
        0.106_562_639_3,
        -0.142_088_994_4,
        0.199_935_508_5,
        -0.333_331_452_8,
        1.0,
    ];
    let arc_tangent = x * TERMS.iter().fold(0.0, |sum, term| sum * (x * x) + term);
    let acute = if cross_length > dot.abs() { std::f64::consts::FRAC_PI_2 - arc_tangent } else { arc_tangent };
    if dot < 0.0 { std::f64::consts::PI - acute } else { acute }
}

/// Per position the unit mean of its faces' normals, or zero if they may not be one group: if a normal is unsound, or
/// deviates from the mean by more than half the crease angle. (Any two are otherwise within the crease angle of each
/// other.)
///
/// Most positions of most models are smooth, and need no list of faces then.
fn smooth_means(
    model: &Model,
    representative: &[u32],
    shapes: &[FaceShape],
    half_cos: f64,
    groups: &[u32],
) -> Vec<DVec3> {
    let mut means = vec![DVec3::ZERO; representative.len()];
    let corners = |face: &[u32; 3]| face.map(|vertex| representative[vertex as usize] as usize);
    for (face, shape) in model.faces.iter().zip(shapes) {
        for (here, angle_rad) in corners(face).into_iter().zip(shape.angles_rad) {
            means[here] += shape.normal * f64::from(angle_rad);
        }
    }
    for mean in &mut means {
        *mean = mean.normalize_or_zero();
    }
    for (face, shape) in model.faces.iter().zip(shapes) {
        for here in corners(face) {
            // Any normal fails this test if the mean is zero.
            if !shape.sound || shape.normal.dot(means[here]) < half_cos {
                means[here] = DVec3::ZERO;
            }
        }
    }
    if !groups.is_empty() {
        // The group of the first face at each position; flat faces share no normal, nor do those of different groups.
        let mut group_at = vec![None; representative.len()];
        for (face, group) in model.faces.iter().zip(groups) {
            for here in corners(face) {
                if *group == 0 || *group_at[here].get_or_insert(*group) != *group {
                    means[here] = DVec3::ZERO;
                }
            }
        }
    }
    means
}

/// The face corners (three times the face plus 0..3) at each wanted position in ascending order, and the start of
/// each position's range.
fn corners_by_position(model: &Model, representative: &[u32], wanted: &[bool]) -> (Vec<u32>, Vec<u32>) {
    let mut first = vec![0u32; representative.len() + 1];
    for &v in model.faces.iter().flatten() {
        let here = representative[v as usize] as usize;
        first[here + 1] += u32::from(wanted[here]);
    }
    let mut sum = 0;
    for count in &mut first {
        sum += *count;
        *count = sum;
    }
    let mut corners = vec![0u32; sum as usize];
    let mut free = first.clone();
    for (corner, &v) in model.faces.iter().flatten().enumerate() {
        let here = representative[v as usize] as usize;
        if wanted[here] {
            let slot = &mut free[here];
            corners[*slot as usize] = corner as u32;
            *slot += 1;
        }
    }
    (first, corners)
}

/// The face corners at one position, numbered from 0, and their groups. Reused to avoid allocations.
#[derive(Default)]
struct Fan {
    /// (other end of the edge, corner, whether the edge runs towards this position), packed into one sortable
    /// integer.
    edges: Vec<u64>,
    /// A union-find forest: the parent corner, and whether its face has the opposite winding.
    parent: Vec<(u32, bool)>,
    /// An unsound corner, a sound corner that shares an edge with it, and whether the latter has the opposite
    /// winding.
    bridges: Vec<(u32, u32, bool)>,
    /// The normal of each group, at its root corner.
    normals: Vec<DVec3>,
    /// (vertex, group, side, corner) of the corners whose normal is missing.
    claims: Vec<(u32, u32, bool, u32)>,
}

/// If an edge has more faces, each is compared only with the next one.
const FACES_COMPARED_AT_AN_EDGE: usize = 16;

impl Fan {
    fn root(&mut self, corner: u32) -> (u32, bool) {
        let (mut at, mut turned) = (corner, false);
        loop {
            let (parent, flip) = self.parent[at as usize];
            if parent == at {
                return (at, turned);
            }
            // Path halving; the flips of the two steps are combined.
            let (grandparent, second_flip) = self.parent[parent as usize];
            self.parent[at as usize] = (grandparent, flip ^ second_flip);
            turned ^= flip ^ second_flip;
            at = grandparent;
        }
    }

    fn join(&mut self, a: u32, b: u32, opposite: bool) {
        let ((root_a, turned_a), (root_b, turned_b)) = (self.root(a), self.root(b));
        // The lower root is kept, independently of the order of joining.
        if root_a != root_b {
            self.parent[root_a.max(root_b) as usize] = (root_a.min(root_b), turned_a ^ turned_b ^ opposite);
        }
    }

    fn group(
        &mut self,
        model: &Model,
        representative: &[u32],
        shapes: &[FaceShape],
        here: u32,
        around: &[u32],
        (least_cos, groups): (f64, &[u32]),
    ) {
        self.edges.clear();
        self.parent.clear();
        self.bridges.clear();
        for (i, &corner) in around.iter().enumerate() {
            self.parent.push((i as u32, false));
            let face = model.faces[corner as usize / 3];
            let k = corner as usize % 3;
            for (other, towards) in [(face[(k + 1) % 3], 0), (face[(k + 2) % 3], 1)] {
                let other = representative[other as usize];
                if other != here {
                    self.edges.push(u64::from(other) << 32 | (i as u64) << 1 | towards);
                }
            }
        }
        self.edges.sort_unstable();
        let face_of = |i: u32| around[i as usize] as usize / 3;
        let group_of = |i: u32| groups.get(face_of(i)).copied().unwrap_or(UNSTATED);
        let meet_smoothly = |i: u32, j: u32, opposite: bool| {
            let cos = shapes[face_of(i)].normal.dot(shapes[face_of(j)].normal);
            match (group_of(i), group_of(j)) {
                (UNSTATED, UNSTATED) => (if opposite { -cos } else { cos }) >= least_cos,
                (a, b) => a == b && a != 0,
            }
        };
        let edges = std::mem::take(&mut self.edges);
        for at_edge in edges.chunk_by(|a, b| a >> 32 == b >> 32) {
            let side = |e: u64| ((e as u32) >> 1, e & 1 == 1);
            for (n, &edge) in at_edge.iter().enumerate() {
                let (i, i_towards) = side(edge);
                let reach = if at_edge.len() > FACES_COMPARED_AT_AN_EDGE { 1 } else { at_edge.len() };
                for &other in at_edge[n + 1..].iter().take(reach) {
                    let (j, j_towards) = side(other);
                    let (f, g) = (face_of(i), face_of(j));
                    let opposite = i_towards == j_towards;
                    let is_polygon = model.face_polygon.get(f).is_some_and(|p| model.face_polygon.get(g) == Some(p));
                    if is_polygon {
                        // A polygon without area would join what is on both sides of it.
                        if shapes[f].sound {
                            self.join(i, j, false);
                        }
                    } else {
                        match (shapes[f].sound, shapes[g].sound) {
                            (true, true) if meet_smoothly(i, j, opposite) => self.join(i, j, opposite),
                            (true, false) => self.bridges.push((j, i, opposite)),
                            (false, true) => self.bridges.push((i, j, opposite)),
                            _ => {}
                        }
                    }
                }
            }
        }
        self.edges = edges;
        if !groups.is_empty() {
            // Faces of one group share a normal even where they share no edge.
            let mut first_of: Vec<(u32, u32)> = Vec::new();
            for i in (0..around.len() as u32).filter(|&i| shapes[face_of(i)].sound) {
                match (group_of(i), first_of.iter().find(|(group, _)| *group == group_of(i))) {
                    (0 | UNSTATED, _) => {}
                    (_, Some(&(_, first))) => self.join(first, i, false),
                    (group, None) => first_of.push((group, i)),
                }
            }
        }
        self.settle_unsound(shapes, around, &meet_smoothly);
    }

    /// Compares the faces on both sides of each unsound face, and then assigns each unsound corner to one group.
    fn settle_unsound(
        &mut self,
        shapes: &[FaceShape],
        around: &[u32],
        meet_smoothly: &impl Fn(u32, u32, bool) -> bool,
    ) {
        let is_sound = |i: u32| shapes[around[i as usize] as usize / 3].sound;
        let corners = 0..around.len() as u32;
        if corners.clone().all(is_sound) {
            return;
        }
        let mut bridges = std::mem::take(&mut self.bridges);
        bridges.sort_unstable();
        for bridge in bridges.chunk_by(|a, b| a.0 == b.0) {
            for pair in bridge.windows(2) {
                let opposite = pair[0].2 ^ pair[1].2;
                if meet_smoothly(pair[0].1, pair[1].1, opposite) {
                    self.join(pair[0].1, pair[1].1, opposite);
                }
            }
        }
        // After all comparisons, so that an unsound face does not connect groups that must remain separate. A face
        // with two corners at this position contains its edge in both directions; equal winding is assumed.
        for bridge in bridges.chunk_by(|a, b| a.0 == b.0) {
            let &(unsound, sound, opposite) = bridge.iter().find(|b| !b.2).unwrap_or(&bridge[0]);
            self.join(unsound, sound, opposite);
        }
        let any = corners.clone().find(|&i| is_sound(i)).unwrap_or(0);
        for i in corners {
            if !is_sound(i) && bridges.binary_search_by_key(&i, |b| b.0).is_err() {
                self.join(i, any, false);
            }
        }
        self.bridges = bridges;
    }

    fn sum_up(&mut self, shapes: &[FaceShape], around: &[u32]) {
        self.normals.clear();
        self.normals.resize(around.len(), DVec3::ZERO);
        let shape_of = |i: u32| &shapes[around[i as usize] as usize / 3];
        for (i, &corner) in around.iter().enumerate() {
            let (root, turned) = self.root(i as u32);
            let shape = shape_of(i as u32);
            if shape.sound {
                let share = shape.normal * f64::from(shape.angles_rad[corner as usize % 3]);
                self.normals[root as usize] += if turned { -share } else { share };
            }
        }
        for i in 0..around.len() as u32 {
            let (root, turned) = self.root(i);
            let own = shape_of(i);
            if root == i {
                let length = self.normals[i as usize].length();
                if length > 1e-9 {
                    self.normals[i as usize] /= length;
                } else {
                    // Set below from the group's first face with a normal.
                    self.normals[i as usize] = DVec3::ZERO;
                }
            }
            if own.sound && self.normals[root as usize] == DVec3::ZERO {
                self.normals[root as usize] = if turned { -own.normal } else { own.normal };
            }
        }
        // There is no sound face at this position, and a single group.
        if self.normals[0] == DVec3::ZERO && self.root(0).0 == 0 {
            let sum: DVec3 = (0..around.len() as u32).map(|i| shape_of(i).normal).sum();
            self.normals[0] = sum.try_normalize().unwrap_or(DVec3::Y);
        }
    }

    fn assign(&mut self, model: &mut Model, representative: &mut Vec<u32>, missing: &[bool], around: &[u32]) {
        self.claims.clear();
        let mut is_one = true;
        for (i, &corner) in around.iter().enumerate() {
            let vertex = model.faces[corner as usize / 3][corner as usize % 3];
            // Vertices beyond the end were added by a split and have a normal.
            if missing.get(vertex as usize) == Some(&true) {
                let (root, turned) = self.root(i as u32);
                is_one &= root == 0 && !turned;
                self.claims.push((vertex, root, turned, corner));
            }
        }
        if is_one {
            let normal = self.normals[0].as_vec3();
            for claim in &self.claims {
                model.normals[claim.0 as usize] = normal;
            }
            return;
        }
        self.claims.sort_unstable();
        let mut last_vertex = None;
        for same in self.claims.chunk_by(|a, b| (a.0, a.1, a.2) == (b.0, b.1, b.2)) {
            let (vertex, root, turned, _) = same[0];
            let normal = self.normals[root as usize].as_vec3();
            let normal = if turned { -normal } else { normal };
            if last_vertex != Some(vertex) {
                last_vertex = Some(vertex);
                model.normals[vertex as usize] = normal;
                continue;
            }
            let copy = model.positions.len() as u32;
            model.positions.push(model.positions[vertex as usize]);
            model.normals.push(normal);
            if let Some(&uv) = model.uvs.get(vertex as usize) {
                model.uvs.push(uv);
            }
            if let Some(&color) = model.colors.get(vertex as usize) {
                model.colors.push(color);
            }
            representative.push(representative[vertex as usize]);
            for claim in same {
                model.faces[claim.3 as usize / 3][claim.3 as usize % 3] = copy;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_angle_is_right_to_a_few_parts_in_1e8() {
        for i in 0..=1000 {
            let angle = std::f64::consts::PI * f64::from(i) / 1000.0;
            assert!((angle_rad(angle.sin() * 36.0, angle.cos() * 36.0) - angle).abs() < 5e-8, "{angle}");
        }
        assert_eq!(angle_rad(0.0, 0.0), 0.0);
    }
}
