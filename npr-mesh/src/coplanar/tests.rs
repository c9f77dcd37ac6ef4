//! The separated model shows at each point what the rule says, which a search through all faces finds.

use super::*;
use crate::Material;
use glam::{DQuat, DVec2};

struct Random(u64);

impl Random {
    fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as u32
    }

    fn below(&mut self, end: u32) -> u32 {
        self.bits() % end
    }

    fn unit(&mut self) -> f64 {
        f64::from(self.bits()) / f64::from(1u32 << 31)
    }
}

/// Triangles in the plane z = 0 of a turned and moved space, each with a material of its own.
struct Soup {
    model: Model,
    flat: Vec<[DVec2; 3]>,
    plane_from_model: (DQuat, DVec3),
}

impl Soup {
    fn new(flat: Vec<[DVec2; 3]>, turn: DQuat, offset: DVec3) -> Self {
        let place = |at: &DVec2| (turn * at.extend(0.0) + offset).as_vec3();
        let model = Model {
            positions: flat.as_flattened().iter().map(place).collect(),
            normals: vec![(turn * DVec3::Z).as_vec3(); 3 * flat.len()],
            faces: (0..flat.len() as u32).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect(),
            face_material: (0..flat.len() as u32).collect(),
            materials: vec![Material::default(); flat.len()],
            ..Model::default()
        };
        Self { model, flat, plane_from_model: (turn.inverse(), offset) }
    }

    /// The materials that are seen at a point from a side, from the top down to the first opaque one, by the rule.
    fn expected(&self, at: DVec2, side: f64) -> Vec<u32> {
        let turned_to = |face: usize| side * orientation(self.flat[face]) > 0.0;
        let here = |turned: bool| {
            (0..self.flat.len()).rev().filter(move |&f| turned_to(f) == turned && contains(self.flat[f], at))
        };
        let backs = here(false).filter(|&face| self.model.materials[face].double_sided);
        let mut seen = Vec::new();
        for face in here(true).chain(backs) {
            seen.push(face as u32);
            if self.model.materials[face].alpha_mode == AlphaMode::Opaque {
                break;
            }
        }
        seen
    }

    /// The materials of the faces that a model shows at a point from a side, ascending.
    fn shown(&self, model: &Model, at: DVec2, side: f64) -> Vec<u32> {
        let (turn, offset) = self.plane_from_model;
        let mut shown = Vec::new();
        for face in 0..model.faces.len() as u32 {
            let corners = corners_of(model, face).map(|corner| (turn * (corner - offset)).truncate());
            let is_front = side * orientation(corners) > 0.0;
            if contains(corners, at) && (is_front || model.shows_back(face)) {
                shown.push(model.face_material[face as usize]);
            }
        }
        shown.sort_unstable();
        shown
    }

    /// Compares what is shown with what is expected at random points, those near a side aside.
    fn check(&self, random: &mut Random, most_expected: usize) {
        let separated = separate(&self.model).map(|separated| separated.model);
        let model = separated.as_ref().unwrap_or(&self.model);
        for _ in 0..200 {
            let at = DVec2::new(random.unit(), random.unit()) * 2.4 - 1.2;
            if self.flat.iter().any(|&corners| is_near_side(corners, at)) {
                continue;
            }
            for side in [1.0, -1.0] {
                let mut expected = self.expected(at, side);
                assert!(expected.len() <= most_expected);
                expected.sort_unstable();
                assert_eq!(self.shown(model, at, side), expected, "{at} from {side}: {:?}", self.flat);
            }
        }
        if most_expected == 1 {
            assert!(separated.is_none_or(|model| separate(&model).is_none()), "what is separated stays");
        }
    }
}

