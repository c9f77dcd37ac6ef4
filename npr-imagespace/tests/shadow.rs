//! Shadows in the filters: as printed, what is lost; with a state, that it is not.

use glam::Vec3;
use npr_imagespace::filter::fused::{
    DepthTest, FilterUniform, FusedFilter, ShadowTest, ink_fused_hard, ink_fused_soft, ink_tap_across,
};
use npr_imagespace::format::texel::{
    DepthCode, Tap, TexelLayout, ink_texel32_bits, ink_texel32_pack, ink_texel32_tap, ink_texel64_bits,
    ink_texel64_pack, ink_texel64_tap,
};
use npr_imagespace::shadow::{
    ShadowState, ink_shadow_background, ink_shadow_depth, ink_shadow_differs, ink_shadow_normal, ink_shadow_region,
    ink_shadow_state,
};

const LAYOUTS: [TexelLayout; 2] = [TexelLayout::Bits32, TexelLayout::Bits64];

fn code(layout: TexelLayout) -> DepthCode {
    DepthCode::perspective(1.0, 50.0, layout).unwrap()
}

fn tap(layout: TexelLayout, normal: Vec3, region: u32, depth: f32) -> Tap {
    match layout {
        TexelLayout::Bits32 => ink_texel32_tap(ink_texel32_pack(normal, region, depth, &code(layout))),
        TexelLayout::Bits64 => ink_texel64_tap(ink_texel64_pack(normal, region, depth, &code(layout))),
    }
}

fn inked(filter: &FusedFilter, layout: TexelLayout, a: Tap, b: Tap) -> bool {
    let uniform = FilterUniform::new(filter, layout, &code(layout)).unwrap();
    // The neighbour on one side only, and the other way round.
    let there = ink_fused_hard(&uniform, &a, &[b, a, a, a]);
    assert_eq!(there, ink_fused_hard(&uniform, &b, &[b, b, a, b]), "{filter:?}");
    there
}

#[test]
fn a_state_survives_packing_beside_the_region_in_both_layouts() {
    for layout in LAYOUTS {
        let most = layout.shadowed_region_max();
        assert_eq!(layout.shadow_bits() | most, layout.region_max());
        for region in [1, 2, most / 2, most] {
            for state in ShadowState::ALL {
                let with = ink_shadow_region(region, state as u32, layout);
                let back = tap(layout, Vec3::Y, with, 3.0).region;
                assert_eq!((back & most, ink_shadow_state(back, layout)), (region, state), "{layout:?} {region}");
                assert_eq!(ink_shadow_region(0, state as u32, layout), 0, "background stays background");
            }
        }
    }
}

#[test]
fn only_lit_against_cast_is_a_border() {
    let bits = 0b1100_0000;
    for a in ShadowState::ALL {
        for b in ShadowState::ALL {
            let is = ink_shadow_differs((a as u32) << 6, (b as u32) << 6, bits);
            let both = [a, b].contains(&ShadowState::Lit) && [a, b].contains(&ShadowState::Cast);
            assert_eq!(is, both, "{a:?} {b:?}");
        }
    }
}

#[test]
fn printed_a_shadowed_surface_has_no_line_against_a_lit_one_of_the_opposite_normal() {
    let filter = FusedFilter { regions: false, ..FusedFilter::default() };
    for layout in LAYOUTS {
        // A thin wall's two sides at one depth: one lit and one in shadow.
        let (lit, shadowed) = (Vec3::X, ink_shadow_normal(Vec3::NEG_X, true));
        assert_eq!(shadowed, lit);
        assert!(!inked(&filter, layout, tap(layout, lit, 1, 3.0), tap(layout, shadowed, 1, 3.0)), "{layout:?}");
        // What the form is for: a border of a shadow on one surface is a fold of 180°.
        let dark = ink_shadow_normal(Vec3::X, true);
        assert!(inked(&filter, layout, tap(layout, lit, 1, 3.0), tap(layout, dark, 1, 3.0)));
        // With states the same wall has its line, by its normals, and the shadow has its own.
        let with = FusedFilter { shadows: ShadowTest::Lines, ..filter };
        let region = |state| ink_shadow_region(1, state as u32, layout);
        let (light, cast) = (region(ShadowState::Lit), region(ShadowState::Cast));
        assert!(inked(&with, layout, tap(layout, Vec3::X, light, 3.0), tap(layout, Vec3::NEG_X, cast, 3.0)));
        assert!(inked(&with, layout, tap(layout, Vec3::X, light, 3.0), tap(layout, Vec3::X, cast, 3.0)));
    }
}

#[test]
fn printed_the_terminator_is_a_line_and_with_states_it_is_none() {
    for layout in LAYOUTS {
        let filter = FusedFilter::default();
        let dark = ink_shadow_normal(Vec3::X, true);
        assert!(inked(&filter, layout, tap(layout, Vec3::X, 1, 3.0), tap(layout, dark, 1, 3.0)));
        let with = FusedFilter { shadows: ShadowTest::Lines, ..filter };
        let region = |state| ink_shadow_region(1, state as u32, layout);
        for state in [ShadowState::Lit, ShadowState::Cast] {
            let (a, b) = (region(state), region(ShadowState::BackFacing));
            assert!(!inked(&with, layout, tap(layout, Vec3::X, a, 3.0), tap(layout, Vec3::X, b, 3.0)), "{state:?}");
        }
    }
}

