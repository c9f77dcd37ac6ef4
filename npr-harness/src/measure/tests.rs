use super::*;
use crate::camera::{Camera, Framing};
use crate::capabilities::Capabilities;
use crate::style::style;
use crate::view::View;
use std::cell::{Cell, RefCell};
use std::convert::Infallible;

fn samples(times_ms: impl IntoIterator<Item = f64>) -> Samples {
    Samples::new(times_ms.into_iter().collect())
}

#[test]
fn quartiles_of_known_numbers() {
    let spread = Spread::of(&[5.0, 1.0, 4.0, 2.0, 3.0]);
    assert_eq!(spread, Spread { median: 3.0, low: 2.0, high: 4.0 });
    let spread = Spread::of(&[4.0, 1.0, 3.0, 2.0]);
    assert_eq!(spread, Spread { median: 2.5, low: 1.75, high: 3.25 });
    assert_eq!(Spread::of(&[7.0]), Spread { median: 7.0, low: 7.0, high: 7.0 });
}

/// A machine that is slow during half of the rounds, and a round in which something slowed one case alone.
#[test]
fn ratios_within_rounds_cancel_what_slows_a_round() {
    let speed = [1.0, 1.0, 8.0, 1.0, 8.0, 8.0, 8.0, 1.0, 2.0];
    let factor = [1.5, 1.5, 1.5, 1.5, 1.5, 1.5, 1.5, 1.5, 9.0];
    let plain = samples(speed);
    let case = samples(speed.iter().zip(factor).map(|(speed, factor)| speed * factor));
    let ratio = case.relative_to(&plain);
    assert_eq!(ratio, Spread { median: 1.5, low: 1.5, high: 1.5 });
    let of_medians = case.spread().median / plain.spread().median;
    assert!(of_medians > 2.0, "the medians alone would say {of_medians}");
}

#[test]
#[should_panic(expected = "cases of the same rounds")]
fn ratios_of_other_rounds_are_refused() {
    samples([1.0, 2.0]).relative_to(&samples([1.0]));
}

/// Work that cannot be shortened by an optimiser.
fn work(steps: u32) {
    let mut state = black_box(1u32);
    for _ in 0..steps {
        state = black_box(state.wrapping_mul(747_796_405).wrapping_add(1));
    }
    black_box(state);
}

#[test]
fn twice_the_work_takes_about_twice_as_long() {
    let (mut once, mut twice) = (|| work(400_000), || work(800_000));
    let timed = time_work(&mut [&mut once, &mut twice], &Rounds::default());
    let ratio = timed[1].relative_to(&timed[0]).median;
    assert!((1.4..=3.0).contains(&ratio), "{ratio}");
}

#[test]
fn cases_are_interleaved_and_the_first_round_is_not_counted() {
    let order = RefCell::new(Vec::new());
    let (mut a, mut b) = (|| order.borrow_mut().push('a'), || order.borrow_mut().push('b'));
    let rounds = Rounds { rounds: 2, frames_a_wait: Some(2), ..Rounds::default() };
    let timed = time_work(&mut [&mut a, &mut b], &rounds);
    assert_eq!(timed.iter().map(|samples| samples.times_ms().len()).collect::<Vec<_>>(), [2, 2]);
    assert_eq!(order.borrow().iter().collect::<String>(), "aabbaabbaabb");
}

/// Results are in the order of the cases, and times within a case in that of the rounds.
#[test]
fn results_keep_the_order() {
    let mut number = 0.0;
    let timed = interleaved(3, &Rounds { rounds: 2, ..Rounds::default() }, &|_| {}, |case| {
        number += 1.0;
        Ok::<_, Infallible>(Measurement { wall_ms: number, device_ms: (case != 1).then_some(-number) })
    });
    let Ok(timed) = timed;
    let case = |wall: [f64; 2], device: Option<[f64; 2]>| Timed { wall: samples(wall), device: device.map(samples) };
    // The first round took 1, 2 and 3.
    let expected = [case([4.0, 7.0], Some([-4.0, -7.0])), case([5.0, 8.0], None), case([6.0, 9.0], Some([-6.0, -9.0]))];
    assert_eq!(timed, expected);
}

#[test]
fn a_bound_on_time_leaves_the_least_number_of_rounds() {
    let rounds_of = |rounds: Rounds| time_work(&mut [&mut || work(100)], &rounds)[0].times_ms().len();
    let bounded = |rounds| rounds_of(Rounds { rounds, most_ms: 0.0, ..Rounds::default() });
    assert_eq!(bounded(100), LEAST_ROUNDS);
    assert_eq!(bounded(3), 3);
    assert_eq!(bounded(0), 1);
    assert_eq!(rounds_of(Rounds { rounds: 9, ..Rounds::default() }), 9);
}

#[test]
fn the_first_error_ends_the_measurement() {
    let calls = Cell::new(0);
    let failed = interleaved(2, &Rounds::default(), &|_| {}, |_| {
        calls.set(calls.get() + 1);
        if calls.get() == 2 { Err("no") } else { Ok(Measurement { wall_ms: 1.0, device_ms: None }) }
    });
    assert_eq!((failed, calls.get()), (Err("no"), 2));
}

/// A scene and plans of a picture and of one with four times the pixels.
fn small_and_large(capabilities: &Capabilities, small: (u32, u32)) -> (Scene, [Plan; 2]) {
    let scene = Scene::new(npr_mesh::embedded::scene());
    let style = style("toon").expect("a style of this crate");
    let camera = Camera::framed(scene.corners(), f64::from(small.0) / f64::from(small.1), &Framing::default());
    let plans = [1, 2].map(|times| {
        let view = View::new(camera, (times * small.0, times * small.1));
        Plan::new(&scene, &style, &view, capabilities).expect("a good style")
    });
    (scene, plans)
}

#[test]
fn frames_of_the_cpu_take_longer_with_more_pixels() {
    let executor = Executor::Cpu { why: None };
    let (scene, plans) = small_and_large(&executor.capabilities(), (192, 108));
    let cases = plans.each_ref().map(|plan| FrameCase { scene: &scene, plan });
    let told = RefCell::new(Vec::new());
    let rounds = Rounds { rounds: 9, ..Rounds::default() };
    let timed = time_frames(&executor, &cases, &rounds, &|share| told.borrow_mut().push(share)).expect("frames");
    assert!(timed.iter().all(|timed| timed.device.is_none() && timed.wall.times_ms().len() == 9));
    let ratio = timed[1].wall.relative_to(&timed[0].wall).median;
    assert!((2.0..=8.0).contains(&ratio), "four times the pixels take {ratio} times as long");
    let told = told.borrow();
    assert!(told.is_sorted() && told[0] > 0.0 && told.last() == Some(&1.0), "{told:?}");
}
