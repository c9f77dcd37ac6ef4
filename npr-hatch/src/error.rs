//! What is refused.

use thiserror::Error;

/// Why parameters, a picture or a file cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum HatchError {
    /// The side is no power of two, or too small or too large.
    #[error("the side is {side} texels: it must be a power of two from {} to {}", crate::MIN_SIDE, crate::MAX_SIDE)]
    Side {
        /// What it is.
        side: u32,
    },
    /// No tone, or too many.
    #[error("{tones} tones: there must be 1 to {}", crate::MAX_TONES)]
    TonesCount {
        /// How many there are.
        tones: usize,
    },
    /// A tone is not strictly between black and the tone before it.
    #[error("tone {index} is {value}: it must be above 0 and below {before}")]
    Tone {
        /// Into the tones.
        index: usize,
        /// What it is.
        value: f32,
        /// The tone before it; for the first one white, 1.
        before: f32,
    },
    /// A number is outside of its range, or not a number.
    #[error("{name} is {value}: it must be within {low}..={high}")]
    Range {
        /// The field's name.
        name: &'static str,
        /// What it is.
        value: f32,
        /// The least that it may be.
        low: f32,
        /// The most.
        high: f32,
    },
    /// The second end of a range is below the first.
    #[error("{name} goes from {low} to {high}, which is less")]
    Order {
        /// The field's name.
        name: &'static str,
        /// Where the range begins.
        low: f32,
        /// Where it ends.
        high: f32,
    },
    /// Crosswise strokes are to begin with a tone that is not there.
    #[error("crosswise strokes are to begin with tone {tone} of {tones}")]
    CrossFrom {
        /// Counted from 0, the lightest.
        tone: usize,
        /// How many tones there are.
        tones: usize,
    },
    /// No candidate to choose from, or too many.
    #[error("{candidates} candidates: there must be 1 to {}", crate::MAX_CANDIDATES)]
    Candidates {
        /// How many there are.
        candidates: u32,
    },
    /// The strokes are too faint for a tone.
    #[error("tone {tone} ({asked}) is out of reach at {side} texels: {strokes} strokes give {reached}")]
    Unreachable {
        /// Into the tones.
        tone: usize,
        /// The tone that was asked for.
        asked: f32,
        /// The level's side.
        side: u32,
        /// How many strokes were drawn.
        strokes: usize,
        /// The mean tone that they gave.
        reached: f64,
    },
    /// The picture of a stroke has no texels, more than fit, or another number of them than its size says.
    #[error(
        "a picture of {width} by {height} with {texels} texels: it must have as many as that, 1 to {}",
        crate::StrokeImage::MAX_TEXELS
    )]
    Texels {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// How many there are.
        texels: usize,
    },
    /// The picture of a stroke is all paper.
    #[error("the picture of {width} by {height} texels has no ink")]
    NoInk {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// Not six tones.
    #[error("{tones} tones cannot be packed: two RGB textures hold {}", crate::HATCH_TONES)]
    PackTones {
        /// How many there are.
        tones: usize,
    },
    /// The number of images, or of one's texels, is not what tones and side say.
    #[error("image {image} has {texels} texels, not {expected}")]
    ImageSize {
        /// Into [`crate::Tam::images`]; their number if one is missing or too many.
        image: usize,
        /// How many it has.
        texels: usize,
        /// How many it must have.
        expected: usize,
    },
    /// A texel is lighter in a darker tone.
    #[error("level {level}, texel {texel}: tone {tone} is lighter than the tone before it")]
    NotNested {
        /// Counted from 0, the finest.
        level: usize,
        /// Row by row.
        texel: usize,
        /// The darker one.
        tone: usize,
    },
    /// Thresholds of another map.
    #[error("the thresholds' side is {found} texels, the map's {expected}")]
    ThresholdSide {
        /// The thresholds'.
        found: u32,
        /// The map's.
        expected: u32,
    },
    /// The number of the thresholds' levels, or of one's texels, is not what the side says.
    #[error("level {level} has {texels} thresholds, not {expected}")]
    ThresholdSize {
        /// Counted from 0, the finest; the first one that is missing or too many.
        level: usize,
        /// How many it has; 0 if it is missing.
        texels: usize,
        /// How many it must have; 0 if it is one too many.
        expected: usize,
    },
    /// Another number of a level's texels have a threshold than in an order of all of them.
    #[error("level {level}: {found} texels have the threshold {threshold}, not {expected}")]
    ThresholdCount {
        /// Counted from 0, the finest.
        level: usize,
        /// The least one of which that is so.
        threshold: u16,
        /// How many have it.
        found: u32,
        /// How many must have it.
        expected: u32,
    },
    /// The file does not begin as one of this crate's.
    #[error("no tonal art map: the file begins with {found:02x?}")]
    Magic {
        /// Up to eight bytes.
        found: Vec<u8>,
    },
    /// A version that this crate does not know.
    #[error("version {found}, where 1 to {} are known", crate::store::VERSION)]
    Version {
        /// What the file says.
        found: u32,
    },
    /// A flag that this crate does not know.
    #[error("the flags are {found:#x}, where only 0x1 is known")]
    Flags {
        /// All of them.
        found: u32,
    },
    /// The file is shorter or longer than its header says.
    #[error("the file has {found} bytes, not {expected}")]
    Length {
        /// How many it has.
        found: usize,
        /// How many it must have.
        expected: usize,
    },
    /// The texels are not those that were stored.
    #[error("the checksum is {found:016x}, not {expected:016x}: the file is damaged")]
    Checksum {
        /// That of what was read.
        found: u64,
        /// What the file says.
        expected: u64,
    },
    /// A map larger than the device's textures can be.
    #[cfg(feature = "wgpu")]
    #[error("a map of {side}² texels: this device's textures are at most {limit}²")]
    TooLarge {
        /// Of the finest level.
        side: u32,
        /// Texels along a side.
        limit: u32,
    },
    /// An array that has one entry for each vertex has another number of them.
    #[error("{name} has {found} entries for {vertices} vertices")]
    PerVertex {
        /// Which.
        name: &'static str,
        /// How many it has.
        found: usize,
        /// How many positions there are.
        vertices: usize,
    },
    /// An index names a vertex that is not there.
    #[error("{name}, entry {index}: vertex {vertex} of {vertices}")]
    NoVertex {
        /// In which array.
        name: &'static str,
        /// Into it.
        index: usize,
        /// What it names.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
    /// A direction has no length, or one that is not finite.
    #[error("{value:?} is no direction")]
    Direction {
        /// What it is.
        value: [f32; 3],
    },
    /// A picture cannot be read or written.
    #[cfg(feature = "image")]
    #[error("{path}: {source}")]
    Image {
        /// Which.
        path: std::path::PathBuf,
        /// Why.
        source: image::ImageError,
    },
    /// A folder cannot be made.
    #[cfg(feature = "image")]
    #[error("{path}: {source}")]
    Folder {
        /// Which.
        path: std::path::PathBuf,
        /// Why.
        source: std::io::Error,
    },
}
