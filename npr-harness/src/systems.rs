//! Every system of the three documents: where its code is, how a style asks for it, and what shows and proves it.

use std::fmt::Write;

/// A system of the documents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct System {
    /// Its number.
    pub number: u32,
    /// What it is.
    pub what: &'static str,
    /// The document: CM is Card & Mitchell's chapter, CR the article on a cartoon renderer, OS the slides on outlining.
    pub source: &'static str,
    /// The file of its code, from the workspace's root, and the function or type in it.
    pub code: (&'static str, &'static str),
    /// The key of a style file that asks for it, or why there is none.
    pub key: Result<&'static str, &'static str>,
    /// The figure of `npr figures` that shows it.
    pub figure: &'static str,
    /// The file of a test of it, from the workspace's root, and the test in it.
    pub test: (&'static str, &'static str),
}

const fn row(
    number: u32,
    source: &'static str,
    what: &'static str,
    code: (&'static str, &'static str),
    key: Result<&'static str, &'static str>,
    figure: &'static str,
    test: (&'static str, &'static str),
) -> System {
    System { number, what, source, code, key, figure, test }
}

const CONTOUR: &str = "npr-outline/src/contour/tests.rs";
const FIN: &str = "npr-outline/src/fin_printed.rs";
const FINS: &str = "npr-outline/src/fin_printed/tests.rs";
const FILTER: &str = "npr-imagespace/tests/filter.rs";
const WEIGHTS: &str = "npr-hatch/tests/weights.rs";
const INK: &str = "npr-harness/tests/image_ink.rs";

