use super::*;
use glam::dcamera::rh::proj::directx as proj;
use glam::dcamera::rh::view::look_at_mat4;
use npr_mesh::edges::{Edge, EdgeKind, EdgeOptions, find};
use npr_mesh::embedded;
use std::collections::HashSet;

const NEAR: f64 = 0.5;
const FAR: f64 = 100.0;

fn edges_of(model: &Model) -> Edges {
    find(&model.positions, &model.faces, &model.face_polygon, &model.face_material, &EdgeOptions::default())
}

/// Reversed z with a finite far plane, looking from `eye` at the origin.
fn view(eye: DVec3, depth: FinDepth) -> FinView {
    let clip_from_view = proj::perspective(1.0, 1.0, FAR, NEAR);
    let clip_from_world = clip_from_view * look_at_mat4(eye, DVec3::ZERO, DVec3::Y);
    FinView { clip_from_world, eye, thickness: 0.01, depth, reversed: false }
}

#[test]
fn a_cube_has_four_vertices_and_two_triangles_an_edge() {
    let model = embedded::cube();
    let fins = printed_fins(&model, &edges_of(&model));
    assert_eq!((fins.vertices.len(), fins.indices.len()), (48, 72));
    for fin in fins.vertices.chunks_exact(4) {
        assert_eq!([fin[0].smooth_normal, fin[1].smooth_normal], [Vec3::ZERO; 2]);
        for (stuck, displaced) in [(fin[0], fin[3]), (fin[1], fin[2])] {
            assert_eq!(stuck.position, displaced.position);
            assert!(displaced.smooth_normal.distance(displaced.position.normalize()) < 1e-6);
        }
    }
    assert!(fins.indices.iter().all(|&i| (i as usize) < fins.vertices.len()));
}

#[test]
fn a_boundary_has_the_negated_normal() {
    let model = embedded::ground(2.0);
    let edges = edges_of(&model);
    let fins = printed_fins(&model, &edges);
    for (edge, fin) in edges.edges.iter().zip(fins.vertices.chunks_exact(4)) {
        assert_eq!(edge.kind(), EdgeKind::Boundary);
        assert!(fin.iter().all(|vertex| vertex.n_face0 == Vec3::Y && vertex.n_face1 == Vec3::NEG_Y));
    }
}

#[test]
fn the_listing_draws_silhouettes_and_neither_creases_nor_edges_seen_edge_on() {
    let model = embedded::cube();
    let edges = edges_of(&model);
    let fins = printed_fins(&model, &edges);
    let drawn = |eye| fin_printed_triangles(&fins, &view(eye, FinDepth::Eye)).len();
    // From a corner: six silhouettes of two triangles each; the three creases towards the eye are not drawn.
    assert_eq!(drawn(DVec3::new(5.0, 6.0, 7.0)), 12);
    // In the planes of two faces, seen edge-on: all products with them are 0, and of the six silhouettes only the two
    // between the front and the far sides are left.
    let eye = DVec3::new(1.0, 1.0, 6.0);
    let flags: f64 = fins
        .vertices
        .iter()
        .map(|v| fin_printed_flag(v.position.as_dvec3(), v.n_face0.as_dvec3(), v.n_face1.as_dvec3(), eye, false))
        .sum();
    let by_hand = |edge: &Edge| {
        let side = |face: u32| {
            let normal = edges.face_normals[face as usize].as_dvec3();
            normal.dot(eye) - 1.0
        };
        side(edge.faces()[0]) * side(edge.faces()[1]) < 0.0
    };
    let silhouettes = edges.edges.iter().filter(|edge| by_hand(edge)).count();
    assert_eq!(silhouettes, 2, "with faces seen edge-on, two of six are left");
    assert_eq!(flags, 4.0 * silhouettes as f64);
}

#[test]
fn depth_as_printed_is_clip_z_of_a_direct3d_projection() {
    let printed = FinDepth::Printed { near: NEAR, far: FAR };
    // z of the matrix that D3DXMatrixPerspectiveFovLH documents: zf / (zf - zn) * z - zn * zf / (zf - zn).
    for w in [0.5, 1.0, 7.0, 100.0] {
        let z = FAR / (FAR - NEAR) * w - NEAR * FAR / (FAR - NEAR);
        assert!((fin_printed_depth(w, printed) - z).abs() < 1e-12);
        assert_eq!(fin_printed_depth(w, FinDepth::Eye), w);
    }
    assert_eq!(fin_printed_depth(NEAR, printed), 0.0);
    assert!((fin_printed_depth(FAR, printed) - FAR).abs() < 1e-9);
}

