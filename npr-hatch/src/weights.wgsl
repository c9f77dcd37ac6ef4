// Weights of six tones by light, and their blend. The counterpart of `weights.rs`. No bindings, no entry points.
// For parameters and results see the Rust functions of the same names.

struct HatchWeights {
    light: vec3<f32>,
    dark: vec3<f32>,
}

fn hatch_level(brightness: f32, n_dot_l: f32) -> f32 {
    return brightness * n_dot_l;
}

fn hatch_weights(level: f32) -> HatchWeights {
    let light = max(1.0 - abs(level - vec3(6.0, 5.0, 4.0)), vec3(0.0));
    var dark = max(1.0 - abs(level - vec3(3.0, 2.0, 1.0)), vec3(0.0));
    if level <= 1.0 {
        dark.z = 1.0;
    }
    return HatchWeights(light, dark);
}

fn hatch_blend(light: vec3<f32>, dark: vec3<f32>, weights: HatchWeights) -> f32 {
    let ink = saturate(dot(1.0 - light, weights.light)) + saturate(dot(1.0 - dark, weights.dark));
    return 1.0 - saturate(ink);
}

fn hatch_transfer(light: vec3<f32>, dark: vec3<f32>, level: f32) -> f32 {
    return hatch_blend(light, dark, hatch_weights(level));
}

fn hatch_level_of_tone(light: vec3<f32>, dark: vec3<f32>, tone: f32) -> f32 {
    let from_dark = saturate((tone - dark.zyx) / (vec3(dark.yx, light.z) - dark.zyx));
    let from_light = saturate((tone - light.zyx) / (vec3(light.yx, 1.0) - light.zyx));
    return 1.0 + dot(from_dark + from_light, vec3(1.0));
}

fn hatch_tone_in_shadow(tone: f32, darkest: f32, lit: f32) -> f32 {
    return tone * lit + min(tone, darkest) * (1.0 - lit);
}

fn hatch_color(tone: f32, paper: vec3<f32>, ink: vec3<f32>) -> vec3<f32> {
    return ink + (paper - ink) * tone;
}
