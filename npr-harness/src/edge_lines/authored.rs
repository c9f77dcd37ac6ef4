//! Lines that the file itself draws, in styles that have no edge lines.

use super::plan::{EdgeLinePlan, INK};
use crate::scene::Scene;
use crate::style::{Lines, Style};
use npr_imagespace::composite::Composite;
use npr_outline::LineKind;
use npr_outline::line_style::LineStyle;

/// The width of the file's lines in a style whose lines have no width in px.
const WIDTH_PX: f32 = 1.3;

fn has_lines(scene: &Scene) -> bool {
    scene.meshes().iter().any(|mesh| !mesh.model().lines.is_empty())
}

/// The style of the file's lines where the style draws lines in other ways than along edges, which cannot find them: the
/// ink and the width of those. `None` if the scene has no lines, the style draws none, or a clipping plane would have to
/// cut them.
pub(crate) fn authored_alone(scene: &Scene, lines: &Lines) -> Option<LineStyle> {
    if !has_lines(scene) || scene.clip.is_some() {
        return None;
    }
    let opaque = |width_px: f32, color: glam::Vec3| (width_px, color.extend(1.0).to_array());
    let (width, ink) = match lines {
        Lines { image: Some(image), .. } => match image.composite {
            Composite::Over { color, opacity } => (WIDTH_PX, color.extend(opacity).to_array()),
            _ => (WIDTH_PX, INK),
        },
        Lines { printed: Some(printed), .. } => opaque(printed.width_px, printed.ink),
        Lines { hull: Some(hull), .. } => opaque(hull.width_px, hull.ink),
        _ => return None,
    };
    let mut width_px = [0.0; LineKind::ALL.len()];
    width_px[LineKind::Authored as usize] = width;
    Some(LineStyle { width_px, ink })
}

/// Why the scene's lines are not drawn, if it has some.
pub(crate) fn authored_left_out(
    scene: &Scene,
    style: &Style,
    edge_lines: Option<&EdgeLinePlan>,
) -> Option<&'static str> {
    if !has_lines(scene) {
        return None;
    }
    match edge_lines {
        Some(lines) if lines.style.width_px[LineKind::Authored as usize] > 0.0 => None,
        Some(_) => Some("the style gives them no width"),
        None if scene.clip.is_some() && style.lines != Lines::NONE => Some("lines along edges are not clipped"),
        None => Some("the style draws no lines"),
    }
}
