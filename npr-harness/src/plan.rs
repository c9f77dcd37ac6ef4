//! Decides which passes a picture needs.
//!
//! A plan is made from a scene, a style, a view and the executor's capabilities. It holds all decisions, so an executor
//! never reads the style. Data that depend on the scene alone are computed once and shared, so planning another view of
//! the same scene is cheap.

mod explain;
mod ground;
pub mod resources;

pub use explain::part_of_pass;
pub use resources::{Resource, ResourceKind};

use crate::camera::Camera;
use crate::capabilities::Capabilities;
#[cfg(feature = "gpu")]
use crate::edge_lines::EdgeLineMethod;
use crate::edge_lines::EdgeLinePlan;
use crate::edge_lines::authored::{authored_alone, authored_left_out};
use crate::edge_lines::plan::device_bytes;
use crate::error::HarnessError;
use crate::facets::{Facet, facets};
use crate::ground::GroundPlan;
use crate::hatch::{HatchGround, HatchPlan};
use crate::hull_lines::HullPlan;
use crate::image_lines::ImagePlan;
#[cfg(feature = "gpu")]
use crate::image_lines::plan::RegionPlan;
use crate::lights::{LightPair, casting_light, light_pairs, lights_in_world};
use crate::picture_limits::check_picture;
use crate::printed_fins::PrintedFinPlan;
use crate::scene::Scene;
use crate::shade::{Shade, ShadeView};
use crate::shadow::{ShadowLines, ShadowPlan, ShadowTechnique};
use crate::style::Style;
use crate::texel_format::TexelFormat;
use crate::view::View;
use glam::{DVec3, DVec4, Vec3};
use npr_imagespace::artist::LineKind as InnerLines;
use npr_mesh::AlphaMode;
use npr_outline::LineKind;
use npr_toon::normal::NormalUse;
use npr_toon::source::{Light, LightKind, combined_color};
use std::sync::Arc;

/// A pass or a method, and why it is used or left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reason {
    /// The pass.
    pub pass: &'static str,
    /// Why.
    pub why: String,
}

/// How surfaces are painted.
#[derive(Clone, Debug)]
pub struct PaintPlan {
    /// The shade, never [`Shade::Paper`].
    pub shade: Shade,
    /// How the normals of a face are used.
    pub normals: NormalUse,
    /// Per mesh: where and with which normal each face is lit, for [`NormalUse::PerFace`]; else empty.
    pub facets: Vec<Arc<Vec<Facet>>>,
    /// The lights that the shade supports, in scene space.
    pub lights: Vec<Light>,
    /// The combined colour of the lights.
    pub light_color: DVec3,
    /// If each object has two of the lights, the distinct pairs; else empty.
    pub light_pairs: Vec<LightPair>,
    /// Per object: the index of its pair; empty if there are no pairs.
    pub object_pairs: Vec<u32>,
    /// The data of scene and view that the shade uses.
    pub view: ShadeView,
    /// Whether lighting needs more than per-pixel normals and constant light directions: positions, or lighting
    /// computed at vertices or for whole faces.
    pub interpolates_light: bool,
    /// The data for strokes, if surfaces are hatched.
    pub hatch: Option<HatchPlan>,
}

/// The source of what a material emits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) enum Emission {
    /// It emits nothing.
    #[default]
    None,
    /// Its colour.
    Constant,
    /// Its colour times a texture.
    Textured,
}

impl Emission {
    fn of(material: &npr_mesh::Material) -> Self {
        match material.emissive_texture {
            _ if material.emissive == Vec3::ZERO => Self::None,
            None => Self::Constant,
            Some(_) => Self::Textured,
        }
    }
}

