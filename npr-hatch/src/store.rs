//! A map in one file.
//!
//! All numbers are little-endian. The texels lie as an upload wants them, so a file can be read where it lies.
//!
//! | bytes | what |
//! | --- | --- |
//! | 8 | [`MAGIC`] |
//! | 4 | [`VERSION`] |
//! | 4 | side of the finest level, a power of two |
//! | 4 | number of tones n |
//! | 4 n | their values, f32, the lightest first |
//! | | the images as in [`Tam::images`], a byte a texel |
//! | 8 | FNV-1a (64 bits) of all bytes before |
//!
//! What [`from_bytes`] accepts has just the length that its header says, the checksum, and texels that are nested in
//! tones ([`Tam::validate`]). It allocates nothing before the length is known to be right.

use crate::parameters::validate_shape;
use crate::{HatchError, MAX_TONES, Tam};

/// How a file begins.
pub const MAGIC: [u8; 8] = *b"NPR\0TAM\n";
/// The only version there is.
pub const VERSION: u32 = 1;

const HEADER: usize = 20;

/// A map as a file's bytes.
pub fn to_bytes(tam: &Tam) -> Result<Vec<u8>, HatchError> {
    tam.validate()?;
    let mut bytes = Vec::with_capacity(length(tam.tones.len(), tam.side));
    bytes.extend(MAGIC);
    for number in [VERSION, tam.side, tam.tones.len() as u32] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(tam.tones.iter().flat_map(|tone| tone.to_le_bytes()));
    for image in &tam.images {
        bytes.extend(image);
    }
    bytes.extend(checksum(&bytes).to_le_bytes());
    Ok(bytes)
}

/// The map in a file's bytes.
pub fn from_bytes(bytes: &[u8]) -> Result<Tam, HatchError> {
    if !bytes.starts_with(&MAGIC) {
        return Err(HatchError::Magic { found: bytes[..bytes.len().min(8)].to_vec() });
    }
    if bytes.len() < HEADER {
        return Err(HatchError::Length { found: bytes.len(), expected: HEADER });
    }
    let word = |at: usize| [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
    let [version, side, count] = [8, 12, 16].map(|at| u32::from_le_bytes(word(at)));
    if version != VERSION {
        return Err(HatchError::Version { found: version });
    }
    let count = count as usize;
    if count > MAX_TONES {
        return Err(HatchError::TonesCount { tones: count });
    }
    let body = HEADER + 4 * count;
    if bytes.len() < body {
        return Err(HatchError::Length { found: bytes.len(), expected: body });
    }
    let tones: Vec<f32> = (0..count).map(|i| f32::from_le_bytes(word(HEADER + 4 * i))).collect();
    validate_shape(&tones, side)?;
    let expected = length(count, side);
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
    let mut tam = Tam { tones, side, images: Vec::new() };
    for _ in 0..count {
        for level in 0..tam.levels() {
            let side = tam.level_side(level) as usize;
            let (image, after) = rest.split_at(side * side);
            tam.images.push(image.to_vec());
            rest = after;
        }
    }
    tam.validate()?;
    Ok(tam)
}

/// Of a file, for a shape that is valid: the levels have 1 + 4 + … + side² texels.
fn length(tones: usize, side: u32) -> usize {
    let side = side as usize;
    HEADER + 4 * tones + tones * ((4 * side * side - 1) / 3) + 8
}

fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |sum, &byte| (sum ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}
