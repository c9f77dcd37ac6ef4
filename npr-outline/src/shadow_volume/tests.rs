use super::*;
use npr_mesh::edges::find;
use npr_mesh::{Material, embedded};
use proptest::prelude::*;

impl ShadowCasters {
    /// In how many volumes a point lies: the sum of the signed crossings of the segment from it to `beyond`, a point
    /// outside all volumes. Sides are taken as they are swept, caps as they are wound.
    fn count_at(&self, point: DVec3, beyond: DVec3, light: DVec4) -> i32 {
        let local = self.local_light(light);
        let mut count = 0;
        let mut crossed = |corners: [DVec4; 3], times: i32| count += times * crossing(corners, point, beyond);
        for edge in self.edges() {
            let sweeps = outline_sweeps(edge.flags, edge.plane0, edge.plane1, local);
            let ends = [edge.from, edge.to].map(|end| Vec3::from(end).as_dvec3());
            let [from, to] = if sweeps > 0 { ends } else { [ends[1], ends[0]] };
            let [near_from, near_to] = [from, to].map(|end| end.extend(1.0));
            let [far_from, far_to] = [from, to].map(|end| outline_swept(end, light));
            crossed([near_to, near_from, far_from], sweeps.abs());
            if light.w != 0.0 {
                crossed([near_to, far_from, far_to], sweeps.abs());
            }
        }
        for face in self.faces() {
            let casting = outline_casting(face.plane, face.flags & VOLUME_OPEN != 0, local);
            let corners = [face.a, face.b, face.c].map(|corner| Vec3::from(corner).as_dvec3());
            crossed(corners.map(|corner| corner.extend(1.0)), casting);
            if light.w != 0.0 {
                let [a, b, c] = corners.map(|corner| outline_swept(corner, light));
                crossed([a, c, b], casting);
            }
        }
        count
    }
}

