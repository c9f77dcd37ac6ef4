//! Errors of this crate.

use thiserror::Error;

/// An invalid parameter, picture, map, mesh or file.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum HatchError {
    /// The side is not a power of two, or out of range.
    #[error("the side is {side} texels: it must be a power of two from {} to {}", crate::MIN_SIDE, crate::MAX_SIDE)]
    Side {
        /// The rejected value.
        side: u32,
    },
    /// The number of tones is out of range.
    #[error("{tones} tones: there must be 1 to {}", crate::MAX_TONES)]
    TonesCount {
        /// The number given.
        tones: usize,
    },
    /// A tone is not strictly between black and the preceding tone.
    #[error("tone {index} is {value}: it must be above 0 and below {before}")]
    Tone {
        /// Index of the tone.
        index: usize,
        /// The rejected value.
        value: f32,
        /// The preceding tone; 1 for the first.
        before: f32,
    },
    /// A number is outside its range or NaN.
    #[error("{name} is {value}: it must be within {low}..={high}")]
    Range {
        /// The name of the field.
        name: &'static str,
        /// The rejected value.
        value: f32,
        /// The minimum.
        low: f32,
        /// The maximum.
        high: f32,
    },
    /// The end of a range is below its start.
    #[error("{name} is the range from {low} to {high}: the end must not be below the start")]
    Order {
        /// The name of the field.
        name: &'static str,
        /// The start of the range.
        low: f32,
        /// The end of the range.
        high: f32,
    },
    /// The first tone with crosswise strokes does not exist.
    #[error("crosswise strokes are to begin with tone {tone} of {tones}, numbered from 0")]
    CrossFrom {
        /// Index of the tone; 0 is the lightest.
        tone: usize,
        /// How many tones there are.
        tones: usize,
    },
    /// The number of candidates is out of range.
    #[error("{candidates} candidates: there must be 1 to {}", crate::MAX_CANDIDATES)]
    Candidates {
        /// The number given.
        candidates: u32,
    },
    /// The strokes are too faint to reach a tone.
    #[error("tone {tone} ({asked}) is out of reach at {side} texels: {strokes} strokes give {reached}")]
    Unreachable {
        /// Index of the tone.
        tone: usize,
        /// The requested tone.
        asked: f32,
        /// Side of the level in texels.
        side: u32,
        /// The number of strokes that were drawn.
        strokes: usize,
        /// Their mean tone.
        reached: f64,
    },
    /// A picture has no texels, too many texels, or a number of texels that is not width × height.
    #[error(
        "a picture of {width} by {height} has {texels} texels: it must have width times height texels, 1 to {}",
        crate::StrokeImage::MAX_TEXELS
    )]
    Texels {
        /// The number of columns.
        width: u32,
        /// The number of rows.
        height: u32,
        /// The number given.
        texels: usize,
    },
    /// The picture of a stroke contains no ink.
    #[error("the picture of {width} by {height} texels has no ink")]
    NoInk {
        /// The number of columns.
        width: u32,
        /// The number of rows.
        height: u32,
    },
    /// The map to be packed does not have six tones.
    #[error("{tones} tones cannot be packed: two RGB textures hold {}", crate::HATCH_TONES)]
    PackTones {
        /// The number given.
        tones: usize,
    },
    /// The number of images of a map, or the number of texels of an image, does not match its tones and its side.
    #[error("image {image} has {texels} texels, not {expected}")]
    ImageSize {
        /// Index into [`crate::Tam::images`]; the first index that is missing or superfluous.
        image: usize,
        /// The actual number.
        texels: usize,
        /// The required number.
        expected: usize,
    },
    /// A texel is lighter in a darker tone.
    #[error("level {level}, texel {texel}: tone {tone} is lighter than the tone before it")]
    NotNested {
        /// Index of the level; 0 is the finest.
        level: usize,
        /// Index of the texel, row by row.
        texel: usize,
        /// Index of the darker tone.
        tone: usize,
    },
    /// The thresholds belong to a map of another side.
    #[error("the thresholds' side is {found} texels, the map's {expected}")]
    ThresholdSide {
        /// The side of the thresholds in texels.
        found: u32,
        /// The side of the map in texels.
        expected: u32,
    },
    /// The number of levels of thresholds, or the number of texels of a level, does not match the side.
    #[error("level {level} has {texels} thresholds, not {expected}")]
    ThresholdSize {
        /// Index of the level; 0 is the finest. The first level that is missing or superfluous.
        level: usize,
        /// The number of its texels; 0 if it is missing.
        texels: usize,
        /// The required number of texels; 0 if it is superfluous.
        expected: usize,
    },
    /// The thresholds of a level are not those of an order of its texels.
    #[error("level {level}: {found} texels have the threshold {threshold}, not {expected}")]
    ThresholdCount {
        /// Index of the level; 0 is the finest.
        level: usize,
        /// The lowest threshold whose number of texels is wrong.
        threshold: u16,
        /// The number of texels with this threshold.
        found: u32,
        /// The required number.
        expected: u32,
    },
    /// The file does not begin with [`crate::store::MAGIC`].
    #[error("no tonal art map: the file begins with {found:02x?}")]
    Magic {
        /// The first bytes of the file, at most eight.
        found: Vec<u8>,
    },
    /// The version of the file format is unknown.
    #[error("format version {found} is unknown: versions 1 to {} are supported", crate::store::VERSION)]
    Version {
        /// The version in the file.
        found: u32,
    },
    /// The file has unknown flags.
    #[error("the flags {found:#x} are unknown: only 0x1 is supported")]
    Flags {
        /// The flags in the file.
        found: u32,
    },
    /// The length of the file does not match its header.
    #[error("the file has {found} bytes, not {expected}")]
    Length {
        /// The actual number.
        found: usize,
        /// The required number.
        expected: usize,
    },
    /// The checksum does not match: the file is damaged.
    #[error("the checksum is {found:016x}, not {expected:016x}: the file is damaged")]
    Checksum {
        /// The checksum of the bytes.
        found: u64,
        /// The checksum in the file.
        expected: u64,
    },
    /// The map is larger than the textures that the device supports.
    #[cfg(feature = "wgpu")]
    #[error("the map has {side} by {side} texels: the textures of this device have at most {limit} by {limit}")]
    TooLarge {
        /// Side of the finest level in texels.
        side: u32,
        /// The maximum side in texels.
        limit: u32,
    },
    /// The length of a per-vertex array is not the number of vertices.
    #[error("{name} has {found} entries for {vertices} vertices")]
    PerVertex {
        /// The name of the array.
        name: &'static str,
        /// The actual number.
        found: usize,
        /// The number of vertices.
        vertices: usize,
    },
    /// A vertex index is out of range.
    #[error("{name}, entry {index}: vertex {vertex} does not exist, there are {vertices} vertices")]
    NoVertex {
        /// The name of the array.
        name: &'static str,
        /// Index into the array.
        index: usize,
        /// The vertex index.
        vertex: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// The length of a direction is zero or not finite.
    #[error("the direction {value:?} must have a finite length above 0")]
    Direction {
        /// The rejected value.
        value: [f32; 3],
    },
    /// A picture could not be read or written.
    #[cfg(feature = "image")]
    #[error("{path}: {source}")]
    Image {
        /// The path.
        path: std::path::PathBuf,
        /// The cause.
        source: image::ImageError,
    },
    /// A folder could not be created.
    #[cfg(feature = "image")]
    #[error("{path}: {source}")]
    Folder {
        /// The path.
        path: std::path::PathBuf,
        /// The cause.
        source: std::io::Error,
    },
}
