//! A map in one file, with its thresholds.
//!
//! All numbers are little-endian. The texels lie as an upload wants them, so a file can be read where it lies.
//!
//! | bytes | what |
//! | --- | --- |
//! | 8 | [`MAGIC`] |
//! | 4 | [`VERSION`] |
//! | 4 | side of the finest level, a power of two |
//! | 4 | number of tones n |
//! | 4 | flags: bit 0 (1), thresholds are there; the others are 0. Version 1 has no flags and no thresholds |
//! | 4 n | the tones' values, f32, the lightest first |
//! | | the images as in [`Tam::images`], a byte a texel |
//! | | the thresholds as in [`Thresholds::levels`], u16 |
//! | 8 | FNV-1a (64 bits) of all bytes before |
//!
//! What [`from_bytes`] accepts has just the length that its header says, the checksum, texels that are nested in
//! tones ([`Tam::validate`]), and thresholds that are an order of the texels ([`Thresholds::validate`]). Before the length is
//! known to be right it allocates nothing but the tones' values.

use crate::parameters::validate_shape;
use crate::{HatchError, MAX_TONES, Tam, Thresholds};

/// How a file begins.
pub const MAGIC: [u8; 8] = *b"NPR\0TAM\n";
/// The version that is written. Version 1 can be read, too.
pub const VERSION: u32 = 2;

/// Bytes before the tones' values.
const HEADER: usize = 24;
/// Those of version 1.
const HEADER_1: usize = 20;
const HAS_THRESHOLDS: u32 = 1;

/// What is in a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Stored {
    /// The map.
    pub tam: Tam,
    /// Its thresholds, if they were stored with it; they cannot be made from the map without its strokes.
    pub thresholds: Option<Thresholds>,
}

/// A map, and its thresholds if they are to be drawn with, as a file's bytes.
///
/// # Errors
/// What [`Tam::validate`] and [`Thresholds::validate`] refuse, and thresholds of another side than the map's
/// ([`HatchError::ThresholdSide`]).
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

/// What is in a file's bytes.
///
/// # Errors
/// Any other bytes than [`to_bytes`] gives, or gave in version 1: see the module.
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

/// Of a file, for a shape that is valid: the levels have 1 + 4 + … + side² texels.
fn length(header: usize, tones: usize, side: u32, flags: u32) -> usize {
    let side = side as usize;
    let texels = (4 * side * side - 1) / 3;
    let thresholds = if flags & HAS_THRESHOLDS != 0 { 2 * texels } else { 0 };
    header + 4 * tones + tones * texels + thresholds + 8
}

fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |sum, &byte| (sum ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}
