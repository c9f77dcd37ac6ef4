//! The render targets of a frame.

use super::context::GpuContext;
use crate::error::HarnessError;
use crate::image_lines::gbuffer::targets::{GBufferTargets, TEXEL_FORMAT};
use crate::image_lines::plan::ImagePlan;
use crate::image_lines::style::InkScale;
use crate::picture::Image;
use crate::shadow::gpu::StencilTarget;
use crate::texel_format::{self, TexelFormat};
use crate::view::View;
use npr_imagespace::format::texel::TexelLayout;
use npr_imagespace::pass::INK_FORMAT;
use npr_imagespace::pass::disc::DiscScratch;
use npr_imagespace::pass::fused::texel_format;
use npr_outline::line_pass::COVERAGE_FORMAT;
use npr_outline::segment::VEIL_LAYERS;
use std::cell::{Cell, OnceCell, Ref, RefCell};

/// Without sRGB encoding on store, because values are display-referred.
pub(crate) const COLOR_FORMAT: wgpu::TextureFormat = texel_format::COLOR.on_device();
/// Depth is reversed: 1 at the near plane.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = texel_format::DEPTH.on_device();

/// The usages of targets that are read by later passes, and copied.
const READ_AND_COPIED: wgpu::TextureUsages =
    wgpu::TextureUsages::TEXTURE_BINDING.union(wgpu::TextureUsages::COPY_SRC).union(wgpu::TextureUsages::COPY_DST);

/// The colour, depth and line targets of a frame; those besides colour are created when a frame first needs them.
pub struct Targets {
    /// The width, px.
    pub width: u32,
    /// The height, px.
    pub height: u32,
    /// Samples along each axis of a pixel.
    pub samples: u32,
    /// With several samples per pixel: the targets of the sample grid, which are resolved into these.
    fine: Option<Box<Targets>>,
    color: wgpu::Texture,
    pub(crate) color_view: wgpu::TextureView,
    /// Created when surfaces are first drawn.
    depth_view: OnceCell<wgpu::TextureView>,
    /// Created when lines along edges are first drawn.
    edge_lines: OnceCell<EdgeLineTargets>,
    /// Depth and alpha of layers of see-through surfaces, created when they are first drawn.
    veils: OnceCell<[[wgpu::TextureView; 2]; VEIL_LAYERS]>,
    /// Created on first use, and recreated for a style that needs others.
    ink: RefCell<Option<InkTargets>>,
    /// The stencil in which shadow volumes are counted.
    pub(crate) stencil: StencilTarget,
    /// Whether the last frame is in `inked` instead of `color`.
    is_inked: Cell<bool>,
}

/// The targets for lines along edges.
pub(crate) struct EdgeLineTargets {
    /// The picture with lines on it.
    inked: wgpu::Texture,
    pub(crate) inked_view: wgpu::TextureView,
    pub(crate) coverage_view: wgpu::TextureView,
}

/// The targets for image-space lines.
pub(crate) struct InkTargets {
    kind: InkKind,
    pub(crate) size: (u32, u32),
    pub(crate) texels: wgpu::TextureView,
    /// The depth buffer of the ink's own geometry pass, if it has one.
    pub(crate) depth: Option<wgpu::TextureView>,
    /// The stencil in which shadow volumes are counted for that pass.
    pub(crate) stencil: StencilTarget,
    /// The ink before dilation, if it is not composited directly.
    pub(crate) found: Option<wgpu::TextureView>,
    /// The scratch textures of the dilation, if any.
    pub(crate) dilation: Option<DiscScratch>,
    /// The encoded G-buffer, if the style has one of its own.
    pub(crate) gbuffer: Option<GBufferTargets>,
    /// The dilated ink, if it is not composited directly.
    pub(crate) thick: Option<wgpu::TextureView>,
}

