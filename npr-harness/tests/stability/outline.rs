//! Limits of lines from edges, fins and hulls.

use super::{holds, near_prediction};

#[test]
fn rounded_normals_misjudge_edges_within_half_a_step_of_tangency() {
    let curves = ["f32", "i16", "i8", "octahedral 16", "octahedral 8"];
    let finding = holds("silhouette-normals", &curves).expect("no adapter is needed");
    // The worst case is an isolated direction that no sample meets exactly, and five roundings of f32 rarely all go one way.
    near_prediction(&finding, "f32", 4.0);
    for format in &curves[1..] {
        near_prediction(&finding, format, 1.3);
    }
}

#[test]
fn i8_normals_tear_a_tenth_of_the_fins_of_long_edges() {
    let finding = holds("torn-fins", &["f32", "i16", "i8", "octahedral 8"]).expect("no adapter is needed");
    near_prediction(&finding, "i8", 1.5);
}

#[test]
fn printed_fins_are_10_percent_too_thin_within_10_near_plane_distances() {
    let curves = ["fins as printed", "fins by eye depth", "edge lines", "inverted hull"];
    let finding = holds("line-width-distance", &curves).expect("no adapter is needed");
    near_prediction(&finding, "fins as printed", 1.15);
}

#[test]
fn printed_fins_of_boundaries_lose_half_their_width_60_degrees_towards_the_viewer() {
    let curves = ["fins as printed", "edge lines", "inverted hull"];
    let finding = holds("line-width-tilt", &curves).expect("no adapter is needed");
    near_prediction(&finding, "fins as printed", 1.05);
    near_prediction(&finding, "inverted hull", 1.1);
}

#[test]
fn fins_and_hulls_of_hard_edges_widen_when_an_end_is_behind_the_eye() {
    holds("near-plane-lines", &["edge lines", "fins as printed", "fins by eye depth", "inverted hull"]);
}

#[test]
fn hulls_of_split_normals_gape_at_corners_of_1_degree() {
    let finding = holds("hull-corners", &["normals of vertices", "welded normals"]).expect("no adapter is needed");
    near_prediction(&finding, "normals of vertices", 1.5);
    near_prediction(&finding, "welded normals", 1.15);
}

#[test]
fn image_lines_lose_bars_thinner_than_three_quarters_of_a_pixel() {
    let finding = holds("thin-bars", &["image lines", "edge lines", "inverted hull"]).expect("no adapter is needed");
    near_prediction(&finding, "image lines", 1.2);
}

#[test]
fn edge_lines_a_quarter_of_a_pixel_apart_are_three_quarters_too_pale() {
    let finding = holds("line-density", &["edge lines", "edge lines, 4 × 4 samples"]).expect("no adapter is needed");
    near_prediction(&finding, "edge lines", 1.05);
}

#[test]
fn contours_come_apart_from_noise_of_a_twelfth_of_an_edge() {
    let curves = ["more than 1.5 px off the contour", "in pieces under 6 px"];
    let finding = holds("contour-noise", &curves).expect("no adapter is needed");
    near_prediction(&finding, "more than 1.5 px off the contour", 1.5);
}

#[test]
fn lines_without_coverage_flicker_with_the_root_of_a_pan() {
    let curves = [
        "edge lines, 8 × 8 samples",
        "edge lines",
        "fins as printed",
        "inverted hull",
        "image lines",
        "image lines, soft",
        "printed filters",
    ];
    let finding = holds("line-flicker", &curves).expect("no adapter is needed");
    near_prediction(&finding, "edge lines, 8 × 8 samples", 1.2);
    for method in ["fins as printed", "inverted hull"] {
        near_prediction(&finding, method, 1.1);
    }
    // Their lines are one to two px wide, some of them three where surfaces curve away.
    for method in ["image lines", "printed filters"] {
        near_prediction(&finding, method, 1.7);
    }
}
