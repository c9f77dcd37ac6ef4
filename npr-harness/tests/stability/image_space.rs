//! Limits of lines found in the image.

use super::{holds, near_prediction};

#[test]
fn depth_of_8_bits_merges_gaps_of_4_near_distances_in_a_range_of_1000() {
    let formats = ["8 bits", "16 bits", "4 × 8 bits", "half float", "float", "14 bits of 1/z", "24 bits of 1/z"];
    let finding = holds("depth-gaps", &formats).expect("no adapter is needed");
    for format in formats {
        near_prediction(&finding, format, 1.3);
    }
}

#[test]
fn depth_of_16_bits_merges_gaps_of_1_percent_from_6500_near_distances_of_range_on() {
    let formats = ["8 bits", "16 bits", "4 × 8 bits", "half float", "float", "14 bits of 1/z", "24 bits of 1/z"];
    let finding = holds("depth-range", &formats).expect("no adapter is needed");
    for format in formats {
        near_prediction(&finding, format, 1.35);
    }
}

#[test]
fn normals_within_a_step_of_their_format_have_the_same_code() {
    let formats = ["3 × 8 bits", "octahedral 2 × 5", "octahedral 2 × 8", "octahedral 2 × 16", "half floats"];
    let finding = holds("normal-angles", &formats).expect("no adapter is needed");
    for format in formats {
        // The worst pairs lie at opposite corners of a cell in the middle of an octant, which few samples meet.
        near_prediction(&finding, format, 1.45);
    }
}

#[test]
fn first_differences_of_depth_ink_planes_below_15_degrees() {
    let tests = ["first differences of 1/z", "sum of 2002, corrected", "sum as printed", "second differences of 1/z"];
    let finding = holds("grazing-plane", &tests).expect("no adapter is needed");
    near_prediction(&finding, tests[0], 1.06);
    // Depths are rounded to 8 bits, whose step is nearly the change from row to row.
    near_prediction(&finding, tests[1], 1.1);
    near_prediction(&finding, tests[2], 1.1);
}

#[test]
fn tessellations_of_9_sides_become_lines_at_a_threshold_of_0_80() {
    let finding = holds("facets-become-lines", &["threshold 0.80", "threshold 0.85"]).expect("no adapter is needed");
    near_prediction(&finding, "threshold 0.80", 1.0);
    near_prediction(&finding, "threshold 0.85", 1.0);
}

#[test]
fn the_inker_fills_balls_of_less_than_23_px_radius_without_a_threshold_that_falls() {
    let cases = ["constant threshold 0.9", "0.9 − 0.25 depth, as printed", "the same, far plane four times as far"];
    let finding = holds("distant-ball", &cases).expect("no adapter is needed");
    for case in cases {
        near_prediction(&finding, case, 1.15);
    }
}

#[test]
fn image_lines_are_half_of_the_area_of_a_teapot_below_80_px() {
    let methods = ["image lines", "edge lines"];
    let finding = holds("model-size", &methods).expect("no adapter is needed");
    near_prediction(&finding, "image lines", 1.15);
    // Lines that are drawn over each other have less ink than their lengths.
    near_prediction(&finding, "edge lines", 1.5);
}

#[test]
fn surfaces_within_32_degrees_of_plus_z_have_no_border_on_a_background_cleared_to_it() {
    let cases = ["cleared to +z, as printed", "cleared to no normal"];
    let finding = holds("plus-z-background", &cases).expect("no adapter is needed");
    near_prediction(&finding, cases[0], 1.02);
}

#[test]
fn regions_by_sums_of_colours_are_equal_among_14_and_those_of_8_bits_among_256() {
    let codes = ["sums of colours, as printed", "8 bits, two for shadow", "8 bits", "24-bit hash of a pair", "24 bits"];
    let finding = holds("region-codes", &codes).expect("no adapter is needed");
    for code in codes {
        near_prediction(&finding, code, 1.25);
    }
}

#[test]
fn the_inker_with_its_instruction_added_inks_every_slope() {
    let forms = ["as printed, depth falling", "as printed, depth rising", "instruction added", "two thresholds"];
    let finding = holds("inker-slope", &forms).expect("no adapter is needed");
    // The slopes that are measured are 12 % apart.
    near_prediction(&finding, forms[0], 1.13);
    near_prediction(&finding, forms[3], 1.13);
}

#[test]
fn the_inker_as_printed_inks_flat_faces_nearer_than_0_033() {
    let finding =
        holds("inker-near", &["as printed", "instruction added", "two thresholds"]).expect("no adapter is needed");
    near_prediction(&finding, "as printed", 1.02);
    near_prediction(&finding, "instruction added", 1.02);
}

#[test]
fn artist_lines_rotated_per_object_vanish_within_7_radii() {
    let cases =
        ["for each object, threshold 0.80", "for each object, threshold 0.85", "for each pixel, threshold 0.80"];
    let finding = holds("artist-distance", &cases).expect("no adapter is needed");
    near_prediction(&finding, cases[0], 1.03);
    near_prediction(&finding, cases[1], 1.03);
}

#[test]
fn repeated_kernels_are_off_a_disc_by_a_third_of_its_area() {
    let kernels = ["3 × 3 steps", "+ steps", "diagonal steps", "disc"];
    let finding = holds("dilation-radius", &kernels).expect("no adapter is needed");
    for kernel in &kernels[..3] {
        near_prediction(&finding, kernel, 1.05);
    }
}
