//! Checks of npr-toon: 1D and 2D ramps from stops, and the texels for a coordinate of a row.

use crate::check::{Allowed, Check, Given, MODELS, SMALL, compare};
use crate::random::{Random, with};
use glam::{DVec2, DVec3, DVec4, Vec2, Vec4};
use npr_toon::ramp::{MAX_STOPS, Ramp, RampBlend, RampStop, RampUniform, TOON_STOPS_OVERRIDE, toon_ramp};
use npr_toon::row::{toon_row_nearest, toon_row_taps};
use npr_toon::table::{Corner, Ramp2d, Ramp2dUniform, toon_corner, toon_ramp_2d, toon_table_mix};
use npr_toon::x_toon::{toon_depth_detail, toon_silhouette_detail, toon_x_toon};

/// Stops starting at `first`, the others not lower than `low`, some of them adjacent in f32.
fn any_ramp(random: &Random, blend: RampBlend, stops: u32, first: f32, low: f32) -> Ramp {
    let mut at = first;
    let stops = (0..stops).map(|_| {
        let here = at;
        at = (at + random.pick(&[0.0, 1e-6, 1e-3, 0.05, 0.13])).max(at.next_up()).max(low);
        RampStop { at: here, color: random.color() }
    });
    Ramp { stops: stops.collect(), blend }
}

fn models(stops: impl Fn(usize) -> u32) -> Vec<Ramp> {
    let random = Random::new(6);
    let model = |number| {
        let blend = if number % 2 == 0 { RampBlend::Hard } else { RampBlend::Smooth };
        let first = random.range(-1.0, 0.5);
        any_ramp(&random, blend, stops(number), first, -1.0)
    };
    (0..MODELS).map(model).collect()
}

fn models_2d() -> Vec<Ramp2d> {
    let random = Random::new(7);
    let ramp = |random: &Random| {
        let blend = random.pick(&[RampBlend::Hard, RampBlend::Hard, RampBlend::Smooth]);
        let first = if blend == RampBlend::Hard { random.pick(&[-1.0, 0.0]) } else { 0.0 };
        let stops = random.below(MAX_STOPS as u32) + 1;
        any_ramp(random, blend, stops, first, 1e-6)
    };
    let model = |_| {
        let corner = Corner { threshold: random.range(0.1, 1.4), color: random.color() };
        let corner = if random.one_in(4) { None } else { Some(corner) };
        Ramp2d { a: ramp(&random), b: ramp(&random), corner }
    };
    (0..MODELS).map(model).collect()
}

fn places(ramp: &Ramp) -> Vec<f32> {
    ramp.stops.iter().map(|stop| stop.at).collect()
}

fn color(rgb: DVec3) -> DVec4 {
    rgb.extend(0.0)
}

fn number(x: f32) -> f64 {
    f64::from(x)
}

/// Neither widths nor close stops amplify errors: lookup coordinates and stops are f32 already, and the difference of
/// two close f32 is exact.
const RAMP: &[Check<Ramp>] = &[Check {
    name: "toon_ramp",
    wgsl: "vec4(toon_ramp(u, a.x, a.y), 0.0)",
    given: |random, ramp| {
        let width = random.width();
        [Vec4::new(random.near(&places(ramp), width), width, 0.0, 0.0); 4]
    },
    rust: |ramp, g| color(toon_ramp(ramp, number(g[0].x), number(g[0].y))),
    allowed: |_, _| Allowed::Within(SMALL),
}];

/// u and v beyond 0..=1 and at stops, or the corner's border; and widths of both.
fn reach(random: &Random, ramps: &Ramp2d) -> Given {
    let widths = Vec2::new(random.width(), random.width());
    let mut uv = Vec2::new(random.near(&places(&ramps.a), widths.x), random.near(&places(&ramps.b), widths.y));
    if let Some(corner) = ramps.corner.filter(|_| random.one_in(2)) {
        let angle = random.range(0.0, std::f32::consts::FRAC_PI_2);
        uv = Vec2::from_angle(angle) * random.near(&[corner.threshold], widths.max_element());
    }
    // Vectors shorter than 1e-15 have a direction only in f64, and so another width.
    let uv = uv.map(|x| if x.abs() < 1e-14 { 0.0 } else { x });
    [Vec4::new(uv.x, uv.y, widths.x, widths.y), Vec4::splat(random.range(0.1, 1.4)), Vec4::ZERO, Vec4::ZERO]
}

/// The corner's border depends on the length of (u, v), whose error in f32 is about 2e-7, and coverage is that over the
/// width; below a width of 2^-23 it is a step, as for other borders. Inputs within 1e-5 of the threshold are exempt if
/// the width is less than that.
fn corner_bound(uv: Vec4, threshold: f32) -> Allowed {
    let (uv, widths) = (DVec2::new(number(uv.x), number(uv.y)), DVec2::new(number(uv.z), number(uv.w)));
    let reach = uv.clamp(DVec2::ZERO, DVec2::ONE);
    let length = reach.length();
    let moving = DVec2::select(uv.cmplt(DVec2::ONE), widths, DVec2::ZERO);
    let width = if length > 0.0 { reach.dot(moving) / length } else { 0.0 };
    let off = (length - number(threshold)).abs();
    // Beyond the pixel the coverage is 0 or 1.
    if off > width / 2.0 + SMALL {
        Allowed::Within(SMALL)
    } else if width > SMALL {
        Allowed::Within(SMALL + 2e-7 / width)
    } else {
        Allowed::Anything
    }
}

