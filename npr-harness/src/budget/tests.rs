use super::*;
use crate::camera::Camera;
use crate::scene::Scene;
use crate::style::style;
use crate::variant::{Part, Setup, plain};
use crate::view::View;

/// A table in which every variant of lines costs and errs differently.
fn table() -> CostTable {
    let cost = |sample_ns| Cost { fixed_ms: 0.0, sample_ns, face_ns: 0.0 };
    let entry = |part, variant: &str, shade, samples, sample_ns| Entry {
        executor: "cpu".into(),
        part,
        variant: variant.into(),
        shade,
        samples,
        cost: cost(sample_ns),
    };
    let expected =
        |part, variant: &str, shade, samples, error| Expected { part, variant: variant.into(), shade, samples, error };
    let (toon, lambert) = (Some(ShadeKey::Toon), Some(ShadeKey::Lambert));
    CostTable {
        version: "0".into(),
        executors: vec!["cpu".into()],
        entries: vec![
            entry(Part::Light, "per pixel", lambert, 1, 10.0),
            entry(Part::Light, "per pixel", toon, 1, 12.0),
            entry(Part::Light, "per vertex", toon, 1, 11.0),
            entry(Part::Lines, "edges", None, 1, 5.0),
            entry(Part::Lines, "image, 64 bits, dilated", None, 1, 3.0),
            entry(Part::Lines, "image, 64 bits, dilated", None, 2, 2.0),
        ],
        expected: vec![
            expected(Part::Light, "per pixel", toon, 1, 0.02),
            expected(Part::Light, "per pixel", toon, 2, 0.01),
            expected(Part::Light, "per vertex", toon, 1, 0.08),
            expected(Part::Lines, "edges", None, 1, 0.0),
            expected(Part::Lines, "image, 64 bits, dilated", None, 1, 0.06),
        ],
    }
}

fn all() -> Vec<Configuration> {
    let scene = Scene::new(npr_mesh::embedded::cube());
    let camera = Camera::framed(scene.corners(), 1.0, &Default::default());
    let setup = Setup { style: style("cartoon").expect("a style of this crate"), samples: 1 };
    configurations(&scene, &setup, &View::new(camera, (1000, 1000)), &table())
}

fn named(configuration: &Configuration) -> String {
    configuration.variants.iter().map(|(_, name)| *name).collect::<Vec<_>>().join("; ")
}

#[test]
fn costs_add_up_and_the_cheapest_comes_first() {
    let all = all();
    // Two ways to light, two to draw lines, three numbers of samples.
    assert_eq!(all.len(), 12);
    assert_eq!(named(&all[0]), "per vertex; image, 64 bits; 1 sample");
    approx::assert_relative_eq!(all[0].cost_ms, 14.0);
    approx::assert_relative_eq!(all[0].cost_plain, 1.4);
    assert!(all.is_sorted_by(|a, b| a.cost_plain <= b.cost_plain));
    // The entry for two samples holds for four: 16 times 12 ns, and 16 times 2.
    let most = all.iter().find(|c| named(c) == "per pixel; image, 64 bits; 4 x 4 samples").expect("it is there");
    approx::assert_relative_eq!(most.cost_ms, 16.0 * 14.0);
    // As expected of two samples, since none is known for four.
    assert_eq!(most.errors, [(Measure::Lines, 0.06), (Measure::Tone, 0.01)]);
}

#[test]
fn within_an_error_the_cheapest_is_chosen_by_what_is_measured() {
    let all = all();
    let budget = Budget { max_errors: "lines=0.02".parse().expect("a budget"), ..Budget::default() };
    // As expected.
    let expected = |configuration: &Configuration, of| {
        Ok(configuration.errors.iter().find(|(measure, _)| *measure == of).map_or(0.0, |(_, error)| *error))
    };
    let choice = within(&all, &budget, expected).expect("there is one");
    assert_eq!(named(&choice.chosen), "per vertex; edges; 1 sample");
    assert_eq!(choice.measured, [(Measure::Lines, 0.0)]);
    // In this scene lines in the image are good enough.
    let choice = within(&all, &budget, |_, _| Ok(0.02)).expect("there is one");
    assert_eq!(named(&choice.chosen), "per vertex; image, 64 bits; 1 sample");
    let both = Budget { max_errors: "lines=0.02, tone=0.05".parse().expect("a budget"), ..Budget::default() };
    let choice = within(&all, &both, expected).expect("there is one");
    assert_eq!(named(&choice.chosen), "per pixel; edges; 1 sample");
    let cheaper = choice.cheaper.expect("there is a cheaper one");
    assert!(cheaper.cost_plain < choice.chosen.cost_plain);
    let better = choice.better.expect("there is a better one");
    assert!(better.total_error() < choice.chosen.total_error() && better.cost_plain > choice.chosen.cost_plain);
}

