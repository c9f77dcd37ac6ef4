//! Loading an OBJ file and finding its edges, compared with tobj alone.
//!
//! `cargo bench -p npr-mesh --bench load`. One thread, minimum over interleaved rounds; the ratios are significant.
#![allow(clippy::print_stdout)]

use npr_mesh::edges;
use std::{fmt::Write, hint::black_box, path::Path, time::Instant};

fn time_ms(best: &mut f64, work: impl FnOnce()) {
    let start = Instant::now();
    work();
    *best = best.min(start.elapsed().as_secs_f64() * 1e3);
}

fn main() {
    let bunny = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data/stanford-bunny.obj"));
    let generated = std::env::temp_dir().join(format!("npr-bench-{}.obj", std::process::id()));
    let path = if bunny.exists() {
        bunny
    } else {
        let torus = npr_mesh::embedded::torus(1.0, 0.4, 264, 132);
        let mut text = String::new();
        for p in &torus.positions {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
        }
        for [a, b, c] in &torus.faces {
            let _ = writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1);
        }
        std::fs::write(&generated, text).expect("the temporary folder can be written to");
        &generated
    };
    let options = tobj::LoadOptions { single_index: true, triangulate: true, ..Default::default() };
    let [mut bare, mut load, mut whole] = [f64::INFINITY; 3];
    for _ in 0..15 {
        time_ms(&mut bare, || {
            let (models, _) = black_box(tobj::load_obj(path, &options).expect("tobj reads it"));
            black_box(models);
        });
        time_ms(&mut load, || {
            black_box(npr_mesh::load(path, &Default::default()).expect("it loads"));
        });
        time_ms(&mut whole, || {
            let model = npr_mesh::load(path, &Default::default()).expect("it loads").into_model();
            let found = edges::find(
                &model.positions,
                &model.faces,
                &model.face_polygon,
                &model.face_material,
                &Default::default(),
            );
            black_box((model, found));
        });
    }
    println!("{}", path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default());
    println!("  tobj, triangulated, single index   {bare:8.2} ms  1.00");
    println!("  loaded, checked, normals computed  {load:8.2} ms  {:.2}", load / bare);
    println!("  the same and edges                 {whole:8.2} ms  {:.2}", whole / bare);
    if path == generated {
        // A failure is harmless: the file is in a temporary folder.
        let _ = std::fs::remove_file(&generated);
    }
}
