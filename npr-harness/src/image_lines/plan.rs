//! The part of a plan for image-space lines.

use super::gbuffer::plan::GBufferPlan;
use super::gbuffer::style::Show;
use super::style::{ImageInk, InkScale, Regions};
use crate::camera::{Camera, Projection};
use crate::error::HarnessError;
use crate::scene::{Mesh, Object, Scene};
use crate::shadow::ShadowLines;
use crate::view::View;
use glam::UVec2;
use npr_imagespace::ImageSpaceError;
use npr_imagespace::artist::{ArtistRotation, LineKind};
use npr_imagespace::composite::Composite;
use npr_imagespace::filter::fused::{FilterUniform, FusedFilter, ShadowTest, ink_fused};
use npr_imagespace::format::texel::{DepthCode, TexelLayout, ink_fold_region, ink_texel32_tap, ink_texel64_tap};
use npr_imagespace::morphology::disc::Disc;
use npr_imagespace::morphology::flood::{FloodPlan, disc_plan, flood};
use npr_imagespace::picture::filter_picture;
use npr_imagespace::region::{region_of_index, region_of_pairs, region_of_patches};
use npr_mesh::edges::{Edge, EdgeKind};
use std::sync::Arc;

/// The part of a plan for image-space lines.
#[derive(Clone, Debug, PartialEq)]
pub struct ImagePlan {
    /// The settings of the style. In a parallel view the depth step is in scene units.
    pub ink: ImageInk,
    /// The encoding of eye depth: the scene's depth range, limited by the near plane.
    pub code: DepthCode,
    /// The region of each face.
    pub regions: RegionPlan,
    /// Per material: the source of its inner lines.
    pub line_kinds: Vec<LineKind>,
    /// The lines of objects, and those of shadows if the same pass draws them.
    pub lines: ImageLines,
    /// The lines of shadows if a separate pass draws them, below the others.
    pub shadow_lines: Option<ImageLines>,
    /// Width and height of the target in which they are found, px.
    pub size: (u32, u32),
    /// The G-buffer that replaces packed texels and fused filter, if the style asks for one.
    pub gbuffer: Option<GBufferPlan>,
    /// Whether the ink has its own geometry pass, because the picture has another size or several samples per pixel.
    pub own_surfaces: bool,
}

/// The regions of faces: numbers from 1 within a mesh, and an offset per object.
#[derive(Clone, Debug, PartialEq)]
pub struct RegionPlan {
    /// Per mesh and face.
    pub of_meshes: Vec<Arc<Vec<u32>>>,
    /// Per mesh: the region of all its faces, if they have one.
    pub of_whole_meshes: Vec<Option<u32>>,
    /// Per object: the offset, and whether the whole object is one region.
    pub of_objects: Vec<(u32, bool)>,
    /// The largest region number that a texel holds; larger numbers are folded into the range.
    pub most: u32,
}

impl RegionPlan {
    /// The folded region number of an object's face.
    pub fn of_face(&self, scene: &Scene, object: u32, face: u32) -> u32 {
        let (first, is_all) = self.of_objects[object as usize];
        let of_mesh = &self.of_meshes[scene.objects()[object as usize].mesh()];
        ink_fold_region(first + if is_all { 0 } else { of_mesh[face as usize] }, self.most)
    }

    /// The offset added to the region of an object's vertices, and the factor applied to it before. Where each mesh is one
    /// region, the offset includes it.
    #[cfg(feature = "gpu")]
    pub(crate) fn of_instance(&self, scene: &Scene, object: u32) -> (u32, u32) {
        let (first, is_all) = self.of_objects[object as usize];
        let of_mesh = self.of_whole_meshes[scene.objects()[object as usize].mesh()];
        match of_mesh {
            _ if is_all => (first, 0),
            Some(region) if !self.of_whole_meshes.contains(&None) => (first.wrapping_add(region), 0),
            _ => (first, 1),
        }
    }

