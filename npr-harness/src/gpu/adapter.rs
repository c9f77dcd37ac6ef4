//! Selection of the adapter, and the features and limits requested from it.

use super::context::{GpuContext, describe, short_name};
use crate::capabilities::{Capabilities, ExecutorKind};
use crate::error::HarnessError;
use crate::picture_limits::MEMORY_BYTES;
use std::collections::HashSet;

/// An adapter that meets the requirements, not opened yet.
pub struct GpuAdapter {
    adapter: wgpu::Adapter,
}

/// The limits that a device is opened with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DeviceLimits {
    /// All limits of the adapter.
    #[default]
    Adapter,
    /// The limits of every WebGL2 device: textures of 2048 px, no storage buffers, no compute shaders.
    Webgl2,
}

impl DeviceLimits {
    /// Reads the environment variable `NPR_GPU_LIMITS`: `adapter` (the default) or `webgl2`.
    ///
    /// # Errors
    /// [`HarnessError::GpuLimits`] for anything else.
    pub fn from_env() -> Result<Self, HarnessError> {
        let value = std::env::var_os("NPR_GPU_LIMITS").unwrap_or_default();
        match value.to_string_lossy().as_ref() {
            "" | "adapter" => Ok(Self::Adapter),
            "webgl2" => Ok(Self::Webgl2),
            other => Err(HarnessError::GpuLimits { name: other.to_owned() }),
        }
    }
}

impl GpuAdapter {
    /// Finds a hardware adapter, else a software one. Among each kind, Vulkan, Metal and DirectX are preferred over
    /// OpenGL, which is only tried if the others offer no hardware adapter. `WGPU_BACKEND` restricts the APIs.
    ///
    /// # Errors
    /// [`HarnessError::NoAdapter`] with a list of the adapters considered.
    pub fn find() -> Result<Self, HarnessError> {
        let (mut seen, mut software) = (Vec::new(), None);
        for backends in BACKENDS {
            let Some(adapter) = usable(backends, &mut seen).into_iter().next() else { continue };
            if !adapter.is_software() {
                return Ok(adapter);
            }
            software.get_or_insert(adapter);
        }
        software.ok_or(HarnessError::NoAdapter { seen })
    }

    /// Every adapter that meets the requirements, hardware and software, of all APIs that `WGPU_BACKEND` allows. The
    /// first is that of [`Self::find`]; of several with the same [`Self::name`], such as two equal graphics cards, only
    /// the first that the system lists is returned.
    pub fn all() -> Vec<Self> {
        let mut adapters: Vec<Self> =
            BACKENDS.into_iter().flat_map(|backends| usable(backends, &mut Vec::new())).collect();
        // Stable, so that among hardware and among software the order of APIs and ranks remains.
        adapters.sort_by_key(Self::is_software);
        let mut names = HashSet::new();
        adapters.retain(|adapter| names.insert(adapter.name()));
        adapters
    }

    /// A short name for files and charts, such as `vulkan-llvmpipe`, see [`GpuContext::name`].
    pub fn name(&self) -> String {
        short_name(&self.adapter.get_info())
    }

    /// Whether the adapter runs on the CPU.
    pub fn is_software(&self) -> bool {
        self.adapter.get_info().device_type == wgpu::DeviceType::Cpu
    }

    /// A one-line description of the adapter.
    pub fn describe(&self) -> String {
        describe(&self.adapter.get_info())
    }

    /// Opens a device on the adapter.
    ///
    /// # Errors
    /// [`HarnessError::NoDevice`].
    pub fn open(&self, limits: DeviceLimits) -> Result<GpuContext, HarnessError> {
        // Timestamps are for measurements, the other two features for shadow volumes.
        let wanted = wgpu::Features::TIMESTAMP_QUERY
            | wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS
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
        let (device, queue) = pollster::block_on(request)
            .map_err(|source| HarnessError::NoDevice { adapter: self.describe(), fault: source.to_string() })?;
        let capabilities = capabilities(&self.adapter, &device);
        Ok(GpuContext::of(self.adapter.get_info(), capabilities, device, queue))
    }
}

/// The capabilities of an opened device; its limits and features may be fewer than the adapter's.
fn capabilities(adapter: &wgpu::Adapter, device: &wgpu::Device) -> Capabilities {
    use wgpu::DownlevelFlags;
    let info = adapter.get_info();
    let flags = adapter.get_downlevel_capabilities().flags;
    let (limits, features) = (device.limits(), device.features());
    let buffers = limits.max_storage_buffers_per_shader_stage;
    Capabilities {
        kind: match info.device_type {
            wgpu::DeviceType::Cpu => ExecutorKind::SoftwareAdapter,
            _ => ExecutorKind::HardwareAdapter,
        },
        compute: flags.contains(DownlevelFlags::COMPUTE_SHADERS)
            && limits.max_compute_invocations_per_workgroup >= 64
            && buffers >= 4,
        no_compute: "the adapter has no compute shaders",
        vertex_storage: flags.contains(DownlevelFlags::VERTEX_STORAGE) && buffers >= 3,
        indirect_draws: flags.contains(DownlevelFlags::INDIRECT_EXECUTION),
        unclipped_depth: features.contains(wgpu::Features::DEPTH_CLIP_CONTROL),
        float_stencil: features.contains(wgpu::Features::DEPTH32FLOAT_STENCIL8),
        exact_depth: info.backend != wgpu::Backend::Gl,
        float_targets: adapter
            .get_texture_format_features(wgpu::TextureFormat::Rgba32Float)
            .allowed_usages
            .contains(wgpu::TextureUsages::RENDER_ATTACHMENT),
        texture_px: limits.max_texture_dimension_2d,
        storage_bytes: limits.max_storage_buffer_binding_size.min(limits.max_buffer_size),
        uniform_alignment: limits.min_uniform_buffer_offset_alignment,
        memory_bytes: MEMORY_BYTES,
    }
}

/// The APIs in the order in which they are tried.
const BACKENDS: [wgpu::Backends; 2] = [wgpu::Backends::PRIMARY, wgpu::Backends::GL];

/// The adapters of some APIs that meet the requirements, the preferred one first; `seen` receives a line about each that
/// there is.
fn usable(backends: wgpu::Backends, seen: &mut Vec<String>) -> Vec<GpuAdapter> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    descriptor.backends &= backends;
    if descriptor.backends.is_empty() {
        return Vec::new();
    }
    let mut adapters = pollster::block_on(wgpu::Instance::new(descriptor).enumerate_adapters(backends));
    seen.extend(adapters.iter().map(|adapter| describe(&adapter.get_info())));
    adapters.retain(is_enough);
    // Stable: among adapters of equal rank, the first that the system lists wins.
    adapters.sort_by_key(|adapter| rank(&adapter.get_info()));
    adapters.into_iter().map(|adapter| GpuAdapter { adapter }).collect()
}

/// Whether an adapter meets the requirements of every picture.
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
