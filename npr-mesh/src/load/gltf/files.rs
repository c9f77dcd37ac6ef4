//! Bytes: the binary container, buffers, and what URIs refer to.

use super::{Document, malformed};
use crate::load::read_file;
use crate::{Limits, LoadError};
use gltf::json::{Index, Root, buffer};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// The data of one buffer.
pub(super) enum Bytes<'a> {
    /// The binary chunk of the file itself.
    Chunk(&'a [u8]),
    /// From a URI, with the length that the buffer states; two buffers may share a file.
    Resource(Rc<Vec<u8>>, usize),
}

impl Bytes<'_> {
    fn as_slice(&self) -> &[u8] {
        match self {
            Bytes::Chunk(bytes) => bytes,
            Bytes::Resource(bytes, length) => &bytes[..*length],
        }
    }
}

/// The JSON text and, of a GLB file, the binary chunk (glTF 2.0, 4.4 "Binary glTF Layout").
///
/// Our own, since the `gltf` crate's subtracts the header's length without a check and refuses files with chunks
/// of other kinds, which the specification has readers skip.
pub(super) fn split_container(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), String> {
    const HEADER: usize = 12;
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes), None));
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
    // JSON comes first and the binary chunk second; whatever follows is for extensions.
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
    Ok((text, chunks.next().filter(|(kind, _)| kind == b"BIN\0").map(|(_, body)| body)))
}

/// The data of all buffers. A file that several of them name is read once.
pub(super) fn buffers<'a>(
    path: &Path,
    limits: &Limits,
    root: &Root,
    chunk: Option<&'a [u8]>,
) -> Result<Vec<Bytes<'a>>, LoadError> {
    let mut read_before: HashMap<PathBuf, Rc<Vec<u8>>> = HashMap::new();
    let mut buffers = Vec::with_capacity(root.buffers.len());
    for (index, buffer) in root.buffers.iter().enumerate() {
        let fail = |fault: String| malformed(path, format!("buffer {index}: {fault}"));
        let stated = buffer.byte_length.0;
        let short = |there: usize| fail(format!("{stated} bytes stated, {there} there"));
        let fit = |there: usize| usize::try_from(stated).ok().filter(|s| *s <= there).ok_or_else(|| short(there));
        let bytes = match buffer.uri.as_deref() {
            None => {
                let chunk = chunk.filter(|_| index == 0).ok_or_else(|| fail("no URI and no binary chunk".into()))?;
                Bytes::Chunk(&chunk[..fit(chunk.len())?])
            }
            Some(uri) => {
                let resource = match data_uri(uri) {
                    Some(data) => Rc::new(data.map_err(fail)?),
                    None => {
                        let file = resolve(path, uri).map_err(fail)?;
                        match read_before.get(&file) {
                            Some(bytes) => Rc::clone(bytes),
                            None => {
                                let bytes = Rc::new(read_file(&file, limits)?);
                                read_before.insert(file, Rc::clone(&bytes));
                                bytes
                            }
                        }
                    }
                };
                let length = fit(resource.len())?;
                Bytes::Resource(resource, length)
            }
        };
        buffers.push(bytes);
    }
    Ok(buffers)
}

/// The bytes of a buffer view and its stride, if it states one.
pub(super) fn view<'d>(
    document: &'d Document,
    index: Index<buffer::View>,
) -> Result<(&'d [u8], Option<usize>), String> {
    let number = index.value();
    let view = document.root.get(index).ok_or_else(|| format!("buffer view {number} does not exist"))?;
    let buffer_number = view.buffer.value();
    let bytes = document
        .buffers
        .get(buffer_number)
        .ok_or_else(|| format!("buffer view {number}: buffer {buffer_number} does not exist"))?
        .as_slice();
    let (offset, length) = (view.byte_offset.unwrap_or_default().0, view.byte_length.0);
    let slice = slice(bytes, offset, length).ok_or_else(|| {
        format!(
            "buffer view {number}: {length} bytes from byte {offset} reach beyond buffer {buffer_number}, which has {}",
            bytes.len()
        )
    })?;
    Ok((slice, view.byte_stride.map(|stride| stride.0)))
}

/// `length` bytes from `offset`, where there are so many.
pub(super) fn slice(bytes: &[u8], offset: u64, length: u64) -> Option<&[u8]> {
    let end = usize::try_from(offset.checked_add(length)?).ok()?;
    bytes.get(usize::try_from(offset).ok()?..end)
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
    Some(if kind.ends_with(";base64") { base64(&data) } else { Ok(data) })
}

