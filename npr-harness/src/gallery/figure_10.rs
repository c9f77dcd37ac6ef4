//! Figure 10 of Card & Mitchell 2002: the construction of shadow outlines in four panels.

use crate::camera::Camera;
use crate::error::HarnessError;
use crate::executor::{Backend, CpuReason, Executor, Picture, Rendered};
use crate::hatch::{HatchEncoding, HatchGround, HatchShade, HatchTransfer};
use crate::image_lines::ImageInk;
use crate::picture::Image;
use crate::scene::Scene;
use crate::shade::Shade;
use crate::shadow::ShadowLines;
use crate::style::{Lines, Style, style};
use crate::view::View;
use npr_toon::normal::NormalUse;

/// The panels, from the upper left: hatching with outlines of objects only; the world-space normals that are filtered,
/// negated in shadow; hatching with shadows, and with outlines of objects and shadows; the same over the surfaces'
/// colours, with weights at pixels.
///
/// Two differences from the printed figure: shadow outlines come from shadow states, not from negated normals, and
/// strokes follow the surface.
pub(crate) fn figure_10_styles() -> [Style; 4] {
    let shadowed = style("hatch-shadow").expect("a style of this crate");
    let Shade::Hatch(hatching) = &shadowed.shade else { panic!("`hatch-shadow` hatches") };
    let six = |transfer, ground| {
        Shade::Hatch(HatchShade { encoding: HatchEncoding::SixTones, transfer, ground, ..hatching.clone() })
    };
    let printed = || six(HatchTransfer::Listing4 { brightness: 7.0 }, HatchGround::Paper);
    let objects = Lines::image(ImageInk { shadows: ShadowLines::None, ..shadowed.lines.image.unwrap_or_default() });
    let at_vertices = NormalUse::PerVertex;
    [
        Style { shade: printed(), normals: at_vertices, shadow: None, lines: objects, ..shadowed.clone() },
        style("normals").expect("a style of this crate"),
        Style { shade: printed(), normals: at_vertices, ..shadowed.clone() },
        Style { shade: six(HatchTransfer::Linear { ambient: 0.2 }, HatchGround::Surface), ..shadowed },
    ]
}

/// Renders the four panels into one picture, each at half its width and height, and returns the reason if the CPU
/// rendered one of them because the GPU could not.
///
/// # Errors
/// [`HarnessError`].
pub(crate) fn figure_10(
    executor: &mut Executor,
    backend: Backend,
    scene: &Scene,
    camera: &Camera,
    (width, height): (u32, u32),
    progress: &(dyn Fn(f64) + Sync),
) -> Result<(Image, Option<CpuReason>), HarnessError> {
    let (columns, rows) = (width / 2, height / 2);
    let mut rgba8 = vec![255; width as usize * height as usize * 4];
    let mut why_cpu = None;
    for (number, style) in (0u32..).zip(figure_10_styles()) {
        let share = |share: f64| progress((f64::from(number) + share) / 4.0);
        let picture = Picture::new(scene, &style, View::new(*camera, (columns, rows)));
        let Rendered { image: panel, why_cpu: why, .. } = executor.render_with_fallback(backend, &picture, &share)?;
        why_cpu = why_cpu.or(why);
        let (left, top) = (number % 2 * columns, number / 2 * rows);
        for (row, bytes) in (top..).zip(panel.rgba8.chunks_exact(columns as usize * 4)) {
            let start = (row as usize * width as usize + left as usize) * 4;
            rgba8[start..start + bytes.len()].copy_from_slice(bytes);
        }
    }
    Ok((Image::new(width, height, rgba8)?, why_cpu))
}
