//! A G-buffer on the GPU: its texels' encoding, the filters over it, and the steps of morphology.

use super::plan::GBufferPlan;
use super::style::{Background, GBufferTarget, InkStep, Show, StepKind};
use crate::error::HarnessError;
use crate::gpu::shader::assemble;
use crate::gpu::targets::{COLOR_FORMAT, InkTargets};
use crate::gpu::uniform::uniform_buffer;
use crate::texel_format::TexelFormat;
use npr_imagespace::composite::Composite;
use npr_imagespace::format::depth::DepthFormat;
use npr_imagespace::format::normal::NormalFormat;
use npr_imagespace::morphology::Kernel;
use npr_imagespace::pass::printed::PrintedPass;
use npr_imagespace::pass::separate::{SeparatePass, SeparateTextures};
use npr_imagespace::pass::step::{PingPong, Step, StepPass};
use npr_imagespace::pass::{InkTarget, PassTarget};
use std::cell::RefCell;

/// `GBufferEncode` of `encode.wgsl`.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct EncodeUniform {
    near_far: [f32; 2],
    normal_format: u32,
    depth_format: u32,
    plus_z: u32,
    negated_depth: u32,
    plain: u32,
    region_sums: u32,
}

impl EncodeUniform {
    fn new(GBufferPlan { gbuffer, range, .. }: &GBufferPlan) -> Self {
        let (normals, depth, region_sums) = match &gbuffer.target {
            GBufferTarget::Rgba8(_) => (Some(NormalFormat::Biased8), DepthFormat::Unorm8, false),
            GBufferTarget::Separate(separate) => (separate.normals, separate.depth, separate.region_sums),
        };
        Self {
            near_far: [range.near, range.far],
            normal_format: match normals {
                None => 0,
                Some(NormalFormat::Biased8) => 1,
                Some(NormalFormat::Oct5) => 2,
                Some(NormalFormat::Oct8) => 3,
                Some(NormalFormat::Oct16) => 4,
                Some(NormalFormat::Half) => 5,
            },
            depth_format: match depth {
                DepthFormat::Unorm8 => 0,
                DepthFormat::Unorm16 | DepthFormat::Packed2x8 => 1,
                DepthFormat::Packed4x8 => 2,
                DepthFormat::Half => 3,
                DepthFormat::Float => 4,
            },
            plus_z: u32::from(gbuffer.background == Background::PlusZ),
            negated_depth: u32::from(gbuffer.negated_depth),
            plain: u32::from(gbuffer.is_plain()),
            region_sums: u32::from(region_sums),
        }
    }
}

/// A filter's pipeline.
enum FilterPass {
    Printed(PrintedPass),
    Separate(SeparatePass),
}