/// The passes of a picture, decided once for both executors.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The camera, the size and the samples per pixel.
    pub view: View,
    /// The display-referred background colour.
    pub paper: Vec3,
    /// How surfaces are painted; `None` if they are left as paper.
    pub paint: Option<PaintPlan>,
    /// Whether surfaces are rasterised into the picture's targets, if only to fill the depth buffer.
    pub draws_surfaces: bool,
    /// Whether texture coordinates, textures or vertex colours are read.
    pub looks_up: bool,
    /// Per texture of the scene: whether it is read.
    pub textures: Vec<bool>,
    /// Whether the emission of materials is part of the picture: a material has some, and the surfaces' own colours are
    /// shown.
    pub emits: bool,
    /// Whether any material is alpha-tested.
    pub cut_out: bool,
    /// Whether normals are used untransformed, [`Style::mesh_normals`].
    pub mesh_normals: bool,
    /// Whether any material is alpha-blended.
    pub blended: bool,
    /// Whether blended surfaces, where their alpha is at least 0.5, are drawn into depth and G-buffer after all others, so
    /// that they hide lines behind them and have lines of their own.
    pub blended_hide: bool,
    /// Whether the nearest layers of blended surfaces with an alpha below 0.5 are drawn by themselves, since they dim the
    /// edge lines behind them.
    pub veiled: bool,
    /// Whether back faces are culled although their material is double-sided, because they cannot be visible.
    pub cull_back: bool,
    /// The inverted hulls.
    pub hulls: Option<HullPlan>,
    /// The printed fins.
    pub printed_fins: Option<PrintedFinPlan>,
    /// Lines along edges.
    pub edge_lines: Option<EdgeLinePlan>,
    /// Lines found in the image.
    pub image: Option<ImagePlan>,
    /// Shadows, if any part of the picture shows them.
    pub shadow: Option<ShadowPlan>,
    /// Whether six-tone tonal art maps are stored as half floats on the GPU, else as bytes.
    pub half_float_maps: bool,
    /// The passes, in order.
    pub passes: Vec<Reason>,
    /// The passes that were left out.
    pub left_out: Vec<Reason>,
    /// By which methods an adapter makes passes; none for the CPU, which has one for each.
    pub methods: Vec<Reason>,
}

impl Plan {
    /// Decides which passes a style needs for a scene in a view, and how an executor performs them.
    ///
    /// # Errors
    /// Errors of the style ([`Style::validate`]), of its lines and of its tonal art map;
    /// [`HarnessError::ClippedEdges`], [`HarnessError::ShadowMapLight`], [`HarnessError::ObjectLights`]; [`HarnessError::Size`] and
    /// [`HarnessError::PictureMemory`]; and if the adapter lacks a capability: [`HarnessError::TextureTooLarge`],
    /// [`HarnessError::ParallelVolumes`], [`HarnessError::FloatTargets`].
    pub fn new(scene: &Scene, style: &Style, view: &View, capabilities: &Capabilities) -> Result<Self, HarnessError> {
        style.validate()?;
        let view = View { samples: view.samples.max(1), ..*view };
        check_picture(style, view.size, view.samples, capabilities.is_adapter(), capabilities.memory_bytes)?;
        let lines = &style.lines;
        let of_model = lines.edges.is_some() || lines.printed.is_some() || lines.hull.is_some();
        if scene.clip.is_some() && of_model {
            return Err(HarnessError::ClippedEdges { style: style.name.clone() });
        }
        let used = |test: &dyn Fn(&npr_mesh::Material) -> bool| scene.materials().iter().any(test);
        let paint = match style.shade {
            Shade::Paper => None,
            _ => Some(PaintPlan::new(scene, style, &view.camera)?),
        };
        let image = match &lines.image {
            Some(ink) => Some(ImagePlan::new(scene, ink, style.crease_angle_rad, &view)?),
            None => None,
        };
        let is_outside = scene.clip.is_none() && !sees_the_inside(scene, &view.camera);
        let edge_lines = match &lines.edges.or_else(|| authored_alone(scene, lines)) {
            Some(edges) => {
                let method = |bytes| capabilities.edge_lines(bytes, scene.objects().len()).0;
                let angles = (style.crease_angle_rad, style.file_edges);
                Some(EdgeLinePlan::new(scene, edges, angles, is_outside, method)?)
            }
            None => None,
        };
        let hulls = lines.hull.map(|hull| HullPlan::new(scene, hull));
        let printed_fins = lines.printed.map(|printed| PrintedFinPlan::new(scene, printed));
        let cut_out = used(&|m| matches!(m.alpha_mode, AlphaMode::Mask { .. }));
        let colored = || scene.meshes().iter().any(|mesh| !mesh.model().colors.is_empty());
        let shows_colors = paint.as_ref().is_some_and(PaintPlan::shows_surface_color);
        let blended = paint.is_some() && scene.has_blend();
        let emits = shows_colors && used(&|m| m.emissive != Vec3::ZERO);
        let has_lines = edge_lines.is_some() || printed_fins.is_some() || hulls.is_some() || image.is_some();
        let blended_hide = has_lines && scene.has_hiding_blend();
        let veiled = edge_lines.is_some() && scene.has_veils();
        let by_alpha = blended || blended_hide || veiled;
        let textured = (shows_colors || by_alpha) && (used(&|m| m.texture.is_some()) || colored())
            || emits && used(&|m| Emission::of(m) == Emission::Textured);
        let says_lines = |image: &ImagePlan| image.line_kinds.iter().any(|&kind| kind != InnerLines::Normals);
        let textures = textures(scene, shows_colors, emits, by_alpha, image.as_ref());
        let beside_picture = image.as_ref().is_some_and(|image| !image.own_surfaces);
        let mut plan = Self {
            view,
            paper: style.paper,
            draws_surfaces: paint.is_some()
                || edge_lines.is_some()
                || printed_fins.is_some()
                || hulls.is_some()
                || beside_picture,
            looks_up: textured || cut_out || image.as_ref().is_some_and(says_lines),
            textures,
            emits,
            cut_out,
            mesh_normals: style.mesh_normals,
            blended,
            blended_hide,
            veiled,
            cull_back: scene.is_closed() && !scene.is_see_through() && is_outside,
            shadow: None,
            half_float_maps: capabilities.half_float_maps().0,
            passes: Vec::new(),
            left_out: Vec::new(),
            methods: Vec::new(),
            paint,
            hulls,
            printed_fins,
            edge_lines,
            image,
        };
        plan.shadow = plan.shadow(scene, style, capabilities)?;
        if capabilities.is_adapter() {
            plan.methods = plan.methods(scene, capabilities)?;
        }
        plan.explain(style, textured);
        plan.explain_ground(scene);
        let authored = authored_left_out(scene, style, plan.edge_lines.as_ref());
        plan.left_out.extend(authored.map(|why| Reason { pass: "lines of the file", why: why.to_owned() }));
        plan.explain_cut_lines(scene);
        Ok(plan)
    }

