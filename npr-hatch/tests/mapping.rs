//! The weights of hatchings sum to 1 and are continuous, and strokes have the requested direction.

use glam::{DVec2, DVec3, Vec3, Vec3Swizzles as _};
use npr_hatch::field::LineTensor;
use npr_hatch::mapping::{
    HATCH_DIRECTIONS, HatchBlend, hatch_direction_step, hatch_doubled_angle, hatch_octave, hatch_offset, hatch_plane,
    hatch_plane_weights, hatch_rotate, hatch_share_tone,
};
use oorandom::Rand64;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// The angle between two directions.
const TURN: f64 = PI / HATCH_DIRECTIONS as f64;

fn direction(random: &mut Rand64) -> DVec3 {
    loop {
        let v = DVec3::new(random.rand_float(), random.rand_float(), random.rand_float()) * 2.0 - 1.0;
        if (0.01..1.0).contains(&v.length_squared()) {
            return v.normalize();
        }
    }
}

/// A vector at an angle in the plane of an axis, without a component along the axis.
fn in_plane(axis: u32, angle: f64) -> DVec3 {
    let (sin, cos) = angle.sin_cos();
    let each = [DVec3::new(0.0, sin, cos), DVec3::new(cos, 0.0, sin), DVec3::new(cos, sin, 0.0)];
    each[axis as usize]
}

/// The tensor d dᵀ as arguments of [`hatch_doubled_angle`], in f64.
fn doubled(d: DVec3, axis: u32) -> DVec2 {
    hatch_doubled_angle(d * d, DVec3::new(d.x * d.y, d.x * d.z, d.y * d.z), axis)
}

/// The weight of each direction.
fn shares(step: HatchBlend) -> [f64; HATCH_DIRECTIONS as usize] {
    assert!((0..HATCH_DIRECTIONS as i32).contains(&step.first) && (0.0..=1.0).contains(&step.share), "{step:?}");
    let mut shares = [0.0; HATCH_DIRECTIONS as usize];
    shares[step.first as usize] += 1.0 - step.share;
    shares[(step.first as usize + 1) % shares.len()] += step.share;
    shares
}

#[test]
fn plane_weights_are_shares() {
    let mut random = Rand64::new(1);
    for _ in 0..10_000 {
        let normal = direction(&mut random);
        let weights = hatch_plane_weights(normal);
        assert!(weights.min_element() >= 0.0 && (weights.element_sum() - 1.0).abs() < 1e-12, "{normal}: {weights}");
        assert_eq!(hatch_plane_weights(-normal), weights);
        let around = hatch_plane_weights(DVec3::new(normal.y, -normal.z, normal.x));
        assert!((around - weights.yzx()).abs().max_element() < 1e-12, "no axis is special");
        assert_eq!(weights.max_position(), normal.abs().max_position(), "{normal}: {weights}");
    }
    let even = hatch_plane_weights(DVec3::ONE.normalize());
    assert!((even - 1.0 / 3.0).abs().max_element() < 1e-12);
    let pair = hatch_plane_weights(DVec3::new(FRAC_1_SQRT_2, 0.0, -FRAC_1_SQRT_2));
    assert!((pair - DVec3::new(0.5, 0.0, 0.5)).abs().max_element() < 1e-12);
    // By hand: the cubes of 0.8 - 0.4 and 0.6 - 0.4 have the ratio 8 to 1.
    let uneven = hatch_plane_weights(DVec3::new(0.8, 0.6, 0.0));
    assert!((uneven - DVec3::new(8.0, 1.0, 0.0) / 9.0).abs().max_element() < 1e-12);
}

#[test]
fn plane_weights_are_continuous() {
    let mut random = Rand64::new(2);
    // With m the largest excess over 0.4, at least 0.577 - 0.4, the derivative of a cube is at most 3 m², so that of
    // its fraction of a sum of at least m³ is at most 12 / m.
    let steepest = 12.0 / (1.0 / 3.0_f64.sqrt() - 0.4);
    let step = 1e-4;
    for _ in 0..100 {
        let (from, other) = (direction(&mut random), direction(&mut random));
        let right = from.cross(other).normalize();
        let up = from.cross(right);
        let at = |number: u32| {
            let (sin, cos) = (f64::from(number) * step).sin_cos();
            hatch_plane_weights(from * cos + up * sin)
        };
        for number in 0..2000 {
            let change = (at(number + 1) - at(number)).abs().max_element();
            assert!(change <= steepest * step, "{change} at {number} from {from}");
        }
    }
}

