mod authored;

use super::*;
use glam::Mat4;
use npr_mesh::edges::{EdgeOptions, find};
use npr_mesh::embedded;
use npr_mesh::{Material, Model};
use proptest::prelude::*;
use std::collections::{BTreeSet, HashMap};

fn edges_of(model: &Model) -> Edges {
    find(&model.positions, &model.faces, &model.face_polygon, &model.face_material, &EdgeOptions::default())
}

fn contours_of(model: &Model, options: &ContourOptions) -> ContourEdges {
    contour_edges(model, &edges_of(model), options).unwrap()
}

fn smooth(crease_angle_rad: f32) -> ContourOptions {
    ContourOptions { crease_angle_rad, ..ContourOptions::default() }
}

/// No creases: only silhouettes and boundaries are lines.
const NO_CREASES: ContourOptions = ContourOptions {
    crease_angle_rad: std::f32::consts::PI,
    material_borders: false,
    creases: true,
    boundaries: true,
    silhouettes: true,
    authored: true,
    file_edges: true,
    world_from_normal: DMat3::IDENTITY,
    double_sided: None,
};

fn point(eye: DVec3) -> DVec4 {
    eye.extend(1.0)
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The ends, lower first, of all lines of a kind.
fn lines_of_kind(contours: &ContourEdges, eye: DVec4, kind: LineKind) -> BTreeSet<[u32; 2]> {
    let mut lines = Vec::new();
    contours.scan(eye, &mut lines);
    let local = contours.local_eye(eye);
    let of_kind = lines.iter().filter(|&&line| contours.kind(line as usize, local) == Some(kind));
    of_kind.map(|&line| contours.edges[line as usize].ends).map(sorted).collect()
}

/// Whether every vertex has an even number of silhouettes.
fn all_loops_closed(contours: &ContourEdges, eye: DVec4) -> bool {
    let mut degree = HashMap::<u32, u32>::new();
    for ends in lines_of_kind(contours, eye, LineKind::Silhouette) {
        ends.iter().for_each(|&end| *degree.entry(end).or_default() += 1);
    }
    degree.values().all(|d| d % 2 == 0)
}

#[test]
fn a_cube_seen_from_a_corner_has_six_silhouettes_and_six_creases() {
    let contours = contours_of(&embedded::cube(), &ContourOptions::default());
    assert_eq!((contours.edges.len(), contours.always), (12, 12));
    for eye in [point(DVec3::new(4.0, 5.0, 6.0)), DVec4::new(1.0, 1.0, 1.0, 0.0)] {
        assert_eq!(lines_of_kind(&contours, eye, LineKind::Silhouette).len(), 6);
        // Three of them towards the eye, three away from it.
        assert_eq!(lines_of_kind(&contours, eye, LineKind::Crease).len(), 6);
    }
    // Seen straight on, and from within, where no face is back-facing.
    assert_eq!(lines_of_kind(&contours, point(DVec3::Z * 9.0), LineKind::Silhouette).len(), 4);
    assert_eq!(lines_of_kind(&contours, point(DVec3::ZERO), LineKind::Silhouette).len(), 0);
}

#[test]
fn the_crease_angle_decides() {
    let model = embedded::cube();
    assert_eq!(contours_of(&model, &smooth(1.5)).always, 12);
    assert_eq!(contours_of(&model, &smooth(1.6)).always, 0);
}

#[test]
fn silhouettes_of_closed_surfaces_are_closed_loops() {
    for model in [embedded::sphere(24), embedded::torus(1.0, 0.4, 24, 12), embedded::cylinder(24), embedded::cube()] {
        let contours = contours_of(&model, &NO_CREASES);
        for (i, direction) in crate::normal_format::fibonacci_sphere(2000).enumerate() {
            // From inside to far away.
            let eye = direction * (0.05 + 0.002 * (i * 7 % 2000) as f64);
            assert!(all_loops_closed(&contours, point(eye)), "{eye}");
            assert!(all_loops_closed(&contours, direction.extend(0.0)), "{eye}");
        }
        // Exactly at corners, at middles of edges, and in the planes of faces, or within rounding of them.
        for face in &model.faces {
            let [a, b, c] = face.map(|v| model.positions[v as usize].as_dvec3());
            for eye in [a, 0.5 * (a + b), (a + b + c) / 3.0, a + 3.0 * (b - a), a + 5.0 * (b - a) - 2.0 * (c - a)] {
                assert!(all_loops_closed(&contours, point(eye)), "{eye}");
                assert!(all_loops_closed(&contours, (b - a).extend(0.0)), "{eye}");
            }
        }
    }
}

#[test]
fn an_eye_in_the_plane_of_a_face_loses_no_loop() {
    let contours = contours_of(&embedded::cube(), &NO_CREASES);
    // In the top's plane, and in the planes of the top and the right side: both count as front-facing.
    for (eye, silhouettes) in [(DVec3::new(0.3, 1.0, 7.0), 6), (DVec3::new(1.0, 1.0, 7.0), 6)] {
        let lines = lines_of_kind(&contours, point(eye), LineKind::Silhouette);
        assert_eq!(lines.len(), silhouettes, "{eye}");
        assert!(all_loops_closed(&contours, point(eye)));
    }
}

#[test]
fn a_spheres_contour_converges_to_the_circle() {
    // From distance d the contour of a unit sphere is a circle of radius sqrt(1 - 1/d²) in the plane at 1/d.
    let eye = DVec3::new(1.0, 2.0, -1.5);
    let (direction, distance) = (eye.normalize(), eye.length());
    let mut previous = f64::INFINITY;
    for segments in [16, 32, 64, 128, 256] {
        let model = embedded::sphere(segments);
        let contours = contours_of(&model, &NO_CREASES);
        let lines = lines_of_kind(&contours, point(eye), LineKind::Silhouette);
        // Edges of the contour run along the mesh, so that they stray by the size of a face.
        let worst = lines
            .iter()
            .flatten()
            .map(|&v| (model.positions[v as usize].as_dvec3().dot(direction) - 1.0 / distance).abs())
            .fold(0.0, f64::max);
        let step = std::f64::consts::TAU / f64::from(segments);
        assert!(worst < 1.2 * step && worst < 0.75 * previous, "{segments}: {worst} of {step}");
        previous = worst;
        // On the screen it is a circle to second order. The tangents' angle with the axis:
        let expected = (1.0 / distance).asin();
        for &v in lines.iter().flatten() {
            let angle = (model.positions[v as usize].as_dvec3() - eye).angle_between(-direction);
            assert!((angle - expected).abs() < step * step, "{segments}: {angle}, {expected}");
        }
    }
}

#[test]
fn boundaries_are_always_drawn() {
    let mut model = embedded::sphere(12);
    model.faces.truncate(30);
    model.face_material.truncate(30);
    let edges = edges_of(&model);
    let boundaries = edges.edges.iter().filter(|edge| edge.kind() == EdgeKind::Boundary).count();
    let contours = contours_of(&model, &NO_CREASES);
    assert!(boundaries > 3 && contours.always == boundaries);
    for direction in crate::normal_format::fibonacci_sphere(200) {
        for eye in [point(3.0 * direction), direction.extend(0.0)] {
            assert_eq!(lines_of_kind(&contours, eye, LineKind::Boundary).len(), boundaries);
        }
    }
    assert_eq!(contours.normals(0)[1], Vec3::ZERO);
    assert!(contours.normals(0)[0].is_normalized());
}

#[test]
fn faces_wound_the_other_way_change_nothing() {
    for model in [embedded::sphere(24), embedded::torus(1.0, 0.4, 32, 16)] {
        let mut flipped = model.clone();
        flipped.faces.iter_mut().step_by(10).for_each(|face| face.swap(1, 2));
        let (contours, of_flipped) = (contours_of(&model, &smooth(0.9)), contours_of(&flipped, &smooth(0.9)));
        assert_eq!(contours.always, of_flipped.always);
        for direction in crate::normal_format::fibonacci_sphere(300) {
            let eye = point(2.7 * direction);
            for kind in [LineKind::Silhouette, LineKind::Crease] {
                let lines = lines_of_kind(&contours, eye, kind);
                assert_eq!(lines, lines_of_kind(&of_flipped, eye, kind));
            }
        }
    }
}

/// Two triangles in a ridge along x, with a sliver of zero area between them: its middle corner lies on the ridge.
fn ridge_with_sliver(slope: f32) -> Model {
    let positions = vec![
        Vec3::new(-1.0, 0.0, 0.0),
        Vec3::new(1.0, 0.0, 0.0),
        Vec3::new(0.0, 0.0, 0.0),
        Vec3::new(0.0, -slope, 1.0),
        Vec3::new(0.0, -slope, -1.0),
    ];
    // The front uses the ridge as one edge, the back as two.
    let faces = vec![[0, 3, 1], [0, 1, 2], [0, 2, 4], [2, 1, 4]];
    Model {
        normals: vec![Vec3::Y; positions.len()],
        face_material: vec![0; faces.len()],
        materials: vec![Material::default()],
        positions,
        faces,
        ..Model::default()
    }
}

#[test]
fn a_sliver_between_two_faces_passes_silhouette_and_crease_on() {
    let along_ridge = |lines: BTreeSet<[u32; 2]>| {
        let is_whole = lines.contains(&[0, 1]);
        let is_halves = lines.contains(&[0, 2]) && lines.contains(&[1, 2]);
        is_whole || is_halves
    };
    let model = ridge_with_sliver(0.5);
    assert_eq!(edges_of(&model).face_normals[1], Vec3::ZERO);
    let contours = contours_of(&model, &NO_CREASES);
    // The front slopes down towards +z: an eye low behind sees the back only.
    for eye in [DVec3::new(0.1, 0.1, 5.0), DVec3::new(-0.3, 0.4, -5.0)] {
        assert!(along_ridge(lines_of_kind(&contours, point(eye), LineKind::Silhouette)), "{eye}");
    }
    assert!(!along_ridge(lines_of_kind(&contours, point(DVec3::new(0.1, 9.0, 0.2)), LineKind::Silhouette)));
    // A roof of 2 · 60°, a crease from everywhere.
    let contours = contours_of(&ridge_with_sliver(1.7), &smooth(1.0));
    assert!(along_ridge(lines_of_kind(&contours, point(DVec3::Y * 9.0), LineKind::Crease)));
}

/// A cube whose top is rotated by 40° against its bottom, which warps its sides.
fn twisted_cube() -> Model {
    let mut model = embedded::cube();
    let turn = Mat4::from_rotation_y(40f32.to_radians());
    for position in model.positions.iter_mut().filter(|position| position.y > 0.0) {
        *position = turn.transform_point3(*position);
    }
    model
}

#[test]
fn the_contour_of_warped_quads_is_that_of_their_triangles() {
    let model = twisted_cube();
    let triangles = Model { face_polygon: Vec::new(), ..model.clone() };
    let (by_quads, by_triangles) = (contours_of(&model, &NO_CREASES), contours_of(&triangles, &NO_CREASES));
    assert_eq!(edges_of(&model).folds.len(), 4);
    let mut along_folds = 0;
    for (i, direction) in crate::normal_format::fibonacci_sphere(500).enumerate() {
        let eye = point(direction * (2.0 + 0.02 * i as f64));
        for eye in [eye, direction.extend(0.0)] {
            let lines = lines_of_kind(&by_quads, eye, LineKind::Silhouette);
            assert_eq!(lines, lines_of_kind(&by_triangles, eye, LineKind::Silhouette), "{eye}");
            assert!(all_loops_closed(&by_quads, eye));
            along_folds += edges_of(&model).folds.iter().filter(|fold| lines.contains(&sorted(fold.ends))).count();
        }
    }
    assert!(along_folds > 100, "{along_folds}");
}

#[test]
fn a_fold_is_no_crease_however_sharp() {
    let model = twisted_cube();
    let edges = edges_of(&model);
    for crease_angle_rad in [0.0, 0.3, 3.0] {
        let contours = contours_of(&model, &smooth(crease_angle_rad));
        assert!(contours.always <= edges.edges.len());
        for fold in &edges.folds {
            assert!(!contours.edges[..contours.always].iter().any(|edge| edge.ends == fold.ends));
        }
    }
    // The quads' own edges are creases or not by the normal of the whole quad.
    assert_eq!(contours_of(&model, &smooth(1.2)).always, 12);
}

#[test]
fn a_warped_quad_wound_the_other_way_changes_nothing() {
    let model = twisted_cube();
    for polygon in 0..6 {
        let mut flipped = model.clone();
        flipped.faces[2 * polygon..2 * polygon + 2].iter_mut().for_each(|face| face.swap(1, 2));
        let (expected, found) = (contours_of(&model, &NO_CREASES), contours_of(&flipped, &NO_CREASES));
        for direction in crate::normal_format::fibonacci_sphere(100) {
            let eye = point(4.0 * direction);
            let of = |contours| lines_of_kind(contours, eye, LineKind::Silhouette);
            assert_eq!(of(&found), of(&expected), "polygon {polygon}, {eye}");
        }
    }
}

#[test]
fn a_parallel_view_is_the_limit_of_a_distant_eye() {
    for model in [embedded::sphere(24), embedded::torus(1.0, 0.4, 32, 16)] {
        let contours = contours_of(&model, &NO_CREASES);
        for direction in crate::normal_format::fibonacci_sphere(50) {
            let parallel = lines_of_kind(&contours, direction.extend(0.0), LineKind::Silhouette);
            let distant = lines_of_kind(&contours, point(direction * 1e7), LineKind::Silhouette);
            // A face within rounding of edge-on may differ; it has three edges.
            assert!(parallel.symmetric_difference(&distant).count() <= 4);
            let by_normals: BTreeSet<[u32; 2]> = edges_of(&model)
                .edges
                .iter()
                .filter(|edge| {
                    let [a, b] = edge.faces().map(|face| {
                        facing_exact(
                            model.faces[face as usize].map(|v| model.positions[v as usize]),
                            direction.extend(0.0),
                        )
                    });
                    (a >= 0.0) != (b >= 0.0)
                })
                .map(|edge| sorted(edge.ends))
                .collect();
            assert!(parallel.symmetric_difference(&by_normals).count() <= 4);
        }
    }
}

#[test]
fn an_origin_far_away_keeps_the_classification_right() {
    // Vertices on a grid that f32 holds exactly at 1e6, so that the moved torus is the same one.
    let mut near = embedded::torus(1.0, 0.4, 24, 12);
    near.positions.iter_mut().for_each(|p| *p = (*p * 64.0).round() / 16.0);
    let offset = Vec3::splat(1e6);
    let far = embedded::placed(near.clone(), Mat4::from_translation(offset), Material::default());
    let (of_near, of_far) = (contours_of(&near, &NO_CREASES), contours_of(&far, &NO_CREASES));
    assert!((of_far.origin - offset).length() < 1.0);
    for direction in crate::normal_format::fibonacci_sphere(500) {
        let eye = 11.0 * direction;
        let lines = lines_of_kind(&of_near, point(eye), LineKind::Silhouette);
        let far_lines = lines_of_kind(&of_far, point(eye + offset.as_dvec3()), LineKind::Silhouette);
        assert!(lines.len() > 20 && lines == far_lines, "{eye}");
    }
}

#[test]
fn a_scan_finds_exactly_the_edges_that_have_a_kind() {
    // 65 and more changing edges fill a block of the scan and begin the next.
    for model in [embedded::cube(), embedded::teapot(4), embedded::cylinder(23), embedded::scene()] {
        let contours = contours_of(&model, &ContourOptions::default());
        for direction in crate::normal_format::fibonacci_sphere(20) {
            let eye = point(6.0 * direction);
            let local = contours.local_eye(eye);
            let mut lines = vec![7];
            contours.scan(eye, &mut lines);
            let expected: Vec<u32> =
                (0..contours.edges.len()).filter(|&e| contours.kind(e, local).is_some()).map(|e| e as u32).collect();
            assert_eq!(lines, expected);
        }
    }
}

#[test]
fn planes_are_those_of_the_faces() {
    let model = embedded::teapot(4);
    let contours = contours_of(&model, &ContourOptions::default());
    for edge in 0..contours.edges.len() {
        let EdgePlanes { plane0, plane1 } = contours.edge_planes(edge);
        for end in contours.edges[edge].ends.map(|v| model.positions[v as usize] - contours.origin) {
            for plane in [plane0, plane1] {
                // Both ends lie in both planes.
                assert!(outline_facing(plane, end.extend(1.0)).abs() < 1e-6);
            }
        }
        // The first face lies to the left of the edge, seen from its front.
        let [a, b] = contours.edges[edge].ends;
        let face = model.faces[contours.edges[edge].faces()[0] as usize];
        let at = |v: u32| model.positions[v as usize];
        let follows = |v: u32, w: u32| (0..3).any(|i| at(face[i]) == at(v) && at(face[(i + 1) % 3]) == at(w));
        assert!(follows(a, b));
    }
}

#[test]
fn borders_of_materials_and_cut_outs_are_marked() {
    let mut model = embedded::cube();
    model.materials.push(Material { alpha_mode: AlphaMode::Mask { cutoff: 0.5 }, ..Material::default() });
    model.face_material[0] = 1;
    model.face_material[1] = 1;
    let contours = contours_of(
        &model,
        &ContourOptions { crease_angle_rad: 3.0, material_borders: true, ..ContourOptions::default() },
    );
    // The four edges around one side; none of them lies between two cut-out faces.
    assert_eq!(contours.always, 4);
    assert!(contours.edges[..4].iter().all(|edge| edge.own_kind() == LineKind::MaterialBorder));
    model.face_material.fill(1);
    let contours = contours_of(&model, &ContourOptions::default());
    assert!(contours.edges.iter().all(ContourEdge::is_cut_out));
}

#[test]
fn empty_arrays_mean_that_faces_have_no_polygon_and_no_material() {
    let mut model = embedded::cube();
    // A material that no face has cuts nothing out.
    model.materials = vec![Material { alpha_mode: AlphaMode::Mask { cutoff: 0.5 }, ..Material::default() }];
    model.face_material.clear();
    let contours = contours_of(&model, &ContourOptions { material_borders: true, ..ContourOptions::default() });
    assert_eq!(contours.always, 12);
    assert!(!contours.edges.iter().any(ContourEdge::is_cut_out));
    // The diagonals of the six sides are edges then, which are no creases, and as both faces are in one plane no
    // silhouettes: they have no record.
    model.face_polygon.clear();
    let edges = edges_of(&model);
    assert_eq!(edges.edges.len(), 18);
    let contours = contours_of(&model, &ContourOptions::default());
    assert_eq!((contours.always, contours.edges.len()), (12, 12));
    let bare = Model { positions: model.positions, faces: model.faces, ..Model::default() };
    assert_eq!(contours_of(&bare, &ContourOptions::default()), contours);
}

#[test]
fn an_edge_of_three_faces_is_a_line_for_every_eye() {
    let mut model = ridge_with_sliver(0.5);
    model.positions.push(Vec3::new(0.0, 1.0, 0.0));
    model.normals.push(Vec3::Z);
    model.faces = vec![[0, 3, 1], [1, 4, 0], [0, 1, 5]];
    model.face_material = vec![0; 3];
    let contours = contours_of(&model, &NO_CREASES);
    for direction in crate::normal_format::fibonacci_sphere(50) {
        let mut lines = Vec::new();
        contours.scan(point(4.0 * direction), &mut lines);
        assert!(lines.iter().any(|&line| contours.edges[line as usize].ends.iter().all(|&v| v < 2)));
        assert_eq!(lines.len(), 7);
    }
}

#[test]
fn invalid_angles_and_widths_are_refused() {
    let model = embedded::cube();
    let edges = edges_of(&model);
    for angle_rad in [-0.1, 3.2, f32::NAN, f32::INFINITY] {
        let error = contour_edges(&model, &edges, &smooth(angle_rad)).unwrap_err();
        assert!(matches!(error, OutlineError::CreaseAngle { .. }));
    }
    assert!(contour_edges(&model, &edges, &smooth(0.0)).is_ok());
    let look = |width| crate::line_style::LineStyle { width_px: [1.0, 0.0, width, 2.0, 0.0], ink: [0.0; 4] };
    for width in [-1.0, f32::NAN, f32::INFINITY] {
        assert!(matches!(look(width).validate(), Err(OutlineError::Width { .. })));
    }
    assert!(look(0.0).validate().is_ok());
    let empty = contours_of(&Model::default(), &ContourOptions::default());
    let mut lines = Vec::new();
    empty.scan(DVec4::W, &mut lines);
    assert!(lines.is_empty());
}

/// Chains of slivers and polygons of many corners take a time that grows with their number, not with its square.
#[test]
fn long_chains_and_large_polygons_end() {
    let count = 100_000u32;
    let start = std::time::Instant::now();
    let on_a_line = |i: u32| Vec3::new(i as f32 * 1e-3, 0.0, 0.0);
    let chain = Model {
        positions: (0..count).map(on_a_line).chain([Vec3::Y, Vec3::Y + Vec3::X]).collect(),
        faces: (0..count - 2).map(|i| [i, i + 1, i + 2]).chain([[0, 1, count]]).collect(),
        face_material: vec![0; count as usize - 1],
        materials: vec![Default::default()],
        ..Default::default()
    };
    let contours = contours_of(&chain, &NO_CREASES);
    assert!(contours.planes.iter().flatten().all(|x| x.is_finite()));
    let around = |i: u32| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(count);
        DVec3::new(angle.cos(), angle.sin(), 0.0).as_vec3()
    };
    let polygon = Model {
        positions: (0..count).map(around).collect(),
        faces: (1..count - 1).map(|i| [0, i, i + 1]).collect(),
        face_material: vec![0; count as usize - 2],
        face_polygon: vec![0; count as usize - 2],
        materials: vec![Default::default()],
        ..Default::default()
    };
    assert_eq!(contours_of(&polygon, &NO_CREASES).edges.len(), count as usize);
    // Quadratic algorithms took more than a minute for each.
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}

