use super::*;

/// A line that is transported over an edge keeps its angle to the edge. A projected line would not.
#[test]
fn a_line_keeps_its_angle_to_the_edge() {
    let from = Tangent::new(Vec3::Y);
    let known = Vec3::new(0.6, 0.0, 0.8);
    let value = Value { scalar: 1.0, line: from.line(known) };
    for angle in [-1.2_f32, -0.4, 0.0, 0.9, 1.6] {
        let normal = Vec3::new(0.0, angle.cos(), angle.sin());
        let found = at_vertex(Some((&from, value)), normal, Vec3::X);
        let expected = Vec3::new(0.6, -angle.sin() * 0.8, angle.cos() * 0.8);
        assert!(found.dot(expected).abs() > 1.0 - 1e-6, "{angle}: {found}, {expected}");
    }
    // The opposite normal has the same plane.
    let found = at_vertex(Some((&from, value)), Vec3::NEG_Y, Vec3::X);
    assert!(found.dot(known).abs() > 1.0 - 1e-6, "{found}");
}

#[test]
fn lines_and_directions_are_inverse() {
    let tangent = Tangent::new(Vec3::new(1.0, -2.0, 0.5).normalize());
    for i in 0..720 {
        let (sin, cos) = (i as f32).to_radians().sin_cos();
        let direction = tangent.u * cos + tangent.v * sin;
        let back = tangent.direction(tangent.line(direction) * 0.01).unwrap();
        assert!(back.dot(direction).abs() > 1.0 - 1e-6, "{i}: {back}, {direction}");
    }
    assert_eq!(tangent.direction(Vec2::ZERO), None);
}
