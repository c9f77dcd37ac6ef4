use super::hierarchy::{Hierarchy, hierarchy_by};
use super::*;
use npr_mesh::edges::has_zero_area;
use obvhs::bvh2::Bvh2;

pub(super) const EVERYWHERE: (f64, f64) = (0.0, f64::INFINITY);

/// SplitMix64 (Steele, Lea & Flood 2014).
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In −1..1.
    pub(super) fn signed(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(super) fn vector(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }

    pub(super) fn unit(&mut self) -> DVec3 {
        loop {
            let v = self.vector();
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }
}

/// A unit sphere of 20 · 4^`levels` faces, its corners shared and counter-clockwise seen from outside.
pub(super) fn icosphere(levels: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let g = (1.0 + 5f64.sqrt()) / 2.0;
    let corner = |x: f64, y: f64, z: f64| DVec3::new(x, y, z).normalize().as_vec3();
    let mut positions = Vec::new();
    for (a, b) in [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)] {
        positions.extend([corner(a, b, 0.0), corner(0.0, a, b), corner(b, 0.0, a)]);
    }
    let near = |a: usize, b: usize| positions[a].distance(positions[b]) < 1.1;
    let mut faces = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(c, a) {
                    let outwards = positions[a].dot(positions[b].cross(positions[c])) > 0.0;
                    faces.push(if outwards { [a, b, c] } else { [a, c, b] }.map(|v| v as u32));
                }
            }
        }
    }
    assert_eq!(faces.len(), 20);
    for _ in 0..levels {
        let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
        let mut finer = Vec::new();
        for [a, b, c] in faces {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(from, to)| {
                *middles.entry((from.min(to), from.max(to))).or_insert_with(|| {
                    let sum = positions[from as usize].as_dvec3() + positions[to as usize].as_dvec3();
                    positions.push(sum.normalize().as_vec3());
                    positions.len() as u32 - 1
                })
            });
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        faces = finer;
    }
    (positions, faces)
}

/// The cube −1..1, two faces a side, counter-clockwise seen from outside.
fn cube() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let positions =
        (0..8).map(|i| Vec3::new([-1.0, 1.0][i & 1], [-1.0, 1.0][i >> 1 & 1], [-1.0, 1.0][i >> 2])).collect();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    (positions, quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

pub(super) fn edges(faces: &[[u32; 3]]) -> impl Iterator<Item = (u32, u32)> {
    faces.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
}

pub(super) fn any_hit(_: &Hit) -> bool {
    true
}

/// The expected result of [`RayCaster::closest`]: the same test on every face.
pub(super) fn closest_of_all(
    positions: &[Vec3],
    faces: &[[u32; 3]],
    origin: DVec3,
    direction: DVec3,
    range: (f64, f64),
) -> Vec<Hit> {
    let frame = Frame::new(origin, direction);
    let mut hits: Vec<Hit> = (0u32..)
        .zip(faces)
        .filter(|(_, face)| !has_zero_area(positions, face))
        .filter_map(|(number, face)| {
            frame.intersect(&Triangle { corners: face.map(|v| positions[v as usize]), face: number })
        })
        .filter(|hit| range.0 <= hit.t && hit.t <= range.1)
        .collect();
    hits.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.face.cmp(&b.face)));
    hits
}

/// Möller & Trumbore 1997: an independent formula for the same intersection.
fn moller_trumbore([a, b, c]: [DVec3; 3], origin: DVec3, direction: DVec3) -> (f64, [f64; 3]) {
    let (e1, e2) = (b - a, c - a);
    let p = direction.cross(e2);
    let det = e1.dot(p);
    let from_a = origin - a;
    let u = from_a.dot(p) / det;
    let q = from_a.cross(e1);
    let v = direction.dot(q) / det;
    (e2.dot(q) / det, [1.0 - u - v, u, v])
}