/// A coordinate of any size and sign, often one of a few, so that corners coincide and are collinear.
fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        (-2i8..3).prop_map(f32::from),
        -1.0..1.0f32,
        prop_oneof![Just(1e-30f32), Just(-1e-20), Just(1e18), Just(-1e10), Just(1e-40)],
    ]
}

proptest! {
    /// For any set of triangles and any eye: no NaN, all indices within their arrays, and a scan that agrees with the
    /// test of each record.
    #[test]
    fn records_of_any_triangles_are_finite_and_within_bounds(
        corners in prop::collection::vec([coordinate(), coordinate(), coordinate()], 3..12),
        faces in prop::collection::vec(([0usize..12, 0usize..12, 0usize..12], 0u32..2, any::<bool>()), 1..40),
        crease_angle_rad in 0.0..std::f32::consts::PI,
        material_borders: bool,
        eye in [coordinate(), coordinate(), coordinate()],
        parallel: bool,
    ) {
        let mut polygon = 0;
        let model = Model {
            positions: corners.iter().copied().map(Vec3::from).collect(),
            faces: faces.iter().map(|(face, ..)| face.map(|v| (v % corners.len()) as u32)).collect(),
            face_material: faces.iter().map(|&(_, material, _)| material).collect(),
            face_polygon: faces.iter().map(|&(.., begins)| { polygon += u32::from(begins); polygon }).collect(),
            materials: vec![Default::default(); 2],
            ..Default::default()
        };
        let options = ContourOptions { crease_angle_rad, material_borders, ..ContourOptions::default() };
        let contours = contours_of(&model, &options);
        let count = contours.edges.len();
        prop_assert!(count <= 3 * model.faces.len());
        prop_assert_eq!(contours.planes.len(), model.faces.len());
        prop_assert!(contours.always <= count);
        prop_assert!(contours.origin.is_finite());
        for edge in 0..count {
            let planes = contours.edge_planes(edge);
            for plane in [planes.plane0, planes.plane1] {
                prop_assert!(plane.iter().all(|x| x.is_finite()), "{plane:?}");
                let length = Vec3::new(plane[0], plane[1], plane[2]).length();
                prop_assert!(length == 0.0 || (length - 1.0).abs() < 1e-5, "a normal of length {length}");
            }
            prop_assert!(contours.edges[edge].ends.iter().all(|&v| (v as usize) < model.positions.len()));
            prop_assert!((contours.edges[edge].faces()[0] as usize) < model.faces.len());
        }
        let eye = DVec3::from(eye.map(f64::from)).extend(if parallel { 0.0 } else { 1.0 });
        let local = contours.local_eye(eye);
        let mut lines = Vec::new();
        contours.scan(eye, &mut lines);
        prop_assert!(lines.is_sorted() && lines.last().is_none_or(|&last| (last as usize) < count));
        for edge in 0..count {
            let said = contours.kind(edge, local).is_some();
            prop_assert_eq!(said, lines.contains(&(edge as u32)), "edge {}", edge);
        }
    }
}

