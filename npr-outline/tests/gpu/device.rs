//! A device, pictures on it, and reading them back.

use npr_outline::line_pass::{COVERAGE_FORMAT, LineTargets};
use std::sync::OnceLock;

/// Of the colour target.
pub const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// A device and its queue.
pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    /// Whether it runs compute shaders.
    pub compute: bool,
}

/// The device that the tests share, or `None`, having said so, where `NPR_GPU` is `off`, or there is no adapter and
/// `NPR_GPU` is not `required`. With `NPR_GPU_LIMITS=webgl2` it has no more than every WebGL2 device.
pub fn gpu() -> Option<&'static Gpu> {
    static GPU: OnceLock<Option<Gpu>> = OnceLock::new();
    let wish = std::env::var("NPR_GPU").unwrap_or_else(|_| "auto".into());
    let gpu = GPU.get_or_init(|| if wish == "off" { None } else { open(wish == "required") }).as_ref();
    if gpu.is_none() {
        println!("skipped: no graphics adapter is used (NPR_GPU={wish})");
    }
    gpu
}

fn open(required: bool) -> Option<Gpu> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()));
    let adapter = match adapter {
        Ok(adapter) => adapter,
        Err(error) if required => panic!("NPR_GPU=required, and there is no adapter: {error}"),
        Err(_) => return None,
    };
    println!("adapter: {}", adapter.get_info().name);
    let limits = std::env::var("NPR_GPU_LIMITS").unwrap_or_default();
    let required_limits = match &*limits {
        "" | "adapter" => wgpu::Limits::default().or_worse_values_from(&adapter.limits()),
        "webgl2" => wgpu::Limits::downlevel_webgl2_defaults().using_alignment(adapter.limits()),
        other => panic!("NPR_GPU_LIMITS={other:?}: it must be adapter or webgl2"),
    };
    let descriptor = wgpu::DeviceDescriptor { required_limits, ..Default::default() };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).expect("an adapter gives a device");
    let compute = adapter.get_downlevel_capabilities().flags.contains(wgpu::DownlevelFlags::COMPUTE_SHADERS)
        && device.limits().max_compute_invocations_per_workgroup >= 64;
    Some(Gpu { device, queue, compute })
}

/// The targets of one picture.
pub struct Picture {
    /// White, with nothing on it.
    pub color: wgpu::Texture,
    pub depth: wgpu::Texture,
    /// Where lines are drawn; starts white.
    pub inked: wgpu::Texture,
    views: [wgpu::TextureView; 4],
}

impl Gpu {
    /// A white picture with a depth buffer cleared to 0, infinitely far.
    pub fn picture(&self, [width, height]: [u32; 2]) -> Picture {
        let texture = |format| {
            self.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING
                    | wgpu::TextureUsages::COPY_SRC
                    | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            })
        };
        let [color, inked] = [(); 2].map(|()| texture(COLOR_FORMAT));
        let depth = texture(wgpu::TextureFormat::Depth32Float);
        let coverage = self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: color.size(),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: COVERAGE_FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        let views = [&color, &depth, &inked, &coverage].map(|t| t.create_view(&Default::default()));
        let picture = Picture { color, depth, inked, views };
        self.clear(&picture);
        picture
    }

    /// Makes a picture white and its scene empty.
    pub fn clear(&self, picture: &Picture) {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        drop(clearing(&mut encoder, picture));
        self.queue.submit([encoder.finish()]);
    }

    /// Fills the depth buffer with a plane, x · px + y · py + c at pixel centres, cut to 0..=1.
    pub fn fill_depth(&self, picture: &Picture, plane: [f32; 3]) {
        let source = format!(
            "@vertex fn vs(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {{
                 return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
             }}
             @fragment fn fs(@builtin(position) p: vec4<f32>) -> @builtin(frag_depth) f32 {{
                 return saturate(p.x * f32({:?}) + p.y * f32({:?}) + f32({:?}));
             }}",
            plane[0], plane[1], plane[2]
        );
        let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let pipeline = self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: wgpu::TextureFormat::Depth32Float,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fs"),
                compilation_options: Default::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: COLOR_FORMAT,
                    blend: None,
                    write_mask: wgpu::ColorWrites::empty(),
                })],
            }),
            multiview_mask: None,
            cache: None,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut pass = clearing(&mut encoder, picture);
        pass.set_pipeline(&pipeline);
        pass.draw(0..3, 0..1);
        drop(pass);
        self.queue.submit([encoder.finish()]);
    }

    /// A buffer's bytes.
    pub fn read_buffer(&self, buffer: &wgpu::Buffer) -> Vec<u8> {
        let copy = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: buffer.size(),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, buffer.size());
        self.queue.submit([encoder.finish()]);
        self.mapped(&copy)
    }

    /// A texture's texels, `bytes` each, rows from the top.
    pub fn read_texture(&self, texture: &wgpu::Texture, bytes: u32) -> Vec<u8> {
        let (row, height) = (texture.width() * bytes, texture.height());
        let padded_row = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let copy = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(padded_row * height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &copy,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded_row),
                    rows_per_image: None,
                },
            },
            texture.size(),
        );
        self.queue.submit([encoder.finish()]);
        self.mapped(&copy).chunks(padded_row as usize).flat_map(|padded| padded[..row as usize].to_vec()).collect()
    }

    /// The values of a depth buffer, rows from the top. OpenGL copies no depths, so a pass brings them into words.
    pub fn read_depth(&self, depth: &wgpu::Texture) -> Vec<f32> {
        let source = "
            @group(0) @binding(0) var depth: texture_2d<f32>;
            @group(0) @binding(1) var nearest: sampler;
            @vertex fn vs(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
                return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
            }
            @fragment fn fs(@builtin(position) p: vec4<f32>) -> @location(0) u32 {
                let size = vec2<f32>(textureDimensions(depth));
                return bitcast<u32>(textureSampleLevel(depth, nearest, p.xy / size, 0.0).x);
            }";
        let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let texture = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering);
        let layout = self.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[entry(0, texture), entry(1, sampler)],
        });
        let pipeline_layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let format = wgpu::TextureFormat::R32Uint;
        let pipeline = self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: Some(&pipeline_layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                targets: &[Some(format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let words = self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: depth.size(),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let (from, to) = (depth.create_view(&Default::default()), words.create_view(&Default::default()));
        let sampler = self.device.create_sampler(&Default::default());
        let resources = [wgpu::BindingResource::TextureView(&from), wgpu::BindingResource::Sampler(&sampler)];
        let entries: Vec<_> =
            (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &entries,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &to,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        drop(pass);
        self.queue.submit([encoder.finish()]);
        bytemuck::pod_collect_to_vec(&self.read_texture(&words, 4))
    }

    fn mapped(&self, buffer: &wgpu::Buffer) -> Vec<u8> {
        buffer.map_async(wgpu::MapMode::Read, .., |result| result.expect("a buffer for reading can be mapped"));
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device is not lost");
        buffer.get_mapped_range(..).expect("it is mapped").to_vec()
    }
}

/// Begins a pass that clears colour to white and depth to 0.
fn clearing<'a>(encoder: &'a mut wgpu::CommandEncoder, picture: &Picture) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: None,
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &picture.views[0],
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::WHITE), store: wgpu::StoreOp::Store },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &picture.views[1],
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}

impl Picture {
    /// As the line pass takes them.
    pub fn targets(&self) -> LineTargets<'_> {
        let [painted, depth, inked, coverage] = &self.views;
        LineTargets { painted, depth, inked, coverage }
    }
}
