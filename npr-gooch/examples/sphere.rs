//! Spheres in cool and warm tones, as a PPM picture: `cargo run -p npr-gooch --example sphere -- spheres.ppm`.
//!
//! The left column uses the equation, the right column Card & Mitchell's listing 7 with the same parameters. Each row has
//! another object colour.

use std::fs::File;
use std::io::{self, BufWriter, Write};

use glam::{DVec2, DVec3};
use npr_gooch::{Gooch, Tones, gooch_shade};

/// Pixels from one sphere to the next.
const CELL: u32 = 256;
/// Samples per pixel along each axis.
const SAMPLES: u32 = 4;
const OBJECTS: [DVec3; 4] =
    [DVec3::new(0.9, 0.2, 0.15), DVec3::new(0.2, 0.6, 0.25), DVec3::new(0.85, 0.85, 0.8), DVec3::new(0.1, 0.1, 0.12)];

fn main() -> io::Result<()> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "spheres.ppm".into());
    let mut out = BufWriter::new(File::create(path)?);
    writeln!(out, "P6 {} {} 255", 2 * CELL, OBJECTS.len() as u32 * CELL)?;
    for y in 0..OBJECTS.len() as u32 * CELL {
        for x in 0..2 * CELL {
            let samples = (0..SAMPLES * SAMPLES).map(|i| {
                let offset = DVec2::new(f64::from(i % SAMPLES) + 0.5, f64::from(i / SAMPLES) + 0.5);
                color(DVec2::new(f64::from(x), f64::from(y)) + offset / f64::from(SAMPLES))
            });
            let mean = samples.sum::<DVec3>() / f64::from(SAMPLES * SAMPLES);
            out.write_all(&mean.to_array().map(|c| (c * 255.0).round() as u8))?;
        }
    }
    out.flush()
}

/// The colour at a position in pixels from the upper left corner of the picture.
fn color(at: DVec2) -> DVec3 {
    let cell = (at / f64::from(CELL)).floor();
    let p = ((at / f64::from(CELL) - cell) * 2.0 - 1.0) * DVec2::new(1.0, -1.0) / 0.88;
    // The background, and a black outline around the sphere.
    if p.length() > 1.0 {
        return if p.length() < 1.025 { DVec3::ZERO } else { DVec3::splat(0.95) };
    }
    let normal = p.extend((1.0 - p.length_squared()).sqrt());
    let tones = if cell.x == 0.0 { Tones::Equation } else { Tones::SwappedShares };
    let model = Gooch { tones, ..Gooch::default() };
    // An orthographic view along -Z. The light is nearly perpendicular to the view, so that the full tone range is visible.
    gooch_shade(&model, OBJECTS[cell.y as usize], normal, DVec3::new(0.7, 0.8, 0.45), DVec3::Z)
}