proptest! {
    #[test]
    fn records_agree_with_the_classification_from_corners(eye in prop::array::uniform3(-8.0..8.0f64)) {
        let model = embedded::torus(1.0, 0.4, 20, 10);
        let edges = edges_of(&model);
        let contours = contours_of(&model, &NO_CREASES);
        let eye = point(DVec3::from_array(eye));
        let lines = lines_of_kind(&contours, eye, LineKind::Silhouette);
        for edge in &edges.edges {
            let sides = edge.faces().map(|face| facing_exact(model.faces[face as usize].map(|v| model.positions[v as usize]), eye));
            // Doubled areas are 0.02 and more: f32 planes err by less than this.
            if sides.iter().all(|side| side.abs() > 1e-6) {
                prop_assert_eq!(lines.contains(&sorted(edge.ends)), (sides[0] > 0.0) != (sides[1] > 0.0));
            }
        }
    }
}

#[test]
fn a_face_wound_the_other_way_and_seen_edge_on_opens_no_loop() {
    for side in 0..6 {
        let mut model = embedded::cube();
        model.faces[2 * side..2 * side + 2].iter_mut().for_each(|face| face.swap(1, 2));
        let contours = contours_of(&model, &NO_CREASES);
        for x in [-1.0, 0.3, 1.0] {
            for y in [-1.0, 0.2, 1.0] {
                for eye in [DVec3::new(x, y, 7.0), DVec3::new(7.0, x, y), DVec3::new(x, -7.0, y)] {
                    assert!(all_loops_closed(&contours, point(eye)), "{side} {eye}");
                    assert!(lines_of_kind(&contours, point(eye), LineKind::Silhouette).len() >= 4);
                }
            }
        }
    }
    // All faces of a surface at random, the first among them.
    let mut model = embedded::torus(1.0, 0.4, 24, 12);
    model.faces.iter_mut().enumerate().filter(|(i, _)| i * i % 7 < 2).for_each(|(_, face)| face.swap(1, 2));
    let contours = contours_of(&model, &NO_CREASES);
    for face in &model.faces {
        let [a, b, c] = face.map(|v| model.positions[v as usize].as_dvec3());
        for eye in [a, 0.5 * (a + b), (a + b + c) / 3.0, a + 3.0 * (b - a)] {
            assert!(all_loops_closed(&contours, point(eye)), "{eye}");
        }
    }
}