#[test]
fn a_fine_sphere_is_hit_within_its_sag() {
    let (positions, faces) = icosphere(5);
    // The facets' planes lie within this of the sphere: the square of half the longest edge over twice the radius,
    // and a third more for the triangle's circumradius.
    let longest = edges(&faces)
        .map(|(a, b)| f64::from(positions[a as usize].distance(positions[b as usize])))
        .fold(0.0, f64::max);
    let sag = (longest / 2.0).powi(2) / 2.0 * (4.0 / 3.0) + 1e-6;
    let caster = RayCaster::new(&positions, &faces);
    let mut random = Random(1);
    for _ in 0..20_000 {
        let direction = random.unit();
        let inside = random.unit() * 0.5;
        let hit = caster.closest(inside, direction, EVERYWHERE, any_hit).expect("closed");
        let radius = (inside + direction * hit.t).length();
        assert!(!hit.front && radius <= 1.0 + 1e-6 && radius >= 1.0 - sag, "{radius}");
        // From outside, straight at the centre: t is the distance to the surface, in units of the direction.
        let hit = caster.closest(direction * 3.0, direction * -2.0, EVERYWHERE, any_hit).expect("closed");
        assert!(hit.front && hit.t >= 1.0 - 1e-6 && hit.t <= 1.0 + sag, "{}", hit.t);
        assert!((hit.barycentric.iter().sum::<f64>() - 1.0).abs() < 1e-15);
    }
}

#[test]
fn a_planes_inverse_depth_is_linear_across_the_screen() {
    let positions = [(-64.0, 0.0), (64.0, 0.0), (64.0, -128.0), (-64.0, -128.0)].map(|(x, z)| Vec3::new(x, -1.0, z));
    let caster = RayCaster::new(&positions, &[[0, 1, 2], [0, 2, 3]]);
    let mut hits = 0;
    for row in 0..90 {
        for column in 0..160 {
            let x = (f64::from(column) + 0.5) / 80.0 - 1.0;
            let y = (f64::from(row) + 0.5) / -90.0;
            let Some(hit) = caster.closest(DVec3::ZERO, DVec3::new(x, y, -1.0), EVERYWHERE, any_hit) else {
                continue;
            };
            hits += 1;
            assert!(hit.front);
            assert!((1.0 / hit.t + y).abs() < 1e-12, "{hit:?}");
        }
    }
    assert!(hits > 14_000);
}

#[test]
fn a_cube_has_no_gaps_at_edges_corners_and_diagonals() {
    let (positions, faces) = cube();
    let caster = RayCaster::new(&positions, &faces);
    let mut random = Random(2);
    let spots: Vec<DVec3> = positions
        .iter()
        .map(|p| p.as_dvec3())
        .chain(edges(&faces).flat_map(|(a, b)| {
            let (a, b) = (positions[a as usize].as_dvec3(), positions[b as usize].as_dvec3());
            [0.5, 0.25, 0.1, 1e-9].map(|s| a.lerp(b, s))
        }))
        .collect();
    for round in 0..4_000 {
        let direction = random.unit();
        let inside = if round % 4 == 0 { DVec3::ZERO } else { random.vector() * 0.99 };
        for &spot in &spots {
            let hit = caster.closest(inside, spot - inside, EVERYWHERE, any_hit).expect("closed");
            assert!(!hit.front && (hit.t - 1.0).abs() < 1e-12, "{hit:?}");
            assert!(caster.any(inside, spot - inside, EVERYWHERE, any_hit));
            // From outside, if the ray continues into the cube.
            if (spot + direction * 0.01).abs().max_element() < 1.0 {
                let hit = caster.closest(spot - direction * 4.0, direction, EVERYWHERE, any_hit).expect("closed");
                assert!(hit.front && (hit.t - 4.0).abs() < 1e-6, "{hit:?}");
            }
        }
    }
    // Along the axes and diagonals every product in the test is exact.
    for &p in &positions {
        assert_eq!(caster.closest(DVec3::ZERO, p.as_dvec3(), EVERYWHERE, any_hit).map(|hit| hit.t), Some(1.0));
        let hits = caster.all(p.as_dvec3() * 3.0, -p.as_dvec3(), EVERYWHERE, any_hit);
        assert_eq!((hits[0].t, hits[hits.len() - 1].t), (2.0, 4.0));
    }
    for axis in [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z] {
        let hits = caster.all(axis * 2.0, -axis, EVERYWHERE, any_hit);
        // Both faces of the near side and both of the far side share the diagonal.
        assert_eq!(
            hits.iter().map(|hit| (hit.t, hit.front)).collect::<Vec<_>>(),
            [(1.0, true), (1.0, true), (3.0, false), (3.0, false)]
        );
    }
}

