//! Lines on the screen: edges clipped, projected, with a width in px, and hidden where their centreline is hidden.
//!
//! The twin of `segment.wgsl`, in f64.
//!
//! # Width
//!
//! A line is the set of points within half its width of the segment, so its ends are round and joints of
//! adjacent lines are closed. The coverage of a pixel is the area of the pixel's square between the line's two borders,
//! exact for straight ones: its sum across a line is the width at any angle and position, and lines thinner than a
//! pixel fade instead of breaking. The width is measured on the screen and does not depend on the distance; listing 1
//! of Card & Mitchell 2002 scales by clip z instead of w, which makes lines thinner towards the near plane.
//!
//! # Visibility
//!
//! A fin centred on a silhouette lies half inside its own surface, so a depth test of the fin's own triangles cuts the
//! line in half. Here visibility is decided for each point of the centreline: it is visible if at least one of
//! the four pixel centres around it shows a surface that is not in front of it. On the outer side of a
//! silhouette that surface is the background; at a crease it is one of the edge's own faces, whose slope across
//! the line is known from its normal and allowed for, up to 8 px of depth a px (83°). Half a pixel's depth is
//! allowed in addition: from one pixel, a point that is less than that behind a surface cannot be distinguished from
//! one on it.
//!
//! From several pixels it can. On a surface seen at a grazing angle depth changes by many px of depth within one px, so
//! that some of the four pixels around a line just behind it would let the line through: seen from below, the top of a
//! table would show the rims of all objects on it. A second test therefore hides a line where the surface through the
//! four pixels, interpolated to the line's point, is in front of it by more than rounding and by more than twice the
//! second differences of depth there. At silhouettes, creases and contacts these differences are larger than any such
//! distance, and a plane that contains the line is not in front of it.
//!
//! See-through surfaces do not hide a line but dim it, by the share that they let through. Whether one is in front of the
//! line is decided at the same four pixels, of which the one that lets most through counts.
//!
//! Depth is the depth buffer's own, reversed: 1 at the near plane, falling with distance. It is linear on the screen,
//! in perspective too, so that interpolating and extrapolating it are exact.

use glam::{DMat4, DVec2, DVec3, DVec4, Vec4Swizzles};

/// The largest slope of a face across the line that is allowed for, px of depth a px.
pub const MAX_SLOPE: f64 = 8.0;
/// From this slope on, px of depth a px, a face is taken as edge-on: it covers no pixel, and its side of the line is
/// only rounding.
const EDGE_ON_SLOPE: f64 = 1024.0;
/// How far a line may be behind a surface and still be visible, px of depth.
const DEPTH_SLACK_PX: f64 = 0.5;
/// How far a line may be behind the surface interpolated to it and still be visible, px of depth: the tolerance for
/// surfaces in contact.
const PLANE_SLACK_PX: f64 = 0.01;
/// The same for each px of depth a px of the surface's slope: rasterisers round corners to 1/256 px, which
/// moves a face's depths by its slope times that.
const PLANE_SLACK_PER_SLOPE: f64 = 1.0 / 128.0;

/// The number of layers of see-through surfaces that dim a line behind them: the nearest.
pub const VEIL_LAYERS: usize = 4;

/// The view that lines are drawn for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineView {
    /// To clip space (x right, y up, z reversed: w at the near plane, towards 0 with distance).
    pub clip_from_world: DMat4,
    /// Width and height of the picture in px.
    pub viewport_px: DVec2,
    /// Depth-buffer units of a distance along the view as long as one px is wide: `depth * .x + .y`. In perspective the
    /// size of a px grows with distance, and `.x` is 2 tan(fov/2) / height; in a parallel view `.y` is a px's size over
    /// the depth range.
    pub depth_per_px: DVec2,
}

/// A line's centreline on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenSegment {
    /// Ends in px, y down, pixel centres at halves.
    pub ends_px: [DVec2; 2],
    /// Depth-buffer values at the ends.
    pub depths: [f64; 2],
    /// On the side of positive and of negative [`ScreenSegment::offset_px`]: by how much the depth-buffer value of the
    /// edge's own face grows a px away from the line; not below 0.
    pub slopes: [f64; 2],
}

