use super::labels::{Box2, Label, Surroundings, place};
use super::scale::number;
use super::*;
use resvg::usvg::Node;

/// Random numbers in 0..1, seeded (a linear congruential generator, Knuth's MMIX).
fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn axis(title: &str, logarithmic: bool) -> Axis {
    Axis { title: title.into(), logarithmic }
}

fn example(count: usize, seed: u64) -> Scatter {
    let mut random = random(seed);
    let names = [
        "edges, ribbons",
        "printed fins",
        "hull, pushed along normals",
        "image, 32-bit packed",
        "image, 64-bit packed",
        "dilation by squares",
        "distance field, 8 steps",
        "compute line rasteriser",
    ];
    let points: Vec<Point> = (0..count)
        .map(|n| {
            let x = 10f64.powf(0.2 + 1.6 * random());
            let error = 10f64.powf(-3.0 + 2.6 * random());
            Point {
                label: format!(
                    "{}{}",
                    names[n % names.len()],
                    if n >= 8 { format!(" {}", n / 8) } else { String::new() }
                ),
                group: ["CPU, ray casting", "GPU (llvmpipe)", "GPU (H200)"][n % 3].into(),
                x,
                x_low: x * (1.0 - 0.15 * random()),
                x_high: x * (1.0 + 0.15 * random()),
                y: if n % 11 == 5 { 0.0 } else { error },
                historical: n % 7 == 1,
            }
        })
        .collect();
    let dominates = |a: &Point, b: &Point| a.x <= b.x && a.y <= b.y && (a.x < b.x || a.y < b.y);
    let front = (0..count).filter(|n| !points.iter().any(|other| dominates(other, &points[*n]))).collect();
    Scatter {
        title: "Lines: error against time".into(),
        x: axis("time relative to a plain pass", true),
        y: axis("1 − F1 within 1.5 px", true),
        groups: Vec::new(),
        points,
        front,
    }
}

fn curves_example() -> Curves {
    let curve = |name: &str, scale: f64, measured, predicted| Curve {
        name: name.into(),
        points: (0..24).map(|n| 10f64.powf(f64::from(n) / 6.0)).map(|x| (x, (x * scale).powi(2) * 1e-6)).collect(),
        measured,
        predicted,
    };
    Curves {
        title: "Depth gap that is still distinguished".into(),
        x: axis("distance, radii", true),
        y: axis("smallest gap, radii", true),
        curves: vec![
            curve("16-bit float", 4.0, Some(60.0), Some(64.0)),
            curve("24-bit fixed", 1.0, Some(300.0), None),
            curve("32-bit float", 0.2, Some(1800.0), Some(1500.0)),
        ],
    }
}

/// The boxes of all texts of an SVG, and its size.
fn texts(svg: &str) -> (Vec<(String, Box2)>, (f64, f64)) {
    fn walk(group: &usvg::Group, found: &mut Vec<(String, Box2)>) {
        for node in group.children() {
            match node {
                Node::Group(group) => walk(group, found),
                Node::Text(text) => {
                    let area = text.abs_bounding_box();
                    let [left, top, right, bottom] =
                        [area.left(), area.top(), area.right(), area.bottom()].map(f64::from);
                    let content = text.chunks().iter().map(|chunk| chunk.text()).collect();
                    found.push((content, Box2 { left, top, right, bottom }));
                }
                _ => {}
            }
        }
    }
    let tree = parse(svg).expect("an SVG");
    let mut found = Vec::new();
    walk(tree.root(), &mut found);
    (found, (tree.size().width().into(), tree.size().height().into()))
}

fn assert_legible(svg: &str, what: &str) {
    let (texts, (width, height)) = texts(svg);
    assert!(texts.len() > 5, "{what}: {} texts", texts.len());
    let picture = Box2 { left: 0.0, top: 0.0, right: width, bottom: height };
    let font = skrifa::FontRef::new(notosans::REGULAR_TTF).expect("a font");
    for (n, (text, area)) in texts.iter().enumerate() {
        let missing = text.chars().find(|&c| skrifa::MetadataProvider::charmap(&font).map(c).is_none());
        assert_eq!(missing, None, "{what}: the font has no such character, of {text:?}");
        assert!(picture.contains(area), "{what}: {text:?} leaves the picture: {area:?}");
        for (other, other_area) in &texts[..n] {
            // The height of a box includes the font's ascent and descent, which no letter fills.
            let core = |area: &Box2| {
                let trim = 0.2 * (area.bottom - area.top);
                Box2 { top: area.top + trim, bottom: area.bottom - trim, ..*area }
            };
            assert!(!core(area).overlaps(&core(other_area)), "{what}: {text:?} and {other:?} overlap");
        }
    }
}

