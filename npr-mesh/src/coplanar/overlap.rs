//! Finds the pairs of faces that lie in one plane and overlap.

use super::box_tree::BoxTree;
use glam::{DVec2, DVec3};

/// A triangle, with its plane.
#[derive(Clone, Copy)]
pub(super) struct Flat {
    pub corners: [DVec3; 3],
    /// Unit length.
    pub normal: DVec3,
    /// The height over the longest side.
    pub height: f64,
    /// Per side: the unit vector in the plane that is perpendicular to it.
    across: [DVec3; 3],
}

impl Flat {
    /// `None` if the triangle is no higher than `rounding` over its longest side, so that it has no certain plane.
    pub fn new(corners: [DVec3; 3], rounding: f64) -> Option<Self> {
        let (normal, height) = normal_and_height(corners).filter(|(_, height)| *height > rounding)?;
        let [a, b, c] = corners;
        let across = [b - a, c - b, a - c].map(|side| side.cross(normal).normalize());
        Some(Self { corners, normal, height, across })
    }
}

/// The unit normal of a triangle and its height over the longest side; `None` without area.
pub(super) fn normal_and_height([a, b, c]: [DVec3; 3]) -> Option<(DVec3, f64)> {
    let normal = (b - a).cross(c - a);
    let length = normal.length();
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared()).sqrt();
    let height = length / longest;
    (height > 0.0 && height.is_finite()).then(|| (normal / length, height))
}

/// Calls `visit` with each pair of triangles that lie in one plane and overlap, as far as `rounding`, the largest error
/// of a corner, tells.
pub(super) fn overlapping(flats: &[Flat], rounding: f64, mut visit: impl FnMut(usize, usize)) {
    // Triangles that overlap by no more than this only touch.
    let margin = 4.0 * rounding;
    let around = |flat: &Flat| {
        let [a, b, c] = flat.corners;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        // Boxes of triangles that only touch are apart, except along an axis on which one of them has no extent.
        let slack = DVec3::select(
            (high - low).cmpgt(DVec3::splat(4.0 * margin)),
            DVec3::splat(-rounding),
            DVec3::splat(rounding),
        );
        [low - slack, high + slack]
    };
    BoxTree::new(flats.iter().map(around)).pairs(|a, b| {
        let (a, b) = (a as usize, b as usize);
        if overlap(&flats[a], &flats[b], rounding, margin) {
            visit(a, b);
        }
    });
}

fn overlap(a: &Flat, b: &Flat, rounding: f64, margin: f64) -> bool {
    // The plane of the slimmer triangle is less certain.
    let (plane, other) = if a.height >= b.height { (a, b) } else { (b, a) };
    let from = plane.corners[0];
    other.corners.iter().all(|corner| (corner - from).dot(plane.normal).abs() <= 2.0 * rounding)
        && !is_apart(a, b, margin)
        && !is_apart(b, a, margin)
}

/// Whether a line along a side of `a` separates two triangles of one plane up to `margin` (the separating axis theorem).
fn is_apart(a: &Flat, b: &Flat, margin: f64) -> bool {
    (0..3).any(|side| {
        let range = |of: &[DVec3; 3]| {
            let [x, y, z] = of.map(|corner| a.across[side].dot(corner - a.corners[side]));
            (x.min(y).min(z), x.max(y).max(z))
        };
        let (ours, theirs) = (range(&a.corners), range(&b.corners));
        ours.1 - theirs.0 <= margin || theirs.1 - ours.0 <= margin
    })
}

/// The projection of a plane along the axis that is nearest to its normal. It keeps two coordinates as they are, so that
/// it rounds nothing, and the orientation of a triangle with this normal is counter-clockwise.
#[derive(Clone, Copy)]
pub(super) struct Projection {
    /// The two coordinates that are kept, and the one that is left out.
    axes: [usize; 3],
    normal: DVec3,
}

impl Projection {
    pub fn new(normal: DVec3) -> Self {
        let z = normal.abs().max_position();
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        Self { axes: if normal[z] < 0.0 { [y, x, z] } else { [x, y, z] }, normal }
    }

    pub fn project(&self, point: DVec3) -> DVec2 {
        DVec2::new(point[self.axes[0]], point[self.axes[1]])
    }

    /// The point of the plane through `on_plane` that is projected to `flat`.
    pub fn lift(&self, flat: DVec2, on_plane: DVec3) -> DVec3 {
        let [x, y, z] = self.axes;
        let mut point = DVec3::ZERO;
        (point[x], point[y]) = (flat.x, flat.y);
        let rest = (on_plane[x] - flat.x) * self.normal[x] + (on_plane[y] - flat.y) * self.normal[y];
        point[z] = on_plane[z] + rest / self.normal[z];
        point
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(corners: [DVec3; 3]) -> Flat {
        Flat::new(corners, 1e-6).expect("it has a height")
    }

    fn pairs(flats: &[Flat]) -> Vec<(usize, usize)> {
        let mut found = Vec::new();
        overlapping(flats, 1e-6, |a, b| found.push((a.min(b), a.max(b))));
        found.sort_unstable();
        found
    }

    #[test]
    fn neighbours_and_faces_above_one_another_do_not_overlap() {
        let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let first = flat([at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(0.0, 1.0, 0.0)]);
        let beside = flat([at(1.0, 0.0, 0.0), at(1.0, 1.0, 0.0), at(0.0, 1.0, 0.0)]);
        let touching = flat([at(0.2, 0.0, 0.0), at(0.4, -1.0, 0.0), at(0.8, 0.0, 0.0)]);
        let above = flat([at(0.0, 0.0, 1e-4), at(1.0, 0.0, 1e-4), at(0.0, 1.0, 1e-4)]);
        let upright = flat([at(0.1, 0.1, -1.0), at(0.5, 0.2, -1.0), at(0.2, 0.2, 1.0)]);
        assert_eq!(pairs(&[first, beside, touching, above, upright]), []);
        let within = flat([at(0.1, 0.1, 0.0), at(0.1, 0.3, 1e-7), at(0.3, 0.1, 0.0)]);
        assert_eq!(pairs(&[first, above, within]), [(0, 2)]);
    }

    #[test]
    fn projecting_and_lifting_return_to_the_point_and_keep_the_winding() {
        for normal in [DVec3::X, DVec3::NEG_Y, DVec3::new(0.2, -0.3, -0.9), DVec3::new(-0.8, 0.5, 0.4)] {
            let normal = normal.normalize();
            let (u, v) = normal.any_orthonormal_pair();
            let origin = DVec3::new(0.3, -2.0, 5.0);
            let along = Projection::new(normal);
            let [a, b, c] = [origin, origin + u, origin + v].map(|point| along.project(point));
            assert!((b - a).perp_dot(c - a) > 0.0, "{normal}");
            let point = origin + u * 0.7 - v * 0.2;
            assert!(along.lift(along.project(point), origin).distance(point) < 1e-14, "{normal}");
        }
    }
}
