//! Which passes a picture needs, and no more.

use crate::camera::Camera;
use crate::error::HarnessError;
use crate::hatch::HatchPlan;
use crate::image_ink::{ImageInk, ImagePlan, InkScale};
use crate::scene::Scene;
use crate::shadow::{ShadowLines, ShadowMethod, ShadowPlan};
use crate::style::{HatchMapping, Lines, Shade, Style};
use glam::DVec4;
use npr_imagespace::artist::LineKind as InnerLines;
use npr_mesh::AlphaMode;
use npr_outline::LineKind;
use npr_outline::contour::{ContourEdges, ContourOptions, contour_edges};
use npr_outline::fin_printed::{PrintedFins, printed_fins};
use npr_toon::normal::NormalUse;
use npr_toon::source::LightPlace;
use std::fmt;

/// How lines are found and drawn on a device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineMethod {
    /// [`LineMethod::OnDevice`] where the adapter is hardware and can, else [`LineMethod::Rectangles`].
    #[default]
    Auto,
    /// A scan on the CPU, and the lines that it finds drawn as rectangles.
    Rectangles,
    /// A compute pass that finds the lines, and an indirect draw of rectangles.
    OnDevice,
}

/// A pass and why it is there, or why not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reason {
    /// The pass.
    pub pass: &'static str,
    /// Why.
    pub why: String,
}

/// The passes of a picture, decided once for both executors.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Whether surfaces are painted at all; otherwise only their depth is needed.
    pub painted: bool,
    /// Whether light is more than normals at pixels and directions that are the same everywhere.
    pub lit: bool,
    /// Whether some material looks up a texture or has vertex colours.
    pub textured: bool,
    /// Whether some material is cut out by alpha.
    pub cut_out: bool,
    /// Whether some material is blended over what is behind it.
    pub blended: bool,
    /// Whether faces turned away are left out although their material is double-sided: they cannot be seen.
    pub cull_back: bool,
    /// The edges that can be lines, where fins are drawn.
    pub contours: Option<ContourEdges>,
    /// A fin for every edge, where the printed form is drawn.
    pub printed_fins: Option<PrintedFins>,
    /// What lines in the image need, where they are asked for.
    pub image: Option<ImagePlan>,
    /// What strokes need, where surfaces are hatched.
    pub hatch: Option<HatchPlan>,
    /// What shadows need, where something is seen of them.
    pub shadow: Option<ShadowPlan>,
    /// Passes, in order.
    pub passes: Vec<Reason>,
    /// What was left out.
    pub left_out: Vec<Reason>,
}

