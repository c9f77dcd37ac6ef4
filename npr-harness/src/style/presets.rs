//! The built-in styles.

use super::{Lines, Style};
use crate::edge_lines::plan::INK;
use crate::hatch::{HatchEncoding, HatchGround, HatchMap, HatchMapping, HatchShade, HatchSource, HatchTransfer};
use crate::image_lines::{ImageInk, InkScale};
use crate::lights::{LightFrame, StyleLight};
use crate::printed_fins::PrintedLines;
use crate::shade::Shade;
use crate::shade::lambert::Lambert;
use crate::shade::painter::{PainterShade, Ramp2dSource};
use crate::shade::ramp::{RampShade, RampSource};
use crate::shade::x_toon::{XToon, XToonDetail};
use crate::shadow::{ShadowLines, ShadowStyle};
use glam::Vec3;
use npr_gooch::Gooch;
use npr_hatch::TamParameters;
use npr_imagespace::artist::ArtistRotation;
use npr_imagespace::composite::Composite;
use npr_imagespace::morphology::disc::Disc;
use npr_outline::line_style::{LineStyle, widths_px};
use npr_toon::Bands;
use npr_toon::half_lambert::HalfLambert;
use npr_toon::normal::NormalUse;
use npr_toon::painter::Painter;
use npr_toon::ramp::{Ramp, RampBlend, RampStop};
use npr_toon::source::Light;
use npr_toon::table::{Corner, Ramp2d};
use std::sync::LazyLock;

/// A warm white.
const PAPER: Vec3 = Vec3::new(0.98, 0.97, 0.94);

fn ink_lines(silhouette_px: f32, crease_px: f32) -> Lines {
    let width_px = widths_px(silhouette_px, silhouette_px, crease_px, crease_px);
    Lines::edges(LineStyle { width_px, ink: INK })
}

fn image_lines(ink: ImageInk) -> Lines {
    let [r, g, b, opacity] = INK;
    Lines::image(ImageInk { composite: Composite::Over { color: Vec3::new(r, g, b), opacity }, ..ink })
}

fn ramp<const N: usize>(blend: RampBlend, stops: [(f32, [f32; 3]); N]) -> Ramp {
    Ramp { stops: stops.map(|(at, color)| RampStop { at, color: Vec3::from(color) }).to_vec(), blend }
}

/// A ramp from dark violet over a cool half-tone to the surface's colour, which is reached only where it faces the
/// light.
fn wash() -> RampShade {
    let stops = [(0.1, [0.30, 0.26, 0.48]), (0.5, [0.62, 0.58, 0.74]), (0.85, [0.97, 0.93, 0.90]), (0.98, [1.0; 3])];
    RampShade { ramp: RampSource::Stops(ramp(RampBlend::Smooth, stops)), half_lambert: Some(HalfLambert::HALF_LIFE) }
}

/// Four steps, none at the terminator, so that the unlit side keeps its shape.
fn wrapped() -> RampShade {
    let stops = [(0.0, [0.42, 0.40, 0.55]), (0.12, [0.58, 0.56, 0.68]), (0.36, [0.82, 0.80, 0.84]), (0.72, [1.0; 3])];
    RampShade { ramp: RampSource::Stops(ramp(RampBlend::Hard, stops)), half_lambert: Some(HalfLambert::SOURCE) }
}

/// The tones of the first light alone, those of the second light alone, and one for brightly lit surfaces.
fn two_lights() -> PainterShade {
    let first = ramp(RampBlend::Hard, [(-1.0, [0.34, 0.32, 0.46]), (0.06, [0.55, 0.54, 0.60]), (0.55, [0.68; 3])]);
    let second = ramp(RampBlend::Hard, [(-1.0, [0.34, 0.32, 0.46]), (0.2, [0.44, 0.44, 0.58])]);
    let corner = Some(Corner { threshold: 0.95, color: Vec3::splat(0.74) });
    PainterShade {
        ramp: Ramp2dSource::Ramps(Ramp2d { a: first, b: second, corner }),
        light_scale: Painter::LIGHT_SCALE,
        material_by_alpha: false,
    }
}

/// Three bands in the foreground, which nearly vanish in the background.
fn fading() -> XToon {
    XToon {
        detailed: ramp(RampBlend::Hard, [(-1.0, [0.34, 0.32, 0.46]), (0.05, [0.72, 0.71, 0.78]), (0.55, [1.0; 3])]),
        abstracted: ramp(RampBlend::Hard, [(-1.0, [0.86, 0.87, 0.92]), (0.05, [0.97, 0.97, 0.98])]),
        detail: XToonDetail::Depth { from: 0.0, to: 0.9 },
    }
}

