//! Properties of the WGSL that hold in f32 arithmetic on a device.

#[path = "../../npr-toon/tests/device/mod.rs"]
mod device;

use glam::{Mat3, Vec3};
use npr_gooch::WGSL;

/// In the reflected direction the cosine is 1, not 1 less a rounding error, so that a steep highlight reaches its colour.
#[test]
fn the_centre_of_a_highlight_is_opaque_at_any_exponent() {
    // Lights above a surface with the normal +Z. The eye is in the reflected direction, exactly.
    let lights: Vec<_> = (0..500)
        .map(|i| {
            let tilt = Mat3::from_rotation_y(0.003 * i as f32);
            (Mat3::from_rotation_z(2.4 * i as f32) * tilt * Vec3::Z * (1.0 + 0.01 * i as f32)).extend(0.0).to_array()
        })
        .collect();
    let model = "GoochModel(vec4(0.0), vec4(0.0), vec4(1.0), 1e6, 0u, 0u, 0u)";
    let expression = format!(
        "vec4(gooch_r_dot_e(vec3(0.0, 0.0, 1.0), a.xyz, vec3(-a.xy, a.z)), gooch_shade({model}, vec3(0.0), \
         vec3(0.0, 0.0, 1.0), a.xyz, vec3(-a.xy, a.z)))"
    );
    let Some(found) = device::evaluate(WGSL, &expression, &lights) else { return };
    for (light, [r_dot_e, r, ..]) in lights.iter().zip(found) {
        assert!(r_dot_e == 1.0 && r > 0.999, "{light:?}: {r_dot_e}, {r}");
    }
}