    fn shadow(
        &self,
        scene: &Scene,
        style: &Style,
        capabilities: &Capabilities,
    ) -> Result<Option<ShadowPlan>, HarnessError> {
        let drawn = self.image.as_ref().filter(|image| image.ink.shadows != ShadowLines::None);
        let in_lines = drawn.is_some_and(|image| image.own_surfaces);
        let in_picture = self.paint.is_some() || drawn.is_some() && !in_lines;
        let Some(shadow) = style.shadow.as_ref().filter(|_| in_picture || in_lines) else { return Ok(None) };
        let light = casting_light(&style.lights, scene, &self.view.camera);
        let of_device = || (capabilities.volumes(scene.objects().len()).0, capabilities.float_stencil);
        let device = capabilities.is_adapter().then(of_device);
        let (technique, because) = ShadowTechnique::new(scene, shadow, light, device, capabilities.texture_px)?;
        let ground = if scene.ground { GroundPlan::new(scene, light) } else { None };
        Ok(Some(ShadowPlan { light, terminator: shadow.terminator, technique, in_picture, in_lines, ground, because }))
    }

    /// Chooses the methods by which an adapter performs the passes, or fails if it cannot.
    fn methods(&self, scene: &Scene, capabilities: &Capabilities) -> Result<Vec<Reason>, HarnessError> {
        capabilities.check_size("the picture", self.view.size)?;
        capabilities.check_size("the picture's samples", self.view.sampled_size())?;
        let mut methods = Vec::new();
        let mut add = |pass, why: &str| methods.push(Reason { pass, why: why.to_owned() });
        if let Some(EdgeLinePlan { contours, .. }) = &self.edge_lines {
            let (bytes, objects) = (device_bytes(scene, contours), scene.objects().len());
            add("edge lines", &capabilities.edge_lines(bytes, objects).1);
        }
        if let Some(image) = &self.image {
            capabilities.check_size("the ink", image.size)?;
            let targets = image.gbuffer.as_ref().map(|plan| plan.gbuffer.encoded());
            let is_float = |format: &TexelFormat| [TexelFormat::Rgba32Float, TexelFormat::R32Float].contains(format);
            if targets.into_iter().flatten().flatten().any(|format| is_float(&format)) && !capabilities.float_targets {
                return Err(HarnessError::FloatTargets);
            }
        }
        match self.shadow.as_ref().map(|shadow| &shadow.technique) {
            Some(ShadowTechnique::Volumes { float_depth, .. }) => {
                if self.view.is_parallel() && !capabilities.unclipped_depth {
                    return Err(HarnessError::ParallelVolumes);
                }
                add("shadow volumes", capabilities.volumes(scene.objects().len()).1);
                add(
                    "shadow volumes",
                    match float_depth {
                        true => "depths of 32-bit floats",
                        false => "depths of 24 bits: the adapter has no stencil beside floats",
                    },
                );
            }
            Some(&ShadowTechnique::Map { side, .. }) => {
                capabilities.check_size("the shadow map", (side, side))?;
                add("shadow map", "depths of 32-bit floats");
            }
            Some(ShadowTechnique::Rays) | None => {}
        }
        if let Some(hatch) = self.hatch() {
            let side = hatch.tam()?.side;
            capabilities.check_size("the tonal art map", (side, side))?;
            add("tonal art map", capabilities.half_float_maps().1);
        }
        if let Some(paint) = self.paint.as_ref().filter(|paint| paint.lights_faces()) {
            let texels = paint.corner_texels(scene);
            capabilities.check_size("the faces' corners", corner_texture_size(texels, capabilities.texture_px))?;
            add("light of faces", "corners of faces in a texture, which vertex shaders read");
        }
        if self.looks_up {
            for (texture, _) in scene.textures().iter().zip(&self.textures).filter(|(_, used)| **used) {
                capabilities.check_size("a texture of the model", (texture.width, texture.height))?;
            }
        }
        if !capabilities.exact_depth {
            add("depth", "multiples of 2^-24: OpenGL brings depths from 0..1 to -1..1 and back");
        }
        Ok(methods)
    }

