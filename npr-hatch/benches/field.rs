//! The time of a direction field: `cargo bench -p npr-hatch --bench field`. One core takes about 0.35 s.
#![allow(clippy::print_stdout, dead_code)]

#[path = "../tests/field/shapes.rs"]
mod shapes;

use npr_hatch::field::FieldOptions;

fn main() {
    let mesh = shapes::torus(2.0, 0.7, [250, 140], 0.3);
    let mut times_s: Vec<_> = (0..9)
        .map(|_| {
            let start = std::time::Instant::now();
            std::hint::black_box(mesh.field(&FieldOptions::default()));
            start.elapsed().as_secs_f64()
        })
        .collect();
    times_s.sort_by(f64::total_cmp);
    println!("{} faces: median {:.3} s", mesh.faces.len(), times_s[4]);
}
