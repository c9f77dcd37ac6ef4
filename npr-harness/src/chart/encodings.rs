//! Formats of a G-buffer: how small a gap in depth or an angle between normals they distinguish.
//!
//! The gap is the smallest by which two depths must differ so that they have different codes wherever they lie, over the
//! subject's range of depths, as a share of the range: found by bisection of the encoder, not from its formula. The
//! angle is the largest between a direction and what the format makes of it, over directions evenly spread. Times are
//! those of frames with lines from a G-buffer of the format; devices keep the codes in targets of 32-bit floats whatever
//! the format, so that times differ by the work of encoding alone, and bytes are those that the format itself takes.

use super::frames::{Drawn, candidates, part_of, rows};
use super::lines::asked;
use super::{Chart, Lab, Row};
use crate::error::HarnessError;
use crate::image_lines::gbuffer::style::GBufferTarget;
use crate::variant::Part;
use glam::DVec3;
use npr_imagespace::format::depth::{DepthFormat, DepthRange};
use npr_imagespace::format::normal::NormalFormat;

pub(super) const CHART: Chart = Chart {
    name: "formats",
    title: "Formats of a G-buffer",
    error: ERROR,
    about: "Depth: the smallest gap that is distinguished at any distance, as a share of the scene's depth. Normals: the \
            largest angle by which one is off, as a share of a right angle. The other of the two is stored as floats.",
    choices: &[],
    run,
};

const ERROR: &str = "smallest difference distinguished";
/// Depths that are tried within the range.
const PLACES: u32 = 64;
/// Directions that are tried.
const DIRECTIONS: u32 = 20_000;

fn run(lab: &Lab<'_>) -> Result<Vec<Row>, HarnessError> {
    let separate = candidates(Part::Lines, &asked(1.0)).into_iter();
    let candidates: Vec<_> =
        separate.filter(|candidate| formats(&candidate.setup.style).is_some_and(|of| of.is_compared())).collect();
    let mut all = Vec::new();
    for (number, subject) in lab.subjects.iter().enumerate() {
        let (near, far) = subject.scene.depth_range(&subject.camera);
        let range = DepthRange::new(near as f32, far as f32)?;
        let mut judge = |drawn: &Drawn<'_>| {
            let Some(Formats { normals, depth }) = formats(&drawn.candidate.setup.style) else { return Ok(None) };
            let gap = largest_gap(depth, &range) / f64::from(range.far - range.near);
            let angle = normals.map_or(0.0, |format| largest_angle_rad(format) / std::f64::consts::FRAC_PI_2);
            let errors = [(ERROR, gap.max(angle)), ("depth gap", gap), ("normal angle", angle)];
            Ok(Some(errors.map(|(name, value)| (name.to_owned(), value)).into()))
        };
        let progress = part_of(lab, number, lab.subjects.len());
        let mut of_subject = rows(CHART.name, lab, subject, &candidates, &mut judge, &progress)?;
        for row in &mut of_subject {
            let of = candidates.iter().find(|candidate| candidate.name == row.variant);
            let formats = of.and_then(|candidate| formats(&candidate.setup.style)).expect("a row is of a candidate");
            row.bytes = formats.texel_bytes() * u64::from(lab.size.0) * u64::from(lab.size.1);
        }
        all.extend(of_subject);
    }
    Ok(all)
}

struct Formats {
    normals: Option<NormalFormat>,
    depth: DepthFormat,
}

impl Formats {
    fn texel_bytes(&self) -> u64 {
        let normal_bits = self.normals.map_or(96, NormalFormat::bits);
        u64::from(normal_bits.div_ceil(8)) + self.depth.bytes() as u64
    }

    /// Whether at most one of the two is other than floats of 32 bits.
    fn is_compared(&self) -> bool {
        self.normals.is_none() || self.depth == DepthFormat::Float
    }
}

fn formats(style: &crate::style::Style) -> Option<Formats> {
    let GBufferTarget::Separate(targets) = style.lines.image?.gbuffer?.target else { return None };
    // Other tests of depth do not change the formats.
    let is_default = targets.filter == npr_imagespace::filter::separate::SeparateFilter::default();
    is_default.then_some(Formats { normals: targets.normals, depth: targets.depth })
}

/// The largest of the smallest differences that change the code, over depths of the range, in units of depth.
fn largest_gap(format: DepthFormat, range: &DepthRange) -> f64 {
    let (near, far) = (f64::from(range.near), f64::from(range.far));
    let smallest = |number: u32| {
        // Irregular, so that no place lies on a grid of codes.
        let at = near + (far - near) * ((f64::from(number) * 0.618_033_988_75).fract() * 0.98 + 0.01);
        // The width of the step of codes that contains it: from its lower to its upper end.
        let code = format.encode(at as f32, range);
        let [low, high] = [-1.0, 1.0].map(|sign| {
            let (mut same, mut other) = (0.0f64, far - near);
            for _ in 0..60 {
                let middle = 0.5 * (same + other);
                if format.encode((at + sign * middle) as f32, range) == code { same = middle } else { other = middle }
            }
            same
        });
        low + high
    };
    (0..PLACES).map(smallest).fold(0.0, f64::max)
}

/// The largest angle between a direction and its decoded code.
fn largest_angle_rad(format: NormalFormat) -> f64 {
    let direction = |number: u32| {
        // A Fibonacci sphere.
        let z = 1.0 - (2.0 * f64::from(number) + 1.0) / f64::from(DIRECTIONS);
        let angle = f64::from(number) * std::f64::consts::PI * (3.0 - 5f64.sqrt());
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * angle.cos(), radius * angle.sin(), z)
    };
    let angle = |number: u32| {
        let normal = direction(number);
        let stored = format.decode(format.encode(normal.as_vec3())).as_dvec3().normalize_or_zero();
        normal.cross(stored).length().atan2(normal.dot(stored))
    };
    (0..DIRECTIONS).map(angle).fold(0.0, f64::max)
}
