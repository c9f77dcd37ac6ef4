//! A sphere in cartoon bands, as a PPM picture: `cargo run -p npr-toon --example ramp -- sphere.ppm`.

use std::fs::File;
use std::io::{self, BufWriter, Write};

use glam::{DVec2, DVec3};
use npr_toon::{Bands, toon_n_dot_h, toon_n_dot_l, toon_shade, toon_width};

const SIZE: u32 = 512;

fn main() -> io::Result<()> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "sphere.ppm".into());
    let mut out = BufWriter::new(File::create(path)?);
    writeln!(out, "P6 {SIZE} {SIZE} 255")?;
    for y in 0..SIZE {
        for x in 0..SIZE {
            let color = pixel(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
            out.write_all(&color.to_array().map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8))?;
        }
    }
    out.flush()
}

/// The colour at a position in pixels from the upper left corner of the picture.
fn pixel(at: DVec2) -> DVec3 {
    if plane(at).length() > 1.0 {
        return DVec3::splat(0.95);
    }
    let (n_dot_l, n_dot_h) = light(at);
    // Differences over one pixel stand in for the derivatives of a GPU.
    let (right, below) = (light(at + DVec2::X), light(at + DVec2::Y));
    let nl_width = toon_width(right.0 - n_dot_l, below.0 - n_dot_l);
    let nh_width = toon_width(right.1 - n_dot_h, below.1 - n_dot_h);
    toon_shade(&Bands::default(), DVec3::new(0.93, 0.45, 0.25), n_dot_l, nl_width, n_dot_h, nh_width)
}

/// N·L and N·H on the sphere, seen along -Z by an orthographic camera.
fn light(at: DVec2) -> (f64, f64) {
    let p = plane(at);
    let normal = p.extend((1.0 - p.length_squared()).max(0.0).sqrt());
    let to_light = DVec3::new(-0.5, 0.7, 0.6);
    (toon_n_dot_l(normal, to_light), toon_n_dot_h(normal, to_light, DVec3::Z))
}

/// Maps pixels to the plane in which the outline of the sphere is the unit circle.
fn plane(at: DVec2) -> DVec2 {
    let centre = f64::from(SIZE) / 2.0;
    (at - centre) * DVec2::new(1.0, -1.0) / (0.9 * centre)
}
