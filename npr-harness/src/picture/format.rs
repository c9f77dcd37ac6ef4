//! Formats of picture files.

use super::Image;
use image::codecs::{jpeg::JpegEncoder, png::PngEncoder, webp::WebPEncoder};
use image::{ExtendedColorType, ImageEncoder};
use std::fmt;
use std::path::Path;

/// On a scale to 100; artefacts are not visible at this quality.
const JPEG_QUALITY: u8 = 95;

/// The format of a picture file that can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PictureFormat {
    /// RGBA, without loss.
    Png,
    /// RGB at quality 95; the alpha channel is dropped without changing the colours.
    Jpeg,
    /// RGBA, without loss.
    WebP,
}

impl PictureFormat {
    /// All file extensions and their formats.
    pub const EXTENSIONS: [(&str, Self); 4] =
        [("png", Self::Png), ("jpg", Self::Jpeg), ("jpeg", Self::Jpeg), ("webp", Self::WebP)];

    /// The format for a file's extension, ignoring case.
    ///
    /// ```
    /// use npr_harness::picture::PictureFormat;
    /// assert_eq!(PictureFormat::of_path("a.JPG".as_ref()), Some(PictureFormat::Jpeg));
    /// assert_eq!(PictureFormat::of_path("a.gif".as_ref()), None);
    /// ```
    pub fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?;
        let known = Self::EXTENSIONS.iter().find(|(known, _)| extension.eq_ignore_ascii_case(known));
        known.map(|(_, format)| *format)
    }

    /// The longest side of a picture that the format can hold, px.
    pub fn largest_side(self) -> u32 {
        match self {
            // PNG, third edition, 11.2.1.
            Self::Png => (1 << 31) - 1,
            // ITU-T T.81, B.2.2: 16 bits.
            Self::Jpeg => 65_535,
            // RFC 9649, 3.4: 14 bits for the size less 1.
            Self::WebP => 16_384,
        }
    }

    pub(super) fn encode(self, image: &Image) -> image::ImageResult<Vec<u8>> {
        let Image { width, height, rgba8 } = image;
        let mut bytes = Vec::new();
        match self {
            Self::Png => PngEncoder::new(&mut bytes).write_image(rgba8, *width, *height, ExtendedColorType::Rgba8),
            Self::WebP => {
                WebPEncoder::new_lossless(&mut bytes).write_image(rgba8, *width, *height, ExtendedColorType::Rgba8)
            }
            Self::Jpeg => {
                let rgb: Vec<u8> = rgba8.as_chunks::<4>().0.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect();
                JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY).write_image(
                    &rgb,
                    *width,
                    *height,
                    ExtendedColorType::Rgb8,
                )
            }
        }?;
        Ok(bytes)
    }
}

impl fmt::Display for PictureFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::WebP => "WebP",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::ImageError;
    use image::ImageFormat;

    /// Smooth, opaque, and different in each channel.
    fn picture(width: u32, height: u32) -> Image {
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [(x * 3) as u8, (y * 5) as u8, 90, 255]));
        Image::new(width, height, pixels.flatten().collect()).expect("four bytes a pixel")
    }

    #[test]
    fn every_format_gives_the_picture_back() {
        let picture = picture(50, 40);
        for (format, decoder, most) in [
            (PictureFormat::Png, ImageFormat::Png, 0),
            (PictureFormat::WebP, ImageFormat::WebP, 0),
            (PictureFormat::Jpeg, ImageFormat::Jpeg, 8),
        ] {
            let bytes = picture.encode(format).expect("encoded");
            let decoded = image::load_from_memory_with_format(&bytes, decoder).expect("decoded").into_rgba8();
            assert_eq!(decoded.dimensions(), (50, 40));
            let worst = decoded.as_raw().iter().zip(&picture.rgba8).map(|(a, b)| a.abs_diff(*b)).max();
            assert!(worst.is_some_and(|worst| worst <= most), "{format}: {worst:?}");
        }
        let jpeg = picture.encode(PictureFormat::Jpeg).expect("encoded");
        assert_eq!(image::load_from_memory(&jpeg).expect("decoded").color(), image::ColorType::Rgb8, "no alpha");
    }

    #[test]
    fn the_largest_side_is_the_encoders() {
        let too_long = |format: PictureFormat| picture(format.largest_side() + 1, 1).encode(format);
        for format in [PictureFormat::Jpeg, PictureFormat::WebP] {
            picture(format.largest_side(), 1).encode(format).expect("it fits");
            assert!(matches!(too_long(format), Err(ImageError::Format { .. })), "{format}");
        }
    }
}