#[test]
fn a_closed_sphere_does_not_leak() {
    let (positions, faces) = icosphere(3);
    let caster = RayCaster::new(&positions, &faces);
    let mut random = Random(3);
    for round in 0..60 {
        // Some origins share coordinates with the corners, which makes rays run exactly along edges' planes.
        let inside = match round % 3 {
            0 => random.unit() * 0.9,
            1 => positions[random.bits() as usize % positions.len()].as_dvec3() * 0.5,
            _ => DVec3::new(0.0, random.signed() * 0.5, 0.0),
        };
        let outside = random.unit() * (1.5 + random.signed() * 0.25);
        let middles =
            edges(&faces).map(|(a, b)| (positions[a as usize].as_dvec3() + positions[b as usize].as_dvec3()) / 2.0);
        for spot in positions.iter().map(|p| p.as_dvec3()).chain(middles) {
            let hit = caster.closest(inside, spot - inside, EVERYWHERE, any_hit).expect("no leak");
            assert!((hit.t - 1.0).abs() < 1e-9 && !hit.front, "{hit:?}");
            // Not near the silhouette: facets deviate from the tangent at a corner by up to 6°.
            if spot.dot(outside - spot) > 0.2 * (outside - spot).length() {
                let hits = caster.all(outside, spot - outside, EVERYWHERE, any_hit);
                assert!((hits[0].t - 1.0).abs() < 1e-9 && hits[0].front, "{hits:?}");
                assert!(hits.iter().any(|hit| !hit.front), "it must leave again: {hits:?}");
            }
        }
    }
}

#[test]
fn the_hierarchy_loses_nothing() {
    let mut random = Random(4);
    let (mut rays, mut hits, mut compared) = (0, 0, 0);
    for soup in 0..60 {
        let size = [1.0, 0.3, 0.05][soup % 3];
        let mut positions = Vec::new();
        let mut faces = Vec::new();
        for _ in 0..150 {
            let at = random.vector();
            let first = positions.len() as u32;
            positions.extend((0..3).map(|_| (at + random.vector() * size).as_vec3()));
            faces.push([first, first + 1, first + 2]);
            // Every fifth face lies in an axis-aligned plane, so that its box has no thickness.
            if random.bits().is_multiple_of(5) {
                let axis = random.bits() as usize % 3;
                for position in &mut positions[first as usize..] {
                    position[axis] = at[axis] as f32;
                }
            }
        }
        let caster = RayCaster::new(&positions, &faces);
        for ray in 0..2_000 {
            let origin = random.vector() * [0.5, 2.0, 100.0][ray % 3];
            let direction = match ray % 5 {
                0 => [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Z][random.bits() as usize % 5] * 3.0,
                1 => positions[random.bits() as usize % positions.len()].as_dvec3() - origin,
                2 => DVec3::new(random.signed(), random.signed() * 1e-7, random.signed() * 1e-8),
                _ => random.vector() - origin,
            };
            let range = if ray % 7 == 0 { (random.signed(), random.signed() + 1.0) } else { EVERYWHERE };
            let expected = closest_of_all(&positions, &faces, origin, direction, range);
            assert_eq!(caster.all(origin, direction, range, any_hit), expected);
            assert_eq!(caster.closest(origin, direction, range, any_hit).as_ref(), expected.first());
            assert_eq!(caster.any(origin, direction, range, any_hit), !expected.is_empty());
            let even = |hit: &Hit| hit.face.is_multiple_of(2);
            assert_eq!(
                caster.closest(origin, direction, range, even),
                expected.iter().copied().find(|hit| hit.face.is_multiple_of(2))
            );
            rays += 1;
            hits += expected.len();
            // Checks the intersection test against the other formula, away from the borders.
            for (number, face) in (0u32..).zip(&faces).filter(|_| ray % 4 == 3) {
                let corners = face.map(|v| positions[v as usize].as_dvec3());
                let (t, weights) = moller_trumbore(corners, origin, direction);
                let inside = weights.into_iter().fold(f64::INFINITY, f64::min);
                if !(inside.abs() > 1e-6 && (t - range.0).abs() > 1e-6 && (t - range.1).abs() > 1e-6) {
                    continue;
                }
                let ours = expected.iter().find(|hit| hit.face == number);
                assert_eq!(ours.is_some(), inside > 0.0 && range.0 < t && t < range.1);
                if let Some(hit) = ours {
                    compared += 1;
                    assert!((hit.t - t).abs() < 1e-7 * (1.0 + t.abs()), "{hit:?} {t}");
                    assert!(hit.barycentric.iter().zip(weights).all(|(x, y)| (x - y).abs() < 1e-6));
                    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
                    assert_eq!(hit.front, normal.dot(direction) < 0.0);
                }
            }
        }
    }
    assert!(rays >= 100_000 && hits > 100_000 && compared > 10_000, "{rays} {hits} {compared}");
}

