//! The figures of the three documents, one by one.

use super::{FROM_THE_LEFT, Figure, Panel, Setting, lines};
use crate::error::HarnessError;
use crate::picture::Image;
use crate::shade::Shade;
use crate::shade::painter::Ramp2dSource;
use crate::style::style;
use glam::DVec2;
use npr_hatch::{TamParameters, draw, sheet};
use npr_imagespace::artist::{artist_color, ink_artist_vector};
use npr_toon::table::{toon_ramp_2d, toon_table};

/// Strokes of six tones by texture coordinates or planes, as the chapter hatches.
const SIX_TONES: &str = "encoding = \"six-tones\"\nmapping = \"form\"\n";

/// The same with negated normals in shadow.
fn shadowed(keys: &str, gbuffer: &str) -> String {
    let keys = format!("shadows = \"negated\"\n{keys}");
    let [shade, rest] = ["shade = \"paper\"\n", "[shadow]\n"];
    format!("{shade}{FROM_THE_LEFT}{rest}[lines.image]\n{keys}\n[lines.image.gbuffer]\n{gbuffer}\n")
}

/// Listings 9 and 10 with the chapter's thresholds.
const LISTINGS: &str = "normal-cos = 0.85\ndepth-step = 0.02";
/// The slides' thresholds.
const SLIDES: &str = "normal-cos = 0.8\ndepth-step = 0.01";

/// Figures of the chapter, the slides and the article, in this order.
pub fn figures() -> Vec<Figure> {
    [chapter(), slides(), article()].concat()
}

