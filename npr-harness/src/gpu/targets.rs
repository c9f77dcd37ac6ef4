//! What a frame is drawn into.

use super::{GpuContext, GpuError};
use crate::compare::Image;
use npr_outline::line_pass::{COVERAGE_FORMAT, STENCIL_FORMAT};

/// Display-referred values, so no encoding on store.
pub(super) const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Reversed.
pub(super) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Colour, depth, and what lines need.
pub struct Targets {
    /// Px.
    pub width: u32,
    /// Px.
    pub height: u32,
    color: wgpu::Texture,
    pub(super) color_view: wgpu::TextureView,
    pub(super) depth_view: wgpu::TextureView,
    pub(super) coverage_view: wgpu::TextureView,
    pub(super) stencil_view: wgpu::TextureView,
}

impl Targets {
    pub(super) fn new(context: &GpuContext, width: u32, height: u32) -> Result<Self, GpuError> {
        let limit = context.device.limits().max_texture_dimension_2d;
        if width == 0 || height == 0 || width > limit || height > limit {
            return Err(GpuError::TooLarge { width, height, limit });
        }
        let texture = |label, format, usage| {
            context.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let read = wgpu::TextureUsages::TEXTURE_BINDING;
        let color = texture("colour", COLOR_FORMAT, wgpu::TextureUsages::COPY_SRC);
        Ok(Self {
            width,
            height,
            color_view: view(&color),
            color,
            depth_view: view(&texture("depth", DEPTH_FORMAT, read)),
            coverage_view: view(&texture("line coverage", COVERAGE_FORMAT, read)),
            stencil_view: view(&texture("ink stencil", STENCIL_FORMAT, wgpu::TextureUsages::empty())),
        })
    }

    pub(super) fn read(&self, context: &GpuContext) -> Result<Image, GpuError> {
        let row = 4 * self.width;
        let padded_row = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = context.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("picture"),
            size: u64::from(padded_row) * u64::from(self.height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = context.device.create_command_encoder(&Default::default());
        encoder.copy_texture_to_buffer(
            self.color.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded_row),
                    rows_per_image: None,
                },
            },
            wgpu::Extent3d { width: self.width, height: self.height, depth_or_array_layers: 1 },
        );
        context.queue.submit([encoder.finish()]);
        let (sender, receiver) = std::sync::mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver is gone only if waiting failed, and then that is the error.
            let _ = sender.send(result);
        });
        context.wait()?;
        let device_error = |fault: String| GpuError::Device { fault };
        receiver.recv().map_err(|e| device_error(e.to_string()))?.map_err(|e| device_error(e.to_string()))?;
        let mapped = buffer.get_mapped_range(..).map_err(|e| device_error(e.to_string()))?;
        let mut rgba8 = Vec::with_capacity(row as usize * self.height as usize);
        for padded in mapped.chunks(padded_row as usize) {
            rgba8.extend_from_slice(&padded[..row as usize]);
        }
        Ok(Image::new(self.width, self.height, rgba8).expect("four bytes a pixel"))
    }
}