/// A bright warm light from the upper left, and a dim cool lamp at the lower right, near the model.
fn warm_and_cool() -> Vec<StyleLight> {
    let warm = Light { color: Vec3::new(1.0, 0.98, 0.93), brightness: 1.2, ..StyleLight::KEY.light };
    let lamp =
        Light { color: Vec3::new(0.9, 0.95, 1.0), brightness: 0.7, ..Light::positional(Vec3::new(1.3, -0.1, 0.7)) };
    [warm, lamp].map(|light| StyleLight { light, frame: LightFrame::View }).to_vec()
}

/// Strokes along the texture's x axis, which the direction field rotates.
static ALONG: LazyLock<HatchMap> = LazyLock::new(|| HatchMap::new(HatchSource::Parameters(fine_strokes())));

/// Oblique strokes, as a right-handed artist draws them.
static OBLIQUE: LazyLock<HatchMap> =
    LazyLock::new(|| HatchMap::new(HatchSource::Parameters(TamParameters { angle_deg: 35.0, ..fine_strokes() })));

fn fine_strokes() -> TamParameters {
    TamParameters {
        side: 512,
        length: [0.15, 0.4],
        bow: 0.02,
        jitter_deg: 3.0,
        cross_deg: 70.0,
        ..TamParameters::default()
    }
}

/// Strokes that follow the surface, and solid black where no light falls.
fn hatching() -> HatchShade {
    HatchShade {
        map: ALONG.clone(),
        encoding: HatchEncoding::Thresholds,
        mapping: HatchMapping::Form,
        transfer: HatchTransfer::Linear { ambient: 0.15 },
        tile: 0.5,
        texel_px: 1.0,
        ink: Vec3::new(INK[0], INK[1], INK[2]),
        ground: HatchGround::Paper,
    }
}

