//! The format of indices on a device.

/// The format of indices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct IndexFormat {
    /// Whether they have 16 bits, not 32.
    pub(crate) is_short: bool,
}

impl IndexFormat {
    /// Indices in this format.
    pub(crate) fn bytes(self, indices: &[u32]) -> Vec<u8> {
        if self.is_short {
            indices.iter().flat_map(|&index| (index as u16).to_ne_bytes()).collect()
        } else {
            bytemuck::cast_slice(indices).to_vec()
        }
    }

    /// The format of wgpu.
    pub(crate) fn on_device(self) -> wgpu::IndexFormat {
        if self.is_short { wgpu::IndexFormat::Uint16 } else { wgpu::IndexFormat::Uint32 }
    }
}
