//! A device, textures on it, and reading them back. Shared by tests, benchmark and example.

use std::sync::OnceLock;

/// A device and its queue.
pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    /// Whether a view can have another format than its texture, as far as sRGB goes.
    pub view_formats: bool,
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
    let view_formats = adapter.get_downlevel_capabilities().flags.contains(wgpu::DownlevelFlags::VIEW_FORMATS);
    Some(Gpu { device, queue, view_formats })
}

impl Gpu {
    /// A texture, uninitialised, to render to, read and copy.
    pub fn texture(&self, format: wgpu::TextureFormat, size: [u32; 2]) -> wgpu::Texture {
        self.usable(format, size, wgpu::TextureUsages::RENDER_ATTACHMENT)
    }

    fn usable(
        &self,
        format: wgpu::TextureFormat,
        [width, height]: [u32; 2],
        usage: wgpu::TextureUsages,
    ) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: usage
                | wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_SRC
                | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        })
    }

    /// A texture that holds the bytes, rows from the top.
    pub fn upload(&self, format: wgpu::TextureFormat, size: [u32; 2], bytes: &[u8]) -> wgpu::Texture {
        // Nothing is drawn into floats, which not every device could.
        let is_float = format.sample_type(None, None) == Some(wgpu::TextureSampleType::Float { filterable: false });
        let drawn = if is_float { wgpu::TextureUsages::empty() } else { wgpu::TextureUsages::RENDER_ATTACHMENT };
        let texture = self.usable(format, size, drawn);
        self.write(&texture, bytes);
        texture
    }

    /// Overwrites a texture.
    pub fn write(&self, texture: &wgpu::Texture, bytes: &[u8]) {
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(bytes.len() as u32 / texture.height()),
            rows_per_image: None,
        };
        self.queue.write_texture(texture.as_image_copy(), bytes, layout, texture.size());
    }

    /// A depth buffer that holds numbers 0..=1, drawn as no copy can write it.
    pub fn depth_buffer(&self, size: [u32; 2], numbers: &[f32]) -> wgpu::Texture {
        let numbers = view(&self.upload(wgpu::TextureFormat::R32Float, size, bytemuck::cast_slice(numbers)));
        let source = "@group(0) @binding(0) var numbers: texture_2d<f32>;
            @vertex fn vs(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
                return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
            }
            @fragment fn fs(@builtin(position) p: vec4<f32>) -> @builtin(frag_depth) f32 {
                return textureLoad(numbers, vec2<i32>(p.xy), 0).x;
            }";
        let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let layout = self.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
                count: None,
            }],
        });
        let pipeline = self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: Some(&self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: None,
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            })),
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
                targets: &[],
            }),
            multiview_mask: None,
            cache: None,
        });
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&numbers) }],
        });
        let depth = self.texture(wgpu::TextureFormat::Depth32Float, size);
        self.run(|encoder| {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: None,
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &view(&depth),
                    depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3, 0..1);
        });
        depth
    }

    /// Records and waits.
    pub fn run(&self, record: impl FnOnce(&mut wgpu::CommandEncoder)) {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        record(&mut encoder);
        self.queue.submit([encoder.finish()]);
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device is not lost");
    }

    /// A texture's texels, rows from the top.
    pub fn read(&self, texture: &wgpu::Texture) -> Vec<u8> {
        let bytes = texture.format().block_copy_size(None).expect("a colour format");
        let (row, height) = (texture.width() * bytes, texture.height());
        let padded_row = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let copy = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(padded_row * height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        self.run(|encoder| {
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
        });
        copy.map_async(wgpu::MapMode::Read, .., |result| result.expect("a buffer for reading can be mapped"));
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device is not lost");
        let mapped = copy.get_mapped_range(..).expect("it is mapped");
        mapped.chunks(padded_row as usize).flat_map(|padded| padded[..row as usize].to_vec()).collect()
    }
}

/// The whole of a texture.
pub fn view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&Default::default())
}
