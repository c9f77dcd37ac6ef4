//! The header of a PLY file.

use crate::load::external::shortened;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    pub fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The number that stands for 1 in a colour: the largest integer.
    pub fn whole(self) -> f64 {
        match self {
            Self::I8 => f64::from(i8::MAX),
            Self::U8 => f64::from(u8::MAX),
            Self::I16 => f64::from(i16::MAX),
            Self::U16 => f64::from(u16::MAX),
            Self::I32 => f64::from(i32::MAX),
            Self::U32 => f64::from(u32::MAX),
            Self::F32 | Self::F64 => 1.0,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Scalar(Scalar),
    /// The types of the length and of the numbers.
    List(Scalar, Scalar),
}

pub struct Property {
    pub name: String,
    pub kind: Kind,
}

pub struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

pub struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
    textures: u64,
}

impl Header {
    /// What is skipped and would be missed.
    pub fn warnings(&self) -> Vec<String> {
        let has = |names: &[&str]| {
            let mut faces = self.elements.iter().filter(|element| element.name == "face" && element.count > 0);
            faces.any(|faces| faces.properties.iter().any(|property| names.contains(&property.name.as_str())))
        };
        let mut warnings = Vec::new();
        if has(&["red", "green", "blue"]) {
            warnings.push("colours of faces are ignored".to_owned());
        }
        if has(&["texcoord", "texcoords"]) {
            warnings.push("texture coordinates of face corners are ignored".to_owned());
        }
        if self.textures > 0 {
            warnings.push("textures that comments name are ignored".to_owned());
        }
        warnings
    }
}

/// Reads the header, and returns it with the bytes behind it.
///
/// # Errors
/// The fault, with its line.
pub fn read(bytes: &[u8]) -> Result<(Header, &[u8]), String> {
    if !bytes.starts_with(b"ply") || !matches!(bytes.get(3), Some(b'\n' | b'\r' | b' ' | b'\t')) {
        return Err("no PLY file: it does not begin with \"ply\"".to_owned());
    }
    // The end of the first line is that of all, as a binary body may begin with any byte.
    let first_end = bytes.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(bytes.len());
    let end: &[u8] = match bytes[first_end..] {
        [b'\r', b'\n', ..] => b"\r\n",
        [b'\r', ..] => b"\r",
        _ => b"\n",
    };
    let last = end[end.len() - 1];
    let mut header = Header { encoding: Encoding::Ascii, elements: Vec::new(), textures: 0 };
    let mut encoding = None;
    let mut rest = bytes;
    let mut number = 0u64;
    loop {
        number += 1;
        let Some(length) = rest.iter().position(|byte| *byte == last) else {
            return Err("the header has no end".to_owned());
        };
        let line = String::from_utf8_lossy(&rest[..length]);
        rest = &rest[length + 1..];
        let words: Vec<&str> = line.split_whitespace().collect();
        let bad = |fault: &str| Err(format!("line {number}: {fault}: \"{}\"", shortened(line.trim())));
        match words[..] {
            [] | ["ply" | "obj_info", ..] => {}
            ["comment", ..] => {
                header.textures += u64::from(words.get(1).is_some_and(|word| word.eq_ignore_ascii_case("TextureFile")));
            }
            ["format", name, _version] => {
                encoding = match name {
                    "ascii" => Some(Encoding::Ascii),
                    "binary_little_endian" => Some(Encoding::LittleEndian),
                    "binary_big_endian" => Some(Encoding::BigEndian),
                    _ => return bad("an unknown format"),
                };
            }
            ["element", name, count] => match count.parse() {
                Ok(count) => {
                    header.elements.push(Element { name: name.to_owned(), count, properties: Vec::new() });
                }
                Err(_) => return bad("a number of elements that is none"),
            },
            ["property", ref of @ ..] => {
                let kind = match of {
                    ["list", count, item, name] => Scalar::named(count)
                        .zip(Scalar::named(item))
                        .map(|(count, item)| (*name, Kind::List(count, item))),
                    [scalar, name] => Scalar::named(scalar).map(|scalar| (*name, Kind::Scalar(scalar))),
                    _ => None,
                };
                match (kind, header.elements.last_mut()) {
                    (Some((name, kind)), Some(element)) => {
                        element.properties.push(Property { name: name.to_owned(), kind });
                    }
                    (None, _) => return bad("a property that is not understood"),
                    (_, None) => return bad("a property of no element"),
                }
            }
            ["end_header", ..] => break,
            _ => return bad("a line that is not understood"),
        }
    }
    header.encoding = encoding.ok_or("the header states no format")?;
    Ok((header, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_with_every_line_end() {
        let text = "ply\nformat binary_big_endian 1.0\ncomment TextureFile a.png\nobj_info x\nelement vertex 2\n\
                    property float x\nproperty list uchar int32 more\nelement face 0\nend_header\n";
        for end in ["\n", "\r\n", "\r"] {
            let bytes = [text.replace('\n', end).as_bytes(), b"\n\x01"].concat();
            let (header, body) = read(&bytes).unwrap();
            assert_eq!((header.encoding, header.elements.len(), body), (Encoding::BigEndian, 2, &b"\n\x01"[..]));
            let [vertex, face] = &header.elements[..] else { panic!("two elements") };
            assert_eq!((vertex.name.as_str(), vertex.count, face.count), ("vertex", 2, 0));
            assert_eq!(vertex.properties[1].kind, Kind::List(Scalar::U8, Scalar::I32));
            assert_eq!(header.warnings().len(), 1);
        }
    }

    #[test]
    fn faults_are_named_with_their_line() {
        for (text, part) in [
            ("plx\n", "does not begin"),
            ("ply\nformat ascii 1.0\n", "no end"),
            ("ply\nend_header\n", "no format"),
            ("ply\nformat base64 1.0\nend_header\n", "line 2"),
            ("ply\nformat ascii 1.0\nelement vertex -1\nend_header\n", "line 3"),
            ("ply\nformat ascii 1.0\nproperty float x\nend_header\n", "of no element"),
            ("ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\nend_header\n", "line 4"),
            ("ply\nformat ascii 1.0\nnonsense\nend_header\n", "nonsense"),
        ] {
            let fault = read(text.as_bytes()).err().expect("a fault");
            assert!(fault.contains(part), "{fault}");
        }
    }
}
