//! Artists' lines whose directions are rotated once for each object.

use crate::camera::Camera;
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::image_lines::{ImageInk, Regions};
use crate::scene::Scene;
use crate::stability::ink::{ahead, beside, curve, drawn, last_above, limit, limit_at, worst};
use crate::stability::{Axis, Finding, Sweep};
use crate::style::Lines;
use crate::view::View;
use glam::{DVec2, DVec3};
use npr_imagespace::artist::{ArtistRotation, LineKind, artist_color, ink_artist_direction};
use npr_imagespace::filter::fused::FusedFilter;
use npr_imagespace::filter::normal::{NORMAL_COS_CARD_MITCHELL, NORMAL_COS_OUTLINING_SKETCH};
use npr_mesh::{Material, Model};
use npr_outline::normal_format::fibonacci_sphere;

pub(super) const ARTIST_DISTANCE: Sweep = Sweep {
    name: "artist-distance",
    technique: "image lines",
    what: "An artist's four directions point 45° away from the viewer, so that no visible normal is like them. Rotated once \
           for an object, they come near visible normals at its rim, the more the closer the object is, and its painted \
           lines vanish there.",
    needs_adapter: false,
    run: artist_distance,
};

/// The share of a ball's visible points, %, at which one of the four directions is within the threshold of a normal that
/// could be visible there.
fn share_lost(distance: f64, normal_cos: f32, per_object: bool) -> f64 {
    let centre = DVec3::NEG_Z * distance;
    let (mut seen, mut lost) = (0u32, 0u32);
    for normal in fibonacci_sphere(6000) {
        let point = centre + normal;
        if normal.dot(point) >= 0.0 {
            continue;
        }
        let rotation = if per_object { centre } else { point };
        let towards = point.normalize();
        // The most similar normal that faces the viewer lies in the plane of the direction and the line of sight.
        let is_lost = (0..4).any(|index| {
            let direction = ink_artist_direction(index, rotation.as_vec3()).as_dvec3();
            let along = direction.dot(towards);
            along < 0.0 || (1.0 - along * along).max(0.0).sqrt() > f64::from(normal_cos)
        });
        seen += 1;
        lost += u32::from(is_lost);
    }
    100.0 * f64::from(lost) / f64::from(seen)
}

fn artist_distance(executor: &Executor) -> Result<Finding, HarnessError> {
    let distances: Vec<f64> = (0..=76).map(|i| 1.3 + 0.1 * f64::from(i)).collect();
    let cases = [
        ("for each object, threshold 0.80", NORMAL_COS_OUTLINING_SKETCH, true),
        ("for each object, threshold 0.85", NORMAL_COS_CARD_MITCHELL, true),
        ("for each pixel, threshold 0.80", NORMAL_COS_OUTLINING_SKETCH, false),
    ];
    let curves = cases.map(|(name, normal_cos, per_object)| {
        let points: Vec<_> =
            distances.iter().map(|&distance| (distance, share_lost(distance, normal_cos, per_object))).collect();
        let limit = if per_object {
            let spare_rad = std::f64::consts::FRAC_PI_4 - f64::from(normal_cos).acos();
            let predicted = 1.0 / spare_rad.sin();
            limit_at(
                "distance below which lines may vanish, in radii of the object",
                last_above(&points, 0.0),
                Bound::AtMost(predicted),
            )
            .predicted(predicted, "1 / sin(45° − acos t): the rim is asin(radius / distance) off the middle")
        } else {
            limit("largest share of an object where lines may vanish, %", worst(&points), Bound::AtMost(0.0))
        };
        curve(name, points, limit)
    });
    let picture = |rotation| {
        let mut scene = Scene::new(funnel());
        scene.line_kinds = vec![LineKind::VertexColor, LineKind::Normals];
        // Within the funnel, near its tip.
        let camera = Camera { eye: DVec3::NEG_Z * 0.35, target: DVec3::NEG_Z, ..ahead(100f64.to_radians(), 0.01) };
        let filter = FusedFilter { depth: None, ..FusedFilter::default() };
        let ink = ImageInk { filter, artist: Some(rotation), regions: Regions::One, ..ImageInk::default() };
        drawn(executor, &scene, Lines::image(ink), View::new(camera, (158, 158)), 1.0)
    };
    Ok(Finding {
        parameter: Axis::linear("distance of the centre, in radii of the object", ""),
        error: Axis::linear("surface where lines may vanish", "%"),
        curves: curves.into(),
        pictures: vec![(
            "Within a funnel that widens away from the viewer, of painted and plain squares: directions rotated for the \
             object, whose lines vanish but beside the axes, and for each pixel."
                .into(),
            beside(&[picture(ArtistRotation::PerObject)?, picture(ArtistRotation::PerPixel)?]),
        )],
    })
}

/// A funnel around −z of painted and plain squares by turns, the first material painted. Each painted square has the
/// direction that is most like its normal.
fn funnel() -> Model {
    const AROUND: u32 = 96;
    const RINGS: u32 = 9;
    const SPREAD: f64 = 0.45;
    let at = |ring: u32, around: u32| {
        let along = 0.4 * 1.35f64.powi(ring as i32);
        let angle = std::f64::consts::TAU * f64::from(around) / f64::from(AROUND);
        (DVec2::from_angle(angle) * SPREAD * along).extend(-along)
    };
    let mut funnel = Model { materials: vec![Material::default(); 2], ..Model::default() };
    for ring in 0..RINGS {
        for around in 0..AROUND {
            let corners = [at(ring, around), at(ring + 1, around), at(ring + 1, around + 1), at(ring, around + 1)];
            let inward = |corner: DVec3| DVec3::new(-corner.x, -corner.y, SPREAD * SPREAD * corner.z).normalize();
            let middle = inward(corners.iter().sum::<DVec3>());
            let color = artist_color(u32::from(middle.x > 0.0) | u32::from(middle.y > 0.0) << 1);
            let linear = color.map(|c| crate::color::decode_srgb(f64::from(c)) as f32);
            let first = funnel.positions.len() as u32;
            funnel.positions.extend(corners.map(|corner| corner.as_vec3()));
            funnel.normals.extend(corners.map(|corner| inward(corner).as_vec3()));
            funnel.colors.extend([linear.extend(1.0); 4]);
            funnel.faces.extend([[first, first + 2, first + 1], [first, first + 3, first + 2]]);
            funnel.face_material.extend([(ring + around / 6) % 2; 2]);
        }
    }
    funnel
}
