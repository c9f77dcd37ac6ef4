//! The per-object instance buffer.

use super::context::GpuContext;
use crate::error::HarnessError;
use crate::image_lines::plan::RegionPlan;
use crate::scene::Scene;
use npr_outline::shadow_pass::affine_rows;

/// `Instance` of `surface.wgsl`, and constants for attributes of vertices that have no buffer: 84 bytes per object.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Instance {
    /// The rows of the matrix from mesh space to scene space.
    rows: [[f32; 4]; 3],
    /// The offset added to the regions of the mesh's faces, and the factor applied to them before, 0 or 1.
    regions: [u32; 2],
    /// The scale of the object's transform, and its log2.
    scale: [f32; 2],
    /// The middle of the object's box, in scene space.
    middle: [f32; 3],
    /// Ones, as bytes of the format Unorm.
    ones: [u8; 4],
    /// Zeros, as such or as an integer.
    zeros: [u8; 4],
}

/// The size of an object's data, bytes.
pub(crate) const INSTANCE_BYTES: u64 = crate::geometry::INSTANCE_BYTES;
const _: () = assert!(size_of::<Instance>() as u64 == INSTANCE_BYTES);

/// The attributes of objects.
pub(crate) const INSTANCE_ATTRIBUTES: [wgpu::VertexAttribute; 6] = wgpu::vertex_attr_array![
    8 => Float32x4, 9 => Float32x4, 10 => Float32x4, 11 => Uint32x2, 12 => Float32x2, 13 => Float32x3
];

/// The data of an object that is not placed and has no region.
pub(crate) fn unplaced_instance() -> [u8; INSTANCE_BYTES as usize] {
    bytemuck::cast(Instance {
        rows: affine_rows(&glam::DAffine3::IDENTITY),
        regions: [0; 2],
        scale: [1.0, 0.0],
        middle: [0.0; 3],
        ones: [255; 4],
        zeros: [0; 4],
    })
}

/// The layout of objects' data for `attributes`: [`INSTANCE_ATTRIBUTES`] and [`constant`] ones.
pub(crate) fn instance_layout(attributes: &[wgpu::VertexAttribute]) -> wgpu::VertexBufferLayout<'_> {
    wgpu::VertexBufferLayout { array_stride: INSTANCE_BYTES, step_mode: wgpu::VertexStepMode::Instance, attributes }
}

/// What an attribute of vertices without a buffer is at every vertex.
#[derive(Clone, Copy)]
pub(crate) enum Constant {
    Zero,
    One,
    /// The integer 0.
    NoRegion,
}

/// An attribute that is constant, from the data of objects.
pub(crate) fn constant(shader_location: u32, value: Constant) -> wgpu::VertexAttribute {
    let (format, offset) = match value {
        Constant::One => (wgpu::VertexFormat::Unorm8x4, std::mem::offset_of!(Instance, ones)),
        Constant::Zero => (wgpu::VertexFormat::Unorm8x4, std::mem::offset_of!(Instance, zeros)),
        Constant::NoRegion => (wgpu::VertexFormat::Uint32, std::mem::offset_of!(Instance, zeros)),
    };
    wgpu::VertexAttribute { format, offset: offset as u64, shader_location }
}

/// Objects drawn by one call: same mesh, same material, same handedness and same lights.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Run {
    pub(crate) mesh: usize,
    /// The index of their first material, and whether all faces use it.
    pub(crate) material: (usize, bool),
    pub(crate) mirrored: bool,
    /// The index of their pair of lights, 0 if there are no pairs.
    pub(crate) lights: u32,
    /// Their range in the instance buffer.
    pub(crate) objects: std::ops::Range<usize>,
}

/// The instance data of all objects of a scene, in the order of their runs.
pub(crate) struct Instances {
    instances: Vec<Instance>,
    buffer: wgpu::Buffer,
    runs: Vec<Run>,
    /// Per object: its index in the instance buffer.
    places: Vec<u32>,
    /// Per object: its pair of lights, or empty.
    pairs: Vec<u32>,
}

impl Instances {
    pub(crate) fn new(
        context: &GpuContext,
        scene: &Scene,
        regions: Option<&RegionPlan>,
        pairs: &[u32],
    ) -> Result<Self, HarnessError> {
        let size = (scene.objects().len().max(1) * size_of::<Instance>()) as u64;
        let limit = context.device.limits().max_buffer_size;
        if size > limit {
            return Err(HarnessError::BufferTooLarge { what: "objects", bytes: size, limit });
        }
        let buffer = context.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("objects"),
            size,
            usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut instances =
            Self { instances: Vec::new(), buffer, runs: Vec::new(), places: Vec::new(), pairs: Vec::new() };
        instances.update(context, scene, regions, pairs);
        Ok(instances)
    }

    /// Uploads the transforms if any object has moved or has other lights. `pairs` is as in the plan.
    pub(crate) fn update(&mut self, context: &GpuContext, scene: &Scene, regions: Option<&RegionPlan>, pairs: &[u32]) {
        let objects = scene.objects();
        let key = |number: &u32| {
            let object = &objects[*number as usize];
            let lights = pairs.get(*number as usize).copied().unwrap_or(0);
            (object.mesh(), object.first_material(), object.is_mirrored(), lights)
        };
        let instance = |&number: &u32| {
            let object = &objects[number as usize];
            let (first, factor) = regions.map_or((0, 1), |regions| regions.of_instance(scene, number));
            let scale = object.scale();
            Instance {
                rows: affine_rows(object.scene_from_mesh()),
                regions: [first, factor],
                scale: [scale as f32, scale.log2() as f32],
                middle: scene.middle_of(number).as_vec3().to_array(),
                ones: [255; 4],
                zeros: [0; 4],
            }
        };
        let now: Vec<Instance> = scene.drawing_order().iter().map(instance).collect();
        if now == self.instances && pairs == self.pairs {
            return;
        }
        context.queue.write_buffer(&self.buffer, 0, bytemuck::cast_slice(&now));
        self.instances = now;
        self.pairs = pairs.to_vec();
        self.places = vec![0; objects.len()];
        self.runs.clear();
        for (place, number) in scene.drawing_order().iter().enumerate() {
            self.places[*number as usize] = place as u32;
            let (mesh, material, mirrored, lights) = key(number);
            match self.runs.last_mut() {
                Some(run)
                    if (run.mesh, run.material, run.mirrored, run.lights) == (mesh, material, mirrored, lights) =>
                {
                    run.objects.end += 1;
                }
                _ => self.runs.push(Run { mesh, material, mirrored, lights, objects: place..place + 1 }),
            }
        }
    }

    pub(crate) fn runs(&self) -> &[Run] {
        &self.runs
    }

    pub(crate) fn slice(&self, run: &Run) -> wgpu::BufferSlice<'_> {
        let size = size_of::<Instance>() as u64;
        self.buffer.slice(run.objects.start as u64 * size..run.objects.end as u64 * size)
    }

    /// The slice of one object.
    pub(crate) fn slice_of(&self, object: u32) -> wgpu::BufferSlice<'_> {
        let (place, size) = (u64::from(self.places[object as usize]), size_of::<Instance>() as u64);
        self.buffer.slice(place * size..(place + 1) * size)
    }
}
