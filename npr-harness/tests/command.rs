//! Tests of the `npr` command's outputs and messages.

mod common;

use common::Folder;
use serde_json::Value;
use std::fs;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// A square.
const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nusemtl red\nf 1//1 2//1 3//1 4//1\n";

const FORMATS: &str = "unknown picture format (expected .png, .jpg, .jpeg, .webp, or - for PNG on standard output)";

/// A folder with a red square in `square.obj`.
fn with_model() -> Folder {
    let folder = Folder::new();
    fs::write(folder.join("square.obj"), format!("mtllib m.mtl\n{OBJ}")).expect("written");
    fs::write(folder.join("m.mtl"), "newmtl red\nKd 1 0 0\n").expect("written");
    folder
}

fn command(arguments: &[&str], folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_npr"));
    command.args(arguments).env("NPR_GPU", "off").current_dir(folder);
    command
}

fn npr(arguments: &[&str], folder: &Folder) -> Output {
    command(arguments, &folder.0).output().expect("the command can be run")
}

/// Renders a small picture of the square on the CPU, with further arguments.
fn render(more: &[&str], folder: &Folder) -> Output {
    npr(&[&["render", "square.obj", "--size", "40x30", "--backend", "cpu"], more].concat(), folder)
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The error message of a command that fails.
fn refused(arguments: &[&str], folder: &Folder) -> String {
    let done = npr(arguments, folder);
    let said = text(&done.stderr);
    assert_eq!(done.status.code(), Some(1), "{arguments:?}: {said}");
    assert!(done.stdout.is_empty(), "{arguments:?}: {}", text(&done.stdout));
    assert_eq!(said.lines().count(), 1, "{arguments:?}: {said}");
    said
}

fn names(folder: &Folder) -> Vec<String> {
    let entries = fs::read_dir(&folder.0).expect("a folder");
    let mut names: Vec<_> =
        entries.map(|entry| text(entry.expect("an entry").file_name().as_encoded_bytes())).collect();
    names.sort_unstable();
    names
}

#[test]
fn the_files_extension_says_which_format_is_written() {
    let folder = with_model();
    let mut pictures = Vec::new();
    for (name, format, color) in [
        ("a.png", image::ImageFormat::Png, image::ColorType::Rgba8),
        ("a.webp", image::ImageFormat::WebP, image::ColorType::Rgba8),
        ("a.jpg", image::ImageFormat::Jpeg, image::ColorType::Rgb8),
        ("b.JPEG", image::ImageFormat::Jpeg, image::ColorType::Rgb8),
    ] {
        let done = render(&["-o", name], &folder);
        assert!(done.status.success(), "{name}: {}", text(&done.stderr));
        let bytes = fs::read(folder.join(name)).expect("it is there");
        assert_eq!(image::guess_format(&bytes).expect("a picture"), format, "{name}");
        let decoded = image::load_from_memory(&bytes).expect("a picture");
        assert_eq!((decoded.width(), decoded.height(), decoded.color()), (40, 30, color), "{name}");
        pictures.push(decoded.into_rgba8());
    }
    assert_eq!(pictures[0], pictures[1], "WebP is lossless");
    let mean = pictures[0].iter().zip(pictures[2].iter()).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>();
    assert!(mean / (40.0 * 30.0 * 4.0) < 4.0, "JPEG is nearly so");
    assert_eq!(names(&folder), ["a.jpg", "a.png", "a.webp", "b.JPEG", "m.mtl", "square.obj"], "no part is left");
}

#[test]
fn an_unknown_format_is_refused_before_anything_is_read() {
    let folder = with_model();
    for name in ["a.gif", "a", "a.obj", ".png", "a.png.txt"] {
        // The model does not exist either; only the first error is reported.
        let said = refused(&["render", "none.obj", "--style", "none.toml", "-o", name], &folder);
        assert_eq!(said, format!("npr: output {name}: {FORMATS}\n"));
    }
    for (name, size, said) in [
        ("a.webp", "16385x1", "16385 × 1 px: each side of a WebP picture must lie in 1..=16384"),
        ("a.jpg", "1x65536", "1 × 65536 px: each side of a JPEG picture must lie in 1..=65535"),
    ] {
        assert!(refused(&["render", "none.obj", "-o", name, "--size", size], &folder).contains(said));
    }
    assert_eq!(names(&folder), ["m.mtl", "square.obj"]);
}

#[test]
fn a_dash_is_standard_output() {
    let folder = with_model();
    assert!(render(&["-o", "a.png"], &folder).status.success());
    let done = render(&["-o", "-", "--plan"], &folder);
    let said = text(&done.stderr);
    assert!(done.status.success(), "{said}");
    assert!(
        done.stdout == fs::read(folder.join("a.png")).expect("it is there"),
        "the bytes of the file, and no others"
    );
    assert!(said.starts_with("-: 40 × 30 px, 2 faces, ") && said.lines().count() > 2, "summary and plan: {said}");
    assert!(!folder.join("-").exists());
    // The two options exclude each other.
    let both = ["render", "square.obj", "-o", "-", "--json"];
    assert_eq!(refused(&both, &folder), "npr: --json and -o - would both write to standard output\n");
}

/// The reader of a picture may close the pipe before the picture is written.
#[cfg(unix)]
#[test]
fn a_reader_that_has_gone_is_an_error() {
    let folder = with_model();
    let arguments = ["render", "square.obj", "-o", "-", "--size", "400x300", "--backend", "cpu"];
    let mut running = command(&arguments, &folder.0)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command can be run");
    drop(running.stdout.take());
    let mut said = String::new();
    running.stderr.take().expect("piped").read_to_string(&mut said).expect("text");
    assert_eq!(running.wait().expect("it ends").code(), Some(1), "{said}");
    assert!(said.starts_with("npr: output -: ") && said.lines().count() == 1, "{said}");
}

#[test]
fn what_is_missing_is_said_in_one_form() {
    let folder = with_model();
    fs::create_dir(folder.join("dir.obj")).expect("made");
    fs::create_dir(folder.join("dir.toml")).expect("made");
    fs::create_dir(folder.join("dir.png")).expect("made");
    let render = |model: &'static str, style: &'static str, output: &'static str| {
        vec!["render", model, "--style", style, "-o", output]
    };
    let cases: [(Vec<&str>, &str); 18] = [
        (render("none.obj", "cartoon", "a.png"), "model none.obj: no such file"),
        (render("dir.obj", "cartoon", "a.png"), "model dir.obj: is a directory"),
        (render("square.obj", "none.toml", "a.png"), "style none.toml: no such file"),
        (render("square.obj", "dir.toml", "a.png"), "style dir.toml: is a directory"),
        (render("square.obj", "cartoon", "dir.png"), "output dir.png: is a directory"),
        (render("square.obj", "cartoon", "no/a.png"), "output no/a.png: the folder no does not exist"),
        (vec!["inspect", "none.obj"], "model none.obj: no such file"),
        (vec!["inspect", "dir.obj"], "model dir.obj: is a directory"),
        (vec!["inspect", "."], "model .: is a directory"),
        (vec!["inspect", "square.obj", "--asset-root", "none"], "asset root none: no such directory"),
        (vec!["inspect", "square.obj", "--asset-root", "m.mtl"], "asset root m.mtl: not a directory"),
        (vec!["check", "square.obj", "none.obj"], "model none.obj: no such file"),
        (vec!["check", "square.obj", "dir.obj", "none.obj"], "model dir.obj: is a directory"),
        (vec!["check", "square.obj", "--style", "none.toml"], "style none.toml: no such file"),
        (vec!["check", "square.obj", "--out", "m.mtl"], "output m.mtl: not a directory"),
        (vec!["style", "none.toml"], "style none.toml: no such file"),
        (vec!["tam", "none.tam", "-o", "out"], "map none.tam: no such file"),
        (vec!["tam", "-o", "m.mtl"], "output m.mtl: not a directory"),
    ];
    for (arguments, said) in cases {
        assert_eq!(refused(&arguments, &folder), format!("npr: {said}\n"), "{arguments:?}");
    }
    #[cfg(unix)]
    assert!(refused(&["inspect", "m.mtl/a.obj"], &folder).starts_with("npr: model m.mtl/a.obj: Not a directory"));
    assert_eq!(names(&folder), ["dir.obj", "dir.png", "dir.toml", "m.mtl", "square.obj"]);
}