/// Clips a segment at the near plane and to the viewport widened by `margin_px`, and returns its ends in clip
/// space, or `None` if nothing is left.
///
/// The following steps divide by w, and f32 loses the position of the centreline when an end is a thousand screens
/// away.
fn outline_clip(ends: [DVec4; 2], viewport_px: DVec2, margin_px: f64) -> Option<[DVec4; 2]> {
    let guard = DVec2::ONE + 2.0 * margin_px / viewport_px;
    let inside =
        |p: DVec4| [p.w - p.z, guard.x * p.w - p.x, guard.x * p.w + p.x, guard.y * p.w - p.y, guard.y * p.w + p.y];
    let (a, b) = (inside(ends[0]), inside(ends[1]));
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for (a, b) in a.into_iter().zip(b) {
        if a < 0.0 && b < 0.0 {
            return None;
        }
        if a < 0.0 {
            from = from.max(a / (a - b));
        }
        if b < 0.0 {
            to = to.min(a / (a - b));
        }
    }
    let span = ends[1] - ends[0];
    let clipped = [ends[0] + span * from, ends[0] + span * to];
    // Without a near plane w = 0 in the plane of the eye.
    (from <= to && clipped.iter().all(|end| end.w > 0.0)).then_some(clipped)
}

/// A clip-space point on the screen: px, and depth.
pub fn outline_screen(clip: DVec4, viewport_px: DVec2) -> (DVec2, f64) {
    let ndc = clip.truncate() / clip.w;
    (DVec2::new(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y) * viewport_px, ndc.z)
}

/// On which side of the line a face is, and how its depth-buffer value changes there: (offset, slope), with the side as
/// the sign of the offset, and the slope in depth a px. The offset is 0 where the face is seen edge-on.
fn outline_face_slope(inward: DVec3, middle: DVec4, segment: &ScreenSegment, view: &LineView) -> (f64, f64) {
    // The derivative of the projection along a direction in the face, away from the edge.
    let step = view.clip_from_world * inward.extend(0.0);
    let moved = (step.truncate() * middle.w - middle.truncate() * step.w) / (middle.w * middle.w);
    let moved_px = DVec2::new(0.5 * moved.x, -0.5 * moved.y) * view.viewport_px;
    let (direction, length) = segment.direction();
    let along = moved_px.dot(direction);
    let across = direction.perp_dot(moved_px);
    let depth_along = if length > 0.0 { (segment.depths[1] - segment.depths[0]) / length } else { 0.0 };
    (across, (moved.z - along * depth_along) / across.abs())
}

/// Projects an edge to the screen; `None` where nothing of it is in front of the near plane and within the widened
/// viewport.
///
/// - `ends`: world space, in the order in which the first face runs over the edge.
/// - `normals`: unit normals of the two faces for the same winding; zero where there is no face.
/// - `width_px`: of the line.
pub fn outline_project(ends: [DVec3; 2], normals: [DVec3; 2], width_px: f64, view: &LineView) -> Option<ScreenSegment> {
    let clip = ends.map(|end| view.clip_from_world * end.extend(1.0));
    let clip = outline_clip(clip, view.viewport_px, 0.5 * width_px + 2.0)?;
    let [(p0, z0), (p1, z1)] = clip.map(|end| outline_screen(end, view.viewport_px));
    let mut segment = ScreenSegment { ends_px: [p0, p1], depths: [z0, z1], slopes: [0.0; 2] };
    let middle = 0.5 * (clip[0] + clip[1]);
    let edge_on = EDGE_ON_SLOPE * (0.5 * (z0 + z1) * view.depth_per_px.x + view.depth_per_px.y);
    let edge = ends[1] - ends[0];
    for inward in [normals[0].cross(edge), normals[1].cross(-edge)] {
        let (across, slope) = outline_face_slope(inward, middle, &segment, view);
        let side = usize::from(across < 0.0);
        if slope < edge_on && slope > segment.slopes[side] {
            segment.slopes[side] = slope;
        }
    }
    Some(segment)
}

