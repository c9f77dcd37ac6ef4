//! Dilation by repeated small kernels against a disc.

use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::picture::Image;
use crate::stability::ink::{beside, curve, limit, picture_of, worst};
use crate::stability::{Axis, Finding, Sweep};
use glam::UVec2;
use npr_imagespace::ImageSpaceError;
use npr_imagespace::morphology::disc::{Disc, DiscBuffers, dilate_disc};
use npr_imagespace::morphology::{Kernel, Operation, ping_pong};

pub(super) const DILATION_RADIUS: Sweep = Sweep {
    name: "dilation-radius",
    technique: "dilation",
    what: "Repeated steps of one pixel make a square or a diamond of a dot, so that the width of a line depends on its \
           direction.",
    needs_adapter: false,
    run: dilation_radius,
};

/// Ink of the pixels within a radius of the lines.
fn by_disc(ink: &[u8], size_px: UVec2, radius: u32) -> Result<Vec<u8>, ImageSpaceError> {
    let mut wide = Vec::new();
    let disc = Disc { radius_px: radius as f32, antialias: false };
    dilate_disc(ink, size_px, &disc, &mut DiscBuffers::default(), &mut wide)?;
    Ok(wide)
}

fn by_steps(ink: &[u8], size_px: UVec2, kernel: Kernel, radius: u32) -> Result<Vec<u8>, ImageSpaceError> {
    ping_pong(ink, size_px, kernel, Operation::Dilate, radius)
}

fn dilation_radius(_: &Executor) -> Result<Finding, HarnessError> {
    const MOST: u32 = 48;
    let side = 2 * MOST + 3;
    let size_px = UVec2::splat(side);
    let mut dot = vec![0u8; (side * side) as usize];
    dot[((MOST + 1) * side + MOST + 1) as usize] = 255;
    let methods: [(&str, Option<Kernel>); 4] = [
        ("3 × 3 steps", Some(Kernel::Square)),
        ("+ steps", Some(Kernel::Cross)),
        ("diagonal steps", Some(Kernel::Diagonal)),
        ("disc", None),
    ];
    let mut curves = Vec::new();
    for (name, kernel) in methods {
        let mut points = Vec::new();
        for radius in [1u32, 2, 3, 4, 6, 8, 12, 16, 24, 32, MOST] {
            // Pixels whose centres are within the radius of the dot's.
            let is_within = |at: u32| {
                let [x, y] = [at % side, at / side].map(|at| i64::from(at) - i64::from(MOST + 1));
                x * x + y * y <= i64::from(radius * radius)
            };
            let wide = match kernel {
                Some(kernel) => by_steps(&dot, size_px, kernel, radius)?,
                None => by_disc(&dot, size_px, radius)?,
            };
            let wrong = wide.iter().zip(0..).filter(|&(&ink, at)| (ink > 127) != is_within(at)).count();
            let all = (0..side * side).filter(|&at| is_within(at)).count();
            points.push((f64::from(radius), 100.0 * wrong as f64 / all as f64));
        }
        let radius = f64::from(MOST);
        let disc = std::f64::consts::PI * radius * radius;
        let what = "pixels that are wrong at a radius of 48 px, % of the disc";
        let last = points[points.len() - 1].1;
        let limit = match kernel {
            Some(Kernel::Square) => {
                let area = (2.0 * radius + 1.0) * (2.0 * radius + 1.0);
                limit(what, last, Bound::AtMost(30.6))
                    .predicted(100.0 * (area / disc - 1.0), "(2 r + 1)² / (π r²) − 1, towards 4/π − 1 = 27 %")
            }
            Some(Kernel::Cross) => {
                let area = 2.0 * radius * radius + 2.0 * radius + 1.0;
                limit(what, last, Bound::AtMost(35.0))
                    .predicted(100.0 * (1.0 - area / disc), "1 − (2 r² + 2 r + 1) / (π r²), towards 1 − 2/π = 36 %")
            }
            Some(Kernel::Diagonal) => {
                // All pixels an even number of steps away along both axes: a quarter of the square.
                limit(what, last, Bound::AtMost(84.5)).predicted(
                    100.0 * (0.75 + 0.25 * (4.0 / std::f64::consts::PI - 1.0)),
                    "¾ + ¼ (4/π − 1): a square of dots 2 px apart",
                )
            }
            None => {
                limit("largest share of pixels that are wrong at any radius, %", worst(&points), Bound::AtMost(0.0))
            }
        };
        curves.push(curve(name, points, limit));
    }
    Ok(Finding {
        parameter: Axis::logarithmic("radius", "px"),
        error: Axis::linear("wrong pixels, share of the disc", "%"),
        curves,
        pictures: vec![(
            "Strokes of 1 px widened by 8 px: 3 × 3 steps, + steps, and a disc.".into(),
            beside(&[strokes(Some(Kernel::Square))?, strokes(Some(Kernel::Cross))?, strokes(None)?]),
        )],
    })
}

/// Three strokes and a dot, widened.
fn strokes(kernel: Option<Kernel>) -> Result<Image, HarnessError> {
    const SIDE: u32 = 104;
    let mut ink = vec![0u8; (SIDE * SIDE) as usize];
    let mut mark = |x: u32, y: u32| ink[(y * SIDE + x) as usize] = 255;
    (16..=56).for_each(|i| mark(i, 20));
    (0..=40).for_each(|i| mark(16 + i, 40 + i));
    (0..=40).for_each(|i| mark(84, 24 + i));
    mark(30, 84);
    let size_px = UVec2::splat(SIDE);
    let wide = match kernel {
        Some(kernel) => by_steps(&ink, size_px, kernel, 8)?,
        None => by_disc(&ink, size_px, 8)?,
    };
    Ok(picture_of(&wide, SIDE))
}
