//! An adapter, a device, and what went wrong on it.

use crate::capabilities::Capabilities;
use crate::error::HarnessError;
use std::sync::{Arc, Mutex, OnceLock};

/// Why compute shaders are not used that were promised.
pub(crate) const REFUSED: &str = "the driver refused the compute shaders that it had promised";

/// A device to render on.
pub struct GpuContext {
    /// Makes resources.
    pub device: wgpu::Device,
    /// Takes work.
    pub queue: wgpu::Queue,
    /// What it is.
    pub info: wgpu::AdapterInfo,
    /// What it can do, as the driver promises.
    pub capabilities: Capabilities,
    /// Set once the driver has refused compute shaders that it had promised.
    refused: OnceLock<()>,
    faults: Arc<Mutex<Faults>>,
}

/// What a device reported since it was last asked.
#[derive(Default)]
struct Faults {
    /// Why it is there no more; that remains.
    lost: Option<String>,
    /// [`HarnessError::OutOfMemory`] or [`HarnessError::Device`]: a `wgpu::Error` cannot be sent between threads on wasm32.
    first: Option<HarnessError>,
}

impl GpuContext {
    /// What an adapter gave.
    pub(super) fn of(
        info: wgpu::AdapterInfo,
        capabilities: Capabilities,
        device: wgpu::Device,
        queue: wgpu::Queue,
    ) -> Self {
        // Without these, wgpu ends the process.
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

    /// What is made use of: all that was promised and not refused.
    pub(crate) fn usable(&self) -> Capabilities {
        let capabilities = self.capabilities.clone();
        if self.refused.get().is_some() { capabilities.without_compute(REFUSED) } else { capabilities }
    }

    /// A picture was made without compute shaders that could not be made with them.
    pub(crate) fn note_refusal(&self) {
        self.refused.get_or_init(|| ());
    }

    /// Whether the adapter runs on the CPU.
    pub fn is_software(&self) -> bool {
        self.capabilities.is_software()
    }

    /// What the adapter is, in a line.
    pub fn describe(&self) -> String {
        describe(&self.info)
    }

    /// Waits for all that was submitted.
    ///
    /// # Errors
    /// [`HarnessError::Lost`]; [`HarnessError::OutOfMemory`] or [`HarnessError::Device`], the first fault that the device reported
    /// since the last call.
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
    /// Waits for a buffer with `MAP_READ` and all that was submitted before, and returns its bytes.
    pub(crate) fn map(&self, buffer: &wgpu::Buffer) -> Result<Vec<u8>, HarnessError> {
        let (sender, receiver) = std::sync::mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver is gone only if waiting failed, and then that is the error.
            let _ = sender.send(result);
        });
        self.wait()?;
        let device_error = |fault: String| HarnessError::Device { fault: one_line(&fault) };
        receiver.recv().map_err(|e| device_error(e.to_string()))?.map_err(|e| device_error(e.to_string()))?;
        let mapped = buffer.get_mapped_range(..).map_err(|e| device_error(e.to_string()))?;
        Ok(mapped.to_vec())
    }

    /// The bytes of a buffer with `COPY_SRC`.
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
