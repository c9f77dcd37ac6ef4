//! Pictures in memory and in files.

mod format;

pub use format::PictureFormat;

use image::{ImageFormat, ImageReader};
use npr_hatch::files::{read_file, write_file};
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// The largest file that is read, bytes.
const MOST_BYTES: u64 = 1 << 30;
/// The largest picture that is read, px.
const MOST_PIXELS: u64 = 1 << 26;

/// A picture in memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// `width * height * 4` bytes in rows from the top: red, green, blue and alpha, not premultiplied.
    pub rgba8: Vec<u8>,
}

/// Why an image could not be made, read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// The number of bytes is not four per pixel.
    #[error("{bytes} bytes are no {width}×{height} image of four bytes a pixel")]
    Length {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
        /// The number of bytes.
        bytes: usize,
    },
    /// The file could not be read.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file is no PNG.
    #[error("{}: {source}", path.display())]
    Decode {
        /// The file.
        path: PathBuf,
        /// What the decoder said.
        source: image::ImageError,
    },
    /// The file has more pixels than the limit.
    #[error("{}: {width} × {height} px: at most {limit} pixels are read", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
        /// Pixels.
        limit: u64,
    },
    /// The picture could not be encoded.
    #[error("a {format} picture could not be made: {source}")]
    Format {
        /// The format.
        format: PictureFormat,
        /// What the encoder said.
        source: image::ImageError,
    },
    /// The picture could not be encoded as PNG.
    #[error("{}: {source}", path.display())]
    Encode {
        /// The file that was to be written.
        path: PathBuf,
        /// What the encoder said.
        source: image::ImageError,
    },
    /// The file or its folder could not be written.
    #[error("{}: {source}", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

/// Why two images cannot be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// They have different sizes.
    #[error(
        "the expected image has {}×{} pixels, the actual one {}×{}",
        expected.0, expected.1, actual.0, actual.1
    )]
    Size {
        /// Width and height, pixels.
        expected: (u32, u32),
        /// Width and height, pixels.
        actual: (u32, u32),
    },
    /// The mask of exempt pixels is for another image.
    #[error("the mask has {mask} entries, the image {pixels} pixels")]
    Mask {
        /// Its length.
        mask: usize,
        /// What its length should be.
        pixels: usize,
    },
    /// An image's bytes do not fit its size.
    #[error("{bytes} bytes are no {width}×{height} image of four bytes a pixel")]
    Bytes {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
        /// The number of bytes.
        bytes: usize,
    },
}

impl Image {
    /// # Errors
    /// [`ImageError::Length`] where `rgba8` has not four bytes a pixel.
    pub fn new(width: u32, height: u32, rgba8: Vec<u8>) -> Result<Self, ImageError> {
        if byte_count(width, height) == Some(rgba8.len()) {
            Ok(Self { width, height, rgba8 })
        } else {
            Err(ImageError::Length { width, height, bytes: rgba8.len() })
        }
    }

    /// Creates an image of one colour.
    ///
    /// # Panics
    /// If the image does not fit the address space.
    pub fn filled(width: u32, height: u32, color: [u8; 4]) -> Self {
        let bytes = byte_count(width, height).expect("the image fits the address space");
        Self { width, height, rgba8: color.repeat(bytes / 4) }
    }

    /// The colour at a column and row, from the upper left.
    ///
    /// # Panics
    /// Outside the image.
    pub fn pixel(&self, x: u32, y: u32) -> [u8; 4] {
        let at = self.offset(x, y);
        std::array::from_fn(|channel| self.rgba8[at + channel])
    }

    /// Sets the colour at a column and row, from the upper left.
    ///
    /// # Panics
    /// Outside the image.
    pub fn set_pixel(&mut self, x: u32, y: u32, color: [u8; 4]) {
        let at = self.offset(x, y);
        self.rgba8[at..at + 4].copy_from_slice(&color);
    }

    fn offset(&self, x: u32, y: u32) -> usize {
        assert!(x < self.width && y < self.height, "({x}, {y}) is outside {}×{}", self.width, self.height);
        (y as usize * self.width as usize + x as usize) * 4
    }

    /// Reads a PNG of any colour type, of at most 2²⁶ pixels, which are counted before they are decoded.
    ///
    /// # Errors
    /// [`ImageError::Read`], [`ImageError::Decode`] and [`ImageError::TooLarge`], which name the file.
    pub fn load_png(path: &Path) -> Result<Self, ImageError> {
        let bytes = read_file(path, MOST_BYTES).map_err(|source| ImageError::Read { path: path.to_owned(), source })?;
        let failed = |source| ImageError::Decode { path: path.to_owned(), source };
        let reader = || ImageReader::with_format(Cursor::new(&bytes), ImageFormat::Png);
        let (width, height) = reader().into_dimensions().map_err(failed)?;
        if u64::from(width) * u64::from(height) > MOST_PIXELS {
            return Err(ImageError::TooLarge { path: path.to_owned(), width, height, limit: MOST_PIXELS });
        }
        let decoded = reader().decode().map_err(failed)?.into_rgba8();
        Self::new(decoded.width(), decoded.height(), decoded.into_raw())
    }

    /// Writes a PNG, whole or not at all ([`write_file`]).
    ///
    /// # Errors
    /// [`ImageError::Encode`] and [`ImageError::Write`], which name the file.
    pub fn save_png(&self, path: &Path) -> Result<(), ImageError> {
        let bytes = self.encode(PictureFormat::Png).map_err(|error| match error {
            ImageError::Format { source, .. } => ImageError::Encode { path: path.to_owned(), source },
            other => other,
        })?;
        write_whole(path, &bytes)
    }

    /// Encodes the picture in a format.
    ///
    /// # Errors
    /// [`ImageError::Length`], [`ImageError::Format`].
    pub fn encode(&self, format: PictureFormat) -> Result<Vec<u8>, ImageError> {
        if byte_count(self.width, self.height) != Some(self.rgba8.len()) {
            return Err(ImageError::Length { width: self.width, height: self.height, bytes: self.rgba8.len() });
        }
        format.encode(self).map_err(|source| ImageError::Format { format, source })
    }
}

/// `None` if the size exceeds the address space.
pub(crate) fn byte_count(width: u32, height: u32) -> Option<usize> {
    (width as usize).checked_mul(height as usize)?.checked_mul(4)
}

fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), ImageError> {
    write_file(path, bytes).map_err(|source| ImageError::Write { path: path.to_owned(), source })
}