    fn new(
        scene: &Scene,
        by: Regions,
        line_kinds: &[LineKind],
        crease_angle_rad: f32,
        most: u32,
    ) -> Result<Self, HarnessError> {
        let of_mesh = |(number, mesh): (usize, &Arc<Mesh>)| {
            let line_kinds = &line_kinds[scene.materials_of(number)];
            let key = FaceRegionKey { regions: by, crease_angle_rad, line_kinds: line_kinds.to_vec() };
            mesh.derived().get(key, || face_regions(mesh, by, line_kinds, crease_angle_rad))
        };
        let of_meshes = scene.meshes().iter().enumerate().map(of_mesh).collect::<Result<Vec<_>, _>>()?;
        let count = |regions: &Arc<Vec<u32>>| regions.iter().copied().max().unwrap_or(0);
        let counts: Vec<u32> = of_meshes.iter().map(count).collect();
        let whole = |regions: &Arc<Vec<u32>>| match regions.first() {
            Some(&first) => regions.iter().all(|&region| region == first).then_some(first),
            None => Some(0),
        };
        let of_whole_meshes = of_meshes.iter().map(whole).collect();
        let mut next = 0u32;
        let of_object = |object: &Object| {
            let (material, is_one) = object.first_material();
            match by {
                Regions::One => (0, false),
                Regions::Material if is_one => (region_of_index(material as u32), true),
                Regions::Material => (material as u32, false),
                Regions::Mesh | Regions::Patch => {
                    let first = next;
                    next = next.wrapping_add(counts[object.mesh()]);
                    (first, false)
                }
            }
        };
        let of_objects = scene.objects().iter().map(of_object).collect();
        Ok(Self { of_meshes, of_whole_meshes, of_objects, most })
    }
}

/// The cache key of a mesh's regions.
#[derive(PartialEq)]
struct FaceRegionKey {
    regions: Regions,
    crease_angle_rad: f32,
    line_kinds: Vec<LineKind>,
}

/// One pass of lines.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageLines {
    /// The filter that detects lines.
    pub filter: FusedFilter,
    /// The disc by which lines are dilated, if any.
    pub dilation: Option<Disc>,
    /// The passes of the dilation, if any.
    flood: Option<FloodPlan>,
    /// How lines are composited over the picture.
    pub composite: Composite,
}

impl ImageLines {
    fn new(filter: FusedFilter, dilation: Option<Disc>, composite: Composite) -> Result<Self, ImageSpaceError> {
        if let Some(disc) = dilation {
            // Validates the radius.
            flood(&[], UVec2::ZERO, &disc, &FloodPlan { passes: Vec::new() })?;
        }
        Ok(Self { filter, dilation, flood: dilation.map(|disc| disc_plan(&disc)), composite })
    }
}

impl ImageLines {
    /// The ink after the dilation, if any.
    pub(crate) fn dilated(&self, ink: Vec<u8>, size_px: UVec2) -> Vec<u8> {
        match (&self.dilation, &self.flood) {
            (Some(disc), Some(plan)) => flood(&ink, size_px, disc, plan).expect("the disc was checked"),
            _ => ink,
        }
    }
}

