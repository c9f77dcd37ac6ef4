//! Charts: every choice of the API is shown, and rows are what they say.

use npr_harness::chart::{Lab, Row, Subject, Table, Time, charts};
use npr_harness::executor::{Backend, Executor};
use npr_harness::measure::{Rounds, Spread};
use npr_harness::scene::Scene;
use npr_harness::variant::Part;
use npr_mesh::embedded;
use std::collections::BTreeSet;
use std::path::Path;

/// Public enums that are no ways to make the same thing, and why.
const NO_VARIANTS: &[(&str, &str)] = &[
    ("AlphaMode", "a material's"),
    ("ArtistRotation", "what lines an artist directs"),
    ("Bytes", "a reader's"),
    ("Composite", "how ink looks"),
    ("Detail", "how bands look"),
    ("DepthSource", "what a renderer of one's own has; its harness stores linear depth"),
    ("EdgeKind", "a mesh's"),
    ("HatchGround", "how strokes look"),
    ("HatchSource", "where a map comes from"),
    ("HatchTransfer", "how tones look"),
    ("InkTarget", "what a pass writes"),
    ("LightKind", "a light's"),
    ("PrincipalDirection", "how strokes look"),
    ("Ramp2dSource", "where a ramp comes from"),
    ("RampBlend", "how a ramp looks"),
    ("RampSource", "where a ramp comes from"),
    ("Shade", "how surfaces look"),
    ("ShadowLines", "what lines are drawn"),
    ("ShadowState", "a result"),
    ("ShadowTest", "what lines are drawn"),
    ("Show", "what is drawn"),
    ("SideVisibility", "what a file says"),
    ("Step", "a pass of a dilation"),
    ("StepKind", "soft dilation is a look"),
    ("Operation", "which of four operations"),
    ("TessellateError", "an error"),
    ("TexelFilter", "how a ramp looks"),
    ("Tones", "how Gooch's light looks"),
    ("Wrap", "a texture's"),
    ("XToonDetail", "how bands look"),
    ("LineKind", "which edges are lines"),
    ("TamChannels", "the plan chooses by adapter"),
    ("Encoding", "a file's"),
    ("Kind", "a file's"),
    ("Scalar", "a file's"),
    ("UpAxis", "a file's"),
    ("Weld", "what edges are"),
];

/// Choices that are covered by another one, and why.
const NOT_APART: &[(&str, &str)] = &[("Taps::Steps", "free steps widen lines, as dilation does")];

/// The enums of a file, by name, with their variants.
fn enums(path: &Path, found: &mut Vec<(String, String)>) {
    let text = std::fs::read_to_string(path).expect("a source file");
    let file = syn::parse_file(&text).expect("it compiles");
    for item in file.items {
        let syn::Item::Enum(item) = item else { continue };
        if matches!(item.vis, syn::Visibility::Public(_)) {
            found.extend(item.variants.iter().map(|variant| (item.ident.to_string(), variant.ident.to_string())));
        }
    }
}

fn all_enums(folder: &Path, found: &mut Vec<(String, String)>) {
    let mut entries: Vec<_> =
        std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            all_enums(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            enums(&path, found);
        }
    }
}

/// What is declared, with the crate before names that two crates have.
fn choices() -> BTreeSet<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = Vec::new();
    for name in ["npr-mesh", "npr-outline", "npr-toon", "npr-gooch", "npr-hatch", "npr-imagespace"] {
        let mut of_crate = Vec::new();
        all_enums(&root.join(name).join("src"), &mut of_crate);
        let prefixed = |name_of: String| match name_of.as_str() {
            "NormalFormat" => format!("{}::{name_of}", name.replace('-', "_")),
            _ => name_of,
        };
        found.extend(of_crate.into_iter().map(|(name_of, variant)| (prefixed(name_of), variant)));
    }
    for folder in ["edge_lines", "hull_lines", "printed_fins", "image_lines", "hatch", "shadow", "shade"] {
        let of_technique = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(folder);
        all_enums(&of_technique, &mut found);
        enums(&of_technique.with_extension("rs"), &mut found);
    }
    let is_choice = |name: &str| !name.ends_with("Error") && NO_VARIANTS.iter().all(|(known, _)| *known != name);
    found.retain(|(name, _)| is_choice(name));
    found.into_iter().map(|(name, variant)| format!("{name}::{variant}")).collect()
}

fn shown() -> BTreeSet<String> {
    let of_parts = Part::ALL.into_iter().flat_map(Part::variants).flat_map(|variant| variant.choices);
    of_parts.chain(charts().iter().flat_map(|chart| chart.choices)).map(|&choice| choice.to_owned()).collect()
}