fn chapter() -> Vec<Figure> {
    let objects = Setting::Objects;
    let still_life = Setting::StillLife;
    let hatched = |keys: &str, tables: &str, shade: &str| {
        format!("{keys}\n{FROM_THE_LEFT}{tables}\n[shade.hatch]\n{SIX_TONES}{shade}\n")
    };
    let negated = "shadows = \"negated\"\nnormal-cos = 0.85\ndepth-step = 0.02";
    let rgba8 = "[lines.image.gbuffer]\ntarget = \"rgba8\"";
    vec![
        Figure {
            name: "chapter-1",
            shows: "Card & Mitchell 2002, figure 1: shading by N·L, outlines from edges, outlines from the image",
            caption: "Outlines from edges are found per edge and have the width that is asked for; those from the image are found between pixels. Printed: vertex-shader fins; here: lines of constant width. The far plane of the image's depth is twice as far as the farthest point.",
            columns: 3,
            panels: vec![
                Panel::style("N·L", objects, "[shade.lambert]\nambient = 0.1\n"),
                Panel::style("lines along edges", objects, "shade = \"paper\"\n[lines.edges]\n"),
                Panel::style("listings 9 and 10", objects, lines(LISTINGS, "target = \"rgba8\"\nfar = 2.0")),
            ],
        },
        Figure {
            name: "chapter-3-4",
            shows: "Card & Mitchell 2002, figures 3 and 4: cartoon shading with outlines; with several diffuse regions \
                    and a specular one",
            caption: "Figure 3 has three colours, ambient, diffuse and specular: the text's form, a threshold for N·L and one for N·H. Figure 4 has more diffuse regions. Here tones are factors on the surfaces' own colours, and borders are antialiased, neither of which the listings have. Listing 3 as printed, two thresholds for N·L and no highlight, is the style printed-bands.",
            columns: 2,
            panels: vec![
                Panel::style(
                    "a diffuse and a specular threshold",
                    still_life,
                    "[shade.toon]\nthresholds = [0.2]\ntones = [[0.45, 0.42, 0.5], [0.9, 0.9, 0.9]]\n\
                     [shade.toon.highlight]\nthreshold = 0.9\n[lines.edges]\n",
                ),
                Panel::style(
                    "three diffuse bands and a highlight",
                    still_life,
                    "[shade.toon]\nthresholds = [0.1, 0.6]\ntones = [[0.35, 0.33, 0.42], [0.7, 0.69, 0.74], [1, 1, 1]]\n\
                     [shade.toon.highlight]\nthreshold = 0.97\n[lines.edges]\n",
                ),
            ],
        },
        Figure {
            name: "chapter-5-6",
            shows: "Card & Mitchell 2002, figures 5 and 6: a hatched object and its tonal art map",
            caption: "Six tones, two of them mixed at each pixel, light factor 7, so that the lightest tone fades to \
                      white. The map is drawn here by the same programme; printed is that of Praun et al. 2001. Its \
                      four finest levels stand below each other; strokes of a level are all in the next finer one, and \
                      those of a tone in the next darker one.",
            columns: 2,
            panels: vec![
                Panel::style("hatched", still_life, hatched("", "", "brightness = 7\n")),
                Panel::drawn("tones from left to right, levels downwards", tonal_art_map),
            ],
        },
        Figure {
            name: "chapter-7",
            shows: "Card & Mitchell 2002, figure 7: Gooch lighting with outlines",
            caption: "The equation's shares, the surfaces' own colours, and a clear highlight, which the text asks for \
                      and no listing has.",
            columns: 1,
            panels: vec![Panel::style(
                "Gooch",
                still_life,
                "[[light]]\ndirection = [-0.7, 0.6, 0.3]\n[shade.gooch]\n[shade.gooch.highlight]\nexponent = 32\n[lines.edges]\n",
            )],
        },
        Figure {
            name: "chapter-8",
            shows: "Card & Mitchell 2002, figure 8: world-space normals and eye-space depth in one RGBA8 target",
            caption: "Cleared to +z, as printed: the background is the colour of a surface that faces +z. Depth is a byte in alpha, from the nearest to the farthest point of the scene, of which the picture cuts off the nearest.",
            columns: 2,
            panels: vec![
                Panel::style(
                    "red, green and blue",
                    still_life,
                    lines(LISTINGS, "target = \"rgba8\"\nbackground = \"plus-z\"\nshow = \"normals\""),
                ),
                Panel::style(
                    "alpha",
                    still_life,
                    lines(LISTINGS, "target = \"rgba8\"\nbackground = \"plus-z\"\nshow = \"depth\""),
                ),
            ],
        },
        Figure {
            name: "chapter-9",
            shows: "Card & Mitchell 2002, figure 9: edges of normals, of depth, and both",
            caption: "Thresholds 0.85 and 0.02, and a far plane twice as far as the farthest point, which halves what a difference counts. Two errors of print are corrected: all four differences of depth count, and the background is no normal.",
            columns: 3,
            panels: vec![
                Panel::style(
                    "normals",
                    objects,
                    lines(&format!("{LISTINGS}\ndepth = false"), "target = \"rgba8\"\nfar = 2.0"),
                ),
                Panel::style(
                    "depth",
                    objects,
                    lines(&format!("{LISTINGS}\nnormals = false"), "target = \"rgba8\"\nfar = 2.0"),
                ),
                Panel::style("both", objects, lines(LISTINGS, "target = \"rgba8\"\nfar = 2.0")),
            ],
        },
        Figure {
            name: "chapter-10",
            shows: "Card & Mitchell 2002, figure 10: how shadow outlines come about",
            caption: "By listings 9 and 10 themselves over the 8-bit target, not by shadow states: normals are negated in shadow, and the border of the side that faces away from the light becomes a line, too. The far ground is so slanted that its differences of depth reach listing 10's threshold. Strokes follow the form, where the chapter lays them by texture coordinates. Panel d has tones that are linear in N·L over some ambient light, where the others have the listing's.",
            columns: 2,
            panels: vec![
                Panel::style(
                    "a: hatched, outlines of objects",
                    still_life,
                    hatched(
                        "normals = \"per-vertex\"",
                        "",
                        &format!("brightness = 7\n[lines.image]\n{LISTINGS}\n{rgba8}"),
                    ),
                ),
                Panel::style(
                    "b: normals, negated in shadow",
                    still_life,
                    shadowed(LISTINGS, "target = \"rgba8\"\nshow = \"normals\""),
                ),
                Panel::style(
                    "c: hatched with shadows, outlines of objects and shadows",
                    still_life,
                    hatched(
                        "normals = \"per-vertex\"",
                        "[shadow]",
                        &format!("brightness = 7\n[lines.image]\n{negated}\n{rgba8}"),
                    ),
                ),
                Panel::style(
                    "d: base colours, and weights at each pixel",
                    still_life,
                    hatched(
                        "",
                        "[shadow]",
                        &format!("ground = \"surface\"\nambient = 0.2\n[lines.image]\n{negated}\n{rgba8}"),
                    ),
                ),
            ],
        },
    ]
}

