//! Timestamps before and after frames.

use crate::error::HarnessError;
use crate::gpu::GpuContext;

/// The features that writing timestamps between passes needs.
pub(crate) const CLOCK_FEATURES: wgpu::Features =
    wgpu::Features::TIMESTAMP_QUERY.union(wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS);

/// Two timestamps for each of some frames.
pub(super) struct DeviceClock {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    frames: u32,
    tick_ms: f64,
}

impl DeviceClock {
    /// A clock for a number of frames; `None` if the device cannot write timestamps between passes.
    pub(super) fn new(context: &GpuContext, frames: u32) -> Option<Self> {
        let GpuContext { device, queue, .. } = context;
        if !device.features().contains(CLOCK_FEATURES) {
            return None;
        }
        let count = 2 * frames;
        let queries = device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("frames"),
            ty: wgpu::QueryType::Timestamp,
            count,
        });
        let resolved = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("timestamps"),
            size: u64::from(count) * u64::from(wgpu::QUERY_SIZE),
            usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        Some(Self { queries, resolved, frames, tick_ms: f64::from(queue.get_timestamp_period()) * 1e-6 })
    }

    /// The commands to submit with each frame, before and after its own.
    pub(super) fn marks(&self, context: &GpuContext) -> Vec<[wgpu::CommandBuffer; 2]> {
        let mark = |query| {
            let mut encoder = context.device.create_command_encoder(&Default::default());
            encoder.write_timestamp(&self.queries, query);
            encoder.finish()
        };
        (0..self.frames).map(|frame| [mark(2 * frame), mark(2 * frame + 1)]).collect()
    }

    /// The mean time of the frames, ms; `None` if a frame does not end after it began, by the timestamps.
    pub(super) fn read(&self, context: &GpuContext) -> Result<Option<f64>, HarnessError> {
        let mut encoder = context.device.create_command_encoder(&Default::default());
        encoder.resolve_query_set(&self.queries, 0..2 * self.frames, &self.resolved, 0);
        context.queue.submit([encoder.finish()]);
        let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(&context.read_buffer(&self.resolved)?);
        let of_frames = ticks.as_chunks::<2>().0.iter();
        let lengths: Option<Vec<u64>> =
            of_frames.map(|[begin, end]| end.checked_sub(*begin).filter(|&length| length > 0)).collect();
        Ok(lengths.map(|lengths| lengths.iter().sum::<u64>() as f64 * self.tick_ms / f64::from(self.frames)))
    }
}