impl ImagePlan {
    /// # Errors
    /// An error if a threshold or the dilation is out of range.
    pub(crate) fn new(scene: &Scene, ink: &ImageInk, crease_angle_rad: f32, view: &View) -> Result<Self, HarnessError> {
        ink.validate()?;
        let camera = &view.camera;
        let code = depth_code(scene, camera, ink.layout)?;
        let mut ink = *ink;
        if let (Projection::Orthographic { .. }, Some(test)) = (camera.projection, &mut ink.filter.depth) {
            // Limited to the largest f32, with which no depth step is a line.
            test.step = (test.step * 2.0 * scene.radius() as f32).min(f32::MAX);
        }
        let test = match ink.shadows {
            ShadowLines::None | ShadowLines::Negated => ShadowTest::NoStates,
            ShadowLines::Lines => ShadowTest::Lines,
            ShadowLines::Separate { .. } => ShadowTest::Ignored,
        };
        // The co-issued reading has its alpha test in the filter.
        let is_tested = ink.gbuffer.is_some_and(|gbuffer| gbuffer.is_co_issued());
        let composite = if is_tested { Composite::Multiply } else { ink.composite };
        let lines = ImageLines::new(FusedFilter { shadows: test, ..ink.filter }, ink.dilation, composite)?;
        FilterUniform::new(&lines.filter, ink.layout, &code)?;
        let shadow_lines = match ink.shadows {
            ShadowLines::Separate { composite, dilation } => Some(ImageLines::new(
                FusedFilter { shadows: ShadowTest::OnlyShadows, ..ink.filter },
                dilation,
                composite,
            )?),
            _ => None,
        };
        let materials = scene.materials().len();
        let mut line_kinds = if ink.artist.is_some() { scene.line_kinds.clone() } else { Vec::new() };
        line_kinds.resize(materials, LineKind::Normals);
        let most = ink.region_max();
        let regions = RegionPlan::new(scene, ink.regions, &line_kinds, crease_angle_rad, most)?;
        let gbuffer = ink.gbuffer.as_ref().map(|gbuffer| GBufferPlan::new(scene, gbuffer, camera)).transpose()?;
        let own_surfaces = ink.scale != InkScale::One || view.samples > 1;
        let size = ink.scale.size(view.size);
        Ok(Self { ink, code, regions, line_kinds, lines, shadow_lines, size, gbuffer, own_surfaces })
    }

    /// How the directions of a material's lines are rotated. A texture is sampled at the pixel, so that there are no
    /// directions at its vertices: with rotations per vertex it has one for the object, as printed.
    pub fn artist_rotation(&self, material: usize) -> ArtistRotation {
        match (self.ink.artist.unwrap_or_default(), self.line_kinds[material]) {
            (ArtistRotation::PerVertex, LineKind::Texture) => ArtistRotation::PerObject,
            (rotation, LineKind::VertexColor | LineKind::Texture) => rotation,
            (_, LineKind::Normals | LineKind::Regions | LineKind::None) => ArtistRotation::PerPixel,
        }
    }

    /// Whether the ink must be stored before it is composited: for a dilation, because its size differs from the
    /// picture's, or because a G-buffer's own filters and steps make it.
    pub(crate) fn is_stored(&self, lines: &ImageLines) -> bool {
        lines.dilation.is_some() || self.ink.scale != InkScale::One || self.gbuffer.is_some()
    }

    /// The encoding from the value of the depth buffer instead of eye depth. Of a G-buffer the depth itself.
    pub fn buffer_code(&self, camera: &Camera) -> DepthCode {
        if let Some(gbuffer) = &self.gbuffer {
            return gbuffer.buffer;
        }
        match camera.projection {
            Projection::Perspective { .. } => self.code.of_buffer(0.0, 1.0 / camera.near),
            Projection::Orthographic { far, .. } => self.code.of_buffer(far, camera.near - far),
        }
    }

    /// The passes of lines, in the order in which they are composited.
    pub fn passes(&self) -> impl Iterator<Item = &ImageLines> {
        self.shadow_lines.iter().chain(std::iter::once(&self.lines))
    }

    /// Whether lines are found, not the G-buffer itself shown.
    pub(crate) fn finds_lines(&self) -> bool {
        self.gbuffer.as_ref().is_none_or(|plan| plan.gbuffer.show == Show::Lines)
    }

    /// Whether the ink of any pass is stored.
    pub(crate) fn stores_ink(&self) -> bool {
        self.finds_lines() && self.passes().any(|lines| self.is_stored(lines))
    }

    /// Whether any lines are dilated.
    pub(crate) fn has_dilation(&self) -> bool {
        self.passes().any(|lines| lines.dilation.is_some())
    }

