//! Which adapter is taken, and what is asked of it.

use super::{GpuContext, GpuError};

/// An adapter that can make pictures, not opened yet.
pub struct GpuAdapter {
    adapter: wgpu::Adapter,
}

/// What is asked of a device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DeviceLimits {
    /// All that the adapter has.
    #[default]
    Adapter,
    /// What every WebGL2 device has: textures of 2048 px, no storage buffers, no compute shaders.
    Webgl2,
}

impl DeviceLimits {
    /// Reads `NPR_GPU_LIMITS`: `adapter` (also when it is not set) or `webgl2`.
    ///
    /// # Errors
    /// [`GpuError::Limits`] for anything else.
    pub fn from_env() -> Result<Self, GpuError> {
        let value = std::env::var_os("NPR_GPU_LIMITS").unwrap_or_default();
        match value.to_string_lossy().as_ref() {
            "" | "adapter" => Ok(Self::Adapter),
            "webgl2" => Ok(Self::Webgl2),
            other => Err(GpuError::Limits { name: other.to_owned() }),
        }
    }
}

impl GpuAdapter {
    /// Finds a hardware adapter, else a software one; of each kind Vulkan's, Metal's or DirectX's before OpenGL's, which is
    /// not looked at where the others have hardware. `WGPU_BACKEND` restricts which interfaces there are.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] with what was looked at.
    pub fn find() -> Result<Self, GpuError> {
        let (mut seen, mut software) = (Vec::new(), None);
        for backends in [wgpu::Backends::PRIMARY, wgpu::Backends::GL] {
            let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
            descriptor.backends &= backends;
            if descriptor.backends.is_empty() {
                continue;
            }
            let mut adapters = pollster::block_on(wgpu::Instance::new(descriptor).enumerate_adapters(backends));
            seen.extend(adapters.iter().map(|adapter| describe(&adapter.get_info())));
            adapters.retain(is_enough);
            // Of equals the one that the system names first.
            let Some(adapter) = adapters.into_iter().min_by_key(|adapter| rank(&adapter.get_info())) else { continue };
            if adapter.get_info().device_type != wgpu::DeviceType::Cpu {
                return Ok(Self { adapter });
            }
            software.get_or_insert(adapter);
        }
        software.map(|adapter| Self { adapter }).ok_or(GpuError::NoAdapter { seen })
    }

    /// Whether the adapter is the processor itself.
    pub fn is_software(&self) -> bool {
        self.adapter.get_info().device_type == wgpu::DeviceType::Cpu
    }

    /// What the adapter is, in a line.
    pub fn describe(&self) -> String {
        describe(&self.adapter.get_info())
    }

    /// Opens a device on it.
    ///
    /// # Errors
    /// [`GpuError::NoDevice`].
    pub fn open(&self, limits: DeviceLimits) -> Result<GpuContext, GpuError> {
        // Timestamps for measurements, the other two for shadows.
        let wanted = wgpu::Features::TIMESTAMP_QUERY
            | wgpu::Features::DEPTH32FLOAT_STENCIL8
            | wgpu::Features::DEPTH_CLIP_CONTROL;
        let required_limits = match limits {
            DeviceLimits::Adapter => self.adapter.limits(),
            DeviceLimits::Webgl2 => wgpu::Limits::downlevel_webgl2_defaults().using_alignment(self.adapter.limits()),
        };
        let request = self.adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("npr"),
            required_features: self.adapter.features() & wanted,
            required_limits,
            ..Default::default()
        });
        let (device, queue) =
            pollster::block_on(request).map_err(|source| GpuError::NoDevice { adapter: self.describe(), source })?;
        Ok(GpuContext::of(&self.adapter, device, queue))
    }
}

/// An adapter's name, interface and driver.
pub(super) fn describe(info: &wgpu::AdapterInfo) -> String {
    format!("{} ({:?}, {})", info.name, info.backend, info.driver_info)
}

/// What every picture needs of an adapter.
fn is_enough(adapter: &wgpu::Adapter) -> bool {
    let depth = adapter.get_texture_format_features(wgpu::TextureFormat::Depth32Float).allowed_usages;
    depth.contains(wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING)
        && adapter.limits().max_color_attachments > 0
        && adapter.get_info().backend != wgpu::Backend::Noop
}

/// Discrete before integrated hardware, hardware before software.
fn rank(info: &wgpu::AdapterInfo) -> u8 {
    match info.device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    }
}