/// The systems, in the order of their numbers.
pub const SYSTEMS: [System; 45] = [
    row(
        1,
        "CM",
        "unique edges with two face normals each; the negated normal where there is one face",
        ("npr-mesh/src/edges.rs", "find"),
        Err("every style with lines along edges has them"),
        "variants-lines",
        (FINS, "a_boundary_has_the_negated_normal"),
    ),
    row(
        2,
        "CM, figure 2",
        "a fin for each edge: four vertices, displaced where the smooth normal is not zero",
        (FIN, "printed_fins"),
        Ok("[lines.printed]"),
        "erratum-1",
        (FINS, "a_cube_has_four_vertices_and_two_triangles_an_edge"),
    ),
    row(
        3,
        "CM, listing 1",
        "silhouettes by the product of two dot products, in the vertex shader",
        (FIN, "fin_printed_triangles"),
        Ok("[lines.printed]"),
        "erratum-2",
        (FINS, "the_listing_draws_silhouettes_and_neither_creases_nor_edges_seen_edge_on"),
    ),
    row(
        4,
        "CM, listing 1",
        "width from depth, so that lines keep their width on the screen",
        (FIN, "fin_printed_depth"),
        Ok("depth"),
        "erratum-1",
        (FINS, "width_is_as_asked_with_w_and_too_small_as_printed"),
    ),
    row(
        5,
        "CM",
        "hidden lines by a depth test against the shaded scene",
        ("npr-outline/src/segment.rs", "outline_is_visible"),
        Ok("[lines.edges]"),
        "chapter-1",
        ("npr-harness/src/truth/lines/tests.rs", "a_box_behind_a_wall_is_not_seen"),
    ),
    row(
        6,
        "CM",
        "face normals as byte and short tuples",
        ("npr-outline/src/normal_format.rs", "NormalFormat"),
        Ok("normals"),
        "erratum-3",
        ("npr-outline/src/normal_format/tests.rs", "fewer_bits_misclassify_more_edges"),
    ),
    row(
        7,
        "CM",
        "creases as a part of the outline",
        ("npr-outline/src/contour.rs", "ContourOptions"),
        Ok("crease-px"),
        "variants-lines",
        (CONTOUR, "the_crease_angle_decides"),
    ),
    row(
        8,
        "CM, future work",
        "screen-aligned fins",
        ("npr-outline/src/segment.rs", "outline_project"),
        Ok("[lines.edges]"),
        "variants-hull",
        ("npr-outline/src/segment/tests.rs", "the_width_is_the_same_all_along_a_receding_segment"),
    ),
    row(
        9,
        "CM, listings 2 and 3",
        "bands of N·L, any number of thresholds and colours; hard shading",
        ("npr-toon/src/bands.rs", "Bands"),
        Ok("[shade.toon]"),
        "chapter-3-4",
        ("npr-toon/tests/light.rs", "listing_3_at_its_thresholds"),
    ),
    row(
        10,
        "CM, text",
        "a specular band of N·H",
        ("npr-toon/src/light.rs", "toon_n_dot_h"),
        Ok("highlight.threshold"),
        "chapter-3-4",
        ("npr-toon/tests/light.rs", "highlight_replaces_the_band"),
    ),
    row(
        11,
        "CM, CR",
        "a 1D ramp texture, with antialiased transitions",
        ("npr-toon/src/ramp.rs", "Ramp"),
        Ok("[shade.ramp]"),
        "variants-bands",
        ("npr-toon/tests/ramp.rs", "an_antialiased_ramp_keeps_the_mean"),
    ),
    row(
        12,
        "CR, listings 1 and 2",
        "a 2D shade texture indexed by two lights, scaled by their brightness",
        ("npr-toon/src/table.rs", "toon_table"),
        Ok("[shade.painter]"),
        "article-2",
        ("npr-toon/tests/painter.rs", "listing_2_by_hand"),
    ),
    row(
        13,
        "CR, figure 1",
        "normals renormalised at each pixel, against interpolated ones",
        ("npr-toon/src/normal.rs", "NormalUse"),
        Ok("normals"),
        "article-1",
        ("npr-toon/tests/border.rs", "interpolated_normals_are_too_short"),
    ),
    row(
        14,
        "CR, listing 2",
        "material colour or texture by alpha; one light colour; × 0.75, then × 2",
        ("npr-toon/src/painter.rs", "toon_material"),
        Ok("material-by-alpha"),
        "article-2",
        ("npr-toon/tests/painter.rs", "alpha_chooses_the_colour_or_the_texture"),
    ),
    row(
        15,
        "CM (Praun et al. 2001)",
        "tonal art maps: tones × mips, nested strokes, toroidal",
        ("npr-hatch/src/draw.rs", "draw"),
        Ok("[shade.hatch.map]"),
        "chapter-5-6",
        ("npr-hatch/tests/tam.rs", "strokes_are_nested_in_tones_and_in_mips"),
    ),
    row(
        16,
        "CM, listing 4",
        "six weights from N·L, the darkest clamped in full shadow",
        ("npr-hatch/src/weights.rs", "hatch_weights"),
        Ok("brightness"),
        "erratum-6",
        (WEIGHTS, "weights_are_the_listings"),
    ),
    row(
        17,
        "CM, listing 5",
        "two packed textures blended by the weights",
        ("npr-hatch/src/weights.rs", "hatch_blend"),
        Ok("encoding"),
        "chapter-5-6",
        (WEIGHTS, "blends_as_listing_5_does"),
    ),
    row(
        18,
        "CM, figure 10d",
        "weights at vertices, and at pixels",
        ("npr-harness/src/hatch/plan.rs", "HatchPlan"),
        Ok("normals"),
        "chapter-10",
        ("npr-harness/tests/hatch_truth.rs", "spheres_have_the_tone_that_is_asked_for"),
    ),
    row(
        19,
        "CM, figure 10d",
        "coloured hatching over a base texture",
        ("npr-harness/src/hatch/style.rs", "HatchGround"),
        Ok("ground"),
        "chapter-10",
        (WEIGHTS, "thresholds_and_colors"),
    ),
    row(
        20,
        "CM, listings 6 and 7",
        "Gooch cool to warm, and the highlight that the text keeps clear",
        ("npr-gooch/src/shade.rs", "gooch_shade"),
        Ok("[shade.gooch]"),
        "chapter-7",
        ("npr-gooch/tests/shade.rs", "the_equation_by_hand"),
    ),
    row(
        21,
        "CM",
        "half-Lambert scale and bias of N·L, from one aggregate light",
        ("npr-toon/src/half_lambert.rs", "toon_half_lambert"),
        Ok("half-lambert.scale"),
        "variants-bands",
        ("npr-toon/tests/painter.rs", "half_lambert_by_hand"),
    ),
    row(
        22,
        "CM, listing 8",
        "world normals and eye depth in one RGBA8 target, cleared to +z",
        ("npr-imagespace/src/format/printed.rs", "ink_printed_encode"),
        Ok("background"),
        "chapter-8",
        ("npr-imagespace/tests/format.rs", "the_printed_target_and_its_clear_values"),
    ),
    row(
        23,
        "CR, OS",
        "several render targets in one geometry pass",
        ("npr-harness/src/gpu/surface.rs", "SurfaceTargets"),
        Err("a plan takes one pass wherever picture and lines have one size (`--plan`)"),
        "slides-targets",
        (INK, "the_device_packs_what_the_reference_packs"),
    ),
    row(
        24,
        "CM, listing 9; OS",
        "the filter of normals, five taps",
        ("npr-imagespace/src/filter/normal.rs", "ink_normal_bytes_edge"),
        Ok("normal-cos"),
        "chapter-9",
        (FILTER, "normals_at_the_two_thresholds"),
    ),
    row(
        25,
        "CM, listing 10; OS",
        "the filter of depth, five taps",
        ("npr-imagespace/src/filter/depth.rs", "ink_depth_plain_codes"),
        Ok("depth-test"),
        "chapter-9",
        (FILTER, "listing_10_counts_two_of_four"),
    ),
    row(
        26,
        "OS",
        "the filter of region IDs, five taps",
        ("npr-imagespace/src/filter/region.rs", "ink_region"),
        Ok("regions"),
        "slides-edges",
        (FILTER, "signed_sums_do_not_distinguish_red_from_green"),
    ),
    row(
        27,
        "OS",
        "the three filters in one pass",
        ("npr-imagespace/src/filter/fused.rs", "ink_fused"),
        Ok("[lines.image]"),
        "slides-outlines",
        (FILTER, "the_fused_filter_is_its_formula"),
    ),
    row(
        28,
        "CM",
        "multiplicative composite, and the alpha test that skips white pixels",
        ("npr-imagespace/src/composite.rs", "ink_composite"),
        Ok("composite.alpha-tested.less"),
        "erratum-9",
        ("npr-imagespace/tests/composite.rs", "the_printed_alpha_test_discards_the_lines"),
    ),
    row(
        29,
        "CM",
        "precision of depth: 8 bits, spread over channels, higher formats",
        ("npr-imagespace/src/format/depth.rs", "DepthFormat"),
        Ok("depth-format"),
        "variants-depth",
        ("npr-imagespace/tests/format.rs", "depths_a_gap_apart_are_told_apart_and_half_a_gap_are_not"),
    ),
    row(
        30,
        "CR, listings 3 and 4",
        "the inker: opposite pixels compared in pairs, a threshold of normals that falls with depth",
        ("npr-imagespace/src/filter/inker.rs", "ink_inker"),
        Ok("inker"),
        "article-inker",
        (FILTER, "the_inker_and_its_two_errors"),
    ),
    row(
        31,
        "CR",
        "artist lines from vertex colours: four directions that face away from the viewer",
        ("npr-imagespace/src/artist.rs", "ink_artist_direction"),
        Ok("artist"),
        "variants-artist",
        ("npr-imagespace/tests/artist.rs", "no_visible_normal_is_within_45_degrees_wherever_a_point_is_seen"),
    ),
    row(
        32,
        "CR",
        "artist lines from a texture, rotated for an object",
        ("npr-imagespace/src/artist.rs", "ink_artist_texel"),
        Ok("artist"),
        "variants-artist",
        ("npr-imagespace/tests/artist.rs", "directions_rotated_once_for_an_object_fail_near_it_as_the_formula_says"),
    ),
    row(
        33,
        "CR",
        "the kind of line chosen for each material",
        ("npr-imagespace/src/artist.rs", "LineKind"),
        Err("a scene's materials say it: `--inner-lines MATERIAL=KIND`"),
        "article-3",
        (INK, "artists_lines_are_where_they_are_painted_and_nowhere_else"),
    ),
    row(
        34,
        "CR",
        "alpha-tested materials: lines around what remains",
        ("npr-imagespace/src/artist.rs", "ink_alpha_kept"),
        Err("a model's materials say it"),
        "variants-cut-out",
        (INK, "what_alpha_leaves_has_lines_around_it"),
    ),
    row(
        35,
        "CR",
        "line width from the size of the render texture",
        ("npr-harness/src/image_lines/style.rs", "InkScale"),
        Ok("scale"),
        "article-width",
        (INK, "larger_and_smaller_ink_are_as_wide_as_they_should_be"),
    ),
    row(
        36,
        "CM, CR listing 5, OS",
        "dilation hard and smoothed, erosion, n steps by ping-pong",
        ("npr-imagespace/src/morphology.rs", "ping_pong"),
        Ok("[[…step]]"),
        "variants-morphology",
        ("npr-imagespace/tests/morphology.rs", "a_step_is_the_extreme_of_its_kernel"),
    ),
    row(
        37,
        "OS",
        "fuzzy edge filters and morphology",
        ("npr-imagespace/src/filter.rs", "ink_ramp"),
        Ok("softness"),
        "slides-dilation",
        (FILTER, "soft_normals_rise_from_paper_to_a_line"),
    ),
    row(
        38,
        "CM figure 10, OS",
        "stencil shadow volumes; shadow outlines from negated normals and depths",
        ("npr-outline/src/shadow_volume.rs", "ShadowCasters"),
        Ok("shadows"),
        "slides-outlines",
        ("npr-outline/src/shadow_volume/tests.rs", "volumes_of_any_triangles_count_the_faces_before_the_light"),
    ),
    row(
        39,
        "CM, figure 10c",
        "the densest hatch inside shadows",
        ("npr-hatch/src/weights.rs", "hatch_tone_in_shadow"),
        Ok("[shadow]"),
        "chapter-10",
        (WEIGHTS, "shadows_have_the_darkest_tone"),
    ),
    row(
        40,
        "CM",
        "independence from primitives: N-patches, interpenetrating parts, clip planes, the near plane",
        ("npr-mesh/src/pn_triangles.rs", "tessellate"),
        Err("`--segments` and `--clip`"),
        "variants-primitives",
        (INK, "surfaces_that_pass_through_each_other_meet_in_a_line"),
    ),
    row(
        41,
        "CR",
        "two lights chosen for each mesh",
        ("npr-harness/src/lights.rs", "LightPair"),
        Ok("[[light]]"),
        "variants-lights",
        ("npr-harness/tests/light_pairs.rs", "each_object_has_the_lights_that_matter_most_to_it"),
    ),
    row(
        42,
        "CR",
        "light for each polygon and for each subdivided face, beside vertices and pixels",
        ("npr-toon/src/normal.rs", "NormalUse"),
        Ok("per-subdivided-face"),
        "variants-light",
        ("npr-harness/tests/light_faces.rs", "each_face_has_the_one_tone_of_its_plane"),
    ),
    row(
        43,
        "CR, listing 3",
        "offsets of the filters' taps",
        ("npr-imagespace/src/picture.rs", "Taps"),
        Ok("taps"),
        "variants-taps",
        (FILTER, "taps_lie_where_their_arrangement_says"),
    ),
    row(
        44,
        "CR, OS",
        "the alpha test of one bit in the geometry pass that feeds the inker",
        ("npr-harness/src/cpu/surface.rs", "is_cut_out"),
        Err("a model's materials say it"),
        "variants-cut-out",
        (INK, "what_alpha_leaves_has_lines_around_it"),
    ),
    row(
        45,
        "CR, related work",
        "the inverted hull: back faces extended",
        ("npr-outline/src/hull.rs", "Hull"),
        Ok("[lines.hull]"),
        "variants-hull",
        ("npr-outline/src/hull/tests.rs", "a_cube_has_gaps_with_the_normals_of_vertices_and_none_with_welded_ones"),
    ),
];

/// The systems as a table in Markdown.
pub fn table() -> String {
    let mut text = String::from(
        "# Systems of the documents\n\nEvery system of the three documents that this workspace implements, written by `npr \
         figures --systems`. CM is the chapter\nof Card & Mitchell, CR the article on a cartoon renderer, OS the slides on \
         outlining ([sources](sources.md)). Style keys are\nthose of [styles](styles.md); `npr figures -o DIR NAME` draws a \
         figure.\n\n| | system | source | code | style key | figure | test |\n| --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for System { number, what, source, code: (file, item), key, figure, test: (test_file, test) } in SYSTEMS {
        let key = match key {
            Ok(key) => format!("`{key}`"),
            Err(why) => format!("none: {why}"),
        };
        let stem = |file: &str| file.rsplit('/').next().unwrap_or(file).to_owned();
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "| {number} | {what} | {source} | [`{item}`](../{file}) | {key} | {figure} | [{}](../{test_file}) `{test}` |",
            stem(test_file)
        );
    }
    text
}