/// The entry point of a pipeline that encodes, and the formats of those of its targets that are written.
type EncoderKey = (&'static str, Vec<Option<wgpu::TextureFormat>>);

/// The pipelines, created on first use: those that encode; the filter of the last style; the
/// steps of morphology.
#[derive(Default)]
pub(crate) struct GBufferPasses {
    encoders: RefCell<Vec<(EncoderKey, wgpu::RenderPipeline)>>,
    filter: RefCell<Option<(GBufferTarget, FilterPass)>>,
    soft_steps: RefCell<Vec<(Step, StepPass)>>,
    hard_steps: RefCell<Vec<(Kernel, PingPong)>>,
}

impl GBufferPasses {
    /// Encodes the texels, finds lines, and leaves their ink after all steps in `ink.found`.
    pub(crate) fn find(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        plan: &GBufferPlan,
        ink: &InkTargets,
    ) -> Result<(), HarnessError> {
        let (Some(targets), Some(found)) = (&ink.gbuffer, &ink.found) else { return Ok(()) };
        let views = targets.encoded.each_ref().map(Option::as_ref);
        let formats = plan.gbuffer.encoded().map(|format| format.map(TexelFormat::on_device));
        let black = Composite::default();
        let onto = |view| PassTarget { view, composite: &black, area: None };
        let mut kept = self.filter.borrow_mut();
        if !kept.as_ref().is_some_and(|(target, _)| *target == plan.gbuffer.target) {
            let pass = match &plan.gbuffer.target {
                GBufferTarget::Rgba8(filter) => FilterPass::Printed(PrintedPass::new(device, filter, InkTarget::Ink)?),
                GBufferTarget::Separate(separate) => {
                    FilterPass::Separate(SeparatePass::new(device, &separate.filter, InkTarget::Ink)?)
                }
            };
            *kept = Some((plan.gbuffer.target, pass));
        }
        match kept.as_ref() {
            Some((GBufferTarget::Rgba8(filter), FilterPass::Printed(pass))) => {
                let [Some(encoded), ..] = views else { unreachable!("bytes are always encoded") };
                self.encode(device, encoder, plan, ink, ("fs_rgba8", &formats), &views);
                pass.record(device, encoder, filter, encoded, &onto(found))?;
            }
            Some((GBufferTarget::Separate(separate), FilterPass::Separate(pass))) => {
                // A filter without tests reads nothing.
                if views.iter().any(Option::is_some) {
                    self.encode(device, encoder, plan, ink, ("fs_separate", &formats), &views);
                }
                let [normal, depth, region] = views;
                let textures = SeparateTextures { normal, depth, region };
                pass.record(device, encoder, &separate.filter, &textures, &onto(found))?;
            }
            _ => unreachable!("a pass is kept with the target that it is for"),
        }
        let Some(second) = &targets.ink else { return Ok(()) };
        let mut pictures = [found, second];
        for step in plan.gbuffer.steps.iter().flatten() {
            if self.record_step(device, encoder, step, pictures)? == 1 {
                pictures.reverse();
            }
        }
        if !std::ptr::eq(pictures[0], found) {
            encoder.copy_texture_to_texture(
                pictures[0].texture().as_image_copy(),
                found.texture().as_image_copy(),
                found.texture().size(),
            );
        }
        Ok(())
    }

    /// Replaces the picture by what the style shows of the G-buffer.
    pub(crate) fn show(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        plan: &GBufferPlan,
        ink: &InkTargets,
        picture: &wgpu::TextureView,
    ) {
        let entry = match plan.gbuffer.show {
            Show::Lines => return,
            Show::Normals => "fs_show_normals",
            Show::Depth => "fs_show_depth",
            Show::Regions => "fs_show_regions",
        };
        self.encode(device, encoder, plan, ink, (entry, &[Some(COLOR_FORMAT)]), &[Some(picture)]);
    }

    fn encode(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        plan: &GBufferPlan,
        ink: &InkTargets,
        (entry, formats): (&'static str, &[Option<wgpu::TextureFormat>]),
        views: &[Option<&wgpu::TextureView>],
    ) {
        let mut encoders = self.encoders.borrow_mut();
        let is_known = |((of_entry, of_formats), _): &&(EncoderKey, _)| *of_entry == entry && of_formats == formats;
        if !encoders.iter().any(|known| is_known(&known)) {
            encoders.push(((entry, formats.to_vec()), pipeline(device, entry, formats)));
        }
        let Some((_, pipeline)) = encoders.iter().find(is_known) else { return };
        let uniform = uniform_buffer(device, bytemuck::bytes_of(&EncodeUniform::new(plan)));
        let layout = pipeline.get_bind_group_layout(0);
        // The layout has what the entry point reads.
        let texels = wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&ink.texels) };
        let uniform = wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() };
        let entries = [uniform, texels];
        let first = usize::from(entry == "fs_show_regions");
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(entry),
            layout: &layout,
            entries: &entries[first..],
        });
        let attachments: Vec<_> = views
            .iter()
            .map(|view| {
                view.map(|view| wgpu::RenderPassColorAttachment {
                    view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                        store: wgpu::StoreOp::Store,
                    },
                })
            })
            .collect();
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(entry),
            color_attachments: &attachments,
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }

    /// Records a step with its repetitions; returns which of the two pictures holds the result.
    fn record_step(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        InkStep { kind, times }: &InkStep,
        pictures: [&wgpu::TextureView; 2],
    ) -> Result<usize, HarnessError> {
        let soft = match *kind {
            StepKind::Hard(operation, kernel) => {
                let mut kept = self.hard_steps.borrow_mut();
                let number = kept.iter().position(|(of, _)| *of == kernel).unwrap_or_else(|| {
                    kept.push((kernel, PingPong::new(device, kernel)));
                    kept.len() - 1
                });
                return Ok(kept[number].1.record(device, encoder, operation, *times, pictures)?);
            }
            StepKind::SoftCross => Step::SoftCross,
            StepKind::SoftDiagonal(threshold) => Step::SoftDiagonal { threshold },
            StepKind::SoftDiagonalPrinted(threshold) => Step::SoftDiagonalPrinted { threshold },
        };
        let mut kept = self.soft_steps.borrow_mut();
        let number = match kept.iter().position(|(of, _)| *of == soft) {
            Some(number) => number,
            None => {
                kept.push((soft, StepPass::new(device, soft, InkTarget::Ink)?));
                kept.len() - 1
            }
        };
        let composite = Composite::default();
        let mut from = 0;
        for _ in 0..*times {
            let target = PassTarget { view: pictures[1 - from], composite: &composite, area: None };
            kept[number].1.record(device, encoder, pictures[from], &target)?;
            from = 1 - from;
        }
        Ok(from)
    }
}

/// The shader that encodes.
fn encode_wgsl() -> String {
    assemble(&vec![
        ("npr-imagespace, format", npr_imagespace::format::FORMAT_WGSL),
        ("npr-imagespace, shadow", npr_imagespace::shadow::SHADOW_WGSL),
        ("gbuffer/texel.wgsl", super::texel::WGSL),
        ("gbuffer/encode.wgsl", include_str!("encode.wgsl")),
    ])
}

fn pipeline(device: &wgpu::Device, entry: &str, formats: &[Option<wgpu::TextureFormat>]) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("encode"),
        source: wgpu::ShaderSource::Wgsl(encode_wgsl().into()),
    });
    let targets: Vec<_> = formats.iter().map(|format| format.map(Into::into)).collect();
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(entry),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs_encode"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}