#[test]
fn size_and_distance_do_not_matter() {
    let (unit_positions, faces) = icosphere(2);
    let mut random = Random(5);
    for size in [1e-30, 1e-12, 1.0, 1e12, 1e30] {
        let positions: Vec<Vec3> = unit_positions.iter().map(|p| (p.as_dvec3() * size).as_vec3()).collect();
        let caster = RayCaster::new(&positions, &faces);
        for distance in [2.0, 1e3, 1e7] {
            for round in 0..400 {
                let origin = random.unit() * distance * size;
                let aim = positions[random.bits() as usize % positions.len()].as_dvec3() * 0.7;
                let direction = (aim - origin) * [1.0, 1e-20, 1e20][round % 3];
                let expected = closest_of_all(&positions, &faces, origin, direction, EVERYWHERE);
                assert!(expected.len() >= 2);
                assert_eq!(caster.all(origin, direction, EVERYWHERE, any_hit), expected);
                assert_eq!(caster.closest(origin, direction, EVERYWHERE, any_hit), Some(expected[0]));
                let radius = (origin + direction * expected[0].t).length() / size;
                assert!((0.9..1.0 + 1e-6).contains(&radius), "{size} {distance} {radius}");
                assert!(caster.closest(origin, -direction, EVERYWHERE, any_hit).is_none());
                assert!(caster.closest(origin, -direction, (f64::NEG_INFINITY, 0.0), any_hit).is_some());
                // A ray that narrowly misses the sphere.
                let aside = origin.normalize().any_orthonormal_vector() * 1.01 * size;
                assert!(!caster.any(origin + aside, -origin, EVERYWHERE, any_hit));
            }
        }
    }
}

#[test]
fn the_range_includes_its_ends() {
    let (positions, faces) = cube();
    let caster = RayCaster::new(&positions, &faces);
    let origin = DVec3::new(0.25, 0.125, 3.0);
    let count = |range| caster.all(origin, -DVec3::Z, range, any_hit).len();
    assert_eq!(count((2.0, 4.0)), 2);
    assert_eq!(count((2.0, 2.0)), 1);
    assert_eq!(count((2.0 + 1e-15, 4.0 - 1e-15)), 0);
    assert_eq!(count((4.0, 2.0)), 0);
    assert_eq!(count((-1.0, 1.0)), 0);
    assert_eq!(count((f64::NAN, 9.0)), 0);
    assert_eq!(count((0.0, f64::NAN)), 0);
    assert!(!caster.any(origin, -DVec3::Z, (0.0, 1.999), any_hit));
    assert!(caster.any(origin, -DVec3::Z, (0.0, 2.0), any_hit));
}

