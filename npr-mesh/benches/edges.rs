//! The edge search compared with two lower bounds: sorting bare edge keys, and copying the bytes.
//!
//! `cargo bench -p npr-mesh`. One thread, new buffers, minimum over interleaved rounds; the ratios are significant.
#![allow(clippy::print_stdout)]

use glam::Vec3;
use npr_mesh::{Model, edges, subdivide::subdivide_midpoint, weld};
use std::{hint::black_box, path::Path, time::Instant};

fn time_ms(best: &mut f64, work: impl FnOnce()) {
    let start = Instant::now();
    work();
    *best = best.min(start.elapsed().as_secs_f64() * 1e3);
}

fn bench(name: &str, model: &Model, rounds: usize) {
    let (positions, faces) = (&model.positions, &model.faces);
    let options = edges::EdgeOptions::default();
    let found = edges::find(positions, faces, &[], &[], &options);
    let bytes_out = size_of_val(&found.edges[..]) + size_of_val(&found.face_normals[..]) + 4 * positions.len();
    let bytes_in = size_of_val(&positions[..]) + size_of_val(&faces[..]);
    let [mut sort, mut find, mut exact, mut welding, mut normals, mut copy, mut welding_exactly] = [f64::INFINITY; 7];
    for _ in 0..rounds {
        time_ms(&mut sort, || {
            let mut keys: Vec<u64> = faces
                .iter()
                .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
                .map(|(a, b)| u64::from(a.min(b)) << 32 | u64::from(a.max(b)))
                .collect();
            keys.sort_unstable();
            black_box(keys);
        });
        time_ms(&mut find, || {
            black_box(edges::find(positions, faces, &[], &[], &options));
        });
        time_ms(&mut exact, || {
            black_box(edges::find(positions, faces, &[], &[], &edges::EdgeOptions::of_file()));
        });
        time_ms(&mut welding_exactly, || {
            black_box(weld::weld_exact(positions));
        });
        time_ms(&mut welding, || {
            black_box(weld::weld_rounding(positions, faces));
        });
        time_ms(&mut normals, || {
            black_box(edges::face_normals(positions, faces, &[]));
        });
        time_ms(&mut copy, || {
            let copied: (Vec<Vec3>, Vec<[u32; 3]>) = (positions.clone(), faces.clone());
            black_box(copied);
            black_box(vec![1u8; bytes_out]);
        });
    }
    println!("{name}: {} faces, {} edges, {bytes_in} bytes in, {bytes_out} out", faces.len(), found.edges.len());
    println!("  sort_unstable of bare edge keys        {sort:8.2} ms  1.00");
    println!("  weld + edges + normals + kinds         {find:8.2} ms  {:.2}", find / sort);
    println!("  the same as in the file, without rules {exact:8.2} ms  {:.2}", exact / sort);
    println!("    of which weld                        {welding:8.2} ms  {:.2}", welding / sort);
    println!("    of which weld, at equal positions    {welding_exactly:8.2} ms  {:.2}", welding_exactly / sort);
    println!("    of which normals                     {normals:8.2} ms  {:.2}", normals / sort);
    println!("  fresh copy of the bytes in and out     {copy:8.2} ms  {:.2}", copy / sort);
}

fn main() {
    let bunny = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data/stanford-bunny.obj"));
    let (name, model) = if bunny.exists() {
        ("bunny", npr_mesh::load(bunny, &Default::default()).expect("the bunny loads").into_model())
    } else {
        ("torus (the bunny is missing)", npr_mesh::embedded::torus(1.0, 0.4, 264, 132))
    };
    bench(name, &model, 30);
    let fine = subdivide_midpoint(&subdivide_midpoint(&model));
    bench(&format!("{name}, subdivided twice"), &fine, 7);
    // In steps of a prime that does not divide the number of faces.
    let count = fine.faces.len() as u64;
    let shuffled = (0..count).map(|i| fine.faces[(i * 2_654_435_761 % count) as usize]).collect();
    bench("the same, faces shuffled", &Model { faces: shuffled, ..fine }, 5);
}