    /// The reference implementation: finds and dilates lines in a packed G-buffer, and returns the ink.
    ///
    /// - `lines`: [`ImagePlan::lines`] or [`ImagePlan::shadow_lines`];
    /// - `texels`: packed by [`ImageInk::layout`]; with 32 bits the second word is ignored.
    ///
    /// # Panics
    /// If `texels` does not have one element per pixel.
    pub fn ink(&self, lines: &ImageLines, texels: &[[u32; 2]]) -> Vec<u8> {
        let size_px = UVec2::from(self.size);
        let filter = &lines.filter;
        let uniform = FilterUniform::new(filter, self.ink.layout, &self.code).expect("it was checked");
        let tap = |words: [u32; 2]| match self.ink.layout {
            TexelLayout::Bits32 => ink_texel32_tap(words[0]),
            TexelLayout::Bits64 => ink_texel64_tap(words),
        };
        let found = filter_picture(texels, size_px, filter.taps, |centre, taps| {
            ink_fused(&uniform, &tap(centre), &taps.map(tap)) as f32
        })
        .expect("a texel for each pixel");
        lines.dilated(found, size_px)
    }
}

fn depth_code(scene: &Scene, camera: &Camera, layout: TexelLayout) -> Result<DepthCode, ImageSpaceError> {
    let (near, far) = scene.depth_range(camera);
    match camera.projection {
        Projection::Perspective { .. } => DepthCode::perspective(near as f32, far as f32, layout),
        Projection::Orthographic { .. } => DepthCode::parallel(near as f32, far as f32, layout),
    }
}

/// Per face: its region. Only materials whose lines come from normals or regions are split into patches. For the others
/// a mesh is one region, so that only the artist's lines are drawn in it.
fn face_regions(
    mesh: &Mesh,
    by: Regions,
    line_kinds: &[LineKind],
    crease_angle_rad: f32,
) -> Result<Vec<u32>, ImageSpaceError> {
    let (model, edges) = (mesh.model(), mesh.edges());
    let faces = model.faces.len();
    let materials = || model.face_material.iter().map(|&material| region_of_index(material));
    let meshes = || {
        let one = (model.face_mesh.is_empty()).then_some(region_of_index(0));
        let each = model.face_mesh.iter().map(|&mesh| region_of_index(mesh));
        each.chain(std::iter::repeat_n(one, faces).flatten())
    };
    match by {
        Regions::One => Ok(vec![1; faces]),
        Regions::Material => Ok(materials().collect()),
        Regions::Mesh => Ok(meshes().collect()),
        Regions::Patch => {
            let is_smooth = |edge: &Edge| {
                edge.kind() == EdgeKind::TwoFace
                    && edges.dihedral_rad(edge).is_some_and(|angle| angle <= crease_angle_rad)
            };
            let smooth = edges.edges.iter().filter(|edge| is_smooth(edge)).map(Edge::faces);
            // Of faces at one place only one has edges.
            let overlaps = edges.overlaps.iter().copied();
            let pairs: Vec<[u32; 2]> = smooth.chain(same_polygon(&model.face_polygon)).chain(overlaps).collect();
            let mut patches = region_of_patches(faces, &pairs)?;
            for ((patch, &material), mesh) in patches.iter_mut().zip(&model.face_material).zip(meshes()) {
                if !matches!(line_kinds[material as usize], LineKind::Normals | LineKind::Regions) {
                    *patch = mesh;
                }
            }
            Ok(region_of_pairs(patches.into_iter().zip(materials()).map(<[u32; 2]>::from)))
        }
    }
}

/// Pairs of neighbouring triangles of one polygon; the edge between them is not an edge of the model.
fn same_polygon(face_polygon: &[u32]) -> impl Iterator<Item = [u32; 2]> + '_ {
    face_polygon
        .windows(2)
        .zip(0u32..)
        .filter(|(polygons, _)| polygons[0] == polygons[1])
        .map(|(_, face)| [face, face + 1])
}