    /// The same plan for an adapter whose driver rejects compute shaders although it reported support for them.
    #[cfg(feature = "gpu")]
    pub fn without_compute(&self, no_compute: &'static str) -> Self {
        let mut plan = self.clone();
        if let Some(edge_lines) = &mut plan.edge_lines {
            edge_lines.method = EdgeLineMethod::OnCpu;
        }
        for method in plan.methods.iter_mut().filter(|method| method.pass == "edge lines") {
            method.why = format!("found on the CPU, drawn as rectangles: {no_compute}");
        }
        plan
    }

    /// Whether a pass runs as a compute shader.
    #[cfg(feature = "gpu")]
    pub(crate) fn computes(&self) -> bool {
        self.edge_lines.as_ref().is_some_and(|lines| lines.method == EdgeLineMethod::OnDevice)
    }

    /// Per object: the index of its pair of lights; empty if there are no pairs.
    #[cfg(feature = "gpu")]
    pub(crate) fn object_pairs(&self) -> &[u32] {
        self.paint.as_ref().map_or(&[], |paint| &paint.object_pairs)
    }

    /// The regions of faces, if lines are found in the image.
    #[cfg(feature = "gpu")]
    pub(crate) fn regions(&self) -> Option<&RegionPlan> {
        self.image.as_ref().map(|image| &image.regions)
    }

    /// What a material adds to the shaded colour of its surfaces.
    pub(crate) fn emission(&self, material: &npr_mesh::Material) -> Emission {
        if self.emits { Emission::of(material) } else { Emission::None }
    }

    /// The data for strokes, if surfaces are hatched.
    pub fn hatch(&self) -> Option<&HatchPlan> {
        self.paint.as_ref().and_then(|paint| paint.hatch.as_ref())
    }

    /// The edges that are lines in the plan's view, as (object, edge), and the number of lines of each [`LineKind`].
    pub fn lines(&self, scene: &Scene) -> (Vec<[u32; 2]>, [usize; LineKind::ALL.len()]) {
        let eye = self.view.camera.homogeneous_eye();
        self.edge_lines.as_ref().map_or_else(Default::default, |lines| lines.lines(scene, eye))
    }
}

