//! The hard fused filter by compute shaders, for software rasterisers.
//!
//! The fragment pass ([`crate::pass::fused`]) loads and decodes five texels a pixel and compares four pairs. A software
//! rasteriser has no units for that, and runs through both sides of a branch. Here an invocation takes a strip of four
//! columns and goes down its rows, decodes one and a half texels a pixel, which it has by gathers, four at a time, keeps
//! the two rows before, and compares a pair once to ink both of its pixels. The ink is the same, pixel by pixel.
//!
//! It writes the line's colour where there is ink, and reads nothing of the picture. So it serves hard filters under
//! opaque lines only ([`serves`]), and the picture's alpha, which other passes leave alone, becomes 1 there: it is
//! taken for opaque.
//!
//! Measured on lavapipe (Mesa 22.3, vectors of eight, two threads): processor time as a share of the fragment pass's,
//! all three tests asked for, 2 to 5 % of the pixels ink, over an area of 703 × 650 px and over 1280 × 720 px:
//!
//! | layout | taps | 703 × 650 | 1280 × 720 |
//! | --- | --- | --- | --- |
//! | narrow | diagonal | 0.23 | 0.22 |
//! | narrow | cross | 0.22 | 0.21 |
//! | wide | diagonal | 0.28 | 0.26 |
//! | wide | cross | 0.27 | 0.26 |
//!
//! There the first use compiles for 0.3 to 0.5 s, the fragment pass's for 0.1 to 0.2, unless the driver's cache has it.
//! Variants, as shares of the same: strips of eight columns 0.21 to 0.24, and twice as long to compile; loads in place
//! of gathers 0.33; also one row a turn of the loop 0.40; also a store asked for at each pixel 0.49.

use super::Onto;
use super::fullscreen::uniform;
use super::fused::TAPS_WGSL;
use crate::ImageSpaceError;
use crate::composite::{Composite, ink_alpha_passes};
use crate::filter::fused::{FilterUniform, FusedFilter, ShadowTest};
use crate::format::texel::{DepthCode, TexelLayout};
use crate::picture::Taps;
use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};

const STRIPS_WGSL: &str = include_str!("fused_strips.wgsl");

/// Of the picture that is inked.
pub const STRIPS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Columns of a strip, and how many strips a workgroup has side by side, as in the shader.
const COLUMNS: u32 = 4;
const STRIPS: u32 = 8;
/// Of a strip, a multiple of 4. Two more are read.
const ROWS: u32 = 32;
/// Invocations of a workgroup along the picture's border, as in the shader.
const BORDER: u32 = 64;

/// `Strips` of the shader.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct StripsUniform {
    inner: [u32; 4],
    area: [u32; 4],
    line: Vec4,
}

/// The colour of a pixel of full ink, if nothing of the picture is left there.
fn opaque_line(composite: &Composite) -> Option<Vec3> {
    match *composite {
        Composite::Multiply => Some(Vec3::ZERO),
        Composite::AlphaTested(test) => ink_alpha_passes(1.0, test).then_some(Vec3::ZERO),
        Composite::Over { color, opacity } => (opacity == 1.0).then_some(color),
    }
}

/// Whether a filter under a composite can be drawn by strips: the filter is hard, looks not for shadows alone, and its
/// lines are opaque.
pub fn serves(filter: &FusedFilter, composite: &Composite) -> bool {
    filter.softness == 0.0 && filter.shadows != ShadowTest::Alone && opaque_line(composite).is_some()
}

/// The pipelines of a hard filter, for a layout.
#[derive(Debug)]
pub struct FusedStrips {
    bindings: wgpu::BindGroupLayout,
    inner: wgpu::ComputePipeline,
    border: wgpu::ComputePipeline,
    nearest: wgpu::Sampler,
    layout: TexelLayout,
    made_for: Structure,
}

/// What of a filter the pipelines are made for: taps, and whether normals, depth (plain or not) regions and shadows
/// count.
pub type Structure = (Taps, bool, Option<bool>, bool, bool);

/// The same for two filters that differ in their thresholds alone.
pub fn structure(filter: &FusedFilter) -> Structure {
    (
        filter.taps,
        filter.normal_cos.is_some(),
        filter.depth.map(|test| test.plain),
        filter.regions,
        filter.shadows == ShadowTest::Lines,
    )
}