impl ScreenSegment {
    /// Unit vector from the first end to the second, and the length in px. Along x where the length is 0.
    pub fn direction(&self) -> (DVec2, f64) {
        (outline_direction(self.ends_px), self.ends_px[0].distance(self.ends_px[1]))
    }

    /// The nearest point of the centreline, as a fraction of the way from the first end to the second.
    pub fn nearest(&self, point_px: DVec2) -> f64 {
        outline_nearest(self.ends_px, point_px)
    }

    /// The centreline at a fraction of the way.
    pub fn at(&self, fraction: f64) -> (DVec2, f64) {
        let [p0, p1] = self.ends_px;
        (p0 + (p1 - p0) * fraction, self.depths[0] + (self.depths[1] - self.depths[0]) * fraction)
    }

    /// Distance of a point from the infinite centreline, positive to the left of its direction on a screen whose y
    /// grows downwards.
    pub fn offset_px(&self, point_px: DVec2) -> f64 {
        self.direction().0.perp_dot(point_px - self.ends_px[0])
    }
}

/// Unit vector from the first end to the second; along x where the length is 0.
fn outline_direction(ends_px: [DVec2; 2]) -> DVec2 {
    let span = ends_px[1] - ends_px[0];
    let length = span.length();
    if length > 0.0 { span / length } else { DVec2::X }
}

/// The nearest point of the centreline, as a fraction of the way from the first end to the second.
fn outline_nearest(ends_px: [DVec2; 2], point_px: DVec2) -> f64 {
    let span = ends_px[1] - ends_px[0];
    let squared = span.length_squared();
    if squared > 0.0 { ((point_px - ends_px[0]).dot(span) / squared).clamp(0.0, 1.0) } else { 0.0 }
}

/// The share of a unit square around the origin on the near side of a straight border at `distance` along the unit
/// vector `normal`: the distribution of a sum of two uniform variables, a trapezoid's integral.
fn outline_half_plane(distance: f64, normal: DVec2) -> f64 {
    let (a, b) = (normal.x.abs().max(normal.y.abs()), normal.x.abs().min(normal.y.abs()));
    let reach = 0.5 * (a + b);
    let inner = 0.5 * (a - b);
    let from_border = distance.abs();
    let near = if from_border <= inner {
        0.5 + from_border / a
    } else {
        // Beyond the middle strip the border cuts off a corner of the square, a triangle.
        let left = (reach - from_border).max(0.0);
        1.0 - 0.5 * left * left / (a * b).max(f64::MIN_POSITIVE)
    };
    if distance < 0.0 { 1.0 - near } else { near }
}

/// The area of the pixel's square between the two borders of a line, whose centreline is `distance` away along the unit
/// vector `normal`.
fn outline_band(distance: f64, normal: DVec2, width_px: f64) -> f64 {
    let half_width = 0.5 * width_px;
    let covered =
        outline_half_plane(half_width - distance, normal) + outline_half_plane(half_width + distance, normal) - 1.0;
    covered.clamp(0.0, 1.0)
}

/// How much of the pixel around `point_px` a line of `width_px` covers, 0..=1: exact beside the line; past its ends by
/// the distance from them, and never more than a longer line would cover, so that a line in pieces has the coverage of
/// the whole.
pub fn outline_coverage(segment: &ScreenSegment, point_px: DVec2, width_px: f64) -> f64 {
    let on_line = segment.at(segment.nearest(point_px)).0;
    outline_coverage_at(on_line, segment.direction().0, point_px, width_px)
}

