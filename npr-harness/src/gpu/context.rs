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

    /// A short name of API and adapter for files and charts, such as `vulkan-llvmpipe` or `gl-nvidia-h200-pcie-sse2`:
    /// lower-case ASCII letters, digits and hyphens, without versions of drivers.
    pub fn name(&self) -> String {
        short_name(&self.info)
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

/// The name of [`GpuContext::name`].
pub(super) fn short_name(info: &wgpu::AdapterInfo) -> String {
    // Mesa's software rasterisers add the version of LLVM and the width of its vectors.
    let name = info.name.split(" (LLVM").next().unwrap_or_default();
    let text = format!("{} {name}", info.backend.to_str()).to_ascii_lowercase();
    let words = text.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-")
}

/// wgpu prints each cause of an error on a line of its own.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_names_are_stable_and_fit_into_file_names() {
        let named = |name: &str, backend| {
            let info =
                wgpu::AdapterInfo { name: name.into(), ..wgpu::AdapterInfo::new(wgpu::DeviceType::Other, backend) };
            short_name(&info)
        };
        assert_eq!(named("llvmpipe (LLVM 15.0.6, 256 bits)", wgpu::Backend::Vulkan), "vulkan-llvmpipe");
        assert_eq!(named("llvmpipe (LLVM 19.1.7, 128 bits)", wgpu::Backend::Gl), "gl-llvmpipe");
        assert_eq!(named("NVIDIA H200", wgpu::Backend::Vulkan), "vulkan-nvidia-h200");
        assert_eq!(named("NVIDIA H200/PCIe/SSE2", wgpu::Backend::Gl), "gl-nvidia-h200-pcie-sse2");
        // Two drivers of one card differ.
        assert_eq!(
            named("AMD Radeon RX 6800 (RADV NAVI21)", wgpu::Backend::Vulkan),
            "vulkan-amd-radeon-rx-6800-radv-navi21"
        );
        assert_eq!(named("", wgpu::Backend::Metal), "metal");
    }
}