#[test]
fn a_non_orientable_surface_keeps_its_lines() {
    // A Möbius band: 24 quads, of which the last is joined to the first upside down.
    let steps = 24u32;
    let point_at = |i: u32, edge: f32| {
        let angle = std::f32::consts::TAU * i as f32 / steps as f32;
        let radius = 1.0 + edge * 0.3 * (0.5 * angle).cos();
        Vec3::new(radius * angle.cos(), edge * 0.3 * (0.5 * angle).sin(), radius * angle.sin())
    };
    let positions: Vec<Vec3> = (0..steps).flat_map(|i| [point_at(i, -1.0), point_at(i, 1.0)]).collect();
    let mut faces = Vec::new();
    for i in 0..steps {
        let [a, b] = [2 * i, 2 * i + 1];
        let [c, d] = if i + 1 < steps { [a + 2, b + 2] } else { [1, 0] };
        faces.extend([[a, c, d], [a, d, b]]);
    }
    let model = Model {
        normals: vec![Vec3::Y; positions.len()],
        face_material: vec![0; faces.len()],
        materials: vec![Material::default()],
        positions,
        faces,
        ..Model::default()
    };
    let edges = edges_of(&model);
    assert!(edges.edges.iter().any(|edge| edge.wound_oppositely()));
    let contours = contours_of(&model, &NO_CREASES);
    for direction in crate::normal_format::fibonacci_sphere(100) {
        let eye = point(4.0 * direction);
        let lines = lines_of_kind(&contours, eye, LineKind::Silhouette);
        for edge in edges.edges.iter().filter(|edge| edge.kind() == EdgeKind::TwoFace) {
            let sides = edge
                .faces()
                .map(|face| facing_exact(model.faces[face as usize].map(|v| model.positions[v as usize]), eye) >= 0.0);
            let expected = (sides[0] != sides[1]) != edge.wound_oppositely();
            assert_eq!(lines.contains(&sorted(edge.ends)), expected);
        }
    }
}

