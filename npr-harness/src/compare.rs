//! Comparison of images, and its report.
//!
//! The difference of a pixel is the largest of its four channels' differences (0..=255), including alpha. Pixels at
//! which the reference itself is not stable can be exempt ([`exempt_mask`]). Both counts, with and without exempt
//! pixels, are kept, so that exemptions can be reported and limited.

use crate::error::HarnessError;
use crate::picture::{Image, ImageError, byte_count};

pub use crate::picture::CompareError;
use base64::prelude::{BASE64_STANDARD, Engine};
use npr_hatch::files::write_file;
use std::fs;
use std::path::{Path, PathBuf};

/// At most `count` pixels may differ by more than `magnitude` in any channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tolerance {
    /// The largest difference that is ignored, of 255.
    pub magnitude: u8,
    /// The number of pixels.
    pub count: u64,
}

/// How two images differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Comparison {
    /// The number of pixels, including exempt ones.
    pub pixels: u64,
    /// The number of exempt pixels.
    pub exempt: u64,
    /// The number of pixels that are not exempt, by their difference.
    pub histogram: [u64; 256],
    /// The number of all pixels, by their difference.
    pub histogram_all: [u64; 256],
    /// The largest difference of a pixel that is not exempt.
    pub worst: u8,
    /// The first pixel with that difference (column and row, from the upper left); `None` if none differs.
    pub worst_at: Option<(u32, u32)>,
}

impl Comparison {
    /// The number of pixels that are not exempt and differ by more than `magnitude`.
    pub fn over(&self, magnitude: u8) -> u64 {
        self.histogram[usize::from(magnitude) + 1..].iter().sum()
    }

    /// The number of pixels, including exempt ones, that differ by more than `magnitude`.
    pub(crate) fn over_all(&self, magnitude: u8) -> u64 {
        self.histogram_all[usize::from(magnitude) + 1..].iter().sum()
    }

    /// Whether all tolerances are met. Without any, no pixel may differ at all.
    pub fn passes(&self, tolerances: &[Tolerance]) -> bool {
        if tolerances.is_empty() {
            return self.over(0) == 0;
        }
        tolerances.iter().all(|tolerance| self.over(tolerance.magnitude) <= tolerance.count)
    }

    /// The fraction of the pixels that is exempt, 0..=1.
    pub fn exempt_share(&self) -> f64 {
        if self.pixels == 0 { 0.0 } else { self.exempt as f64 / self.pixels as f64 }
    }
}

/// Counts the differences.
///
/// - `exempt`: per pixel, row by row, or empty for none.
///
/// # Errors
/// [`CompareError`] where the sizes or the mask's length do not fit.
pub fn compare(expected: &Image, actual: &Image, exempt: &[bool]) -> Result<Comparison, CompareError> {
    check(expected, actual, exempt)?;
    let mut result = Comparison {
        pixels: (expected.rgba8.len() / 4) as u64,
        exempt: 0,
        histogram: [0; 256],
        histogram_all: [0; 256],
        worst: 0,
        worst_at: None,
    };
    for (number, difference) in differences(expected, actual).enumerate() {
        result.histogram_all[usize::from(difference)] += 1;
        if !exempt.is_empty() && exempt[number] {
            result.exempt += 1;
            continue;
        }
        result.histogram[usize::from(difference)] += 1;
        if difference > result.worst {
            result.worst = difference;
            let width = expected.width as usize;
            result.worst_at = Some(((number % width) as u32, (number / width) as u32));
        }
    }
    Ok(result)
}

/// Per pixel, in row order: whether any of the `shifted` renders of the reference differs from the reference by more
/// than `magnitude` in any channel, that is, whether the pixel is sensitive to sampling.
///
/// # Errors
/// [`CompareError::Size`] where one of the images has another size.
pub fn exempt_mask(reference: &Image, shifted: &[Image], magnitude: u8) -> Result<Vec<bool>, CompareError> {
    let mut mask = vec![false; reference.rgba8.len() / 4];
    for image in shifted {
        check(reference, image, &[])?;
        for (exempt, difference) in mask.iter_mut().zip(differences(reference, image)) {
            *exempt |= difference > magnitude;
        }
    }
    Ok(mask)
}

/// A picture of the channels' differences, on opaque black: a difference of 1 is shown as 64, of 255 as 255. A
/// difference in alpha appears in all three colours. Exempt pixels are on dark teal (0, 32, 48).
///
/// # Errors
/// [`CompareError`] where the sizes or the mask's length do not fit.
pub(crate) fn difference_image(expected: &Image, actual: &Image, exempt: &[bool]) -> Result<Image, CompareError> {
    check(expected, actual, exempt)?;
    let amplified = |difference: u8| match difference {
        0 => 0,
        _ => 64 + (u16::from(difference - 1) * 191 / 254) as u8,
    };
    let mut rgba8 = Vec::with_capacity(expected.rgba8.len());
    for (number, (e, a)) in pixels(expected).zip(pixels(actual)).enumerate() {
        let [r, g, b, alpha] = std::array::from_fn(|channel| amplified(e[channel].abs_diff(a[channel])));
        let ground = if !exempt.is_empty() && exempt[number] { [0, 32, 48] } else { [0, 0, 0] };
        rgba8.extend([r.max(alpha).max(ground[0]), g.max(alpha).max(ground[1]), b.max(alpha).max(ground[2]), 255]);
    }
    Ok(Image { width: expected.width, height: expected.height, rgba8 })
}

