//! Properties of the WGSL that hold in f32 arithmetic on a device.
#![cfg(feature = "wgpu")]

#[path = "../../npr-toon/tests/device/mod.rs"]
mod device;

use npr_hatch::WGSL;
use npr_hatch::glam::DVec2;
use npr_hatch::mapping::{HATCH_DIRECTIONS, hatch_direction_step};

/// Every direction has an index in 0..12: shaders use it to rotate and to offset a map, as Rust does.
#[test]
fn indices_of_directions_are_in_range_and_those_of_rust() {
    // Doubled angles in steps of 1/8 of the distance between directions, none of them at an integer, at 4 lengths.
    let doubled: Vec<_> = (0..8 * HATCH_DIRECTIONS)
        .flat_map(|i| [0.01_f32, 0.3, 1.0, 50.0].map(|length| (i, length)))
        .map(|(i, length)| {
            let angle = (i as f32 + 0.5) / (8 * HATCH_DIRECTIONS) as f32 * std::f32::consts::TAU;
            [length * angle.cos(), length * angle.sin(), 0.0, 0.0]
        })
        .collect();
    let expression = "vec4(f32(hatch_direction_step(a.xy).first), hatch_direction_step(a.xy).share, 0.0, 0.0)";
    let Some(found) = device::evaluate(WGSL, expression, &doubled) else { return };
    let mut seen = [false; HATCH_DIRECTIONS as usize];
    for ([x, y, ..], [first, share, ..]) in doubled.into_iter().zip(found) {
        let expected = hatch_direction_step(DVec2::new(f64::from(x), f64::from(y)));
        assert_eq!(first, expected.first as f32, "({x}, {y})");
        assert!((f64::from(share) - expected.share).abs() < 1e-4, "({x}, {y}): {share}, {}", expected.share);
        seen[first as usize] = true;
    }
    assert_eq!(seen, [true; HATCH_DIRECTIONS as usize]);
}