#[test]
fn misspelt_names_get_a_proposal() {
    let folder = with_model();
    let styled = |style: &'static str| ["render", "square.obj", "-o", "a.png", "--style", style];
    let said = refused(&styled("cartoom"), &folder);
    assert!(said.starts_with("npr: no style is called \"cartoom\" (did you mean \"cartoon\"? there are: "), "{said}");
    let said = refused(&styled("watercolour"), &folder);
    assert!(said.starts_with("npr: no style is called \"watercolour\" (there are: "), "{said}");
    assert!(refused(&["style", "Gooch"], &folder).contains("did you mean \"gooch\"?"));
    let lines = |material: &'static str| {
        ["render", "square.obj", "-o", "a.png", "--backend", "cpu", "--style", "artist", "--inner-lines", material]
    };
    let said = refused(&lines("rod=none"), &folder);
    assert_eq!(said, "npr: no material is called \"rod\" (did you mean \"red\"? there are: \"red\")\n");
    let said = refused(&lines("blue=none"), &folder);
    assert_eq!(said, "npr: no material is called \"blue\" (there are: \"red\")\n");
    fs::write(folder.join("own.toml"), "paper = \"#ffffff\"\n[lines.edges]\ncreese-px = 1\n").expect("written");
    let said = refused(&styled("own.toml"), &folder);
    assert!(said.starts_with("npr: own.toml:3:1: unknown field `creese-px` (did you mean `crease-px`?), "), "{said}");
    assert!(!folder.join("a.png").exists());
}

