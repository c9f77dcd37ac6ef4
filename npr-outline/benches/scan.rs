//! Finding the silhouettes of a view against merely reading the same records.
//!
//! `cargo bench -p npr-outline --bench scan`. One thread, minimum over interleaved rounds; read the ratio.
#![allow(clippy::print_stdout)]

use glam::DVec4;
use npr_mesh::{Model, edges};
use npr_outline::{ContourOptions, contour_edges};
use std::{hint::black_box, time::Instant};

fn time_ms(best: &mut f64, work: impl FnOnce()) {
    let start = Instant::now();
    work();
    *best = best.min(start.elapsed().as_secs_f64() * 1e3);
}

fn main() {
    // As many faces as the Stanford bunny has.
    let model: Model = npr_mesh::embedded::torus(1.0, 0.4, 264, 132);
    let edges =
        edges::find(&model.positions, &model.faces, &model.face_polygon, &model.face_material, &Default::default());
    let contours = contour_edges(&model, &edges, &ContourOptions::default()).expect("the default options are valid");
    let eye = DVec4::new(1.9, 2.3, 3.1, 1.0);
    let mut lines = Vec::with_capacity(contours.edges.len());
    let [mut sum, mut scan] = [f64::INFINITY; 2];
    for _ in 0..200 {
        time_ms(&mut sum, || {
            // Eight sums side by side, so that adding does not wait for adding.
            let mut sums = [0f32; 8];
            for planes in black_box(&contours.planes).as_chunks::<2>().0 {
                for (sum, value) in sums.iter_mut().zip(planes.as_flattened()) {
                    *sum += value;
                }
            }
            let faces = black_box(&contours.edges).iter().fold([0u32; 2], |[a, b], edge| {
                let [first, second] = edge.faces();
                [a ^ first, b ^ second]
            });
            black_box((sums, faces));
        });
        time_ms(&mut scan, || contours.scan(black_box(eye), &mut lines));
    }
    println!(
        "{} faces of 16 bytes, {} edges of 16 bytes, {} lines",
        contours.planes.len(),
        contours.edges.len(),
        lines.len()
    );
    println!("  sum of the records {sum:8.4} ms  1.00");
    println!("  scan               {scan:8.4} ms  {:.2}", scan / sum);
}
