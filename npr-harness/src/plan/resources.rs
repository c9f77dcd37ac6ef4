//! What a plan takes in memory: render targets, textures and buffers of an adapter, arrays of the CPU executor.

use super::{Plan, corner_texture_size};
use crate::capabilities::Capabilities;
use crate::edge_lines::EdgeLineMethod;
use crate::error::HarnessError;
use crate::geometry::{
    COLOR_BYTES, DIRECTION_BYTES, INSTANCE_BYTES, NORMAL_BYTES, OCTAVE_BYTES, POSITION_BYTES, REGION_BYTES, Streams,
    UV_BYTES, blended_faces, index_bytes, index_count, material_table, sources, splits,
};
use crate::image_lines::InkScale;
use crate::scene::Scene;
use crate::shadow::{ShadowTechnique, VolumeMethod};
use crate::texel_format::{
    COLOR, COVERAGE, DEPTH, INK, SHADOW_MAP, SHADOW_MASK, TexelFormat, UNQUANTISED, level_count, stencil_format,
};
use glam::DVec4;
use npr_imagespace::format::texel::TexelLayout;
use npr_imagespace::morphology::disc::{SITE_PX, WORD_PX};
use npr_outline::ContourEdges;
use npr_outline::segment::VEIL_LAYERS;
use npr_toon::painter::PainterUniform;
use std::fmt;
use std::sync::Arc;

/// The record of a line that a scan on the CPU found, bytes.
const RECORD_BYTES: u64 = 52;

/// The format of packed texels.
const fn packed(layout: TexelLayout) -> TexelFormat {
    match layout {
        TexelLayout::Bits32 => TexelFormat::R32Uint,
        TexelLayout::Bits64 => TexelFormat::Rg32Uint,
    }
}

/// What a resource is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResourceKind {
    /// A texture that a frame renders into, on an adapter.
    Target {
        /// Of its texels.
        format: TexelFormat,
        /// Width and height, texels.
        size: (u32, u32),
        /// Its texels along each axis of a pixel of the picture. There are no multisampled textures.
        samples: u32,
    },
    /// A texture that is uploaded, on an adapter.
    Texture {
        /// Of its texels.
        format: TexelFormat,
        /// Width and height of the largest level, texels.
        size: (u32, u32),
        /// The number of levels.
        levels: u32,
    },
    /// A buffer on an adapter.
    Buffer {
        /// Whether the size is a bound, because it depends on what a frame finds.
        is_bound: bool,
    },
    /// An array of the CPU executor.
    Array,
}

/// Something that takes memory while a plan is executed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Resource {
    /// On an adapter the label of the object.
    pub name: String,
    /// What it is.
    pub kind: ResourceKind,
    /// The number of such objects.
    pub count: u32,
    /// The size of all of them together, bytes. It does not include what drivers add, such as the padding of rows.
    pub bytes: u64,
}

impl fmt::Display for Resource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, kind, count, bytes } = self;
        let what = match kind {
            ResourceKind::Target { format, size: (width, height), .. } => format!("target {format:?} {width}×{height}"),
            ResourceKind::Texture { format, size: (width, height), levels } => {
                format!("texture {format:?} {width}×{height}, {levels} levels")
            }
            ResourceKind::Buffer { is_bound: false } => "buffer".into(),
            ResourceKind::Buffer { is_bound: true } => "buffer, at most".into(),
            ResourceKind::Array => "array".into(),
        };
        let times = if *count == 1 { String::new() } else { format!("{count} × ") };
        write!(f, "{bytes:>12} {name:<36} {times}{what}")
    }
}

/// The sum of the sizes of some resources, bytes.
pub fn total_bytes(resources: &[Resource]) -> u64 {
    resources.iter().map(|resource| resource.bytes).sum()
}

/// A list of resources; equal ones are counted together.
#[derive(Default)]
struct List(Vec<Resource>);

impl List {
    fn add(&mut self, name: &str, kind: ResourceKind, bytes: u64) {
        let is_same = |known: &&mut Resource| known.name == name && known.kind == kind;
        match self.0.iter_mut().find(is_same) {
            Some(known) => {
                known.count += 1;
                known.bytes += bytes;
            }
            None => self.0.push(Resource { name: name.to_owned(), kind, count: 1, bytes }),
        }
    }

