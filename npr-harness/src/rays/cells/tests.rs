use super::super::clusters::OVERLAP;
use super::super::tests::{EVERYWHERE, Random, any_hit, closest_of_all, edges, icosphere};
use super::super::{Hit, RayCaster};
use super::*;
use glam::Vec3;

/// Faces that share no corners.
fn apart(triangles: Vec<[Vec3; 3]>) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let faces = (0..triangles.len() as u32).map(|n| [3 * n, 3 * n + 1, 3 * n + 2]).collect();
    (triangles.into_flattened(), faces)
}

/// The kinds: faces as large as the scene; long thin faces; nested faces; faces around one edge; a stack of slanted
/// sheets.
fn crowded(kind: usize, count: usize, random: &mut Random) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut triangles: Vec<[Vec3; 3]> = (0..count)
        .map(|number| {
            let share = number as f32 / count as f32;
            let corners = [0; 3].map(|_| random.vector().as_vec3());
            match kind {
                0 => corners,
                1 => [corners[0], corners[0] + 0.01 * corners[1], corners[2]],
                2 => [Vec3::new(-1.0, -1.0, 0.3), Vec3::new(1.0, -0.8, 0.1), Vec3::new(0.1, 1.0, -0.3)]
                    .map(|corner| corner * (0.2 + 0.8 * share)),
                3 => [Vec3::new(-1.0, -1.0, -1.0), Vec3::new(1.0, 1.0, 1.0), corners[0]],
                _ => [Vec3::new(-1.0, -1.0, -1.0), Vec3::new(1.0, -1.0, 1.0), Vec3::new(0.0, 1.0, 0.0)]
                    .map(|corner| corner + Vec3::new(-0.1, 0.0, 0.1) * share),
            }
        })
        .collect();
    // Adds duplicates and faces without area.
    for number in 0..count / 10 {
        let [a, b, c] = triangles[number];
        triangles.push([[a, b, c], [a, c, b], [a, a, c]][number % 3]);
    }
    apart(triangles)
}

#[test]
fn what_is_split_is_hit_as_before() {
    let mut random = Random(11);
    let mut found = 0;
    for kind in 0..5 {
        let (positions, faces) = crowded(kind, 1_000, &mut random);
        let caster = RayCaster::new(&positions, &faces);
        assert!(!caster.tree.cells.is_empty(), "kind {kind} is for cells");
        for ray in 0..500 {
            let origin = random.vector() * [0.5, 2.0, 50.0][ray % 3];
            let corner = positions[random.bits() as usize % positions.len()].as_dvec3();
            let direction = match ray % 4 {
                0 => corner - origin,
                1 => DVec3::AXES[random.bits() as usize % 3] * random.signed(),
                _ => random.vector() - origin,
            };
            let range = if ray % 7 == 0 { (random.signed(), random.signed() + 1.0) } else { EVERYWHERE };
            let expected = closest_of_all(&positions, &faces, origin, direction, range);
            assert_eq!(caster.closest(origin, direction, range, any_hit).as_ref(), expected.first(), "kind {kind}");
            let third = |hit: &Hit| hit.face.is_multiple_of(3);
            assert_eq!(
                caster.closest(origin, direction, range, third),
                expected.iter().copied().find(|hit| third(hit))
            );
            assert_eq!(caster.any(origin, direction, range, third), expected.iter().any(third));
            assert_eq!(caster.all(origin, direction, range, any_hit), expected, "kind {kind}");
            found += expected.len();
        }
        assert!(caster.tree.count().0 > 2 * faces.len(), "kind {kind} is split: {:?}", caster.tree.count());
    }
    assert!(found > 25_000, "{found}");
}

#[test]
fn a_closed_sphere_among_cells_does_not_leak() {
    let mut random = Random(12);
    for levels in [0, 1, 2] {
        let (mut positions, mut faces) = icosphere(levels);
        let own = faces.len() as u32;
        let aims: Vec<DVec3> = edges(&faces)
            .flat_map(|(a, b)| {
                let (a, b) = (positions[a as usize].as_dvec3(), positions[b as usize].as_dvec3());
                [0.0, 0.5, 0.3].map(|share| a.lerp(b, share))
            })
            .collect();
        let (more, crowd) = crowded(0, 600, &mut random);
        faces.extend(crowd.iter().map(|face| face.map(|corner| corner + positions.len() as u32)));
        positions.extend(more);
        let caster = RayCaster::new(&positions, &faces);
        for origin in [DVec3::ZERO, DVec3::X * 0.25, random.unit() * 0.4, random.unit() * 0.7] {
            for &aim in &aims {
                let hit = caster.closest(origin, aim - origin, EVERYWHERE, |hit| hit.face < own).expect("no leak");
                assert!((hit.t - 1.0).abs() < 1e-9, "{hit:?}");
                assert!(caster.any(origin, aim - origin, EVERYWHERE, |hit| hit.face < own));
            }
        }
        assert!(caster.tree.count().0 > 2 * faces.len(), "{:?}", caster.tree.count());
    }
}

