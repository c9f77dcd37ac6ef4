//! Errata that have two forms that run: pairs with equal parameters in which only the erratum differs.

use super::{BANDS, Content, FROM_THE_LEFT, Figure, Panel, Setting};

/// A pair, or three readings, of an erratum.
#[derive(Clone, Debug)]
pub struct Erratum {
    /// Its number in the list of errata; see `docs/errata.md`.
    pub number: u32,
    /// As printed, corrected, and where they differ; for three readings the third as well.
    pub figure: Figure,
}

impl Erratum {
    /// Another panel of the same setting, after the difference.
    fn and(mut self, legend: &'static str, toml: String) -> Self {
        if let Some(&Panel { content: Content::Style { setting, .. }, .. }) = self.figure.panels.first() {
            self.figure.panels.push(Panel::style(legend, setting, toml));
        }
        self
    }
}

fn pair(
    number: u32,
    name: &'static str,
    shows: &'static str,
    caption: &'static str,
    setting: Setting,
    [printed, corrected]: [String; 2],
) -> Erratum {
    let panels = vec![
        Panel::style("as printed", setting, printed),
        Panel::style("corrected", setting, corrected),
        Panel::difference([0, 1]),
    ];
    Erratum { number, figure: Figure { name, shows, caption, columns: 3, panels } }
}

