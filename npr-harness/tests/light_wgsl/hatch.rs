//! Checks of npr-hatch, except for its texture lookups. No function needs a uniform.

use crate::check::{Allowed, Check, Given, MODELS, SMALL, compare};
use crate::random::{Random, with};
use glam::{DVec2, DVec3, DVec4, Vec2, Vec3, Vec4};
use npr_hatch::lookup::{
    HatchFootprint, HatchTaps, hatch_flat_weight, hatch_footprint, hatch_samples, hatch_soft_tone, hatch_taps,
};
use npr_hatch::mapping::{
    HatchBlend, hatch_direction_step, hatch_doubled_angle, hatch_octave, hatch_offset, hatch_plane,
    hatch_plane_weights, hatch_rotate, hatch_share_tone,
};
use npr_hatch::{
    hatch_blend, hatch_color, hatch_level, hatch_level_of_tone, hatch_threshold, hatch_tone_in_shadow, hatch_transfer,
    hatch_weights,
};

fn xyz(v: Vec4) -> DVec3 {
    v.truncate().as_dvec3()
}

fn x(v: Vec4) -> f64 {
    f64::from(v.x)
}

fn small(_: &(), _: &Given) -> Allowed {
    Allowed::Within(SMALL)
}

fn xy(v: Vec4) -> DVec2 {
    DVec2::new(f64::from(v.x), f64::from(v.y))
}

fn zw(v: Vec4) -> DVec2 {
    DVec2::new(f64::from(v.z), f64::from(v.w))
}

/// At and around integers, where the weights have kinks, and far away.
fn factor(random: &Random) -> f32 {
    let near = random.near(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0], 1.0);
    random.pick(&[near, near, near, random.range(-20.0, 20.0)])
}

/// Six tones that decrease by at least 1/50, and any tone.
fn tones(random: &Random, _: &()) -> Given {
    let mut tone = 1.0;
    let tones = [(); 6].map(|()| {
        tone -= random.range(0.02, 0.16);
        tone
    });
    let asked = random.pick(&[tones[random.below(6) as usize], random.range(-0.2, 1.2)]);
    [with(Vec3::from_slice(&tones), 0.0), with(Vec3::from_slice(&tones[3..]), 0.0), Vec4::splat(asked), Vec4::ZERO]
}

/// Two packed texels and a light factor.
fn texels(random: &Random, _: &()) -> Given {
    [with(random.color(), 0.0), with(random.color(), 0.0), Vec4::splat(factor(random)), Vec4::ZERO]
}

/// The derivatives of texture coordinates along x and y, the number of texels and of levels.
fn derivatives(random: &Random, _: &()) -> Given {
    let last = 4.0 + random.below(7) as f32;
    let texels = random.pick(&[1.0, 1.0, 0.7, 1.3]) * last.exp2();
    let long = random.log_range(0.01, 2000.0) / texels;
    let ratio = random.pick(&[1.0, random.range(1.0, 3.0), random.range(1.0, 20.0), random.log_range(1.0, 1e4)]);
    let [axis, screen] = [(); 2].map(|()| Vec2::from_angle(random.range(-3.2, 3.2)));
    let axis = random.pick(&[Vec2::X, Vec2::Y, axis, axis, axis]);
    let screen = random.pick(&[Vec2::X, screen, screen]);
    let (longer, shorter) = (axis * long, axis.perp() * (long / ratio));
    let (dx, dy) = (longer * screen.x + shorter * screen.y, shorter * screen.x - longer * screen.y);
    let (dx, dy) = match random.below(20) {
        0 => (dx, Vec2::ZERO),
        1 => (Vec2::ZERO, dy),
        2 => (dx, dx * random.range(-2.0, 2.0)),
        3 => (Vec2::ZERO, Vec2::ZERO),
        _ => (dx, dy),
    };
    [Vec4::new(dx.x, dx.y, dy.x, dy.y), Vec4::new(texels, last, 0.0, 0.0), Vec4::ZERO, Vec4::ZERO]
}

fn footprint(g: &Given) -> HatchFootprint {
    hatch_footprint(xy(g[0]), zw(g[0]), x(g[1]), f64::from(g[1].y))
}

/// s sᵀ / |s| of the spread in texels of its level, up to 2.6.
fn spread(_: &(), g: &Given) -> DVec4 {
    let HatchFootprint { level, spread } = footprint(g);
    let s = spread * (x(g[1]) / level.exp2());
    DVec4::new(s.x * s.x, s.x * s.y, s.y * s.y, 0.0) / s.length().max(1e-30)
}