#[test]
fn every_choice_of_the_api_is_in_a_chart() {
    let (choices, shown) = (choices(), shown());
    assert!(choices.len() > 40, "{choices:?}");
    let apart: BTreeSet<String> = NOT_APART.iter().map(|(name, _)| (*name).to_owned()).collect();
    let missing: Vec<_> = choices.difference(&shown).filter(|name| !apart.contains(*name)).collect();
    assert!(missing.is_empty(), "in no chart, and not said why: {missing:?}");
    let unknown: Vec<_> = shown.iter().filter(|name| !choices.contains(*name)).collect();
    assert!(unknown.is_empty(), "charts show what is not there: {unknown:?}");
    assert!(apart.iter().all(|name| choices.contains(name) && !shown.contains(name)), "{apart:?}");
}

#[test]
fn names_of_variants_are_unique_within_a_part() {
    for part in Part::ALL {
        let names: Vec<_> = part.variants().iter().map(|variant| variant.name).collect();
        assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len(), "{names:?}");
    }
}

/// The rows of charts on the CPU and, if there is one, an adapter, of a small scene.
fn rows(names: &[&str]) -> Table {
    let executors = [Executor::choose(Backend::Auto).expect("an executor"), Executor::Cpu { why: None }];
    let executors = if executors[0].is_cpu() { &executors[1..] } else { &executors[..] };
    let size = (96, 54);
    let subjects = [Subject::framed("cone", Scene::new(embedded::cone(12)), size, &Default::default())];
    let lab = Lab {
        executors,
        subjects: &subjects,
        size,
        rounds: Rounds { rounds: 1, ..Rounds::default() },
        skipped: &|_| {},
        progress: &|_| {},
    };
    let rows = charts()
        .iter()
        .filter(|chart| names.contains(&chart.name))
        .flat_map(|chart| (chart.run)(&lab).expect("the chart is measured"))
        .collect();
    Table { rows, ..Table::default() }
}

#[test]
fn every_variant_is_a_point_of_its_chart_with_the_same_errors_each_time() {
    let names = ["lines", "formats", "dilation-4", "light-bands", "hatching-planes", "shadows"];
    let (table, again) = (rows(&names), rows(&names));
    let has_adapter = table.rows.iter().any(|row| row.executor != "cpu");
    for (part, chart) in [
        (Part::Lines, "lines"),
        (Part::Light, "light-bands"),
        (Part::Strokes, "hatching-planes"),
        (Part::Shadows, "shadows"),
        (Part::Samples, "light-bands"),
    ] {
        let points = table.points(chart);
        for variant in part.variants() {
            let is_shown = points.iter().any(|point| match variant.name {
                "1 sample" => !point.variant.contains("samples"),
                name => point.variant.contains(name),
            });
            // The CPU has rays alone.
            let needs_adapter = part == Part::Shadows;
            assert!(is_shown || needs_adapter && !has_adapter, "{chart} lacks {}", variant.name);
        }
    }
    let errors = |table: &Table| {
        let of = |row: &Row| (row.chart.clone(), row.variant.clone(), row.executor.clone(), row.errors.clone());
        table.rows.iter().map(of).collect::<Vec<_>>()
    };
    assert_eq!(format!("{:?}", errors(&table)), format!("{:?}", errors(&again)));
    for row in &table.rows {
        let Spread { median, low, high } = row.time.relative;
        assert!(0.0 < low && low <= median && median <= high, "{row:?}");
        assert!(row.errors.iter().all(|(_, error)| *error >= 0.0), "{row:?}");
    }
}

#[test]
fn a_table_is_written_as_csv_a_line_for_each_error() {
    let time = Time {
        relative: Spread { median: 2.0, low: 1.5, high: 2.5 },
        relative_own: Spread { median: 1.0, low: 1.0, high: 1.0 },
        ms: Spread { median: 8.0, low: 7.0, high: 9.0 },
        device_ms: None,
    };
    let row = Row {
        chart: "lines".into(),
        variant: "image, \"64\" bits".into(),
        historical: false,
        executor: "cpu".into(),
        scene: "teapot".into(),
        errors: vec![("1 - F1".into(), 0.25), ("flicker".into(), 0.5)],
        time,
        bytes: 1024,
    };
    let table = Table { machine: vec!["two cores".into(), "no adapter".into()], rows: vec![row], ..Table::default() };
    let version = env!("CARGO_PKG_VERSION");
    let end = format!("2,1.5,2.5,1,8,7,9,,1024,false,{version},two cores; no adapter");
    assert_eq!(
        table.to_csv(),
        format!(
            "chart,variant,executor,scene,error,value,relative,relative_low,relative_high,relative_own,ms,ms_low,ms_high,\
             device_ms,bytes,historical,version,machine\r\n\
             lines,\"image, \"\"64\"\" bits\",cpu,teapot,1 - F1,0.25,{end}\r\n\
             lines,\"image, \"\"64\"\" bits\",cpu,teapot,flicker,0.5,{end}\r\n"
        )
    );
}
