//! The part of a plan for edge lines.

use crate::error::HarnessError;
use crate::scene::opacity::Hides;
use crate::scene::{Mesh, Object, ObjectLines, Scene};
use crate::schema::{within, within_colors};
use glam::DVec4;
use npr_outline::LineKind;
use npr_outline::contour::{ContourEdges, ContourOptions, contour_edges};
use npr_outline::line_style::LineStyle;
use std::sync::Arc;

/// The ink of this crate's styles, nearly black.
pub const INK: [f32; 4] = [0.10, 0.09, 0.11, 1.0];

/// The edge lines of a picture.
#[derive(Clone, Debug)]
pub struct EdgeLinePlan {
    /// Per object: the edges that can be lines of a kind that is drawn; none if the object has no lines. Objects whose
    /// transforms preserve angles share them.
    pub contours: Vec<Arc<ContourEdges>>,
    /// The widths in px of the picture, and the ink.
    pub style: LineStyle,
    /// How the GPU executor finds the lines.
    pub method: EdgeLineMethod,
}

/// How the GPU executor classifies edges as lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeLineMethod {
    /// By a scan on the CPU.
    OnCpu,
    /// By a compute pass that writes the arguments of an indirect draw.
    OnDevice,
}

/// The cache key of the contours: the crease angle, if creases are drawn, per [`LineKind`] whether it is drawn, and
/// whether the file's edges decide.
#[derive(PartialEq)]
struct ContoursKey(Option<f32>, [bool; LineKind::ALL.len()], bool, Option<bool>);

impl EdgeLinePlan {
    /// `file_edges` is [`Style::file_edges`](crate::style::Style::file_edges). `is_outside`: whether the eye is outside of
    /// all objects, so that it sees no back face of a closed one. `method` selects a method from the size in bytes of the
    /// edges on the GPU.
    pub(crate) fn new(
        scene: &Scene,
        style: &LineStyle,
        (crease_angle_rad, file_edges): (f32, bool),
        is_outside: bool,
        method: impl FnOnce(u64) -> EdgeLineMethod,
    ) -> Result<Self, HarnessError> {
        style.validate()?;
        for object in scene.objects() {
            if let ObjectLines::Own(own) = &object.lines {
                validate(own)?;
            }
        }
        let drawn = drawn_kinds(scene, style);
        let [silhouettes, boundaries, creases, material_borders, authored] = drawn;
        let of_object = |(object, mesh): (&Object, &Mesh)| {
            if object.lines == ObjectLines::None {
                return Ok(Arc::default());
            }
            let (derived, world_from_normal) = object.derived(mesh);
            let double_sided = double_sided(scene, object, mesh, is_outside);
            let options = ContourOptions {
                crease_angle_rad,
                material_borders,
                creases,
                boundaries,
                silhouettes,
                authored,
                file_edges,
                world_from_normal,
                double_sided,
            };
            derived.get(ContoursKey(creases.then_some(crease_angle_rad), drawn, file_edges, double_sided), || {
                contour_edges(mesh.model(), &mesh.edges_and_cuts(), &options)
            })
        };
        let contours = scene.placed_objects().map(of_object).collect::<Result<Vec<_>, _>>()?;
        let method = method(device_bytes(scene, &contours));
        Ok(Self { contours, style: *style, method })
    }

    /// The objects that have lines, grouped by line style; the style of the picture comes first.
    pub(crate) fn groups(&self, scene: &Scene) -> Vec<(LineStyle, Vec<u32>)> {
        let mut groups: Vec<(LineStyle, Vec<u32>)> = vec![(self.style, Vec::new())];
        for (number, object) in (0u32..).zip(scene.objects()) {
            let style = match object.lines {
                ObjectLines::OfStyle => self.style,
                ObjectLines::None => continue,
                ObjectLines::Own(style) => style,
            };
            match groups.iter_mut().find(|(known, _)| *known == style) {
                Some((_, objects)) => objects.push(number),
                None => groups.push((style, vec![number])),
            }
        }
        groups.retain(|(_, objects)| !objects.is_empty());
        groups
    }

    /// The edges that are lines for an eye, as (object, edge), and the number of lines of each
    /// [`LineKind`].
    pub fn lines(&self, scene: &Scene, eye: DVec4) -> (Vec<[u32; 2]>, [usize; LineKind::ALL.len()]) {
        let (mut lines, mut counts, mut found) = (Vec::new(), [0; LineKind::ALL.len()], Vec::new());
        for number in self.groups(scene).into_iter().flat_map(|(_, objects)| objects) {
            let object = &scene.objects()[number as usize];
            let (contours, eye) = (&self.contours[number as usize], object.homogeneous(eye));
            contours.scan(eye, &mut found);
            let eye = contours.local_eye(eye);
            for kind in found.iter().filter_map(|&line| contours.kind(line as usize, eye)) {
                counts[kind as usize] += 1;
            }
            lines.extend(found.iter().map(|&line| [number, line]));
        }
        (lines, counts)
    }
}

/// Whether all faces of an object are double-sided, or none is; `None` for what the materials of its mesh say.
///
/// The back faces of a closed object that hides what is behind it are hidden, and so is an edge between two of them. It is left out like one
/// between culled faces, since depths at pixels do not say that it is hidden where its distance from the contour is less
/// than a pixel.
fn double_sided(scene: &Scene, object: &Object, mesh: &Mesh, is_outside: bool) -> Option<bool> {
    let (first, is_own) = object.first_material();
    let mut materials = if is_own { first..first + 1 } else { scene.materials_of(object.mesh()) };
    if is_outside && mesh.is_closed() && materials.all(|material| scene.hides(material) == Hides::Everything) {
        return Some(false);
    }
    let own = is_own.then(|| scene.materials()[first].double_sided);
    let differs = |own: &bool| mesh.model().materials.iter().any(|of_mesh| of_mesh.double_sided != *own);
    own.filter(differs)
}

/// Per [`LineKind`]: whether any object has such lines, of the picture's style or of its own.
fn drawn_kinds(scene: &Scene, style: &LineStyle) -> [bool; LineKind::ALL.len()] {
    LineKind::ALL.map(|kind| {
        let is_drawn = |object: &Object| match &object.lines {
            ObjectLines::OfStyle => style.width_px[kind as usize] > 0.0,
            ObjectLines::Own(own) => own.width_px[kind as usize] > 0.0,
            ObjectLines::None => false,
        };
        scene.objects().iter().any(is_drawn)
    })
}

/// The size of the largest buffer for finding lines on the GPU, bytes.
pub(crate) fn device_bytes(scene: &Scene, contours: &[Arc<ContourEdges>]) -> u64 {
    let bytes = scene.placed_objects().zip(contours).map(|((_, mesh), of)| of.device_bytes(&mesh.model().positions));
    bytes.max().unwrap_or(0)
}

/// Checks that widths and colours are within their ranges.
pub(crate) fn validate(style: &LineStyle) -> Result<(), HarnessError> {
    for &width_px in &style.width_px {
        // The limit bounds the cost: every line wider than the picture covers all pixels.
        within("a line's width", width_px, 0.0, 256.0, "0..=256 px")?;
    }
    within_colors("a component of the lines' ink", &style.ink)
}
