//! Systems of the documents that have no figure of their own in print.

use super::{BANDS, Figure, Panel, Setting, lines};

const SHINY: &str = "[shade.toon]\nthresholds = [0.05, 0.6]\ntones = [[0.35, 0.33, 0.42], [0.7, 0.69, 0.74], [1, 1, 1]]\n\
                     [shade.toon.highlight]\nthreshold = 0.97\n";
const THREE_LAMPS: &str = "[[light]]\nposition = [-1.0, 0.5, 0.4]\ncolor = [1.0, 0.55, 0.4]\n\
                           [[light]]\nposition = [0.0, 0.9, 0.5]\n\
                           [[light]]\nposition = [1.0, 0.5, 0.4]\ncolor = [0.4, 0.6, 1.0]\n\
                           [shade.painter.first]\nat = [0.1, 0.6]\ncolors = [[0.35, 0.33, 0.42], [0.8, 0.8, 0.8]]\n\
                           [shade.painter.second]\nat = [0.1, 0.6]\ncolors = [[0.35, 0.33, 0.42], [0.8, 0.8, 0.8]]\n";

/// The figures.
pub fn variants() -> Vec<Figure> {
    let (still_life, objects) = (Setting::StillLife, Setting::Objects);
    let depth = |format: &str| {
        let keys = "normals = false\nregions = \"none\"\ndepth-step = 0.002";
        lines(keys, &format!("target = \"separate\"\ndepth-test = \"each\"\nfar = 20.0\ndepth-format = \"{format}\""))
    };
    let ramp = |blend: &str| {
        format!(
            "[shade.ramp.stops]\nat = [-1.0, 0.05, 0.6]\ncolors = [[0.35, 0.33, 0.42], [0.7, 0.69, 0.74], [1, 1, 1]]\nblend = \
             \"{blend}\"\n"
        )
    };
    let half_lambert = "[shade.ramp.stops]\nat = [0.0, 0.5, 1.0]\ncolors = [[0.3, 0.28, 0.4], [0.7, 0.69, 0.74], [1, 1, 1]]\n\
                        blend = \"smooth\"\n[shade.ramp.half-lambert]\n";
    let kinds = |kinds: &str| format!("shade = \"paper\"\n[lines.edges]\n{kinds}\n");
    let taps = |step: i32| {
        lines(&format!("depth = false\ntaps = [[{step}, {step}], [-{step}, {step}]]"), "target = \"separate\"")
    };
    let artist = |turned: &str| format!("{BANDS}[lines.image]\nartist = \"{turned}\"\n");
    let stepped = |step: &str| lines("", &format!("target = \"separate\"\nstep = [{step}]"));
    vec![
        Figure {
            name: "variants-bands",
            shows: "Bands with hard and with antialiased borders, a smooth ramp, and half-Lambert light",
            caption: "A ramp of colours by N·L: steps as a texture without filtering gives them, steps with the width of \
                      a pixel, and linear interpolation; half-Lambert scales and biases N·L first, so that no side is \
                      wholly dark.",
            columns: 2,
            panels: vec![
                Panel::style("hard", still_life, format!("{BANDS}antialias = false\n")),
                Panel::style("antialiased", still_life, BANDS),
                Panel::style("smooth", still_life, ramp("smooth")),
                Panel::style("half-Lambert", still_life, half_lambert),
            ],
        },
        Figure {
            name: "variants-light",
            shows: "Light for each polygon, each subdivided face, each vertex and each pixel",
            caption: "A coarse ball and can. Of one value for a polygon its shape is seen; subdivided faces approach light \
                      at pixels; light at vertices misses a highlight within a face.",
            columns: 2,
            panels: vec![
                Panel::style("polygons", Setting::Coarse, format!("normals = \"per-face\"\n{SHINY}")),
                Panel::style(
                    "faces subdivided by 6",
                    Setting::Coarse,
                    format!("normals = {{ per-subdivided-face = 6 }}\n{SHINY}"),
                ),
                Panel::style("vertices", Setting::Coarse, format!("normals = \"per-vertex\"\n{SHINY}")),
                Panel::style("pixels", Setting::Coarse, SHINY),
            ],
        },
        Figure {
            name: "variants-lights",
            shows: "The painter's two lights chosen for each object",
            caption: "Three lamps in a row. Each teapot takes the two that matter most to it: the left one is lit from the \
                      left and the middle, the right one from the middle and the right.",
            columns: 1,
            panels: vec![Panel::style("three lamps, two teapots", Setting::TwoTeapots, THREE_LAMPS)],
        },
        Figure {
            name: "variants-lines",
            shows: "Lines along edges by kind: silhouettes, creases, all",
            caption: "Each kind has a width of its own, constant on the screen; what is hidden is left out.",
            columns: 3,
            panels: vec![
                Panel::style("silhouettes", objects, kinds("crease-px = 0\nboundary-px = 0")),
                Panel::style("creases", objects, kinds("silhouette-px = 0\nboundary-px = 0")),
                Panel::style("all", objects, kinds("silhouette-px = 3\ncrease-px = 1")),
            ],
        },
        Figure {
            name: "variants-hull",
            shows: "The inverted hull, beside lines along edges and printed fins",
            caption: "Back faces of the model, grown by the width, as most games draw outlines: no creases, and gaps at \
                      hard edges with the normals of vertices, which welded normals close.",
            columns: 2,
            panels: vec![
                Panel::style("welded normals", objects, format!("{BANDS}[lines.hull]\nwidth-px = 5\n")),
                Panel::style(
                    "normals of vertices",
                    objects,
                    format!("{BANDS}[lines.hull]\nwidth-px = 5\nnormals = \"vertices\"\n"),
                ),
                Panel::style("fins of listing 1", objects, format!("{BANDS}[lines.printed]\nwidth-px = 5\n")),
                Panel::style("lines along edges", objects, format!("{BANDS}[lines.edges]\nsilhouette-px = 5\n")),
            ],
        },
        Figure {
            name: "variants-depth",
            shows: "Depth of 8, 16 and 32 bits, and floats, feeding the filter of depth",
            caption: "The far plane is twenty times as far as the farthest point, and the threshold 0.002 of the range. A step of 8 bits is 0.0039 of it, so that slanted surfaces are ink wherever a code ends. From 16 bits on no code is as coarse as the threshold, and the pictures are the same.",
            columns: 2,
            panels: vec![
                Panel::style("8 bits", objects, depth("8-bit")),
                Panel::style("16 bits", objects, depth("16-bit")),
                Panel::style("four channels of 8 bits", objects, depth("packed-4x8")),
                Panel::style("float", objects, depth("float")),
            ],
        },
        Figure {
            name: "variants-taps",
            shows: "Taps of a filter at 1, 2 and 4 px",
            caption: "The offsets of the texture coordinates in the inker's vertex program decide how wide a line is, and \
                      how small a detail may be.",
            columns: 3,
            panels: vec![
                Panel::style("1 px", objects, taps(1)),
                Panel::style("2 px", objects, taps(2)),
                Panel::style("4 px", objects, taps(4)),
            ],
        },
        Figure {
            name: "variants-morphology",
            shows: "Erosion, opening, closing, and steps of dilation with three kernels",
            caption: "Lines of one and two pixels are broken by an erosion; closing fills what is narrower than its kernel. Repeated, a + grows to a diamond, diagonals and a square to a square.",
            columns: 3,
            panels: vec![
                Panel::style("eroded by a +", objects, stepped("{ kind = \"erode\", kernel = \"cross\" }")),
                Panel::style("opened by a +", objects, stepped("{ kind = \"open\", kernel = \"cross\" }")),
                Panel::style(
                    "closed by a square, 4",
                    objects,
                    stepped("{ kind = \"close\", kernel = \"square\", times = 4 }"),
                ),
                Panel::style(
                    "dilated by a +, 3",
                    objects,
                    stepped("{ kind = \"dilate\", kernel = \"cross\", times = 3 }"),
                ),
                Panel::style(
                    "by diagonals, 3",
                    objects,
                    stepped("{ kind = \"dilate\", kernel = \"diagonal\", times = 3 }"),
                ),
                Panel::style(
                    "by a square, 3",
                    objects,
                    stepped("{ kind = \"dilate\", kernel = \"square\", times = 3 }"),
                ),
            ],
        },
        Figure {
            name: "variants-primitives",
            shows: "Independence from primitives: rounded patches, surfaces that pass through each other, a clip plane",
            caption: "Lines in the image need no edges: where a ball made of PN triangles passes through a cube, and where \
                      a plane cuts both, there is a line.",
            columns: 2,
            panels: vec![
                Panel::style("lines along edges", Setting::Crossing, format!("{BANDS}[lines.edges]\n")),
                Panel::style("lines in the image", Setting::Crossing, format!("{BANDS}[lines.image]\n")),
                Panel::style("cut by a plane", Setting::Clipped, format!("{BANDS}[lines.image]\n")),
                Panel::style("cut by the near plane", Setting::NearCut, format!("{BANDS}[lines.image]\n")),
            ],
        },
        Figure {
            name: "variants-artist",
            shows: "Artist lines with directions turned for each pixel, each vertex and each object",
            caption: "Printed are turns for vertices, for their colours, and for objects, for a texture through the palette. All \
                      three find the same lines here: a turn moves the four directions alike, and painted areas differ as \
                      before. Only the border against a surface with normals of its own is lost where an object is near \
                      and turned as a whole: within 7.1 of its radii for the threshold 0.8.",
            columns: 3,
            panels: vec![
                Panel::style("pixels", Setting::Painted, artist("per-pixel")),
                Panel::style("vertices", Setting::Painted, artist("per-vertex")),
                Panel::style("objects", Setting::Painted, artist("per-object")),
            ],
        },
        Figure {
            name: "variants-cut-out",
            shows: "Alpha-tested materials: lines around what remains",
            caption: "A pixel below the reference is discarded from every target of the geometry pass, so that all filters \
                      see what lies behind it.",
            columns: 2,
            panels: vec![
                Panel::style("ink alone", Setting::CutOut, lines("", "target = \"separate\"")),
                Panel::style("over the surfaces", Setting::CutOut, format!("{BANDS}[lines.image]\n")),
            ],
        },
    ]
}
