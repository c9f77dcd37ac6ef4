//! What can go wrong on a device.

/// Why a picture could not be made on a device.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No adapter that can do what every picture needs.
    #[error("no usable graphics adapter (seen: {})", if seen.is_empty() { "none".to_owned() } else { seen.join("; ") })]
    NoAdapter {
        /// Those that were found and are not enough.
        seen: Vec<String>,
    },
    /// The adapter gave no device.
    #[error("{adapter} gave no device: {source}")]
    NoDevice {
        /// Which.
        adapter: String,
        /// Why.
        source: wgpu::RequestDeviceError,
    },
    /// A texture larger than the device's can be.
    #[error(
        "{what} of {width} × {height} px: this device's textures have at most {limit} × {limit} px (the CPU has no such limit)"
    )]
    TooLarge {
        /// What of the picture.
        what: &'static str,
        /// Px.
        width: u32,
        /// Px.
        height: u32,
        /// Px.
        limit: u32,
    },
    /// A ramp's image larger than the device's textures can be.
    #[error(
        "a ramp of {width} × {height} texels: this device's textures are at most {limit} × {limit} (the CPU has no such limit)"
    )]
    RampTooLarge {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Texels along a side.
        limit: u32,
    },
    /// A buffer larger than the device's can be.
    #[error("{what} needs {bytes} bytes, this device's buffers hold at most {limit}")]
    BufferTooLarge {
        /// What it holds.
        what: &'static str,
        /// How much it holds.
        bytes: u64,
        /// How much is allowed.
        limit: u64,
    },
    /// More draws than a software adapter has memory for: it keeps half a MiB for each until a picture is finished
    /// (lavapipe, Mesa 22.3).
    #[error("{draws} draws, one for each material or blended face: {limit} at most on a software adapter")]
    TooManyDraws {
        /// How many there would be.
        draws: usize,
        /// How many are made.
        limit: usize,
    },
    /// Shadow volumes in a parallel view, whose depth ends, on a device that cuts off what is farther.
    #[error("this device cannot draw shadow volumes in a parallel view (a shadow map, or the CPU, can)")]
    ParallelVolumes,
    /// An environment variable that names no limits.
    #[error("NPR_GPU_LIMITS={name:?}: it must be adapter or webgl2")]
    Limits {
        /// What it says.
        name: String,
    },
    /// The device is there no more.
    #[error("the graphics device was lost: {reason}")]
    Lost {
        /// In its own words.
        reason: String,
    },
    /// The device has no memory left.
    #[error("the graphics device is out of memory: {fault}")]
    OutOfMemory {
        /// In its own words.
        fault: String,
    },
    /// The device reported a fault.
    #[error("the graphics device failed: {fault}")]
    Device {
        /// In its own words.
        fault: String,
    },
    /// Lines that cannot be drawn.
    #[error(transparent)]
    Outline(#[from] npr_outline::OutlineError),
    /// Lines in the image that cannot be found.
    #[error(transparent)]
    ImageSpace(#[from] npr_imagespace::ImageSpaceError),
    /// Bands or ramps that cannot be shaded.
    #[error(transparent)]
    Toon(#[from] npr_toon::ToonError),
    /// Tones that cannot be shaded.
    #[error(transparent)]
    Gooch(#[from] npr_gooch::GoochError),
    /// A tonal art map that cannot be looked up.
    #[error(transparent)]
    Hatch(#[from] npr_hatch::HatchError),
}

impl GpuError {
    /// Whether it lies with the device, and the CPU may make the picture.
    pub fn is_of_the_device(&self) -> bool {
        use npr_outline::OutlineError;
        match self {
            Self::NoAdapter { .. }
            | Self::NoDevice { .. }
            | Self::TooLarge { .. }
            | Self::RampTooLarge { .. }
            | Self::BufferTooLarge { .. }
            | Self::TooManyDraws { .. }
            | Self::ParallelVolumes
            | Self::Lost { .. }
            | Self::OutOfMemory { .. }
            | Self::Device { .. } => true,
            Self::Outline(error) => {
                matches!(error, OutlineError::TooManyEdges { .. })
            }
            Self::Hatch(error) => matches!(error, npr_hatch::HatchError::TooLarge { .. }),
            Self::Limits { .. } | Self::ImageSpace(_) | Self::Toon(_) | Self::Gooch(_) => false,
        }
    }

    /// Whether it is a limit of the device, and not a fault.
    pub fn is_limit(&self) -> bool {
        match self {
            Self::TooLarge { .. }
            | Self::RampTooLarge { .. }
            | Self::BufferTooLarge { .. }
            | Self::TooManyDraws { .. }
            | Self::ParallelVolumes => true,
            Self::Outline(_) | Self::Hatch(_) => self.is_of_the_device(),
            _ => false,
        }
    }

    /// Whether the device makes no further picture.
    pub(crate) fn is_final(&self) -> bool {
        matches!(self, Self::Lost { .. } | Self::OutOfMemory { .. })
    }
}
