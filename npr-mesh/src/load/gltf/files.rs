//! Raw data: the binary container, buffers, and URIs.

use super::document::{Bytes, Document};
use super::slice::slice;
use crate::LoadError;
use crate::load::external::{External, meanings, shortened};
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use base64::{DecodeError, Engine};
use gltf::json::{Index, Root, buffer};
use std::borrow::Cow;
use std::collections::HashMap;
use std::path::PathBuf;
use std::rc::Rc;

/// Splits a file into the JSON text and, for a GLB file, the binary chunk (glTF 2.0, 4.4 "Binary glTF Layout").
///
/// The parser of the `gltf` crate subtracts the length of the header without a check, and rejects files with chunks
/// of unknown types, which the specification requires readers to skip.
pub(super) fn split_container<'a>(
    bytes: &'a [u8],
    warnings: &mut Vec<String>,
) -> Result<(&'a [u8], Option<&'a [u8]>), String> {
    const HEADER: usize = 12;
    let mut without_mark = |text: &'a [u8]| match text.strip_prefix(b"\xEF\xBB\xBF") {
        Some(rest) => {
            warnings.push("a byte-order mark at the beginning is passed over".to_owned());
            rest
        }
        None => text,
    };
    if !bytes.starts_with(b"glTF") {
        return Ok((without_mark(bytes), None));
    }
    let word = |at: usize| bytes.get(at..)?.first_chunk().map(|four| u32::from_le_bytes(*four));
    let (Some(version), Some(length)) = (word(4), word(8)) else {
        return Err("GLB header cut off".to_owned());
    };
    if version != 2 {
        return Err(format!("GLB version {version}, expected 2"));
    }
    let length = length as usize;
    if length > bytes.len() {
        return Err(format!("GLB cut off: {length} bytes by its header, {} in the file", bytes.len()));
    }
    let mut rest = bytes.get(HEADER..length).ok_or_else(|| format!("GLB length {length} in its header"))?;
    let mut chunks = Vec::new();
    // The first chunk is JSON, the second the binary chunk; further chunks belong to extensions.
    while chunks.len() < 2 && !rest.is_empty() {
        let cut_off = || format!("GLB chunk {} cut off", chunks.len());
        let (head, body) = rest.split_first_chunk::<8>().ok_or_else(cut_off)?;
        let [a, b, c, d, kind @ ..] = *head;
        let size = u32::from_le_bytes([a, b, c, d]) as usize;
        let (body, after) = body.split_at_checked(size).ok_or_else(cut_off)?;
        chunks.push((kind, body));
        rest = after;
    }
    let mut chunks = chunks.into_iter();
    let Some((kind, text)) = chunks.next() else { return Err("GLB without a chunk".to_owned()) };
    if kind != *b"JSON" {
        return Err("first GLB chunk is not JSON".to_owned());
    }
    Ok((without_mark(text), chunks.next().filter(|(kind, _)| kind == b"BIN\0").map(|(_, body)| body)))
}

/// The content of all buffers, and the number of bytes read for them. A file is read once even if several buffers
/// refer to it.
///
/// # Errors
/// Only exceeded limits, since an unavailable buffer may be unused.
pub(super) fn buffers<'a>(
    external: &External,
    root: &Root,
    chunk: Option<&'a [u8]>,
) -> Result<(Vec<Bytes<'a>>, u64), LoadError> {
    let mut read_before: HashMap<PathBuf, Rc<Vec<u8>>> = HashMap::new();
    let mut buffers = Vec::with_capacity(root.buffers.len());
    for (index, buffer) in root.buffers.iter().enumerate() {
        let stated = buffer.byte_length.0;
        let fit = |there: usize| usize::try_from(stated).ok().filter(|stated| *stated <= there);
        let short = |there: usize| Bytes::Missing(format!("{stated} bytes stated, {there} there"));
        buffers.push(match (buffer.uri.as_deref(), chunk.filter(|_| index == 0)) {
            (None, None) => Bytes::Missing("no URI and no binary chunk".to_owned()),
            (None, Some(chunk)) => match fit(chunk.len()) {
                Some(length) => Bytes::Chunk(&chunk[..length]),
                None => short(chunk.len()),
            },
            (Some(uri), _) => match resource(external, uri, &mut read_before) {
                Ok(resource) => match fit(resource.len()) {
                    Some(length) => Bytes::Resource(resource, length),
                    None => short(resource.len()),
                },
                Err(error @ LoadError::TooLarge { .. }) => return Err(error),
                Err(LoadError::Malformed { fault, .. }) => Bytes::Missing(fault),
                Err(LoadError::Outside { name, .. }) => {
                    Bytes::Missing(format!("URI \"{name}\" leads out of the model's folder"))
                }
                Err(error) => Bytes::Missing(error.to_string()),
            },
        });
    }
    let bytes = read_before.values().map(|bytes| bytes.len() as u64).sum();
    Ok((buffers, bytes))
}