#[test]
fn what_is_clipped_covers_its_triangle_and_no_more() {
    let mut random = Random(13);
    let padding = PADDING as f32;
    let mut both = 0;
    for round in 0..20_000 {
        let mut corners = [0; 3].map(|_| random.vector().as_vec3a());
        // Every fourth triangle has an edge nearly parallel to the plane.
        if round % 4 == 0 {
            corners[1][0] = corners[0][0] + random.signed() as f32 * 1e-7;
        }
        let axis = round % 3;
        let at = if round % 5 == 0 { corners[1][axis] } else { random.signed() as f32 };
        let mut bounds = Aabb::from_points(&corners);
        bounds.min -= padding;
        bounds.max += padding;
        let parts = clipped(corners, &bounds, axis, at);
        for _ in 0..20 {
            let (u, v) = (random.signed().abs(), random.signed().abs());
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let [a, b, c] = corners.map(|corner| corner.as_dvec3());
            let point = (a + (b - a) * u + (c - a) * v).as_vec3a();
            let inside = |part: &Aabb| {
                (point - part.min).min_element() > 0.8 * padding && (part.max - point).min_element() > 0.8 * padding
            };
            assert!(parts.iter().any(inside), "{corners:?} {axis} {at} {point}");
        }
        for part in parts.iter().filter(|part| part.valid()) {
            assert_eq!(part.union(&bounds), bounds);
        }
        let over = [parts[0].max[axis] - at, at - parts[1].min[axis]];
        assert!(parts.iter().zip(over).all(|(part, over)| !part.valid() || over <= 1.2 * padding), "{over:?}");
        both += usize::from(parts[0].valid() && parts[1].valid());
    }
    assert!(both > 5_000, "{both}");
    // A right triangle split at half its height: the part below has its full width, the part above half of it.
    let corners = [Vec3A::ZERO, Vec3A::new(1.0, 0.0, 0.0), Vec3A::new(0.0, 1.0, 0.0)];
    let [below, above] = clipped(corners, &Aabb { min: Vec3A::splat(-1.0), max: Vec3A::splat(2.0) }, 1, 0.5);
    assert!(below.max.abs_diff_eq(Vec3A::new(1.0, 0.5, 0.0), 2.0 * padding), "{below:?}");
    assert!(above.max.abs_diff_eq(Vec3A::new(0.5, 1.0, 0.0), 2.0 * padding), "{above:?}");
    assert!(above.min.abs_diff_eq(Vec3A::new(0.0, 0.5, 0.0), 2.0 * padding), "{above:?}");
}

#[test]
fn references_and_time_are_bounded() {
    let mut random = Random(14);
    for kind in 0..5 {
        let (positions, faces) = crowded(kind, 10_000, &mut random);
        let start = std::time::Instant::now();
        let caster = RayCaster::new(&positions, &faces);
        for _ in 0..1_000 {
            let origin = random.unit() * 3.0;
            caster.closest(origin, random.vector() - origin, EVERYWHERE, any_hit);
        }
        assert!(start.elapsed().as_secs() < 20, "kind {kind}: {:?}", start.elapsed());
        let (references, level) = caster.tree.count();
        assert!(references <= (1 + REFERENCES.0) * faces.len() + REFERENCES.1, "kind {kind}: {references}");
        assert!(level <= LEVELS, "kind {kind}: {level}");
    }
    // The hits are the same when no references are left.
    let (positions, faces) = crowded(0, 2_000, &mut random);
    let caster = RayCaster::new(&positions, &faces);
    let faces_in_all = caster.tree.count().0;
    caster.whole.left.store(5_000, Ordering::Relaxed);
    for _ in 0..200 {
        let origin = random.unit() * 2.0;
        let direction = random.vector() - origin;
        let expected = closest_of_all(&positions, &faces, origin, direction, EVERYWHERE);
        assert_eq!(caster.all(origin, direction, EVERYWHERE, any_hit), expected);
    }
    let (references, _) = caster.tree.count();
    assert!((faces_in_all + 2_500..=faces_in_all + 5_000).contains(&references), "{references}");
}

#[test]
fn models_have_no_cells() {
    for levels in [0, 3, 5] {
        let (positions, faces) = icosphere(levels);
        assert!(RayCaster::new(&positions, &faces).tree.cells.is_empty());
    }
}

#[test]
fn small_faces_are_told_apart_whole() {
    let mut random = Random(16);
    let triangles: Vec<[Vec3; 3]> = (0..20_000)
        .map(|_| {
            let place = random.vector();
            [0; 3].map(|_| (place + 0.2 * random.vector()).as_vec3())
        })
        .collect();
    let (positions, faces) = apart(triangles);
    let caster = RayCaster::new(&positions, &faces);
    let boxes = positions.chunks(3).map(|corners| {
        let corners: Vec<Vec3A> = corners.iter().map(|&corner| corner.into()).collect();
        Aabb::from_points(&corners)
    });
    let boxes: Vec<Aabb> = boxes.collect();
    let all = boxes.iter().fold(Aabb::INVALID, |all, one| all.union(one));
    let over = boxes.iter().map(Aabb::half_area).sum::<f32>() / all.half_area();
    assert!(over > 2.0 * OVERLAP && !caster.tree.bvh.nodes[0].is_leaf(), "{over}");
}

#[test]
fn threads_find_the_same() {
    let mut random = Random(15);
    let (positions, faces) = crowded(0, 5_000, &mut random);
    let rays: Vec<(DVec3, DVec3)> = (0..2_000).map(|_| (random.unit() * 3.0, -random.unit())).collect();
    let hits = |caster: &RayCaster| -> Vec<Option<Hit>> {
        rays.iter().map(|&(origin, way)| caster.closest(origin, way, EVERYWHERE, any_hit)).collect()
    };
    let alone = hits(&RayCaster::new(&positions, &faces));
    let shared = RayCaster::new(&positions, &faces);
    std::thread::scope(|scope| {
        let all = [0; 4].map(|_| scope.spawn(|| hits(&shared)));
        for one in all {
            assert_eq!(one.join().expect("no panic"), alone);
        }
    });
}
