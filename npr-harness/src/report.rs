//! The report: one page with the gallery, the charts, the failure atlas, the checks and both executors' pictures.
//!
//! [`Contents`] is plain data; [`page`] makes it one HTML file that refers to nothing else. [`Stages`] keeps what was
//! measured, so that an interrupted run goes on where it was.

mod changes;
mod html;
pub mod make;
mod page;
mod stages;
mod svg;
pub mod tables;

pub use changes::{Change, Changes, Direction, changes};
pub use page::page;
pub use stages::Stages;
pub use svg::{atlas_diagram, chart_diagram};

use crate::chart::table::{Point, Row};
use crate::check;
use crate::error::HarnessError;
use crate::picture::{Image, PictureFormat};
use crate::stability;
use serde::{Deserialize, Serialize};

/// What a report shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contents {
    /// The machine and the adapters, a line each.
    pub machine: Vec<String>,
    /// What is not shown, and why.
    pub skipped: Vec<String>,
    /// Pictures of the styles.
    pub gallery: Vec<GalleryPicture>,
    /// The charts.
    pub charts: Vec<ChartContent>,
    /// The failure atlas.
    pub atlas: Vec<AtlasEntry>,
    /// The checks.
    pub check: Option<CheckTable>,
    /// Pictures by two executors.
    pub pairs: Vec<Pair>,
    /// What differs from an earlier run.
    pub changes: Option<Changes>,
}

/// A picture as a PNG file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PngPicture {
    /// Px.
    pub width: u32,
    /// Px.
    pub height: u32,
    /// The bytes of the file.
    #[serde(with = "base64_bytes")]
    pub png: Vec<u8>,
}

impl PngPicture {
    /// Encodes a picture, reduced to at most `most_width` px.
    ///
    /// # Errors
    /// [`HarnessError::Image`].
    pub fn new(image: &Image, most_width: u32) -> Result<Self, HarnessError> {
        let reduced;
        let image = if image.width > most_width {
            reduced = reduce(image, most_width);
            &reduced
        } else {
            image
        };
        Ok(Self { width: image.width, height: image.height, png: image.encode(PictureFormat::Png)? })
    }
}

fn reduce(image: &Image, width: u32) -> Image {
    let height = (f64::from(image.height) * f64::from(width) / f64::from(image.width)).round().max(1.0) as u32;
    let Some(pixels) = image::RgbaImage::from_raw(image.width, image.height, image.rgba8.clone()) else {
        return image.clone();
    };
    let reduced = image::imageops::resize(&pixels, width, height, image::imageops::FilterType::CatmullRom);
    Image { width, height, rgba8: reduced.into_raw() }
}

mod base64_bytes {
    use base64::prelude::{BASE64_STANDARD, Engine};
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub fn serialize<S: Serializer>(bytes: &[u8], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&BASE64_STANDARD.encode(bytes))
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<u8>, D::Error> {
        let text = String::deserialize(deserializer)?;
        BASE64_STANDARD.decode(text).map_err(D::Error::custom)
    }
}

/// A picture of the gallery.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GalleryPicture {
    /// The style.
    pub name: String,
    /// A description.
    pub about: String,
    /// Its passes.
    pub passes: Vec<String>,
    /// The time from planning to the picture in memory, ms.
    pub time_ms: f64,
    /// The picture.
    pub picture: PngPicture,
}

/// A chart with what was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartContent {
    /// The name, in kebab case.
    pub name: String,
    /// A heading.
    pub title: String,
    /// The error on the axis.
    pub error: String,
    /// What is measured.
    pub about: String,
    /// The executors of the run, whether this chart has points of them or not.
    pub executors: Vec<String>,
    /// The rows of this chart.
    pub rows: Vec<Row>,
    /// Its points.
    pub points: Vec<Point>,
}

/// A sweep of the atlas with what it found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AtlasEntry {
    /// The name, in kebab case.
    pub name: String,
    /// The technique that it breaks.
    pub technique: String,
    /// What fails, and why.
    pub what: String,
    /// What it found, or why it was skipped.
    pub found: Result<Found, String>,
}

/// What a sweep found: [`stability::Finding`] with encoded pictures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// The parameter that is varied.
    pub parameter: stability::Axis,
    /// The error that is measured.
    pub error: stability::Axis,
    /// The curves.
    pub curves: Vec<stability::Curve>,
    /// Pictures with their captions.
    pub pictures: Vec<(String, PngPicture)>,
}

impl Found {
    /// Encodes the pictures of a finding.
    ///
    /// # Errors
    /// [`HarnessError::Image`].
    pub fn new(finding: stability::Finding) -> Result<Self, HarnessError> {
        let stability::Finding { parameter, error, curves, pictures } = finding;
        let pictures =
            pictures.into_iter().map(|(caption, image)| Ok((caption, PngPicture::new(&image, MOST_ATLAS_WIDTH)?)));
        Ok(Self { parameter, error, curves, pictures: pictures.collect::<Result<_, HarnessError>>()? })
    }
}

/// Pictures of the atlas are reduced to this, px.
const MOST_ATLAS_WIDTH: u32 = 640;

/// The metrics of a check.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CheckTable {
    /// The executor that rendered the pictures.
    pub executor: String,
    /// The checks that were skipped, and why.
    pub skipped: Vec<String>,
    /// The metrics.
    pub rows: Vec<CheckRow>,
}

/// A metric: [`check::Metric`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CheckRow {
    /// The model.
    pub model: String,
    /// The view.
    pub view: String,
    /// The technique or style.
    pub technique: String,
    /// The name of the metric.
    pub metric: String,
    /// The value.
    pub value: f64,
    /// The limit, if there is one.
    pub limit: Option<check::Limit>,
    /// Whether the value is within the limit.
    pub pass: bool,
}

impl From<check::Report> for CheckTable {
    fn from(report: check::Report) -> Self {
        let row = |metric: check::Metric| CheckRow {
            model: metric.model,
            view: metric.view,
            technique: metric.technique,
            metric: metric.metric.into(),
            value: metric.value,
            limit: metric.limit,
            pass: metric.pass,
        };
        let rows = report.metrics.into_iter().map(row).collect();
        Self { executor: report.executor, skipped: report.skipped, rows }
    }
}

/// A style's picture by two executors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pair {
    /// The style.
    pub style: String,
    /// The executors.
    pub executors: [String; 2],
    /// Their pictures.
    pub pictures: [PngPicture; 2],
    /// The amplified difference.
    pub difference: PngPicture,
    /// The number of pixels that differ.
    pub differing: u64,
    /// The number of pixels.
    pub pixels: u64,
    /// The largest difference of a channel, of 255.
    pub worst: u8,
}

#[cfg(test)]
mod tests;
