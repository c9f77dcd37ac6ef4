//! The figures of the documents on both executors, and where the pairs of the errata differ.

mod common;

use common::{device, planned, rendered};
use glam::{DVec4, IVec2};

use npr_harness::check::{PLACES, Reference, Shot, agrees, magnitude};
use npr_harness::compare::compare;
use npr_harness::cpu::PrimaryHits;
use npr_harness::executor::{Executor, Picture};
use npr_harness::figures::{PANEL, Setting, Stage, all, errata, figures};
use npr_harness::picture::Image;
use npr_harness::style::Style;
use npr_harness::view::View;
use std::collections::{BTreeSet, HashMap};
use std::path::Path;

/// The size at which executors are compared, px.
const SIZE: (u32, u32) = PANEL;
/// The size at which pairs are compared, px: that of the figures.
const PAIR: (u32, u32) = PANEL;

#[test]
fn every_panel_agrees_on_both_executors() {
    let Some(executor) = device() else { return };
    for setting in Setting::ALL {
        let (scene, camera) = (setting.scene(), setting.camera());
        let hits = PrimaryHits::kept(&scene, View::new(camera, SIZE), PLACES);
        let mut known = BTreeSet::new();
        for figure in all() {
            for (_, style) in figure.styles().expect("good styles").into_iter().filter(|(of, _)| *of == setting) {
                // Many figures share a panel.
                let text = Style { name: String::new(), ..style.clone() }.to_toml().expect("a style");
                if !known.insert(text) {
                    continue;
                }
                let plan = planned(&scene, &style, &camera, SIZE);
                let shot = Shot { hits: &hits, style: &style, plan: &plan };
                let mut reference = Reference::new(shot).expect("pictures");
                let actual = rendered(&executor, &scene, &style, &camera, SIZE);
                let compared = |reference: &Reference<'_>| {
                    compare(&reference.image, &actual, &reference.exempt).expect("one size")
                };
                if !agrees(&compared(&reference), magnitude(&plan)) {
                    reference.look_closer().expect("pictures");
                }
                let comparison = compared(&reference);
                assert!(agrees(&comparison, magnitude(&plan)), "{}: {comparison:?}", style.name);
            }
        }
    }
}

#[test]
fn every_figure_has_a_name_of_its_own_and_says_what_it_shows() {
    let mut names = BTreeSet::new();
    for figure in all() {
        assert!(names.insert(figure.name), "two figures are called {}", figure.name);
        assert!(!figure.shows.is_empty() && figure.caption.len() > 40, "{}", figure.name);
        assert!(figure.panels.iter().all(|panel| !panel.legend.is_empty()), "{}", figure.name);
        for (_, style) in figure.styles().expect("good styles") {
            let text = style.to_toml().expect("a style has a form");
            let read = Style::from_toml(&text, Path::new("again.toml")).unwrap_or_else(|e| panic!("{e}\n{text}"));
            assert_eq!(read, style, "{text}");
        }
    }
    let documents: Vec<_> = figures().iter().map(|figure| figure.name.split('-').next()).collect();
    for of in ["chapter", "slides", "article"] {
        assert!(documents.contains(&Some(of)));
    }
}

/// A pair by the CPU: as printed, and corrected.
struct Pair {
    images: Vec<Image>,
}

impl Pair {
    fn new(stage: &mut Stage, name: &str) -> Self {
        let erratum = errata().into_iter().find(|erratum| erratum.figure.name == name).expect("there is such a pair");
        let styles = erratum.figure.styles().expect("good styles");
        let executor = Executor::Cpu { why: None };
        let image = |(setting, style): &(Setting, Style)| {
            let picture = Picture::new(stage.scene(*setting), style, View::new(setting.camera(), PAIR));
            executor.render(&picture, &|_| {}).expect("a picture")
        };
        Self { images: styles.iter().map(image).collect::<Vec<_>>() }
    }