/// [`outline_coverage`] where the nearest point of the centreline and the line's direction are known.
fn outline_coverage_at(on_line: DVec2, direction: DVec2, point_px: DVec2, width_px: f64) -> f64 {
    let to_point = point_px - on_line;
    let distance = to_point.length();
    let beside = outline_band(direction.perp_dot(to_point).abs(), DVec2::new(-direction.y, direction.x), width_px);
    if to_point.dot(direction).abs() <= 1e-3 * distance || distance <= 1e-3 {
        return beside;
    }
    beside.min((0.5 * width_px + 0.5 - distance).clamp(0.0, 1.0))
}

/// How far in front of a line its own faces may be at a pixel, in depth-buffer units. Parameters as of [`outline_vote`].
fn outline_allowed(offset: f64, slopes: [f64; 2], per_px: f64) -> f64 {
    let slope = slopes[usize::from(offset < 0.0)].min(MAX_SLOPE * per_px);
    DEPTH_SLACK_PX * per_px + slope * offset.abs()
}

/// The share of a line that see-through surfaces in front of it let through at a pixel.
///
/// `depths`, `alphas`: of the layers of surfaces there; the depth is 0 where there is none.
fn outline_through(depths: DVec4, alphas: DVec4, depth: f64, offset: f64, slopes: [f64; 2], per_px: f64) -> f64 {
    let limit = depth + outline_allowed(offset, slopes, per_px);
    let through = DVec4::select(depths.cmpgt(DVec4::splat(limit)), 1.0 - alphas, DVec4::ONE);
    through.x * through.y * through.z * through.w
}

/// What one of the four pixels around a point of the centreline says: whether its surface is not in front of the line,
/// and whether it may be one of the edge's own faces.
///
/// - `offset`: of the pixel's centre from the centreline, px; positive as in [`ScreenSegment::offset_px`].
/// - `slopes`: as in [`ScreenSegment::slopes`].
/// - `per_px`: depth-buffer units of one px along the view.
fn outline_vote(scene_depth: f64, depth: f64, offset: f64, slopes: [f64; 2], per_px: f64) -> (bool, bool) {
    let behind = scene_depth - depth;
    // A face of the edge may lie as far behind the line as it may lie in front.
    (behind <= outline_allowed(offset, slopes, per_px), behind.abs() <= (DEPTH_SLACK_PX + MAX_SLOPE) * per_px)
}

/// How far in front of a point of a line the plane through four pixels is, less the tolerance for rounding and for the
/// deviation of the four from a plane, in depth-buffer units.
///
/// - `quad`: their depths: upper left and right, lower left and right.
/// - `within`: the point from the upper left pixel's centre, px.
fn outline_plane_in_front(quad: DVec4, within: DVec2, depth: f64, per_px: f64) -> f64 {
    let along_x = 0.5 * (quad.y - quad.x + quad.w - quad.z);
    let along_y = 0.5 * (quad.z - quad.x + quad.w - quad.y);
    let there = 0.25 * (quad.x + quad.y + quad.z + quad.w) + along_x * (within.x - 0.5) + along_y * (within.y - 0.5);
    let twist = (quad.x - quad.y - quad.z + quad.w).abs();
    there - depth - PLANE_SLACK_PX * per_px - PLANE_SLACK_PER_SLOPE * (along_x.abs() + along_y.abs()) - twist
}

/// The greater of the two second differences of four consecutive depths.
fn outline_second_difference(depths: DVec4) -> f64 {
    (depths.x - 2.0 * depths.y + depths.z).abs().max((depths.y - 2.0 * depths.z + depths.w).abs())
}

