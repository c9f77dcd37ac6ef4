//! What a frame is drawn into.

use super::shadow::StencilTarget;
use super::{Capabilities, GpuContext, GpuError};
use crate::compare::Image;
use crate::image_ink::{ImageInk, ImagePlan, InkScale};
use npr_imagespace::format::texel::TexelLayout;
use npr_imagespace::pass::INK_FORMAT;
use npr_imagespace::pass::disc::DiscScratch;
use npr_imagespace::pass::fused::texel_format;
use npr_outline::line_pass::WINNER_FORMAT;
use std::cell::{Cell, Ref, RefCell};

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
    /// Samples along each axis of a pixel.
    pub samples: u32,
    /// Of several samples: where the picture is drawn as many times as large, before it is averaged here.
    fine: Option<Box<Targets>>,
    color: wgpu::Texture,
    pub(super) color_view: wgpu::TextureView,
    pub(super) depth_view: wgpu::TextureView,
    /// The picture with lines on it.
    inked: wgpu::Texture,
    pub(super) inked_view: wgpu::TextureView,
    pub(super) winner_view: wgpu::TextureView,
    /// Made when first needed, and anew for a style that needs others.
    ink: RefCell<Option<InkTargets>>,
    /// Where shadow volumes are counted.
    pub(super) stencil: StencilTarget,
    /// Which of the two the last frame ended in.
    is_inked: Cell<bool>,
}

/// What lines in the image are found in.
pub(super) struct InkTargets {
    /// For which layout, which scale, and whether for a brush.
    kind: (TexelLayout, InkScale, bool),
    pub(super) size: (u32, u32),
    pub(super) texels: wgpu::TextureView,
    /// Where the ink has another size than what the picture is drawn into, and its surfaces are drawn for it.
    pub(super) depth: Option<wgpu::TextureView>,
    /// Where shadow volumes are counted for these.
    pub(super) stencil: StencilTarget,
    /// Ink as it is found, where it is not laid at once.
    pub(super) found: Option<wgpu::TextureView>,
    /// Where there is a brush.
    pub(super) brush: Option<DiscScratch>,
    /// Ink from the brush, where it is not laid at once.
    pub(super) thick: Option<wgpu::TextureView>,
}

impl InkTargets {
    /// `apart`: the picture's own surfaces are not of its size.
    fn new(
        context: &GpuContext,
        capabilities: &Capabilities,
        ink: &ImageInk,
        brushed: bool,
        picture: (u32, u32),
        apart: bool,
    ) -> Result<Self, GpuError> {
        let size = ink.scale.size(picture);
        capabilities.check_size("the ink", size)?;
        let view = |label, format, usage| texture(context, label, format, usage, size).create_view(&Default::default());
        let read = wgpu::TextureUsages::TEXTURE_BINDING;
        let scaled = ink.scale != InkScale::One;
        Ok(Self {
            kind: (ink.layout, ink.scale, brushed),
            size,
            texels: view("normal, region and depth", texel_format(ink.layout), read | wgpu::TextureUsages::COPY_SRC),
            depth: (scaled || apart).then(|| view("depth of the ink", DEPTH_FORMAT, wgpu::TextureUsages::empty())),
            stencil: StencilTarget::default(),
            found: (scaled || brushed).then(|| view("ink", INK_FORMAT, read)),
            brush: brushed.then(|| DiscScratch::new(&context.device, size.into())),
            thick: (scaled && brushed).then(|| view("thick ink", INK_FORMAT, read)),
        })
    }
}

fn texture(
    context: &GpuContext,
    label: &str,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
    (width, height): (u32, u32),
) -> wgpu::Texture {
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
}