/// 1 where the segment from `inside` to `outside` leaves through a homogeneous triangle, counter-clockwise from outside, −1
/// where it enters, 0 where it passes by.
fn crossing(corners: [DVec4; 3], inside: DVec3, outside: DVec3) -> i32 {
    // Signs of 4×4 determinants: the sides of planes through three homogeneous points.
    let side = |a: DVec4, b: DVec4, c: DVec4, d: DVec4| glam::DMat4::from_cols(a, b, c, d).determinant();
    let [a, b, c] = corners;
    let (p, q) = (inside.extend(1.0), outside.extend(1.0));
    let (at_p, at_q) = (side(a, b, c, p), side(a, b, c, q));
    if at_p * at_q >= 0.0 {
        return 0;
    }
    let [u, v, w] = [side(p, q, a, b), side(p, q, b, c), side(p, q, c, a)];
    let within = (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
    if !within {
        return 0;
    }
    if at_p > 0.0 { 1 } else { -1 }
}

fn casters_of(model: &Model) -> ShadowCasters {
    let edges = find(&model.positions, &model.faces, &[], &model.face_material, &EDGES);
    shadow_casters(model, &edges)
}

fn soup(positions: Vec<Vec3>, faces: Vec<[u32; 3]>) -> Model {
    Model {
        normals: vec![Vec3::Y; positions.len()],
        face_material: vec![0; faces.len()],
        materials: vec![Material::default()],
        positions,
        faces,
        ..Default::default()
    }
}

fn far(to_light: DVec3) -> DVec4 {
    to_light.extend(0.0)
}

fn near(place: DVec3) -> DVec4 {
    place.extend(1.0)
}

/// A point in no volume: far towards the light and aside, so that the way there crosses sides; or right beside the
/// light.
fn beyond(light: DVec4) -> DVec3 {
    let aside = DVec3::new(0.31, -0.17, 0.23);
    if light.w == 0.0 {
        light.truncate() * 1e3 + light.truncate().cross(aside) * 2e3
    } else {
        light.truncate() + aside * 1e-4
    }
}

/// How many faces that cast lie between a point and the light: the definition, by straight intersection in f64.
fn layers(casters: &ShadowCasters, point: DVec3, light: DVec4) -> i32 {
    let local = casters.local_light(light);
    let way = light.truncate() - point * light.w;
    let reach = if light.w == 0.0 { f64::INFINITY } else { 1.0 };
    let hit = |face: &VolumeFace| {
        let [a, b, c] = [face.a, face.b, face.c].map(|corner| Vec3::from(corner).as_dvec3());
        let n = (b - a).cross(c - a);
        let t = n.dot(a - point) / n.dot(way);
        let at = point + way * t;
        let sides = [(a, b), (b, c), (c, a)].map(|(p, q)| n.dot((q - p).cross(at - p)));
        t > 0.0 && t < reach && sides.iter().all(|&side| side > 0.0)
    };
    let casting = |face: &VolumeFace| outline_casting(face.plane, face.flags & VOLUME_OPEN != 0, local) != 0;
    casters.faces().filter(casting).filter(hit).count() as i32
}

#[test]
fn faces_without_material_cast() {
    let cube = embedded::cube();
    // A material that no face has lets no light through.
    let blend = vec![Material { alpha_mode: AlphaMode::Blend, ..Material::default() }];
    let without = Model { face_material: vec![], face_polygon: vec![], materials: blend, ..cube.clone() };
    assert_eq!(casters_of(&without), casters_of(&cube));
    assert_eq!(casters_of(&without).faces().len(), 12);
    let bare = Model { positions: cube.positions.clone(), faces: cube.faces.clone(), ..Model::default() };
    assert_eq!(casters_of(&bare), casters_of(&cube));
}

#[test]
fn a_square_shadows_what_is_behind_it_whichever_way_it_is_wound() {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 0.0, 1.0), Vec3::Z];
    for faces in [vec![[0, 1, 2], [0, 2, 3]], vec![[0, 2, 1], [0, 3, 2]], vec![[0, 1, 2], [0, 3, 2]]] {
        let casters = casters_of(&soup(positions.clone(), faces));
        assert!(casters.open);
        for light in [far(DVec3::Y), near(DVec3::new(0.4, 3.0, 0.4)), far(-DVec3::Y), near(DVec3::new(0.4, -3.0, 0.4))]
        {
            let (up, count) = (if light.y > 0.0 { 1.0 } else { -1.0 }, |at| casters.count_at(at, beyond(light), light));
            assert_eq!(count(DVec3::new(0.3, -up, 0.55)), 1, "{light}");
            assert_eq!(count(DVec3::new(0.3, up, 0.55)), 0, "{light}");
            assert_eq!(count(DVec3::new(2.3, -up, 0.55)), 0, "{light}");
            // The middle of the square is darkened once, whatever the winding: no crack and no double along the
            // diagonal.
            let (mut edges, mut faces) = (Vec::new(), Vec::new());
            casters.scan(light, &mut edges, &mut faces);
            assert_eq!((edges.len(), faces.len()), (4, 2));
        }
    }
}

#[test]
fn of_a_cube_half_casts_and_its_contour_sweeps_once() {
    let casters = casters_of(&embedded::cube());
    assert!(!casters.open);
    let (mut edges, mut faces) = (Vec::new(), Vec::new());
    for light in [far(DVec3::new(1.0, 2.0, 3.0)), near(DVec3::new(5.0, 6.0, 7.0))] {
        casters.scan(light, &mut edges, &mut faces);
        assert_eq!((edges.len(), faces.len()), (6, 6));
        let local = casters.local_light(light);
        assert!(edges.iter().all(|edge| outline_sweeps(edge.flags, edge.plane0, edge.plane1, local).abs() == 1));
    }
    // Straight above, and within, where every face faces away from the light and nothing casts.
    casters.scan(far(DVec3::Y), &mut edges, &mut faces);
    assert_eq!(faces.len(), 2 + 8, "edge-on counts as facing the light");
    casters.scan(near(DVec3::ZERO), &mut edges, &mut faces);
    assert_eq!((edges.len(), faces.len()), (0, 0));
}