/// The errata, in the order of their numbers. The others of the list have no second form that runs, or are choices; see
/// `docs/errata.md`.
pub fn errata() -> Vec<Erratum> {
    let (still_life, objects) = (Setting::StillLife, Setting::Objects);
    let fins = |keys: &str| format!("shade = \"paper\"\n[lines.printed]\n{keys}\n");
    let listings = |keys: &str, gbuffer: &str| {
        format!(
            "shade = \"paper\"\n[lines.image]\nnormal-cos = 0.85\ndepth-step = 0.02\n{keys}\n[lines.image.gbuffer]\ntarget = \
             \"rgba8\"\nfar = 2.0\n{gbuffer}\n"
        )
    };
    let composited = |test: &str, gbuffer: &str| {
        let composite = format!("composite = {{ alpha-tested = {test} }}");
        format!(
            "{BANDS}[lines.image]\nnormal-cos = 0.85\ndepth-step = 0.02\n{composite}\n[lines.image.gbuffer]\ntarget = \
             \"rgba8\"\nfar = 2.0\n{gbuffer}\n"
        )
    };
    let inker = |form: &str| {
        format!(
            "shade = \"paper\"\n[lines.image.gbuffer]\ntarget = \"rgba8\"\nfar = 2.0\ninker = {{ form = \"{form}\" }}\n"
        )
    };
    let stepped = |step: &str| listings("", &format!("step = [{step}]"));
    let shadowed = |shadows: &str| format!("{FROM_THE_LEFT}[shadow]\n{BANDS}[lines.image]\nshadows = \"{shadows}\"\n");
    let ridge = |shadows: &str| {
        let light = "[[light]]\nframe = \"world\"\ndirection = [-1.0, 0.6, 0.4]\n";
        let keys = "depth = false\nregions = \"one\"";
        format!("shade = \"paper\"\n{light}[shadow]\n[lines.image]\nshadows = \"{shadows}\"\n{keys}\n")
    };
    let hatched = |brightness: u32| {
        format!("[shade.hatch]\nencoding = \"six-tones\"\nmapping = \"form\"\nbrightness = {brightness}\n")
    };
    let gooch = |tones: &str| format!("[[light]]\ndirection = [-0.7, 0.6, 0.3]\n[shade.gooch]\ntones = \"{tones}\"\n");
    let regions = |test: &str| {
        let gbuffer = format!("target = \"separate\"\nregion-test = \"{test}\"");
        format!(
            "shade = \"paper\"\n[lines.image]\nnormals = false\ndepth = false\nregions = \
             \"mesh\"\n[lines.image.gbuffer]\n{gbuffer}\n"
        )
    };
    let spaces = |space: &str| {
        format!("normal-space = \"{space}\"\n[[light]]\nframe = \"world\"\ndirection = [-0.6, 0.8, 0.5]\n{BANDS}")
    };

    let alpha = pair(
        9,
        "erratum-9",
        "Chapter, alpha test: GREATER and 0, or LESS and 128; and the co-issued reading",
        "To discard the white pixels of the edge image alpha must be less than the reference. GREATER keeps them and discards the lines, and the reference, (DWORD) 0.5f, is 0. If both halves of a co-issued pair of instructions read before either writes, listing 10's alpha is its sum less the threshold, and GREATER then keeps the edges of depth; of those of normals it keeps what the last tap alone finds.",
        objects,
        [composited("{ less = false, reference = 0 }", ""), composited("{ less = true, reference = 128 }", "")],
    );
    let co_issued = composited("{ less = false, reference = 0 }", "co-issued = true");
    let alpha = alpha.and("as printed, co-issued", co_issued);

    vec![
        pair(
            1,
            "erratum-1",
            "Chapter, listing 1: width from clip z, or from w",
            "Clip z is 0 at the near plane and grows towards w behind it: fins get thinner towards the viewer. Here the \
             near plane lies at half the distance, so that the fault can be seen; with one a thousandth of the distance \
             away the widths differ by a thousandth.",
            Setting::NearPlane,
            [fins("width-px = 4"), fins("width-px = 4\ndepth = \"eye\"")],
        ),
        pair(
            2,
            "erratum-2",
            "Chapter, text on listing 1: the offset is zero where the product is below zero, or elsewhere",
            "The text has the reverse of the listing: all edges have width but the silhouettes.",
            still_life,
            [fins("reversed = true"), fins("")],
        ),
        pair(
            3,
            "erratum-3",
            "Chapter, silhouette test: normals rounded to bytes, each vertex by itself",
            "A rounded normal is not perpendicular to its face, and the two ends of an edge can disagree: half a fin is \
             left, or one is drawn that is no silhouette. Corrected here are the normals alone; lines along edges are \
             classified once for an edge.",
            Setting::Cans,
            [fins("normals = \"byte\"\nwidth-px = 3"), fins("width-px = 3")],
        )
        .and("as shorts", fins("normals = \"short\"\nwidth-px = 3")),
        pair(
            6,
            "erratum-6",
            "Chapter, listing 4: a light factor of six, or of seven",
            "The weights of the six tones sum to 1 up to a factor of 6, and to less above it, down to 0 at 7, which is \
             paper. With six nothing becomes white, and tones are darker than N·L.",
            still_life,
            [hatched(6), hatched(7)],
        ),
        pair(
            7,
            "erratum-7",
            "Chapter, listing 7: shares of the surface's colour swapped between cool and warm",
            "The listing adds alpha times the colour to yellow and beta times it to blue; the equation, like Gooch et al. \
             1998, has them the other way round.",
            still_life,
            [gooch("swapped-shares"), gooch("equation")],
        ),
        pair(
            8,
            "erratum-8",
            "Chapter, listing 10: the first and the last difference of depth, or all four",
            "The accumulating additions overwrite each other's result, so that only two of the four differences count.",
            objects,
            [listings("normals = false", "depth-test = \"sum-printed\""), listings("normals = false", "")],
        ),
        alpha,
        pair(
            10,
            "erratum-10",
            "Slides, region IDs: sums of colour channels, or numbers",
            "The signed differences of the channels are added up, so that two colours with one sum are one region. Each \
             tile is a region here, and neither normals nor depths differ.",
            Setting::Tiles,
            [regions("color-sums"), regions("numbers")],
        ),
        pair(
            12,
            "erratum-12",
            "Article, listing 4: one difference of depth squared, or two thresholds",
            "Only the first difference of depth is squared, and both are added to the difference of normals before one threshold. So the sign of the second difference decides, and surfaces that curve away a little, which neither test would take, become ink where depth rises: the ring. Corrected: a threshold for normals and one for depth.",
            objects,
            [inker("printed"), inker("explicit")],
        ),
        {
            let mut erratum = pair(
                12,
                "erratum-12-added",
                "Article, listing 4: the missing instruction added, or two thresholds",
                "With both differences squared the constants sum to the threshold, and every difference of depth is ink: \
                 8-bit rounding hid that in 2002.",
                objects,
                [inker("corrected"), inker("explicit")],
            );
            erratum.figure.panels[0].legend = "instruction added";
            erratum
        },
        pair(
            13,
            "erratum-13",
            "Article, listing 5: smooth dilation by two samples, or by four",
            "The comment combines four samples with a threshold and a clamp; the program reads two and does not clamp.",
            objects,
            [
                stepped("{ kind = \"soft-diagonal-printed\", threshold = 0.25 }"),
                stepped("{ kind = \"soft-diagonal\", threshold = 0.25 }"),
            ],
        ),
        pair(
            14,
            "erratum-14",
            "Slides, dilation: the shader's soft one, or the text's minimum",
            "The shader adds five samples up: one on a line gives 0.4 of a line, two 0.8, three a whole one. The text's \
             dilation is the darkest of the five.",
            objects,
            [stepped("{ kind = \"soft-cross\" }"), stepped("{ kind = \"dilate\", kernel = \"cross\" }")],
        ),
        pair(
            15,
            "erratum-15",
            "Chapter, clear colour +z, or no normal",
            "In a right-handed space +z points at a viewer who looks along -z: what faces that viewer has no edge of \
             normals against the background. Only normals are compared here.",
            Setting::Front,
            [listings("depth = false", "background = \"plus-z\""), listings("depth = false", "")],
        ),
        pair(
            16,
            "erratum-16",
            "Chapter, listings 2, 4, 6 and 8: normals as they are in the vertex buffer, or in world space",
            "They are in world space only where the model's matrix is the identity. The right teapot lies on its side and \
             is lit as if it stood; the left one is only moved, which does not change a normal.",
            Setting::TwoTeapots,
            [spaces("mesh"), spaces("world")],
        ),
        pair(
            18,
            "erratum-18",
            "Chapter and slides, shadow outlines: negated normals, or a state beside the region",
            "Negated normals make a line of the border of the side that faces away from the light. A state in two bits does not.",
            still_life,
            [shadowed("negated"), shadowed("lines")],
        ),
        pair(
            18,
            "erratum-18-ridge",
            "Chapter and slides, shadow outlines: a ridge between a lit and a shadowed side",
            "A sharp wedge points at the viewer, with its right side in shadow. The negated normal of that side is nearly the \
             normal of the lit one, and the line between them vanishes. Only normals are compared.",
            Setting::Wedge,
            [ridge("negated"), ridge("lines")],
        ),
    ]
}