#[test]
fn texts_of_diagrams_neither_overlap_nor_leave_the_picture() {
    for (count, seed) in [(0, 1), (1, 1), (2, 2), (9, 3), (16, 4), (22, 5), (22, 6), (45, 7), (80, 8)] {
        assert_legible(&scatter(&example(count, seed)), &format!("{count} points, seed {seed}"));
    }
    let mut linear = example(12, 9);
    (linear.x.logarithmic, linear.y.logarithmic) = (false, false);
    assert_legible(&scatter(&linear), "linear");
    let mut narrow = example(12, 10);
    for (n, point) in narrow.points.iter_mut().enumerate() {
        point.x = 1.0 + 0.01 * n as f64;
        (point.x_low, point.x_high, point.y) = (point.x, point.x, 1234.0 + n as f64);
    }
    assert_legible(&scatter(&narrow), "a narrow range");
    assert_legible(&curves(&curves_example()), "curves");
    let mut close = curves_example();
    for (n, curve) in close.curves.iter_mut().enumerate() {
        (curve.measured, curve.predicted) = (Some(1.01 + 0.01 * n as f64), Some(6812.9 - n as f64));
    }
    let svg = curves(&close);
    assert_legible(&svg, "limits near each other");
    for text in ["1.01", "1.02", "1.03", "6813", "6812", "6811"] {
        assert!(texts(&svg).0.iter().any(|(found, _)| found.trim() == text), "{text} is not there");
    }
}

#[test]
fn values_of_limits_have_room_at_any_distance() {
    for step in 0..40 {
        let mut diagram = curves_example();
        for (n, curve) in diagram.curves.iter_mut().enumerate() {
            let value = 12.34 * 10f64.powf(0.01 * f64::from(step) * n as f64);
            (curve.measured, curve.predicted) = (Some(value), Some(1.11 * value));
        }
        assert_legible(&curves(&diagram), &format!("step {step}"));
    }
}

#[test]
fn ticks_do_not_touch() {
    let mut random = random(3);
    for n in 0..400 {
        let (decade, extent) = (10.0 * random() - 5.0, 10f64.powf(6.0 * random() - 4.0));
        let low = 10f64.powf(decade);
        let axis = axis("", n % 2 == 0);
        let values = [low, low * (1.0 + extent), if n % 3 == 0 { 0.0 } else { low }];
        for is_stacked in [false, true] {
            let scale = scale::Scale::new(&axis, values.into_iter(), (60.0, 300.0));
            let mut ticks = scale.ticks(13.0, is_stacked);
            assert!(ticks.len() >= 2, "{values:?}: {ticks:?}");
            ticks.sort_by(|a, b| a.at.total_cmp(&b.at));
            for pair in ticks.windows(2) {
                let length = |text: &str| if is_stacked { 13.0 } else { canvas::text_width(text, 13.0, false) };
                let room = 0.5 * (length(&pair[0].text) + length(&pair[1].text));
                assert!(pair[1].at - pair[0].at > room, "{values:?}, {pair:?}");
                assert_ne!(pair[0].text, pair[1].text, "{values:?}");
            }
        }
    }
}

#[test]
fn every_point_is_named_or_numbered() {
    for (count, seed) in [(22, 5), (45, 7)] {
        let example = example(count, seed);
        let (texts, _) = texts(&scatter(&example));
        for (n, point) in example.points.iter().enumerate() {
            assert!(texts.iter().any(|(text, _)| text.trim() == point.label), "point {n}, {}", point.label);
        }
    }
}

#[test]
fn labels_have_room_of_their_own() {
    for seed in 0..60 {
        let mut random = random(seed);
        let bounds = Box2 { left: 10.0, top: 20.0, right: 900.0, bottom: 520.0 };
        let labels: Vec<Label> = (0..24)
            .map(|_| {
                // Half of them in a cluster.
                let spread = if random() < 0.5 { 0.15 } else { 1.0 };
                let point = (10.0 + 890.0 * spread * random(), 20.0 + 500.0 * spread * random());
                Label { point, size: (30.0 + 140.0 * random(), 15.0) }
            })
            .collect();
        let marks: Vec<_> = labels.iter().map(|label| Box2::around(label.point, 6.0, 6.0)).collect();
        let around = Surroundings { marks: marks.clone(), segments: Vec::new() };
        let placed = place(&labels, &around, bounds);
        assert_eq!(placed, place(&labels, &around, bounds), "seed {seed}");
        for (n, (area, label)) in placed.iter().zip(&labels).enumerate() {
            let area = area.unwrap_or_else(|| panic!("seed {seed}: no room for label {n}"));
            assert!(
                (area.right - area.left - label.size.0).abs() < 1e-9 && (area.bottom - area.top - 15.0).abs() < 1e-9
            );
            assert!(bounds.contains(&area), "seed {seed}: label {n} is outside");
            assert!(!marks.iter().any(|mark| mark.overlaps(&area)), "seed {seed}: label {n} covers a mark");
            assert!(!placed[..n].iter().flatten().any(|other| other.overlaps(&area)), "seed {seed}: label {n}");
        }
    }
    let crowded = Label { point: (5.0, 5.0), size: (50.0, 10.0) };
    let bounds = Box2 { left: 0.0, top: 0.0, right: 20.0, bottom: 20.0 };
    assert_eq!(place(&[crowded], &Surroundings::default(), bounds), [None], "wider than the picture");
}

