//! Uniform buffers.

use npr_outline::filled_buffer::filled_buffer;

/// Creates a uniform buffer that is written once.
pub(crate) fn uniform_buffer(device: &wgpu::Device, contents: &[u8]) -> wgpu::Buffer {
    debug_assert!(contents.len().is_multiple_of(16), "WebGL2 binds uniforms of whole vectors");
    filled_buffer(device, "uniform", contents, wgpu::BufferUsages::UNIFORM)
}
