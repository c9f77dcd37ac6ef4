//! A buffer view that is compressed by meshoptimizer.

use super::extensions::MESHOPT;
use super::slice::slice;
use crate::load::external::shortened;
use meshoptimizer_rs::{Workspace, codec};
use serde::Deserialize;
use std::cell::OnceCell;

/// A buffer view whose content is compressed.
pub struct CompressedView {
    extension: &'static str,
    stated: Meshopt,
    /// The decompressed content, or why there is none.
    content: OnceCell<Result<Vec<u8>, String>>,
}

/// The properties of both extensions.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Meshopt {
    pub buffer: usize,
    #[serde(default)]
    byte_offset: u64,
    byte_length: u64,
    pub byte_stride: usize,
    pub count: usize,
    mode: String,
    #[serde(default)]
    filter: Option<String>,
}

impl CompressedView {
    pub fn new(extension: &'static str, stated: Meshopt) -> Self {
        Self { extension, stated, content: OnceCell::new() }
    }

    /// The index of the buffer that holds the compressed data.
    pub fn buffer(&self) -> usize {
        self.stated.buffer
    }

    /// The decompressed content. `buffer`: the content of the buffer, or why there is none.
    ///
    /// # Errors
    /// The fault with the name of the extension.
    pub fn content(&self, buffer: Result<&[u8], &str>) -> Result<&[u8], String> {
        let decode = || {
            let Meshopt { buffer: number, byte_offset, byte_length, .. } = self.stated;
            let fail = |fault: String| format!("{}: {fault}", self.extension);
            let bytes = buffer.map_err(|fault| fail(format!("buffer {number}: {fault}")))?;
            let source = slice(bytes, byte_offset, byte_length).ok_or_else(|| {
                let range = format!("{byte_length} bytes from byte {byte_offset}");
                fail(format!("{range} reach beyond buffer {number}, which has {}", bytes.len()))
            })?;
            self.decode(source).map_err(fail)
        };
        self.content.get_or_init(decode).as_deref().map_err(Clone::clone)
    }

    fn decode(&self, source: &[u8]) -> Result<Vec<u8>, String> {
        let Meshopt { count, byte_stride: stride, .. } = self.stated;
        let space = &mut Workspace::default();
        let mode = self.stated.mode.as_str();
        let is_khr = self.extension == MESHOPT[1];
        if mode == "ATTRIBUTES" && !is_khr && source.first().is_some_and(|head| *head != 0xA0) {
            return Err("another version of the codec than that of the extension".to_owned());
        }
        let decoded = match mode {
            "ATTRIBUTES" => codec::decode_vertex_buffer(count, stride, source, space),
            "TRIANGLES" => codec::decode_index_buffer(count, stride, source, space),
            "INDICES" => codec::decode_index_sequence(count, stride, source, space),
            other => return Err(format!("unknown mode {}", shortened(other))),
        };
        let mut bytes = decoded.map_err(|error| error.to_string())?;
        let filtered = match self.stated.filter.as_deref().unwrap_or("NONE") {
            "NONE" => Ok(()),
            filter if mode != "ATTRIBUTES" => return Err(format!("filter {filter} of {mode}")),
            "OCTAHEDRAL" => codec::decode_filter_oct(&mut bytes, count, stride, space),
            "QUATERNION" => codec::decode_filter_quat(&mut bytes, count, stride, space),
            "EXPONENTIAL" => codec::decode_filter_exp(&mut bytes, count, stride, space),
            "COLOR" if is_khr => codec::decode_filter_color(&mut bytes, count, stride, space),
            other => return Err(format!("unknown filter {}", shortened(other))),
        };
        filtered.map_err(|error| error.to_string())?;
        Ok(bytes)
    }
}
