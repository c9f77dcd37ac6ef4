//! Limits of shadows.

use super::{holds, measured, near_prediction};

#[test]
fn volumes_counted_in_front_of_the_surface_fail_as_soon_as_the_eye_is_in_shadow_and_those_behind_it_never() {
    let curves = ["counted in front of the surface", "counted behind it"];
    let found = holds("shadow-eye-inside", &curves).expect("on the CPU");
    // The prediction is the shadow's side, 0; the positions that are tried are 0.01 before and behind it.
    assert!(measured(&found, curves[0]).abs() <= 0.01);
}

#[test]
fn volumes_of_lights_at_any_distance_are_right() {
    holds("shadow-light-distance", &["volumes"]);
}

#[test]
fn volumes_from_the_contour_leak_through_holes_that_reach_it_and_those_of_every_face_do_not() {
    let found = holds("shadow-open-mesh", &["every face casts", "sides from the contour"]).expect("on the CPU");
    near_prediction(&found, "sides from the contour", 1.2);
}

#[test]
fn shadow_maps_are_as_wrong_as_their_texels_are_large() {
    if let Some(found) = holds("shadow-map-resolution", &["shadow map", "volumes"]) {
        near_prediction(&found, "shadow map", 1.4);
    }
}

#[test]
fn shadow_maps_lose_gaps_narrower_than_a_texel() {
    if let Some(found) = holds("shadow-map-gaps", &["shadow map"]) {
        near_prediction(&found, "shadow map", 1.15);
    }
}

#[test]
fn shadow_maps_detach_shadows_by_three_quarters_of_a_texel_under_a_light_at_45_degrees() {
    if let Some(found) = holds("shadow-map-bias", &["shadow map", "volumes"]) {
        near_prediction(&found, "shadow map", 1.3);
    }
}

#[test]
fn shadow_maps_of_128_texels_end_a_shadow_a_tenth_of_its_length_off_under_a_light_at_9_degrees() {
    if let Some(found) = holds("shadow-grazing-light", &["shadow map of 128 texels", "volumes"]) {
        near_prediction(&found, "shadow map of 128 texels", 2.0);
    }
}