    fn target(&mut self, name: &str, format: TexelFormat, size: (u32, u32), samples: u32) {
        let bytes = format.bytes() * u64::from(size.0) * u64::from(size.1);
        self.add(name, ResourceKind::Target { format, size, samples }, bytes);
    }

    fn texture(&mut self, name: &str, format: TexelFormat, size: (u32, u32), levels: u32) {
        let of_level = |level: u32| u64::from((size.0 >> level).max(1)) * u64::from((size.1 >> level).max(1));
        let bytes = format.bytes() * (0..levels).map(of_level).sum::<u64>();
        self.add(name, ResourceKind::Texture { format, size, levels }, bytes);
    }

    /// A buffer, unless it is empty. Buffers are padded to whole words.
    fn buffer(&mut self, name: &str, bytes: u64) {
        if bytes > 0 {
            self.add(name, ResourceKind::Buffer { is_bound: false }, bytes.next_multiple_of(4));
        }
    }

    fn array<T>(&mut self, name: &str, elements: u64) {
        if elements > 0 {
            self.add(name, ResourceKind::Array, elements * size_of::<T>() as u64);
        }
    }
}

fn area((width, height): (u32, u32)) -> u64 {
    u64::from(width) * u64::from(height)
}

impl Plan {
    /// What executing this plan takes in memory besides the scene itself. On an adapter: render targets, textures and
    /// buffers, without uniforms of a few hundred bytes and textures of one texel, which stand where a shader declares
    /// what it does not read. On the CPU: arrays per pixel and hierarchies.
    ///
    /// `capabilities`: those that the plan was made with. The hierarchy of the CPU executor is built if it is not yet.
    ///
    /// # Errors
    /// Those of the tonal art map and of the shade's numbers, which planning has found before.
    pub fn resources(&self, scene: &Scene, capabilities: &Capabilities) -> Result<Vec<Resource>, HarnessError> {
        let mut list = List::default();
        if capabilities.is_adapter() {
            self.targets(scene, &mut list);
            self.uploaded_textures(scene, capabilities, &mut list)?;
            self.vertex_buffers(scene, capabilities, &mut list);
            self.edge_buffers(scene, &mut list);
            self.shadow_buffers(scene, &mut list);
        } else {
            self.arrays(scene, &mut list);
        }
        Ok(list.0)
    }

    fn targets(&self, scene: &Scene, list: &mut List) {
        let (samples, size) = (self.view.samples, self.view.sampled_size());
        list.target("colour", COLOR, size, samples);
        if samples > 1 {
            list.target("colour", COLOR, self.view.size, 1);
        }
        if self.draws_surfaces {
            list.target("depth", DEPTH, size, samples);
        }
        if self.edge_lines.as_ref().is_some_and(|lines| !lines.groups(scene).is_empty()) {
            list.target("colour and lines", COLOR, size, samples);
            list.target("greatest coverage", COVERAGE, size, samples);
            for _ in 0..if self.veiled { VEIL_LAYERS } else { 0 } {
                list.target("depth of a layer", DEPTH, size, samples);
                list.target("alpha of a layer", COLOR, size, samples);
            }
        }
        if let Some(image) = &self.image {
            let size = image.size;
            let format = if image.gbuffer.is_some() { UNQUANTISED } else { packed(image.ink.layout) };
            list.target("normal, region and depth", format, size, 1);
            if image.own_surfaces {
                list.target("depth of the ink", DEPTH, size, 1);
            }
            if image.stores_ink() {
                list.target("ink", INK, size, 1);
            }
            if let Some(plan) = image.gbuffer.as_ref().filter(|_| image.finds_lines()) {
                for format in plan.gbuffer.encoded().into_iter().flatten() {
                    list.target("G-buffer", format, size, 1);
                }
                if plan.gbuffer.has_steps() {
                    list.target("second ink", INK, size, 1);
                }
            }
            if image.finds_lines() && image.has_dilation() {
                list.target("disc", TexelFormat::R32Uint, (size.0.div_ceil(WORD_PX), size.1), 1);
                for _ in 0..2 {
                    list.target("disc", TexelFormat::Rgba32Uint, (size.0.div_ceil(SITE_PX), size.1), 1);
                }
                if image.ink.scale != InkScale::One {
                    list.target("thick ink", INK, size, 1);
                }
            }
        }
        let Some(shadow) = &self.shadow else { return };
        match shadow.technique {
            ShadowTechnique::Volumes { float_depth, .. } => {
                let in_lines = self.image.as_ref().filter(|_| shadow.in_lines).map(|image| (image.size, 1));
                for (size, samples) in shadow.in_picture.then_some((size, samples)).into_iter().chain(in_lines) {
                    list.target("shadow stencil", stencil_format(float_depth), size, samples);
                    list.target("shadow mask", SHADOW_MASK, size, samples);
                }
            }
            ShadowTechnique::Map { side, .. } => list.target("shadow map", SHADOW_MAP, (side, side), 1),
            ShadowTechnique::Rays => {}
        }
    }

