//! Comparison of the GPU with the reference at several samples per pixel.
#![cfg(feature = "gpu")]
#![allow(clippy::print_stdout)]

mod common;

use common::device;
use npr_harness::capabilities::Capabilities;
use npr_harness::check::{EXEMPT_SHARE, PLACES, Reference, Shot, magnitude};
use npr_harness::compare::compare;
use npr_harness::cpu::PrimaryHits;
use npr_harness::executor::Picture;
use npr_harness::gallery::still_life_camera;
use npr_harness::plan::Plan;
use npr_harness::scene::Scene;
use npr_harness::style::style;
use npr_harness::view::View;
use npr_mesh::embedded;

const SIZE: (u32, u32) = (192, 108);

/// One style for each path through the passes: only surfaces, edge lines, printed fins, image-space lines of the
/// picture's size, of other sizes and with dilation, shadows with and without separate lines, strokes.
#[test]
fn several_samples_are_the_same_on_both() {
    let Some(executor) = device() else { return };
    let scene = Scene::new(embedded::scene());
    let camera = still_life_camera();
    let hits = PrimaryHits::kept(&scene, View::new(camera, SIZE), PLACES);
    // Image-space lines use one sample per pixel; the other pixels show the number of samples.
    let shown = ["toon", "cartoon", "printed-fins", "toon-shadow", "hatch", "hatch-planes", "printed-hatch"];
    let covered = ["ink-image", "ink-fine", "ink-thick", "shadow-lines", "printed-shadow"];
    for name in shown.into_iter().chain(covered) {
        let style = style(name).expect("a style of the crate");
        let view = |samples| View { samples, ..View::new(camera, SIZE) };
        let draw = |samples| executor.render(&Picture::new(&scene, &style, view(samples)), &|_| {}).expect("a picture");
        let single = draw(1);
        let most = if ["cartoon", "hatch-planes"].contains(&name) { 3 } else { 2 };
        for samples in 2..=most {
            let plan = Plan::new(&scene, &style, &view(samples), &Capabilities::RAY_CASTER).expect("a plan");
            let shot = Shot { hits: &hits, style: &style, plan: &plan };
            let mut reference = Reference::new(shot).expect("pictures");
            let actual = draw(samples);
            let against = |reference: &Reference<'_>, actual| {
                compare(&reference.image, actual, &reference.exempt).expect("one size")
            };
            let magnitude = magnitude(&plan);
            if against(&reference, &actual).worst > magnitude {
                reference.look_closer().expect("pictures");
            }
            let compared = against(&reference, &actual);
            let (worst, share) = (compared.worst, compared.exempt_share());
            println!("{name}, {samples}: {worst} of 255, {:.2} % exempt", share * 100.0);
            assert!(worst <= magnitude, "{name}, {samples}: {worst} of 255");
            // As many rows of samples lie along a contour.
            assert!(share <= EXEMPT_SHARE * f64::from(samples), "{name}, {samples}: {share} exempt");
            let one = against(&reference, &single).worst;
            assert!(one > magnitude || covered.contains(&name), "{name}, {samples}: one sample shows the same");
        }
    }
}