#[test]
fn a_repeated_warning_is_one_with_its_number() {
    let folder = with_model();
    let model = format!("mtllib{}\n{OBJ}", " none.mtl".repeat(9));
    fs::write(folder.join("square.obj"), model).expect("written");
    let done = render(&["-o", "a.png", "--json"], &folder);
    let said = text(&done.stderr);
    assert!(done.status.success(), "{said}");
    let of_file: Vec<_> = said.lines().filter(|line| line.contains("none.mtl")).collect();
    assert!(
        matches!(of_file[..], [one] if one.starts_with("npr: square.obj: warning: ") && one.ends_with(" (9 times)"))
    );
    let json: Value = serde_json::from_slice(&done.stdout).expect("JSON on standard output");
    let inspected: Value =
        serde_json::from_slice(&npr(&["inspect", "square.obj", "--json"], &folder).stdout).expect("JSON");
    for json in [json, inspected] {
        let warnings = json["warnings"].as_array().expect("a list");
        let counts: Vec<_> = warnings.iter().map(|w| (w["text"].is_string(), w["count"].as_u64())).collect();
        // The second warning: no file defines the material.
        assert_eq!(counts, [(true, Some(9)), (true, Some(1))], "{warnings:?}");
        assert!(warnings[0]["text"].as_str().is_some_and(|text| text.contains("none.mtl") && !text.contains("times")));
    }
    let inspected = text(&npr(&["inspect", "square.obj"], &folder).stdout);
    assert_eq!(inspected.lines().filter(|line| line.starts_with("warning") && line.contains("(9 times)")).count(), 1);
}

/// One missing file with eight materials causes two lines.
#[test]
fn a_missing_material_file_is_said_once() {
    let folder = Folder::new();
    let uses: String = (0..8).map(|number| format!("usemtl m{number}\nf 1 2 3\n")).collect();
    let model = format!("{}v 0 0 0\nv 1 0 0\nv 0 1 0\n{uses}", "mtllib none.mtl\n".repeat(8));
    fs::write(folder.join("square.obj"), model).expect("written");
    let done = render(&["-o", "a.png"], &folder);
    let said = text(&done.stderr);
    assert!(done.status.success(), "{said}");
    assert_eq!(said.lines().filter(|line| line.contains("none.mtl")).count(), 1, "{said}");
    assert_eq!(said.lines().filter(|line| line.contains("(8 materials)")).count(), 1, "{said}");
    assert_eq!(said.lines().filter(|line| line.contains("material")).count(), 2, "{said}");
}