/// The area is a difference of products, each rounded: its error is 2⁻²² of the longer axis' square, since the
/// derivatives in texels are rounded too. Where the ratio is at most 16, its relative error is 16 · 2⁻²² = 4e-6; its
/// root, up to 4, has half of that: 8e-6. A level has an error of 2e-6, so the longer axis in texels of that level has
/// one of 4 · 1.4e-6. The rest is rounding of values up to 4: together 2e-5.
fn spread_bound(_: &(), _: &Given) -> Allowed {
    Allowed::Within(2e-5)
}

/// A position, and the side of a level as a power of two.
fn place(random: &Random, _: &()) -> Given {
    let side = (random.below(9) as f32).exp2();
    let centre = |random: &Random| (random.below(6 * side as u32) as f32 + random.pick(&[0.0, 0.5])) / side - 3.0;
    let place = [(); 2].map(|()| {
        let centre = centre(random);
        random.pick(&[centre, centre.next_up(), centre.next_down(), random.range(-3.0, 3.0), random.range(-3.0, 3.0)])
    });
    [Vec4::new(place[0], place[1], side, 0.0); 4]
}

/// The position of a number on a circle of length `turn`, so that 0 and `turn` are equal: two triangle waves, a quarter
/// apart.
fn on_circle(number: f64, turn: f64) -> DVec2 {
    (DVec2::new(number, number + 0.25 * turn).map(|at| at.rem_euclid(turn)) - 0.5 * turn).abs()
}

fn low_taps(_: &(), g: &Given) -> DVec4 {
    let HatchTaps { low, share, .. } = hatch_taps(xy(g[0]), g[0].z as u32);
    let at = low.as_dvec2() + share;
    let [x, y] = [at.x, at.y].map(|at| on_circle(at, f64::from(g[0].z)));
    DVec4::new(x.x, x.y, y.x, y.y)
}

/// A position times a power of two is exact; subtracting half a texel rounds by up to 2⁻¹⁵ for 768 texels. Mapping it
/// to the circle rounds values up to 384 by 2⁻¹⁷ twice. On the circle, steps between texels are continuous.
fn taps_bound(_: &(), _: &Given) -> Allowed {
    Allowed::Within(5e-5)
}

/// The texel after `low`.
fn high_taps(_: &(), g: &Given) -> DVec4 {
    let HatchTaps { low, high, .. } = hatch_taps(xy(g[0]), g[0].z as u32);
    let side = g[0].z as u32;
    let after = ((low + 1) % side).as_dvec2();
    assert_eq!(high.as_dvec2(), after);
    DVec4::ZERO
}

/// A normal for the planes' weights, of any length, mostly 1.
fn normal(random: &Random, _: &()) -> Given {
    let unit = random.direction();
    let axis = random.pick(&[Vec3::X, Vec3::Y, Vec3::Z]);
    let near = (axis + random.range(0.0, 1.0) * unit).normalize();
    let normal = random.pick(&[unit, near, near, axis, -axis, Vec3::splat(0.577_350_26)]);
    let normal = if random.one_in(30) { Vec3::ZERO } else { normal };
    [with(normal, 0.0); 4]
}

/// A point, a tensor of a direction or of the mean of several, and an axis.
fn seen(random: &Random, _: &()) -> Given {
    let (d, e, share) = (random.direction(), random.direction(), random.pick(&[0.0, random.unit()]));
    let element = |a: fn(Vec3) -> f32| a(d) + (a(e) - a(d)) * share;
    let diagonal = Vec3::new(element(|d| d.x * d.x), element(|d| d.y * d.y), element(|d| d.z * d.z));
    let others = Vec3::new(element(|d| d.x * d.y), element(|d| d.x * d.z), element(|d| d.y * d.z));
    [with(diagonal, 0.0), with(others, 0.0), Vec4::splat(random.below(3) as f32), Vec4::ZERO]
}

