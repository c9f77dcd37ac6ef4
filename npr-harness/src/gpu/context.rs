//! An open device and its error reporting.

use crate::capabilities::Capabilities;
use crate::error::HarnessError;
use std::sync::{Arc, Mutex, OnceLock};

/// The reason given where compute shaders are not used although the driver reports support.
pub(crate) const REFUSED: &str = "the driver refused the compute shaders that it had promised";

/// A device to render on.
pub struct GpuContext {
    /// Creates resources.
    pub device: wgpu::Device,
    /// Accepts submitted work.
    pub queue: wgpu::Queue,
    /// The adapter's name, backend and driver.
    pub info: wgpu::AdapterInfo,
    /// The capabilities that the driver reports.
    pub capabilities: Capabilities,
    /// Set once the driver has rejected compute shaders although it reports support.
    refused: OnceLock<()>,
    faults: Arc<Mutex<Faults>>,
}

/// The errors that a device has reported since the last check.
#[derive(Default)]
struct Faults {
    /// The reason why the device was lost; never cleared.
    lost: Option<String>,
    /// The first [`HarnessError::OutOfMemory`] or [`HarnessError::Device`]; converted because a `wgpu::Error` is not
    /// `Send` on wasm32.
    first: Option<HarnessError>,
}

impl GpuContext {
    /// Wraps an opened device.
    pub(super) fn of(
        info: wgpu::AdapterInfo,
        capabilities: Capabilities,
        device: wgpu::Device,
        queue: wgpu::Queue,
    ) -> Self {
        // Without these handlers, wgpu aborts the process on an error.
        let faults = Arc::new(Mutex::new(Faults::default()));
        let sink = Arc::clone(&faults);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            if let Ok(mut faults) = sink.lock() {
                let fault = one_line(&error.to_string());
                faults.first.get_or_insert(match error {
                    wgpu::Error::OutOfMemory { .. } => HarnessError::OutOfMemory { fault },
                    _ => HarnessError::Device { fault },
                });
            }
        }));
        let sink = Arc::clone(&faults);
        device.set_device_lost_callback(move |reason, message| {
            if let Ok(mut faults) = sink.lock() {
                faults.lost.get_or_insert_with(|| one_line(&format!("{reason:?} {message}")));
            }
        });
        Self { device, queue, info, capabilities, refused: OnceLock::new(), faults }
    }

    /// The capabilities that are used: those reported, minus those that the driver rejected.
    pub(crate) fn usable(&self) -> Capabilities {
        let capabilities = self.capabilities.clone();
        if self.refused.get().is_some() { capabilities.without_compute(REFUSED) } else { capabilities }
    }

    /// Records that a picture succeeded only without compute shaders.
    pub(crate) fn note_refusal(&self) {
        self.refused.get_or_init(|| ());
    }

    /// Whether the adapter runs on the CPU.
    pub fn is_software(&self) -> bool {
        self.capabilities.is_software()
    }

    /// A one-line description of the adapter.
    pub fn describe(&self) -> String {
        describe(&self.info)
    }

    /// Waits for all submitted work.
    ///
    /// # Errors
    /// [`HarnessError::Lost`]; or the first [`HarnessError::OutOfMemory`] or [`HarnessError::Device`] that the device
    /// has reported since the last call.
    pub fn wait(&self) -> Result<(), HarnessError> {
        let polled = self.device.poll(wgpu::PollType::wait_indefinitely());
        let mut faults = self.faults.lock().map_err(|_| HarnessError::Device { fault: "a fault was lost".into() })?;
        if let Some(reason) = &faults.lost {
            return Err(HarnessError::Lost { reason: reason.clone() });
        }
        match faults.first.take() {
            Some(error) => Err(error),
            None => polled.map(|_| ()).map_err(|error| HarnessError::Device { fault: one_line(&error.to_string()) }),
        }
    }
}

impl GpuContext {
    /// Waits for all previously submitted work, maps a buffer with usage `MAP_READ` and returns its bytes.
    pub(crate) fn map(&self, buffer: &wgpu::Buffer) -> Result<Vec<u8>, HarnessError> {
        let (sender, receiver) = std::sync::mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver is dropped only if waiting failed, and that failure is the error returned.
            let _ = sender.send(result);
        });
        self.wait()?;
        let device_error = |fault: String| HarnessError::Device { fault: one_line(&fault) };
        receiver.recv().map_err(|e| device_error(e.to_string()))?.map_err(|e| device_error(e.to_string()))?;
        let mapped = buffer.get_mapped_range(..).map_err(|e| device_error(e.to_string()))?;
        Ok(mapped.to_vec())
    }

    /// Reads back a buffer with usage `COPY_SRC`.
    pub(crate) fn read_buffer(&self, buffer: &wgpu::Buffer) -> Result<Vec<u8>, HarnessError> {
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

/// An adapter's name, interface and driver.
pub(super) fn describe(info: &wgpu::AdapterInfo) -> String {
    format!("{} ({:?}, {})", info.name, info.backend, info.driver_info)
}

/// wgpu prints each cause of an error on a line of its own.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