#[test]
fn a_rendering_says_what_took_which_time() {
    let folder = with_model();
    let done = render(&["-o", "a.png", "--json"], &folder);
    let json: Value = serde_json::from_slice(&done.stdout).expect("JSON on standard output");
    assert!(json["device_ms"].as_f64().is_some_and(|ms| ms >= 0.0), "{}", json["device_ms"]);
    for part in ["load_ms", "prepare_ms", "render_ms"] {
        assert!(json[part].as_f64().is_some_and(|ms| ms > 0.0), "{part}: {}", json[part]);
    }
    let said = text(&render(&["-o", "a.png"], &folder).stdout);
    let parts = [" ms to wait for the device, ", " ms to load, ", " ms to prepare, ", " ms to render, on CPU"];
    let mut rest = said.as_str();
    for part in parts {
        rest = rest.split_once(part).unwrap_or_else(|| panic!("{part:?} in its place in {said}")).1;
    }
}

#[test]
fn shells_get_scripts_that_know_every_command_and_flag() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let done = npr(&["completions", shell], &folder);
        assert!(done.status.success(), "{shell}: {}", text(&done.stderr));
        let script = text(&done.stdout);
        for word in ["render", "inspect", "check", "tam", "styles", "completions", "max-memory", "asset-root"] {
            assert!(script.contains(word), "{shell} knows {word}");
        }
    }
    assert_eq!(npr(&["completions", "csh"], &folder).status.code(), Some(2));
    // The bash completion is checked with bash, if it is installed.
    let script = npr(&["completions", "bash"], &folder).stdout;
    let read = Command::new("bash").arg("-n").stdin(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let Ok(mut read) = read else { return };
    read.stdin.take().expect("piped").write_all(&script).expect("bash reads it");
    let read = read.wait_with_output().expect("it ends");
    assert!(read.status.success(), "{}", text(&read.stderr));
}

/// As with a pipe to `head`.
#[test]
fn a_reader_that_has_had_enough_ends_nothing() {
    let folder = Folder::new();
    let mut child = Command::new(env!("CARGO_BIN_EXE_npr"))
        .arg("styles")
        .current_dir(&folder.0)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    drop(child.stdout.take());
    let done = child.wait_with_output().expect("it ends");
    assert!(done.status.success() && done.stderr.is_empty(), "{}", text(&done.stderr));
}

/// A box with corners at ±1, without normals, and further lines.
fn boxed(more: &str) -> String {
    let mut text = String::new();
    for corner in 0..8u8 {
        let at = |bit: u8| if corner & bit == 0 { -1 } else { 1 };
        text.push_str(&format!("v {} {} {}\n", at(1), at(2), at(4)));
    }
    text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n" + more
}

#[test]
fn a_stray_triangle_is_warned_of_once_and_can_be_left_out() {
    let folder = with_model();
    fs::write(folder.join("box.obj"), boxed("")).expect("written");
    fs::write(folder.join("stray.obj"), boxed("v 1000 0 0\nv 1000 0 0.01\nv 1000 0.01 0\nf 9 10 11\n"))
        .expect("written");
    let picture = |model: &str, fit: &[&str]| {
        let arguments = ["render", model, "-o", "a.png", "--size", "60x40", "--backend", "cpu"];
        let done = npr(&[&arguments, fit].concat(), &folder);
        assert!(done.status.success(), "{}", text(&done.stderr));
        (text(&done.stderr), fs::read(folder.join("a.png")).expect("a picture"))
    };
    let (said, alone) = picture("box.obj", &[]);
    assert!(!said.contains("extent"), "{said}");
    let outlier =
        "npr: stray.obj: warning: 1 face of 13, at 1000, 0.005, 0.005, far from the rest, takes 99.7 % of the extent: ";
    for (fit, advice, is_alone) in [
        (&[][..], "--fit inliers frames the rest", false),
        (&["--fit", "all"], "--fit inliers frames the rest", false),
        (&["--fit", "inliers"], "only the rest is framed", true),
    ] {
        let (said, image) = picture("stray.obj", fit);
        assert_eq!(said.lines().filter(|line| *line == format!("{outlier}{advice}")).count(), 1, "{said}");
        // The scene with the triangle is not closed, so that the dots of hidden edges may differ.
        let pixels = |png: &[u8]| image::load_from_memory(png).expect("a PNG file").to_rgba8().into_raw();
        let differ = pixels(&image).chunks(4).zip(pixels(&alone).chunks(4)).filter(|(a, b)| a != b).count();
        assert_eq!(differ <= 24, is_alone, "{fit:?}: {differ} px of 2,400");
    }
    let done = npr(&["render", "stray.obj", "-o", "a.png", "--size", "9x9", "--backend", "cpu", "--json"], &folder);
    let json: Value = serde_json::from_slice(&done.stdout).expect("JSON");
    let warnings = json["warnings"].as_array().expect("a list");
    assert_eq!(warnings.iter().filter(|w| w["text"].as_str().is_some_and(|w| w.contains("extent"))).count(), 1);
}

