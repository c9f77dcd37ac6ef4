//! Limits of bands and tones of light.

use super::{holds, near_prediction};

#[test]
fn hard_borders_flicker_by_nearly_twice_their_motion_and_antialiased_ones_by_a_tenth_of_it() {
    let found = holds("band-edge-flicker", &["hard", "antialiased", "antialiased, 2 × 2 samples"]).expect("on the CPU");
    near_prediction(&found, "hard", 1.02);
}

#[test]
fn bands_of_light_per_face_at_vertices_and_at_pixels_leave_their_border_by_a_px_below_272_22_and_16_segments() {
    let found = holds("vertex-light-bands", &["per face", "at vertices", "at pixels"]).expect("on the CPU");
    for method in ["per face", "at vertices", "at pixels"] {
        near_prediction(&found, method, 1.05);
    }
}

#[test]
fn smooth_tones_per_face_at_vertices_and_at_pixels_are_off_by_4_of_255_below_160_23_and_18_segments() {
    let found = holds("vertex-light-tones", &["per face", "at vertices", "at pixels"]).expect("on the CPU");
    for method in ["per face", "at vertices", "at pixels"] {
        near_prediction(&found, method, 1.05);
    }
}

#[test]
fn highlights_of_light_at_vertices_vanish_between_vertices() {
    let found = holds("vertex-light-highlight", &["at vertices", "at pixels"]).expect("on the CPU");
    near_prediction(&found, "at vertices", 1.08);
}

#[test]
fn terminators_of_coarse_spheres_have_teeth_of_up_to_half_a_cells_diagonal() {
    let curves = ["normals negated in shadow", "shadow states of lines"];
    let found = holds("terminator-teeth", &curves).expect("on the CPU");
    for method in curves {
        near_prediction(&found, method, 1.5);
    }
}