#[test]
fn three_faces_at_one_edge_cast_one_each() {
    let positions = vec![Vec3::ZERO, Vec3::Z, Vec3::X, Vec3::NEG_X, Vec3::new(0.1, -1.0, 0.0)];
    let casters = casters_of(&soup(positions, vec![[0, 1, 2], [1, 0, 3], [0, 1, 4]]));
    let light = far(DVec3::new(0.05, 1.0, 0.0));
    for at in [
        DVec3::new(0.2, -2.0, 0.3),
        DVec3::new(-0.4, -2.0, 0.3),
        DVec3::new(3.0, -2.0, 0.3),
        DVec3::new(-3.0, -0.5, 0.4),
    ] {
        assert_eq!(casters.count_at(at, beyond(light), light), layers(&casters, at, light), "{at}");
    }
    assert_eq!(casters.edges().filter(|edge| edge.flags & VOLUME_SECOND != 0).count(), 0);
}

#[test]
fn a_face_turned_by_mistake_leaves_no_hole_in_a_shadow() {
    let mut cube = embedded::cube();
    let (low, high) = cube.bounds().unwrap();
    let is_top = |face: &[u32; 3]| face.iter().all(|&v| cube.positions[v as usize].y == high.y);
    let top: Vec<usize> = (0..cube.faces.len()).filter(|&face| is_top(&cube.faces[face])).collect();
    assert_eq!(top.len(), 2);
    for face in top {
        cube.faces[face].swap(0, 1);
    }
    let casters = casters_of(&cube);
    assert!(casters.open);
    let light = far(DVec3::new(0.01, 1.0, 0.02));
    for (x, z) in [(0.1, 0.2), (0.5, 0.4), (0.8, 0.7), (0.3, 0.9)] {
        let at = low.as_dvec3() + (high - low).as_dvec3() * DVec3::new(x, -1.0, z);
        assert_eq!(casters.count_at(at, beyond(light), light), 2, "{at}");
    }
}

/// A cup that hangs from a plate: every edge of its rim has two faces of the plate, and one of its own.
#[test]
fn what_ends_at_an_edge_of_others_is_open() {
    let p = Vec3::new;
    let rim = [p(1.0, 0.0, 1.0), p(2.0, 0.0, 1.0), p(1.5, 0.0, 2.0)];
    let outside = [p(-3.0, 0.0, -2.0), p(6.0, 0.0, -2.0), p(1.5, 0.0, 7.0)];
    let positions: Vec<Vec3> = rim.into_iter().chain(outside).chain([p(1.5, -1.0, 1.3)]).collect();
    let mut faces = vec![[0, 2, 1]];
    for i in 0..3 {
        let j = (i + 1) % 3;
        faces.extend([[i, j, j + 3], [i, j + 3, i + 3]]);
    }
    let plate = faces.len();
    faces.extend([[0, 1, 6], [1, 2, 6], [2, 0, 6]]);
    let casters = casters_of(&soup(positions, faces));
    assert!(casters.faces().skip(plate).all(|face| face.flags == VOLUME_OPEN));
    for light in [far(DVec3::new(0.1, 1.0, 0.2)), far(DVec3::new(0.1, -1.0, 0.2))] {
        for at in [p(1.5, -3.0, 1.3), p(1.5, 3.0, 1.3), p(1.5, -0.2, 1.35), p(0.2, -2.0, 0.3)].map(|at| at.as_dvec3()) {
            assert_eq!(casters.count_at(at, beyond(light), light), layers(&casters, at, light), "{at} {light}");
        }
    }
}

#[test]
fn doubled_and_blended_faces_cast_nothing_more() {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Z];
    let light = far(DVec3::Y);
    let below = DVec3::new(0.2, -1.0, 0.2);
    let doubled = casters_of(&soup(positions.clone(), vec![[0, 1, 2], [2, 1, 0]]));
    assert_eq!((doubled.faces().len(), doubled.count_at(below, beyond(light), light)), (1, 1));
    let mut glass = soup(positions, vec![[0, 1, 2]]);
    glass.materials[0].alpha_mode = AlphaMode::Blend;
    glass.materials[0].base_color.w = 0.5;
    assert_eq!(casters_of(&glass).faces().len(), 1, "from 0.5 on it casts");
    glass.materials[0].base_color.w = 0.49;
    assert_eq!((casters_of(&glass).faces().len(), casters_of(&glass).edges().len()), (0, 0));
}