/// A roof of 2 · atan(1 / 2) = 53°, and of 2 · atan(1 / 8) = 14° where it is four times as wide.
#[test]
fn angles_of_a_placed_model_are_those_of_its_shape() {
    let model = Model {
        positions: [[-2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 1.0]].map(Vec3::from).to_vec(),
        normals: vec![Vec3::Y; 4],
        faces: vec![[0, 3, 1], [1, 3, 2]],
        ..Model::default()
    };
    let creases = |matrix: DMat3| {
        let world_from_normal = matrix.inverse().transpose();
        let options = ContourOptions { world_from_normal, ..smooth(40f32.to_radians()) };
        let contours = contours_of(&model, &options);
        contours.edges.iter().filter(|edge| edge.own_kind() == LineKind::Crease).count()
    };
    let scale = |x: f64, y: f64, z: f64| DMat3::from_diagonal(DVec3::new(x, y, z));
    assert_eq!(creases(DMat3::IDENTITY), 1);
    assert_eq!(creases(scale(4.0, 1.0, 1.0)), 0);
    assert_eq!(creases(scale(-3.0, -3.0, 3.0)), 1);
    assert_eq!(creases(DMat3::from_rotation_y(1.0) * scale(1.0, 1.0, 50.0)), 1);
    // Sheared along the ridge the angle is another, but not much.
    assert_eq!(creases(DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(0.1, 0.0, 1.0))), 1);
}