fn slides() -> Vec<Figure> {
    let still_life = Setting::StillLife;
    let separate = "target = \"separate\"\ndepth-test = \"each\"";
    let negated = "target = \"separate\"\ndepth-test = \"each\"\nnegated-depth = true";
    let shown = |what: &str| format!("{negated}\nshow = \"{what}\"");
    let none = "regions = \"none\"\n";
    let thick = "step = [{ kind = \"dilate\", times = 2 }]";
    let fuzzy = "step = [{ kind = \"soft-cross\" }]";
    vec![
        Figure {
            name: "slides-targets",
            shows: "SIGGRAPH 2002 slides: normals and depth, both negated in shadow, and region IDs",
            caption: "Three targets of one geometry pass. A negated depth needs a format with a sign; it is shown black. \
                      Regions are patches of one material without creases here, numbered; the colours are scattered.",
            columns: 3,
            panels: vec![
                Panel::style("normals", still_life, shadowed(none, &shown("normals"))),
                Panel::style("depth", still_life, shadowed(none, &shown("depth"))),
                Panel::style("regions", still_life, lines("", "target = \"separate\"\nshow = \"regions\"")),
            ],
        },
        Figure {
            name: "slides-plain",
            shows: "SIGGRAPH 2002 slides: normals and depth, and the edges of each, without shadows",
            caption: "What the filters read, and what they find: thresholds 0.80 and 0.01 for each difference.",
            columns: 2,
            panels: vec![
                Panel::style("normals", still_life, lines(none, &format!("{separate}\nshow = \"normals\""))),
                Panel::style("depth", still_life, lines(none, &format!("{separate}\nshow = \"depth\""))),
                Panel::style(
                    "edges of normals",
                    still_life,
                    lines(&format!("{SLIDES}\ndepth = false\n{none}"), "target = \"separate\""),
                ),
                Panel::style(
                    "edges of depth",
                    still_life,
                    lines(&format!("{SLIDES}\nnormals = false\n{none}"), separate),
                ),
            ],
        },
        Figure {
            name: "slides-edges",
            shows: "SIGGRAPH 2002 slides: edges of normals, of depth, and of region IDs",
            caption: "Normals and depth as they are negated in shadow, so that their edges outline shadows too. Thresholds 0.80 and 0.01 for each difference; regions by number, where the slides add up signed differences of colour channels.",
            columns: 3,
            panels: vec![
                Panel::style(
                    "normals",
                    still_life,
                    shadowed(&format!("{SLIDES}\ndepth = false\n{none}"), "target = \"separate\""),
                ),
                Panel::style("depth", still_life, shadowed(&format!("{SLIDES}\nnormals = false\n{none}"), negated)),
                Panel::style("regions", still_life, lines("normals = false\ndepth = false", "target = \"separate\"")),
            ],
        },
        Figure {
            name: "slides-outlines",
            shows: "SIGGRAPH 2002 slides: outlines of objects and of shadows together",
            caption: "All three filters in one pass, over normals and depths that are negated in shadow on the right. The border of the side that faces away from the light becomes a line with them, which the slides' pictures show, too.",
            columns: 2,
            panels: vec![
                Panel::style("objects alone", still_life, lines(SLIDES, separate)),
                Panel::style("objects and shadows", still_life, shadowed(SLIDES, negated)),
            ],
        },
        Figure {
            name: "slides-dilation",
            shows: "SIGGRAPH 2002 slides: thin and dilated, hard and fuzzy",
            caption: "Dilation is the minimum of lightness that the text names, twice over a + of five pixels. Fuzzy dilation is \
                      the shader as it is, which adds up instead: 0.4 of a line for each sample on one. Fuzzy filters \
                      have ramps around their thresholds instead of steps.",
            columns: 2,
            panels: vec![
                Panel::style("thin", still_life, lines(SLIDES, separate)),
                Panel::style("dilated twice", still_life, lines(SLIDES, &format!("{separate}\n{thick}"))),
                Panel::style("fuzzy dilation", still_life, lines(SLIDES, &format!("{separate}\n{fuzzy}"))),
                Panel::style("fuzzy filters", still_life, lines(&format!("{SLIDES}\nsoftness = 0.3"), separate)),
            ],
        },
    ]
}

