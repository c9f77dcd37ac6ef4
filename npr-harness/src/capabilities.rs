//! What an executor can do, and which method each pass takes for it.

use crate::edge_lines::EdgeLineMethod;
use crate::error::HarnessError;
use crate::picture_limits::MEMORY_BYTES;
use crate::shadow::VolumeMethod;

/// With more objects lines are not found by a pass for each, nor kept for each what bounds its shadow volumes.
pub const MANY_OBJECTS: usize = 64;

/// The kind of an executor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExecutorKind {
    /// Ray casting on the CPU.
    RayCaster,
    /// A graphics adapter that is the processor itself.
    SoftwareAdapter,
    /// A graphics adapter of hardware.
    HardwareAdapter,
}

/// What an executor can do, as far as pictures depend on it. Plain data: taking something away is enough to make pictures
/// without it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Capabilities {
    /// The kind of the executor. The following fields are about adapters; a ray caster has no such limits.
    pub kind: ExecutorKind,
    /// Whether the adapter runs compute shaders, in groups of 64 invocations, over the four storage buffers that they need
    /// here.
    pub compute: bool,
    /// The reason, if it does not, or if they are not used.
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
    /// How much memory a picture may take besides its scene, bytes.
    pub memory_bytes: u64,
}

impl Capabilities {
    /// Ray casting on the CPU, with [`MEMORY_BYTES`].
    pub const RAY_CASTER: Self = Self {
        kind: ExecutorKind::RayCaster,
        compute: false,
        no_compute: "the CPU casts rays",
        vertex_storage: false,
        indirect_draws: false,
        unclipped_depth: true,
        float_stencil: true,
        exact_depth: true,
        texture_px: u32::MAX,
        storage_bytes: u64::MAX,
        memory_bytes: MEMORY_BYTES,
    };

    /// Whether an adapter executes, and not the CPU.
    pub fn is_adapter(&self) -> bool {
        self.kind != ExecutorKind::RayCaster
    }

    /// Whether the adapter is the processor itself.
    pub fn is_software(&self) -> bool {
        self.kind == ExecutorKind::SoftwareAdapter
    }

    /// The same capabilities without compute shaders and the methods that need them, with the reason: all passes are
    /// triangles then.
    pub fn without_compute(self, no_compute: &'static str) -> Self {
        Self { compute: false, no_compute, vertex_storage: false, indirect_draws: false, ..self }
    }

    /// Whether lines can be found on the device, whoever asks for that.
    pub fn can_find_lines(&self) -> bool {
        self.compute && self.vertex_storage && self.indirect_draws
    }

    /// How lines along edges are found, and why so. On the device edges take [`ContourEdges::device_bytes`] in one buffer.
    ///
    /// [`ContourEdges::device_bytes`]: npr_outline::ContourEdges::device_bytes
    pub fn edge_lines(&self, edge_bytes: u64, objects: usize) -> (EdgeLineMethod, String) {
        let on_cpu = |why: &str| (EdgeLineMethod::OnCpu, format!("found on the CPU, drawn as rectangles: {why}"));
        match self.kind {
            ExecutorKind::RayCaster => (EdgeLineMethod::OnCpu, "found and drawn on the CPU".into()),
            _ if !self.compute => on_cpu(self.no_compute),
            ExecutorKind::SoftwareAdapter => on_cpu("a software adapter finds them no faster"),
            _ if !self.vertex_storage => on_cpu("the adapter has no storage buffers in vertex shaders"),
            _ if !self.indirect_draws => on_cpu("the adapter has no draws with arguments in a buffer"),
            _ if edge_bytes > self.storage_bytes => on_cpu("so many edges do not fit the adapter's storage buffers"),
            _ if objects > MANY_OBJECTS => on_cpu("each of so many objects would be a pass of its own"),
            _ => (EdgeLineMethod::OnDevice, "found and drawn on the device".into()),
        }
    }

    /// Who decides what bounds shadow volumes, and why so.
    pub fn volumes(&self, objects: usize) -> (VolumeMethod, &'static str) {
        if self.is_software() && objects <= MANY_OBJECTS {
            (VolumeMethod::OnCpu, "bounds found on the CPU: a software rasteriser is slow at many small instances")
        } else {
            (VolumeMethod::OnDevice, "bounds found on the device")
        }
    }

    /// Whether tonal art maps of six tones are stored as half floats, else as bytes, and why so.
    pub fn half_float_maps(&self) -> (bool, &'static str) {
        if self.is_software() {
            (true, "half floats: a software rasteriser filters bytes in 8 bits")
        } else {
            (false, "bytes")
        }
    }

    /// Whether a texture can be had.
    pub(crate) fn check_size(&self, what: &'static str, (width, height): (u32, u32)) -> Result<(), HarnessError> {
        let limit = self.texture_px;
        if self.is_adapter() && (width == 0 || height == 0 || width > limit || height > limit) {
            return Err(HarnessError::TextureTooLarge { what, width, height, limit });
        }
        Ok(())
    }
}
