//! What an adapter can do, and which method each pass takes for it.

use super::GpuError;
use crate::plan::{LineMethod, Plan, Reason};
use crate::scene::Scene;
use crate::shadow::ShadowMethod;
use npr_hatch::upload::TamChannels;

/// What an adapter can do, as far as pictures depend on it. Plain data: taking something away is enough to make pictures
/// without it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Capabilities {
    /// Whether the adapter is the processor itself.
    pub software: bool,
    /// Whether it runs compute shaders, in groups of 64 invocations, over the four storage buffers that they need here.
    pub compute: bool,
    /// Why not, where it does not or they are not used.
    pub no_compute: &'static str,
    /// Whether vertex shaders read the three storage buffers that edges lie in.
    pub vertex_storage: bool,
    /// Whether a draw call's arguments can lie in a buffer.
    pub indirect_draws: bool,
    /// Whether depths outside 0..=1 can be kept from being clipped, which shadow volumes need in parallel views.
    pub unclipped_depth: bool,
    /// Whether a depth buffer of 32-bit floats can have a stencil beside it. Otherwise shadow volumes are counted against
    /// depths of 24 bits.
    pub float_stencil: bool,
    /// Whether depths reach the depth buffer as they were computed. OpenGL brings them from 0..=1 to −1..=1 and back: they
    /// are multiples of 2⁻²⁴ then, at any distance.
    pub exact_depth: bool,
    /// The longest side of a texture, px.
    pub texture_px: u32,
    /// The largest storage buffer, bytes.
    pub storage_bytes: u64,
}

/// Who decides which faces and edges bound shadow volumes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VolumeMethod {
    /// The device, in each frame.
    OnDevice,
    /// The CPU, once for a light.
    OnCpu,
}

impl Capabilities {
    /// Reads them from an adapter and the device that was opened on it, whose limits and features may be less.
    pub fn new(adapter: &wgpu::Adapter, device: &wgpu::Device) -> Self {
        use wgpu::DownlevelFlags;
        let info = adapter.get_info();
        let flags = adapter.get_downlevel_capabilities().flags;
        let (limits, features) = (device.limits(), device.features());
        let buffers = limits.max_storage_buffers_per_shader_stage;
        Self {
            software: info.device_type == wgpu::DeviceType::Cpu,
            compute: flags.contains(DownlevelFlags::COMPUTE_SHADERS)
                && limits.max_compute_invocations_per_workgroup >= 64
                && buffers >= 4,
            no_compute: "the adapter has no compute shaders",
            vertex_storage: flags.contains(DownlevelFlags::VERTEX_STORAGE) && buffers >= 3,
            indirect_draws: flags.contains(DownlevelFlags::INDIRECT_EXECUTION),
            unclipped_depth: features.contains(wgpu::Features::DEPTH_CLIP_CONTROL),
            float_stencil: features.contains(wgpu::Features::DEPTH32FLOAT_STENCIL8),
            exact_depth: info.backend != wgpu::Backend::Gl,
            texture_px: limits.max_texture_dimension_2d,
            storage_bytes: limits.max_storage_buffer_binding_size.min(limits.max_buffer_size),
        }
    }

    /// What is left without compute shaders and what goes with them, and why they are not used: all passes are triangles
    /// then.
    pub fn without_compute(self, no_compute: &'static str) -> Self {
        Self { compute: false, no_compute, vertex_storage: false, indirect_draws: false, ..self }
    }

    /// Whether lines can be found on the device, whoever asks for that.
    pub fn can_find_lines(&self) -> bool {
        self.compute && self.vertex_storage && self.indirect_draws
    }

    /// How lines from edges are found and drawn, and why so. On the device edges take [`ContourEdges::device_bytes`] in one
    /// buffer.
    ///
    /// [`ContourEdges::device_bytes`]: npr_outline::ContourEdges::device_bytes
    pub fn lines(&self, edge_bytes: u64) -> (LineMethod, String) {
        let rectangles = |why: &str| (LineMethod::Rectangles, format!("found on the CPU, drawn as rectangles: {why}"));
        match (self.compute, self.software) {
            (false, _) => rectangles(self.no_compute),
            (true, true) => rectangles("a software rasteriser has no units to find them by"),
            (true, false) if !self.vertex_storage => rectangles("the adapter has no storage buffers in vertex shaders"),
            (true, false) if !self.indirect_draws => rectangles("the adapter has no draws with arguments in a buffer"),
            (true, false) if edge_bytes > self.storage_bytes => {
                rectangles("so many edges do not fit the adapter's storage buffers")
            }
            (true, false) => (LineMethod::OnDevice, "found and drawn on the device".into()),
        }
    }