    fn pixels() -> impl Iterator<Item = (u32, u32)> {
        (0..PAIR.1).flat_map(|y| (0..PAIR.0).map(move |x| (x, y)))
    }

    /// 0 paper to 255 ink.
    fn ink(&self, which: usize, x: u32, y: u32) -> u8 {
        255 - self.images[which].pixel(x, y)[1]
    }

    fn inked(&self, which: usize) -> usize {
        Self::pixels().filter(|&(x, y)| self.ink(which, x, y) > 0).count()
    }

    fn differs(&self, [a, b]: [usize; 2], x: u32, y: u32) -> bool {
        self.images[a].pixel(x, y) != self.images[b].pixel(x, y)
    }

    fn differing(&self, of: [usize; 2]) -> Vec<(u32, u32)> {
        Self::pixels().filter(|&(x, y)| self.differs(of, x, y)).collect()
    }

    /// Whether a pixel within a distance, in pixels along both axes, has ink.
    fn is_near_ink(&self, which: usize, x: u32, y: u32, within: i32) -> bool {
        let at = IVec2::new(x as i32, y as i32);
        (-within..=within).any(|dy| {
            (-within..=within).any(|dx| {
                let near = at + IVec2::new(dx, dy);
                let inside = near.cmpge(IVec2::ZERO).all() && near.cmplt(IVec2::new(480, 270)).all();
                inside && self.ink(which, near.x as u32, near.y as u32) > 0
            })
        })
    }
}

const PRINTED: usize = 0;
const CORRECTED: usize = 1;

/// Fins are thinner everywhere, never elsewhere: with the near plane at half the distance clip z is half of w there.
#[test]
fn erratum_1_width_from_clip_z_is_too_thin() {
    let pair = Pair::new(&mut Stage::default(), "erratum-1");
    for (x, y) in pair.differing([PRINTED, CORRECTED]) {
        assert!(pair.ink(PRINTED, x, y) == 0 && pair.ink(CORRECTED, x, y) == 255, "thicker at {x}, {y}");
    }
    let share = pair.inked(PRINTED) as f64 / pair.inked(CORRECTED) as f64;
    assert!((0.4..0.75).contains(&share), "{share}");
}

/// The text draws edges inside of objects, and no silhouette: that of the cube, in the left part, is lost.
#[test]
fn erratum_2_the_text_draws_everything_but_silhouettes() {
    let pair = Pair::new(&mut Stage::default(), "erratum-2");
    assert!(pair.inked(PRINTED) > 3 * pair.inked(CORRECTED), "{} {}", pair.inked(PRINTED), pair.inked(CORRECTED));
    let is_left = |&(x, _): &(u32, u32)| x < 130;
    let outline: Vec<_> = Pair::pixels().filter(is_left).filter(|&(x, y)| pair.ink(CORRECTED, x, y) > 0).collect();
    let kept = outline.iter().filter(|&&(x, y)| pair.ink(PRINTED, x, y) > 0).count();
    assert!(outline.len() > 300 && kept * 20 < outline.len(), "{kept} of {}", outline.len());
}

/// A torn fin is half of one: ink is lost along the line, and what is new lies beside it.
#[test]
fn erratum_3_rounded_normals_tear_fins() {
    let pair = Pair::new(&mut Stage::default(), "erratum-3");
    let differing = pair.differing([PRINTED, CORRECTED]);
    assert!(differing.len() > 50 && differing.len() * 10 < pair.inked(CORRECTED), "{}", differing.len());
    assert!(differing.iter().all(|&(x, y)| pair.is_near_ink(CORRECTED, x, y, 3)));
    let lost = differing.iter().filter(|&&(x, y)| pair.ink(PRINTED, x, y) == 0).count();
    assert!(lost * 2 > differing.len(), "{lost} of {}", differing.len());
}

