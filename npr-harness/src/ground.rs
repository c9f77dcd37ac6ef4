//! A plane under the model that catches shadows.
//!
//! [`Scene::ground`](crate::scene::Scene::ground) asks for it. It is horizontal, below the lowest point of the subject, and
//! visible from above where nothing is in front of it. Where the light reaches it, it is paper, as if it were not there; in
//! a cast shadow it is what a paper-coloured surface would be there, in hatched styles with strokes. It is no part of the
//! model: it has no lines but the borders of shadows (in styles whose shadows have lines by their states), hides no lines,
//! casts no shadow, and changes neither the view nor what depends on the model's size. A clipping plane does not cut it.

use crate::scene::Scene;
#[cfg(feature = "gpu")]
use glam::Vec3;
use glam::{DVec2, DVec3, DVec4};

/// The distance of the plane below the lowest point, in radii of the subject. Larger than the rounding of depths, so that
/// a face that lies on the ground is in front of it; far less than a pixel.
const GAP: f64 = 1e-4;

/// The width of the lit margin around the shadow, in radii of the subject: shadows have a border on all sides.
const MARGIN: f64 = 0.1;

/// The largest distance of the rectangle's sides from the middle of the subject, in radii, for grazing light.
const FARTHEST: f64 = 64.0;

/// The part of the plane that a shadow may fall on: a rectangle along the axes, scene space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundPlan {
    /// The Y of the plane.
    pub height: f64,
    /// The least X and Z.
    pub low: DVec2,
    /// The greatest X and Z.
    pub high: DVec2,
}

/// The least sine of the angle at which light falls on the ground.
const LEAST_SLOPE: f64 = 1e-6;

impl GroundPlan {
    /// The ground of a scene for the light that casts shadows: a point with w = 1, or the unit direction to it with w = 0.
    /// `None` if the light is not above the ground, or if the subject is a point.
    pub fn new(scene: &Scene, light: DVec4) -> Option<Self> {
        let (low, high) = scene.subject().map(|(low, high)| (low.as_dvec3(), high.as_dvec3()))?;
        let (middle, radius) = (scene.middle(), scene.radius());
        let height = low.y - GAP * radius;
        let is_above = light.y - height * light.w > LEAST_SLOPE * (light.truncate() - middle * light.w).length();
        if radius == 0.0 || !is_above {
            return None;
        }
        let flat = |point: DVec3| DVec2::new(point.x, point.z);
        let farthest = FARTHEST * radius;
        let mut ends = (flat(low), flat(high));
        for corner in 0..8u8 {
            let end = |bit: u8| if corner & bit == 0 { low } else { high };
            let corner = DVec3::new(end(1).x, end(2).y, end(4).z);
            let way = light.truncate() - corner * light.w;
            // The shadow of a corner that is not below a lamp has no end.
            let (least, most) = if way.y > LEAST_SLOPE * way.length() {
                let shadow = flat(corner - way * ((corner.y - height) / way.y));
                (shadow, shadow)
            } else {
                (flat(middle) - farthest, flat(middle) + farthest)
            };
            ends = (ends.0.min(least), ends.1.max(most));
        }
        let (least, most) = (flat(middle) - farthest, flat(middle) + farthest);
        let margin = MARGIN * radius;
        Some(Self { height, low: (ends.0 - margin).clamp(least, most), high: (ends.1 + margin).clamp(least, most) })
    }

    /// The corners, counter-clockwise seen from above.
    pub fn corners(&self) -> [DVec3; 4] {
        let Self { height, low, high } = *self;
        [(low.x, high.y), (high.x, high.y), (high.x, low.y), (low.x, low.y)].map(|(x, z)| DVec3::new(x, height, z))
    }

    /// Where a ray meets the plane, inside the rectangle or not.
    pub(crate) fn on_plane(&self, origin: DVec3, direction: DVec3) -> (f64, DVec3) {
        let t = (self.height - origin.y) / direction.y;
        (t, origin + direction * t)
    }

