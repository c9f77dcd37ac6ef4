//! Converts the counts in a stencil buffer of shadow volumes to a texture.
//!
//! [`crate::shadow_pass`] leaves counts in a stencil. Few GLES 3.0 and WebGL2 devices can read a stencil in a shader,
//! so this pass uses the stencil test to write 1 where [`crate::shadow_volume::outline_in_shadow`] holds, 0 elsewhere.
//! Reading the mask takes one load of an unsigned byte.

use crate::OutlineError;
use crate::shadow_pass::check_depth_stencil_format;
use crate::target::{check_area, check_view, size};

/// The format of the mask: 0 lit, 1 in shadow.
pub const MASK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Uint;

const MASK_WGSL: &str = include_str!("shadow_mask.wgsl");

/// The pipelines: one writes 1 for counts other than 0, the other writes 0 for counts of 128 and more.
#[derive(Debug)]
pub struct ShadowMaskPass {
    some: wgpu::RenderPipeline,
    wrapped: wgpu::RenderPipeline,
    format: wgpu::TextureFormat,
}

impl ShadowMaskPass {
    /// Makes the pipelines for a depth and stencil buffer of `format`, that of [`crate::shadow_pass::ShadowPass::new`].
    ///
    /// # Errors
    /// [`OutlineError::ViewFormat`] for a format without depth or without stencil.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Result<Self, OutlineError> {
        check_depth_stencil_format(format)?;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("shadow mask"),
            source: wgpu::ShaderSource::Wgsl(MASK_WGSL.into()),
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("shadow mask"),
            bind_group_layouts: &[],
            immediate_size: 0,
        });
        let pipeline = |entry_point, compare, read_mask| {
            let face = wgpu::StencilFaceState { compare, ..Default::default() };
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("shadow mask"),
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("vs_shadow_mask"),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: Default::default(),
                depth_stencil: Some(wgpu::DepthStencilState {
                    format,
                    depth_write_enabled: Some(false),
                    depth_compare: Some(wgpu::CompareFunction::Always),
                    stencil: wgpu::StencilState { front: face, back: face, read_mask, write_mask: 0 },
                    bias: Default::default(),
                }),
                multisample: Default::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some(entry_point),
                    compilation_options: Default::default(),
                    targets: &[Some(MASK_FORMAT.into())],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        // The reference of the stencil test is 0: NotEqual under all bits is "not 0", under the highest "128 and more".
        Ok(Self {
            some: pipeline("fs_in_shadow", wgpu::CompareFunction::NotEqual, 0xff),
            wrapped: pipeline("fs_lit", wgpu::CompareFunction::NotEqual, 0x80),
            format,
        })
    }

    /// Records writing the mask, [`MASK_FORMAT`], from a depth and stencil buffer of the same size: views of the first
    /// level of textures with one sample a pixel.
    ///
    /// `area`: left, top, width and height, px, outside of which the mask becomes 0; `None` for all of it.
    ///
    /// # Errors
    /// If a texture is not as said; [`OutlineError::Area`]. Nothing is recorded then.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        depth_stencil: &wgpu::TextureView,
        mask: &wgpu::TextureView,
        area: Option<[u32; 4]>,
    ) -> Result<(), OutlineError> {
        let size_px = size(mask);
        check_view("the mask", mask, "R8Uint", |format| format == MASK_FORMAT, None)?;
        let needed = "the format that the pass was made for";
        check_view("depth and stencil", depth_stencil, needed, |format| format == self.format, Some(size_px))?;
        check_area(area, size_px)?;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow mask"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: mask,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            // Neither is written.
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth_stencil,
                depth_ops: None,
                stencil_ops: None,
            }),
            ..Default::default()
        });
        if let Some([x, y, width, height]) = area {
            if width == 0 || height == 0 {
                return Ok(());
            }
            pass.set_scissor_rect(x, y, width, height);
        }
        pass.set_stencil_reference(0);
        for pipeline in [&self.some, &self.wrapped] {
            pass.set_pipeline(pipeline);
            pass.draw(0..3, 0..1);
        }
        Ok(())
    }
}
