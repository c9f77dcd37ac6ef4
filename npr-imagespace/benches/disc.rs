//! The exact disc at several radii against what bounds it: a copy of the bytes, one 3 × 3 dilation, and a plain
//! two-pass distance transform with a lower envelope.
//!
//! `cargo bench -p npr-imagespace`. One thread, buffers kept, minimum over interleaved rounds; read the ratios.
#![allow(clippy::print_stdout)]

use glam::UVec2;
use npr_imagespace::morphology::disc::{Disc, DiscBuffers, dilate_disc};
use npr_imagespace::morphology::{Kernel, dilate};
use std::{hint::black_box, time::Instant};

fn time_ms(best: &mut f64, work: impl FnOnce()) {
    let start = Instant::now();
    work();
    *best = best.min(start.elapsed().as_secs_f64() * 1e3);
}

/// Ellipses and strokes, one or two pixels wide: about as much ink as a filtered frame has.
fn drawing(size: UVec2) -> Vec<u8> {
    let (width, height) = (size.x as usize, size.y as usize);
    let mut ink = vec![0; width * height];
    for curve in 0..24 {
        let seed = f64::from(curve) * 0.618_034;
        for i in 0..40_000 {
            let t = f64::from(i) / 40_000.0;
            let (sin, cos) = (std::f64::consts::TAU * t).sin_cos();
            let x = width as f64 * (seed.fract() + (0.04 + 0.09 * (3.0 * seed).fract()) * cos);
            let y = height as f64 * ((7.0 * seed).fract() + (0.04 + 0.15 * (5.0 * seed).fract()) * sin);
            if x >= 0.0 && y >= 0.0 && x + 1.0 < width as f64 && y < height as f64 {
                ink[y as usize * width + x as usize] = 255;
                ink[y as usize * width + x as usize + 1] = 255;
            }
        }
    }
    ink
}

/// Squared distances: a sweep along the columns, then the lower envelope of parabolas in each row, as the textbooks
/// have it. At any radius.
fn distances(ink: &[u8], width: usize, out: &mut Vec<u8>, radius: f32) {
    let height = ink.len() / width;
    let far = 1e9f32;
    let mut column = vec![far; ink.len()];
    for y in 0..height {
        for x in 0..width {
            let above = if y > 0 { column[(y - 1) * width + x] + 1.0 } else { far };
            column[y * width + x] = if ink[y * width + x] >= 128 { 0.0 } else { above };
        }
    }
    for y in (0..height.saturating_sub(1)).rev() {
        for x in 0..width {
            column[y * width + x] = column[y * width + x].min(column[(y + 1) * width + x] + 1.0);
        }
    }
    out.resize(ink.len(), 0);
    let (mut sites, mut from) = (vec![0usize; width], vec![0f32; width + 1]);
    for y in 0..height {
        let f: Vec<f32> = column[y * width..][..width].iter().map(|g| g.min(4e4) * g.min(4e4)).collect();
        let mut last = 0;
        (sites[0], from[0], from[1]) = (0, f32::NEG_INFINITY, f32::INFINITY);
        for q in 1..width {
            loop {
                let p = sites[last];
                let crossing = ((f[q] + (q * q) as f32) - (f[p] + (p * p) as f32)) / (2 * (q - p)) as f32;
                if crossing > from[last] || last == 0 {
                    last += 1;
                    (sites[last], from[last], from[last + 1]) = (q, crossing, f32::INFINITY);
                    break;
                }
                last -= 1;
            }
        }
        let mut site = 0;
        for x in 0..width {
            while from[site + 1] < x as f32 {
                site += 1;
            }
            let away = x as f32 - sites[site] as f32;
            out[y * width + x] = if away * away + f[sites[site]] <= radius * radius { 255 } else { 0 };
        }
    }
}

/// Pixels here and there, with no order that a cache or a branch could learn.
fn noise(size: UVec2, share: f64) -> Vec<u8> {
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / 16_777_216.0
    };
    (0..size.x * size.y).map(|_| if next() < share { 255 } else { 0 }).collect()
}

fn bench(name: &str, ink: &[u8], size: UVec2) {
    let inked = ink.iter().filter(|&&ink| ink > 0).count() as f64 / ink.len() as f64;
    let radii = [1.0, 2.0, 3.0, 4.0, 6.0, 9.0, 16.0, 64.0];
    let (mut hard, mut soft) = ([f64::INFINITY; 8], [f64::INFINITY; 8]);
    let [mut copy, mut square, mut envelope] = [f64::INFINITY; 3];
    let (mut buffers, mut out) = (DiscBuffers::default(), vec![0; ink.len()]);
    for round in 0..12 {
        time_ms(&mut copy, || {
            out.copy_from_slice(black_box(ink));
            black_box(&out);
        });
        time_ms(&mut square, || dilate(black_box(ink), size, Kernel::Square, &mut out).expect("it fits"));
        if round < 3 {
            time_ms(&mut envelope, || distances(black_box(ink), size.x as usize, &mut out, 16.0));
        }
        for (times, antialias) in [(&mut hard, false), (&mut soft, true)] {
            for (time, radius_px) in times.iter_mut().zip(radii) {
                let disc = Disc { radius_px, antialias };
                time_ms(time, || {
                    dilate_disc(black_box(ink), size, &disc, &mut buffers, &mut out).expect("it fits");
                    black_box(&out);
                });
            }
        }
    }
    println!("{name}, {} × {} px, {:.1} % ink", size.x, size.y, 100.0 * inked);
    println!("  copy                       {copy:7.2} ms  {:6.2}", copy / square);
    println!("  3 × 3 dilation             {square:7.2} ms    1.00");
    println!("  distance, lower envelope   {envelope:7.2} ms  {:6.2}", envelope / square);
    for (i, radius_px) in radii.into_iter().enumerate() {
        println!(
            "  disc of {radius_px:3} px, hard       {:7.2} ms  {:6.2}    soft {:7.2} ms  {:6.2}",
            hard[i],
            hard[i] / square,
            soft[i],
            soft[i] / square
        );
    }
}

fn main() {
    let size = UVec2::new(1920, 1080);
    bench("lines", &drawing(size), size);
    bench("specks", &noise(size, 0.001), size);
    bench("noise", &noise(size, 0.5), size);
}