fn resource(
    external: &External,
    uri: &str,
    read_before: &mut HashMap<PathBuf, Rc<Vec<u8>>>,
) -> Result<Rc<Vec<u8>>, LoadError> {
    let malformed = |fault| LoadError::Malformed { path: external.model.to_owned(), fault };
    if let Some(data) = data_uri(uri) {
        return data.map(Rc::new).map_err(malformed);
    }
    let file = external.find(&names(uri).map_err(malformed)?)?;
    if let Some(bytes) = read_before.get(&file) {
        return Ok(Rc::clone(bytes));
    }
    let bytes = Rc::new(external.read(&file)?);
    read_before.insert(file, Rc::clone(&bytes));
    Ok(bytes)
}

/// The bytes of a buffer view, and its stride if stated.
pub(super) fn view<'d>(
    document: &'d Document,
    index: Index<buffer::View>,
) -> Result<(&'d [u8], Option<usize>), String> {
    let number = index.value();
    let view = &document.root.buffer_views[number];
    let stride = view.byte_stride.map(|stride| stride.0);
    if let Some(compressed) = document.decoded.get(&number) {
        let content = compressed
            .content(document.buffers[compressed.buffer()].as_slice())
            .map_err(|fault| format!("buffer view {number}: {fault}"))?;
        return Ok((content, stride));
    }
    let buffer_number = view.buffer.value();
    let bytes = document.buffers[buffer_number]
        .as_slice()
        .map_err(|fault| format!("buffer view {number}: buffer {buffer_number}: {fault}"))?;
    let (offset, length) = (view.byte_offset.unwrap_or_default().0, view.byte_length.0);
    let slice = slice(bytes, offset, length).ok_or_else(|| {
        format!(
            "buffer view {number}: {length} bytes from byte {offset} reach beyond buffer {buffer_number}, which has {}",
            bytes.len()
        )
    })?;
    Ok((slice, stride))
}

/// The content of a `data:` URI (RFC 2397), or `None` for any other URI.
pub(super) fn data_uri(uri: &str) -> Option<Result<Vec<u8>, String>> {
    let (scheme, rest) = uri.split_at_checked(5)?;
    if !scheme.eq_ignore_ascii_case("data:") {
        return None;
    }
    let Some((kind, data)) = rest.split_once(',') else { return Some(Err("data URI without a comma".to_owned())) };
    let data = match percent_decoded(data) {
        Ok(data) => data,
        Err(fault) => return Some(Err(fault)),
    };
    let is_base64 = kind.len() >= 7 && kind.as_bytes()[kind.len() - 7..].eq_ignore_ascii_case(b";base64");
    Some(if is_base64 { base64(&data) } else { Ok(data.into_owned()) })
}

/// Decodes base 64 in the standard alphabet (RFC 4648, section 4) with or without padding.
fn base64(text: &[u8]) -> Result<Vec<u8>, String> {
    let config = GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::RequireNone)
        .with_decode_allow_trailing_bits(true);
    let padding = text.iter().rev().take(2).take_while(|c| **c == b'=').count();
    let engine = GeneralPurpose::new(&base64::alphabet::STANDARD, config);
    engine.decode(&text[..text.len() - padding]).map_err(|error| match error {
        DecodeError::InvalidByte(at, _) => format!("character {at} of the base 64 data is not a base 64 digit"),
        _ => "base 64 data cut off".to_owned(),
    })
}

