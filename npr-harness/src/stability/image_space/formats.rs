//! The smallest differences of depth and of normals that formats hold.

use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::picture::Image;
use crate::stability::ink::{
    Random, beside, crossing, curve, geometric, last_above, limit, limit_at, picture_of, worst,
};
use crate::stability::{Axis, Finding, Sweep};
use glam::{DQuat, UVec2};
use npr_imagespace::ImageSpaceError;
use npr_imagespace::filter::depth::ink_depth_step;
use npr_imagespace::format::depth::{DepthFormat, DepthRange};
use npr_imagespace::format::normal::NormalFormat;
use npr_imagespace::format::texel::{DepthCode, TexelLayout, ink_depth_code};
use npr_imagespace::picture::{Taps, filter_picture};

pub(super) const DEPTH_GAPS: Sweep = Sweep {
    name: "depth-gaps",
    technique: "G-buffer formats",
    what: "Two surfaces whose depths have the same code have no line between them. Fixed-point depths have equal steps at \
           any distance, floats grow coarser with the distance, and codes of the reciprocal with its square.",
    needs_adapter: false,
    run: depth_gaps,
};

pub(super) const DEPTH_RANGE: Sweep = Sweep {
    name: "depth-range",
    technique: "G-buffer formats",
    what: "The steps of a fixed-point depth are shares of the range from near to far: in a scene that is a hundred times \
           as deep they are a hundred times as large. Those of floats and of reciprocals hardly depend on the far plane.",
    needs_adapter: false,
    run: depth_range,
};

pub(super) const NORMAL_ANGLES: Sweep = Sweep {
    name: "normal-angles",
    technique: "G-buffer formats",
    what: "Two normals with the same code have no line between them.",
    needs_adapter: false,
    run: normal_angles,
};

/// A way to store depth.
#[derive(Clone, Copy)]
enum Depth {
    Format(DepthFormat, DepthRange),
    Reciprocal(DepthCode),
}

impl Depth {
    fn code(&self, depth: f64) -> u32 {
        match self {
            Self::Format(format, range) => format.encode(depth as f32, range),
            Self::Reciprocal(code) => ink_depth_code(depth as f32, code),
        }
    }

    /// The smallest difference that changes the code of a depth.
    fn gap_from(&self, depth: f64) -> f64 {
        let code = self.code(depth);
        let differs = |gap: f64| self.code(depth + gap) != code;
        let mut high = 1e-9 * depth;
        // At the far end of a range all depths have one code.
        while !differs(high) && high < 1e9 {
            high *= 2.0;
        }
        let mut low = 0.0;
        while high - low > 1e-3 * high {
            let middle = 0.5 * (low + high);
            if differs(middle) { high = middle } else { low = middle }
        }
        high
    }

    /// The smallest difference that changes the code of any depth around `depth`: within 2 %, or some steps.
    fn gap(&self, depth: f64) -> f64 {
        const STARTS: u32 = 100;
        let mut random = Random(11);
        let mut largest =
            |reach: f64| (0..STARTS).map(|_| self.gap_from(depth + reach * random.unit())).fold(0.0, f64::max);
        let about = largest(0.02 * depth);
        largest((0.02 * depth).max(2.0 * about))
    }
}

const NEAR: f64 = 1.0;

