//! Reading pictures of strokes from PNG files and writing maps to PNG files.

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::{DynamicImage, GrayImage, ImageError, ImageFormat, ImageReader, Luma};

use crate::files::{read_file, write_file};
use crate::sheet::Sheet;
use crate::{HatchError, StrokeImage, Tam};

/// The maximum length of a picture file in bytes.
const MAX_BYTES: u64 = 1 << 30;

type Gray16 = image::ImageBuffer<Luma<u16>, Vec<u16>>;

impl StrokeImage {
    /// A stroke from a picture of any size and bit depth. Ink is (1 - luminance) times alpha.
    pub fn from_picture(picture: &DynamicImage) -> Result<Self, HatchError> {
        let (width, height) = (picture.width(), picture.height());
        let texels = width as usize * height as usize;
        if texels > Self::MAX_TEXELS {
            return Err(HatchError::Texels { width, height, texels });
        }
        // Integer arithmetic on 16 bits per channel gives the same result on every platform.
        let picture = picture.to_rgba16();
        let ink = picture.pixels().map(|pixel| {
            let [r, g, b, a] = pixel.0.map(u64::from);
            // The luminance of Rec. 709, with weights in 1/10,000.
            let luminance = (2126 * r + 7152 * g + 722 * b) / 10_000;
            ((65535 - luminance) * a / 65535) as u16
        });
        Self::from_ink(width, height, &ink.collect::<Vec<_>>())
    }

    /// A stroke from a PNG file of at most 1 GiB. The number of texels is checked before decoding.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, HatchError> {
        let path = path.as_ref();
        let failed = |source: ImageError| HatchError::Image { path: path.into(), source };
        let bytes = read_file(path, MAX_BYTES).map_err(|error| failed(error.into()))?;
        let reader = || ImageReader::new(Cursor::new(&bytes)).with_guessed_format().map_err(|e| failed(e.into()));
        let (width, height) = reader()?.into_dimensions().map_err(failed)?;
        let texels = u64::from(width) * u64::from(height);
        if texels > Self::MAX_TEXELS as u64 {
            return Err(HatchError::Texels { width, height, texels: usize::try_from(texels).unwrap_or(usize::MAX) });
        }
        Self::from_picture(&reader()?.decode().map_err(failed)?)
    }
}

/// Writes each image of a map into a folder, which is created if necessary, as `tone_N_SIDE.png`, where N is the index of
/// the tone. Returns the paths in the order of [`Tam::images`].
pub fn write_images(tam: &Tam, folder: impl AsRef<Path>) -> Result<Vec<PathBuf>, HatchError> {
    tam.validate()?;
    let folder = folder.as_ref();
    fs::create_dir_all(folder).map_err(|source| HatchError::Folder { path: folder.into(), source })?;
    let mut paths = Vec::new();
    for tone in 0..tam.tones.len() {
        for level in 0..tam.levels() {
            let side = tam.level_side(level);
            let path = folder.join(format!("tone_{tone}_{side}.png"));
            write_gray(&path, side, side, tam.image(tone, level))?;
            paths.push(path);
        }
    }
    Ok(paths)
}

/// Writes 8-bit gray texels as a PNG file, atomically ([`write_file`]).
pub fn write_gray(path: impl AsRef<Path>, width: u32, height: u32, texels: &[u8]) -> Result<(), HatchError> {
    let path = path.as_ref();
    let image = GrayImage::from_raw(width, height, texels.to_vec());
    let image = image.ok_or(HatchError::Texels { width, height, texels: texels.len() })?;
    save(path, |to| image.write_to(to, ImageFormat::Png))
}

/// Writes a sheet as a PNG file.
pub fn write_sheet(path: impl AsRef<Path>, sheet: &Sheet) -> Result<(), HatchError> {
    write_gray(path, sheet.width, sheet.height, &sheet.texels)
}

/// Writes 16-bit gray texels, such as [`crate::Thresholds`], as a PNG file.
pub fn write_gray16(path: impl AsRef<Path>, width: u32, height: u32, texels: &[u16]) -> Result<(), HatchError> {
    let path = path.as_ref();
    let image = Gray16::from_raw(width, height, texels.to_vec());
    let image = image.ok_or(HatchError::Texels { width, height, texels: texels.len() })?;
    save(path, |to| image.write_to(to, ImageFormat::Png))
}

/// Encodes a picture in memory and writes it to a file.
fn save(path: &Path, encode: impl Fn(&mut Cursor<Vec<u8>>) -> Result<(), ImageError>) -> Result<(), HatchError> {
    let failed = |source| HatchError::Image { path: path.into(), source };
    let mut bytes = Cursor::new(Vec::new());
    encode(&mut bytes).map_err(failed)?;
    write_file(path, bytes.get_ref()).map_err(|error| failed(error.into()))
}