#[test]
fn width_is_as_asked_with_w_and_too_small_as_printed() {
    let fin = |distance: f32| PrintedFin {
        position: Vec3::new(0.0, 0.0, -distance),
        smooth_normal: Vec3::X,
        n_face0: Vec3::Z,
        n_face1: Vec3::NEG_Z,
    };
    let height_px = 480.0;
    let mut view = view(DVec3::ZERO, FinDepth::Eye);
    view.clip_from_world = proj::perspective(1.0, 1.0, FAR, NEAR);
    view.thickness = 3.0 * 2.0 * (0.5f64).tan() / height_px;
    for distance in [0.6, 1.0, 5.0, 50.0] {
        let width_px = |view: &FinView| {
            let clip = fin_printed_vertex(&fin(distance), view);
            0.5 * clip.x / clip.w * height_px
        };
        assert!((width_px(&view) - 3.0).abs() < 1e-9);
        let printed = width_px(&FinView { depth: FinDepth::Printed { near: NEAR, far: FAR }, ..view });
        let ratio = FAR / (FAR - NEAR) * (1.0 - NEAR / f64::from(distance));
        assert!((printed / 3.0 - ratio).abs() < 1e-9, "{distance}: {printed}");
    }
}

#[test]
fn a_face_wound_the_other_way_keeps_its_fins() {
    let model = embedded::sphere(16);
    let mut flipped = model.clone();
    flipped.faces.iter_mut().step_by(10).for_each(|face| face.swap(1, 2));
    let count = |model: &Model| {
        let fins = printed_fins(model, &edges_of(model));
        fin_printed_triangles(&fins, &view(DVec3::new(2.0, 1.5, 3.0), FinDepth::Eye)).len()
    };
    assert!(count(&model) > 20);
    assert_eq!(count(&model), count(&flipped));
}

fn pixels(triangles: &[[DVec4; 3]], size: u32) -> Vec<(u32, u32)> {
    let mut visited = Vec::new();
    rasterise(triangles, [size, size], |_, _| 0.0, |x, y| visited.push((x, y)));
    visited
}

#[test]
fn two_triangles_share_their_border_without_gap_or_overlap() {
    let at = |x: f64, y: f64| DVec4::new(x, y, 0.5, 1.0);
    // Corners on pixel centres of an 8 × 8 picture, so that borders run through centres.
    let (low, high) = (-0.875, 0.625);
    let [a, b, c, d] = [at(low, low), at(high, low), at(high, high), at(low, high)];
    for triangles in [[[a, b, c], [a, c, d]], [[a, c, b], [d, c, a]], [[b, c, d], [b, d, a]]] {
        let visited = pixels(&triangles, 8);
        assert_eq!(visited.iter().collect::<HashSet<_>>().len(), visited.len(), "overlap");
        assert_eq!(visited.len(), 36);
        // y = 0.625 is the centre of row 1 and is a top border; y = -0.875 that of row 7 and a bottom one.
        assert!(visited.contains(&(0, 1)) && !visited.contains(&(0, 7)) && !visited.contains(&(6, 1)));
    }
}

#[test]
fn triangles_are_cut_at_the_near_plane_and_by_the_scene() {
    let clip_from_world = proj::perspective(1.0, 1.0, FAR, NEAR);
    // A floor that runs from behind the eye into the distance.
    let at = |x: f64, z: f64| clip_from_world * DVec4::new(x, -0.4, z, 1.0);
    let floor = [[at(-50.0, 5.0), at(50.0, 5.0), at(0.0, -60.0)]];
    let visited = pixels(&floor, 64);
    // The floor at the near plane: y = -0.4 at depth 0.5 is at 1.46 of the half height, below the picture.
    assert!(visited.iter().all(|&(_, y)| y >= 32) && visited.contains(&(32, 63)) && visited.contains(&(0, 63)));
    let depth_at_row = |y: u32| {
        let mut seen = 0;
        let ray = (f64::from(y) + 0.5) / 32.0 - 1.0;
        let depth = 0.4 / (ray * 0.5f64.tan());
        let clip = clip_from_world * DVec4::new(0.0, 0.0, -depth, 1.0);
        for (nudge, hits) in [(-1e-9, 1), (1e-9, 0)] {
            rasterise(
                &floor,
                [64, 64],
                |_, _| clip.z / clip.w + nudge,
                |x, row| seen += i32::from((x, row) == (32, y)),
            );
            assert_eq!(seen, hits, "row {y}");
            seen = 0;
        }
    };
    depth_at_row(40);
    depth_at_row(63);
    // Behind the eye altogether.
    assert!(pixels(&[[at(-1.0, 1.0), at(1.0, 1.0), at(0.0, 3.0)]], 64).is_empty());
}

/// Errata, offset: the text displaces exactly the fins that the listing does not.
#[test]
fn the_text_draws_all_but_the_silhouettes() {
    let model = embedded::cube();
    let fins = printed_fins(&model, &edges_of(&model));
    let listing = view(DVec3::new(5.0, 6.0, 7.0), FinDepth::Eye);
    let text = FinView { reversed: true, ..listing };
    let (drawn, rest) = (fin_printed_triangles(&fins, &listing), fin_printed_triangles(&fins, &text));
    assert_eq!((drawn.len(), rest.len()), (12, 12), "six silhouettes, and six edges that are none");
    assert!(drawn.iter().all(|triangle| !rest.contains(triangle)));
}