#[test]
fn within_a_time_the_most_accurate_is_chosen() {
    let all = all();
    let budget = |max_time| Budget { max_time: Some(max_time), ..Budget::default() };
    let of = |time| {
        within(&all, &budget(time), |_, _| unreachable!("nothing is measured")).map(|choice| named(&choice.chosen))
    };
    assert_eq!(of(MaxTime::Plain(1.7)).expect("fits"), "per pixel; edges; 1 sample");
    assert_eq!(of(MaxTime::Ms(17.0)).expect("fits"), "per pixel; edges; 1 sample");
    // Lines err by 3 units in the image, light by 6 more at vertices.
    assert_eq!(of(MaxTime::Plain(1.6)).expect("fits"), "per pixel; image, 64 bits; 1 sample");
    match of(MaxTime::Plain(1.3)) {
        Err(HarnessError::NoSuchSpeed { asked_plain, least_plain, least_ms }) => {
            assert_eq!(asked_plain, 1.3);
            approx::assert_relative_eq!(least_plain, 1.4);
            approx::assert_relative_eq!(least_ms, 14.0);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_no_configuration_keeps_to_is_said_with_the_least_error() {
    let budget = Budget { max_errors: "tone=0.001".parse().expect("a budget"), ..Budget::default() };
    let mut tried = 0;
    let found = within(&all(), &budget, |configuration, _| {
        tried += 1;
        Ok(configuration.errors[1].1)
    });
    match found {
        Err(HarnessError::NoSuchAccuracy { measure: "tone", asked, least, in_time: false }) => {
            assert_eq!((asked, least, tried), (0.001, 0.01, 12));
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_plain_pass_is_the_unit() {
    let scene = Scene::new(npr_mesh::embedded::cube());
    let camera = Camera::framed(scene.corners(), 1.0, &Default::default());
    let all = configurations(&scene, &plain(), &View::new(camera, (64, 64)), &table());
    assert_eq!(all.iter().map(|c| c.cost_plain).fold(f64::INFINITY, f64::min), 1.0);
}

#[test]
fn budgets_of_errors_are_read_and_refused() {
    let read = |text: &str| text.parse::<MaxErrors>();
    assert_eq!(read("lines=0.02,tone=0.01").map(|all| all.0), Ok(vec![(Measure::Lines, 0.02), (Measure::Tone, 0.01)]));
    for (text, what) in [
        ("lines", "is no budget"),
        ("line=0.1", "is no measure"),
        ("lines=a", "is no error"),
        ("lines=2", "is no error"),
        ("lines=nan", "is no error"),
        ("lines=0.1,lines=0.2", "given twice"),
        ("lines=-0.1", "from 0 to 1"),
        ("", "is no budget"),
    ] {
        let error = read(text).expect_err(text);
        assert!(error.contains(what), "{text}: {error}");
    }
}

#[test]
fn a_budget_for_what_a_style_does_not_have_is_refused() {
    let check = |name: &str, errors: &str| {
        let style = style(name).expect("a style of this crate");
        errors.parse::<MaxErrors>().expect("a budget").check(&style)
    };
    assert!(check("cartoon", "lines=0.1,tone=0.1").is_ok());
    assert!(check("toon-shadow", "lines=0.1,tone=0.1,shadows=0.1").is_ok());
    for (name, errors, what) in [
        ("lambert", "lines=0.1", "lines"),
        ("lines", "tone=0.1", "tone"),
        ("cartoon", "tone=0.1,shadows=0.1", "shadows"),
    ] {
        match check(name, errors) {
            Err(HarnessError::NothingErrs { style, measure }) => assert_eq!((style.as_str(), measure), (name, what)),
            other => panic!("{other:?}"),
        }
    }
}