    /// The t of the point of the rectangle that a ray shows from above.
    pub(crate) fn meets(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        if direction.y >= 0.0 {
            return None;
        }
        let (t, at) = self.on_plane(origin, direction);
        let at = DVec2::new(at.x, at.z);
        (at.cmpge(self.low).all() && at.cmple(self.high).all()).then_some(t)
    }

    /// The texture coordinates of a point for strokes, which lie as densely as those by planes; `tile` is the length of a
    /// map's side.
    pub(crate) fn uv(at: DVec3, tile: f64) -> DVec2 {
        DVec2::new(at.x, at.z) / tile
    }

    #[cfg(feature = "gpu")]
    fn bounds(&self) -> (Vec3, Vec3) {
        let [low, _, high, _] = self.corners();
        (low.min(high).as_vec3(), low.max(high).as_vec3())
    }
}

/// The box of everything that a picture with this ground shows: of the scene, and of the ground.
#[cfg(feature = "gpu")]
pub(crate) fn bounds_with(ground: Option<&GroundPlan>, scene: &Scene) -> Option<(Vec3, Vec3)> {
    let (low, high) = scene.bounds()?;
    Some(ground.map_or((low, high), |ground| {
        let of_ground = ground.bounds();
        (low.min(of_ground.0), high.max(of_ground.1))
    }))
}

/// The name of the pass.
pub(crate) const GROUND: &str = "ground";

#[cfg(test)]
mod tests {
    use super::*;
    use npr_mesh::embedded::cube;

    fn ground(light: DVec4) -> Option<GroundPlan> {
        GroundPlan::new(&Scene::new(cube()), light)
    }

    #[test]
    fn the_rectangle_holds_the_shadow_and_a_lit_margin() {
        let scene = Scene::new(cube());
        let (low, high) = scene.bounds().expect("it has faces");
        let side = f64::from(high.x - low.x);
        let toward_light = DVec3::new(3.0, 1.0, -0.5).normalize();
        let GroundPlan { height, low: least, high: most } = ground(toward_light.extend(0.0)).expect("a ground");
        let margin = MARGIN * scene.radius();
        assert!(height < f64::from(low.y) && height > f64::from(low.y) - 1e-3 * side);
        // The shadow of the upper side is three sides to the left, and half of one to the front.
        let expected = [low.x.into(), high.x.into(), low.z.into(), high.z.into()];
        let [left, right, back, front]: [f64; 4] = expected;
        for (found, expected) in [
            (least.x, left - 3.0 * side - margin),
            (most.x, right + margin),
            (least.y, back - margin),
            (most.y, front + 0.5 * side + margin),
        ] {
            assert!((found - expected).abs() < 1e-3 * side, "{found} {expected}");
        }
    }

    #[test]
    fn grazing_light_and_lamps_beside_the_model_have_a_finite_ground() {
        let scene = Scene::new(cube());
        let farthest = FARTHEST * scene.radius() + scene.middle().length();
        let grazing = DVec3::new(1.0, 1e-5, 0.3).normalize().extend(0.0);
        let beside = (scene.middle() + DVec3::X * 3.0 * scene.radius()).extend(1.0);
        for light in [grazing, beside] {
            let GroundPlan { low, high, .. } = ground(light).expect("a ground");
            assert!(low.abs().max(high.abs()).max_element() <= farthest, "{low} {high}");
            assert!(low.x < -10.0 * scene.radius(), "{low}");
        }
    }

    #[test]
    fn light_from_below_or_along_the_ground_has_none() {
        let below = DVec3::new(0.0, -10.0, 0.0);
        for light in [DVec3::NEG_Y.extend(0.0), DVec3::X.extend(0.0), DVec4::ZERO, below.extend(1.0)] {
            assert_eq!(ground(light), None, "{light}");
        }
        assert!(ground(DVec3::Y.extend(0.0)).is_some());
    }
}