impl PaintPlan {
    fn new(scene: &Scene, style: &Style, camera: &Camera) -> Result<Self, HarnessError> {
        let model = style.shade.model();
        let hatch = match &style.shade {
            Shade::Hatch(shade) => Some(HatchPlan::new(scene, shade, style.normals == NormalUse::PerVertex)?),
            _ => None,
        };
        let lights = lights_in_world(&style.lights, model.lights(), scene, camera);
        let has_own = || scene.objects().iter().any(|object| object.lights().is_some());
        let (light_pairs, object_pairs) = if model.pairs_lights() && (lights.len() > 2 || has_own()) {
            light_pairs(&lights, scene, style.shadow.is_some())?
        } else {
            (Vec::new(), Vec::new())
        };
        let is_near = |light: &Light| matches!(light.place, LightKind::Positional { .. });
        let interpolates_light = !model.is_normals()
            && (hatch.is_some()
                || style.normals != NormalUse::PerPixel
                || model.needs_position()
                || lights.iter().any(is_near));
        let lights_faces = interpolates_light && style.normals == NormalUse::PerFace;
        Ok(Self {
            shade: style.shade.clone(),
            normals: style.normals,
            facets: if lights_faces { scene.meshes().iter().map(|mesh| facets(mesh)).collect() } else { Vec::new() },
            light_color: combined_color(&lights),
            view: ShadeView { eye_depth: eye_depth_plane(camera), depth_range: scene.depth_range(camera) },
            lights,
            light_pairs,
            object_pairs,
            interpolates_light,
            hatch,
        })
    }
}

impl PaintPlan {
    /// The lights of an object, and their combined colour.
    pub fn lights_of(&self, object: u32) -> (&[Light], DVec3) {
        match self.object_pairs.get(object as usize) {
            Some(&pair) => (&self.light_pairs[pair as usize].lights, self.light_pairs[pair as usize].color),
            None => (&self.lights, self.light_color),
        }
    }

    /// Whether the surfaces' own colours are part of the picture.
    pub fn shows_surface_color(&self) -> bool {
        match &self.hatch {
            Some(hatch) => hatch.shade.ground == HatchGround::Surface,
            None => self.shade.model().shows_surface_color(),
        }
    }

    /// Whether light is constant over faces or pieces of faces.
    pub fn lights_faces(&self) -> bool {
        self.interpolates_light && self.normals.is_constant()
    }

    /// The number of texels from which a device reads where faces are lit: two, a position and a normal, per face or per
    /// corner.
    pub(crate) fn corner_texels(&self, scene: &Scene) -> usize {
        let per_face = if self.normals == NormalUse::PerFace { 2 } else { 6 };
        scene.meshes().iter().map(|mesh| per_face * mesh.model().faces.len()).sum()
    }
}

/// Per texture of a scene: whether a picture depends on it. It does by a colour that is shown or emitted, by alpha, or by
/// lines that an artist drew.
fn textures(scene: &Scene, shows_colors: bool, emits: bool, blended: bool, image: Option<&ImagePlan>) -> Vec<bool> {
    let mut used = vec![false; scene.textures().len()];
    for (number, material) in scene.materials().iter().enumerate() {
        let Some(texture) = material.texture else { continue };
        let line_kind = image.map(|image| image.line_kinds[number]);
        used[texture as usize] |= shows_colors
            || matches!(material.alpha_mode, AlphaMode::Mask { .. })
            || blended && material.alpha_mode == AlphaMode::Blend
            || matches!(line_kind, Some(InnerLines::Texture | InnerLines::Regions));
    }
    if emits {
        for material in scene.materials().iter().filter(|material| Emission::of(material) == Emission::Textured) {
            material.emissive_texture.into_iter().for_each(|texture| used[texture as usize] = true);
        }
    }
    used
}

/// The size of a texture for these texels, in rows of up to 4096; no wider than one row of them.
pub(crate) fn corner_texture_size(texels: usize, texture_px: u32) -> (u32, u32) {
    let width = u32::try_from(texels).unwrap_or(u32::MAX).clamp(1, texture_px.clamp(1, 4096));
    (width, u32::try_from(texels.div_ceil(width as usize).max(1)).unwrap_or(u32::MAX))
}

/// The plane (n, d) such that n · p + d is the eye depth of a point p.
fn eye_depth_plane(camera: &Camera) -> DVec4 {
    let back = camera.axes()[2];
    (-back).extend(back.dot(camera.eye))
}

/// Whether the eye or the near plane lies within the model's bounding box, so that back faces may be visible.
fn sees_the_inside(scene: &Scene, camera: &Camera) -> bool {
    let Some((low, high)) = scene.bounds() else { return false };
    let margin = scene.radius() * 1e-3 + 2.0 * camera.near;
    let (low, high) = (low.as_dvec3() - margin, high.as_dvec3() + margin);
    camera.eye.cmpge(low).all() && camera.eye.cmple(high).all()
}
