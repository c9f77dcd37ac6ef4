//! Decodes images to RGBA8.

use crate::{Limits, LoadError};
use image::error::ImageFormatHint;
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader};
use std::io::Cursor;
use std::path::Path;

/// A decoded image.
#[derive(Debug)]
pub(super) struct Decoded {
    pub width: u32,
    pub height: u32,
    /// `width * height * 4` bytes, rows from the top.
    pub rgba8: Vec<u8>,
    /// Whether the file has alpha values.
    #[cfg_attr(not(feature = "obj"), allow(dead_code))]
    pub has_alpha: bool,
}

/// The formats of glTF 2.0, 3.8.3 "Images", and of `EXT_texture_webp`.
#[cfg(feature = "gltf")]
pub(super) const OF_GLTF: [ImageFormat; 3] = [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::WebP];

/// The formats that exporters of OBJ files name in material files.
#[cfg(feature = "obj")]
pub(super) const OF_OBJ: [ImageFormat; 7] = [
    ImageFormat::Png,
    ImageFormat::Jpeg,
    ImageFormat::Bmp,
    ImageFormat::Tga,
    ImageFormat::Gif,
    ImageFormat::WebP,
    ImageFormat::Tiff,
];

/// Checks the number of texels of an image and, added to `so_far`, of all images.
///
/// # Errors
/// [`LoadError::ImageTooLarge`] with `path` and the name of the image.
pub(super) fn check_texels(
    texels: u64,
    name: &str,
    so_far: &mut u64,
    path: &Path,
    limits: &Limits,
) -> Result<(), LoadError> {
    *so_far = so_far.saturating_add(texels);
    for (what, count, limit) in
        [("texels in an image", texels, limits.texels), ("texels in all images", *so_far, limits.texels_in_all)]
    {
        if count > limit {
            return Err(LoadError::ImageTooLarge { path: path.to_owned(), image: name.to_owned(), what, count, limit });
        }
    }
    Ok(())
}

/// Decodes a file in memory, of an animation the first picture.
///
/// The format, one of `formats`, is determined by the first bytes, not by the file extension. TGA files have no mark, so
/// that any other bytes are read as TGA if the name says so. The size in the header is checked against
/// [`Limits::texels`] and, added to `so_far`, against [`Limits::texels_in_all`] before memory is allocated. 16-bit
/// samples are rounded to 8 bits. Colour profiles and Exif orientation are ignored, as glTF 2.0 requires (3.8.2).
///
/// # Errors
/// [`LoadError::ImageTooLarge`] and [`LoadError::Malformed`] with `path` and the name of the image.
pub(super) fn decode(
    formats: &[ImageFormat],
    bytes: &[u8],
    name: &str,
    path: &Path,
    limits: &Limits,
    so_far: &mut u64,
) -> Result<Decoded, LoadError> {
    let malformed = |why: String| LoadError::Malformed { path: path.to_owned(), fault: format!("image {name}: {why}") };
    let mut reader =
        ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|e| malformed(e.to_string()))?;
    let ending = Path::new(name).extension().and_then(|ending| ending.to_str());
    if reader.format().is_none() && ending.is_some_and(|ending| ending.eq_ignore_ascii_case("tga")) {
        reader.set_format(ImageFormat::Tga);
    }
    // Another crate in the build may enable more formats of `image`.
    if let Some(other) = reader.format().filter(|format| !formats.contains(format)) {
        return Err(malformed(ImageError::Unsupported(ImageFormatHint::Exact(other).into()).to_string()));
    }
    // The formats store at most eight bytes per texel; the rest is for the tables of the decoders.
    let mut decoder_limits = image::Limits::default();
    decoder_limits.max_alloc = Some(limits.texels.saturating_mul(16).saturating_add(64 << 20));
    reader.limits(decoder_limits);
    let decoder = reader.into_decoder().map_err(|e| malformed(e.to_string()))?;
    let (width, height) = decoder.dimensions();
    let texels = u64::from(width) * u64::from(height);
    // Broken images count as well, since decoding them takes time.
    check_texels(texels, name, so_far, path, limits)?;
    if texels == 0 {
        return Err(malformed("no texel in it".to_owned()));
    }
    let image = DynamicImage::from_decoder(decoder).map_err(|e| malformed(e.to_string()))?;
    let has_alpha = image.color().has_alpha();
    Ok(Decoded { width, height, rgba8: image.into_rgba8().into_raw(), has_alpha })
}

#[cfg(test)]
#[cfg(all(feature = "gltf", feature = "obj"))]
mod tests {
    use super::*;
    use image::{Rgba, RgbaImage};

    fn png(width: u32, height: u32) -> Vec<u8> {
        let image = RgbaImage::from_fn(width, height, |x, y| Rgba([x as u8, y as u8, 7, 200]));
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn a_png_comes_back_with_its_rows_from_the_top() {
        let image = decode(&OF_GLTF, &png(3, 2), "a", Path::new("m.obj"), &Limits::default(), &mut 0).unwrap();
        assert_eq!((image.width, image.height), (3, 2));
        let texels: Vec<_> = image.rgba8.chunks(4).map(|t| [t[0], t[1], t[2], t[3]]).collect();
        assert_eq!(texels[4], [1, 1, 7, 200]);
    }

    #[test]
    fn too_many_texels_are_refused() {
        let limits = Limits { texels: 5, ..Limits::default() };
        let error = decode(&OF_GLTF, &png(3, 2), "a", Path::new("m.obj"), &limits, &mut 0).unwrap_err();
        assert!(matches!(error, LoadError::ImageTooLarge { count: 6, limit: 5, .. }), "{error}");
        let limits = Limits { texels_in_all: 10, ..Limits::default() };
        assert!(decode(&OF_GLTF, &png(3, 2), "a", Path::new("m.obj"), &limits, &mut 4).is_ok());
        let error = decode(&OF_GLTF, &png(3, 2), "a", Path::new("m.obj"), &limits, &mut 5).unwrap_err();
        assert!(matches!(error, LoadError::ImageTooLarge { count: 11, limit: 10, .. }), "{error}");
    }

    #[test]
    fn garbage_is_malformed_and_named() {
        let whole = png(8, 8);
        for bytes in [&b""[..], b"not an image at all", &whole[..20], &whole[..whole.len() - 30]] {
            let error = decode(&OF_GLTF, bytes, "wall", Path::new("m.obj"), &Limits::default(), &mut 0).unwrap_err();
            assert!(matches!(error, LoadError::Malformed { .. }), "{error}");
            assert!(error.to_string().contains("wall") && error.to_string().contains("m.obj"), "{error}");
        }
    }
}
