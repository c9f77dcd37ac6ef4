//! npr-hatch. Nothing in it needs a uniform.

use crate::check::{Allowed, Check, Given, MODELS, SMALL, compare};
use crate::random::{Random, with};
use glam::{DVec3, DVec4, Vec3, Vec4};
use npr_hatch::{hatch_blend, hatch_color, hatch_level, hatch_linear, hatch_threshold, hatch_transfer, hatch_weights};

fn xyz(v: Vec4) -> DVec3 {
    v.truncate().as_dvec3()
}

fn x(v: Vec4) -> f64 {
    f64::from(v.x)
}

fn small(_: &(), _: &Given) -> Allowed {
    Allowed::Within(SMALL)
}

/// At and around the whole numbers, where the weights are bent, and far away.
fn factor(random: &Random) -> f32 {
    let near = random.near(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0], 1.0);
    random.pick(&[near, near, near, random.range(-20.0, 20.0)])
}

/// Six tones that fall by a fiftieth or more, and a tone anywhere.
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
        name: "hatch_linear",
        wgsl: "vec4(hatch_linear(a.rgb, b.rgb, c.x))",
        given: tones,
        rust: |(), g| DVec4::splat(hatch_linear(xyz(g[0]), xyz(g[1]), x(g[2]))),
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
];

pub fn calls() -> Vec<&'static str> {
    CHECKS.iter().map(|check| check.wgsl).collect()
}

#[test]
fn hatch_is_its_reference() {
    let Some(gpu) = crate::device() else { return };
    compare(&gpu, npr_hatch::WGSL, "vec4<f32>", &[], &[(); MODELS], |()| [0.0_f32; 4], CHECKS);
}
