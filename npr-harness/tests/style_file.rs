//! Styles as TOML.

mod common;

use common::Folder;
use glam::{UVec2, Vec3};
use npr_harness::compare::Image;
use npr_harness::error::HarnessError;
use npr_harness::light::{LightFrame, StyleLight};
use npr_harness::style::{
    PainterShade, Ramp2dSource, RampShade, RampSource, Shade, Style, StyleFileError, style, styles,
};
use npr_toon::row::{RampRow, TexelFilter};
use npr_toon::source::Light;
use npr_toon::table::RampTable;
use std::path::Path;

fn parse(text: &str) -> Result<Style, StyleFileError> {
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
    for style in all {
        let text = style.to_toml().expect("every style has a form");
        assert_eq!(parse(&text).unwrap_or_else(|e| panic!("{e}\n{text}")), style, "{text}");
    }
}

#[test]
fn what_is_left_out_has_its_default() {
    let style = parse("").expect("an empty file is a style");
    assert_eq!((style.name.as_str(), style.lights.len(), &style.shade), ("mine", 1, &named("toon").shade));
    assert_eq!(style.lines, None);
    let style = parse("shade = \"paper\"\n[lines.image]\n").expect("a style");
    assert_eq!(style.shade, Shade::Paper);
    let style = parse("paper = \"#ff8000\"\n").expect("a style");
    assert_eq!(style.paper, Vec3::new(1.0, 128.0 / 255.0, 0.0));
}

/// Each at its own place in the tree, so that no struct forgets to refuse.
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
        "[lines.fins]\nsilhouette-px = 1\nboundary-px = 1\ncrease-px = 1\nink = [0, 0, 0]\n",
        "[lines.printed]\nwidth-px = 1\nink = [0, 0, 0]\n",
        "[lines.image]\n",
        "[lines.image.brush]\nradius-px = 1\n",
        "[lines.image.composite.over]\ncolor = [0, 0, 0]\n",
        "[lines.image.composite.alpha-tested]\nless = true\nreference = 1\n",
    ];
    for text in base {
        let said = message(&format!("{text}tonse = 1\n"));
        assert!(said.contains("unknown field `tonse`"), "{said}");
        let line = text.matches('\n').count() + 1;
        assert!(said.starts_with(&format!("some/mine.toml:{line}:1: ")), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
    }
    // And an unknown kind.
    for text in ["[shade.tune]\n", "[lines.finns]\n", "normals = \"per-pixl\"\n"] {
        assert!(message(text).contains("unknown variant"), "{}", message(text));
    }
}

#[test]
fn what_is_wrong_is_said() {
    let cases = [
        ("paper = [1, 1]", "mine.toml:1:9"),
        ("paper = \"#12345g\"", "no colour"),
        ("paper = [2, 0, 0]", "a component of the paper of 2"),
        ("crease-angle-deg = nan", "crease"),
        ("light = []", "one light or two"),
        ("[[light]]\n", "light 0 needs either a direction or a position"),
        ("[[light]]\ndirection = [0, 0, 0]\n", "light 0 comes from"),
        ("[[light]]\ndirection = [0, 0, 1]\nbrightness = -1\n", "brightness of light 0"),
        (&"[[light]]\ndirection = [0, 0, 1]\n".repeat(3), "3 lights are too many"),
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
    assert!(matches!(Style::read(&folder.0), Err(StyleFileError::Read { .. })));
    assert!(matches!(Style::read(&folder.0.join("none.toml")), Err(StyleFileError::Read { .. })));
    let _: HarnessError = Style::read(&folder.0).expect_err("a folder").into();
}
