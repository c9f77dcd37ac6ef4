//! Tests of the `npr` command as a process.

mod common;

use common::Folder;
use npr_harness::picture::Image;
use npr_harness::style::styles;
use std::path::Path;
use std::process::{Command, Output};

/// The corner of a cube: three quadrilaterals.
const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\n\
                   vn 0 0 -1\nvn 0 -1 0\nvn -1 0 0\n\
                   f 1//1 4//1 3//1 2//1\nf 1//2 2//2 6//2 5//2\nf 1//3 5//3 7//3 4//3\n";

fn npr(arguments: &[&str], environment: &[(&str, &str)], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_npr"))
        .args(arguments)
        .env_remove("NPR_GPU")
        .envs(environment.iter().copied())
        .current_dir(folder)
        .output()
        .expect("the command can be run")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// An environment in which no driver is found.
const NO_ADAPTER: [(&str, &str); 3] = [
    ("VK_ICD_FILENAMES", "/there/is/no/such/driver.json"),
    ("VK_DRIVER_FILES", "/there/is/no/such/driver.json"),
    ("WGPU_BACKEND", "vulkan"),
];

fn with_model() -> Folder {
    let folder = Folder::new();
    std::fs::write(folder.join("corner.obj"), OBJ).expect("written");
    folder
}

#[test]
fn inspect_counts_a_model() {
    let folder = with_model();
    let output = npr(&["inspect", "corner.obj", "--json"], &[], &folder.0);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON on stdout");
    for (key, value) in [
        ("faces", 6),
        ("zero_area_faces", 0),
        ("duplicate_faces", 0),
        ("edges", 9),
        ("boundary_edges", 6),
        ("two_face_edges", 3),
        ("nonmanifold_edges", 0),
        ("creases_over_30_deg", 3),
        ("within_0.01_deg_of_30", 0),
        ("polygons", 3),
        ("positions", 7),
        ("wound_oppositely", 0),
    ] {
        assert_eq!(json[key], value, "{key}");
    }
    assert_eq!(json["closed"], false);
    assert_eq!(json["model"], "corner");
}

#[test]
fn weld_says_which_vertices_are_one() {
    let folder = Folder::new();
    // Two triangles, 0.001 apart along their common side.
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1.001 0 0\nv 0.001 1 0\nv 1 1 0\nf 1 2 3\nf 4 6 5\n";
    std::fs::write(folder.join("gap.obj"), text).expect("a file");
    let boundaries = |flags: &[&str]| {
        let output = npr(&[&["inspect", "gap.obj", "--json"], flags].concat(), &[], &folder.0);
        let counted: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        counted["boundary_edges"].as_u64().expect("a count")
    };
    assert_eq!([boundaries(&[]), boundaries(&["--weld", "0"]), boundaries(&["--weld", "0.002"])], [6, 6, 4]);
    for wrong in ["-1", "NaN", "inf", "far"] {
        let flag = format!("--weld={wrong}");
        assert_ne!(npr(&["inspect", "gap.obj", &flag], &[], &folder.0).status.code(), Some(0), "{wrong}");
    }
}

#[test]
fn render_writes_a_picture_of_the_size_asked_for() {
    let folder = with_model();
    let arguments = ["render", "corner.obj", "-o", "a.png", "--size", "123x45", "--backend", "cpu", "--json"];
    let output = npr(&arguments, &[], &folder.0);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let image = Image::load_png(&folder.join("a.png")).expect("a PNG");
    assert_eq!((image.width, image.height), (123, 45));
    assert!(image.rgba8.chunks(4).any(|p| p[1] < 60) && image.rgba8.chunks(4).any(|p| p[1] > 230), "ink and paper");
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON on stdout");
    assert_eq!((json["width"].as_u64(), json["faces"].as_u64()), (Some(123), Some(6)));
    assert_eq!(json["executor"], "CPU, ray casting");
    assert_eq!(json["lines"]["boundary"], 6);
}

#[test]
fn what_is_wrong_is_said_in_one_line() {
    let folder = with_model();
    std::fs::write(folder.join("empty.obj"), "").expect("written");
    std::fs::write(folder.join("torn.glb"), b"glTF\x02\0\0\0\xff\xff\0\0").expect("written");
    std::fs::write(folder.join("model.txt"), OBJ).expect("written");
    std::fs::create_dir(folder.join("folder.obj")).expect("made");
    let model = "corner.obj";
    let cases: [(&str, &str, &[&str], &str); 13] = [
        (model, "a.png", &["--style", "watercolour"], "watercolour"),
        ("missing.obj", "a.png", &[], "missing.obj"),
        ("empty.obj", "a.png", &[], "empty.obj"),
        ("torn.glb", "a.png", &[], "torn.glb"),
        ("model.txt", "a.png", &[], "model.txt"),
        ("folder.obj", "a.png", &[], "folder.obj"),
        (model, "a.png", &["--size", "0x0"], "0 × 0"),
        (model, "a.png", &["--size", "100000x100000"], "100000 × 100000"),
        (model, "no/such/folder/a.png", &["--size", "8x8"], "a.png"),
        (model, "no/such/folder/a.png", &["--size", "8x8"], "no/such/folder does not exist"),
        (model, "folder.obj", &["--size", "8x8"], "folder.obj"),
        (model, "./corner.obj", &["--size", "8x8"], "it is read for the picture"),
        (model, "a.png", &["--fov", "180"], "180"),
    ];
    for (input, output, more, named) in cases {
        let arguments = [&["render", input, "-o", output, "--backend", "cpu"], more].concat();
        let done = npr(&arguments, &[], &folder.0);
        let said = text(&done.stderr);
        assert_eq!(done.status.code(), Some(1), "{arguments:?}: {said}");
        assert!(said.starts_with("npr: ") && said.trim_end().lines().count() == 1, "{arguments:?}: {said}");
        assert!(said.contains(named) && !said.contains("panicked"), "{arguments:?}: {said}");
        assert!(done.stdout.is_empty(), "{arguments:?}: {}", text(&done.stdout));
        assert!(!folder.join("a.png").exists(), "{arguments:?} wrote a picture");
    }
}

#[test]
fn without_an_adapter_required_fails_and_auto_says_so() {
    let folder = with_model();
    let arguments = ["render", "corner.obj", "-o", "a.png", "--size", "32x32"];
    let required = [&NO_ADAPTER[..], &[("NPR_GPU", "required")]].concat();
    let done = npr(&arguments, &required, &folder.0);
    let said = text(&done.stderr);
    assert_eq!(done.status.code(), Some(1), "{said}");
    assert!(said.contains("npr: NPR_GPU=required, but no usable graphics adapter"), "{said}");
    assert!(!folder.join("a.png").exists());
    let auto = [&NO_ADAPTER[..], &[("NPR_GPU", "auto")]].concat();
    let done = npr(&arguments, &auto, &folder.0);
    let said = text(&done.stderr);
    assert!(done.status.success(), "{said}");
    assert!(said.contains("npr: rendering on the CPU: no usable graphics adapter"), "{said}");
    assert!(folder.join("a.png").exists());
    let done = npr(&arguments, &[("NPR_GPU", "perhaps")], &folder.0);
    assert_eq!(done.status.code(), Some(1));
    assert!(text(&done.stderr).starts_with("npr: NPR_GPU=\"perhaps\""), "{}", text(&done.stderr));
}

#[test]
fn without_a_command_every_style_is_drawn() {
    let folder = Folder::new();
    let done = npr(&[], &[("NPR_GPU", "off")], &folder.0);
    assert!(done.status.success(), "{}", text(&done.stderr));
    let listed = text(&npr(&["styles"], &[], &folder.0).stdout);
    for style in styles() {
        let image = Image::load_png(&folder.join("npr-out").join(format!("{}.png", style.name))).expect("a PNG");
        assert_eq!((image.width, image.height), npr_harness::gallery::SIZE);
        assert!(listed.lines().any(|line| line.starts_with(&style.name)), "{}", style.name);
    }
}

#[test]
fn a_style_is_printed_changed_and_drawn() {
    let folder = with_model();
    let off = [("NPR_GPU", "off")];
    let printed = npr(&["style", "cartoon"], &[], &folder.0);
    assert!(printed.status.success(), "{}", text(&printed.stderr));
    let own = text(&printed.stdout).replace("paper = [0.98, 0.97, 0.94]", "paper = \"#3060c0\"");
    std::fs::write(folder.join("own.toml"), &own).expect("written");
    let render = |style: &str, out: &str| {
        npr(&["render", "corner.obj", "-o", out, "--style", style, "--size", "40x30"], &off, &folder.0)
    };
    let done = render("own.toml", "own.png");
    assert!(done.status.success(), "{}", text(&done.stderr));
    assert_eq!(Image::load_png(&folder.join("own.png")).expect("a PNG").rgba8[..4], [0x30, 0x60, 0xc0, 255]);
    // Unknown names are reported with their position in one line, and nothing is rendered.
    std::fs::write(folder.join("own.toml"), own.replace("antialias", "antialais")).expect("written");
    let refused = render("own.toml", "not.png");
    let said = text(&refused.stderr);
    assert_eq!(refused.status.code(), Some(1), "{said}");
    let line = own.lines().position(|line| line.starts_with("antialias")).expect("it is there") + 1;
    let start = format!("npr: own.toml:{line}:1: unknown field `antialais`");
    assert!(said.lines().last().is_some_and(|line| line.starts_with(&start)), "{said}");
    assert!(!folder.join("not.png").exists());
    for (style, why) in [("none.toml", "none.toml: "), ("no-such", "no style is called \"no-such\"")] {
        let refused = render(style, "not.png");
        assert_eq!(refused.status.code(), Some(1));
        assert!(text(&refused.stderr).contains(why), "{}", text(&refused.stderr));
    }
    assert_eq!(npr(&["style", "no-such"], &[], &folder.0).status.code(), Some(1));
}

/// If writing fails midway, the old picture remains and no partial new one.
#[cfg(unix)]
#[test]
fn a_picture_that_cannot_be_written_leaves_the_old_one() {
    let folder = with_model();
    std::fs::create_dir(folder.join("out")).expect("made");
    std::fs::write(folder.join("out/a.png"), b"the old one").expect("written");
    // The limit on file size is 512 or 1024 bytes; without the trap the process would be killed instead of getting an
    // error.
    let limited = "trap '' XFSZ; ulimit -f 1; exec \"$0\" render corner.obj -o out/a.png --size 400x300 --backend cpu";
    let done = Command::new("sh")
        .args(["-c", limited, env!("CARGO_BIN_EXE_npr")])
        .current_dir(&folder.0)
        .output()
        .expect("there is a shell");
    let said = text(&done.stderr);
    assert_eq!(done.status.code(), Some(1), "{said}");
    assert!(said.starts_with("npr: output out/a.png: "), "{said}");
    assert_eq!(std::fs::read(folder.join("out/a.png")).expect("there"), b"the old one");
    assert_eq!(std::fs::read_dir(folder.join("out")).expect("a folder").count(), 1, "nothing else is there");
}