fn check(expected: &Image, actual: &Image, exempt: &[bool]) -> Result<(), CompareError> {
    for image in [expected, actual] {
        if byte_count(image.width, image.height) != Some(image.rgba8.len()) {
            let (width, height, bytes) = (image.width, image.height, image.rgba8.len());
            return Err(CompareError::Bytes { width, height, bytes });
        }
    }
    let sizes = [expected, actual].map(|image| (image.width, image.height));
    if sizes[0] != sizes[1] {
        return Err(CompareError::Size { expected: sizes[0], actual: sizes[1] });
    }
    let pixels = expected.rgba8.len() / 4;
    if !exempt.is_empty() && exempt.len() != pixels {
        return Err(CompareError::Mask { mask: exempt.len(), pixels });
    }
    Ok(())
}

fn pixels(image: &Image) -> impl Iterator<Item = &[u8]> {
    image.rgba8.chunks_exact(4)
}

/// Per pixel: the largest difference of its channels.
fn differences<'a>(expected: &'a Image, actual: &'a Image) -> impl Iterator<Item = u8> + 'a {
    pixels(expected).zip(pixels(actual)).map(|(e, a)| (0..4).fold(0, |worst, c| worst.max(e[c].abs_diff(a[c]))))
}

/// Writes `name`-expected.png, `name`-actual.png and `name`-difference.png into `dir`, which is created if necessary,
/// and returns their paths in this order. In the names, every character except ASCII letters, digits, `.`, `_` and `-`
/// becomes `_`.
///
/// For images of different sizes, the first two are written and an error is returned.
///
/// # Errors
/// [`HarnessError::Image`], which names the file, and [`HarnessError::Compare`].
pub(crate) fn leave_behind(
    dir: &Path,
    name: &str,
    expected: &Image,
    actual: &Image,
    exempt: &[bool],
) -> Result<[PathBuf; 3], HarnessError> {
    fs::create_dir_all(dir).map_err(|source| ImageError::Write { path: dir.to_owned(), source })?;
    let name: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() || "._-".contains(c) { c } else { '_' }).collect();
    let paths = ["expected", "actual", "difference"].map(|which| dir.join(format!("{name}-{which}.png")));
    expected.save_png(&paths[0])?;
    actual.save_png(&paths[1])?;
    difference_image(expected, actual, exempt)?.save_png(&paths[2])?;
    Ok(paths)
}

/// One comparison of a report.
#[derive(Clone, Debug)]
pub(crate) struct ReportRow {
    /// The name of the comparison.
    pub name: String,
    /// Files of the expected, actual and difference images, as [`leave_behind`] returns them.
    pub images: [PathBuf; 3],
    /// The comparison.
    pub comparison: Comparison,
    /// The tolerances.
    pub tolerances: Vec<Tolerance>,
}

/// Writes `index.html` into `dir`, which is created if necessary, and returns its path. The page shows the three images
/// of every row side by side, with the numbers. The images are embedded, so that the page is self-contained.
///
/// # Errors
/// [`ImageError::Read`] for an image and [`ImageError::Write`] for the page.
pub(crate) fn html_report(dir: &Path, rows: &[ReportRow]) -> Result<PathBuf, ImageError> {
    fs::create_dir_all(dir).map_err(|source| ImageError::Write { path: dir.to_owned(), source })?;
    let failed = rows.iter().filter(|row| !row.comparison.passes(&row.tolerances)).count();
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Images compared</title>\n<style>\n\
         body {{ font-family: sans-serif; background: #ddd; }}\n\
         table {{ border-collapse: collapse; }}\n\
         th, td {{ border: 1px solid #888; padding: 4px; text-align: left; vertical-align: top; }}\n\
         img {{ max-width: 28vw; image-rendering: pixelated; }}\n\
         .failed {{ background: #fbb; }}\n\
         </style></head><body>\n<h1>Images compared</h1>\n<p>{} of {} failed.</p>\n\
         <table>\n<tr><th>name</th><th>expected</th><th>actual</th><th>difference</th></tr>\n",
        failed,
        rows.len(),
    );
    for row in rows {
        let c = &row.comparison;
        let passes = c.passes(&row.tolerances);
        page.push_str(if passes { "<tr>" } else { "<tr class=\"failed\">" });
        let verdict = if passes { "passed" } else { "failed" };
        page.push_str(&format!("<td><b>{}</b><br>{verdict}<br>{} pixels", escape(&row.name), c.pixels));
        page.push_str(&format!("<br>{} exempt ({:.3} %)", c.exempt, c.exempt_share() * 100.0));
        if let Some((x, y)) = c.worst_at {
            page.push_str(&format!("<br>worst difference {} at ({x}, {y})", c.worst));
        }
        let any_difference = [Tolerance { magnitude: 0, count: 0 }];
        for t in if row.tolerances.is_empty() { &any_difference[..] } else { &row.tolerances } {
            let (over, over_all) = (c.over(t.magnitude), c.over_all(t.magnitude));
            page.push_str(&format!(
                "<br>over {}: {over} of at most {} ({over_all} with the exempt ones)",
                t.magnitude, t.count
            ));
        }
        page.push_str("</td>");
        for (path, which) in row.images.iter().zip(["expected", "actual", "difference"]) {
            let bytes = fs::read(path).map_err(|source| ImageError::Read { path: path.clone(), source })?;
            page.push_str(&format!(
                "<td><img alt=\"{which}\" src=\"data:image/png;base64,{}\"></td>",
                BASE64_STANDARD.encode(&bytes)
            ));
        }
        page.push_str("</tr>\n");
    }
    page.push_str("</table>\n</body></html>\n");
    let path = dir.join("index.html");
    write_whole(&path, page.as_bytes())?;
    Ok(path)
}

/// Escapes text for an element or a quoted attribute of HTML.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;").replace('\'', "&#39;")
}

fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), ImageError> {
    write_file(path, bytes).map_err(|source| ImageError::Write { path: path.to_owned(), source })
}

#[cfg(test)]
mod tests;