const RAMP_2D: &[Check<Ramp2d>] = &[
    Check {
        name: "toon_corner",
        wgsl: "vec4(toon_corner(a.xy, a.zw, u.corner.w))",
        given: reach,
        rust: |ramps, g| {
            let [u, v, along_u, along_v] = g[0].as_dvec4().to_array();
            let threshold = ramps.corner.map_or(1e4, |corner| number(corner.threshold));
            DVec4::splat(toon_corner(DVec2::new(u, v), DVec2::new(along_u, along_v), threshold))
        },
        allowed: |ramps, g| corner_bound(g[0], ramps.corner.map_or(1e4, |corner| corner.threshold)),
    },
    Check {
        name: "toon_ramp_2d",
        wgsl: "vec4(toon_ramp_2d(u, a.xy, a.zw), 0.0)",
        given: reach,
        rust: |ramps, g| {
            let [u, v, along_u, along_v] = g[0].as_dvec4().to_array();
            color(toon_ramp_2d(ramps, DVec2::new(u, v), DVec2::new(along_u, along_v)))
        },
        // The corner's coverage multiplies colours that differ by at most 2.
        allowed: |ramps, g| match ramps.corner.map(|corner| corner_bound(g[0], corner.threshold)) {
            Some(Allowed::Within(bound)) => Allowed::Within(SMALL + 2.0 * (bound - SMALL)),
            Some(other) => other,
            None => Allowed::Within(SMALL),
        },
    },
];

/// The level of detail, which needs no model, and the mean of two ramps by it.
const X_TOON: &[Check<Ramp2d>] = &[
    Check {
        name: "toon_depth_detail",
        wgsl: "vec4(toon_depth_detail(a.x, a.y, a.z))",
        given: |random, _| {
            let near = random.log_range(1e-3, 1e6);
            let far = near * random.range(1.2, 100.0);
            let depth =
                random.pick(&[near, far, random.range(0.5 * near, 1.2 * far), near * random.log_range(1.0, 100.0)]);
            [Vec4::new(depth, near, far, 0.0); 4]
        },
        rust: |_, g| DVec4::splat(toon_depth_detail(number(g[0].x), number(g[0].y), number(g[0].z))),
        // WGSL's logarithm has an error of 2^-21 around 1, and the smallest divisor is ln 1.2.
        allowed: |_, _| Allowed::Within(SMALL),
    },
    Check {
        name: "toon_silhouette_detail",
        wgsl: "vec4(toon_silhouette_detail(a.x, a.y))",
        given: |random, _| {
            let n_dot_v = random.pick(&[0.0, 1.0, -1.0, random.range(-1.0, 1.0), random.range(-1.1, 1.1)]);
            [Vec4::new(n_dot_v, random.log_range(0.25, 16.0), 0.0, 0.0); 4]
        },
        rust: |_, g| DVec4::splat(toon_silhouette_detail(number(g[0].x), number(g[0].y))),
        // The same for log2, times the exponent.
        allowed: |_, g| Allowed::Within(SMALL + number(g[0].y) * 2f64.powi(-21)),
    },
    Check {
        name: "toon_x_toon",
        wgsl: "vec4(toon_x_toon(u.a, u.b, a.x, a.y, a.z), 0.0)",
        given: |random, ramps| {
            let (width, detail) = (random.width(), random.pick(&[0.0, 1.0, random.unit()]));
            let places = [places(&ramps.a), places(&ramps.b)].concat();
            [Vec4::new(random.near(&places, width), width, detail, 0.0); 4]
        },
        rust: |ramps, g| color(toon_x_toon(&ramps.a, &ramps.b, number(g[0].x), number(g[0].y), number(g[0].z))),
        allowed: |_, _| Allowed::Within(SMALL),
    },
];

/// A coordinate, the range of a row, and its number of texels.
fn place(random: &Random, _: &Ramp) -> Given {
    let (start, length) =
        (random.pick(&[0.0, -1.0, random.range(-2.0, 1.0)]), random.pick(&[1.0, 2.0, random.unit() + 0.1]));
    let (end, count) = (start + length, random.pick(&[1, 2, 3, 16, 256, random.below(64) + 1]));
    let texel = length / count as f32;
    let border = start + texel * random.below(count + 1) as f32;
    let x = match random.below(16) {
        // Borders and centres of texels, far away, and anywhere.
        0 => border,
        1 => border + texel / 2.0,
        2 => border + texel * random.range(-1e-3, 1e-3),
        3 => random.pick(&[-1.0, 1.0]) * random.log_range(1.0, 1e30),
        _ => random.range(start - 0.2 * length, end + 0.2 * length),
    };
    [Vec4::new(x, start, end, count as f32), Vec4::ZERO, Vec4::ZERO, Vec4::ZERO]
}