    fn uploaded_textures(
        &self,
        scene: &Scene,
        capabilities: &Capabilities,
        list: &mut List,
    ) -> Result<(), HarnessError> {
        for (texture, _) in scene.textures().iter().zip(&self.textures).filter(|(_, used)| **used) {
            let size = (texture.width, texture.height);
            list.texture(&texture.name, TexelFormat::Rgba8UnormSrgb, size, level_count(size));
        }
        let Some(paint) = &self.paint else { return Ok(()) };
        if let Some((width, height, _)) = paint.shade.model().on_device(&paint.view)?.image {
            list.texture("image of the shade", COLOR, (width, height), 1);
        }
        if let Some(hatch) = &paint.hatch {
            match hatch.drawn_thresholds()? {
                Some(map) => {
                    let size = (map.side, map.side);
                    list.texture("thresholds", TexelFormat::Rg8Unorm, size, level_count(size));
                }
                None => {
                    let side = hatch.tam()?.side;
                    let format = if self.half_float_maps { TexelFormat::Rgba16Float } else { TexelFormat::Rgba8Unorm };
                    for name in ["the lighter tones", "the darker tones"] {
                        list.texture(name, format, (side, side), level_count((side, side)));
                    }
                }
            }
        }
        if paint.lights_faces() {
            let size = corner_texture_size(paint.corner_texels(scene), capabilities.texture_px);
            list.texture("corners of faces", TexelFormat::Rgba32Float, size, 1);
        }
        Ok(())
    }

    fn vertex_buffers(&self, scene: &Scene, capabilities: &Capabilities, list: &mut List) {
        let streams = Streams::new(scene, self);
        let splits = splits(scene, self, streams);
        let of_mesh = |(mesh, split): (&Arc<crate::scene::Mesh>, _)| sources(mesh.model(), split).count() as u64;
        let vertices: u64 = scene.meshes().iter().zip(&splits).map(of_mesh).sum();
        for (present, name, bytes) in [
            (true, "positions", POSITION_BYTES),
            (streams.normals, "normals", NORMAL_BYTES),
            (streams.uvs, "texture coordinates", UV_BYTES),
            (streams.colors, "vertex colours", COLOR_BYTES),
            (streams.regions, "regions", REGION_BYTES),
            (streams.directions, "directions of strokes", DIRECTION_BYTES),
            (streams.octaves, "octaves of strokes", OCTAVE_BYTES),
        ] {
            if present {
                list.buffer(name, vertices * bytes);
            }
        }
        let index_bytes = index_bytes(vertices as usize);
        let stride = capabilities.uniform_alignment as usize;
        let materials = material_table(scene, self, stride);
        list.buffer("faces", index_bytes * index_count(scene, &splits, &materials.duplicates));
        if self.blended || self.blended_hide || self.veiled {
            list.buffer("blended faces", 3 * index_bytes * blended_faces(scene).len() as u64);
        }
        list.buffer("objects", INSTANCE_BYTES * scene.objects().len().max(1) as u64);
        list.buffer("materials", materials.uniforms.len() as u64);
        let light_bytes = size_of::<PainterUniform>();
        let pairs = self.paint.as_ref().map_or(0, |paint| paint.light_pairs.len());
        list.buffer(
            "lights",
            if pairs == 0 { light_bytes } else { pairs * light_bytes.next_multiple_of(stride) } as u64,
        );
    }