/// A vector of a doubled angle, of any length: at, near and between the borders of the turns.
fn doubled(random: &Random, _: &()) -> Given {
    let step = std::f32::consts::PI / 6.0;
    let turn = random.below(13) as f32 - 6.0;
    let near = (turn + random.pick(&[0.0, 0.375, 0.5, 0.625])) * step + random.range(-1e-4, 1e-4);
    let angle = random.pick(&[turn * step, near, near, random.range(-3.2, 3.2)]);
    let length = random.pick(&[1.0, random.unit(), random.log_range(1e-6, 1.0)]);
    let there = Vec2::from_angle(angle) * length;
    let axes = [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y, Vec2::new(-1.0, -0.0)];
    let there = if random.one_in(20) { random.pick(&axes) } else { there };
    [there.extend(0.0).extend(0.0); 4]
}

fn turned_between(_: &(), g: &Given) -> DVec4 {
    let HatchBlend { first, share } = hatch_direction_step(xy(g[0]));
    let at = on_circle(f64::from(first) + share, 12.0);
    DVec4::new(at.x, at.y, 0.0, 0.0)
}

/// An arc tangent with an error up to 1e-5 (it is a polynomial; Vulkan allows 4096 ulp, 1e-3) gives 2e-5 turns; sums
/// and products up to 18 turns give 4e-6; a share is four times as steep.
fn turn_bound(_: &(), _: &Given) -> Allowed {
    Allowed::Within(1e-4)
}

fn octave(random: &Random, _: &()) -> Given {
    let whole = random.below(21) as f32 - 10.0;
    let at = whole + random.pick(&[0.0, 0.375, 0.5, 0.625]);
    [Vec4::splat(random.pick(&[whole, at, at.next_up(), at.next_down(), random.range(-10.0, 10.0)])); 4]
}

fn turn(random: &Random, _: &()) -> Given {
    let numbers = Vec4::new(random.range(-10.0, 10.0), random.range(-10.0, 10.0), random.below(12) as f32, 0.0);
    [numbers; 4]
}

/// Sines with an error of 2⁻²⁰ (on hardware; Vulkan allows 2⁻¹¹) and angles rounded by 2⁻²³, times two positions of up
/// to 10, and rounding of values up to 20.
fn turned_bound(_: &(), _: &Given) -> Allowed {
    Allowed::Within(4e-5)
}

fn tone_and_share(random: &Random, _: &()) -> Given {
    let tone = random.pick(&[0.0, 1.0, 1e-6, random.log_range(1e-7, 1.0), random.unit(), random.unit()]);
    [Vec4::new(tone, random.pick(&[0.0, 1.0, random.unit(), random.unit()]), 0.0, 0.0); 4]
}

/// Functions that the checks call, appended to the library: see [`spread`] and [`on_circle`].
const CONTINUOUS: &str = "
    fn spread_line(footprint: HatchFootprint, texels: f32) -> vec4<f32> {
        let s = footprint.spread * (texels / exp2(footprint.level));
        return vec4(s.x * s.x, s.x * s.y, s.y * s.y, 0.0) / max(length(s), 1e-30);
    }
    fn wave(number: f32, turn: f32) -> f32 {
        return abs(number - turn * floor(number / turn) - 0.5 * turn);
    }
    fn on_circle(number: f32, turn: f32) -> vec2<f32> {
        return vec2(wave(number, turn), wave(number + 0.25 * turn, turn));
    }
    fn taps_on_circle(taps: HatchTaps, side: f32) -> vec4<f32> {
        let at = vec2<f32>(taps.low) + taps.share;
        return vec4(on_circle(at.x, side), on_circle(at.y, side));
    }
    fn high_beside_low(taps: HatchTaps, side: u32) -> vec4<f32> {
        return vec4(vec2<f32>(taps.high) - vec2<f32>((taps.low + 1u) % side), 0.0, 0.0);
    }
    fn step_on_circle(at: HatchBlend) -> vec4<f32> {
        return vec4(on_circle(f32(at.first) + at.share, 12.0), 0.0, 0.0);
    }
    fn step_as_number(at: HatchBlend) -> vec4<f32> {
        return vec4(f32(at.first) + at.share);
    }";