/// Base 64 in the standard alphabet (RFC 4648, 4), with or without the padding at its end.
fn base64(text: &[u8]) -> Result<Vec<u8>, String> {
    let padding = text.iter().rev().take(2).take_while(|c| **c == b'=').count();
    let digits = &text[..text.len() - padding];
    if digits.len() % 4 == 1 {
        return Err("base 64 data cut off".to_owned());
    }
    let mut bytes = Vec::with_capacity(digits.len() / 4 * 3 + 2);
    for (number, group) in digits.chunks(4).enumerate() {
        let mut bits = 0u32;
        for (at, &c) in group.iter().enumerate() {
            let digit = match c {
                b'A'..=b'Z' => c - b'A',
                b'a'..=b'z' => c - b'a' + 26,
                b'0'..=b'9' => c - b'0' + 52,
                b'+' => 62,
                b'/' => 63,
                _ => return Err(format!("character {} of the base 64 data is none of its digits", number * 4 + at)),
            };
            bits |= u32::from(digit) << (18 - 6 * at);
        }
        bytes.extend_from_slice(&bits.to_be_bytes()[1..group.len()]);
    }
    Ok(bytes)
}

fn percent_decoded(text: &str) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        rest = after;
        if first != b'%' {
            bytes.push(first);
            continue;
        }
        let digit = |at: usize| after.get(at).and_then(|c| char::from(*c).to_digit(16));
        let (Some(high), Some(low)) = (digit(0), digit(1)) else {
            return Err("'%' in a URI without two hexadecimal digits".to_owned());
        };
        bytes.push((high * 16 + low) as u8);
        rest = &after[2..];
    }
    Ok(bytes)
}

/// The file that a relative URI names, which may only lie in the model's own folder or below it: what a model
/// refers to is read on its word alone, so it must not reach the rest of the disk.
pub(super) fn resolve(model: &Path, uri: &str) -> Result<PathBuf, String> {
    let refused = |why: &str| format!("URI \"{}\" {why}", shortened(uri));
    let name = percent_decoded(uri).map_err(|fault| refused(&format!("({fault})")))?;
    let name = String::from_utf8(name).map_err(|_| refused("is not UTF-8"))?;
    // Drive letters and schemes have a colon, and a backslash is a separator on some systems.
    if name.starts_with('/') || name.contains([':', '\\', '\0']) {
        return Err(refused("is not a relative path"));
    }
    let mut parts = Vec::new();
    for part in name.split('/') {
        match part {
            "" | "." => {}
            ".." if parts.pop().is_none() => return Err(refused("leads out of the model's folder")),
            ".." => {}
            _ => parts.push(part),
        }
    }
    if parts.is_empty() {
        return Err(refused("names no file"));
    }
    let mut file = model.parent().unwrap_or(Path::new("")).to_owned();
    file.extend(parts);
    Ok(file)
}

/// A URI for messages.
pub(super) fn shortened(uri: &str) -> String {
    const MOST: usize = 80;
    let mut text: String = uri.chars().take(MOST).flat_map(char::escape_debug).collect();
    if uri.chars().nth(MOST).is_some() {
        text.push('…');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_every_length() {
        for (text, bytes) in [
            ("", &b""[..]),
            ("Zg==", b"f"),
            ("Zg", b"f"),
            ("Zm8=", b"fo"),
            ("Zm9v", b"foo"),
            ("Zm9vYg==", b"foob"),
            ("+/+/", b"\xFB\xFF\xBF"),
        ] {
            assert_eq!(base64(text.as_bytes()).unwrap(), bytes, "{text}");
        }
        for text in ["Z", "Zm9vY", "Zm 9", "Zg===", "Z=g=", "Zm9-"] {
            assert!(base64(text.as_bytes()).is_err(), "{text}");
        }
    }

    #[test]
    fn uris_stay_in_the_folder() {
        let model = Path::new("models/m.gltf");
        for (uri, file) in [
            ("a.bin", "models/a.bin"),
            ("a%20b.bin", "models/a b.bin"),
            ("./t/../a.bin", "models/a.bin"),
            ("t/a.png", "models/t/a.png"),
        ] {
            assert_eq!(resolve(model, uri).unwrap(), Path::new(file), "{uri}");
        }
        for uri in [
            "",
            ".",
            "..",
            "../a.bin",
            "t/../../a.bin",
            "%2e%2e/a.bin",
            "..%2fa.bin",
            "/a.bin",
            "%2fa.bin",
            "C:/a.bin",
            "file:///a.bin",
            "http://a/a.bin",
            "..\\a.bin",
            "a%",
            "a%0",
            "a%zz",
            "a%ff",
            "a%00b",
        ] {
            assert!(resolve(model, uri).is_err(), "{uri}");
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
