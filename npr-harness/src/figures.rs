//! The figures of the documents, and pairs that differ in one erratum: what `npr figures` draws.
//!
//! Every panel that is rendered is a style file and a [`Setting`], so that whatever a figure shows can be had for other
//! models too.

mod documents;
mod errata;
mod page;
mod scenes;
mod variants;

pub use documents::figures;
pub use errata::{Erratum, errata};
pub use page::{write, write_gallery};
pub use scenes::Setting;
pub use variants::variants;

use crate::error::HarnessError;
use crate::executor::{Backend, CpuReason, Executor, Picture, Rendered, Work};
use crate::picture::Image;
use crate::scene::Scene;
use crate::style::Style;
use crate::view::View;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The size of a panel, px.
pub const PANEL: (u32, u32) = (480, 270);
/// The space between panels, px.
const GAP: u32 = 8;

/// Light from the left, low enough for visible shadows.
const FROM_THE_LEFT: &str = "[[light]]\ndirection = [-0.75, 0.95, 0.35]\n";
/// Three bands of light.
const BANDS: &str =
    "[shade.toon]\nthresholds = [0.05, 0.6]\ntones = [[0.35, 0.33, 0.42], [0.7, 0.69, 0.74], [1, 1, 1]]\n";

/// A style without surfaces: black lines of a G-buffer on white.
fn lines(keys: &str, gbuffer: &str) -> String {
    format!("shade = \"paper\"\n[lines.image]\n{keys}\n[lines.image.gbuffer]\n{gbuffer}\n")
}

/// A figure: panels in rows.
#[derive(Clone, Debug)]
pub struct Figure {
    /// The name of its file, without the ending.
    pub name: &'static str,
    /// The figure of a document, or the erratum, that it shows.
    pub shows: &'static str,
    /// What there is to see, what differs from print, and why.
    pub caption: &'static str,
    /// Panels in a row.
    pub columns: u32,
    /// The panels, row by row.
    pub panels: Vec<Panel>,
}

/// A part of a figure.
#[derive(Clone, Debug)]
pub struct Panel {
    /// What it is, for the page.
    pub legend: &'static str,
    /// What it shows.
    pub content: Content,
}

/// What a panel shows.
#[derive(Clone, Debug)]
pub enum Content {
    /// A picture of a scene by a style file.
    Style {
        /// The style file.
        toml: String,
        /// Scene and view.
        setting: Setting,
    },
    /// The difference of two panels before it: black where a channel differs by half or more, white where none does.
    Difference([usize; 2]),
    /// A picture that is no rendering.
    Drawn(fn() -> Result<Image, HarnessError>),
}

impl Panel {
    fn style(legend: &'static str, setting: Setting, toml: impl Into<String>) -> Self {
        Self { legend, content: Content::Style { toml: toml.into(), setting } }
    }

    fn difference(of: [usize; 2]) -> Self {
        Self { legend: "where they differ", content: Content::Difference(of) }
    }

    fn drawn(legend: &'static str, draw: fn() -> Result<Image, HarnessError>) -> Self {
        Self { legend, content: Content::Drawn(draw) }
    }
}

impl Figure {
    /// The styles of its panels, with their settings.
    ///
    /// # Errors
    /// Those of [`Style::from_toml`]; none for the figures of this crate.
    pub fn styles(&self) -> Result<Vec<(Setting, Style)>, HarnessError> {
        let of_panel = |(number, panel): (usize, &Panel)| match &panel.content {
            Content::Style { toml, setting } => {
                let name = PathBuf::from(format!("{}-{}.toml", self.name, number + 1));
                Some(Style::from_toml(toml, &name).map(|style| (*setting, style)))
            }
            Content::Difference(_) | Content::Drawn(_) => None,
        };
        self.panels.iter().enumerate().filter_map(of_panel).collect()
    }
}

/// The figures of the documents, of their other systems, and of the errata.
pub fn all() -> Vec<Figure> {
    figures().into_iter().chain(variants()).chain(errata().into_iter().map(|erratum| erratum.figure)).collect()
}