const CHECKS: &[Check<()>] = &[
    Check {
        name: "hatch_level",
        wgsl: "vec4(hatch_level(a.x, a.y))",
        given: |random, ()| [Vec4::new(random.range(0.0, 8.0), random.range(-1.0, 1.0), 0.0, 0.0); 4],
        rust: |(), g| DVec4::splat(hatch_level(x(g[0]), f64::from(g[0].y))),
        allowed: small,
    },
    Check {
        name: "hatch_weights, lighter",
        wgsl: "vec4(hatch_weights(c.x).light, 0.0)",
        given: texels,
        rust: |(), g| hatch_weights(x(g[2])).light.extend(0.0),
        allowed: small,
    },
    Check {
        name: "hatch_weights, darker",
        wgsl: "vec4(hatch_weights(c.x).dark, 0.0)",
        given: texels,
        rust: |(), g| hatch_weights(x(g[2])).dark.extend(0.0),
        allowed: small,
    },
    Check {
        name: "hatch_blend",
        wgsl: "vec4(hatch_blend(a.rgb, b.rgb, hatch_weights(c.x)))",
        given: texels,
        rust: |(), g| DVec4::splat(hatch_blend(xyz(g[0]), xyz(g[1]), hatch_weights(x(g[2])))),
        allowed: small,
    },
    Check {
        name: "hatch_transfer",
        wgsl: "vec4(hatch_transfer(a.rgb, b.rgb, c.x))",
        given: texels,
        rust: |(), g| DVec4::splat(hatch_transfer(xyz(g[0]), xyz(g[1]), x(g[2]))),
        allowed: small,
    },
    Check {
        name: "hatch_level_of_tone",
        wgsl: "vec4(hatch_level_of_tone(a.rgb, b.rgb, c.x))",
        given: tones,
        rust: |(), g| DVec4::splat(hatch_level_of_tone(xyz(g[0]), xyz(g[1]), x(g[2]))),
        allowed: small,
    },
    Check {
        name: "hatch_tone_in_shadow",
        wgsl: "vec4(hatch_tone_in_shadow(a.x, a.y, a.z))",
        given: |random, ()| {
            let lit = random.pick(&[0.0, 1.0, random.unit()]);
            [Vec4::new(random.unit(), random.range(0.0, 0.5), lit, 0.0); 4]
        },
        rust: |(), g| DVec4::splat(hatch_tone_in_shadow(x(g[0]), f64::from(g[0].y), f64::from(g[0].z))),
        allowed: small,
    },
    Check {
        name: "hatch_color",
        wgsl: "vec4(hatch_color(c.x, a.rgb, b.rgb), 0.0)",
        given: |random, ()| {
            [with(random.color(), 0.0), with(random.color(), 0.0), Vec4::splat(random.unit()), Vec4::ZERO]
        },
        rust: |(), g| hatch_color(x(g[2]), xyz(g[0]), xyz(g[1])).extend(0.0),
        allowed: small,
    },
    Check {
        name: "hatch_threshold",
        wgsl: "vec4(hatch_threshold(a.x, a.y, a.z))",
        given: |random, ()| {
            let (texel, width) = (random.unit(), random.pick(&[0.0, 0.02, random.range(0.02, 1.0)]));
            let tone = random.pick(&[texel, random.unit(), texel + random.range(-0.6, 0.6) * width]);
            [Vec4::new(texel, tone, width, 0.0); 4]
        },
        rust: |(), g| DVec4::splat(hatch_threshold(x(g[0]), f64::from(g[0].y), f64::from(g[0].z))),
        allowed: small,
    },
    Check {
        name: "hatch_flat_weight",
        wgsl: "vec4(hatch_flat_weight(a.x, a.y))",
        given: |random, ()| {
            let last_level = random.pick(&[2.0, 8.0, 12.0]);
            let level = random.pick(&[last_level, random.range(0.0, last_level), last_level - random.range(2.5, 4.5)]);
            [Vec4::new(level, last_level, 0.0, 0.0); 4]
        },
        rust: |(), g| DVec4::splat(hatch_flat_weight(x(g[0]), f64::from(g[0].y))),
        allowed: small,
    },
    Check {
        name: "hatch_samples",
        wgsl: "vec4(f32(hatch_samples(HatchFootprint(a.x, a.yz))))",
        given: |random, ()| {
            let part = || random.pick(&[0.0, 0.0, random.range(-1.0, 1.0)]);
            [Vec4::new(random.unit(), part(), part(), 0.0); 4]
        },
        rust: |(), g| {
            let spread = g[0].as_dvec4().truncate();
            DVec4::splat(
                hatch_samples(HatchFootprint { level: spread.x, spread: DVec2::new(spread.y, spread.z) }).into(),
            )
        },
        allowed: |_, _| Allowed::Within(0.0),
    },
    Check {
        name: "hatch_soft_tone",
        wgsl: "vec4(hatch_soft_tone(a.x, a.y))",
        given: |random, ()| {
            let tone = random.pick(&[0.0, 1.0, random.range(-0.2, 1.2), random.unit(), random.log_range(1e-6, 1.0)]);
            [Vec4::new(tone, random.pick(&[0.0, 1.0 / 64.0, random.unit()]), 0.0, 0.0); 4]
        },
        rust: |(), g| DVec4::splat(hatch_soft_tone(x(g[0]), f64::from(g[0].y))),
        allowed: small,
    },
    Check {
        name: "hatch_footprint, level",
        wgsl: "vec4(hatch_footprint(a.xy, a.zw, b.x, b.y).level)",
        given: derivatives,
        rust: |(), g| DVec4::splat(footprint(g).level),
        allowed: small,
    },
    Check {
        name: "hatch_footprint, spread",
        wgsl: "spread_line(hatch_footprint(a.xy, a.zw, b.x, b.y), b.x)",
        given: derivatives,
        rust: spread,
        allowed: spread_bound,
    },
    Check {
        name: "hatch_taps, low and share",
        wgsl: "taps_on_circle(hatch_taps(a.xy, u32(a.z)), a.z)",
        given: place,
        rust: low_taps,
        allowed: taps_bound,
    },
    Check {
        name: "hatch_taps, high",
        wgsl: "high_beside_low(hatch_taps(a.xy, u32(a.z)), u32(a.z))",
        given: place,
        rust: high_taps,
        allowed: |(), _| Allowed::Within(0.0),
    },
    Check {
        name: "hatch_plane_weights",
        wgsl: "vec4(hatch_plane_weights(a.xyz), 0.0)",
        given: normal,
        rust: |(), g| hatch_plane_weights(xyz(g[0])).extend(0.0),
        allowed: small,
    },
    Check {
        name: "hatch_plane",
        wgsl: "vec4(hatch_plane(a.xyz, u32(c.x)), 0.0, 0.0)",
        given: seen,
        rust: |(), g| hatch_plane(xyz(g[0]), g[2].x as u32).extend(0.0).extend(0.0),
        allowed: |(), _| Allowed::Within(0.0),
    },
    Check {
        name: "hatch_doubled_angle",
        wgsl: "vec4(hatch_doubled_angle(a.xyz, b.xyz, u32(c.x)), 0.0, 0.0)",
        given: seen,
        rust: |(), g| hatch_doubled_angle(xyz(g[0]), xyz(g[1]), g[2].x as u32).extend(0.0).extend(0.0),
        allowed: small,
    },
    Check {
        name: "hatch_direction_step",
        wgsl: "step_on_circle(hatch_direction_step(a.xy))",
        given: doubled,
        rust: turned_between,
        allowed: turn_bound,
    },
    Check {
        name: "hatch_octave",
        wgsl: "step_as_number(hatch_octave(a.x))",
        given: octave,
        rust: |(), g| {
            let HatchBlend { first, share } = hatch_octave(x(g[0]));
            DVec4::splat(f64::from(first) + share)
        },
        allowed: small,
    },
    Check {
        name: "hatch_rotate",
        wgsl: "vec4(hatch_rotate(a.xy, i32(a.z)), 0.0, 0.0)",
        given: turn,
        rust: |(), g| hatch_rotate(xy(g[0]), g[0].z as i32).extend(0.0).extend(0.0),
        allowed: turned_bound,
    },
    Check {
        name: "hatch_offset",
        wgsl: "vec4(hatch_offset(i32(a.x)), 0.0, 0.0)",
        given: |random, ()| [Vec4::splat(random.below(81) as f32 - 40.0); 4],
        rust: |(), g| hatch_offset(g[0].x as i32).extend(0.0).extend(0.0),
        allowed: small,
    },
    Check {
        name: "hatch_share_tone",
        wgsl: "vec4(hatch_share_tone(a.x, a.y))",
        given: tone_and_share,
        rust: |(), g| DVec4::splat(hatch_share_tone(x(g[0]), f64::from(g[0].y))),
        allowed: small,
    },
];

pub fn calls() -> Vec<&'static str> {
    CHECKS.iter().map(|check| check.wgsl).collect()
}

#[test]
fn hatch_is_its_reference() {
    let Some(gpu) = crate::device() else { return };
    let library = [npr_hatch::WGSL, CONTINUOUS].concat();
    compare(&gpu, &library, "vec4<f32>", &[], &[(); MODELS], |()| [0.0_f32; 4], CHECKS);
}