/// The built-in styles.
pub fn styles() -> Vec<Style> {
    let style = |name: &str, about: &str, shade, lines| Style {
        name: name.to_owned(),
        about: about.to_owned(),
        paper: PAPER,
        shade,
        normals: NormalUse::PerPixel,
        mesh_normals: false,
        lights: vec![StyleLight::KEY],
        shadow: None,
        lines,
        crease_angle_rad: 45f32.to_radians(),
        file_edges: true,
    };
    let hard = Bands { antialias: false, ..Bands::hard_shading() };
    let shadow = Some(ShadowStyle::default());
    // Low enough for visible shadows, and high enough for them to end on the ground.
    let from_the_left = vec![StyleLight { light: Light::directional(Vec3::new(-0.75, 0.95, 0.35)), ..StyleLight::KEY }];
    // Nearly perpendicular to the view, so that the whole range from cool to warm is visible.
    let from_the_side = vec![StyleLight { light: Light::directional(Vec3::new(-0.7, 0.6, 0.3)), ..StyleLight::KEY }];
    vec![
        style("cartoon", "banded light, highlight, ink lines", Shade::Toon(Bands::default()), ink_lines(2.0, 1.3)),
        style("toon", "banded light alone", Shade::Toon(Bands::default()), Lines::NONE),
        style("lines", "ink on paper, hidden lines removed", Shade::Paper, ink_lines(1.4, 1.0)),
        style("bold", "two tones and a heavy pen", Shade::Toon(Bands::hard_shading()), ink_lines(4.0, 2.0)),
        Style {
            lights: from_the_side.clone(),
            ..style(
                "gooch",
                "cool to warm, a clear highlight, ink lines",
                Shade::Gooch(Gooch::default()),
                ink_lines(1.6, 1.1),
            )
        },
        Style {
            lights: warm_and_cool(),
            ..style(
                "two-lights",
                "a warm light and a cool lamp through a 2D ramp, ink lines",
                Shade::Painter(two_lights()),
                ink_lines(2.0, 1.3),
            )
        },
        style("x-toon", "bands that fade with depth, ink lines", Shade::XToon(fading()), ink_lines(2.0, 1.3)),
        style("wash", "a smooth ramp of colours, fine lines", Shade::Ramp(wash()), ink_lines(1.2, 0.9)),
        style("wrapped", "four bands of half-Lambert light, ink lines", Shade::Ramp(wrapped()), ink_lines(2.0, 1.3)),
        style(
            "lambert",
            "plain diffuse light, no bands, no lines",
            Shade::Lambert(Lambert { ambient: 0.25 }),
            Lines::NONE,
        ),
        style(
            "ink-image",
            "banded light, lines found in the image",
            Shade::Toon(Bands::default()),
            image_lines(ImageInk::default()),
        ),
        style(
            "ink-thick",
            "the same at twice the size, widened by a round dilation",
            Shade::Toon(Bands::default()),
            image_lines(ImageInk {
                dilation: Some(Disc { radius_px: 3.0, antialias: true }),
                scale: InkScale::Double,
                ..ImageInk::default()
            }),
        ),
        style(
            "ink-fine",
            "lines on paper, found at twice the picture's size",
            Shade::Paper,
            image_lines(ImageInk { scale: InkScale::Double, ..ImageInk::default() }),
        ),
        style(
            "artist",
            "lines where an artist painted them, material by material",
            Shade::Toon(Bands::default()),
            image_lines(ImageInk { artist: Some(ArtistRotation::PerPixel), ..ImageInk::default() }),
        ),
        Style {
            shadow,
            lights: from_the_left.clone(),
            ..style(
                "toon-shadow",
                "banded light and cast shadows, both outlined by one pass over the image",
                Shade::Toon(Bands::default()),
                image_lines(ImageInk { shadows: ShadowLines::Lines, ..ImageInk::default() }),
            )
        },
        Style {
            shadow,
            lights: from_the_left.clone(),
            ..style(
                "hatch-shadow",
                "strokes that follow the form, densest in cast shadows, outlined",
                Shade::Hatch(hatching()),
                image_lines(ImageInk { shadows: ShadowLines::Lines, ..ImageInk::default() }),
            )
        },
        Style {
            shadow,
            lights: from_the_left.clone(),
            ..style(
                "shadow-lines",
                "ink on paper, and in blue where shadows end",
                Shade::Paper,
                image_lines(ImageInk {
                    shadows: ShadowLines::Separate {
                        composite: Composite::Over { color: Vec3::new(0.20, 0.36, 0.72), opacity: 1.0 },
                        dilation: Some(Disc { radius_px: 1.0, antialias: true }),
                    },
                    ..ImageInk::default()
                }),
            )
        },
        Style {
            shadow,
            lights: from_the_left.clone(),
            ..style(
                "normals",
                "world-space normals, negated in shadow: what the 2002 chapter filters",
                Shade::Normals,
                Lines::NONE,
            )
        },
        Style {
            shadow,
            lights: from_the_left,
            ..style(
                "printed-shadow",
                "shadow outlines by negated normals, as the 2002 chapter has them",
                Shade::Toon(hard.clone()),
                image_lines(ImageInk { shadows: ShadowLines::Negated, ..ImageInk::default() }),
            )
        },
        Style {
            normals: NormalUse::PerVertex,
            ..style(
                "vertex-light",
                "the bands of `toon` by light that is computed at the vertices",
                Shade::Toon(Bands::default()),
                Lines::NONE,
            )
        },
        Style {
            normals: NormalUse::Interpolated,
            ..style(
                "printed-bands",
                "the three bands of the 2002 chapter's listing 3, aliased, normals as interpolated",
                Shade::Toon(Bands::three_diffuse_bands()),
                Lines::NONE,
            )
        },
        Style {
            normals: NormalUse::Interpolated,
            lights: from_the_side,
            ..style(
                "printed-gooch",
                "the cool and warm tones of the 2002 chapter's listing 7, as printed",
                Shade::Gooch(Gooch::swapped_shares()),
                Lines::NONE,
            )
        },
        style("hatch", "strokes that follow the form, fine lines", Shade::Hatch(hatching()), ink_lines(1.4, 1.0)),
        style(
            "hatch-planes",
            "oblique strokes of six tones by three planes, ink lines",
            Shade::Hatch(HatchShade {
                map: OBLIQUE.clone(),
                encoding: HatchEncoding::SixTones,
                mapping: HatchMapping::Planes,
                ..hatching()
            }),
            ink_lines(1.6, 1.1),
        ),
        style(
            "hatch-color",
            "coloured strokes over the surface's own colour, by its texture coordinates",
            Shade::Hatch(HatchShade {
                map: OBLIQUE.clone(),
                mapping: HatchMapping::Coordinates,
                transfer: HatchTransfer::Linear { ambient: 0.3 },
                ink: Vec3::new(0.20, 0.14, 0.30),
                ground: HatchGround::Surface,
                ..hatching()
            }),
            ink_lines(1.4, 1.0),
        ),
        Style {
            normals: NormalUse::PerVertex,
            ..style(
                "printed-hatch",
                "hatching by the 2002 chapter's listings 4 and 5, as printed: weights at the vertices",
                Shade::Hatch(HatchShade {
                    map: OBLIQUE.clone(),
                    encoding: HatchEncoding::SixTones,
                    mapping: HatchMapping::Coordinates,
                    transfer: HatchTransfer::Listing4 { brightness: 6.0 },
                    ink: Vec3::ZERO,
                    ..hatching()
                }),
                Lines::NONE,
            )
        },
        style(
            "printed-fins",
            "the outline of the 2002 chapter's listing 1, as printed",
            Shade::Toon(hard),
            Lines::printed(PrintedLines::default()),
        ),
    ]
}

/// Finds a built-in style by name.
pub fn style(name: &str) -> Option<Style> {
    styles().into_iter().find(|style| style.name == name)
}
