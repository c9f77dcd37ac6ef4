//! Limits on the size of a picture, checked before anything is allocated.

use crate::error::HarnessError;
use crate::image_lines::InkScale;
use crate::shadow::ShadowMethod;
use crate::style::Style;

/// The largest side of a picture, px.
pub const LARGEST_SIDE: u32 = 65_536;
/// The default limit on a picture's memory, bytes.
pub const MEMORY_BYTES: u64 = 2 << 30;
/// The maximum number of samples per pixel along each axis.
pub const MOST_SAMPLES: u32 = 64;

/// CPU, per sample: colour 32, depth 8, line coverage or texel 8.
const SAMPLE_BYTES: u64 = 48;
/// CPU, per pixel: the resolved frame.
const MEAN_BYTES: u64 = 40;
/// CPU, per pixel: the picture, its copy while it grows, its file.
const FILE_BYTES: u64 = 12;
/// GPU, per sample: two colours, depth, line coverage, 12 for strokes, the readback buffer, the picture, its file.
const DEVICE_BYTES: u64 = 48;
/// Per pixel of ink in image-space lines: texels 8, depth 4, ink and dilation.
const INK_BYTES: u64 = 20;
/// The same where the style has a G-buffer of its own: texels of 16 instead of 8, three encoded targets, a second ink.
const GBUFFER_BYTES: u64 = 34;

/// GPU, per pixel of the picture, and of the ink if it has another size: depth, the stencil for shadows, and the shadow
/// mask.
const STENCIL_BYTES: u64 = 9;

/// An estimate of the memory that rendering a picture takes besides the scene, bytes; usually slightly too high. A
/// software adapter uses main memory too.
pub(crate) fn picture_bytes(style: &Style, (width, height): (u32, u32), samples: u32, on_device: bool) -> u64 {
    let pixels = u64::from(width) * u64::from(height);
    let image = style.lines.image.as_ref();
    let each = INK_BYTES + if image.is_some_and(|ink| ink.gbuffer.is_some()) { GBUFFER_BYTES } else { 0 };
    let ink = match image.map(|ink| ink.scale) {
        Some(InkScale::Half) => each / 4,
        Some(InkScale::One) => each,
        Some(InkScale::Double) => 4 * each,
        None => 0,
    };
    let (mut stencil, mut map) = (0, 0);
    match style.shadow.map(|shadow| shadow.method) {
        Some(ShadowMethod::Volumes) => {
            stencil = STENCIL_BYTES
                + if image.is_some_and(|ink| ink.scale == InkScale::Double) { 4 * STENCIL_BYTES } else { 0 }
        }
        Some(ShadowMethod::Map { side }) => map = 4 * u64::from(side) * u64::from(side),
        None => {}
    }
    let samples = u64::from(samples.max(1));
    let per_pixel = if on_device {
        let sampled = (DEVICE_BYTES + stencil).saturating_mul(samples).saturating_mul(samples);
        // Several samples are resolved into targets of the picture's size, and the ink has its own geometry pass.
        let own = if samples > 1 { DEVICE_BYTES + STENCIL_BYTES } else { 0 };
        sampled.saturating_add(own + ink)
    } else {
        map = 0;
        let mean = if samples > 1 { MEAN_BYTES } else { 0 };
        SAMPLE_BYTES.saturating_mul(samples).saturating_mul(samples).saturating_add(mean + FILE_BYTES + ink)
    };
    pixels.saturating_mul(per_pixel).saturating_add(map)
}

/// Checks that a picture is within the limits.
///
/// # Errors
/// [`HarnessError::Size`], [`HarnessError::PictureMemory`].
pub fn check_picture(
    style: &Style,
    (width, height): (u32, u32),
    samples: u32,
    on_device: bool,
    most_bytes: u64,
) -> Result<(), HarnessError> {
    if ![width, height].iter().all(|side| (1..=LARGEST_SIDE).contains(side)) {
        return Err(HarnessError::Size { width, height, limit: LARGEST_SIDE });
    }
    let bytes = picture_bytes(style, (width, height), samples, on_device);
    if bytes > most_bytes {
        return Err(HarnessError::PictureMemory { width, height, samples, bytes, limit: most_bytes });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::{style, styles};

    #[test]
    fn no_size_overflows() {
        for style in styles() {
            for on_device in [false, true] {
                let most = picture_bytes(&style, (u32::MAX, u32::MAX), u32::MAX, on_device);
                assert!(most > 1 << 63, "{}", style.name);
                assert_eq!(picture_bytes(&style, (0, 9), 1, on_device), 0);
            }
        }
    }

    #[test]
    fn usual_pictures_fit_and_huge_ones_do_not() {
        let check = |name: &str, size, samples, on_device| {
            check_picture(&style(name).expect("it is there"), size, samples, on_device, MEMORY_BYTES)
        };
        for on_device in [false, true] {
            for style in styles() {
                check(&style.name, (3840, 2160), 1, on_device).expect("a large screen's");
                check(&style.name, (1280, 720), if on_device { 1 } else { 4 }, on_device).expect("a usual one");
            }
            for size in [(0, 0), (0, 5), (100_000, 100_000), (65_537, 1)] {
                assert!(matches!(check("cartoon", size, 1, on_device), Err(HarnessError::Size { .. })), "{size:?}");
            }
            let refused = check("cartoon", (65_536, 16_384), 1, on_device);
            assert!(matches!(refused, Err(HarnessError::PictureMemory { .. })), "{refused:?}");
            check("cartoon", (65_536, 512), 1, on_device).expect("it is long, not large");
        }
        let sampled = check("cartoon", (3840, 2160), 64, false);
        assert!(matches!(sampled, Err(HarnessError::PictureMemory { samples: 64, .. })), "{sampled:?}");
    }
}
