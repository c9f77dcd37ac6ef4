//! Checks of npr-gooch.

use crate::check::{Allowed, Check, Given, MODELS, SMALL, compare};
use crate::random::{Random, with};
use glam::{DVec3, DVec4, Vec4};
use npr_gooch::{
    Gooch, GoochUniform, Highlight, Tones, gooch_cool, gooch_highlight, gooch_n_dot_l, gooch_over, gooch_r_dot_e,
    gooch_r_dot_e_unit, gooch_shade, gooch_tone, gooch_warm, gooch_weight,
};

fn xyz(v: Vec4) -> DVec3 {
    v.truncate().as_dvec3()
}

fn color(rgb: DVec3) -> DVec4 {
    rgb.extend(0.0)
}

/// Presets, and models with sums beyond 1, both pairings and no highlight.
fn models() -> Vec<Gooch> {
    let random = Random::new(2);
    let any = |random: &Random| {
        let highlight = Highlight {
            color: random.color(),
            strength: random.pick(&[1.0, 0.5, random.unit()]),
            exponent: random.log_range(1.0, 128.0),
        };
        Gooch {
            blue: random.color(),
            yellow: random.color(),
            alpha: random.range(0.0, 1.5),
            beta: random.range(0.0, 1.5),
            tones: random.pick(&[Tones::Equation, Tones::SwappedShares]),
            highlight: if random.one_in(4) { None } else { Some(highlight) },
        }
    };
    let presets = [Gooch::default(), Gooch::swapped_shares()];
    presets.into_iter().chain((2..MODELS).map(|_| any(&random))).collect()
}

fn small(_: &Gooch, _: &Given) -> Allowed {
    Allowed::Within(SMALL)
}

/// WGSL's `pow` is exp2(n log2 x), with an error of log2 up to 2^-21 and so of x^n up to n · 3.3e-7; up to the default
/// of n = 32 that is the common bound.
fn highlight_bound(model: &Gooch, _: &Given) -> Allowed {
    Allowed::Within(model.highlight.map_or(SMALL, |highlight| SMALL * (f64::from(highlight.exponent) / 32.0).max(1.0)))
}

/// The error is at most the highlight itself, though (R·E)^n changes n (R·E)^(n-1) times as fast as R·E, whose error in
/// f32 is up to 8e-7 from its dot products: see `gooch_r_dot_e_unit`.
///
/// At N·L = 0 the highlight ends, with a jump at grazing angles: inputs are exempt if f32 may be on the other side.
fn shade_bound(model: &Gooch, g: &Given) -> Allowed {
    let n_dot_l = gooch_n_dot_l(xyz(g[0]), xyz(g[1]));
    let r_dot_e = gooch_r_dot_e(xyz(g[0]), xyz(g[1]), xyz(g[2])).clamp(0.0, 1.0);
    if n_dot_l != 0.0 && n_dot_l.abs() < SMALL && gooch_highlight(model, 1.0, r_dot_e) > SMALL {
        return Allowed::Anything;
    }
    highlight_bound(model, g)
}

/// Two vectors and the object's colour, and the eye's direction.
fn scene(random: &Random, _: &Gooch) -> Given {
    let normal = random.vector();
    let (to_light, to_eye) = (random.beside(normal), random.beside(normal));
    // Sometimes the eye is in the direction of the mirrored light.
    let n = normal.normalize_or_zero();
    let mirrored = to_light.normalize_or_zero().reflect(n) * -1.0;
    let to_eye = if random.one_in(3) { mirrored + random.direction() * random.log_range(1e-4, 1.0) } else { to_eye };
    [with(normal, 0.0), with(to_light, 0.0), with(to_eye, 0.0), with(random.color(), 0.0)]
}