impl InkTargets {
    fn new(context: &GpuContext, image: &ImagePlan) -> Result<Self, HarnessError> {
        let (ink, size) = (&image.ink, image.size);
        let dilated = image.finds_lines() && image.has_dilation();
        context.capabilities.check_size("the ink", size)?;
        let device = &context.device;
        let view = |label, format, usage| texture(device, label, format, usage, size).create_view(&Default::default());
        let read = wgpu::TextureUsages::TEXTURE_BINDING;
        let scaled = ink.scale != InkScale::One;
        let texels = if ink.gbuffer.is_some() { TEXEL_FORMAT } else { texel_format(ink.layout) };
        let ink_of = |label| view(label, INK_FORMAT, READ_AND_COPIED);
        let encoded = |format| view("G-buffer", format, read);
        let depth = || view("depth of the ink", DEPTH_FORMAT, wgpu::TextureUsages::empty());
        Ok(Self {
            kind: ink_kind(image),
            size,
            texels: view("normal, region and depth", texels, read | wgpu::TextureUsages::COPY_SRC),
            depth: image.own_surfaces.then(depth),
            stencil: StencilTarget::default(),
            found: image.stores_ink().then(|| ink_of("ink")),
            gbuffer: ink
                .gbuffer
                .as_ref()
                .filter(|_| image.finds_lines())
                .map(|gbuffer| GBufferTargets::new(gbuffer, encoded, || ink_of("second ink"))),
            dilation: dilated.then(|| DiscScratch::new(device, size.into())),
            thick: (scaled && dilated).then(|| view("thick ink", INK_FORMAT, read)),
        })
    }
}

/// The properties for which ink targets are created: the layout of texels, the size, whether there is dilation, whether
/// the ink has its own geometry pass, whether lines are found; and the encoded targets of a G-buffer and whether it has
/// steps.
pub(crate) type InkKind = (TexelLayout, (u32, u32), [bool; 3], Option<([Option<TexelFormat>; 3], bool)>);

pub(crate) fn ink_kind(image: &ImagePlan) -> InkKind {
    let gbuffer = image.gbuffer.as_ref().map(|plan| (plan.gbuffer.encoded(), plan.gbuffer.has_steps()));
    (image.ink.layout, image.size, [image.has_dilation(), image.own_surfaces, image.finds_lines()], gbuffer)
}

fn texture(
    device: &wgpu::Device,
    label: &str,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
    (width, height): (u32, u32),
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
        view_formats: &[],
    })
}

impl Targets {
    pub(crate) fn new(context: &GpuContext, view: &View) -> Result<Self, HarnessError> {
        let (width, height) = view.size;
        context.capabilities.check_size("the picture", view.size)?;
        let samples = view.samples.max(1);
        let fine = match samples {
            1 => None,
            _ => {
                context.capabilities.check_size("the picture's samples", view.sampled_size())?;
                Some(Box::new(Self::new(context, &View { size: view.sampled_size(), samples: 1, ..*view })?))
            }
        };
        let color = texture(&context.device, "colour", COLOR_FORMAT, READ_AND_COPIED, (width, height));
        Ok(Self {
            width,
            height,
            samples,
            fine,
            color_view: color.create_view(&Default::default()),
            color,
            depth_view: OnceCell::new(),
            edge_lines: OnceCell::new(),
            veils: OnceCell::new(),
            ink: RefCell::default(),
            stencil: StencilTarget::default(),
            is_inked: Cell::new(false),
        })
    }