impl Plan {
    /// Decides what a style needs for a scene seen by a camera.
    ///
    /// # Errors
    /// What is wrong with the style, [`Style::validate`], with its lines, or with its map; [`HarnessError::ClippedEdges`],
    /// [`HarnessError::ShadowMapLight`].
    pub fn new(scene: &Scene, style: &Style, camera: &Camera) -> Result<Self, HarnessError> {
        style.validate()?;
        let model = &scene.model;
        let painted = style.shade != Shade::Paper;
        let used = |test: &dyn Fn(&npr_mesh::Material) -> bool| model.materials.iter().any(test);
        let textured = painted && (used(&|m| m.texture.is_some()) || !model.colors.is_empty());
        let placed = style.lights.iter().any(|light| matches!(light.light.place, LightPlace::Positional { .. }));
        let two = style.lights.len() > 1;
        let each = matches!(style.shade, Shade::Painter(_));
        // Several lights taken together are a direction.
        let hatch = if let Shade::Hatch(shade) = &style.shade { Some(HatchPlan::new(scene, shade)?) } else { None };
        let shows_light = painted && style.shade != Shade::Normals;
        let lit = shows_light && (hatch.is_some() || style.normals != NormalUse::PerPixel || placed && (each || !two));
        let cut_out = used(&|m| matches!(m.alpha_mode, AlphaMode::Mask { .. }));
        let blended = painted && scene.has_blend();
        let cull_back = scene.closed && scene.clip.is_none() && !sees_the_inside(scene, camera);
        if scene.clip.is_some() && matches!(style.lines, Some(Lines::Fins(_) | Lines::Printed { .. })) {
            return Err(HarnessError::ClippedEdges { style: style.name.clone() });
        }
        let drawn = matches!(&style.lines, Some(Lines::Image(ink)) if ink.shadows != ShadowLines::None);
        let shadow = match &style.shadow {
            Some(shadow) if painted || drawn => Some(ShadowPlan::new(scene, style, shadow, camera)?),
            _ => None,
        };
        let mut passes = Vec::new();
        let mut left_out = Vec::new();
        let mut add = |there: bool, pass, why: &str, why_not: &str| {
            let (list, why) = if there { (&mut passes, why) } else { (&mut left_out, why_not) };
            list.push(Reason { pass, why: why.to_owned() });
        };
        let volumes = shadow.as_ref().is_some_and(|shadow| shadow.style.method == ShadowMethod::Volumes);
        let no_shadow = if style.shadow.is_some() { "the style shows nothing of it" } else { "no light casts shadows" };
        let no_volumes = if shadow.is_some() { "the style asks for a map" } else { no_shadow };
        add(volumes, "geometry: depth, before all", "shadows fall on what is seen", no_volumes);
        add(volumes, "shadow volumes into a stencil", "a light casts shadows", no_volumes);
        add(
            shadow.is_some() && !volumes,
            "shadow map",
            "a light casts shadows, and the style asks for a map",
            if volumes { "volumes are exact" } else { no_shadow },
        );
        let outlined = style.lines.is_some();
        add(painted, "geometry: colour and depth", "surfaces are painted", "the style paints no surface");
        let image = if let Some(Lines::Image(ink)) = &style.lines { Some(ink) } else { None };
        let another_size = image.is_some_and(|ink| ink.scale != InkScale::One);
        add(
            !painted && outlined && !another_size,
            "geometry: depth alone",
            "lines are hidden behind surfaces",
            if painted { "colour is drawn with it" } else { "nothing in the picture itself needs it" },
        );
        add(textured, "texture and vertex colour lookups", "materials have them", "no material needs them");
        add(cut_out, "alpha test", "materials have a cutoff", "no material has a cutoff");
        add(blended, "blended surfaces, back to front", "materials are blended", "no material is blended");
        add(
            !cull_back,
            "faces turned away",
            "the model is open, cut, or seen from inside",
            "the model is closed: they are hidden",
        );
        let fins = matches!(style.lines, Some(Lines::Fins(_)));
        add(fins, "line coverage and ink", "the style draws lines", "the style draws no such lines");
        let printed = matches!(style.lines, Some(Lines::Printed { .. }));
        add(
            printed,
            "printed fins, all edges",
            "the style asks for the printed form",
            "only edges that are lines are sent",
        );
        let one_pass = image.is_some() && !another_size;
        add(
            one_pass,
            "normal, region, depth beside colour",
            "lines are found in the image",
            if another_size { "they are drawn at another size" } else { "no line is found in the image" },
        );
        add(
            another_size,
            "geometry: normal, region, depth",
            "the ink has another size than the picture",
            if image.is_some() { "the ink has the picture's size" } else { "no line is found in the image" },
        );
        let apart_brush = |ink: &ImageInk| matches!(ink.shadows, ShadowLines::Apart { brush: Some(_), .. });
        let thick = image.is_some_and(|ink| ink.brush.is_some() || apart_brush(ink));
        let in_one = one_pass && !thick;
        let apart = image.is_some() && !in_one;
        let none = if image.is_some() { "the ink is needed by itself" } else { "no line is found in the image" };
        add(in_one, "filter and composite in one", "nothing needs the ink in between", none);
        add(
            image.is_some_and(|ink| matches!(ink.shadows, ShadowLines::Apart { .. })),
            "filter for shadows",
            "their lines look different",
            if drawn { "the pass of the objects' lines finds them" } else { "shadows have no lines" },
        );
        add(apart, "filter", "the ink is worked on before it is laid", "it is in the composite, or not there");
        add(thick, "dilation by a disc", "the style has a brush", "lines are as wide as they are found");
        add(another_size, "composite", "the ink has another size", "the pass before lays the ink, or there is none");
        add(
            painted && two && each,
            "second light",
            "the ramp has an axis for it",
            if painted && two { "the shade knows one: the two are taken together" } else { "there is one light" },
        );
        add(
            lit,
            "positions or light between vertices",
            "a light is near, strokes lie on surfaces, or the style asks for vertices' light",
            "the light comes from far away, and meets normals at pixels",
        );
        let mapping = hatch.as_ref().map(|hatch| hatch.mapping);
        add(
            hatch.is_some(),
            "tonal art map",
            match mapping {
                Some(HatchMapping::Coordinates) => "surfaces are hatched, by texture coordinates",
                Some(HatchMapping::Form) => "surfaces are hatched, along their form",
                _ => "surfaces are hatched, by three planes",
            },
            "no surface is hatched",
        );
        add(
            mapping == Some(HatchMapping::Form),
            "a field of directions",
            "strokes follow the form",
            "no stroke follows the form",
        );
        add(false, "multisampling", "", "lines and band borders carry their own coverage");
        let contours = match &style.lines {
            Some(Lines::Fins(look)) => {
                look.validate()?;
                let options = ContourOptions { crease_angle_rad: style.crease_angle_rad, material_borders: false };
                Some(contour_edges(model, &scene.edges, &options)?)
            }
            _ => None,
        };
        let printed_fins = printed.then(|| printed_fins(model, &scene.edges));
        let image = match &style.lines {
            Some(Lines::Image(ink)) => Some(ImagePlan::new(scene, ink, style.crease_angle_rad, camera)?),
            _ => None,
        };
        Ok(Self {
            painted,
            lit,
            textured,
            cut_out,
            blended,
            cull_back,
            contours,
            printed_fins,
            image,
            hatch,
            shadow,
            passes,
            left_out,
        })
    }