fn orientation([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

fn contains([a, b, c]: [DVec2; 3], at: DVec2) -> bool {
    let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| (to - from).perp_dot(at - from));
    sides.iter().all(|&x| x > 0.0) || sides.iter().all(|&x| x < 0.0)
}

fn is_near_side([a, b, c]: [DVec2; 3], at: DVec2) -> bool {
    let distance = |from: DVec2, to: DVec2| {
        let t = ((at - from).dot(to - from) / (to - from).length_squared()).clamp(0.0, 1.0);
        at.distance(from.lerp(to, t))
    };
    [(a, b), (b, c), (c, a)].into_iter().any(|(from, to)| distance(from, to) < 1e-5)
}

fn turn(random: &mut Random) -> DQuat {
    match random.below(3) {
        0 => DQuat::IDENTITY,
        _ => DQuat::from_xyzw(random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5, random.unit()).normalize(),
    }
}

/// Triangles with corners anywhere, on a coarse grid, and with those of earlier ones in another order.
fn soup(random: &mut Random, faces: usize) -> Soup {
    let mut flat: Vec<[DVec2; 3]> = Vec::new();
    while flat.len() < faces {
        let anywhere = [(); 3].map(|()| DVec2::new(random.unit(), random.unit()) * 2.0 - 1.0);
        let on_grid = [(); 3].map(|()| DVec2::new(f64::from(random.below(5)), f64::from(random.below(5))) * 0.5 - 1.0);
        let corners = match (random.below(4), flat.is_empty()) {
            (0, false) => {
                let mut corners = flat[random.below(flat.len() as u32) as usize];
                corners.rotate_left(random.below(3) as usize);
                if random.below(2) == 0 {
                    corners.reverse();
                }
                corners
            }
            (1, _) => anywhere,
            _ => on_grid,
        };
        if orientation(corners).abs() > 0.01 {
            flat.push(corners);
        }
    }
    let turn = turn(random);
    Soup::new(flat, turn, DVec3::new(0.1, -0.4, 2.0) * f64::from(random.below(2)))
}

#[test]
fn opaque_soups_show_the_face_turned_to_the_eye_and_of_several_the_last() {
    let mut random = Random(3);
    for _ in 0..60 {
        let faces = 2 + random.below(8) as usize;
        soup(&mut random, faces).check(&mut random, 1);
    }
}

#[test]
fn soups_of_all_kinds_of_materials_show_what_is_above_the_first_opaque_face() {
    let mut random = Random(5);
    for _ in 0..60 {
        let faces = 2 + random.below(8) as usize;
        let mut soup = soup(&mut random, faces);
        for material in &mut soup.model.materials {
            material.double_sided = random.below(2) == 0;
            material.alpha_mode =
                [AlphaMode::Opaque, AlphaMode::Opaque, AlphaMode::Blend, AlphaMode::Mask { cutoff: 0.5 }]
                    [random.below(4) as usize];
        }
        soup.check(&mut random, faces);
    }
}

#[test]
fn a_polygon_cut_along_other_diagonals_is_one_in_any_rotation() {
    let mut random = Random(8);
    for _ in 0..40 {
        let corners: Vec<DVec2> = (0..7).map(|i| DVec2::from_angle(f64::from(i) * 0.9) * 0.9).collect();
        let fan = |from: usize| {
            let corners = corners.clone();
            (1..6).map(move |i| [from, (from + i) % 7, (from + i + 1) % 7].map(|corner| corners[corner]))
        };
        let flat = fan(0).chain(fan(2)).chain(fan(3)).collect();
        let turn = turn(&mut random);
        Soup::new(flat, turn, DVec3::ZERO).check(&mut random, 1);
    }
}

/// A flat grid of squares, each cut along a diagonal, with bumps.
fn grid(bump: f32) -> Model {
    let at = |i: u32| Vec3::new((i % 41) as f32, (i / 41) as f32, bump * ((i * 7919) % 13) as f32) / 40.0;
    let mut faces = Vec::new();
    for square in 0..1600 {
        let corner = square / 40 * 41 + square % 40;
        faces.extend([[corner, corner + 1, corner + 42], [corner, corner + 42, corner + 41]]);
    }
    Model { positions: (0..41 * 41).map(at).collect(), normals: vec![Vec3::Z; 41 * 41], faces, ..Model::default() }
}

#[test]
fn models_without_overlaps_stay_as_they_are() {
    for model in [grid(0.0), grid(0.3), crate::embedded::cube(), crate::embedded::teapot(4)] {
        assert!(separate(&model).is_none());
    }
    assert!(separate(&Model::default()).is_none());
}

#[test]
fn faces_farther_apart_than_rounding_stay_as_they_are() {
    let mut model = grid(0.0);
    let mut above = model.clone();
    above.positions.iter_mut().for_each(|position| position.z += 1e-5);
    model.append(&above);
    assert!(separate(&model).is_none());
}

#[test]
fn two_layers_of_a_fine_grid_are_separated_square_by_square() {
    let mut model = grid(0.0);
    let mut other = model.clone();
    // The second layer is cut along the other diagonals.
    for (number, face) in (0u32..).zip(&mut other.faces) {
        let corner = number / 2 / 40 * 41 + number / 2 % 40;
        *face =
            if number % 2 == 0 { [corner, corner + 1, corner + 41] } else { [corner + 1, corner + 42, corner + 41] };
    }
    model.append(&other);
    let separated = separate(&model).expect("all faces overlap").model;
    assert_eq!(separated.faces.len(), 4 * 1600);
    assert!(separated.face_mesh.iter().all(|&mesh| mesh == 1), "the later layer is seen");
}

#[test]
fn faces_that_are_never_seen_together_stay_whole() {
    // The bottom of a box on a larger floor: each is seen from its own front only.
    let mut random = Random(1);
    let square = [DVec2::NEG_ONE, DVec2::new(1.0, -1.0), DVec2::ONE, DVec2::new(-1.0, 1.0)];
    let [a, b, c, d] = square;
    let [e, f, g, h] = square.map(|corner| corner * 0.5);
    let mut soup = Soup::new(vec![[a, b, c], [a, c, d], [e, g, f], [e, h, g]], turn(&mut random), DVec3::ZERO);
    assert!(separate(&soup.model).is_some());
    soup.model.materials.iter_mut().for_each(|material| material.double_sided = false);
    assert!(separate(&soup.model).is_none());
}

#[test]
fn sources_and_coincident_faces_are_named() {
    let square = [DVec2::NEG_ONE, DVec2::new(1.0, -1.0), DVec2::ONE, DVec2::new(-1.0, 1.0)];
    let [a, b, c, _] = square;
    let beside = [DVec2::new(3.0, 3.0), DVec2::new(4.0, 3.0), DVec2::new(3.0, 4.0)];
    let soup = Soup::new(vec![beside, [a, b, c], [b, c, a]], DQuat::IDENTITY, DVec3::ZERO);
    let separated = separate(&soup.model).expect("a face is there twice");
    assert_eq!((separated.sources, separated.coincident), (vec![0, 2], vec![1, 2]));
    assert!(separated.model.face_polygon.is_empty(), "nothing is cut");
}

#[test]
fn no_piece_is_so_slim_that_its_normal_is_uncertain() {
    let mut random = Random(17);
    let square = [DVec2::NEG_ONE, DVec2::new(1.0, -1.0), DVec2::ONE, DVec2::new(-1.0, 1.0)];
    let mark = square.map(|corner| corner * 0.4);
    let of = |corners: [DVec2; 4]| [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]];
    for _ in 0..200 {
        let turn = turn(&mut random);
        let soup = Soup::new([of(square), of(mark)].concat(), turn, DVec3::ZERO);
        let separated = separate(&soup.model).expect("the mark is on the square").model;
        for face in 0..separated.faces.len() as u32 {
            let [a, b, c] = corners_of(&separated, face);
            let normal = (b - a).cross(c - a).normalize();
            assert!(normal.dot(turn * DVec3::Z) > 0.999, "{normal} of {:?}", [a, b, c]);
        }
    }
}