/// Whether `t` texels from the row's start is within 1e-5 of the row from a place where the texel changes.
fn at_a_border(g: &Given, t: f64) -> bool {
    let count = number(g[0].w);
    t > 0.5 && t < count - 0.5 && (t - t.round()).abs() < SMALL * count
}

fn texels(g: &Given) -> f64 {
    (number(g[0].x) - number(g[0].y)) / (number(g[0].z) - number(g[0].y)) * number(g[0].w)
}

const ROWS: &[Check<Ramp>] = &[
    Check {
        name: "toon_row_nearest",
        wgsl: "vec4(f32(toon_row_nearest(a.x, a.y, a.z, u32(a.w))))",
        given: place,
        rust: |_, g| {
            let texel = toon_row_nearest(number(g[0].x), number(g[0].y), number(g[0].z), g[0].w as u32);
            DVec4::splat(f64::from(texel))
        },
        allowed: |_, g| if at_a_border(g, texels(g)) { Allowed::Anything } else { Allowed::Within(0.0) },
    },
    Check {
        name: "toon_row_taps",
        wgsl: "taps(toon_row_taps(a.x, a.y, a.z, u32(a.w)))",
        given: place,
        rust: |_, g| {
            let taps = toon_row_taps(number(g[0].x), number(g[0].y), number(g[0].z), g[0].w as u32);
            DVec4::new(f64::from(taps.left), f64::from(taps.right), taps.share, 0.0)
        },
        // Weights are in texels, so an error of 1e-5 of the row is multiplied by its number of texels. Texels must be
        // equal, except at centres, where the left one may be the previous one with a weight of nearly 1.
        allowed: |_, g| {
            let s = texels(g) - 0.5;
            let at_a_centre = s > -0.5 && s < number(g[0].w) && (s - s.round()).abs() < SMALL * number(g[0].w);
            if at_a_centre { Allowed::Anything } else { Allowed::Within(SMALL * number(g[0].w)) }
        },
    },
    Check {
        name: "toon_table_mix",
        wgsl: "toon_table_mix(a, b, c, d, a.w, b.w)",
        given: |random, _| [(); 4].map(|()| with(random.color(), random.pick(&[0.0, 1.0, random.unit()]))),
        rust: |_, g| {
            let [a, b, c, d] = g.map(|v| v.truncate().as_dvec3());
            let mixed = toon_table_mix(a, b, c, d, number(g[0].w), number(g[1].w));
            // Colours have four components there and three here; alpha is checked as the first component of other
            // inputs.
            let [a, b, c, d] = g.map(|v| DVec3::splat(number(v.w)));
            mixed.extend(toon_table_mix(a, b, c, d, number(g[0].w), number(g[1].w)).x)
        },
        allowed: |_, _| Allowed::Within(SMALL),
    },
];

pub fn calls() -> Vec<&'static str> {
    let expressions = |checks: &[Check<Ramp>]| checks.iter().map(|check| check.wgsl).collect::<Vec<_>>();
    let of_two = RAMP_2D.iter().chain(X_TOON).map(|check| check.wgsl).collect();
    [expressions(RAMP), expressions(ROWS), of_two].concat()
}

fn pack(ramp: &Ramp) -> RampUniform {
    RampUniform::new(ramp).expect("it is valid")
}

#[test]
fn ramps_are_their_reference() {
    let Some(gpu) = crate::device() else { return };
    let any = models(|number| number as u32 % MAX_STOPS as u32 + 1);
    compare(&gpu, npr_toon::WGSL, "ToonRamp", &[], &any, pack, RAMP);
    for count in [1, 3] {
        println!("{TOON_STOPS_OVERRIDE} = {count}");
        let constants = [(TOON_STOPS_OVERRIDE, f64::from(count))];
        compare(&gpu, npr_toon::WGSL, "ToonRamp", &constants, &models(|_| count), pack, RAMP);
    }
}

#[test]
fn ramps_of_two_lights_are_their_reference() {
    let Some(gpu) = crate::device() else { return };
    let pack = |ramps: &Ramp2d| Ramp2dUniform::new(ramps).expect("they are valid");
    compare(&gpu, npr_toon::WGSL, "ToonRamp2d", &[], &models_2d(), pack, RAMP_2D);
    compare(&gpu, npr_toon::WGSL, "ToonRamp2d", &[], &models_2d(), pack, X_TOON);
}

#[test]
fn rows_are_their_reference() {
    let Some(gpu) = crate::device() else { return };
    let library = npr_toon::WGSL.to_owned()
        + "fn taps(t: ToonTaps) -> vec4<f32> { return vec4(f32(t.left), f32(t.right), t.share, 0.0); }";
    compare(&gpu, &library, "ToonRamp", &[], &models(|_| 1), pack, ROWS);
}