/// Decodes percent-encoding. Unlike the URL standard it refuses a '%' without two hexadecimal digits.
fn percent_decoded(text: &str) -> Result<Cow<'_, [u8]>, String> {
    let is_valid = |(at, _)| text.get(at + 1..at + 3).is_some_and(|code| code.bytes().all(|c| c.is_ascii_hexdigit()));
    if !text.match_indices('%').all(is_valid) {
        return Err("'%' in a URI without two hexadecimal digits".to_owned());
    }
    Ok(percent_encoding::percent_decode_str(text).into())
}

/// The possible file names of a URI: relative to the model's folder, or absolute for a `file:` URI.
pub(super) fn names(uri: &str) -> Result<Vec<PathBuf>, String> {
    let refused = |why: &str| format!("URI \"{}\" {why}", shortened(uri));
    let local = uri.get(..7).filter(|scheme| scheme.eq_ignore_ascii_case("file://")).map(|_| &uri[7..]);
    // The host precedes the path.
    let local = local.map(|rest| rest.strip_prefix("localhost").unwrap_or(rest));
    let name = percent_decoded(local.unwrap_or(uri)).map_err(|fault| refused(&format!("({fault})")))?;
    let name = std::str::from_utf8(&name).map_err(|_| refused("is not UTF-8"))?;
    // Drive letters and URI schemes contain a colon.
    if name.contains([':', '\0']) || local.is_some_and(|path| !path.starts_with('/')) {
        return Err(refused("is not a relative path"));
    }
    meanings(name).ok_or_else(|| refused("names no file"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn base64_of_every_length() {
        for (text, bytes) in [
            ("", &b""[..]),
            ("Zg==", b"f"),
            ("Zg", b"f"),
            ("Zg=", b"f"),
            // Bits beyond the last byte are ignored.
            ("Zh==", b"f"),
            ("Zm8=", b"fo"),
            ("Zm9v", b"foo"),
            ("Zm9vYg==", b"foob"),
            ("+/+/", b"\xFB\xFF\xBF"),
        ] {
            assert_eq!(base64(text.as_bytes()).unwrap(), bytes, "{text}");
        }
        for text in ["Z", "Zm9vY", "Zm 9", "Zg===", "Z=g=", "Zm9-", "Zm9vZg==Zg=="] {
            assert!(base64(text.as_bytes()).is_err(), "{text}");
        }
    }

    #[test]
    fn uris_name_files() {
        for (uri, name) in [
            ("a.bin", "a.bin"),
            ("a%20b.bin", "a b.bin"),
            ("./t/../a.bin", "./t/../a.bin"),
            ("t/a.png", "t/a.png"),
            ("%2e%2e/a.bin", "../a.bin"),
            ("file:///m/a.bin", "/m/a.bin"),
            ("FILE://localhost/m/a.bin", "/m/a.bin"),
        ] {
            assert_eq!(names(uri).unwrap()[0], Path::new(name), "{uri}");
        }
        for uri in [
            "",
            ".",
            "..",
            "C:/a.bin",
            "http://a/a.bin",
            "file://host/a.bin",
            "a%",
            "a%0",
            "a%zz",
            "a%é",
            "a%%41",
            "a%ff",
            "a%00b",
        ] {
            assert!(names(uri).is_err(), "{uri}");
        }
    }

    #[test]
    fn data_uris() {
        assert_eq!(data_uri("data:application/octet-stream;base64,Zm9v").unwrap().unwrap(), b"foo");
        assert_eq!(data_uri("data:,a%20b").unwrap().unwrap(), b"a b");
        assert!(data_uri("data:nothing").unwrap().is_err());
        assert!(data_uri("a.bin").is_none() && data_uri("é.bin").is_none());
    }
}