#[test]
fn pieces_have_what_the_file_says_of_their_sides() {
    let square = [DVec2::NEG_ONE, DVec2::new(1.0, -1.0), DVec2::ONE, DVec2::new(-1.0, 1.0)];
    let [a, b, c, d] = square;
    let mark = square.map(|corner| corner * 0.5);
    let mut soup = Soup::new(vec![[a, b, c], [a, c, d], [mark[0], mark[1], mark[2]]], DQuat::IDENTITY, DVec3::ZERO);
    use crate::SideVisibility::{Hard, Hidden, Silhouette};
    soup.model.side_visibility = vec![[Hard, Silhouette, Hidden], [Hidden, Hard, Hard], [Hard; 3]];
    let separated = separate(&soup.model).expect("the mark is on the square").model;
    assert_eq!(separated.side_visibility.len(), separated.faces.len());
    let mut lengths = HashMap::new();
    for (face, sides) in (0u32..).zip(&separated.side_visibility) {
        let corners = corners_of(&separated, face);
        for side in 0..3 {
            *lengths.entry(sides[side]).or_insert(0.0) += corners[side].distance(corners[(side + 1) % 3]);
        }
    }
    // The outer sides: three hard and one silhouette; and those of the mark, its diagonal among them.
    assert!((lengths[&Silhouette] - 2.0).abs() < 1e-6, "{lengths:?}");
    assert!((lengths[&Hard] - (6.0 + 2.0 + 2f64.sqrt())).abs() < 1e-6, "{lengths:?}");
}

#[test]
fn pieces_interpolate_what_their_corners_have() {
    let square = [DVec2::NEG_ONE, DVec2::new(1.0, -1.0), DVec2::ONE, DVec2::new(-1.0, 1.0)];
    let mark = square.map(|corner| corner * 0.5);
    let of = |corners: [DVec2; 4]| [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]];
    let mut soup = Soup::new([of(square), of(mark)].concat(), DQuat::IDENTITY, DVec3::ZERO);
    let uv = |position: &Vec3| Vec3::new(0.5, 0.25, 0.0) * *position;
    soup.model.uvs = soup.model.positions.iter().map(|position| uv(position).truncate()).collect();
    soup.model.colors = soup.model.positions.iter().map(|position| position.extend(1.0)).collect();
    let separated = separate(&soup.model).expect("the mark is on the square").model;
    for (vertex, position) in separated.positions.iter().enumerate() {
        assert!(separated.uvs[vertex].abs_diff_eq(uv(position).truncate(), 1e-6));
        assert!(separated.colors[vertex].abs_diff_eq(position.extend(1.0), 1e-6));
        assert_eq!(separated.normals[vertex], Vec3::Z);
    }
    let area = |face: u32| {
        let [a, b, c] = corners_of(&separated, face);
        0.5 * (b - a).cross(c - a).length()
    };
    let of_material = |kinds: [u32; 2]| {
        (0..separated.faces.len() as u32)
            .filter(|&face| kinds.contains(&separated.face_material[face as usize]))
            .map(area)
            .sum::<f64>()
    };
    assert_eq!((of_material([0, 1]), of_material([2, 3])), (3.0, 1.0));
    assert!(separated.one_sided.is_empty(), "nothing is turned against anything else");
}