#[test]
fn nothing_is_hit_where_there_is_nothing() {
    let nothing = RayCaster::new(&[], &[]);
    assert!(nothing.closest(DVec3::ZERO, DVec3::X, EVERYWHERE, any_hit).is_none());
    let (mut positions, _) = cube();
    positions.extend([Vec3::splat(f32::NAN), Vec3::new(0.0, f32::INFINITY, 0.0), Vec3::ZERO, Vec3::X * 2.0, Vec3::X]);
    // Faces with two equal corners, three equal corners, collinear corners, and corners that are not finite; then a
    // valid face.
    let mut faces = vec![[0, 0, 1], [3, 3, 3], [10, 11, 12], [0, 1, 8], [9, 1, 2]];
    assert!(!RayCaster::new(&positions, &faces).any(DVec3::ZERO, DVec3::X, EVERYWHERE, any_hit));
    faces.push([0, 1, 3]);
    let caster = RayCaster::new(&positions, &faces);
    let hit = caster.closest(DVec3::new(0.25, -0.25, 5.0), -DVec3::Z, EVERYWHERE, any_hit);
    assert_eq!(hit.map(|hit| (hit.face, hit.t)), Some((5, 6.0)));
    // A ray in the face's plane hits nothing, and neither does one without a direction.
    assert!(!caster.any(DVec3::new(-5.0, 0.0, -1.0), DVec3::X, EVERYWHERE, any_hit));
    for (origin, direction) in [
        (DVec3::ZERO, DVec3::ZERO),
        (DVec3::ZERO, DVec3::new(0.0, f64::NAN, 1.0)),
        (DVec3::ZERO, DVec3::new(0.0, 0.0, f64::INFINITY)),
        (DVec3::splat(f64::NAN), DVec3::X),
    ] {
        assert!(!caster.any(origin, direction, (f64::NEG_INFINITY, f64::INFINITY), any_hit));
    }
}

#[test]
fn of_faces_on_each_other_the_first_is_hit() {
    let (positions, faces) = cube();
    // Enough copies to fill many leaves; the second half has the opposite winding.
    let copies = 500u32;
    let many: Vec<[u32; 3]> = (0..copies)
        .flat_map(|copy| {
            faces.iter().map(move |&[a, b, c]| {
                let mut face = if copy >= copies / 2 { [a, c, b] } else { [b, c, a] };
                face.rotate_left(copy as usize % 3);
                face
            })
        })
        .collect();
    let one = RayCaster::new(&positions, &faces);
    let caster = RayCaster::new(&positions, &many);
    let mut random = Random(6);
    for _ in 0..500 {
        let (origin, direction) = (random.unit() * 4.0, random.unit());
        let first = one.closest(origin, direction, EVERYWHERE, any_hit);
        let of_many = caster.all(origin, direction, EVERYWHERE, any_hit);
        assert_eq!(of_many.len(), one.all(origin, direction, EVERYWHERE, any_hit).len() * copies as usize);
        assert_eq!(caster.closest(origin, direction, EVERYWHERE, any_hit), of_many.first().copied());
        assert_eq!(of_many.first().map(|hit| hit.face % 12), first.map(|hit| hit.face));
        for hit in of_many {
            let corners = many[hit.face as usize].map(|corner| positions[corner as usize].as_dvec3());
            let at: DVec3 = corners.into_iter().zip(hit.barycentric).map(|(corner, weight)| corner * weight).sum();
            assert!(at.distance(origin + direction * hit.t) < 1e-12, "{hit:?}");
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            assert_eq!(hit.front, normal.dot(direction) < 0.0);
        }
    }
    // The weights are exactly representable, so all copies are at the same t.
    let hit = caster.closest(DVec3::new(0.25, -0.25, 4.0), -DVec3::Z, EVERYWHERE, any_hit);
    let hit_once = one.closest(DVec3::new(0.25, -0.25, 4.0), -DVec3::Z, EVERYWHERE, any_hit);
    assert_eq!(hit.map(|hit| (hit.t, hit.face)), hit_once.map(|hit| (hit.t, hit.face)));
    // The same if the first copies are rejected.
    let late = |hit: &Hit| hit.face >= 12 * 400;
    let hit = caster.closest(DVec3::new(0.25, -0.25, 4.0), -DVec3::Z, EVERYWHERE, late);
    assert_eq!(hit.map(|hit| hit.face), hit_once.map(|hit| hit.face + 12 * 400));
}

#[test]
fn threads_can_share_a_caster() {
    fn shared<T: Send + Sync>() {}
    shared::<RayCaster>();
}

