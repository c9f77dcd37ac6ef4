//! Different notations of one model give the same model.

use crate::Folder;
use crate::case::sound;
use npr_mesh::{LoadOptions, Loaded, Model, embedded, load};
use std::fmt::Write as _;
use std::path::PathBuf;

/// The faces in the order of the file.
fn faces_of(model: &Model) -> Vec<[u32; 3]> {
    model.faces.clone()
}

fn vertices(model: &Model) -> String {
    let mut text = String::new();
    for p in &model.positions {
        writeln!(text, "v {:?} {:?} {:?}", p.x, p.y, p.z).expect("into memory");
    }
    text
}

fn plain(model: &Model) -> String {
    let mut text = vertices(model);
    for [a, b, c] in faces_of(model) {
        writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).expect("into memory");
    }
    text
}

fn loaded(folder: &Folder, name: &str, text: impl AsRef<[u8]>) -> Loaded {
    let path = folder.0.join(format!("{name}.obj"));
    std::fs::write(&path, text).expect("written");
    load(&path, &LoadOptions::default()).expect(name)
}

#[test]
fn every_way_to_write_a_model_gives_the_same_model() {
    let folder = Folder::new("variants");
    let model = embedded::teapot(8);
    let text = plain(&model);
    let expected = sound(loaded(&folder, "plain", &text)).unwrap();
    let count = model.positions.len() as i64;
    let mut negative = vertices(&model);
    for face in faces_of(&model) {
        let [a, b, c] = face.map(|v| i64::from(v) - count);
        writeln!(negative, "f {a} {b} {c}").unwrap();
    }
    let continued: String = text.lines().map(|line| line.replacen(' ', " \\\n  ", 2) + "\n").collect();
    let latin1 = [b"# caf\xe9\n", text.as_bytes()].concat();
    for (name, text) in [
        ("crlf", text.replace('\n', "\r\n").into_bytes()),
        ("cr", text.replace('\n', "\r").into_bytes()),
        ("byte-order-mark", format!("\u{feff}{text}").into_bytes()),
        ("continued", continued.into_bytes()),
        ("negative", negative.into_bytes()),
        ("latin1", latin1),
        ("indented", text.lines().map(|line| format!(" \t{line}  \n")).collect::<String>().into_bytes()),
        ("comments", text.lines().map(|line| format!("{line} # and so on\n")).collect::<String>().into_bytes()),
        ("slashes", text.lines().map(|line| line.replace("f ", "f  ") + "\n").collect::<String>().into_bytes()),
    ] {
        assert!(loaded(&folder, name, text).into_model() == expected, "{name}");
    }
}

#[test]
fn quads_have_the_triangles_and_the_edges_of_the_same_model_in_triangles() {
    let folder = Folder::new("quads");
    // A sheet of flat squares, split along the diagonal that the loader chooses: the first.
    let side = 9u32;
    let mut vertices = String::new();
    let (mut quads, mut triangles) = (String::new(), String::new());
    for y in 0..=side {
        for x in 0..=side {
            writeln!(vertices, "v {x} {y} {}", x.saturating_sub(4)).unwrap();
        }
    }
    for y in 0..side {
        for x in 0..side {
            let a = y * (side + 1) + x + 1;
            let [b, c, d] = [a + 1, a + side + 2, a + side + 1];
            writeln!(quads, "f {a} {b} {c} {d}").unwrap();
            writeln!(triangles, "f {a} {b} {c}\nf {a} {c} {d}").unwrap();
        }
    }
    let quads = loaded(&folder, "quads", vertices.clone() + &quads).into_model();
    let triangles = loaded(&folder, "triangles", vertices + &triangles).into_model();
    assert_eq!(quads.faces.len(), 162);
    let corners = |model: &Model| -> Vec<_> {
        model.faces.iter().map(|face| face.map(|v| (model.positions[v as usize], model.normals[v as usize]))).collect()
    };
    let (of_quads, of_triangles) = (corners(&quads), corners(&triangles));
    for (quad, triangle) in of_quads.iter().zip(&of_triangles) {
        for ((p, n), (q, m)) in quad.iter().zip(triangle) {
            assert_eq!(p, q);
            assert!(n.distance(*m) < 1e-6, "{n} {m}");
        }
    }
    let found = |model: &Model| {
        let options = npr_mesh::edges::EdgeOptions::default();
        npr_mesh::edges::find(&model.positions, &model.faces, &model.face_polygon, &[], &options)
    };
    assert_eq!(found(&triangles).edges.len() - found(&quads).edges.len(), 81);
}

/// Other notations of the shared test models, if available, give the same models.
#[test]
fn real_models_are_the_same_in_every_way_to_write_them() {
    let data = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    let folder = Folder::new("real");
    for name in ["spot_quads", "suzanne", "fandisk"] {
        let Ok(text) = std::fs::read_to_string(data.join(name).with_extension("obj")) else {
            println!("skipped {name}: no shared models here");
            continue;
        };
        let text = text.replace("mtllib", "# mtllib");
        let expected = loaded(&folder, name, &text).into_model();
        let crlf = text.replace("\r\n", "\n").replace('\n', "\r\n");
        assert!(loaded(&folder, name, crlf).into_model() == expected, "{name}");
        assert!(loaded(&folder, name, format!("\u{feff}{text}")).into_model() == expected, "{name}");
        let counts = |kind: &str, before: usize| {
            text.lines().take(before).filter(|l| l.split_whitespace().next() == Some(kind)).count() as i64
        };
        let all = [counts("v", usize::MAX), counts("vt", usize::MAX), counts("vn", usize::MAX)];
        // In these files all vertices precede all faces.
        let negative: String = text
            .lines()
            .map(|line| match line.strip_prefix("f ") {
                None => format!("{line}\n"),
                Some(rest) => {
                    let corner = |corner: &str| -> String {
                        let numbers = corner.split('/').zip(all).map(|(number, count)| match number.parse::<i64>() {
                            Ok(number) => (number - 1 - count).to_string(),
                            Err(_) => String::new(),
                        });
                        numbers.collect::<Vec<_>>().join("/")
                    };
                    format!("f {}\n", rest.split_whitespace().map(corner).collect::<Vec<_>>().join(" \\\n"))
                }
            })
            .collect();
        assert!(loaded(&folder, name, negative).into_model() == expected, "{name}");
    }
}