/// With six nothing is lighter than with seven, and where light is full seven has paper.
#[test]
fn erratum_6_a_factor_of_six_never_becomes_white() {
    let pair = Pair::new(&mut Stage::default(), "erratum-6");
    let mean = |which| {
        let surface: Vec<_> = Pair::pixels().filter(|&(x, y)| pair.ink(0, x, y) > 0 || pair.ink(1, x, y) > 0).collect();
        surface.iter().map(|&(x, y)| f64::from(pair.ink(which, x, y))).sum::<f64>() / surface.len() as f64
    };
    assert!(mean(PRINTED) > mean(CORRECTED) + 5.0, "{} {}", mean(PRINTED), mean(CORRECTED));
    // Strokes are nested: a lighter tone has no stroke that a darker one lacks. Weights are rounded.
    let lighter =
        Pair::pixels().filter(|&(x, y)| pair.ink(PRINTED, x, y).saturating_add(2) < pair.ink(CORRECTED, x, y)).count();
    assert_eq!(lighter, 0);
}

/// Every surface changes but where both shares give one colour; paper does not.
#[test]
fn erratum_7_swapped_shares_change_surfaces_and_nothing_else() {
    let pair = Pair::new(&mut Stage::default(), "erratum-7");
    let surface = Pair::pixels().filter(|&(x, y)| pair.images[CORRECTED].pixel(x, y) != [255; 4]).count();
    let differing = pair.differing([PRINTED, CORRECTED]);
    assert!(differing.iter().all(|&(x, y)| pair.images[CORRECTED].pixel(x, y) != [255; 4]));
    assert!(differing.len() * 10 > surface * 8, "{} of {surface}", differing.len());
}

/// Two of four differences: lines are lost, none are added.
#[test]
fn erratum_8_the_printed_sum_loses_lines() {
    let pair = Pair::new(&mut Stage::default(), "erratum-8");
    let differing = pair.differing([PRINTED, CORRECTED]);
    assert!(differing.iter().all(|&(x, y)| pair.ink(PRINTED, x, y) == 0 && pair.ink(CORRECTED, x, y) == 255));
    assert!(differing.len() * 4 > pair.inked(CORRECTED), "{} of {}", differing.len(), pair.inked(CORRECTED));
}

/// As printed no line is seen; by the co-issued reading some are, and none that the corrected test does not show.
#[test]
fn erratum_9_greater_discards_the_lines() {
    let pair = Pair::new(&mut Stage::default(), "erratum-9");
    let black = |which: usize, x, y| pair.images[which].pixel(x, y) == [0, 0, 0, 255];
    let count = |which| Pair::pixels().filter(|&(x, y)| black(which, x, y)).count();
    assert_eq!(count(PRINTED), 0);
    assert!(pair.differing([PRINTED, CORRECTED]).iter().all(|&(x, y)| black(CORRECTED, x, y)));
    const CO_ISSUED: usize = 2;
    let (corrected, co_issued) = (count(CORRECTED), count(CO_ISSUED));
    assert!(co_issued * 10 > corrected * 3 && co_issued < corrected, "{co_issued} of {corrected}");
    assert!(Pair::pixels().all(|(x, y)| !black(CO_ISSUED, x, y) || black(CORRECTED, x, y)));
}

/// Tiles whose colours have one sum run into each other: whole sides of tiles are missing, of 10 × 2 px each.
#[test]
fn erratum_10_equal_sums_are_one_region() {
    let pair = Pair::new(&mut Stage::default(), "erratum-10");
    let differing = pair.differing([PRINTED, CORRECTED]);
    assert!(differing.iter().all(|&(x, y)| pair.ink(PRINTED, x, y) == 0 && pair.ink(CORRECTED, x, y) == 255));
    // Of 2,517 pairs of neighbours 16 have equal sums; some 14 px of each side are not part of another side.
    assert!((100..350).contains(&differing.len()), "{}", differing.len());
}

