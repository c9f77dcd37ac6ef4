//! Rasterises triangles on the CPU in f64: the reference of the passes that draw triangles without antialiasing.

use glam::{DVec2, DVec3, DVec4};

/// Visits the pixels that triangles cover and the scene does not hide, as a graphics processor would without
/// antialiasing: each pixel whose centre a triangle covers (centres on a border belong to the triangle on whose
/// left or top it is) and where the triangle's depth is at least the scene's. Both windings are drawn. A pixel is
/// visited once for each triangle that covers it.
///
/// - `triangles`: clip space, z reversed; cut at the near plane, and beyond the far plane nothing is visited.
/// - `viewport`: width and height in px.
/// - `depth_at`: the scene's depth-buffer value at a pixel.
/// - `visit`: called with the pixel's column, row and the triangle's depth there.
///
/// Processors round corners to a fraction of a px (1/256 is usual) before they rasterise; this does not.
pub fn rasterise(
    triangles: &[[DVec4; 3]],
    viewport: [u32; 2],
    depth_at: impl Fn(u32, u32) -> f64,
    mut visit: impl FnMut(u32, u32, f64),
) {
    let viewport_px = DVec2::new(f64::from(viewport[0]), f64::from(viewport[1]));
    for triangle in triangles {
        let (corners, count) = clip_near(triangle);
        // Without a near plane a corner may lie behind the eye.
        if corners[..count].iter().any(|corner| corner.w <= 0.0) {
            continue;
        }
        let screen = corners.map(|corner| {
            let (point, depth) = crate::segment::outline_screen(corner, viewport_px);
            point.extend(depth)
        });
        for last in 2..count {
            rasterise_one([screen[0], screen[last - 1], screen[last]], viewport, &depth_at, &mut visit);
        }
    }
}

/// The part of a triangle in front of the near plane: corners, of which the first 0, 3 or 4 are valid.
fn clip_near(triangle: &[DVec4; 3]) -> ([DVec4; 4], usize) {
    let mut kept = [DVec4::W; 4];
    let mut count = 0;
    for (i, &from) in triangle.iter().enumerate() {
        let to = triangle[(i + 1) % 3];
        let (inside_from, inside_to) = (from.w - from.z, to.w - to.z);
        if inside_from >= 0.0 {
            kept[count] = from;
            count += 1;
        }
        if (inside_from >= 0.0) != (inside_to >= 0.0) {
            kept[count] = from + (to - from) * (inside_from / (inside_from - inside_to));
            count += 1;
        }
    }
    (kept, count)
}

/// `corners`: px, y down, and depth.
fn rasterise_one(
    corners: [DVec3; 3],
    [width, height]: [u32; 2],
    depth_at: &impl Fn(u32, u32) -> f64,
    visit: &mut impl FnMut(u32, u32, f64),
) {
    let [a, mut b, mut c] = corners;
    let area = (b - a).truncate().perp_dot((c - a).truncate());
    if area == 0.0 || !area.is_finite() {
        return;
    }
    if area < 0.0 {
        std::mem::swap(&mut b, &mut c);
    }
    let area = area.abs();
    let sides = [(b, c), (c, a), (a, b)];
    // With y down and the inside on the right of each side: left sides go up, top sides to the right.
    let takes_border = sides.map(|(from, to)| to.y < from.y || (to.y == from.y && to.x > from.x));
    let low = a.min(b).min(c);
    let high = a.max(b).max(c);
    // Casts from f64 saturate, so pixels outside the picture give an empty range.
    let first = |v: f64| (v - 0.5).ceil().max(0.0) as u32;
    let end = |v: f64, size: u32| (((v - 0.5).floor() + 1.0).max(0.0) as u32).min(size);
    for y in first(low.y)..end(high.y, height) {
        for x in first(low.x)..end(high.x, width) {
            let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let inside = sides.map(|(from, to)| (to - from).truncate().perp_dot(centre - from.truncate()));
            if inside.iter().zip(takes_border).any(|(&e, border)| e < 0.0 || (e == 0.0 && !border)) {
                continue;
            }
            let depth = (inside[0] * a.z + inside[1] * b.z + inside[2] * c.z) / area;
            if depth >= 0.0 && depth >= depth_at(x, y) {
                visit(x, y, depth);
            }
        }
    }
}