/// A flat square of which one half has a vertex in the middle of the diagonal, with a face without area there. However
/// that face is wound, it has the plane of its neighbours, and the square has no line but its boundary.
#[test]
fn a_face_without_area_has_the_plane_of_its_neighbour_however_it_is_wound() {
    let positions = [[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, -1.0]];
    for sliver in [[1, 0, 2], [0, 1, 2]] {
        let model = Model {
            positions: positions.map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec(),
            normals: vec![Vec3::Z; 5],
            faces: vec![[0, 1, 3], sliver, [2, 0, 4], [1, 2, 4]],
            ..Model::default()
        };
        let contours = contours_of(&model, &smooth(0.5));
        let mut lines = Vec::new();
        for eye in [DVec4::new(0.3, 0.2, 5.0, 1.0), DVec4::new(0.3, 0.2, -5.0, 1.0)] {
            contours.scan(eye, &mut lines);
            let kinds: Vec<_> = lines.iter().map(|&l| contours.kind(l as usize, contours.local_eye(eye))).collect();
            assert_eq!(kinds, [Some(LineKind::Boundary); 4], "{sliver:?}");
        }
    }
}

#[test]
fn the_largest_buffer_is_that_of_planes_edges_or_positions() {
    let cube = embedded::cube();
    let contours = contours_of(&cube, &ContourOptions::default());
    // Twelve faces, twelve edges, 24 vertices.
    assert_eq!(contours.device_bytes(&cube.positions), 12 * 24);
    assert_eq!(contours.device_bytes(&[]), 16 * 12);
}