    fn edge_buffers(&self, scene: &Scene, list: &mut List) {
        if let Some(lines) = &self.edge_lines {
            let groups = lines.groups(scene);
            match lines.method {
                EdgeLineMethod::OnDevice => {
                    let mut known: Vec<&Arc<ContourEdges>> = Vec::new();
                    for &number in groups.iter().flat_map(|(_, objects)| objects) {
                        let contours = &lines.contours[number as usize];
                        if !known.iter().any(|known| Arc::ptr_eq(known, contours)) {
                            known.push(contours);
                            let positions = &scene.placed(number).1.model().positions;
                            list.buffer("outline planes", (size_of_val(&contours.planes[..]) as u64).max(32));
                            list.buffer("outline edges", (size_of_val(&contours.edges[..]) as u64).max(32));
                            list.buffer("outline positions", (size_of_val(&positions[..]) as u64).max(32));
                        }
                        list.buffer("outline lines", 4 * contours.edges.len().max(1) as u64);
                        list.buffer("outline draw arguments", 16);
                    }
                }
                EdgeLineMethod::OnCpu => {
                    // Every edge of a group may be a line.
                    for (_, objects) in &groups {
                        let edges = |&number: &u32| lines.contours[number as usize].edges.len() as u64;
                        let bytes = RECORD_BYTES * objects.iter().map(edges).sum::<u64>();
                        if bytes > 0 {
                            list.add("outline records", ResourceKind::Buffer { is_bound: true }, bytes);
                        }
                    }
                }
            }
        }
        for hull in self.hulls.iter().flat_map(|plan| &plan.hulls) {
            list.buffer("hull", size_of_val(&hull.vertices[..]) as u64);
            list.buffer("hull's faces", size_of_val(&hull.faces[..]) as u64);
        }
        for fins in self.printed_fins.iter().flat_map(|plan| &plan.fins) {
            let (vertices, indices) = (fins.vertices.len() as u64, fins.indices.len() as u64);
            list.buffer("printed fins", 24 * vertices);
            list.buffer("printed fins' normals", 24 * vertices);
            list.buffer("printed fins' indices", 4 * indices);
        }
    }

    fn shadow_buffers(&self, scene: &Scene, list: &mut List) {
        let Some(shadow) = &self.shadow else { return };
        let ShadowTechnique::Volumes { casters, method, .. } = &shadow.technique else { return };
        match method {
            VolumeMethod::OnDevice => {
                for casters in casters {
                    list.buffer("volume edges", 64 * casters.edges().len() as u64);
                    list.buffer("volume faces", 64 * casters.faces().len() as u64);
                }
            }
            VolumeMethod::OnCpu => {
                for object in scene.objects() {
                    let light = object.homogeneous(shadow.light);
                    list.buffer("volumes", 16 * casters[object.mesh()].triangles(light).0.len() as u64);
                }
            }
        }
    }

    fn arrays(&self, scene: &Scene, list: &mut List) {
        let samples = area(self.view.sampled_size());
        list.array::<DVec4>("colours of samples", samples);
        list.array::<f64>("depths of samples", samples);
        if self.edge_lines.as_ref().is_some_and(|lines| !lines.groups(scene).is_empty()) {
            list.array::<f64>("coverage by lines", samples);
        }
        if self.view.samples > 1 {
            list.array::<DVec4>("colours", area(self.view.size));
            list.array::<f64>("depths", area(self.view.size));
        }
        if let Some(image) = &self.image {
            match image.gbuffer {
                Some(_) => list.array::<[u32; 4]>("normals, regions and depths", area(image.size)),
                None => list.array::<[u32; 2]>("normals, regions and depths", area(image.size)),
            }
            if image.finds_lines() {
                list.array::<u8>("ink", area(image.size));
            }
        }
        list.array::<[u8; 4]>("picture", area(self.view.size));
        for (texture, _) in scene.textures().iter().zip(&self.textures).filter(|(_, used)| **used) {
            let (width, height) = (texture.width, texture.height);
            let of_level = |level: u32| u64::from((width >> level).max(1)) * u64::from((height >> level).max(1));
            list.array::<[u8; 4]>(&texture.name, (0..level_count((width, height))).map(of_level).sum());
        }
        list.array::<u8>("hierarchy of faces", scene.ray_bytes());
        if let Some(lines) = &self.edge_lines {
            let mut known: Vec<*const ContourEdges> = Vec::new();
            for contours in &lines.contours {
                if !known.contains(&Arc::as_ptr(contours)) {
                    known.push(Arc::as_ptr(contours));
                    list.array::<[f32; 4]>("planes of edges", contours.planes.len() as u64);
                    list.array::<[u32; 4]>("edges", contours.edges.len() as u64);
                }
            }
        }
    }
}