fn article() -> Vec<Figure> {
    let still_life = Setting::StillLife;
    let bands = "[shade.toon]\nthresholds = [0.05, 0.6]\ntones = [[0.35, 0.33, 0.42], [0.7, 0.69, 0.74], [1, 1, 1]]\n\
                 [shade.toon.highlight]\nthreshold = 0.97\n";
    let painter = style("two-lights").and_then(|style| style.to_toml().ok()).unwrap_or_default();
    let inker = |keys: &str, rest: &str| {
        let table = format!("target = \"rgba8\"\ninker = {{ form = \"explicit\" }}\n{rest}");
        format!("{bands}[lines.image]\n{keys}\n[lines.image.gbuffer]\n{table}\n")
    };
    vec![
        Figure {
            name: "article-1",
            shows: "The Evolution of a Cartoon Renderer, figure 1: interpolated and renormalised normals",
            caption: "Interpolated normals are shorter than 1 between the corners of a triangle, so that bands and highlights pull away from its middle; a normalising cube map, or today an instruction, mends it. Ball and can have ten segments.",
            columns: 3,
            panels: vec![
                Panel::style("interpolated", Setting::Coarse, format!("normals = \"interpolated\"\n{bands}")),
                Panel::style("renormalised", Setting::Coarse, bands),
                Panel::difference([0, 1]),
            ],
        },
        Figure {
            name: "article-2",
            shows: "The Evolution of a Cartoon Renderer, figure 2: the shading texture, and what it does",
            caption: "The first light's N·L runs to the right, the second's downwards. The strip below the texture has the first light's N·L alone. The second light is a lamp here; both of the article's have directions.",
            columns: 2,
            panels: vec![
                Panel::drawn("texture and strip", shading_texture),
                Panel::style("painted", still_life, painter),
            ],
        },
        Figure {
            name: "article-3",
            shows: "The Evolution of a Cartoon Renderer, figure 3: the four directions of artist lines, and the palette",
            caption: "The four vectors lie 45° from the plane of the picture and are 60° and 90° apart, not 45°, which is impossible. Left the colours that an artist paints with, right a scene in which a ball's seams are vertex colours, the bricks a texture through the palette, and the pips regions. Of the two blue cubes one has creases, the other is asked to have no inner lines.",
            columns: 2,
            panels: vec![
                Panel::drawn("palette, with the directions as arrows", palette),
                Panel::style("painted lines", Setting::Painted, "[lines.image]\nartist = true\n"),
            ],
        },
        Figure {
            name: "article-inker",
            shows: "The Evolution of a Cartoon Renderer: the inker",
            caption: "Four diagonal neighbours in two opposite pairs, a threshold of normals that falls with depth, and a \
                      threshold of depth of its own (as printed both are one sum).",
            columns: 2,
            panels: vec![
                Panel::style("ink alone", still_life, lines("", "target = \"rgba8\"\ninker = { form = \"explicit\" }")),
                Panel::style("over the painting", still_life, inker("", "")),
            ],
        },
        Figure {
            name: "article-width",
            shows: "The Evolution of a Cartoon Renderer: the width of lines by the size of the render texture",
            caption: "Lines are one or two pixels wide in the texture that they are found in: half the picture's size \
                      doubles their width, twice the size halves it and smooths them.",
            columns: 3,
            panels: vec![
                Panel::style("half", still_life, inker("scale = \"half\"", "")),
                Panel::style("one", still_life, inker("", "")),
                Panel::style("double", still_life, inker("scale = \"double\"", "")),
            ],
        },
        Figure {
            name: "article-dilation",
            shows: "The Evolution of a Cartoon Renderer: hard and smooth dilation",
            caption: "Four diagonal samples: the darkest of them, or their sum times a threshold, clamped, as the text \
                      has it.",
            columns: 2,
            panels: vec![
                Panel::style("hard", still_life, inker("", "step = [{ kind = \"dilate\", kernel = \"diagonal\" }]")),
                Panel::style(
                    "smooth, threshold 0.25",
                    still_life,
                    inker("", "step = [{ kind = \"soft-diagonal\", threshold = 0.25 }]"),
                ),
            ],
        },
    ]
}

