// Thresholds of texels. The counterpart of `threshold.rs`.

fn hatch_threshold(texel: f32, tone: f32, width: f32) -> f32 {
    if width > 0.0 {
        return saturate((texel - tone) / width + 0.5);
    }
    return select(0.0, 1.0, texel > tone || tone <= 0.0);
}

fn hatch_soft_tone(tone: f32, width: f32) -> f32 {
    let end = 0.5 * width;
    if tone <= 0.0 {
        return -width;
    }
    if tone >= 1.0 {
        return 1.0 + width;
    }
    if tone < end {
        return sqrt(2.0 * width * tone) - end;
    }
    if tone > 1.0 - end {
        return 1.0 + end - sqrt(2.0 * width * (1.0 - tone));
    }
    return tone;
}
