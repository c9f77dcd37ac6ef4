//! The ways to make each part of a picture that a style leaves open.
//!
//! A style asks for lines of a width and a colour, for light, for strokes, for shadows. Each technique declares its
//! variants beside its own code, in a list `VARIANTS`; a variant changes a [`Setup`] so that the part is made that way.
//! Charts show all of them, and a plan by budget chooses among them.

use crate::shade::Shade;
use crate::shade::lambert::Lambert;
use crate::shadow::ShadowLines;
use crate::style::{Lines, Style, style};
use crate::{edge_lines, hatch, hull_lines, image_lines, printed_fins, shade, shadow};
use glam::Vec3;
use npr_imagespace::composite::Composite;
use npr_outline::LineKind;
use serde::{Deserialize, Serialize};

/// What determines how a picture is made, apart from scene and camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// The style.
    pub style: Style,
    /// Samples per pixel along each axis.
    pub samples: u32,
}

/// A part of a picture that can be made in several ways.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Part {
    /// Lines.
    Lines,
    /// Light on surfaces.
    Light,
    /// Strokes on surfaces.
    Strokes,
    /// Shadows that are cast.
    Shadows,
    /// Samples per pixel.
    Samples,
}

impl Part {
    /// All parts.
    pub const ALL: [Self; 5] = [Self::Lines, Self::Light, Self::Strokes, Self::Shadows, Self::Samples];

    /// The name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lines => "lines",
            Self::Light => "light",
            Self::Strokes => "strokes",
            Self::Shadows => "shadows",
            Self::Samples => "samples",
        }
    }

    /// The ways to make it.
    pub fn variants(self) -> Vec<Variant> {
        match self {
            Self::Lines => {
                [edge_lines::VARIANTS, hull_lines::VARIANTS, printed_fins::VARIANTS, image_lines::VARIANTS].concat()
            }
            Self::Light => shade::VARIANTS.to_vec(),
            Self::Strokes => hatch::VARIANTS.to_vec(),
            Self::Shadows => shadow::VARIANTS.to_vec(),
            Self::Samples => SAMPLES.to_vec(),
        }
    }
}

/// A way to make a part of a picture.
#[derive(Clone, Copy)]
pub struct Variant {
    /// The name, unique within its part.
    pub name: &'static str,
    /// The choices of the API that it stands for, such as `HatchEncoding::Thresholds`.
    pub choices: &'static [&'static str],
    /// Whether it has an error in print, and is kept for comparison.
    pub historical: bool,
    /// Whether a plan by budget may choose it: not what is historical, nor what a device only emulates.
    pub in_budget: bool,
    /// The same picture with the part made this way; `None` if the setup does not have the part, or asks for something
    /// that this way cannot give.
    pub apply: fn(&Setup) -> Option<Setup>,
}

const SAMPLES: &[Variant] = &[
    Variant {
        name: "1 sample",
        choices: &[],
        historical: false,
        in_budget: true,
        apply: |setup| Some(Setup { samples: 1, ..setup.clone() }),
    },
    Variant {
        name: "2 x 2 samples",
        choices: &[],
        historical: false,
        in_budget: true,
        apply: |setup| Some(Setup { samples: 2, ..setup.clone() }),
    },
    Variant {
        name: "4 x 4 samples",
        choices: &[],
        historical: false,
        in_budget: true,
        apply: |setup| Some(Setup { samples: 4, ..setup.clone() }),
    },
];

/// The plain pass, which is the unit of time of charts and budgets: light without bands, no lines, one sample.
pub fn plain() -> Setup {
    let base = style("cartoon").expect("a style of this crate");
    Setup { style: Style { shade: Shade::Lambert(Lambert { ambient: 0.25 }), lines: Lines::NONE, ..base }, samples: 1 }
}

/// The lines that a style asks for, whatever draws them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RequestedLines {
    /// The width of silhouettes and boundaries, px.
    pub width_px: f32,
    /// The width of creases, px; 0 for none.
    pub crease_px: f32,
    /// The width of borders between materials, px; 0 for none.
    pub border_px: f32,
    /// Their display-referred colour.
    pub color: Vec3,
    /// Their opacity, 0..=1.
    pub opacity: f32,
}

impl RequestedLines {
    /// The lines of a style that has lines of one kind; `None` for others, and where lines are more than that: shadows
    /// have them, an artist directs them, or they come from formats that the style names.
    pub fn of(style: &Style) -> Option<Self> {
        let Lines { hull, printed, edges, image } = style.lines;
        match (hull, printed, edges, image) {
            (None, None, Some(lines), None) => {
                let width = |kind: LineKind| lines.width_px[kind as usize];
                let [r, g, b, opacity] = lines.ink;
                Some(Self {
                    width_px: width(LineKind::Silhouette),
                    crease_px: width(LineKind::Crease),
                    border_px: width(LineKind::MaterialBorder),
                    color: Vec3::new(r, g, b),
                    opacity,
                })
            }
            (None, None, None, Some(ink)) => {
                let Composite::Over { color, opacity } = ink.composite else { return None };
                let is_plain = ink.gbuffer.is_none() && ink.artist.is_none() && ink.shadows == ShadowLines::None;
                let width_px = image_lines::width_px(&ink);
                is_plain.then_some(Self { width_px, crease_px: width_px, border_px: width_px, color, opacity })
            }
            (Some(hull), None, None, None) => {
                Some(Self { width_px: hull.width_px, crease_px: 0.0, border_px: 0.0, color: hull.ink, opacity: 1.0 })
            }
            (None, Some(fins), None, None) => {
                Some(Self { width_px: fins.width_px, crease_px: 0.0, border_px: 0.0, color: fins.ink, opacity: 1.0 })
            }
            _ => None,
        }
    }

    /// The setup with other lines, for its asked ones.
    pub(crate) fn drawn(setup: &Setup, lines: impl FnOnce(&Self) -> Option<Lines>) -> Option<Setup> {
        let lines = lines(&Self::of(&setup.style)?)?;
        Some(Setup { style: Style { lines, ..setup.style.clone() }, ..*setup })
    }
}