#[test]
fn one_plane_is_alone_around_its_axis() {
    // sin 23.57° is below 0.4, sin 23.59° above.
    let mut random = Rand64::new(3);
    for axis in 0..3 {
        let alone = DVec3::AXES[axis];
        for number in 0..1000 {
            let around = in_plane(axis as u32, random.rand_float() * 2.0 * PI);
            let (sin, cos) = (23.57_f64.to_radians() * f64::from(number) / 999.0).sin_cos();
            assert_eq!(hatch_plane_weights(alone * cos + around * sin), alone);
        }
        let (sin, cos) = 23.59_f64.to_radians().sin_cos();
        assert!(hatch_plane_weights(alone * cos + DVec3::AXES[(axis + 1) % 3] * sin)[axis] < 1.0);
    }
}

#[test]
fn without_a_normal_there_is_one_plane() {
    for none in [DVec3::ZERO, DVec3::NAN, DVec3::splat(0.3), DVec3::new(f64::NAN, 0.0, 0.1)] {
        assert_eq!(hatch_plane_weights(none), DVec3::Z, "{none}");
    }
    assert_eq!(hatch_plane_weights(DVec3::new(f64::NAN, 1.0, 0.0)), DVec3::Y);
}

#[test]
fn planes_are_seen_upright() {
    let at = DVec3::new(1.0, 2.0, 3.0);
    assert_eq!([0, 1, 2].map(|axis| hatch_plane(at, axis)), [(3.0, 2.0), (1.0, 3.0), (1.0, 2.0)].map(DVec2::from));
    for axis in 0..3 {
        for angle in [0.0, 0.4, 2.0, -1.0] {
            let d = in_plane(axis, angle);
            assert_eq!((hatch_plane(d, axis), d[axis as usize]), (DVec2::from_angle(angle), 0.0));
        }
    }
}

#[test]
fn a_tensor_has_the_doubled_angle_of_what_is_seen() {
    let mut random = Rand64::new(4);
    for _ in 0..1000 {
        let d = direction(&mut random);
        for axis in 0..3 {
            let DVec2 { x, y } = hatch_plane(d, axis);
            // (x + iy)².
            let expected = DVec2::new(x * x - y * y, 2.0 * x * y);
            assert!((doubled(d, axis) - expected).abs().max_element() < 1e-12);
            assert_eq!(doubled(d, axis), doubled(-d, axis));
            // The tensor of a field has the same order of elements, in f32.
            let LineTensor { diagonal, others } = LineTensor::from_direction(d.as_vec3());
            let handed = hatch_doubled_angle(Vec3::from(diagonal).as_dvec3(), Vec3::from(others).as_dvec3(), axis);
            assert!((handed - expected).abs().max_element() < 1e-6);
        }
    }
}

#[test]
fn turned_strokes_run_along_the_direction() {
    // A hatching is faded over the middle quarter of a step: it is visible up to 5/8 of a step from its direction,
    // and has a weight of 1/2 or more up to 1/2 of a step.
    let (mut most_off, mut most_off_of_half) = (0.0_f64, 0.0_f64);
    for axis in 0..3 {
        for number in 0..7200 {
            let angle = f64::from(number) / 7200.0 * 2.0 * PI;
            let d = in_plane(axis, angle);
            let step = hatch_direction_step(doubled(d, axis));
            assert_eq!(step, hatch_direction_step(doubled(-d, axis)));
            for (turn, share) in shares(step).into_iter().enumerate() {
                let map = hatch_rotate(hatch_plane(d, axis), turn as i32);
                let off = map.y.abs().atan2(map.x.abs());
                most_off = if share > 0.0 { most_off.max(off) } else { most_off };
                most_off_of_half = if share >= 0.5 { most_off_of_half.max(off) } else { most_off_of_half };
            }
        }
    }
    assert!(most_off <= 0.625 * TURN + 1e-9, "{} of a turn", most_off / TURN);
    assert!(most_off_of_half <= 0.5 * TURN + 1e-9, "{} of a turn", most_off_of_half / TURN);
    // Both bounds are tight up to one step of the angle.
    assert!(most_off > 0.615 * TURN && most_off_of_half > 0.49 * TURN, "{most_off} {most_off_of_half}");
}

#[test]
fn exact_directions_have_one_turn() {
    for axis in 0..3 {
        for turn in 0..HATCH_DIRECTIONS {
            let found = shares(hatch_direction_step(doubled(in_plane(axis, f64::from(turn) * TURN), axis)));
            assert_eq!(found[turn as usize], 1.0, "{axis}, {turn}: {found:?}");
        }
    }
    for none in [DVec2::ZERO, -DVec2::ZERO] {
        assert_eq!(hatch_direction_step(none), HatchBlend { first: 0, share: 0.0 });
    }
    // Both signs of zero at a half turn.
    assert_eq!(shares(hatch_direction_step(DVec2::new(-1.0, 0.0)))[6], 1.0);
    assert_eq!(shares(hatch_direction_step(DVec2::new(-1.0, -0.0)))[6], 1.0);
}

