//! The ground on the GPU: a rectangle that the geometry pass draws after all surfaces. The CPU version is `cpu/ground.rs`.

use super::instances::{INSTANCE_BYTES, unplaced_instance};
use super::materials::{Uploaded, material_group};
use super::uniform::uniform_buffer;
use crate::geometry::{MaterialUniform, NORMAL_BYTES, POSITION_BYTES, Streams, UV_BYTES};
use crate::ground::GroundPlan;
use crate::plan::Plan;
use glam::Vec3;
use npr_outline::filled_buffer::filled_buffer;

/// The attributes of its vertices besides positions.
pub(super) const STREAMS: Streams =
    Streams { normals: true, uvs: true, colors: false, regions: false, directions: false, octaves: false };

/// Two triangles.
const VERTICES: u64 = 6;

/// The vertices and the material of a ground.
pub(super) struct GroundOnDevice {
    vertices: wgpu::Buffer,
    material: wgpu::BindGroup,
}

impl GroundOnDevice {
    /// `layout` is that of materials; `unread` stands where the shader declares textures.
    pub(super) fn new(
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        unread: &Uploaded,
        plan: &Plan,
        ground: &GroundPlan,
    ) -> Self {
        let [a, b, c, d] = ground.corners();
        let corners = [a, b, c, a, c, d];
        let tile = plan.hatch().map_or(1.0, |hatch| hatch.tile);
        let mut bytes: Vec<u8> = bytemuck::cast_slice(&corners.map(|corner| corner.as_vec3().to_array())).to_vec();
        bytes.extend_from_slice(bytemuck::cast_slice(&[Vec3::Y.to_array(); VERTICES as usize]));
        let uvs = corners.map(|corner| GroundPlan::uv(corner, tile).as_vec2().to_array());
        bytes.extend_from_slice(bytemuck::cast_slice(&uvs));
        bytes.extend_from_slice(&unplaced_instance());
        let uniform = MaterialUniform {
            base_color: plan.paper.extend(1.0).to_array(),
            texture_size: [1.0; 2],
            last_level: 0.0,
            cutoff: f32::MIN,
            wrap: [0; 2],
            emissive_size: [1.0; 2],
            emissive: [0.0; 4],
        };
        let uniform = uniform_buffer(device, bytemuck::bytes_of(&uniform));
        Self {
            vertices: filled_buffer(device, "ground", &bytes, wgpu::BufferUsages::VERTEX),
            material: material_group(device, layout, &uniform, [unread; 2]),
        }
    }

    /// Binds its vertices and its material, and draws it. `instances` is the slot of objects' data.
    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, instances: u32) {
        let sizes = [(0, VERTICES * POSITION_BYTES), (1, VERTICES * NORMAL_BYTES), (2, VERTICES * UV_BYTES)];
        let mut start = 0;
        for (slot, bytes) in sizes.into_iter().chain([(instances, INSTANCE_BYTES)]) {
            pass.set_vertex_buffer(slot, self.vertices.slice(start..start + bytes));
            start += bytes;
        }
        pass.set_bind_group(1, &self.material, &[0]);
        pass.draw(0..VERTICES as u32, 0..1);
    }
}