/// The work for figures, whose scenes are built on the stage.
///
/// # Errors
/// Those of [`Figure::styles`].
pub fn work(stage: &mut Stage, figures: &[Figure]) -> Result<Work, HarnessError> {
    let mut work = Work::default();
    for figure in figures {
        for (setting, style) in figure.styles()? {
            work = work.and(Work::new(stage.scene(setting), &style, PANEL, 1));
        }
    }
    Ok(work)
}

/// A figure that was drawn.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The figure.
    pub figure: Figure,
    /// Its picture.
    pub image: Image,
    /// The reason why the CPU drew a panel of it, if the GPU could not.
    pub why_cpu: Option<CpuReason>,
}

/// Scenes, each built once.
#[derive(Default)]
pub struct Stage {
    scenes: BTreeMap<Setting, Scene>,
}

impl Stage {
    /// The scene of a setting.
    pub fn scene(&mut self, setting: Setting) -> &Scene {
        self.scenes.entry(setting).or_insert_with(|| setting.scene())
    }
}

/// Draws a figure.
///
/// # Errors
/// [`HarnessError`].
pub fn draw(
    executor: &mut Executor,
    backend: Backend,
    stage: &mut Stage,
    figure: Figure,
) -> Result<Drawn, HarnessError> {
    let mut why_cpu = None;
    let mut images: Vec<Image> = Vec::new();
    let mut styles = figure.styles()?.into_iter();
    for panel in &figure.panels {
        let image = match &panel.content {
            Content::Style { .. } => {
                let (setting, style) = styles.next().expect("a style for each of these panels");
                let picture = Picture::new(stage.scene(setting), &style, View::new(setting.camera(), PANEL));
                let Rendered { image, why_cpu: why, .. } = executor.render_with_fallback(backend, &picture, &|_| {})?;
                why_cpu = why_cpu.or(why);
                image
            }
            Content::Difference([a, b]) => difference(&images[*a], &images[*b]),
            Content::Drawn(draw) => draw()?,
        };
        images.push(image);
    }
    let image = grid(&images, figure.columns);
    Ok(Drawn { figure, image, why_cpu })
}

/// White where two pictures are equal, and the darker the more they differ.
fn difference(a: &Image, b: &Image) -> Image {
    let mut shown = Image::filled(a.width, a.height, [255; 4]);
    for y in 0..a.height.min(b.height) {
        for x in 0..a.width.min(b.width) {
            let apart = a.pixel(x, y).iter().zip(b.pixel(x, y)).map(|(&a, b)| a.abs_diff(b)).max().unwrap_or(0);
            let gray = 255 - apart.saturating_mul(2);
            shown.set_pixel(x, y, [gray, gray, gray, 255]);
        }
    }
    shown
}

/// Panels in rows, each in the middle of its cell.
fn grid(panels: &[Image], columns: u32) -> Image {
    let size = |of: fn(&Image) -> u32| panels.iter().map(of).max().unwrap_or(1);
    let (width, height) = (size(|panel| panel.width), size(|panel| panel.height));
    let rows = (panels.len() as u32).div_ceil(columns);
    let across = |count: u32, side: u32| count * side + (count + 1) * GAP;
    let mut whole = Image::filled(across(columns, width), across(rows, height), [224, 224, 224, 255]);
    for (number, panel) in (0..).zip(panels) {
        let (column, row) = (number % columns, number / columns);
        let left = GAP + column * (width + GAP) + (width - panel.width) / 2;
        let top = GAP + row * (height + GAP) + (height - panel.height) / 2;
        for y in 0..panel.height {
            for x in 0..panel.width {
                whole.set_pixel(left + x, top + y, panel.pixel(x, y));
            }
        }
    }
    whole
}

/// The file of a figure's picture.
fn picture_file(dir: &Path, figure: &Figure) -> PathBuf {
    dir.join(format!("{}.png", figure.name))
}
