//! Tests of style files.

mod common;

use common::Folder;
use glam::{UVec2, Vec3};
use npr_harness::error::HarnessError;
use npr_harness::hull_lines::HullLines;
use npr_harness::image_lines::ImageInk;
use npr_harness::lights::{LightFrame, StyleLight};
use npr_harness::picture::Image;
use npr_harness::shade::Shade;
use npr_harness::shade::painter::{PainterShade, Ramp2dSource};
use npr_harness::shade::ramp::{RampShade, RampSource};
use npr_harness::shadow::{ShadowLines, ShadowMethod, ShadowStyle};
use npr_harness::style::{Lines, Style, style, styles};
use npr_hatch::{TamParameters, Thresholds, draw, store};
use npr_imagespace::artist::ArtistRotation;
use npr_imagespace::composite::Composite;
use npr_imagespace::morphology::disc::Disc;
use npr_outline::LineKind;
use npr_outline::hull::HullNormals;
use npr_toon::Bands;
use npr_toon::normal::NormalUse;
use npr_toon::row::{RampRow, TexelFilter};
use npr_toon::source::Light;
use npr_toon::table::RampTable;
use std::path::Path;

fn parse(text: &str) -> Result<Style, HarnessError> {
    Style::from_toml(text, Path::new("some/mine.toml"))
}

fn message(text: &str) -> String {
    parse(text).expect_err("an error").to_string()
}

fn named(name: &str) -> Style {
    style(name).expect("a style of this crate")
}