#[test]
fn faces_on_or_within_one_another_take_no_quadratic_time() {
    let mut random = Random(9);
    for kind in 0..4 {
        let corners: Vec<[Vec3; 3]> = (0..40_000)
            .map(|number| {
                let size = match kind {
                    0 => 1.0,
                    1 => 0.2 + 2e-5 * number as f32,
                    2 => (number as f32 * -0.003).exp2(),
                    _ => random.signed() as f32 * 1e-3,
                };
                let place = if kind == 3 { random.vector().as_vec3() } else { Vec3::ZERO };
                [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.1), Vec3::new(0.0, 1.0, -0.1)]
                    .map(|corner| place + size * corner)
            })
            .collect();
        let faces: Vec<[u32; 3]> = (0..corners.len() as u32).map(|n| [3 * n, 3 * n + 1, 3 * n + 2]).collect();
        let start = std::time::Instant::now();
        let caster = RayCaster::new(corners.as_flattened(), &faces);
        assert!(start.elapsed().as_secs() < 10, "kind {kind}: {:?}", start.elapsed());
        let seen = faces.iter().filter(|face| !has_zero_area(corners.as_flattened(), face)).count();
        assert_eq!(caster.tree.count().0, seen - caster.alike.iter().map(|same| same.len() - 1).sum::<usize>());
        let bvh = &caster.tree.bvh;
        assert!(bvh.max_depth <= 3 * faces.len().ilog2() as usize + 3, "kind {kind}: {} deep", bvh.max_depth);
        let mut indices = bvh.primitive_indices.clone();
        indices.sort_unstable();
        assert!(indices.windows(2).all(|pair| pair[0] < pair[1]) && indices.len() == caster.tree.triangles.len());
        assert_eq!(checked_depth(bvh), bvh.max_depth);

        let hits = caster.all(DVec3::new(0.0, 0.0, 2.0), DVec3::NEG_Z, EVERYWHERE, any_hit).len();
        assert!(kind == 3 || hits == faces.len(), "kind {kind}: {hits}");
    }
}

/// The depth of a hierarchy. Checks that boxes contain their children and that each primitive is in exactly one leaf.
fn checked_depth(bvh: &Bvh2) -> usize {
    let (mut deepest, mut open) = (0, vec![(0, 0)]);
    let mut met = vec![false; bvh.primitive_indices.len()];
    while let Some((number, depth)) = open.pop() {
        let node = bvh.nodes[number];
        deepest = deepest.max(depth);
        if node.is_leaf() && node.prim_count != CELL {
            assert!(node.prim_count <= 8);
            for met in &mut met[node.first_index as usize..][..node.prim_count as usize] {
                assert!(!std::mem::replace(met, true));
            }
        } else if !node.is_leaf() {
            for child in [node.first_index as usize, node.first_index as usize + 1] {
                assert_eq!(node.aabb().union(bvh.nodes[child].aabb()), *node.aabb());
                open.push((child, depth + 1));
            }
        }
    }
    assert!(met.into_iter().all(|met| met));
    deepest
}

#[test]
fn any_number_of_threads_builds_the_same() {
    let (mut positions, mut faces) = icosphere(6);
    // Some faces are degenerate, some are duplicates, and two clusters next to the sphere become cells.
    faces[100] = [0, 0, 1];
    faces[70_000] = faces[50];
    let mut random = Random(22);
    for number in 0..6_000 {
        let first = positions.len() as u32;
        let place = DVec3::X * if number % 2 == 0 { 3.0 } else { -3.0 };
        positions.extend((0..3).map(|_| (place + random.vector()).as_vec3()));
        faces.push([first, first + 1, first + 2]);
    }
    let count = faces.len();
    let found = |threads| {
        let mut found = Boxes::by(&positions, &faces, threads);
        let alike = duplicates::join(&positions, &faces, &mut found);
        assert_eq!((found.boxes.len(), alike.len()), (count - 2, 1));
        found
    };
    let built = |threads| {
        let Boxes { boxes, faces, .. } = found(threads);
        hierarchy_by(boxes, faces, true, threads)
    };
    let Hierarchy { bvh: one, crowds } = built(1);
    assert_eq!(checked_depth(&one), one.max_depth);
    assert!(crowds.len() >= 2, "{}", crowds.len());
    assert_eq!(one.primitive_indices.len() + crowds.iter().map(|crowd| crowd.0.len()).sum::<usize>(), count - 2);
    for threads in [2, 3, 8] {
        let Hierarchy { bvh: several, crowds: of_several } = built(threads);
        assert!(crowds == of_several);
        assert!(bytemuck::cast_slice::<_, u8>(&one.nodes) == bytemuck::cast_slice::<_, u8>(&several.nodes));
        assert_eq!(one.primitive_indices, several.primitive_indices);
        assert_eq!(one.max_depth, several.max_depth);
    }
}