const CHECKS: &[Check<Gooch>] = &[
    Check {
        name: "gooch_unit",
        wgsl: "vec4(gooch_unit(a.xyz), 0.0)",
        given: scene,
        rust: |_, g| color(xyz(g[0]).normalize_or_zero()),
        allowed: small,
    },
    Check {
        name: "gooch_n_dot_l",
        wgsl: "vec4(gooch_n_dot_l(a.xyz, b.xyz))",
        given: scene,
        rust: |_, g| DVec4::splat(gooch_n_dot_l(xyz(g[0]), xyz(g[1]))),
        allowed: small,
    },
    Check {
        name: "gooch_weight",
        wgsl: "vec4(gooch_weight(a.x))",
        given: |random, _| [Vec4::splat(random.near(&[-1.0, 0.0, 1.0], 0.1)); 4],
        rust: |_, g| DVec4::splat(gooch_weight(f64::from(g[0].x))),
        allowed: small,
    },
    Check {
        name: "gooch_cool",
        wgsl: "vec4(gooch_cool(u, d.rgb), 0.0)",
        given: scene,
        rust: |model, g| color(gooch_cool(model, xyz(g[3]))),
        allowed: small,
    },
    Check {
        name: "gooch_warm",
        wgsl: "vec4(gooch_warm(u, d.rgb), 0.0)",
        given: scene,
        rust: |model, g| color(gooch_warm(model, xyz(g[3]))),
        allowed: small,
    },
    Check {
        name: "gooch_tone",
        wgsl: "vec4(gooch_tone(u, a.rgb, a.w), 0.0)",
        given: |random, _| [with(random.color(), random.near(&[-1.0, 0.0, 1.0], 0.1)); 4],
        rust: |model, g| color(gooch_tone(model, xyz(g[0]), f64::from(g[0].w))),
        allowed: small,
    },
    Check {
        name: "gooch_r_dot_e",
        wgsl: "vec4(gooch_r_dot_e(a.xyz, b.xyz, c.xyz))",
        given: scene,
        rust: |_, g| DVec4::splat(gooch_r_dot_e(xyz(g[0]), xyz(g[1]), xyz(g[2]))),
        allowed: small,
    },
    Check {
        name: "gooch_r_dot_e_unit",
        wgsl: "vec4(gooch_r_dot_e_unit(gooch_unit(a.xyz), gooch_unit(b.xyz), gooch_unit(c.xyz)))",
        given: scene,
        rust: |_, g| {
            let [n, l, e] = [0, 1, 2].map(|i| xyz(g[i]).normalize_or_zero());
            DVec4::splat(gooch_r_dot_e_unit(n, l, e))
        },
        allowed: small,
    },
    Check {
        name: "gooch_highlight",
        wgsl: "vec4(gooch_highlight(u, a.x, a.y))",
        // N·L is only compared with 0; R·E may exceed 1 by rounding.
        given: |random, _| {
            let n_dot_l = random.pick(&[0.5, 1e-7, 1e-30, 0.0, -0.0, -1e-30, -0.5]);
            [Vec4::new(n_dot_l, random.near(&[0.0, 0.5, 1.0], 0.2), 0.0, 0.0); 4]
        },
        rust: |model, g| DVec4::splat(gooch_highlight(model, f64::from(g[0].x), f64::from(g[0].y))),
        allowed: highlight_bound,
    },
    Check {
        name: "gooch_over",
        wgsl: "vec4(gooch_over(u, a.rgb, a.w), 0.0)",
        // Without a highlight its opacity is 0; the uniform has no other field for that.
        given: |random, model| {
            let opacity = random.pick(&[0.0, 1.0, random.unit()]);
            [with(random.color(), if model.highlight.is_some() { opacity } else { 0.0 }); 4]
        },
        rust: |model, g| color(gooch_over(model, xyz(g[0]), f64::from(g[0].w))),
        allowed: small,
    },
    Check {
        name: "gooch_shade",
        wgsl: "vec4(gooch_shade(u, d.rgb, a.xyz, b.xyz, c.xyz), 0.0)",
        given: scene,
        rust: |model, g| color(gooch_shade(model, xyz(g[3]), xyz(g[0]), xyz(g[1]), xyz(g[2]))),
        // At N·L = 0 the highlight ends, with a jump at grazing angles: inputs are exempt if f32 may be on the other
        // side.
        allowed: shade_bound,
    },
];

pub fn calls() -> Vec<&'static str> {
    CHECKS.iter().map(|check| check.wgsl).collect()
}

#[test]
fn gooch_is_its_reference() {
    let Some(gpu) = crate::device() else { return };
    let pack = |model: &Gooch| GoochUniform::new(model).expect("it is valid");
    compare(&gpu, npr_gooch::WGSL, "GoochModel", &[], &models(), pack, CHECKS);
}