#[test]
fn the_teapot_on_the_ground_is_counted_as_its_faces_are() {
    let model = embedded::scene();
    let casters = casters_of(&model);
    assert!(casters.open, "the ground is");
    assert!(casters.faces().any(|face| face.flags == 0), "the solids are closed");
    let (low, high) = model.bounds().unwrap();
    let size = (high - low).as_dvec3();
    for light in [far(DVec3::new(0.3, 1.0, 0.4)), near(high.as_dvec3() + size * 0.4)] {
        for step in 0..40 {
            let along = DVec3::new(0.618_034, 0.754_878, 0.569_840) * f64::from(step);
            let at = low.as_dvec3() + size * along.fract();
            assert_eq!(casters.count_at(at, beyond(light), light), layers(&casters, at, light), "{at} {light}");
        }
    }
}

#[test]
fn a_way_without_end_ends_in_the_volumes_that_its_direction_meets() {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 0.0, 1.0), Vec3::Z];
    let casters = casters_of(&soup(positions, vec![[0, 1, 2], [0, 3, 2]]));
    let light = near(DVec3::new(0.6, 0.5, 0.3));
    for direction in [DVec3::NEG_Y, DVec3::Y, DVec3::X, DVec3::new(0.2, -1.0, 0.3), DVec3::new(2.0, -1.0, 0.0)] {
        let far_off = light.truncate() + DVec3::splat(0.01) + direction * 1e4;
        assert_eq!(casters.endless(light, direction) as i32, layers(&casters, far_off, light), "{direction}");
    }
    assert_eq!(casters.endless(light, DVec3::NEG_Y), 1);
    assert_eq!(casters.endless(far(DVec3::Y), DVec3::NEG_Y), 0);
}

#[test]
fn a_way_without_end_through_a_closed_solid_ends_in_one_volume_and_from_within_in_none() {
    let cube = embedded::cube();
    let (low, high) = cube.bounds().unwrap();
    let (middle, half) = ((low + high).as_dvec3() * 0.5, (high - low).as_dvec3() * 0.5);
    let casters = casters_of(&cube);
    assert!(!casters.open);
    for light in [DVec3::new(2.5, 3.0, 3.5), DVec3::new(-4.0, 1.5, 0.2), DVec3::new(0.1, -3.0, 0.2)] {
        let light = middle + half * light;
        for aside in [DVec3::new(0.01, 0.02, 0.03), DVec3::new(0.3, -0.4, 0.2), DVec3::new(-0.45, 0.15, -0.4)] {
            // In through one face towards the light, out through one that faces away from it and does not cast.
            let direction = middle + half * aside - light;
            assert_eq!(casters.endless(near(light), direction), 1, "{light} {aside}");
            assert_eq!(casters.endless(near(light), -direction), 0, "away: {light} {aside}");
            let along = direction.normalize();
            let beside = along + along.any_orthonormal_vector() * 3.0;
            assert_eq!(casters.endless(near(light), beside), 0, "beside: {light} {aside}");
        }
    }
    // Within, every face faces away from the light.
    for direction in [DVec3::new(1.0, 0.2, 0.3), DVec3::new(-0.1, -1.0, 0.3), DVec3::new(0.2, 0.1, -1.0)] {
        assert_eq!(casters.endless(near(middle + half * 0.1), direction), 0, "{direction}");
    }
}

#[test]
fn a_stencil_says_shadow_from_1_to_127() {
    let expected =
        [(0, false), (1, true), (2, true), (126, true), (127, true), (128, false), (129, false), (255, false)];
    for (count, is_in_shadow) in expected {
        assert_eq!(outline_in_shadow(count), is_in_shadow, "{count}");
    }
}

/// Corners of a lattice, so that faces share edges and corners, fold, coincide and lose their area.
fn lattice() -> impl Strategy<Value = (Vec<Vec3>, Vec<[u32; 3]>)> {
    let corner = prop::array::uniform3(0..3i8).prop_map(|c| Vec3::from(c.map(f32::from)));
    (prop::collection::vec(corner, 4..12), 1..14usize).prop_flat_map(|(corners, faces)| {
        let count = corners.len() as u32;
        (Just(corners), prop::collection::vec(prop::array::uniform3(0..count), faces))
    })
}

