//! Creates buffers with contents without panicking on a lost device.

/// Creates a buffer with contents, padded with zeros to a multiple of four bytes.
///
/// `wgpu::util::DeviceExt::create_buffer_init` panics where the device is lost or has no memory left. Here the buffer
/// is invalid then, as with `create_buffer`, and the device reports the error to its error scopes and handlers.
pub fn filled_buffer(device: &wgpu::Device, label: &str, contents: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
    let size = (contents.len() as u64).next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT);
    let is_filled = size > 0;
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage,
        mapped_at_creation: is_filled,
    });
    if is_filled && let Ok(mut mapped) = buffer.get_mapped_range_mut(..) {
        mapped.slice(..contents.len()).copy_from_slice(contents);
        drop(mapped);
        buffer.unmap();
    }
    buffer
}
