//! A sphere under two lights, as a PPM picture: `cargo run -p npr-toon --example two_lights -- sphere.ppm`.
//!
//! The upper part shows a warm light from the upper left and a dim cool light from the lower right, through a 2D ramp with
//! a corner tone for strong light. The lower part shows the ramp, dark at its upper left.

use std::fs::File;
use std::io::{self, BufWriter, Write};

use glam::{DVec2, DVec3, UVec2, Vec3};
use npr_toon::border::toon_border_width;
use npr_toon::painter::{Painter, toon_material, toon_paint, toon_painter_uv};
use npr_toon::row::TexelFilter;
use npr_toon::source::Light;
use npr_toon::table::{Corner, Ramp2d, RampTable, toon_ramp_2d, toon_table};
use npr_toon::{Bands, ToonError};

const SIZE: u32 = 512;
const TABLE: u32 = 96;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "sphere.ppm".into());
    let sun = Light { color: Vec3::new(1.0, 0.95, 0.8), ..Light::directional(Vec3::new(-0.6, 0.7, 0.5)) };
    let sky =
        Light { color: Vec3::new(0.7, 0.85, 1.0), brightness: 0.6, ..Light::directional(Vec3::new(0.8, -0.5, 0.3)) };
    let (painter, ramps) = (Painter::new(vec![sun, sky])?, ramps()?);
    let table = RampTable::from_ramps(&ramps, UVec2::splat(TABLE), TexelFilter::Nearest)?;
    Ok(write(&path, |at| {
        let (x, y) = (at.x / f64::from(TABLE), (at.y - f64::from(SIZE)) / f64::from(TABLE));
        if y >= 0.0 {
            return if x < 1.0 { toon_table(&table, DVec2::new(x, y)) } else { DVec3::splat(0.95) };
        }
        sphere(&painter, &ramps, at)
    })?)
}

/// Three bands per light, and a corner tone for strong light.
fn ramps() -> Result<Ramp2d, ToonError> {
    let bands = Bands {
        thresholds: vec![0.12, 0.5],
        tones: vec![Vec3::splat(0.3), Vec3::splat(0.48), Vec3::splat(0.62)],
        ..Bands::default()
    };
    let corner = Corner { threshold: 0.96, color: Vec3::splat(0.8) };
    Ok(Ramp2d { corner: Some(corner), ..Ramp2d::from_bands(&bands)? })
}

/// The colour at a position in pixels from the upper left corner of the picture.
fn sphere(painter: &Painter, ramps: &Ramp2d, at: DVec2) -> DVec3 {
    if plane(at).length() > 1.0 {
        return DVec3::splat(0.95);
    }
    // Differences over one pixel stand in for the derivatives of a GPU.
    let uv = light(painter, at);
    let (right, below) = (light(painter, at + DVec2::X) - uv, light(painter, at + DVec2::Y) - uv);
    let widths = DVec2::new(toon_border_width(right.x, below.x), toon_border_width(right.y, below.y));
    let material = toon_material(DVec3::new(0.93, 0.5, 0.3).extend(1.0), DVec3::ONE.extend(1.0));
    toon_paint(painter, toon_ramp_2d(ramps, uv, widths), material).truncate()
}

/// The diffuse terms of both lights on the sphere, seen along -Z by an orthographic camera.
fn light(painter: &Painter, at: DVec2) -> DVec2 {
    let p = plane(at);
    let normal = p.extend((1.0 - p.length_squared()).max(0.0).sqrt());
    toon_painter_uv(painter, normal, normal)
}

/// Maps pixels to the plane in which the outline of the sphere is the unit circle.
fn plane(at: DVec2) -> DVec2 {
    let centre = f64::from(SIZE) / 2.0;
    (at - centre) * DVec2::new(1.0, -1.0) / (0.9 * centre)
}

fn write(path: &str, pixel: impl Fn(DVec2) -> DVec3) -> io::Result<()> {
    let mut out = BufWriter::new(File::create(path)?);
    writeln!(out, "P6 {SIZE} {} 255", SIZE + TABLE)?;
    for y in 0..SIZE + TABLE {
        for x in 0..SIZE {
            let color = pixel(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
            out.write_all(&color.to_array().map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8))?;
        }
    }
    out.flush()
}