proptest! {
    #[test]
    fn volumes_of_any_triangles_count_the_faces_before_the_light(
        (corners, faces) in lattice(),
        at in prop::array::uniform3(-1.0..3.0f64),
        light in prop::array::uniform3(-4.0..6.0f64),
        is_near in any::<bool>(),
    ) {
        let casters = casters_of(&soup(corners, faces));
        // In no plane of the lattice.
        let (at, light) = (DVec3::from(at) + 0.001_234, DVec3::from(light) + DVec3::new(0.004_1, 0.007_3, 0.002_9));
        let light = if is_near { near(light) } else { far(light) };
        prop_assert_eq!(casters.count_at(at, beyond(light), light), layers(&casters, at, light));
    }
}

/// The triangles of a light by the records that a device has, one by one.
#[test]
fn triangles_are_those_of_the_records() {
    for model in [embedded::scene(), embedded::teapot(4)] {
        let casters = casters_of(&model);
        for light in [far(DVec3::new(0.3, 0.9, -0.2)), near(DVec3::new(1.0, 4.0, 2.0))] {
            let (mut edges, mut faces) = (Vec::new(), Vec::new());
            casters.scan(light, &mut edges, &mut faces);
            let local = casters.local_light(light);
            let each = if light.w == 0.0 { 3 } else { 6 };
            let sweeps =
                |edge: &VolumeEdge| outline_sweeps(edge.flags, edge.plane0, edge.plane1, local).unsigned_abs() as usize;
            let casting = |face: &VolumeFace| outline_casting(face.plane, face.flags & VOLUME_OPEN != 0, local);
            let swept: usize = edges.iter().map(sweeps).sum();
            let caps = |turn: i32| faces.iter().filter(|face| casting(face) == turn).count();
            let (corners, towards) = casters.triangles(light);
            assert_eq!(towards, each * (swept + caps(1)));
            assert_eq!(corners.len(), towards + each * caps(-1));
            assert!(swept > 100 && caps(1) > 100, "{swept} {}", caps(1));
            // From the end of the first edge to its start and away, whichever is the start.
            let edge = edges.iter().find(|edge| sweeps(edge) > 0).expect("one sweeps");
            let forwards = outline_sweeps(edge.flags, edge.plane0, edge.plane1, local) > 0;
            let (from, to) = if forwards { (edge.from, edge.to) } else { (edge.to, edge.from) };
            let corner = |[x, y, z]: [f32; 3], w: f32| [x, y, z, w];
            assert_eq!(corners[..3], [corner(to, 1.0), corner(from, 1.0), corner(from, 0.0)]);
        }
    }
}

/// Pages around a spine, wound in every way: the spine sweeps as often as the directions of its faces do not cancel out.
#[test]
fn pages_of_a_book_shadow_what_is_behind_them_however_they_are_wound() {
    let spine = [Vec3::ZERO, Vec3::Z];
    let tips =
        [Vec3::new(1.0, 0.3, 0.5), Vec3::new(-0.8, 0.4, 0.5), Vec3::new(0.2, 1.0, 0.5), Vec3::new(-0.3, -0.9, 0.5)];
    for windings in 0..16u32 {
        let faces = (0..4u32).map(|page| if windings >> page & 1 == 0 { [0, 1, 2 + page] } else { [1, 0, 2 + page] });
        let casters = casters_of(&soup([&spine[..], &tips[..]].concat(), faces.collect()));
        for light in [far(DVec3::new(0.2, 0.9, 0.1)), near(DVec3::new(0.3, 4.0, 0.6))] {
            for (x, y) in [(0.33, -2.0), (-0.35, -2.0), (0.05, 0.15), (-0.6, -1.5), (2.0, -1.0), (-0.02, -0.4)] {
                let point = DVec3::new(x, y, 0.47);
                let count = casters.count_at(point, beyond(light), light);
                assert_eq!(count, layers(&casters, point, light), "{windings:04b} {light} {point}");
            }
        }
    }
}
