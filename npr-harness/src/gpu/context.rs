//! An adapter, a device, and what went wrong on it.

use super::GpuError;
use npr_outline::line_strokes::STROKE_FORMAT;
use std::sync::{Arc, Mutex};

/// A device to render on.
pub struct GpuContext {
    /// Makes resources.
    pub device: wgpu::Device,
    /// Takes work.
    pub queue: wgpu::Queue,
    /// What it is.
    pub info: wgpu::AdapterInfo,
    /// Whether lines can be found on the device.
    pub can_find_lines: bool,
    /// Whether lines can be drawn by compute shaders.
    pub can_stroke: bool,
    faults: Arc<Mutex<Faults>>,
}

/// What a device reported since it was last asked.
#[derive(Default)]
struct Faults {
    /// Why it is there no more; that remains.
    lost: Option<String>,
    /// [`GpuError::OutOfMemory`] or [`GpuError::Device`]: a `wgpu::Error` cannot be sent between threads on wasm32.
    first: Option<GpuError>,
}

impl GpuContext {
    /// Takes a hardware adapter, else a software one.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] with what was looked at, or why the device could not be had.
    pub fn new() -> Result<Self, GpuError> {
        pollster::block_on(Self::request())
    }

    async fn request() -> Result<Self, GpuError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let mut adapters = instance.enumerate_adapters(wgpu::Backends::all()).await;
        let seen: Vec<String> = adapters.iter().map(|a| describe(&a.get_info())).collect();
        adapters.retain(is_enough);
        // Stable: of equals the one that the system names first.
        adapters.sort_by_key(|adapter| rank(&adapter.get_info()));
        let adapter = adapters.first().ok_or(GpuError::NoAdapter { seen })?;
        let info = adapter.get_info();
        // The latter two for shadows.
        let wanted = wgpu::Features::TIMESTAMP_QUERY
            | wgpu::Features::DEPTH32FLOAT_STENCIL8
            | wgpu::Features::DEPTH_CLIP_CONTROL;
        let flags = adapter.get_downlevel_capabilities().flags;
        let can_find_lines = flags
            .contains(wgpu::DownlevelFlags::VERTEX_STORAGE | wgpu::DownlevelFlags::INDIRECT_EXECUTION)
            && flags.contains(wgpu::DownlevelFlags::COMPUTE_SHADERS);
        let limits = adapter.limits();
        let stored = adapter.get_texture_format_features(STROKE_FORMAT).allowed_usages;
        let can_stroke = flags.contains(wgpu::DownlevelFlags::COMPUTE_SHADERS)
            && stored.contains(wgpu::TextureUsages::STORAGE_BINDING)
            && limits.max_storage_buffers_per_shader_stage >= 4
            && limits.max_storage_textures_per_shader_stage >= 1;
        let (device, queue) = adapter
            .request_device(&wgpu::DeviceDescriptor {
                label: Some("npr"),
                required_features: adapter.features() & wanted,
                required_limits: limits,
                ..Default::default()
            })
            .await
            .map_err(|source| GpuError::NoDevice { adapter: describe(&info), source })?;
        // Without these, wgpu ends the process.
        let faults = Arc::new(Mutex::new(Faults::default()));
        let sink = Arc::clone(&faults);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            if let Ok(mut faults) = sink.lock() {
                let fault = one_line(&error.to_string());
                faults.first.get_or_insert(match error {
                    wgpu::Error::OutOfMemory { .. } => GpuError::OutOfMemory { fault },
                    _ => GpuError::Device { fault },
                });
            }
        }));
        let sink = Arc::clone(&faults);
        device.set_device_lost_callback(move |reason, message| {
            if let Ok(mut faults) = sink.lock() {
                faults.lost.get_or_insert_with(|| one_line(&format!("{reason:?} {message}")));
            }
        });
        Ok(Self { device, queue, info, can_find_lines, can_stroke, faults })
    }

    /// Whether the adapter runs on the CPU.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// What the adapter is, in a line.
    pub fn describe(&self) -> String {
        describe(&self.info)
    }

    /// Waits for all that was submitted.
    ///
    /// # Errors
    /// [`GpuError::Lost`]; [`GpuError::OutOfMemory`] or [`GpuError::Device`], the first fault that the device reported
    /// since the last call.
    pub fn wait(&self) -> Result<(), GpuError> {
        let polled = self.device.poll(wgpu::PollType::wait_indefinitely());
        let mut faults = self.faults.lock().map_err(|_| GpuError::Device { fault: "a fault was lost".into() })?;
        if let Some(reason) = &faults.lost {
            return Err(GpuError::Lost { reason: reason.clone() });
        }
        match faults.first.take() {
            Some(error) => Err(error),
            None => polled.map(|_| ()).map_err(|error| GpuError::Device { fault: one_line(&error.to_string()) }),
        }
    }
}

impl GpuContext {
    /// Waits for a buffer with `MAP_READ` and all that was submitted before, and returns its bytes.
    pub(super) fn map(&self, buffer: &wgpu::Buffer) -> Result<Vec<u8>, GpuError> {
        let (sender, receiver) = std::sync::mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver is gone only if waiting failed, and then that is the error.
            let _ = sender.send(result);
        });
        self.wait()?;
        let device_error = |fault: String| GpuError::Device { fault: one_line(&fault) };
        receiver.recv().map_err(|e| device_error(e.to_string()))?.map_err(|e| device_error(e.to_string()))?;
        let mapped = buffer.get_mapped_range(..).map_err(|e| device_error(e.to_string()))?;
        Ok(mapped.to_vec())
    }

    /// The bytes of a buffer with `COPY_SRC`.
    pub(super) fn read_buffer(&self, buffer: &wgpu::Buffer) -> Result<Vec<u8>, GpuError> {
        let copy = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("copy"),
            size: buffer.size(),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, buffer.size());
        self.queue.submit([encoder.finish()]);
        self.map(&copy)
    }
}

/// wgpu tells causes on lines of their own.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn describe(info: &wgpu::AdapterInfo) -> String {
    format!("{} ({:?}, {})", info.name, info.backend, info.driver_info)
}

/// What every picture needs of an adapter.
fn is_enough(adapter: &wgpu::Adapter) -> bool {
    let depth = adapter.get_texture_format_features(wgpu::TextureFormat::Depth32Float).allowed_usages;
    depth.contains(wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING)
        && adapter.limits().max_color_attachments > 0
        && adapter.get_info().backend != wgpu::Backend::Noop
}

/// Hardware before software, Vulkan, Metal and DirectX before OpenGL.
fn rank(info: &wgpu::AdapterInfo) -> (u8, u8) {
    let kind = match info.device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    };
    (kind, u8::from(info.backend == wgpu::Backend::Gl))
}
