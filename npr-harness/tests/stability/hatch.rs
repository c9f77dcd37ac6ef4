//! Limits of hatching.

use super::{holds, near_prediction};

#[test]
fn weights_at_vertices_darken_spheres_by_a_hundredth_below_28_segments() {
    let found = holds("hatch-vertex-weights", &["at vertices", "at pixels"]).expect("on the CPU");
    near_prediction(&found, "at vertices", 1.05);
}

#[test]
fn six_tones_show_black_as_their_darkest_tone_and_thresholds_show_every_tone() {
    let found = holds("hatch-extreme-tones", &["six tones", "thresholds"]).expect("on the CPU");
    near_prediction(&found, "six tones", 1.02);
}

#[test]
fn hatching_keeps_its_tone_at_any_distance() {
    holds("hatch-minification-tone", &["six tones", "thresholds"]);
}

#[test]
fn strokes_give_way_to_flat_tones_where_a_map_covers_8_px() {
    let found = holds("hatch-minification-strokes", &["six tones", "thresholds"]).expect("on the CPU");
    for encoding in ["six tones", "thresholds"] {
        near_prediction(&found, encoding, 1.03);
    }
}

#[test]
fn strokes_are_twice_as_wide_where_texels_cover_2_px() {
    let found = holds("hatch-magnification", &["six tones", "thresholds"]).expect("on the CPU");
    for encoding in ["six tones", "thresholds"] {
        near_prediction(&found, encoding, 1.15);
    }
}

#[test]
fn thresholds_of_small_levels_have_tones_to_half_a_texel_and_six_tones_are_exact() {
    let found = holds("hatch-map-tones", &["six tones", "thresholds"]).expect("on the CPU");
    near_prediction(&found, "thresholds", 1.1);
}

#[test]
fn directions_of_strokes_are_lost_on_spheroids_less_than_8_percent_longer_than_wide() {
    holds("hatch-direction", &["24 segments", "64 segments"]);
}