/// The sign of a difference decides: of a step in depth only one direction is ink.
#[test]
fn erratum_12_lines_depend_on_the_sign_of_a_difference() {
    let mut stage = Stage::default();
    let pair = Pair::new(&mut stage, "erratum-12");
    let differing = pair.differing([PRINTED, CORRECTED]);
    let total = (PAIR.0 * PAIR.1) as usize;
    assert!(differing.len() > 500 && differing.len() * 10 < total, "{}", differing.len());
    // Only surfaces and what is beside them.
    let added = Pair::new(&mut stage, "erratum-12-added");
    assert!(differing.iter().all(|&(x, y)| added.is_near_ink(PRINTED, x, y, 2)));
    // With the missing instruction added, most of all surfaces is ink.
    assert!(added.inked(PRINTED) > 3 * added.inked(CORRECTED), "{} {}", added.inked(PRINTED), added.inked(CORRECTED));
    let lost = Pair::pixels().filter(|&(x, y)| added.ink(PRINTED, x, y) < added.ink(CORRECTED, x, y));
    assert!(lost.count() * 20 < added.inked(CORRECTED), "a step in depth is ink with both");
}

/// Two samples of four: nothing is darker, and at most half the ink is there.
#[test]
fn erratum_13_two_samples_give_at_most_half() {
    let pair = Pair::new(&mut Stage::default(), "erratum-13");
    let sum = |which| Pair::pixels().map(|(x, y)| u64::from(pair.ink(which, x, y))).sum::<u64>();
    assert!(Pair::pixels().all(|(x, y)| pair.ink(PRINTED, x, y) <= pair.ink(CORRECTED, x, y)));
    let share = sum(PRINTED) as f64 / sum(CORRECTED) as f64;
    assert!((0.4..0.6).contains(&share), "{share}");
}

/// The soft dilation inks the same pixels, and those with fewer than three line samples less.
#[test]
fn erratum_14_the_shader_is_paler_at_borders() {
    let pair = Pair::new(&mut Stage::default(), "erratum-14");
    let differing = pair.differing([PRINTED, CORRECTED]);
    assert!(differing.len() > 1000);
    assert!(
        differing
            .iter()
            .all(|&(x, y)| [102, 204].contains(&pair.ink(PRINTED, x, y)) && pair.ink(CORRECTED, x, y) == 255)
    );
}

/// What faces +z, within the threshold's 32°, has no line against the background, and nothing else changes.
#[test]
fn erratum_15_the_background_hides_what_faces_it() {
    let pair = Pair::new(&mut Stage::default(), "erratum-15");
    let differing = pair.differing([PRINTED, CORRECTED]);
    assert!(differing.len() > 200);
    assert!(differing.iter().all(|&(x, y)| pair.ink(PRINTED, x, y) == 0 && pair.ink(CORRECTED, x, y) == 255));
    // The ball and the ring, right of the middle, have no border that faces +z.
    assert!(differing.iter().all(|&(x, _)| x < 250), "{:?}", differing.iter().max());
}

/// A moved object is lit right, a turned one is not.
#[test]
fn erratum_16_turned_objects_are_lit_as_if_they_were_not() {
    let pair = Pair::new(&mut Stage::default(), "erratum-16");
    let differing = pair.differing([PRINTED, CORRECTED]);
    assert!(differing.len() > 3000);
    assert!(differing.iter().all(|&(x, _)| x > PAIR.0 / 2), "the left teapot is only moved");
}

/// The terminator is a line, or is none; lines around cast shadows are there with both.
#[test]
fn erratum_18_negated_normals_outline_the_terminator() {
    let pair = Pair::new(&mut Stage::default(), "erratum-18");
    let black = |which: usize, x, y| pair.images[which].pixel(x, y) == [0, 0, 0, 255];
    let differing = pair.differing([PRINTED, CORRECTED]);
    assert!((300..4000).contains(&differing.len()), "{}", differing.len());
    assert!(differing.iter().all(|&(x, y)| black(PRINTED, x, y) != black(CORRECTED, x, y)));
    let added = differing.iter().filter(|&&(x, y)| black(PRINTED, x, y)).count();
    assert!(added * 2 > differing.len(), "{added} of {}", differing.len());
}