/// Whether the surface around a point of a line is in front of it by more than rounding and its curvature explain.
///
/// - `corner`: the upper left one of the four pixels around it, and `quad` their depths.
fn outline_plane_hides(
    quad: DVec4,
    corner: DVec2,
    on_line: DVec2,
    depth: f64,
    view: &LineView,
    depth_at: impl Fn(i64, i64) -> f64,
) -> bool {
    // Outside the picture there are no depths.
    if corner.cmplt(DVec2::ZERO).any() || corner.cmpgt(view.viewport_px - 2.0).any() {
        return false;
    }
    let per_px = depth * view.depth_per_px.x + view.depth_per_px.y;
    let within = on_line - 0.5 - corner;
    let (x, y) = (corner.x as i64, corner.y as i64);
    let before = outline_plane_in_front(quad, within, depth, per_px);
    if before <= 0.0 {
        return false;
    }
    // The row and the column of the nearest of the four, with the next pixel on either side.
    let (right, lower) = (within.x > 0.5, within.y > 0.5);
    let row = if lower { quad.zw() } else { quad.xy() };
    let column = if right { quad.yw() } else { quad.xz() };
    let (row_y, column_x) = (y + i64::from(lower), x + i64::from(right));
    let curvature_x =
        outline_second_difference(DVec4::new(depth_at(x - 1, row_y), row.x, row.y, depth_at(x + 2, row_y)));
    let curvature_y =
        outline_second_difference(DVec4::new(depth_at(column_x, y - 1), column.x, column.y, depth_at(column_x, y + 2)));
    // Twice, since towards a silhouette the curvature is greater than where it is measured.
    before > 2.0 * (curvature_x + curvature_y)
}

/// Whether the centreline is visible at a fraction of its length.
///
/// - `depth_at`: the depth buffer's value at a pixel; x and y may lie outside the picture by a few px, and the
///   caller clamps them.
/// - `cut_out`: the edge's own faces may be absent; the line is then visible only where there is a surface at its own
///   depth.
pub fn outline_is_visible(
    segment: &ScreenSegment,
    fraction: f64,
    view: &LineView,
    cut_out: bool,
    depth_at: impl Fn(i64, i64) -> f64,
) -> bool {
    let (on_line, depth) = segment.at(fraction);
    let corner = (on_line - 0.5).floor();
    let per_px = depth * view.depth_per_px.x + view.depth_per_px.y;
    let direction = segment.direction().0;
    let (mut seen, mut surface) = (false, false);
    let mut quad = [0.0; 4];
    for (tap, scene) in (0u8..).zip(&mut quad) {
        let pixel = corner + DVec2::new(f64::from(tap & 1), f64::from(tap >> 1));
        let offset = direction.perp_dot(pixel + 0.5 - on_line);
        *scene = depth_at(pixel.x as i64, pixel.y as i64);
        let votes = outline_vote(*scene, depth, offset, segment.slopes, per_px);
        (seen, surface) = (seen || votes.0, surface || votes.1);
    }
    seen && (surface || !cut_out) && !outline_plane_hides(quad.into(), corner, on_line, depth, view, depth_at)
}

/// The share of the centreline that see-through surfaces in front of it let through, at a fraction of its length: the
/// greatest of what the four pixels around it say whose opaque surfaces do not hide it; 1 if all of them do.
///
/// - `depth_at`: as of [`outline_is_visible`].
/// - `layers_at`: the depths and alphas of see-through surfaces at a pixel, [`VEIL_LAYERS`] of them; the depth is 0 where
///   there is none.
pub fn outline_share_through(
    segment: &ScreenSegment,
    fraction: f64,
    view: &LineView,
    depth_at: impl Fn(i64, i64) -> f64,
    layers_at: impl Fn(i64, i64) -> [DVec4; 2],
) -> f64 {
    let (on_line, depth) = segment.at(fraction);
    let corner = (on_line - 0.5).floor();
    let per_px = depth * view.depth_per_px.x + view.depth_per_px.y;
    let direction = segment.direction().0;
    let at_pixel = |tap: u8| {
        let pixel = corner + DVec2::new(f64::from(tap & 1), f64::from(tap >> 1));
        let offset = direction.perp_dot(pixel + 0.5 - on_line);
        let (x, y) = (pixel.x as i64, pixel.y as i64);
        let sees = outline_vote(depth_at(x, y), depth, offset, segment.slopes, per_px).0;
        let [depths, alphas] = layers_at(x, y);
        sees.then(|| outline_through(depths, alphas, depth, offset, segment.slopes, per_px))
    };
    (0..4).filter_map(at_pixel).reduce(f64::max).unwrap_or(1.0)
}

#[cfg(test)]
mod tests;
