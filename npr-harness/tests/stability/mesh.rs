//! Limits of meshes.

use super::{holds, near_prediction};

#[test]
fn positions_in_f32_are_displaced_by_half_a_px_50_000_sizes_from_the_origin_and_nodes_in_f64_at_10_to_the_12() {
    let found = holds("model-offset", &["positions in f32", "a node in f64"]).expect("on the CPU");
    near_prediction(&found, "positions in f32", 1.5);
    near_prediction(&found, "a node in f64", 3.0);
}

#[test]
fn of_faces_in_one_plane_no_pixel_shows_the_other() {
    let curves = ["cut along the same diagonal", "cut along the other diagonal", "a mark on a sheet", "back to back"];
    holds("coincident-faces", &curves);
}

#[test]
fn executors_show_the_same_of_faces_in_one_plane() {
    let curves = ["cut along the same diagonal", "cut along the other diagonal", "a mark on a sheet", "back to back"];
    holds("coincident-faces-executors", &curves);
}

#[test]
fn seams_with_t_junctions_are_not_drawn_and_as_they_are_in_the_file_they_are_open() {
    let curves = ["lines from edges", "edges as they are in the file"];
    let found = holds("t-junctions", &curves).expect("on the CPU");
    near_prediction(&found, curves[1], 1.01);
}

#[test]
fn seams_open_at_a_gap_of_the_tolerance_and_exactly_welded_ones_at_any_gap() {
    let curves = ["within a tolerance", "within rounding, as for drawing", "exactly"];
    let found = holds("weld-seams", &curves).expect("on the CPU");
    for method in curves {
        near_prediction(&found, method, 1.02);
    }
}

#[test]
fn welding_destroys_plates_thinner_than_the_tolerance() {
    let found = holds("weld-plates", &["a flat box"]).expect("on the CPU");
    near_prediction(&found, "a flat box", 1.02);
}

#[test]
fn opposite_windings_misjudge_no_edge_by_the_rule_and_half_of_them_without_it() {
    let curves = ["by the rule", "by each face's own winding"];
    let found = holds("opposite-windings", &curves).expect("on the CPU");
    near_prediction(&found, curves[1], 1.05);
}

#[test]
fn faces_without_area_change_nothing_and_thin_ones_take_creases_away() {
    let curves = ["two equal corners", "three points nearly on a line"];
    let found = holds("zero-area-faces", &curves).expect("on the CPU");
    near_prediction(&found, curves[1], 1.1);
}