    /// Whether texture coordinates, textures or vertex colours are read at all.
    pub fn looks_up(&self) -> bool {
        let says_lines = |image: &ImagePlan| image.line_kinds.iter().any(|&kind| kind != InnerLines::Normals);
        self.textured || self.cut_out || self.image.as_ref().is_some_and(says_lines)
    }

    /// The lines for an eye, and how many there are of each [`LineKind`].
    pub fn lines(&self, eye: DVec4) -> (Vec<u32>, [usize; 4]) {
        let mut lines = Vec::new();
        let mut counts = [0; 4];
        if let Some(contours) = &self.contours {
            contours.scan(eye, &mut lines);
            let eye = contours.local_eye(eye);
            for kind in lines.iter().filter_map(|&line| contours.kind(line as usize, eye)) {
                counts[kind as usize] += 1;
            }
        }
        debug_assert_eq!(LineKind::ALL.len(), counts.len());
        (lines, counts)
    }
}

/// Whether the eye, or the near plane, is within the model's box: then the back of a face can be seen.
fn sees_the_inside(scene: &Scene, camera: &Camera) -> bool {
    let Some((low, high)) = scene.bounds() else { return false };
    let margin = scene.radius() * 1e-3 + 2.0 * camera.near;
    let (low, high) = (low.as_dvec3() - margin, high.as_dvec3() + margin);
    camera.eye.cmpge(low).all() && camera.eye.cmple(high).all()
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for reason in &self.passes {
            writeln!(f, "  with    {:<36} {}", reason.pass, reason.why)?;
        }
        for reason in &self.left_out {
            writeln!(f, "  without {:<36} {}", reason.pass, reason.why)?;
        }
        Ok(())
    }
}