#[test]
fn every_style_survives_being_written_and_read() {
    let row = RampRow {
        texels: vec![[10, 20, 30, 255], [200, 210, 220, 255]],
        from: -1.0,
        to: 1.0,
        filter: TexelFilter::Nearest,
    };
    let table = RampTable {
        size: UVec2::new(3, 2),
        texels: (0..6).map(|i| [i, 2 * i, 255 - i, 255]).collect(),
        filter: TexelFilter::Linear,
    };
    let world = StyleLight { light: Light::positional(Vec3::new(1.0, 2.5, -3.0)), frame: LightFrame::World };
    let ramp = Shade::Ramp(RampShade { ramp: RampSource::Image(row), half_lambert: None });
    let painter =
        Shade::Painter(PainterShade { ramp: Ramp2dSource::Image(table), light_scale: 0.5, material_by_alpha: true });
    let mut all = styles();
    all.push(Style { shade: ramp, ..named("wash") });
    all.push(Style { shade: painter, lights: vec![StyleLight::KEY, world], ..named("two-lights") });
    let dilation = Some(Disc { radius_px: 2.0, antialias: false });
    let apart = ShadowLines::Separate { composite: Composite::Multiply, dilation };
    let map = Some(ShadowStyle { method: ShadowMethod::Map { side: 512 }, terminator: 0.0 });
    all.push(Style {
        shadow: map,
        lines: Lines::image(ImageInk { shadows: apart, ..ImageInk::default() }),
        ..named("normals")
    });
    for normals in [HullNormals::Welded, HullNormals::Vertices] {
        let hull = HullLines { width_px: 3.5, ink: Vec3::new(0.25, 0.5, 0.75), normals };
        all.push(Style { lines: Lines { hull: Some(hull), ..named("cartoon").lines }, ..named("cartoon") });
    }
    for text in [
        "[lines.image]\ntaps = [[3, -1], [0, 2]]\n[lines.image.gbuffer]\ntarget = \"separate\"\nnormal-format = \
         \"octahedral-5\"\ndepth-format = \"packed-2x8\"\ndepth-test = \"step\"\nfar = 3.5\nbackground = \"plus-z\"\n",
        "[shadow]\n[lines.image]\nshadows = \"negated\"\ndepth-step = 0.25\nnormals = false\n[lines.image.gbuffer]\n\
         target = \"separate\"\nnegated-depth = true\ndepth-format = \"half\"\ndepth-test = \"sum-printed\"\nregion-test = \
         \"color-sums\"\nshow = \"regions\"\n",
        "[lines.image]\nsoftness = 0.5\n[lines.image.gbuffer]\ntarget = \"rgba8\"\ninker = { normal-cos = 0.75, \
         normal-fall = 0.125 }\nstep = [{ kind = \"open\", kernel = \"square\", times = 3 }, { kind = \"soft-diagonal\", \
         threshold = 0.75 }, { kind = \"close\" }, { kind = \"soft-diagonal-printed\" }]\n",
        "normal-space = \"mesh\"\n[lines.printed]\ndepth = \"eye\"\nreversed = true\nnormals = \"octahedral-8\"\n",
    ] {
        let style = parse(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        all.push(Style { name: "one".into(), ..style });
    }
    all.push(Style { shade: Shade::Toon(Bands { absolute: true, ..Bands::default() }), ..named("toon") });
    for normals in [NormalUse::Interpolated, NormalUse::PerFace, NormalUse::PerSubdividedFace(7)] {
        all.push(Style { normals, ..named("toon") });
    }
    let rotations = [ArtistRotation::PerPixel, ArtistRotation::PerVertex, ArtistRotation::PerObject];
    for artist in rotations.map(Some).into_iter().chain([None]) {
        all.push(Style { lines: Lines::image(ImageInk { artist, ..ImageInk::default() }), ..named("artist") });
    }
    for style in all {
        let text = style.to_toml().expect("every style has a form");
        assert_eq!(parse(&text).unwrap_or_else(|e| panic!("{e}\n{text}")), style, "{text}");
    }
}

/// The form of the text on listing 3, as docs/errata.md has it.
const DIFFUSE_AND_SPECULAR: &str = "\
[shade.toon]
absolute = true
antialias = false
thresholds = [0.1]
tones = [[0.2, 0.2, 0.2], [0.6, 0.6, 0.6]]
highlight = { threshold = 0.8, color = [0.9, 0.9, 1.0] }
";

#[test]
fn the_page_of_errata_has_this_style() {
    let page = include_str!("../../docs/errata.md");
    let block: String = DIFFUSE_AND_SPECULAR.lines().map(|line| format!("  {line}\n")).collect();
    assert!(page.contains(&block), "{block}");
}

#[test]
fn what_is_left_out_has_its_default() {
    let style = parse("").expect("an empty file is a style");
    assert_eq!((style.name.as_str(), style.lights.len(), &style.shade), ("mine", 1, &named("toon").shade));
    assert_eq!(style.lines, Lines::NONE);
    for text in ["\"per-subdivided-face\"", "{ per-subdivided-face = 4 }"] {
        let style = parse(&format!("normals = {text}")).expect("a style");
        assert_eq!(style.normals, NormalUse::PerSubdividedFace(4));
    }
    let style = parse(DIFFUSE_AND_SPECULAR).expect("a style");
    assert_eq!(style.shade, Shade::Toon(Bands { absolute: true, ..Bands::diffuse_and_specular() }));
    let style = parse("shade = \"paper\"\n[lines.image]\n").expect("a style");
    assert_eq!(style.shade, Shade::Paper);
    let style = parse("paper = \"#ff8000\"\n").expect("a style");
    assert_eq!(style.paper, Vec3::new(1.0, 128.0 / 255.0, 0.0));
}

/// `artist = true` is what it was before there were other rotations, and so it is written.
#[test]
fn artists_directions_are_rotated_as_a_style_says() {
    let artist = |text: &str| {
        let style = parse(&format!("[lines.image]\nartist = {text}\n")).expect("a style");
        style.lines.image.expect("lines in the image").artist
    };
    assert_eq!([artist("false"), artist("true")], [None, Some(ArtistRotation::PerPixel)]);
    assert_eq!(artist("\"per-pixel\""), Some(ArtistRotation::PerPixel));
    assert_eq!(artist("\"per-vertex\""), Some(ArtistRotation::PerVertex));
    assert_eq!(artist("\"per-object\""), Some(ArtistRotation::PerObject));
    assert!(named("artist").to_toml().expect("a form").contains("\nartist = true\n"));
}

/// One unknown key in each table, so that every struct is checked.
#[test]
fn an_unknown_key_is_named() {
    let base = [
        "",
        "[[light]]\ndirection = [0, 0, 1]\n",
        "[shade.lambert]\nambient = 0.2\n",
        "[shade.toon]\nthresholds = [0]\ntones = [[0, 0, 0], [1, 1, 1]]\n",
        "[shade.toon]\nthresholds = []\ntones = [[1, 1, 1]]\n[shade.toon.highlight]\nthreshold = 0.9\n",
        "[shade.ramp]\n",
        "[shade.ramp.stops]\nat = [0]\ncolors = [[0, 0, 0]]\n",
        "[shade.ramp.image]\ntexels = [\"#000000\"]\nfrom = 0\nto = 1\n",
        "[shade.ramp.half-lambert]\n",
        "[shade.painter]\n",
        "[shade.painter.corner]\nthreshold = 1\ncolor = [1, 1, 1]\n",
        "[shade.painter.image]\n",
        "[shade.gooch]\n",
        "[shade.gooch.highlight]\nexponent = 3\n",
        "[shade.hatch]\n",
        "[shade.hatch.map]\n",
        "[lines.edges]\nsilhouette-px = 1\nboundary-px = 1\ncrease-px = 1\nink = [0, 0, 0]\n",
        "[lines.printed]\nwidth-px = 1\nink = [0, 0, 0]\n",
        "[lines.hull]\nwidth-px = 1\nink = [0, 0, 0]\nnormals = \"welded\"\n",
        "[shadow]\n",
        "[lines.image]\n",
        "[lines.image.shadows.separate]\ncomposite = \"multiply\"\n",
        "[lines.image.dilation]\nradius-px = 1\n",
        "[lines.image.composite.over]\ncolor = [0, 0, 0]\n",
        "[lines.image.composite.alpha-tested]\nless = true\nreference = 1\n",
    ];
    for text in base {
        let said = message(&format!("{text}tonse = 1\n"));
        assert!(said.contains("unknown field `tonse`"), "{said}");
        let knows = said.contains("`tones`");
        assert_eq!(said.contains("`tonse` (did you mean `tones`?), expected"), knows, "{said}");
        let line = text.matches('\n').count() + 1;
        assert!(said.starts_with(&format!("some/mine.toml:{line}:1: ")), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
    }
    // An unknown kind.
    for text in [
        "[shade.tune]\n",
        "[shadow]\nmethod = \"rays\"\n",
        "[lines.image]\nshadows = \"all\"\n",
        "normals = \"per-pixl\"\n",
    ] {
        assert!(message(text).contains("unknown variant"), "{}", message(text));
    }
}

/// In tables of every kind, a similar known name is suggested.
#[test]
fn a_misspelt_key_gets_a_proposal() {
    for (text, said) in [
        ("papper = 1", "1:1: unknown field `papper` (did you mean `paper`?), expected one of `"),
        ("[line.edges]\n", "1:2: unknown field `line` (did you mean `lines`?)"),
        ("[lines.edgs]\n", "1:8: unknown field `edgs` (did you mean `edges`?)"),
        ("[lines.edges]\nsilhouete-px = 2", "2:1: unknown field `silhouete-px` (did you mean `silhouette-px`?)"),
        ("[lines.image]\nnormal_cos = 1", "`normal-cos`?"),
        ("[lines.image.dilation]\nradius = 1", "2:1: unknown field `radius`, expected "),
        ("[[light]]\ndirecton = [0, 0, 1]", "2:1: unknown field `directon` (did you mean `direction`?)"),
        ("[shade.goch]\n", "`gooch`?"),
        ("[shade.gooch]\nyelow = 1", "`yellow`?"),
        ("[shade.hatch.map]\nwidht-px = 1", "`width-px`?"),
        (
            "[shadow]\nmethod = \"volume\"",
            "unknown variant `volume` (did you mean `volumes`?), expected `volumes` or `map`",
        ),
        ("normals = \"per-pixl\"", "`per-pixel`?"),
        (
            "normals = { per-subdivide-face = 3 }",
            "unknown field `per-subdivide-face` (did you mean `per-subdivided-face`?)",
        ),
        ("normals = 3", "invalid type: integer `3`, expected a use of normals, "),
        ("normals = { per-subdivided-face = 0 }", "0 divisions of each side of a face: it must be 1..=64"),
        ("normals = {}", "an empty table: it needs per-subdivided-face"),
        ("[shadow]\nwatercolour = 1", "unknown field `watercolour`, expected "),
    ] {
        assert!(message(text).starts_with("some/mine.toml:"), "{text}: {}", message(text));
        assert!(message(text).contains(said), "{text}: {}", message(text));
    }
}

#[test]
fn lines_with_one_key_have_defaults_for_the_rest() {
    let edges = |text: &str| parse(text).expect(text).lines.edges.expect("lines along edges");
    let cartoon = named("cartoon").lines.edges.expect("cartoon has lines along edges");
    let [silhouette, boundary, crease] =
        [LineKind::Silhouette, LineKind::Boundary, LineKind::Crease].map(|k| k as usize);
    let usual = edges("[lines.edges]\n");
    assert_eq!(usual.ink, cartoon.ink);
    for kind in [silhouette, boundary, crease] {
        assert_eq!(usual.width_px[kind], cartoon.width_px[kind]);
    }
    assert_eq!(usual.width_px[LineKind::MaterialBorder as usize], 0.0);
    let wide = edges("[lines.edges]\nsilhouette-px = 5\n");
    assert_eq!((wide.width_px[silhouette], wide.width_px[crease], wide.ink), (5.0, usual.width_px[crease], usual.ink));
    let red = edges("[lines.edges]\nink = \"#ff0000\"\n");
    assert_eq!((red.width_px, red.ink), (usual.width_px, [1.0, 0.0, 0.0, 1.0]));
    assert_eq!(edges("[lines.edges]\nopacity = 0.5\n").ink[3], 0.5);
    let hull = HullLines { width_px: 2.0, ink: Vec3::ZERO, normals: HullNormals::Welded };
    assert_eq!(parse("[lines.hull]\n").expect("a style").lines, Lines::hull(hull));
    assert_eq!(parse("[lines.printed]\n").expect("a style").lines, named("printed-fins").lines);
    let style = parse("[lines.image.composite.over]\nopacity = 0.5\n").expect("a style");
    let ink = style.lines.image.expect("lines in the image");
    assert_eq!(ink.composite, Composite::Over { color: Vec3::ZERO, opacity: 0.5 });
}

#[test]
fn lines_of_several_kinds_stand_in_one_style() {
    let style = parse("[lines.edges]\n[lines.image]\n[lines.printed]\n[lines.hull]\n").expect("a style");
    let Lines { hull, printed, edges, image } = style.lines;
    assert!(hull.is_some() && printed.is_some() && edges.is_some() && image.is_some());
    assert!(message("[lines.fins]\n").contains("unknown field `fins`"), "{}", message("[lines.fins]\n"));
}

#[test]
fn two_kinds_of_one_thing_are_named_with_their_place() {
    for (text, said) in [
        (
            "[shade.toon]\n[shade.gooch]\n[shade.hatch]\n",
            "2:8: a style has one kind of shade: [shade.toon] and [shade.gooch]",
        ),
        (
            "[lines.image.composite]\nmultiply = {}\nover = {}\n",
            "3:1: a style has one kind of composite of lines: [lines.image.composite.multiply] and \
             [lines.image.composite.over] are both there",
        ),
        (
            "[lines.image.shadows]\nseparate = {}\nlines = {}\n",
            "[lines.image.shadows.separate] and [lines.image.shadows.lines]",
        ),
    ] {
        assert!(message(text).contains(said), "{text}: {}", message(text));
        assert!(matches!(parse(text), Err(HarnessError::TwoKinds { .. })), "{text}");
    }
}

const RGBA8: &str = "[lines.image.gbuffer]\ntarget = \"rgba8\"\n";
const SEPARATE: &str = "[lines.image.gbuffer]\ntarget = \"separate\"\n";

#[test]
fn what_is_wrong_is_said() {
    let cases = [
        ("paper = [1, 1]", "mine.toml:1:9"),
        ("paper = \"#12345g\"", "no colour"),
        ("paper = [2, 0, 0]", "a component of the paper of 2"),
        ("crease-angle-deg = nan", "crease"),
        ("light = []", "one to eight lights"),
        ("[[light]]\n", "light 0 needs either a direction or a position"),
        ("[[light]]\ndirection = [0, 0, 0]\n", "light 0 comes from"),
        ("[[light]]\ndirection = [0, 0, 1]\nbrightness = -1\n", "brightness of light 0"),
        (&"[[light]]\ndirection = [0, 0, 1]\n".repeat(9), "9 lights are too many: a style has at most 8"),
        ("[shade.toon]\nthresholds = [0.5, 0.1]\ntones = [[0,0,0],[0,0,0],[0,0,0]]", "threshold 1 is 0.1"),
        ("[shade.toon]\nthresholds = []\ntones = []", "at least one tone"),
        ("[shade.toon]\nthresholds = [nan]\ntones = [[0,0,0],[0,0,0]]", "not finite"),
        ("[shade.ramp.stops]\nat = [0, 1]\ncolors = [[0,0,0]]", "2 numbers in `at` and 1 in `colors`"),
        ("[shade.ramp]\n", "either a table `stops` or a table `image`"),
        ("[shade.ramp.image]\ntexels = []\nfrom = 0\nto = 1", "0 texels"),
        ("[shade.ramp.image]\nfile = \"no.png\"\nfrom = 0\nto = 1", "no.png"),
        ("[shade.painter.image]\ntexels = [[\"#000000\"], []]", "row 1"),
        ("[shade.painter]\n", "either tables `first` and `second`"),
        ("[shade.gooch]\nalpha = -1", "alpha"),
        ("[shade.lambert]\nambient = 2", "ambient"),
        ("[shade.hatch]\nambient = 0.1\nbrightness = 6", "either `ambient`"),
        ("[shade.hatch]\nambient = 2", "ambient light of 2"),
        ("[shade.hatch]\nbrightness = 0", "brightness of 0"),
        ("[shade.hatch]\ntile = 0", "a hatching's tile of 0"),
        ("[shade.hatch]\ntexel-px = nan", "a hatching's texels"),
        ("[shade.hatch]\nink = [0, 0, 2]", "a component of the ink of 2"),
        ("[shade.hatch.map]\nside = 100", "the side is 100"),
        ("[shade.hatch.map]\ntones = []", "0 tones"),
        ("[shade.hatch.map]\ntones = [0.5, 0.6]", "tone 1 is 0.6"),
        ("[shade.hatch.map]\ncross-from = 6", "tone 6 of 6"),
        ("[shade.hatch.map]\ncross-from = \"no\"", "the number of a tone, or \"never\""),
        ("[shade.hatch.map]\ncandidates = 0", "0 candidates"),
        ("[shade.hatch.map]\nfile = \"none.tam\"", "none.tam"),
        ("[shade.hatch.map]\nfile = \"none.tam\"\nseed = 3", "either a file or what a map is to be like"),
        ("[shade.hatch.map]\nstroke = \"none.png\"", "none.png"),
        ("[shade.hatch]\nencoding = \"six-tones\"\n[shade.hatch.map]\ntones = [0.5]", "a map of 1 tones"),
        ("[shadow]\nside = 512", "only a shadow map has a side"),
        ("[shadow]\nmethod = \"map\"\nside = 8", "the side of a shadow map of 8"),
        ("[shadow]\nterminator = 1", "a shadow's terminator of 1"),
        ("[lines.hull]\nwidth-px = 257", "a hull's width of 257"),
        ("[lines.hull]\nwidth-px = -1", "0..=256 px"),
        ("[lines.hull]\nwidth-px = nan", "a hull's width of"),
        ("[lines.hull]\nink = [0, 2, 0]", "a component of the hull's ink of 2"),
        ("[lines.hull]\nnormals = \"faces\"", "unknown variant `faces`, expected `welded` or `vertices`"),
        ("[lines.image]\nshadows = \"lines\"", "draws lines around shadows, and has none"),
        ("shade = \"toon\"", "this kind has a table of its own"),
        ("[lines.image]\nshadows = \"separate\"", "this kind has a table of its own"),
        ("normal-space = \"eye\"", "unknown variant `eye`"),
        ("[lines.printed]\nnormals = \"int\"", "unknown variant `int`"),
        ("[lines.image]\ntaps = [[0, 0], [1, 1]]", "a step of (0, 0) px to a tap"),
        ("[lines.image]\ntaps = [[1, 1], [65, 0]]", "a step of (65, 0) px to a tap"),
        ("[lines.image]\ntaps = \"square\"", "\"diagonal\", \"cross\", or two steps [[x, y], [x, y]] in px"),
        ("[lines.image.gbuffer]\n", "missing field `target`"),
        (&format!("{RGBA8}depth-format = \"float\""), "formats and region tests of a G-buffer need target"),
        (&format!("{RGBA8}depth-test = \"bend\""), "an RGBA8 target needs a depth test"),
        (&format!("{RGBA8}inker = {{}}\ndepth-test = \"sum\""), "the inker has a depth test of its own"),
        (&format!("{RGBA8}inker = {{ normal-cos = 2 }}"), "the inker's cosine of 2"),
        (&format!("{RGBA8}co-issued = true"), "needs an RGBA8 target without the inker, and composite.alpha-tested"),
        (&format!("{RGBA8}far = 0.5"), "a G-buffer's far plane of 0.5"),
        (&format!("{RGBA8}step = [{{ kind = \"erode\", times = 65 }}]"), "the repetitions of a step of 65"),
        (&format!("{RGBA8}step = [{{ kind = \"erode\", threshold = 1 }}]"), "only smoothed diagonal steps"),
        (&format!("{RGBA8}step = [{{ kind = \"soft-cross\", kernel = \"cross\" }}]"), "a kernel of its own"),
        (&format!("{RGBA8}step = [{}]", "{ kind = \"erode\" },".repeat(5)), "5 steps of morphology: at most 4"),
        (&format!("[lines.image]\nsoftness = 0.1\n{RGBA8}"), "lines on bytes are hard"),
        (&format!("[lines.image]\ndepth-plain = true\n{RGBA8}"), "`depth-plain` cannot be there beside `gbuffer`"),
        (&format!("[lines.image]\nlayout = \"32-bit\"\n{RGBA8}"), "`layout` cannot be there beside `gbuffer`"),
        (&format!("[shadow]\n[lines.image]\nshadows = \"lines\"\n{RGBA8}"), "lines over it needs shadows"),
        (&format!("[lines.image]\nscale = \"half\"\n{RGBA8}show = \"depth\""), "to show it needs scale"),
        (&format!("[lines.image]\ndepth = false\n{RGBA8}inker = {{}}"), "the inker has tests of its own"),
        (&format!("[lines.image]\nnormal-cos = 0.5\n{RGBA8}inker = {{}}"), "the inker has tests of its own"),
        (&format!("{RGBA8}inker = {{ form = \"printed\", depth-delta = 0.5 }}"), "only the explicit form of the inker"),
        (&format!("[lines.image]\nregions = \"mesh\"\n{RGBA8}"), "an RGBA8 target has no regions"),
        (&format!("{RGBA8}show = \"regions\""), "an RGBA8 target has no regions to show"),
        (&format!("[lines.image]\nregions = \"none\"\n{SEPARATE}show = \"regions\""), "regions are to be shown"),
        (&format!("{SEPARATE}show = \"depth\"\nstep = [{{ kind = \"erode\" }}]"), "steps of morphology need lines"),
        (
            &format!("[lines.image]\ndilation = {{ radius-px = 2 }}\n{SEPARATE}show = \"normals\""),
            "a dilation needs lines",
        ),
        (&format!("{SEPARATE}inker = {{}}"), "the inker needs target = \"rgba8\""),
        (&format!("{SEPARATE}negated-depth = true"), "negated depth needs negated normals"),
        (&format!("[shadow]\n[lines.image]\nshadows = \"negated\"\n{SEPARATE}negated-depth = true"), "with a sign"),
        ("= 3", "mine.toml:1:1"),
    ];
    for (text, said) in cases {
        assert!(message(text).contains(said), "{text}: {}", message(text));
    }
}

#[test]
fn a_ramp_comes_from_an_image_beside_the_file() {
    let folder = Folder::new();
    let pixels = [[0u8, 0, 0, 255], [40, 0, 0, 255], [1, 2, 3, 255], [250, 251, 252, 255]];
    Image::new(2, 2, pixels.concat()).expect("four pixels").save_png(&folder.0.join("ramp.png")).expect("written");
    let path = folder.0.join("mine.toml");
    let write = |text: &str| std::fs::write(&path, text).expect("written");
    write("[shade.ramp.image]\nfile = \"ramp.png\"\nrow = 1\nfrom = 0\nto = 1\n");
    let Shade::Ramp(RampShade { ramp: RampSource::Image(row), .. }) = Style::read(&path).expect("a style").shade else {
        panic!("no row")
    };
    assert_eq!(row.texels, pixels[2..]);
    write("[shade.painter.image]\nfile = \"ramp.png\"\n");
    let shade = Style::read(&path).expect("a style").shade;
    let Shade::Painter(PainterShade { ramp: Ramp2dSource::Image(table), .. }) = shade else { panic!("no table") };
    assert_eq!((table.size, table.texels), (UVec2::splat(2), pixels.to_vec()));
    write("[shade.ramp.image]\nfile = \"ramp.png\"\nrow = 2\nfrom = 0\nto = 1\n");
    assert!(Style::read(&path).expect_err("no such row").to_string().contains("row 2"));
    assert!(matches!(Style::read(&folder.0), Err(HarnessError::Read { .. })));
    assert!(matches!(Style::read(&folder.0.join("none.toml")), Err(HarnessError::Read { .. })));
}

#[test]
fn a_map_comes_from_a_file_or_a_picture_of_a_stroke() {
    let folder = Folder::new();
    let parameters = TamParameters { side: 32, ..TamParameters::default() };
    let drawing = draw(&parameters, None).expect("a map");
    let thresholds = Thresholds::new(&drawing, &parameters, None);
    let write = |name: &str, thresholds| {
        let bytes = store::to_bytes(&drawing.tam, thresholds).expect("a file");
        std::fs::write(folder.join(name), bytes).expect("written");
    };
    write("all.tam", Some(&thresholds));
    write("tones.tam", None);
    let path = folder.join("mine.toml");
    let read = |text: &str| {
        std::fs::write(&path, text).expect("written");
        Style::read(&path)
    };
    let style = read("[shade.hatch.map]\nfile = \"all.tam\"\n").expect("a style");
    let Shade::Hatch(hatch) = &style.shade else { panic!("no strokes") };
    assert_eq!(hatch.map.tam().expect("a map"), &drawing.tam);
    assert_eq!(hatch.map.thresholds().expect("a map"), Some(&thresholds));
    // In a written style the path is absolute.
    let text = style.to_toml().expect("a form");
    assert_eq!(Style::from_toml(&text, Path::new("/else/where.toml")).expect("a style"), style);
    let said = read("[shade.hatch.map]\nfile = \"tones.tam\"\n").expect_err("no thresholds").to_string();
    assert!(said.contains("tones.tam") && said.contains("no thresholds"), "{said}");
    read("[shade.hatch]\nencoding = \"six-tones\"\n[shade.hatch.map]\nfile = \"tones.tam\"\n").expect("a style");
    std::fs::write(folder.join("text.tam"), "no map").expect("written");
    let said = read("[shade.hatch.map]\nfile = \"text.tam\"\n").expect_err("no map").to_string();
    assert!(said.contains("text.tam") && said.contains("no tonal art map"), "{said}");

    let stroke = |name: &str, value: u8| {
        let image = Image::new(8, 2, [value, value, value, 255].repeat(16)).expect("16 pixels");
        image.save_png(&folder.join(name)).expect("written");
    };
    stroke("ink.png", 0);
    stroke("paper.png", 255);
    let style = read("[shade.hatch.map]\nstroke = \"ink.png\"\nside = 64\nwidth-px = 3\n").expect("a style");
    let text = style.to_toml().expect("a form");
    assert_eq!(Style::from_toml(&text, Path::new("/else/where.toml")).expect("a style"), style);
    let Shade::Hatch(hatch) = &style.shade else { panic!("no strokes") };
    assert!((hatch.map.tam().expect("a map").mean(2, 0) - 4.0 / 7.0).abs() < 0.005);
    let said = read("[shade.hatch.map]\nstroke = \"paper.png\"\n").expect_err("no ink").to_string();
    assert!(said.contains("has no ink"), "{said}");
}

/// The first file and the one after the lines were found by fuzzing stored files.
#[test]
fn numbers_that_no_picture_survives_are_refused() {
    let changed = |style: &str, what: &str| {
        let text = named(style).to_toml().expect("a form");
        let key = what.split('=').next().expect("a key");
        assert!(text.lines().any(|line| line.starts_with(key)), "{key}: {text}");
        text.lines().map(|line| if line.starts_with(key) { what } else { line }).collect::<Vec<_>>().join("\n")
    };
    let (lines, thick) = (|what: &str| changed("cartoon", what), |what: &str| changed("ink-thick", what));
    let cases = [
        (lines("ink = [0.1, inf, 0.11]"), "the lines' ink of inf"),
        (lines("ink = [nan, 0, 0]"), "the lines' ink of NaN"),
        (lines("opacity = -1"), "the lines' ink of -1"),
        (lines("silhouette-px = 1e30"), "width of 1000000"),
        (lines("crease-px = nan"), "width of NaN"),
        (thick("depth-step = nan"), "NaN"),
        (thick("radius-px = -1"), "-1"),
        (thick("softness = 0.4"), "at most 0.39999998"),
        (thick("softness = -1"), "softness of -1"),
        ("[lines.image]\nnormals = false\nsoftness = 2.1".into(), "a test of depth"),
        (thick("artist = \"per-face\""), "per-object"),
        ("paper = [2, 0, 0]".into(), "paper of 2"),
        ("crease-angle-deg = inf".into(), "inf"),
        ("[[light]]\ndirection = [nan, 0, 0]".into(), "light 0"),
        ("[[light]]\nposition = [1e30, 0, 0]".into(), "1e19"),
        ("[[light]]\ndirection = [1e-40, 0, 0]".into(), "light 0"),
        ("[shade.hatch]\ntile = 1e30".into(), "tile"),
        ("[shade.hatch.map]\nside = 4096\ncandidates = 64".into(), "npr tam"),
        ("[shade.hatch.map]\nside = 4294967295".into(), "4294967295"),
        ("[shade.hatch.map]\nside = 1e999".into(), ""),
    ];
    for (text, named) in cases {
        let said = message(&text);
        assert!(said.contains(named) && said.lines().count() == 1, "{text}: {said}");
    }
}

#[test]
fn files_that_are_no_styles_end_in_an_error() {
    let folder = Folder::new();
    let read = |name: &str, bytes: &[u8]| {
        std::fs::write(folder.join(name), bytes).expect("written");
        Style::read(&folder.join(name)).expect_err(name).to_string()
    };
    let long = read("long.toml", &vec![b'#'; (1 << 20) + 1]);
    assert!(long.contains("long.toml") && long.contains("1048576"), "{long}");
    assert!(read("bytes.toml", b"paper = \"\xff\"").contains("UTF-8"));
    let deep = [b"a = ".as_slice(), &vec![b'['; 1 << 19]].concat();
    assert!(read("deep.toml", &deep).contains("deep.toml:1:"));
    let nested = [b"a".as_slice(), &b".a".repeat(1 << 18), b" = 1"].concat();
    assert!(read("nested.toml", &nested).contains("nested.toml:1:"));
    // A file that a style refers to must be a regular file, too.
    for (form, file) in [("shade.ramp.image", "from = 0\nto = 1\n"), ("shade.hatch.map", "")] {
        for device in ["/dev/zero", "/dev/tty", "."] {
            let said = read("named.toml", format!("[{form}]\nfile = {device:?}\n{file}").as_bytes());
            assert!(said.contains("regular file"), "{form}, {device}: {said}");
        }
    }
    let stroke = read("stroke.toml", b"[shade.hatch.map]\nstroke = \"/dev/zero\"\n");
    assert!(stroke.contains("regular file"), "{stroke}");
}

#[test]
fn pictures_of_too_many_pixels_are_not_decoded() {
    let folder = Folder::new();
    // A header without data for 65,535 × 65,535 px of RGBA, for which decoding would allocate 16 GiB.
    let mut header = b"IHDR\0\0\xff\xff\0\0\xff\xff\x08\x06\0\0\0".to_vec();
    let sum = header.iter().fold(!0u32, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| if sum & 1 == 1 { sum >> 1 ^ 0xedb8_8320 } else { sum >> 1 })
    });
    header.extend((!sum).to_be_bytes());
    let bytes = [b"\x89PNG\r\n\x1a\n\0\0\0\x0d".as_slice(), &header, b"\0\0\0\0IDAT"].concat();
    std::fs::write(folder.join("huge.png"), bytes).expect("written");
    for text in
        ["[shade.ramp.image]\nfile = \"huge.png\"\nfrom = 0\nto = 1\n", "[shade.hatch.map]\nstroke = \"huge.png\"\n"]
    {
        std::fs::write(folder.join("huge.toml"), text).expect("written");
        let said = Style::read(&folder.join("huge.toml")).expect_err("too many").to_string();
        assert!(said.contains("65535"), "{said}");
    }
}

#[test]
fn an_empty_table_of_kinds_is_named_in_words() {
    let text = "paper = \"#ffffff\"\n\n[shade]\n";
    let said = Style::from_toml(text, Path::new("s.toml")).expect_err("no kind").to_string();
    assert!(said.starts_with("s.toml:") && said.contains("the table is empty"), "{said}");
    // Any combination of kinds of lines is valid, including none.
    assert_eq!(Style::from_toml("[lines]\n", Path::new("s.toml")).expect("a style").lines, Lines::NONE);
}
