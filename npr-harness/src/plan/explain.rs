//! Lists the passes of a plan and those that were left out, each with its reason.

use super::{PaintPlan, Plan, Reason};
use crate::ground::GROUND;
use crate::hatch::HatchMapping;
use crate::image_lines::{ImagePlan, InkScale};
use crate::scene::Scene;
use crate::shadow::{ShadowLines, ShadowTechnique};
use crate::style::Style;
use crate::variant::Part;
use std::fmt;

impl Plan {
    /// Lists the lines along cuts, if edge lines are drawn.
    pub(super) fn explain_cut_lines(&mut self, scene: &Scene) {
        if self.edge_lines.is_some() {
            self.passes.extend(cut_lines(scene));
        }
    }

    /// Lists the passes that are used and those that are left out, with reasons.
    pub(super) fn explain(&mut self, style: &Style, textured: bool) {
        let (mut passes, mut left_out) = (Vec::new(), Vec::new());
        let mut add = |taken: bool, pass, why: &str, why_not: &str| {
            let (list, why) = if taken { (&mut passes, why) } else { (&mut left_out, why_not) };
            list.push(Reason { pass, why: why.to_owned() });
        };
        let technique = self.shadow.as_ref().map(|shadow| &shadow.technique);
        let volumes = matches!(technique, Some(ShadowTechnique::Volumes { .. }));
        let map = matches!(technique, Some(ShadowTechnique::Map { .. }));
        let no_shadow = if style.shadow.is_some() { "the style shows nothing of it" } else { "no light casts shadows" };
        let rays = matches!(technique, Some(ShadowTechnique::Rays));
        let by_rays = "the CPU follows rays to the light";
        let because = self.shadow.as_ref().and_then(|shadow| shadow.because);
        let no_volumes = match (rays, map) {
            (true, _) => by_rays,
            (_, true) if because.is_some() => because.unwrap_or_default(),
            (_, true) => "the style asks for a map",
            _ => no_shadow,
        };
        add(rays, "shadow rays", by_rays, if technique.is_some() { "a device has other means" } else { no_shadow });
        add(volumes, "geometry: depth, before all", "shadows fall on what is seen", no_volumes);
        add(volumes, "shadow volumes into a stencil", because.unwrap_or("a light casts shadows"), no_volumes);
        let no_map = match (rays, volumes) {
            (true, _) => by_rays,
            (_, true) => "volumes are exact",
            _ => no_shadow,
        };
        let why_map = because.unwrap_or("a light casts shadows, and the style asks for a map");
        add(map, "shadow map", why_map, no_map);

        let painted = self.paint.is_some();
        add(painted, "geometry: colour and depth", "surfaces are painted", "the style paints no surface");
        add(
            !painted && self.draws_surfaces,
            "geometry: depth alone",
            "lines are hidden behind surfaces",
            if painted { "colour is drawn with it" } else { "nothing in the picture itself needs it" },
        );
        add(textured, "texture and vertex colour lookups", "materials have them", "no material needs them");
        add(self.cut_out, "alpha test", "materials have a cutoff", "no material has a cutoff");
        add(self.blended, "blended surfaces, back to front", "materials are blended", "no material is blended");
        if self.blended_hide {
            add(true, "blended surfaces from alpha 0.5 on, in depth", "they hide lines behind them", "");
        }
        if self.veiled {
            add(true, "layers of see-through surfaces", "they dim the lines behind them", "");
        }
        add(
            !self.cull_back,
            "back faces",
            "the model is open, cut, see-through, or seen from inside",
            "the model is closed: they are hidden",
        );
        add(
            self.hulls.is_some(),
            "inverted hull: displaced back faces",
            "the style asks for it",
            "no outline is made of back faces",
        );
        add(
            self.printed_fins.is_some(),
            "printed fins, all edges",
            "the style asks for the printed form",
            "only edges that are lines are sent",
        );
        add(
            self.edge_lines.is_some(),
            "line coverage and ink",
            if style.lines.edges.is_some() {
                "the style draws lines along edges"
            } else {
                "the file has lines of its own"
            },
            "the style draws no line along an edge",
        );

        let image = self.image.as_ref();
        let no_lines = "no line is found in the image";
        let own = image.filter(|image| image.own_surfaces);
        let (other_size, why_own) = match own {
            Some(own) if own.ink.scale == InkScale::One => (false, "the picture has several samples a pixel"),
            Some(_) => (true, "the ink has another size than the picture"),
            None => (false, ""),
        };
        add(
            image.is_some() && own.is_none(),
            "normal, region, depth beside colour",
            "lines are found in the image",
            if own.is_some() { "they are drawn by themselves" } else { no_lines },
        );
        add(
            own.is_some(),
            "geometry: normal, region, depth",
            why_own,
            if image.is_some() { "they are drawn beside the picture" } else { no_lines },
        );
        let gbuffer = image.and_then(|image| image.gbuffer.as_ref()).map(|plan| &plan.gbuffer);
        add(
            gbuffer.is_some(),
            "G-buffer in the style's formats",
            "the style names them",
            if image.is_some() { "the filter reads packed texels" } else { no_lines },
        );
        add(
            gbuffer.is_some_and(|gbuffer| gbuffer.steps.iter().any(Option::is_some)),
            "steps of morphology",
            "the style asks for them",
            if gbuffer.is_some() { "the style has none" } else { "lines come from packed texels, or there are none" },
        );
        let stored = image.is_some_and(|image| image.passes().any(|lines| image.is_stored(lines)));
        let not_stored = if image.is_some() { "the ink is needed by itself" } else { no_lines };
        add(image.is_some() && !stored, "filter and composite in one", "nothing needs the ink in between", not_stored);
        let shadow_lines = image.is_some_and(|image| image.shadow_lines.is_some());
        let drawn = image.is_some_and(|image| image.ink.shadows != ShadowLines::None);
        add(
            shadow_lines,
            "filter for shadows",
            "their lines look different",
            if drawn { "the pass of the objects' lines finds them" } else { "shadows have no lines" },
        );
        add(
            stored,
            "filter",
            "the ink is worked on before it is composited",
            "it is part of the composite, or not needed",
        );
        let thick = image.is_some_and(ImagePlan::has_dilation);
        add(thick, "dilation by a disc", "the style widens lines", "lines are as wide as they are found");
        add(
            other_size,
            "composite",
            "the ink has another size than the picture",
            "the pass before composites the ink, or there is none",
        );

        let paint = self.paint.as_ref();
        let two = style.lights.len() > 1;
        add(
            paint.is_some_and(|paint| paint.lights.len() > 1),
            "second light",
            "the ramp has an axis for it",
            if painted && two { "the shade knows one: all are taken together" } else { "there is one light" },
        );
        add(
            paint.is_some_and(|paint| !paint.light_pairs.is_empty()),
            "two lights for each object",
            "the style has more than two, or objects name theirs",
            "all objects have the same lights",
        );
        add(
            paint.is_some_and(|paint| paint.interpolates_light),
            "positions or light between vertices",
            "a light is near, strokes lie on surfaces, or the style asks for vertices' or faces' light",
            "the light comes from far away, and meets normals at pixels",
        );
        add(
            paint.is_some_and(PaintPlan::lights_faces),
            "one light for a face or a piece of one",
            "the style asks for it",
            "light varies over a face",
        );
        let mapping = self.hatch().map(|hatch| hatch.shade.mapping);
        add(
            mapping.is_some(),
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
        add(
            self.view.samples > 1,
            "resolve",
            "the picture has several samples a pixel",
            "lines and band borders carry their own coverage",
        );
        (self.passes, self.left_out) = (passes, left_out);
    }
}

/// The lines along the cuts of a scene's meshes, if there are any.
fn cut_lines(scene: &Scene) -> Option<Reason> {
    let cuts = || scene.meshes().iter().map(|mesh| mesh.cut_lines()).filter(|cuts| !cuts.edges.is_empty());
    let segments: usize = cuts().map(|cuts| cuts.edges.len()).sum();
    let step = cuts().map(|cuts| cuts.step).max()?;
    let found = match step {
        1 => String::new(),
        _ => format!(", found between every {step} texels, since there are too many"),
    };
    let why = format!("alpha cuts faces: {segments} segments where it passes the cutoff{found}");
    Some(Reason { pass: "lines along cuts", why })
}

/// The part of a picture that a pass makes, for its costs: a tonal art map and its field for strokes, and what surfaces
/// need besides for their light, or for strokes.
pub fn part_of_pass(pass: &str, is_hatched: bool) -> Part {
    match pass {
        "shadow rays" | "geometry: depth, before all" | "shadow volumes into a stencil" | "shadow map" => Part::Shadows,
        GROUND => Part::Shadows,
        "inverted hull: displaced back faces"
        | "printed fins, all edges"
        | "line coverage and ink"
        | "lines along cuts"
        | "blended surfaces from alpha 0.5 on, in depth"
        | "layers of see-through surfaces"
        | "normal, region, depth beside colour"
        | "geometry: normal, region, depth"
        | "G-buffer in the style's formats"
        | "steps of morphology"
        | "filter and composite in one"
        | "filter for shadows"
        | "filter"
        | "dilation by a disc"
        | "composite" => Part::Lines,
        "resolve" => Part::Samples,
        _ if is_hatched => Part::Strokes,
        _ => Part::Light,
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for reason in &self.passes {
            writeln!(f, "  with    {:<36} {}", reason.pass, reason.why)?;
        }
        for reason in &self.left_out {
            writeln!(f, "  without {:<36} {}", reason.pass, reason.why)?;
        }
        for reason in &self.methods {
            writeln!(f, "  method  {:<36} {}", reason.pass, reason.why)?;
        }
        Ok(())
    }
}
