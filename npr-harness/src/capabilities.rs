//! The capabilities of an executor, and the method for each pass that follows from them.

use crate::edge_lines::EdgeLineMethod;
use crate::error::HarnessError;
use crate::picture_limits::MEMORY_BYTES;
use crate::shadow::VolumeMethod;

/// Above this number of objects, methods with GPU passes or buffers per object are not used, neither for finding lines
/// nor for shadow volumes.
pub(crate) const MANY_OBJECTS: usize = 64;

/// The kind of an executor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExecutorKind {
    /// Ray casting on the CPU.
    RayCaster,
    /// A graphics adapter that runs on the CPU.
    SoftwareAdapter,
    /// A hardware graphics adapter.
    HardwareAdapter,
}

/// The capabilities of an executor that affect pictures. Plain data: clearing a field is enough to make pictures
/// without that capability.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Capabilities {
    /// The kind of the executor. The other fields apply to adapters; a ray caster has no such limits.
    pub kind: ExecutorKind,
    /// Whether the adapter supports compute shaders with workgroups of 64 invocations and the four storage buffers that
    /// they use here.
    pub compute: bool,
    /// The reason if compute shaders are not supported or not used.
    pub no_compute: &'static str,
    /// Whether vertex shaders can read the three storage buffers that hold the edges.
    pub vertex_storage: bool,
    /// Whether indirect draws are supported.
    pub indirect_draws: bool,
    /// Whether depth clipping can be disabled, which shadow volumes need in parallel views.
    pub unclipped_depth: bool,
    /// Whether a depth buffer of 32-bit floats can have a stencil. Otherwise shadow volumes use depths of 24 bits.
    pub float_stencil: bool,
    /// Whether depths are stored as computed. OpenGL maps them from 0..=1 to −1..=1 and back, which rounds them to
    /// multiples of 2⁻²⁴ at any distance.
    pub exact_depth: bool,
    /// Whether four 32-bit floats can be rendered to, which a style's own G-buffer of separate targets needs.
    pub float_targets: bool,
    /// The longest side of a texture, px.
    pub texture_px: u32,
    /// The largest storage buffer, bytes.
    pub storage_bytes: u64,
    /// Uniforms in one buffer lie at multiples of this, bytes.
    pub uniform_alignment: u32,
    /// The memory that a picture may use in addition to its scene, bytes.
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
        float_targets: true,
        texture_px: u32::MAX,
        storage_bytes: u64::MAX,
        uniform_alignment: 256,
        memory_bytes: MEMORY_BYTES,
    };

    /// Whether the executor is an adapter, not the CPU ray caster.
    pub fn is_adapter(&self) -> bool {
        self.kind != ExecutorKind::RayCaster
    }

    /// Whether the adapter runs on the CPU.
    pub fn is_software(&self) -> bool {
        self.kind == ExecutorKind::SoftwareAdapter
    }

    /// The same capabilities without compute shaders and the methods that need them, with the reason. All passes then
    /// draw triangles.
    pub fn without_compute(self, no_compute: &'static str) -> Self {
        Self { compute: false, no_compute, vertex_storage: false, indirect_draws: false, ..self }
    }

    /// Whether the adapter supports finding lines on the GPU.
    pub fn can_find_lines(&self) -> bool {
        self.compute && self.vertex_storage && self.indirect_draws
    }

    /// Selects how edge lines are found, with the reason. On the GPU the edges take [`ContourEdges::device_bytes`] in
    /// one buffer.
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

    /// Selects the executor that decides what bounds shadow volumes, with the reason.
    pub fn volumes(&self, objects: usize) -> (VolumeMethod, &'static str) {
        if self.is_software() && objects <= MANY_OBJECTS {
            (VolumeMethod::OnCpu, "bounds found on the CPU: a software rasteriser is slow at many small instances")
        } else {
            (VolumeMethod::OnDevice, "bounds found on the device")
        }
    }

    /// Whether six-tone tonal art maps are stored as half floats, else as bytes, with the reason.
    pub(crate) fn half_float_maps(&self) -> (bool, &'static str) {
        if self.is_software() {
            (true, "half floats: a software rasteriser filters bytes in 8 bits")
        } else {
            (false, "bytes")
        }
    }

    /// Checks that the adapter supports a texture of this size.
    pub(crate) fn check_size(&self, what: &'static str, (width, height): (u32, u32)) -> Result<(), HarnessError> {
        let limit = self.texture_px;
        if self.is_adapter() && (width == 0 || height == 0 || width > limit || height > limit) {
            return Err(HarnessError::TextureTooLarge { what, width, height, limit });
        }
        Ok(())
    }
}