#[test]
fn edges_that_can_be_no_line_that_is_drawn_have_no_record() {
    let open = {
        let mut model = embedded::cube();
        // Without two of the sides, which are neighbours.
        model.faces.drain(..2);
        model.faces.drain(2..4);
        for of_faces in [&mut model.face_material, &mut model.face_polygon] {
            of_faces.drain(..2);
            of_faces.drain(2..4);
        }
        model
    };
    let all = ContourOptions::default();
    let counts = |options: ContourOptions| {
        let contours = contours_of(&open, &options);
        let of_kind = |kind| contours.edges.iter().filter(|edge| edge.own_kind() == kind).count();
        assert!(contours.edges[..contours.always].iter().all(ContourEdge::is_always));
        assert!(!contours.edges[contours.always..].iter().any(ContourEdge::is_always));
        LineKind::ALL.map(of_kind)
    };
    // Of twelve edges one is between the two missing sides; six bound what is left, and five are creases.
    assert_eq!(counts(all), [0, 6, 5, 0, 0]);
    assert_eq!(counts(ContourOptions { creases: false, ..all }), [5, 6, 0, 0, 0]);
    assert_eq!(counts(ContourOptions { boundaries: false, ..all }), [0, 0, 5, 0, 0]);
    assert_eq!(counts(ContourOptions { creases: false, silhouettes: false, ..all }), [0, 6, 0, 0, 0]);
    assert_eq!(counts(ContourOptions { silhouettes: false, ..all }), [0, 6, 5, 0, 0]);
    assert_eq!(
        counts(ContourOptions { creases: false, boundaries: false, silhouettes: false, ..all }),
        [0; 5],
        "no line is drawn"
    );
}