/// The same model written with Z up, and every place of the file that is given on the command line, is the same picture.
#[test]
fn places_on_the_command_line_are_those_of_the_file() {
    let folder = with_model();
    let upright = "v 0 0 0\nv 4 0 0\nv 4 1 0\nv 0 1 0\nv 0 0 -2\nv 4 0 -2\nv 4 3 -2\nf 1 2 3 4\nf 5 6 7\nf 1 2 6 5\n";
    let z_up = "v 0 0 0\nv 4 0 0\nv 4 0 1\nv 0 0 1\nv 0 2 0\nv 4 2 0\nv 4 2 3\nf 1 2 3 4\nf 5 6 7\nf 1 2 6 5\n";
    fs::write(folder.join("y.obj"), upright).expect("written");
    fs::write(folder.join("z.obj"), z_up).expect("written");
    let picture = |model: &str, more: &[&str]| {
        let arguments =
            ["render", model, "-o", "a.png", "--size", "60x40", "--backend", "cpu", "--style", "toon-shadow"];
        let done = npr(&[&arguments, more].concat(), &folder);
        assert!(done.status.success(), "{}", text(&done.stderr));
        fs::read(folder.join("a.png")).expect("a picture")
    };
    let plain = picture("y.obj", &[]);
    assert_ne!(picture("z.obj", &[]), plain);
    assert_eq!(picture("z.obj", &["--up", "z"]), plain);
    assert_eq!(picture("y.obj", &["--up", "+Y"]), plain);
    for (y, z) in [
        (&["--target", "4,3,-2"], &["--target", "4,2,3"]),
        (&["--clip", "0,-1,0,0.75"], &["--clip", "0,0,-1,0.75"]),
        (&["--clip", "0,0,1,1.5"], &["--clip", "0,-1,0,1.5"]),
    ] {
        let upright = picture("y.obj", y);
        assert_ne!(upright, plain, "{y:?}");
        assert_eq!(picture("z.obj", &[&["--up", "z"], &z[..]].concat()), upright, "{z:?}");
    }
    assert_ne!(picture("y.obj", &["--roll", "-30"]), plain);
    assert_eq!(picture("y.obj", &["--roll", "0"]), plain);
    assert_ne!(picture("y.obj", &["--ground"]), plain);
}

#[test]
fn what_is_no_view_is_refused() {
    let folder = with_model();
    let with = |more: &[&str]| {
        let done = npr(
            &[&["render", "square.obj", "-o", "a.png", "--size", "8x8", "--backend", "cpu"], more].concat(),
            &folder,
        );
        assert!(!done.status.success() && !folder.join("a.png").exists(), "{more:?}");
        text(&done.stderr)
    };
    for (more, named) in [
        (&["--up", "w"][..], "expected x, y, z, -x, -y or -z"),
        (&["--target", "1,2"], "expected three numbers: X,Y,Z"),
        (&["--target", "1,2,nan"], "no point"),
        (&["--target", "1e9,0,0"], "it must lie in 0..=1e6 radii of the model"),
        (&["--roll", "1e9"], "roll"),
        (&["--fit", "some"], "inliers"),
    ] {
        let said = with(more);
        assert!(said.contains(named) && !said.contains("panicked"), "{more:?}: {said}");
    }
    let done = render(&["-o", "a.png", "--ground"], &folder);
    assert!(done.status.success());
    assert!(text(&done.stderr).contains("--ground shows nothing: no light of the style \"cartoon\" casts shadows"));
}