#[test]
fn shares_of_turns_are_continuous_and_one_together() {
    let step = 1e-4;
    // The weight goes from 0 to 1 over a quarter of a step.
    let steepest = 4.0 / TURN;
    let count = (2.0 * PI / step) as u32 + 1;
    let at = |number: u32| shares(hatch_direction_step(doubled(in_plane(2, f64::from(number) * step), 2) * 0.3));
    for number in 0..count {
        let (here, next) = (at(number), at(number + 1));
        assert!((here.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        for (turn, (here, next)) in here.into_iter().zip(next).enumerate() {
            assert!((next - here).abs() <= steepest * step + 1e-9, "turn {turn} at {number}: {here}, {next}");
        }
    }
}

#[test]
fn an_octave_changes_in_the_middle_quarter() {
    let expected = [
        (-1.0, -1, 0.0),
        (-0.7, -1, 0.0),
        (-0.5, -1, 0.5),
        (-0.3, -1, 1.0),
        (0.0, 0, 0.0),
        (0.375, 0, 0.0),
        (0.4375, 0, 0.25),
        (0.5, 0, 0.5),
        (0.5625, 0, 0.75),
        (0.625, 0, 1.0),
        (7.99, 7, 1.0),
        (8.0, 8, 0.0),
    ];
    for (octave, first, share) in expected {
        assert_eq!(hatch_octave(octave), HatchBlend { first, share }, "{octave}");
    }
    // The weight of the second hatching is a piecewise linear function from 0 to 1.
    let place = |number: i32| {
        let HatchBlend { first, share } = hatch_octave(f64::from(number) * 1e-3);
        f64::from(first) + share
    };
    for number in -5000..5000 {
        let change = place(number + 1) - place(number);
        assert!((0.0..=4e-3 + 1e-9).contains(&change), "{change} at {number}");
    }
}

#[test]
fn turning_is_a_rotation_back() {
    let mut random = Rand64::new(5);
    for _ in 0..100 {
        let place = direction(&mut random).truncate() * 5.0;
        for turn in -3..30 {
            let turned = hatch_rotate(place, turn);
            let expected = DVec2::from_angle(-f64::from(turn) * TURN).rotate(place);
            assert!((turned - expected).abs().max_element() < 1e-12, "{place}, {turn}: {turned}");
        }
        assert!((hatch_rotate(place, 0) - place).abs().max_element() < 1e-14);
        assert!((hatch_rotate(place, 6) - DVec2::new(place.y, -place.x)).abs().max_element() < 1e-14);
        assert!((hatch_rotate(place, 12) + place).abs().max_element() < 1e-14);
    }
}

#[test]
fn hatchings_are_moved_apart() {
    // The number of all hatchings: twelve directions of three planes. A square grid of as many points has a distance
    // of 1/6.
    let places: Vec<DVec2> = (0..36).map(hatch_offset).collect();
    let mut nearest = f64::INFINITY;
    for (i, a) in places.iter().enumerate() {
        assert!(a.min_element() >= 0.0 && a.max_element() < 1.0);
        for b in &places[..i] {
            let apart = (a - b).abs();
            nearest = nearest.min(apart.min(1.0 - apart).length());
        }
    }
    assert!(nearest > 0.5 / 6.0, "{nearest}");
    assert_eq!(hatch_offset(0), DVec2::ZERO);
    // Also for negative octaves, which occur in magnified maps.
    for number in 1..36 {
        assert!((hatch_offset(-number) + hatch_offset(number) - 1.0).abs().max_element() < 1e-12);
    }
}

#[test]
fn the_product_of_shares_is_the_tone() {
    let mut random = Rand64::new(6);
    for number in 0..1000 {
        let tone = if number % 10 == 0 { 10.0_f64.powf(-6.0 * random.rand_float()) } else { random.rand_float() };
        let tone = tone.max(1e-6);
        let weights = hatch_plane_weights(direction(&mut random));
        let turn = random.rand_float();
        let product = [turn, 1.0 - turn]
            .map(|part| (0..3).map(|axis| hatch_share_tone(tone, weights[axis] * part)).product::<f64>())
            .into_iter()
            .product::<f64>();
        assert!((product - tone).abs() < 1e-9, "{weights} {turn}: {product}, not {tone}");
    }
    for tone in [0.0, 1e-9, 0.3, 1.0] {
        assert_eq!(
            (hatch_share_tone(tone, 0.0), hatch_share_tone(tone, 1.0)),
            (1.0, tone),
            "all paper, and as asked for"
        );
    }
    assert_eq!(hatch_share_tone(1.0, 0.3), 1.0);
    // Black remains black when it is distributed over several hatchings.
    assert!(hatch_share_tone(0.0, 0.5).powi(2) <= 1e-6);
    assert!(hatch_share_tone(0.2, 0.3) > hatch_share_tone(0.2, 0.4));
}
