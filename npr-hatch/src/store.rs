//! The file format of a map with its thresholds.
//!
//! All numbers are little-endian. Texels are stored in the layout of texture uploads.
//!
//! | bytes | content |
//! | --- | --- |
//! | 8 | [`MAGIC`] |
//! | 4 | [`VERSION`] |
//! | 4 | side of the finest level, a power of two |
//! | 4 | number of tones n |
//! | 4 | flags: bit 0 is set if there are thresholds, all others are 0. Version 1 has no flags and no thresholds |
//! | 4 n | the tones as f32, the lightest first |
//! | | the images in the order of [`Tam::images`], one byte per texel |
//! | | the thresholds in the order of [`Thresholds::levels`], u16 |
//! | 8 | FNV-1a checksum (64 bits) of all preceding bytes |
//!
//! [`from_bytes`] checks the length against the header, the checksum, that texels are nested ([`Tam::validate`]) and that
//! thresholds are an order of the texels ([`Thresholds::validate`]). Before the length has been checked it allocates nothing
//! but the tones.

use crate::parameters::validate_shape;
use crate::{HatchError, MAX_TONES, Tam, Thresholds};

/// The first bytes of a file.
pub const MAGIC: [u8; 8] = *b"NPR\0TAM\n";
/// The version that is written. Version 1 can be read as well.
pub const VERSION: u32 = 2;

/// The length in bytes of the header, before the tones.
const HEADER: usize = 24;
/// The length of the header of version 1.
const HEADER_1: usize = 20;
const HAS_THRESHOLDS: u32 = 1;

/// The content of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Stored {
    /// The map.
    pub tam: Tam,
    /// The thresholds, if they were stored. They cannot be computed from the map without its strokes.
    pub thresholds: Option<Thresholds>,
}

/// Serialises a map, optionally with thresholds.
///
/// # Errors
/// Those of [`Tam::validate`] and [`Thresholds::validate`], and [`HatchError::ThresholdSide`] if map and thresholds have
/// different sides.
pub fn to_bytes(tam: &Tam, thresholds: Option<&Thresholds>) -> Result<Vec<u8>, HatchError> {
    tam.validate()?;
    if let Some(thresholds) = thresholds {
        if thresholds.side != tam.side {
            return Err(HatchError::ThresholdSide { found: thresholds.side, expected: tam.side });
        }
        thresholds.validate()?;
    }
    let flags = if thresholds.is_some() { HAS_THRESHOLDS } else { 0 };
    let mut bytes = Vec::with_capacity(length(HEADER, tam.tones.len(), tam.side, flags));
    bytes.extend(MAGIC);
    for number in [VERSION, tam.side, tam.tones.len() as u32, flags] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(tam.tones.iter().flat_map(|tone| tone.to_le_bytes()));
    for image in &tam.images {
        bytes.extend(image);
    }
    for level in thresholds.iter().flat_map(|thresholds| &thresholds.levels) {
        bytes.extend(level.iter().flat_map(|threshold| threshold.to_le_bytes()));
    }
    bytes.extend(checksum(&bytes).to_le_bytes());
    Ok(bytes)
}

/// Deserialises a file of version 1 or 2.
///
/// # Errors
/// Any violation of the file format, see the module.
pub fn from_bytes(bytes: &[u8]) -> Result<Stored, HatchError> {
    if !bytes.starts_with(&MAGIC) {
        return Err(HatchError::Magic { found: bytes[..bytes.len().min(8)].to_vec() });
    }
    let at_least = |expected| {
        let found = bytes.len();
        if found < expected { Err(HatchError::Length { found, expected }) } else { Ok(()) }
    };
    let word = |at: usize| [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
    at_least(HEADER_1)?;
    let [version, side, count] = [8, 12, 16].map(|at| u32::from_le_bytes(word(at)));
    let header = match version {
        1 => HEADER_1,
        VERSION => HEADER,
        found => return Err(HatchError::Version { found }),
    };
    at_least(header)?;
    let flags = if version == 1 { 0 } else { u32::from_le_bytes(word(HEADER_1)) };
    if flags & !HAS_THRESHOLDS != 0 {
        return Err(HatchError::Flags { found: flags });
    }
    let count = count as usize;
    if count > MAX_TONES {
        return Err(HatchError::TonesCount { tones: count });
    }
    let body = header + 4 * count;
    at_least(body)?;
    let tones: Vec<f32> = (0..count).map(|i| f32::from_le_bytes(word(header + 4 * i))).collect();
    validate_shape(&tones, side)?;
    let expected = length(header, count, side, flags);
    if bytes.len() != expected {
        return Err(HatchError::Length { found: bytes.len(), expected });
    }
    let (content, sum) = bytes.split_at(expected - 8);
    let mut stored = [0; 8];
    stored.copy_from_slice(sum);
    let (found, expected) = (checksum(content), u64::from_le_bytes(stored));
    if found != expected {
        return Err(HatchError::Checksum { found, expected });
    }
    let mut rest = &content[body..];
    let mut take = |length| {
        let (taken, after) = rest.split_at(length);
        rest = after;
        taken
    };
    let mut tam = Tam { tones, side, images: Vec::new() };
    let texels: Vec<usize> = (0..tam.levels()).map(|level| (tam.level_side(level) as usize).pow(2)).collect();
    for _ in 0..count {
        tam.images.extend(texels.iter().map(|&texels| take(texels).to_vec()));
    }
    tam.validate()?;
    let mut thresholds = None;
    if flags & HAS_THRESHOLDS != 0 {
        let mut level = |&texels: &usize| {
            let pairs = take(2 * texels).chunks_exact(2);
            pairs.map(|pair| u16::from_le_bytes([pair[0], pair[1]])).collect()
        };
        let read = Thresholds { side, levels: texels.iter().map(&mut level).collect() };
        read.validate()?;
        thresholds = Some(read);
    }
    Ok(Stored { tam, thresholds })
}

/// The length of a file in bytes for a valid shape: the levels have 1 + 4 + … + side² texels.
fn length(header: usize, tones: usize, side: u32, flags: u32) -> usize {
    let side = side as usize;
    let texels = (4 * side * side - 1) / 3;
    let thresholds = if flags & HAS_THRESHOLDS != 0 { 2 * texels } else { 0 };
    header + 4 * tones + tones * texels + thresholds + 8
}

fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |sum, &byte| (sum ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}