    /// The targets for image-space lines, created if necessary.
    ///
    /// # Errors
    /// [`HarnessError::TextureTooLarge`].
    pub(crate) fn ink(&self, context: &GpuContext, image: &ImagePlan) -> Result<Ref<'_, InkTargets>, HarnessError> {
        let is_for = |targets: &InkTargets| targets.kind == ink_kind(image);
        if !self.ink.borrow().as_ref().is_some_and(is_for) {
            *self.ink.borrow_mut() = Some(InkTargets::new(context, image)?);
        }
        Ok(Ref::map(self.ink.borrow(), |targets| targets.as_ref().expect("it was just made")))
    }

    /// The targets into which surfaces and edge lines are drawn.
    pub(crate) fn canvas(&self) -> &Self {
        self.fine.as_deref().unwrap_or(self)
    }

    /// The depth buffer.
    pub(crate) fn depth_view(&self, device: &wgpu::Device) -> &wgpu::TextureView {
        self.depth_view.get_or_init(|| {
            let read = wgpu::TextureUsages::TEXTURE_BINDING;
            texture(device, "depth", DEPTH_FORMAT, read, (self.width, self.height)).create_view(&Default::default())
        })
    }

    /// Depth and alpha of layers of see-through surfaces.
    pub(crate) fn veils(&self, device: &wgpu::Device) -> &[[wgpu::TextureView; 2]; VEIL_LAYERS] {
        self.veils.get_or_init(|| {
            std::array::from_fn(|_| {
                [("depth of a layer", DEPTH_FORMAT), ("alpha of a layer", COLOR_FORMAT)].map(|(label, format)| {
                    let read = wgpu::TextureUsages::TEXTURE_BINDING;
                    texture(device, label, format, read, (self.width, self.height)).create_view(&Default::default())
                })
            })
        })
    }

    /// The targets for lines along edges.
    pub(crate) fn edge_lines(&self, device: &wgpu::Device) -> &EdgeLineTargets {
        self.edge_lines.get_or_init(|| {
            let texture = |label, format, usage| texture(device, label, format, usage, (self.width, self.height));
            let inked = texture("colour and lines", COLOR_FORMAT, READ_AND_COPIED);
            let coverage = texture("greatest coverage", COVERAGE_FORMAT, wgpu::TextureUsages::empty());
            EdgeLineTargets {
                inked_view: inked.create_view(&Default::default()),
                inked,
                coverage_view: coverage.create_view(&Default::default()),
            }
        })
    }

    /// The texture that holds the result of the frame.
    fn result(&self) -> &wgpu::Texture {
        match self.edge_lines.get() {
            Some(lines) if self.is_inked.get() => &lines.inked,
            _ => &self.color,
        }
    }

    /// Marks the painted picture as the result of the frame.
    pub(crate) fn begin(&self) {
        self.is_inked.set(false);
        if let Some(fine) = &self.fine {
            fine.begin();
        }
    }

    /// The view that holds the result of the frame.
    pub(crate) fn drawn(&self) -> &wgpu::TextureView {
        match self.edge_lines.get() {
            Some(lines) if self.is_inked.get() => &lines.inked_view,
            _ => &self.color_view,
        }
    }

    /// Copies the painted picture to the target of lines, and marks that target as the result of the frame.
    pub(crate) fn begin_ink(&self, device: &wgpu::Device, encoder: &mut wgpu::CommandEncoder) -> &EdgeLineTargets {
        let lines = self.edge_lines(device);
        encoder.copy_texture_to_texture(self.color.as_image_copy(), lines.inked.as_image_copy(), self.color.size());
        self.is_inked.set(true);
        lines
    }

    /// Copies the picture with its lines back to the painted one, so that further lines can be drawn over it.
    pub(crate) fn continue_ink(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.copy_texture_to_texture(self.result().as_image_copy(), self.color.as_image_copy(), self.color.size());
    }

    pub(crate) fn read(&self, context: &GpuContext) -> Result<Image, HarnessError> {
        let rgba8 = read_texture(context, self.result())?;
        Ok(Image::new(self.width, self.height, rgba8).expect("four bytes a pixel"))
    }

    /// The packed normal, region and depth of the last frame's pixels; with 32 bits the second word is 0. None of
    /// styles with a G-buffer of their own.
    pub(crate) fn read_texels(&self, context: &GpuContext) -> Result<Option<Vec<[u32; 2]>>, HarnessError> {
        let ink = self.ink.borrow();
        let Some(ink) = ink.as_ref().filter(|ink| ink.kind.3.is_none()) else { return Ok(None) };
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(&read_texture(context, ink.texels.texture())?);
        Ok(Some(match ink.kind.0 {
            TexelLayout::Bits32 => words.into_iter().map(|word| [word, 0]).collect(),
            TexelLayout::Bits64 => words.as_chunks::<2>().0.to_vec(),
        }))
    }
}

/// Reads back the texels of a texture, in rows from the top.
fn read_texture(context: &GpuContext, texture: &wgpu::Texture) -> Result<Vec<u8>, HarnessError> {
    let bytes = texture.format().block_copy_size(None).expect("a colour format");
    let row = bytes * texture.width();
    let padded_row = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = context.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("picture"),
        size: u64::from(padded_row) * u64::from(texture.height()),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = context.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded_row), rows_per_image: None },
        },
        texture.size(),
    );
    context.queue.submit([encoder.finish()]);
    let mapped = context.map(&buffer)?;
    Ok(mapped.chunks(padded_row as usize).flat_map(|padded| &padded[..row as usize]).copied().collect())
}