/// Of a wedge that points at the viewer the ridge is lost, and nothing else.
#[test]
fn erratum_18_negated_normals_lose_a_ridge_between_light_and_shadow() {
    let pair = Pair::new(&mut Stage::default(), "erratum-18-ridge");
    let differing = pair.differing([PRINTED, CORRECTED]);
    assert!(differing.iter().all(|&(x, y)| pair.ink(PRINTED, x, y) == 0 && pair.ink(CORRECTED, x, y) == 255));
    let columns: BTreeSet<_> = differing.iter().map(|&(x, _)| x).collect();
    assert!(differing.len() > 200 && columns.len() <= 2, "{} in {columns:?}", differing.len());
}

/// Every erratum with two forms that run has a pair.
#[test]
fn errata_with_two_forms_have_pairs() {
    let numbers: BTreeSet<_> = errata().iter().map(|erratum| erratum.number).collect();
    assert_eq!(numbers, BTreeSet::from([1, 2, 3, 6, 7, 8, 9, 10, 12, 13, 14, 15, 16, 18]));
}

/// What a G-buffer shows is right: its normals, depths and regions at known points of a known scene.
#[test]
fn a_g_buffer_shows_what_the_surface_has() {
    let setting = Setting::Front;
    let (scene, camera) = (setting.scene(), setting.camera());
    let executor = Executor::Cpu { why: None };
    let styled = |table: &str| {
        let text = format!("shade = \"paper\"\n[lines.image.gbuffer]\ntarget = \"separate\"\n{table}\n");
        Style::from_toml(&text, Path::new("shown.toml")).expect("a style")
    };
    let shown = |table: &str| {
        let style = styled(table);
        executor.render(&Picture::new(&scene, &style, View::new(camera, PAIR)), &|_| {}).expect("a picture")
    };
    let normals = shown("show = \"normals\"\nnormal-format = \"bytes\"");
    // The front of the cube faces +z; the background has no normal.
    let at = |x: f64, y: f64, z: f64| {
        let clip = camera.clip_from_world(480.0 / 270.0) * DVec4::new(x, y, z, 1.0);
        ((240.0 * (1.0 + clip.x / clip.w)) as u32, (135.0 * (1.0 - clip.y / clip.w)) as u32)
    };
    let front = at(-3.6, 1.0, 0.9);
    assert_eq!(normals.pixel(front.0, front.1), [128, 128, 255, 255]);
    assert_eq!(normals.pixel(2, 2), [0, 0, 0, 255]);
    // Depth is linear from the nearest to the farthest, with the far plane at twice that.
    let depth = shown("show = \"depth\"\nfar = 2.0");
    let plan = planned(&scene, &styled("far = 2.0"), &camera, PAIR);
    let range = plan.image.and_then(|image| image.gbuffer).expect("a G-buffer").range;
    let near = planned(&scene, &styled(""), &camera, PAIR).image.and_then(|image| image.gbuffer).expect("one").range;
    assert!((range.far / near.far - 2.0).abs() < 1e-6 && range.near == near.near);
    assert!(near.near < 13.1 && near.near > 12.0 && near.far > 14.9 && near.far < 16.0, "{near:?}");
    let share = f64::from((14.0 - 0.9 - range.near) / (range.far - range.near));
    let got = depth.pixel(front.0, front.1);
    assert!((f64::from(got[0]) - share * 255.0).abs() <= 1.0, "{got:?} for {share}");
    assert_eq!(depth.pixel(2, 2), [255; 4]);
    // Each object a region of its own, and the faces of the cube three.
    let regions = shown("show = \"regions\"");
    let mut counted: HashMap<[u8; 4], usize> = HashMap::new();
    for (x, y) in Pair::pixels() {
        *counted.entry(regions.pixel(x, y)).or_default() += 1;
    }
    assert_eq!(counted.values().filter(|&&count| count > 40).count(), 1 + 5, "{counted:?}");
}