#[test]
fn printed_negated_depth_is_lost_in_a_format_without_sign() {
    let depth = ink_shadow_depth(0.25, true);
    assert_eq!(depth, -0.25);
    // As any unorm target stores it.
    assert_eq!((depth.clamp(0.0, 1.0) * 255.0).round(), 0.0);
    assert_eq!(ink_shadow_depth(0.25, false), 0.25);
}

#[test]
fn states_that_are_ignored_and_lines_that_stand_alone() {
    for layout in LAYOUTS {
        let region = |number, state| ink_shadow_region(number, state as u32, layout);
        let (lit, cast) = (region(1, ShadowState::Lit), region(1, ShadowState::Cast));
        let other = region(2, ShadowState::Cast);
        let at = |region| tap(layout, Vec3::X, region, 3.0);
        let filter = |shadows| FusedFilter { shadows, ..FusedFilter::default() };
        // Nobody looks: a shadow is no border of regions.
        assert!(!inked(&filter(ShadowTest::Ignored), layout, at(lit), at(cast)));
        assert!(inked(&filter(ShadowTest::Ignored), layout, at(lit), at(other)));
        // Alone: a shadow's border, but not where an object ends too.
        assert!(inked(&filter(ShadowTest::OnlyShadows), layout, at(lit), at(cast)));
        assert!(!inked(&filter(ShadowTest::OnlyShadows), layout, at(lit), at(other)));
        assert!(!inked(&filter(ShadowTest::OnlyShadows), layout, at(cast), at(other)));
        // Together they are what one pass draws.
        for (a, b) in [(lit, cast), (lit, other), (cast, other), (lit, lit)] {
            let [all, objects, shadows] = [ShadowTest::Lines, ShadowTest::Ignored, ShadowTest::OnlyShadows]
                .map(|test| inked(&filter(test), layout, at(a), at(b)));
            assert_eq!((all, objects && shadows), (objects || shadows, false));
        }
    }
}

#[test]
fn background_that_catches_shadows_has_their_borders_and_no_other_line() {
    for layout in LAYOUTS {
        let ground = |state: ShadowState| {
            let number = ink_shadow_background(state as u32, layout);
            assert_eq!(ink_shadow_state(number, layout), state);
            match layout {
                TexelLayout::Bits32 => ink_texel32_tap(ink_texel32_bits(Vec3::Y, number, 0)),
                TexelLayout::Bits64 => ink_texel64_tap(ink_texel64_bits(Vec3::Y, number, 0)),
            }
        };
        let (lit, cast) = (ground(ShadowState::Lit), ground(ShadowState::Cast));
        let background = tap(layout, Vec3::X, 0, 3.0);
        let surface = |state| tap(layout, Vec3::X, ink_shadow_region(1, state as u32, layout), 3.0);
        for softness in [0.0, 0.2] {
            for shadows in [ShadowTest::Lines, ShadowTest::Ignored, ShadowTest::OnlyShadows] {
                let filter = FusedFilter { shadows, softness, ..FusedFilter::default() };
                let uniform = FilterUniform::new(&filter, layout, &code(layout)).unwrap();
                let is_line = |a: Tap, b: Tap| match softness {
                    0.0 => inked(&filter, layout, a, b),
                    _ => ink_fused_soft(&uniform, &a, &[b; 4]) > 0.5,
                };
                assert_eq!(is_line(lit, cast), shadows != ShadowTest::Ignored, "{shadows:?} {softness}");
                for state in [lit, cast] {
                    assert!(!is_line(background, state), "the end of the ground is no line");
                    for of_surface in ShadowState::ALL {
                        // The outline of a surface, drawn as against background.
                        let expected = is_line(surface(of_surface), background);
                        assert_eq!(is_line(surface(of_surface), state), expected, "{shadows:?} {softness}");
                    }
                }
            }
        }
    }
}

#[test]
fn soft_a_shadows_border_is_full_ink_and_fades_where_others_are() {
    let layout = TexelLayout::Bits64;
    let region = |state| ink_shadow_region(1, state as u32, layout);
    let (lit, cast) = (region(ShadowState::Lit), region(ShadowState::Cast));
    let soft = |shadows, normal_cos| {
        let filter = FusedFilter {
            shadows,
            normal_cos: Some(normal_cos),
            depth: None::<DepthTest>,
            softness: 0.2,
            ..FusedFilter::default()
        };
        FilterUniform::new(&filter, layout, &code(layout)).unwrap()
    };
    let (a, b) = (tap(layout, Vec3::X, lit, 3.0), tap(layout, Vec3::X, cast, 3.0));
    let lines = soft(ShadowTest::Lines, 0.8);
    assert!(!ink_tap_across(&lines, &a, &b));
    let weight = f64::from(lines.weight);
    assert_eq!(ink_fused_soft(&lines, &a, &[b, a, a, a]), weight.min(1.0));
    assert_eq!(ink_fused_soft(&soft(ShadowTest::OnlyShadows, 0.8), &a, &[b, a, a, a]), weight.min(1.0));
    let tilted = tap(layout, Vec3::Y, cast, 3.0);
    let alone = ink_fused_soft(&soft(ShadowTest::OnlyShadows, 0.8), &a, &[tilted; 4]);
    assert_eq!(alone, 0.0, "an object's line is there");
}