#[test]
fn pictures_are_equal_on_repeated_runs_and_not_blank() {
    for svg in [scatter(&example(16, 4)), curves(&curves_example())] {
        let first = png(&svg, 1.0).expect("a PNG");
        assert_eq!(first, png(&svg, 1.0).expect("a PNG"));
        let image = image::load_from_memory(&first).expect("a PNG").to_rgb8();
        let ground = image.pixels().filter(|pixel| pixel.0 == GROUND.light).count();
        let share = ground as f64 / (image.width() * image.height()) as f64;
        assert!((0.7..0.98).contains(&share), "{share} of the picture is ground");
        for color in &SERIES[..3] {
            assert!(image.pixels().any(|pixel| pixel.0 == color.light), "{color:?} is not there");
        }
    }
}

#[test]
fn themed_diagrams_have_only_variables_as_colours() {
    let svg = scatter(&example(16, 4));
    let themed = themed(&svg);
    assert!(!themed.contains("\"#"), "a colour is literal");
    for color in palette().iter().take(5) {
        assert!(themed.contains(&format!("var({})", color.variable)), "{color:?}");
    }
    let root = &themed[..themed.find('>').expect("a tag")];
    assert!(root.contains("viewBox") && !root.contains("width") && !root.contains("height"), "{root}");
    assert!(parse(&svg).is_ok());
}

/// The contrast of WCAG 2.1, from relative luminances.
fn contrast(a: [u8; 3], b: [u8; 3]) -> f64 {
    let luminance = |rgb: [u8; 3]| {
        let linear = rgb.map(|c| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        });
        0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    };
    let (a, b) = (luminance(a), luminance(b));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

#[test]
fn colours_contrast_with_the_ground() {
    for color in [INK, FAINT].into_iter().chain(SERIES) {
        for (theme, colour, ground) in [("light", color.light, GROUND.light), ("dark", color.dark, GROUND.dark)] {
            let contrast = contrast(colour, ground);
            assert!(contrast >= 4.5, "{}, {theme}: {contrast:.2}", color.variable);
        }
    }
}

#[test]
fn numbers_are_short() {
    let cases = [
        (0.0, "0"),
        (1.0, "1"),
        (0.05, "0.05"),
        (-2.5, "−2.5"),
        (1234.0, "1234"),
        (1e-4, "1e−4"),
        (2.5e-7, "2.5e−7"),
        (1e5, "1e5"),
        (0.1 + 0.2, "0.3"),
    ];
    for (value, text) in cases {
        assert_eq!(number(value), text);
    }
}

#[test]
fn zero_has_a_line_of_its_own_on_a_logarithmic_axis() {
    let values = [0.0, 1e-3, 1.0];
    let scale = scale::Scale::new(&axis("", true), values.into_iter(), (500.0, 100.0));
    let zero = scale.zero.expect("a line");
    assert!(zero < 500.0 && scale.at(0.0) == zero && scale.at(1e-3) < zero - 10.0);
    let ticks = scale.ticks(13.0, true);
    assert_eq!(ticks[0].text, "0");
    let one = ticks.iter().find(|tick| tick.text == "1").expect("marked");
    assert!((scale.at(1.0) - one.at).abs() < 1e-9);
    let ticks: Vec<_> = ticks.iter().map(|tick| &*tick.text).collect();
    assert!(ticks.contains(&"0.01") && ticks.contains(&"0.1"), "{ticks:?}");
}

/// Writes the examples to the folder that NPR_PLOTS names, to be looked at.
#[test]
fn examples_to_look_at() {
    let Some(dir) = std::env::var_os("NPR_PLOTS") else { return };
    let dir = std::path::Path::new(&dir);
    for (name, svg) in [
        ("scatter-9", scatter(&example(9, 3))),
        ("scatter-22", scatter(&example(22, 5))),
        ("scatter-45", scatter(&example(45, 7))),
        ("curves", curves(&curves_example())),
    ] {
        std::fs::write(dir.join(format!("{name}.svg")), &svg).expect("written");
        std::fs::write(dir.join(format!("{name}.png")), png(&svg, 1.5).expect("a PNG")).expect("written");
    }
}