/// Normals of the vertex buffer go with every use of normals, for faces and their pieces too.
#[test]
fn untransformed_normals_agree_in_every_use_of_them() {
    let Some(executor) = device() else { return };
    let setting = Setting::TwoTeapots;
    let (scene, camera) = (setting.scene(), setting.camera());
    let hits = PrimaryHits::kept(&scene, View::new(camera, SIZE), PLACES);
    for normals in ["\"per-pixel\"", "\"interpolated\"", "\"per-vertex\"", "\"per-face\"", "\"per-subdivided-face\""] {
        let text =
            format!("normals = {normals}\nnormal-space = \"mesh\"\n[shade.lambert]\nambient = 0.1\n[lines.image]\n");
        let style = Style::from_toml(&text, Path::new("mesh.toml")).expect("a style");
        let plan = planned(&scene, &style, &camera, SIZE);
        let reference = Reference::new(Shot { hits: &hits, style: &style, plan: &plan }).expect("pictures");
        let actual = rendered(&executor, &scene, &style, &camera, SIZE);
        let comparison = compare(&reference.image, &actual, &reference.exempt).expect("one size");
        assert!(agrees(&comparison, magnitude(&plan)), "{normals}: {comparison:?}");
    }
}

/// Formats and tests that are in no figure.
#[test]
fn other_g_buffers_agree_on_both_executors() {
    let Some(executor) = device() else { return };
    let setting = Setting::Front;
    let (scene, camera) = (setting.scene(), setting.camera());
    let hits = PrimaryHits::kept(&scene, View::new(camera, SIZE), PLACES);
    for (keys, table) in [
        ("depth = false\nregions = \"none\"", "background = \"plus-z\""),
        ("", "normal-format = \"octahedral-5\"\ndepth-format = \"half\"\ndepth-test = \"step\""),
        (
            "regions = \"material\"",
            "normal-format = \"octahedral-16\"\ndepth-format = \"packed-2x8\"\ndepth-test = \"sum\"",
        ),
        ("softness = 0.2", "normal-format = \"half\"\ndepth-format = \"16-bit\"\nregion-test = \"color-sums\""),
        (
            "taps = \"cross\"",
            "normal-format = \"bytes\"\nstep = [{ kind = \"soft-diagonal\", threshold = 0.4, times = 3 }]",
        ),
        (
            "dilation = { radius-px = 2.5 }\nscale = \"double\"",
            "step = [{ kind = \"close\", kernel = \"diagonal\", times = 2 }]",
        ),
    ] {
        let text = format!("[lines.image]\n{keys}\n[lines.image.gbuffer]\ntarget = \"separate\"\n{table}\n");
        let style = Style::from_toml(&text, Path::new("other.toml")).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let plan = planned(&scene, &style, &camera, SIZE);
        let reference = Reference::new(Shot { hits: &hits, style: &style, plan: &plan }).expect("pictures");
        let actual = rendered(&executor, &scene, &style, &camera, SIZE);
        let comparison = compare(&reference.image, &actual, &reference.exempt).expect("one size");
        assert!(agrees(&comparison, magnitude(&plan)), "{text}: {} {comparison:?}", comparison.worst);
        let none = format!("shade = \"paper\"\n{text}");
        let drawn = rendered(
            &executor,
            &scene,
            &Style::from_toml(&none, Path::new("ink.toml")).expect("a style"),
            &camera,
            SIZE,
        );
        let ink = drawn.rgba8.chunks_exact(4).filter(|pixel| pixel[1] < 128).count();
        assert!((400..20_000).contains(&ink), "{ink} px of ink by {text}");
    }
}