    /// Who decides what bounds shadow volumes, and why so.
    pub fn volumes(&self) -> (VolumeMethod, &'static str) {
        if self.software {
            (VolumeMethod::OnCpu, "bounds found on the CPU: a software rasteriser is slow at many small instances")
        } else {
            (VolumeMethod::OnDevice, "bounds found on the device")
        }
    }

    /// What tonal art maps are stored in, and why so.
    pub fn tonal_art_map(&self) -> (TamChannels, &'static str) {
        if self.software {
            (TamChannels::HalfFloats, "half floats: a software rasteriser filters bytes in 8 bits")
        } else {
            (TamChannels::Bytes, "bytes")
        }
    }

    /// Depth with a stencil: as exact as there is.
    pub(super) fn stencil_format(&self) -> wgpu::TextureFormat {
        if self.float_stencil {
            wgpu::TextureFormat::Depth32FloatStencil8
        } else {
            wgpu::TextureFormat::Depth24PlusStencil8
        }
    }

    /// By which methods the passes of a plan are made, and why; or why the adapter cannot make the picture.
    ///
    /// `samples`: along each axis of a pixel of a picture of `size` px.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] with the texture that would be, [`GpuError::ParallelVolumes`].
    pub fn methods(
        &self,
        scene: &Scene,
        plan: &Plan,
        parallel: bool,
        size: (u32, u32),
        samples: u32,
    ) -> Result<Vec<Reason>, GpuError> {
        let samples = samples.max(1);
        self.check_size("the picture", size)?;
        self.check_size("the picture's samples", (size.0.saturating_mul(samples), size.1.saturating_mul(samples)))?;
        let mut methods = Vec::new();
        let mut add = |pass, why: &str| methods.push(Reason { pass, why: why.to_owned() });
        if let Some(contours) = &plan.contours {
            add("lines", &self.lines(contours.device_bytes(&scene.model.positions)).1);
        }
        if let Some(image) = &plan.image {
            self.check_size("the ink", image.ink.scale.size(size))?;
            add("lines in the image", "fragment shader");
        }
        match plan.shadow.as_ref().map(|shadow| shadow.style.method) {
            Some(ShadowMethod::Volumes) if parallel && !self.unclipped_depth => return Err(GpuError::ParallelVolumes),
            Some(ShadowMethod::Volumes) => {
                add("shadow volumes", self.volumes().1);
                let stencil = if self.float_stencil {
                    "depths of 32-bit floats"
                } else {
                    "depths of 24 bits: the adapter has no stencil beside floats"
                };
                add("shadow volumes", stencil);
            }
            Some(ShadowMethod::Map { side }) => {
                self.check_size("the shadow map", (side, side))?;
                add("shadow map", "depths of 32-bit floats");
            }
            None => {}
        }
        if let Some(hatch) = &plan.hatch {
            let side = hatch.tam()?.side;
            self.check_size("the tonal art map", (side, side))?;
            add("tonal art map", self.tonal_art_map().1);
        }
        if plan.looks_up() {
            for texture in &scene.model.textures {
                self.check_size("a texture of the model", (texture.width, texture.height))?;
            }
        }
        if !self.exact_depth {
            add("depth", "multiples of 2^-24: OpenGL brings depths from 0..1 to -1..1 and back");
        }
        Ok(methods)
    }

    /// Whether a texture can be had.
    pub(super) fn check_size(&self, what: &'static str, (width, height): (u32, u32)) -> Result<(), GpuError> {
        let limit = self.texture_px;
        if width == 0 || height == 0 || width > limit || height > limit {
            return Err(GpuError::TooLarge { what, width, height, limit });
        }
        Ok(())
    }
}