/// The ways to store depths from [`NEAR`] to `far`.
fn depths(far: f64) -> Result<[(&'static str, Depth); 7], ImageSpaceError> {
    let (near, far) = (NEAR as f32, far as f32);
    let range = DepthRange::new(near, far)?;
    let code = |layout| Ok::<_, ImageSpaceError>(Depth::Reciprocal(DepthCode::perspective(near, far, layout)?));
    Ok([
        ("8 bits", Depth::Format(DepthFormat::Unorm8, range)),
        ("16 bits", Depth::Format(DepthFormat::Unorm16, range)),
        ("4 × 8 bits", Depth::Format(DepthFormat::Packed4x8, range)),
        ("half float", Depth::Format(DepthFormat::Half, range)),
        ("float", Depth::Format(DepthFormat::Float, range)),
        ("14 bits of 1/z", code(TexelLayout::Bits32)?),
        ("24 bits of 1/z", code(TexelLayout::Bits64)?),
    ])
}

/// What quantisation predicts for the gap around a depth, and how.
fn predicted_gap(name: &str, depth: f64, far: f64) -> (f64, &'static str) {
    let span = far - NEAR;
    let float_step = |bits: i32| 2f64.powi(depth.log2().floor() as i32 - bits);
    let reciprocal = |bits: u32| {
        let step = (1.0 / NEAR - 1.0 / far) / (2f64.powi(bits as i32) - 1.0);
        depth * depth * step / (1.0 - depth * step)
    };
    match name {
        "8 bits" => (span / 255.0, "(far − near) / 255"),
        "16 bits" => (span / 65535.0, "(far − near) / 65535"),
        "4 × 8 bits" => {
            let fraction_step = 2f64.powi(((depth - NEAR) / span).log2().floor() as i32 - 23);
            (
                float_step(23).max(span * fraction_step).max(span * 2f64.powi(-32)),
                "the coarsest of the spacings of z and of its share of the range in f32, and of (far − near) / 2³²",
            )
        }
        "half float" => (float_step(10), "the spacing of half floats, 2^(⌊log₂ z⌋ − 10)"),
        "float" => (float_step(23), "the spacing of f32, 2^(⌊log₂ z⌋ − 23)"),
        "14 bits of 1/z" => (reciprocal(14), "z² s / (1 − z s), s = (1/near − 1/far) / (2¹⁴ − 1)"),
        _ => (reciprocal(24), "z² s / (1 − z s), s = (1/near − 1/far) / (2²⁴ − 1)"),
    }
}

fn depth_gaps(_: &Executor) -> Result<Finding, HarnessError> {
    const FAR: f64 = 1000.0;
    const AT: f64 = 100.0;
    let mut curves = Vec::new();
    for (name, depth) in depths(FAR)? {
        let distances = geometric(2.0, 500.0, 13);
        let points = distances.into_iter().map(|at| (at, depth.gap(at))).collect();
        let (predicted, formula) = predicted_gap(name, AT, FAR);
        let what = "smallest gap that is always distinguished at 100 times the near distance, in near distances";
        let limit = limit(what, depth.gap(AT), Bound::AtMost(1.05 * predicted)).predicted(predicted, formula);
        curves.push(curve(name, points, limit));
    }
    let [eight, sixteen, ..] = depths(FAR)?;
    let cards = |(_, depth): (_, Depth)| cards(depth);
    Ok(Finding {
        parameter: Axis::logarithmic("distance over that of the near plane", ""),
        error: Axis::logarithmic("smallest gap distinguished, over the near distance", ""),
        curves,
        pictures: vec![(
            "Cards of which each is 1 % farther away than the one before, from 50 times the near distance of a range of \
             1000: their borders by depths of 8 and of 16 bits."
                .into(),
            beside(&[cards(eight), cards(sixteen)]),
        )],
    })
}

/// Lines between cards, each 1 % farther away than the one below it.
fn cards(depth: Depth) -> Image {
    const SIZE: UVec2 = UVec2::new(150, 110);
    const CARDS: u32 = 9;
    let decoded = |at: UVec2| {
        // Card 0 is the nearest and lies lowest and leftmost.
        let card = (0..CARDS).find(|card| {
            let (left, top) = (8 + 9 * card, 6 + 8 * (CARDS - 1 - card));
            (left..left + 62).contains(&at.x) && (top..top + 34).contains(&at.y)
        });
        let Some(card) = card else { return 0.0 };
        let eye_depth = 50.0 * 1.01f64.powi(card as i32);
        match depth {
            Depth::Format(format, range) => format.decode(depth.code(eye_depth), &range),
            Depth::Reciprocal(code) => code.depth(depth.code(eye_depth)) as f32,
        }
    };
    let depths: Vec<f32> =
        (0..SIZE.x * SIZE.y).map(|pixel| decoded(UVec2::new(pixel % SIZE.x, pixel / SIZE.x))).collect();
    let ink = filter_picture(&depths, SIZE, Taps::Cross, |centre, taps| {
        f32::from(u8::from(ink_depth_step(centre, taps, 0.005)))
    });
    picture_of(&ink.expect("one for each pixel"), SIZE.x)
}

fn depth_range(_: &Executor) -> Result<Finding, HarnessError> {
    const AT: f64 = 10.0;
    let ratios = geometric(20.0, 1e6, 24);
    let last = ratios[ratios.len() - 1];
    let mut curves = Vec::new();
    for method in 0..7 {
        let mut points = Vec::new();
        for &ratio in &ratios {
            points.push((ratio, 100.0 * depths(ratio)?[method].1.gap(AT) / AT));
        }
        let name = depths(last)?[method].0;
        let limit = if let "8 bits" | "16 bits" = name {
            let steps = if name == "8 bits" { 255.0 } else { 65535.0 };
            let predicted = 1.0 + 0.01 * AT * steps;
            limit_at(
                "far over near distance up to which gaps of 1 % are distinguished at 10 near distances",
                crossing(&points, 1.0),
                Bound::AtLeast(0.95 * predicted),
            )
            .predicted(predicted, "1 + 0.1 (2ⁿ − 1): a step is a tenth of the near distance")
        } else {
            let (predicted, formula) = predicted_gap(name, AT, last);
            let what =
                "largest gap that is not distinguished at 10 near distances, for any far plane, % of the distance";
            let predicted = 100.0 * predicted / AT;
            // The arithmetic of the 24-bit codes is that of f32, which has no more bits.
            let spare = if name == "24 bits of 1/z" { 1.4 } else { 1.05 };
            limit(what, worst(&points), Bound::AtMost(spare * predicted)).predicted(predicted, formula)
        };
        curves.push(curve(name, points, limit));
    }
    let [near, far] = [10_000.0, 100_000.0].map(|far| depths(far).map(|depths| cards(depths[1].1)));
    Ok(Finding {
        parameter: Axis::logarithmic("far over near distance", ""),
        error: Axis::logarithmic("smallest gap distinguished at 10 near distances, of the distance", "%"),
        curves,
        pictures: vec![(
            "Cards 1 % apart from 50 near distances on, in 16 bits: the far plane at 10 000 and at 100 000 near distances."
                .into(),
            beside(&[near?, far?]),
        )],
    })
}

fn normal_angles(_: &Executor) -> Result<Finding, HarnessError> {
    const PAIRS: u32 = 20_000;
    let angles_deg = geometric(0.002, 20.0, 80);
    let mut random = Random(19);
    let pairs: Vec<_> = (0..PAIRS).map(|_| (random.direction(), random.direction())).collect();
    let mut curves = Vec::new();
    for format in NormalFormat::ALL {
        let share = |angle_deg: f64| {
            let same = pairs.iter().filter(|(middle, other)| {
                let axis = middle.cross(*other).normalize();
                let half = 0.5 * angle_deg.to_radians();
                let [a, b] = [half, -half].map(|angle| DQuat::from_axis_angle(axis, angle) * *middle);
                format.encode(a.as_vec3()) == format.encode(b.as_vec3())
            });
            100.0 * same.count() as f64 / f64::from(PAIRS)
        };
        let mut points = Vec::new();
        for &angle in &angles_deg {
            points.push((angle, share(angle)));
            // Beyond, no pair has the same code.
            if points.iter().rev().take(8).filter(|point| point.1 == 0.0).count() == 8 {
                break;
            }
        }
        // On the middle of an octant, 1/√3 from the origin, a cell of the grid is a rhombus of two equilateral triangles
        // of side √2 steps; its long diagonal is √6 of them.
        let octahedral = |most: f64| (3.0 * 2f64.sqrt() / most).to_degrees();
        let cube = |step: f64| (3f64.sqrt() * step).to_degrees();
        let rhombus =
            "√6 / m over 1/√3: the long diagonal of a cell of the unfolded octahedron, in the middle of an octant";
        let (name, predicted, formula) = match format {
            NormalFormat::Biased8 => ("3 × 8 bits", cube(2.0 / 255.0), "√3 · 2/255: the diagonal of a step"),
            NormalFormat::Oct5 => ("octahedral 2 × 5", octahedral(15.0), rhombus),
            NormalFormat::Oct8 => ("octahedral 2 × 8", octahedral(127.0), rhombus),
            NormalFormat::Oct16 => ("octahedral 2 × 16", octahedral(32767.0), rhombus),
            NormalFormat::Half => ("half floats", cube(2f64.powi(-11)), "√3 · 2⁻¹¹: the diagonal of a step of ½..1"),
        };
        let limit = limit(
            "largest angle between two normals that have the same code, degrees",
            last_above(&points, 0.0),
            Bound::AtMost(predicted),
        );
        curves.push(curve(name, points, limit.predicted(predicted, formula)));
    }
    Ok(Finding {
        parameter: Axis::logarithmic("angle between two normals", "degrees"),
        error: Axis::linear("pairs with the same code", "%"),
        curves,
        pictures: vec![(
            "A ball whose grey changes with every 6° of its stored normals from a direction: octahedral in 2 × 5 bits, in 2 \
             × 8, and in 3 × 8 bits."
                .into(),
            beside(&[NormalFormat::Oct5, NormalFormat::Oct8, NormalFormat::Biased8].map(banded_ball)),
        )],
    })
}

/// A ball whose grey alternates with every 6° of its stored normals' angle to the viewer.
fn banded_ball(format: NormalFormat) -> Image {
    const SIZE_PX: u32 = 104;
    let mut picture = Image::filled(SIZE_PX, SIZE_PX, [255; 4]);
    for y in 0..SIZE_PX {
        for x in 0..SIZE_PX {
            let at = (glam::DVec2::new(f64::from(x), f64::from(y)) + 0.5) / (f64::from(SIZE_PX) / 2.0) - 1.0;
            let squared = at.length_squared();
            if squared > 0.95 {
                continue;
            }
            let normal = glam::DVec3::new(at.x, -at.y, (1.0 - squared).sqrt());
            let stored = format.decode(format.encode(normal.as_vec3())).as_dvec3();
            let angle_deg = stored.angle_between(glam::DVec3::new(0.3, 0.4, 0.866)).to_degrees();
            let grey = if (angle_deg / 6.0) as u32 % 2 == 1 { 200 } else { 60 };
            picture.set_pixel(x, y, [grey, grey, grey, 255]);
        }
    }
    picture
}