impl FusedStrips {
    /// Makes the pipelines for what the filter looks for, and where; thresholds may change. The device needs
    /// [`wgpu::DownlevelFlags::COMPUTE_SHADERS`] and one storage texture a stage.
    pub fn new(device: &wgpu::Device, filter: &FusedFilter, layout: TexelLayout) -> Self {
        let bindings = bindings(device);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("fused strips"),
            source: wgpu::ShaderSource::Wgsl([crate::WGSL, TAPS_WGSL, STRIPS_WGSL].concat().into()),
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("fused strips"),
            bind_group_layouts: &[Some(&bindings)],
            immediate_size: 0,
        });
        let constant = |name, is: bool| (name, f64::from(u8::from(is)));
        let constants = [
            constant("narrow", layout == TexelLayout::Narrow),
            constant("cross_taps", filter.taps == Taps::Cross),
            constant("asks_normals", filter.normal_cos.is_some()),
            constant("asks_bends", filter.depth.is_some_and(|test| !test.plain)),
            constant("asks_steps", filter.depth.is_some_and(|test| test.plain)),
            constant("asks_regions", filter.regions),
            constant("asks_shadows", filter.shadows == ShadowTest::Lines),
            ("rows", f64::from(ROWS)),
        ];
        let pipeline = |entry, constants: &[_]| {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: Some(&pipeline_layout),
                module: &module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
                cache: None,
            })
        };
        let [inner, border] = ["fused_strips", "fused_border"].map(|entry| pipeline(entry, &constants));
        let nearest = device.create_sampler(&wgpu::SamplerDescriptor::default());
        Self { bindings, inner, border, nearest, layout, made_for: structure(filter) }
    }

    /// Records filtering `texels`, of format [`texel_format`](crate::pass::fused::texel_format), onto a picture of
    /// their size, [`STRIPS_FORMAT`] with `STORAGE_BINDING`. Both views show the first level of their textures.
    ///
    /// # Errors
    /// If a threshold is out of its range.
    ///
    /// # Panics
    /// Where not [`serves`], or the filter looks for other things, or elsewhere, than that of [`FusedStrips::new`].
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        filter: &FusedFilter,
        code: &DepthCode,
        texels: &wgpu::TextureView,
        onto: &Onto<'_>,
    ) -> Result<(), ImageSpaceError> {
        let what = FilterUniform::new(filter, self.layout, code)?;
        assert_eq!(structure(filter), self.made_for, "strips for another filter");
        let line = opaque_line(onto.composite).filter(|_| filter.softness == 0.0).expect("a hard filter, opaque lines");
        let (width, height) = (texels.texture().width(), texels.texture().height());
        let area @ [x, y, area_width, area_height] = onto.area.unwrap_or([0, 0, width, height]);
        if area_width == 0 || area_height == 0 {
            return Ok(());
        }
        let (right, bottom) = (x + area_width, y + area_height);
        let inner @ [left, top, end, floor] = [x.max(1), y.max(1), right.min(width - 1), bottom.min(height - 1)];
        let strips = uniform(device, bytemuck::bytes_of(&StripsUniform { inner, area, line: line.extend(1.0) }));
        let what = uniform(device, bytemuck::bytes_of(&what));
        let group = self.group(device, &what, &strips, texels, onto.view);
        let mut pass = encoder
            .begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some("fused strips"), timestamp_writes: None });
        pass.set_bind_group(0, &group, &[]);
        if left < end && top < floor {
            pass.set_pipeline(&self.inner);
            pass.dispatch_workgroups((end - left).div_ceil(COLUMNS * STRIPS), (floor - top).div_ceil(ROWS), 1);
        }
        if x == 0 || y == 0 || right == width || bottom == height {
            pass.set_pipeline(&self.border);
            pass.dispatch_workgroups(width.max(height).div_ceil(BORDER), 4, 1);
        }
        Ok(())
    }

    fn group(
        &self,
        device: &wgpu::Device,
        what: &wgpu::Buffer,
        strips: &wgpu::Buffer,
        texels: &wgpu::TextureView,
        picture: &wgpu::TextureView,
    ) -> wgpu::BindGroup {
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("fused strips"),
            layout: &self.bindings,
            entries: &[
                entry(0, what.as_entire_binding()),
                entry(1, strips.as_entire_binding()),
                entry(2, wgpu::BindingResource::TextureView(texels)),
                entry(3, wgpu::BindingResource::TextureView(picture)),
                entry(4, wgpu::BindingResource::Sampler(&self.nearest)),
            ],
        })
    }
}

fn bindings(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let uniform = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let texels = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Uint,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let picture = wgpu::BindingType::StorageTexture {
        access: wgpu::StorageTextureAccess::WriteOnly,
        format: STRIPS_FORMAT,
        view_dimension: wgpu::TextureViewDimension::D2,
    };
    let nearest = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering);
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::COMPUTE, ty, count: None };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("fused strips"),
        entries: &[entry(0, uniform), entry(1, uniform), entry(2, texels), entry(3, picture), entry(4, nearest)],
    })
}