fn tonal_art_map() -> Result<Image, HarnessError> {
    let map = draw(&TamParameters { side: 128, ..TamParameters::default() }, None)?;
    let sheet = sheet::contact(&map.tam);
    let rgba8 = sheet.texels.iter().flat_map(|&gray| [gray, gray, gray, 255]).collect();
    Ok(Image::new(sheet.width, sheet.height, rgba8)?)
}

/// A square of the texture, and below it a strip of its first row.
fn shading_texture() -> Result<Image, HarnessError> {
    const SIDE: u32 = 224;
    const STRIP: u32 = 32;
    let Some(Shade::Painter(painter)) = style("two-lights").map(|style| style.shade) else {
        return Ok(Image::filled(1, 1, [255; 4]));
    };
    let mut image = Image::filled(SIDE, SIDE + STRIP + 8, [255; 4]);
    let at = |v: u32| (f64::from(v) + 0.5) / f64::from(SIDE);
    let color = |first: f64, second: f64| {
        let color = match &painter.ramp {
            Ramp2dSource::Ramps(ramps) => toon_ramp_2d(ramps, DVec2::new(first, second), DVec2::ZERO),
            Ramp2dSource::Image(table) => toon_table(table, DVec2::new(first, second)),
        };
        let [r, g, b] = color.to_array().map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
        [r, g, b, 255]
    };
    for x in 0..SIDE {
        for y in 0..SIDE {
            image.set_pixel(x, y, color(at(x), at(y)));
        }
        for y in 0..STRIP {
            image.set_pixel(x, SIDE + 8 + y, color(at(x), 0.0));
        }
    }
    Ok(image)
}

/// The 2 × 2 palette, each cell with its direction's arrow in the plane of the picture.
fn palette() -> Result<Image, HarnessError> {
    const CELL: u32 = 128;
    let mut image = Image::filled(2 * CELL, 2 * CELL, [255; 4]);
    for index in 0..4u32 {
        let color = artist_color(index).to_array().map(|c| (c * 255.0).round() as u8);
        let (left, top) = (index % 2 * CELL, index / 2 * CELL);
        let direction = ink_artist_vector(index);
        let middle = DVec2::splat(f64::from(CELL) / 2.0);
        // y of a picture points down.
        let along = DVec2::new(f64::from(direction.x), -f64::from(direction.y)).normalize();
        for y in 0..CELL {
            for x in 0..CELL {
                let from = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) - middle;
                let (forth, aside) = (from.dot(along), from.perp_dot(along).abs());
                let shaft = (-36.0..24.0).contains(&forth) && aside < 3.0;
                let head = (24.0..44.0).contains(&forth) && aside < (44.0 - forth) * 0.6;
                let [r, g, b] = if shaft || head { [20; 3] } else { color };
                image.set_pixel(left + x, top + y, [r, g, b, 255]);
            }
        }
    }
    Ok(image)
}
