//! Tests of `npr tam` as a process.

mod common;

use common::Folder;
use npr_hatch::{Placement, StrokeImage, TamParameters, Thresholds, draw, even_tones, store};
use std::path::Path;
use std::process::{Command, Output};

fn tam(arguments: &[&str], folder: &Path) -> Output {
    let command = Command::new(env!("CARGO_BIN_EXE_npr")).arg("tam").args(arguments).current_dir(folder).output();
    command.expect("the command can be run")
}

/// The standard output of a successful command.
fn printed(arguments: &[&str], folder: &Path) -> String {
    let output = tam(arguments, folder);
    assert!(output.status.success(), "{arguments:?}: {}", text(&output.stderr));
    assert!(output.stderr.is_empty(), "{arguments:?}: {}", text(&output.stderr));
    text(&output.stdout)
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn gray(path: &Path) -> image::GrayImage {
    image::open(path).expect("a PNG").to_luma8()
}

/// The map file that drawing in memory produces.
fn drawn(parameters: &TamParameters, stroke: Option<&StrokeImage>) -> Vec<u8> {
    let drawing = draw(parameters, stroke).expect("good parameters");
    let thresholds = Thresholds::new(&drawing, parameters, stroke);
    store::to_bytes(&drawing.tam, Some(&thresholds)).expect("a good map")
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut names: Vec<_> =
        entries.map(|entry| text(entry.expect("an entry").file_name().as_encoded_bytes())).collect();
    names.sort_unstable();
    names
}

#[test]
fn a_folder_holds_the_default_map() {
    let folder = Folder::new();
    let said = printed(&["-o", "a/b"], &folder.0);
    let at = |name: &str| folder.join("a/b").join(name);
    let bytes = std::fs::read(at("map.tam")).expect("there");
    assert!(bytes == drawn(&TamParameters::default(), None));
    let stored = store::from_bytes(&bytes).expect("a map");
    let mut expected: Vec<_> =
        ["map.tam", "ramp.png", "sheet.png", "thresholds.png", "tiled.png"].map(String::from).into();
    for (tone, level) in (0..6).flat_map(|tone| (0..9).map(move |level| (tone, level))) {
        let name = format!("tone_{tone}_{}.png", 256 >> level);
        assert!(gray(&at(&name)).as_raw() == stored.tam.image(tone, level), "{name}");
        expected.push(name);
    }
    expected.sort_unstable();
    assert_eq!(names(&folder.join("a/b")), expected);
    let thresholds = image::open(at("thresholds.png")).expect("a PNG");
    assert!(matches!(thresholds, image::DynamicImage::ImageLuma16(_)));
    assert!(Some(thresholds.to_luma16().as_raw()) == stored.thresholds.as_ref().map(|t| &t.levels[0]));
    // The tones are side by side; the corner of the darkest is at its expected position.
    let sheet = gray(&at("sheet.png"));
    assert_eq!(sheet.dimensions(), (6 * 264 + 8, 256 + 128 + 64 + 32 + 5 * 8));
    assert_eq!(sheet.get_pixel(8 + 5 * 264 + 3, 8 + 4).0[0], stored.tam.image(5, 0)[4 * 256 + 3]);
    // White on the left, black on the right, with all tones between.
    let ramp = gray(&at("ramp.png"));
    assert_eq!(ramp.dimensions(), (1024, 256));
    for (x, column) in (0..4).map(|i| (i * 256, 1.0 - (f64::from(i) + 0.5) / 4.0)) {
        let sum: u64 = (0..256 * 256).map(|i| u64::from(ramp.get_pixel(x + i % 256, i / 256).0[0])).sum();
        let mean = sum as f64 / (255.0 * 65536.0);
        assert!((mean - column).abs() < 0.02, "{mean}, {column}");
    }
    assert!(said.contains("6 tones at 256² with 8 mips") && said.contains("strokes placed"), "{said}");
    assert!(said.contains("map.tam") && said.contains("54 images"), "{said}");
}

#[test]
fn every_parameter_arrives() {
    let folder = Folder::new();
    // A grainy stroke, only slightly lighter in places, because single texels must become as dark as the darkest tone.
    let grain = |x, y| image::Luma([if (x / 5 + y / 4) % 3 == 0 { 40 } else { 0 }]);
    image::GrayImage::from_fn(40, 16, grain).save(folder.join("stroke.png")).expect("written");
    let stroke = StrokeImage::load(folder.join("stroke.png")).expect("a picture");
    let small = || TamParameters { side: 32, ..TamParameters::default() };
    let cases: [(&[&str], TamParameters); 15] = [
        (&[], small()),
        (&["--tones", "12"], TamParameters { tones: even_tones(12), cross_from: Some(6), ..small() }),
        (&["--tones", "2"], TamParameters { tones: even_tones(2), cross_from: Some(1), ..small() }),
        (&["--tones", "1"], TamParameters { tones: even_tones(1), cross_from: None, ..small() }),
        (&["--tone-values", "0.9,0.5"], TamParameters { tones: vec![0.9, 0.5], cross_from: Some(1), ..small() }),
        (&["--seed", "18446744073709551615"], TamParameters { seed: u64::MAX, ..small() }),
        (&["--width-px", "2.5"], TamParameters { width_px: 2.5, ..small() }),
        (&["--length", "0.1,0.2"], TamParameters { length: [0.1, 0.2], ..small() }),
        (&["--angle", "-30", "--jitter", "9"], TamParameters { angle_deg: -30.0, jitter_deg: 9.0, ..small() }),
        (&["--bow", "0.1", "--taper", "0"], TamParameters { bow: 0.1, taper: 0.0, ..small() }),
        (&["--pressure", "0.9,0.95"], TamParameters { pressure: [0.9, 0.95], ..small() }),
        (&["--cross-from", "0"], TamParameters { cross_from: Some(0), ..small() }),
        (&["--cross-from", "never"], TamParameters { cross_from: None, ..small() }),
        (&["--cross-angle", "-60"], TamParameters { cross_deg: -60.0, ..small() }),
        (&["--candidates", "5"], TamParameters { placement: Placement::BestOf { candidates: 5 }, ..small() }),
    ];
    let mut maps = Vec::new();
    for (arguments, parameters) in cases {
        printed(&[&["-o", "out", "--size", "32"], arguments].concat(), &folder.0);
        let bytes = std::fs::read(folder.join("out/map.tam")).expect("there");
        assert!(bytes == drawn(&parameters, None), "{arguments:?}");
        assert!(!maps.contains(&bytes), "{arguments:?} are of no effect");
        maps.push(bytes);
    }
    printed(&["-o", "out", "--size", "32", "--width-px", "4", "--stroke", "stroke.png"], &folder.0);
    let bytes = std::fs::read(folder.join("out/map.tam")).expect("there");
    assert!(bytes == drawn(&TamParameters { width_px: 4.0, ..small() }, Some(&stroke)));
}

#[test]
fn the_same_seed_gives_the_same_files() {
    let folder = Folder::new();
    let arguments = ["--size", "64", "--tones", "3", "--candidates", "3", "--seed", "7", "-o"];
    for out in ["a", "b"] {
        printed(&[&arguments[..], &[out]].concat(), &folder.0);
    }
    let all = names(&folder.join("a"));
    assert_eq!(names(&folder.join("b")), all);
    for name in all {
        let [a, b] = ["a", "b"].map(|out| std::fs::read(folder.join(out).join(&name)).expect("there"));
        assert!(a == b, "{name}");
    }
}

#[test]
fn json_says_what_was_asked_for_and_found() {
    let folder = Folder::new();
    let said = printed(&["-o", "out", "--tone-values", "0.8,0.3", "--size", "128", "--json"], &folder.0);
    let json: serde_json::Value = serde_json::from_str(&said).expect("JSON on stdout");
    let stored = store::from_bytes(&std::fs::read(folder.join("out/map.tam")).expect("there")).expect("a map");
    assert_eq!((json["side"].as_u64(), json["levels"].as_u64()), (Some(128), Some(8)));
    assert_eq!(json["thresholds"], true);
    for (tone, asked) in [0.8, 0.3].into_iter().enumerate() {
        let number = |key: &str| json["tones"][tone][key].as_f64().expect("a number");
        let errors = [0, 1].map(|level| stored.tam.mean(tone, level) - f64::from(stored.tam.tones[tone]));
        let largest = if errors[0].abs() >= errors[1].abs() { errors[0] } else { errors[1] };
        assert!((number("asked") - asked).abs() < 1e-6 && (number("largest_error") - largest).abs() < 1e-12);
        assert!((number("found") - stored.tam.mean(tone, 0)).abs() < 1e-12 && number("largest_error").abs() < 0.005);
    }
    for key in ["strokes", "strokes_per_s", "draw_s", "thresholds_s", "write_s"] {
        assert!(json[key].as_f64().is_some_and(|value| value > 0.0), "{key}");
    }
    let files = json["files"].as_array().expect("files");
    assert_eq!(files.len(), names(&folder.join("out")).len());
    assert!(files.iter().all(|path| folder.join(path.as_str().expect("a path")).exists()));
}

#[test]
fn a_map_is_unpacked_as_it_was_drawn() {
    let folder = Folder::new();
    printed(&["-o", "a", "--size", "32", "--tones", "2"], &folder.0);
    let said = printed(&["a/map.tam", "-o", "b"], &folder.0);
    assert!(said.contains("2 tones at 32²") && !said.contains("strokes"), "{said}");
    let mut all = names(&folder.join("a"));
    all.retain(|name| name != "map.tam");
    assert_eq!(names(&folder.join("b")), all);
    for name in all {
        let [a, b] = ["a", "b"].map(|out| std::fs::read(folder.join(out).join(&name)).expect("there"));
        assert!(a == b, "{name}");
    }
    // Without thresholds fewer files are written, which is reported.
    let stored = store::from_bytes(&std::fs::read(folder.join("a/map.tam")).expect("there")).expect("a map");
    std::fs::write(folder.join("bare.tam"), store::to_bytes(&stored.tam, None).expect("good")).expect("written");
    assert!(printed(&["bare.tam", "-o", "c"], &folder.0).contains("no thresholds"));
    assert!(!folder.join("c/ramp.png").exists() && folder.join("c/sheet.png").exists());
    let said = printed(&["bare.tam", "-o", "c", "--json"], &folder.0);
    let json: serde_json::Value = serde_json::from_str(&said).expect("JSON on stdout");
    assert_eq!((&json["thresholds"], &json["strokes"]), (&false.into(), &serde_json::Value::Null));
}

#[test]
fn what_is_wrong_is_said_in_one_line() {
    let folder = Folder::new();
    printed(&["-o", "good", "--size", "8", "--width-px", "1", "--tones", "1"], &folder.0);
    let mut torn = std::fs::read(folder.join("good/map.tam")).expect("there");
    torn.pop();
    std::fs::write(folder.join("torn.tam"), torn).expect("written");
    std::fs::write(folder.join("text.tam"), "no map").expect("written");
    let white = image::GrayImage::from_pixel(4, 4, image::Luma([255]));
    white.save(folder.join("white.png")).expect("written");
    let cases: [(&[&str], &str); 21] = [
        (&["--size", "100"], "the side is 100 texels"),
        (&["--size", "8192"], "the side is 8192 texels"),
        (&["--tones", "0"], "0 tones"),
        (&["--tones", "1000000000000"], "1000000000000 tones"),
        (&["--tone-values", "0.5,0.7"], "tone 1 is 0.7"),
        (&["--tone-values", "-0.5"], "tone 0 is -0.5"),
        (&["--width-px", "65"], "width_px is 65"),
        (&["--width-px", "NaN"], "width_px is NaN"),
        (&["--length", "0,1"], "length is 0"),
        (&["--length", "0.5,0.4"], "length is the range from 0.5 to 0.4"),
        (&["--angle", "400"], "angle_deg is 400"),
        (&["--jitter", "-1"], "jitter_deg is -1"),
        (&["--bow", "1"], "bow is 1"),
        (&["--taper", "2"], "taper is 2"),
        (&["--pressure", "0,1"], "pressure is 0"),
        (&["--cross-from", "6"], "crosswise strokes are to begin with tone 6 of 6"),
        (&["--cross-angle", "999"], "cross_deg is 999"),
        (&["--candidates", "0"], "0 candidates"),
        (&["--stroke", "missing.png"], "npr: stroke picture missing.png: no such file"),
        (&["--stroke", "white.png"], "no ink"),
        (&["--pressure", "0.1,0.1"], "out of reach"),
    ];
    let maps: [(&[&str], &str); 4] = [
        (&["missing.tam"], "npr: map missing.tam: no such file"),
        (&["torn.tam"], "torn.tam: the file has"),
        (&["text.tam"], "text.tam: no tonal art map"),
        (&["good"], "npr: map good: is a directory"),
    ];
    for (arguments, named) in cases.into_iter().chain(maps) {
        let done = tam(&[arguments, &["-o", "out"]].concat(), &folder.0);
        let said = text(&done.stderr);
        assert_eq!(done.status.code(), Some(1), "{arguments:?}: {said}");
        assert!(said.starts_with("npr: ") && said.trim_end().lines().count() == 1, "{arguments:?}: {said}");
        assert!(said.contains(named), "{arguments:?}: {said}");
        assert!(done.stdout.is_empty() && !folder.join("out").exists(), "{arguments:?}");
    }
    // Invalid arguments.
    let arguments: [&[&str]; 8] = [
        &[],
        &["-o", "out", "--tones", "3", "--tone-values", "0.5"],
        &["-o", "out", "--length", "0.5"],
        &["-o", "out", "--cross-from", "often"],
        &["-o", "out", "--seed", "-1"],
        &["-o", "out", "good/map.tam", "--seed", "2"],
        &["-o", "out", "good/map.tam", "--tone-values", "0.5"],
        &["-o", "out", "good/map.tam", "--candidates", "2"],
    ];
    for arguments in arguments {
        assert_eq!(tam(arguments, &folder.0).status.code(), Some(2), "{arguments:?}");
        assert!(!folder.join("out").exists());
    }
}

#[test]
fn what_cannot_be_written_is_said() {
    let folder = Folder::new();
    let arguments = ["--size", "8", "--width-px", "1", "-o"];
    std::fs::write(folder.join("file"), "").expect("written");
    let done = tam(&[&arguments[..], &["file/out"]].concat(), &folder.0);
    assert_eq!(done.status.code(), Some(1));
    let said = text(&done.stderr);
    assert!(said.starts_with("npr: output file/out: ") && !said.contains("incomplete"), "{said}");
    let said = text(&tam(&[&arguments[..], &["file"]].concat(), &folder.0).stderr);
    assert_eq!(said, "npr: output file: not a directory\n");
    // Writing fails midway because a folder has the name of an output file.
    std::fs::create_dir_all(folder.join("out/tone_2_4.png")).expect("made");
    let done = tam(&[&arguments[..], &["out"]].concat(), &folder.0);
    assert_eq!(done.status.code(), Some(1));
    let said = text(&done.stderr);
    assert!(said.contains("tone_2_4.png: ") && said.trim_end().ends_with("; out is incomplete"), "{said}");
    assert!(done.stdout.is_empty() && folder.join("out/tone_1_1.png").exists());
}