impl Targets {
    pub(super) fn new(
        context: &GpuContext,
        capabilities: &Capabilities,
        (width, height): (u32, u32),
        samples: u32,
    ) -> Result<Self, GpuError> {
        capabilities.check_size("the picture", (width, height))?;
        let samples = samples.max(1);
        let fine = match samples {
            1 => None,
            _ => {
                let fine = (width.saturating_mul(samples), height.saturating_mul(samples));
                capabilities.check_size("the picture's samples", fine)?;
                Some(Box::new(Self::new(context, capabilities, fine, 1)?))
            }
        };
        let texture = |label, format, usage| texture(context, label, format, usage, (width, height));
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let read = wgpu::TextureUsages::TEXTURE_BINDING;
        let color = texture("colour", COLOR_FORMAT, read | wgpu::TextureUsages::COPY_SRC);
        let copied = wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST;
        let inked = texture("colour and lines", COLOR_FORMAT, read | copied);
        Ok(Self {
            width,
            height,
            samples,
            fine,
            color_view: view(&color),
            color,
            depth_view: view(&texture("depth", DEPTH_FORMAT, read)),
            inked_view: view(&inked),
            inked,
            winner_view: view(&texture("greatest coverage", WINNER_FORMAT, wgpu::TextureUsages::empty())),
            ink: RefCell::default(),
            stencil: StencilTarget::default(),
            is_inked: Cell::new(false),
        })
    }

    /// What lines in the image need.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`].
    pub(super) fn ink(
        &self,
        context: &GpuContext,
        capabilities: &Capabilities,
        image: &ImagePlan,
    ) -> Result<Ref<'_, InkTargets>, GpuError> {
        let (ink, brushed) = (&image.ink, image.has_brush());
        let kind = (ink.layout, ink.scale, brushed);
        let is_for = |targets: &InkTargets| targets.kind == kind;
        if !self.ink.borrow().as_ref().is_some_and(is_for) {
            let picture = (self.width, self.height);
            let made = InkTargets::new(context, capabilities, ink, brushed, picture, self.fine.is_some())?;
            *self.ink.borrow_mut() = Some(made);
        }
        Ok(Ref::map(self.ink.borrow(), |targets| targets.as_ref().expect("it was just made")))
    }

    /// What surfaces, and lines from edges, are drawn into.
    pub(super) fn canvas(&self) -> &Self {
        self.fine.as_deref().unwrap_or(self)
    }

    /// Says that the frame ends in the painted picture.
    pub(super) fn begin(&self) {
        self.is_inked.set(false);
        if let Some(fine) = &self.fine {
            fine.begin();
        }
    }

    /// What the frame ends in.
    pub(super) fn drawn(&self) -> &wgpu::TextureView {
        if self.is_inked.get() { &self.inked_view } else { &self.color_view }
    }

    /// Copies the painted picture to where lines are drawn on it, and says that the frame ends there.
    pub(super) fn begin_ink(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.copy_texture_to_texture(self.color.as_image_copy(), self.inked.as_image_copy(), self.color.size());
        self.is_inked.set(true);
    }

    pub(super) fn read(&self, context: &GpuContext) -> Result<Image, GpuError> {
        let rgba8 = read_texture(context, if self.is_inked.get() { &self.inked } else { &self.color })?;
        Ok(Image::new(self.width, self.height, rgba8).expect("four bytes a pixel"))
    }

    /// Normal, region and depth of the last frame's pixels, packed; of one word the second is 0.
    pub(super) fn read_texels(&self, context: &GpuContext) -> Result<Option<Vec<[u32; 2]>>, GpuError> {
        let ink = self.ink.borrow();
        let Some(ink) = ink.as_ref() else { return Ok(None) };
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(&read_texture(context, ink.texels.texture())?);
        Ok(Some(match ink.kind.0 {
            TexelLayout::Narrow => words.into_iter().map(|word| [word, 0]).collect(),
            TexelLayout::Wide => words.as_chunks::<2>().0.to_vec(),
        }))
    }
}

/// A texture's texels, rows from the top.
fn read_texture(context: &GpuContext, texture: &wgpu::Texture) -> Result<Vec<u8>, GpuError> {
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