/// Of single-sided faces an edge is a line only where one of them is seen from the front, however they are wound.
#[test]
fn edges_without_a_face_that_is_shown_are_no_lines() {
    let outward = embedded::cube();
    let mut inward = embedded::cube();
    inward.faces.iter_mut().for_each(|face| face.swap(1, 2));
    // The polygon of the first two faces has the opposite winding.
    let mut mixed = embedded::cube();
    mixed.faces[..2].iter_mut().for_each(|face| face.swap(1, 2));
    for (name, model) in [("outward", outward), ("inward", inward), ("mixed", mixed)] {
        let of_sides =
            |double_sided| contours_of(&model, &ContourOptions { double_sided, ..ContourOptions::default() });
        let (single, double) = (of_sides(Some(false)), of_sides(Some(true)));
        assert!(single.single_sided && !double.single_sided && double == of_sides(None));
        // An eye that faces one side of the inward cube has all of its edges beside a face that is shown.
        let mut fewer = 0;
        for eye in crate::normal_format::fibonacci_sphere(40).map(|direction| point(direction * 6.0)) {
            let is_shown =
                |face: u32| facing_exact(model.faces[face as usize].map(|v| model.positions[v as usize]), eye) >= 0.0;
            let (mut found, mut all) = (Vec::new(), Vec::new());
            single.scan(eye, &mut found);
            double.scan(eye, &mut all);
            let expected: Vec<u32> = all
                .iter()
                .copied()
                .filter(|&line| double.edges[line as usize].faces().into_iter().any(is_shown))
                .collect();
            assert_eq!(found, expected, "{name}");
            fewer += usize::from(found.len() < all.len());
            let local = single.local_eye(eye);
            for line in all {
                assert_eq!(single.kind(line as usize, local).is_some(), expected.contains(&line), "{name}");
            }
        }
        assert!(fewer >= 20, "{name}: {fewer}");
    }
}

/// A single-sided face with a duplicate of the opposite winding is shown from both sides.
#[test]
fn back_to_back_faces_are_shown_from_both_sides() {
    let square = vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
    let count = |faces: Vec<[u32; 3]>, eye: DVec3| {
        let model = Model { positions: square.clone(), faces, ..Model::default() };
        let options = ContourOptions { double_sided: Some(false), ..ContourOptions::default() };
        let mut lines = Vec::new();
        contours_of(&model, &options).scan(point(eye), &mut lines);
        lines.len()
    };
    let (front, back) = (DVec3::new(0.4, 0.4, 5.0), DVec3::new(0.4, 0.4, -5.0));
    let one = vec![[0, 1, 2], [0, 2, 3]];
    assert_eq!((count(one.clone(), front), count(one.clone(), back)), (4, 0));
    let two: Vec<_> = one.into_iter().chain([[0, 2, 1], [0, 3, 2]]).collect();
    assert_eq!((count(two.clone(), front), count(two, back)), (4, 4));
}
