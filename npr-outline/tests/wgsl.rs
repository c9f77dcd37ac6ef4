//! All WGSL of the crate parses and validates, alone where it is a library and together as the passes use it.

#[path = "../../npr-imagespace/tests/wgsl/twins.rs"]
mod twins;

use naga::valid::{Capabilities, ValidationFlags, Validator};
use twins::{Except, Twins};

const CONTOUR: &str = include_str!("../src/contour.wgsl");
const LINE: &str = include_str!("../src/segment.wgsl");
const LINE_INK: &str = include_str!("../src/line_ink.wgsl");
const LINE_UNVEILED: &str = include_str!("../src/line_unveiled.wgsl");
const LINE_VEILED: &str = include_str!("../src/line_veiled.wgsl");
const LINE_PASS: &str = include_str!("../src/line_pass.wgsl");
const LINE_PULLED: &str = include_str!("../src/line_pulled.wgsl");
const EDGE_RECORD: &str = include_str!("../src/edge_record.wgsl");
const COMPACTION: &str = include_str!("../src/compaction.wgsl");
const NORMAL_FORMAT: &str = include_str!("../src/normal_format.wgsl");
const FIN_PRINTED: &str = include_str!("../src/fin_printed.wgsl");
const FIN_PASS: &str = include_str!("../src/fin_pass.wgsl");
const HULL: &str = include_str!("../src/hull.wgsl");
const HULL_PASS: &str = include_str!("../src/hull_pass.wgsl");

const SHADOW_VOLUME: &str = include_str!("../src/shadow_volume.wgsl");
const SHADOW_PASS: &str = include_str!("../src/shadow_pass.wgsl");
const SHADOW_MASK: &str = include_str!("../src/shadow_mask.wgsl");

fn validated(parts: &[&str]) -> naga::Module {
    let source = parts.concat();
    let module = naga::front::wgsl::parse_str(&source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(&source)));
    if let Err(error) = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module) {
        panic!("{}", error.emit_to_string(&source));
    }
    module
}

fn entry_points(parts: &[&str]) -> Vec<String> {
    validated(parts).entry_points.iter().map(|entry| entry.name.clone()).collect()
}

#[test]
fn modules_validate_as_the_passes_use_them() {
    for through in [LINE_UNVEILED, LINE_VEILED] {
        assert_eq!(entry_points(&[CONTOUR, LINE, LINE_INK, through, LINE_PASS]), ["vs_record", "fs_ink"]);
        assert_eq!(
            entry_points(&[CONTOUR, LINE, LINE_INK, through, LINE_PASS, EDGE_RECORD, LINE_PULLED]),
            ["vs_record", "fs_ink", "vs_pulled"]
        );
    }
    assert_eq!(entry_points(&[CONTOUR, LINE, EDGE_RECORD, COMPACTION]), ["compact"]);
    assert_eq!(entry_points(&[NORMAL_FORMAT, FIN_PRINTED, FIN_PASS]), ["vs_fin", "vs_fin_oct", "fs_fin"]);
    assert_eq!(entry_points(&[HULL, HULL_PASS]), ["vs_hull", "fs_hull"]);
    assert_eq!(entry_points(&[SHADOW_VOLUME, SHADOW_PASS]), ["vs_side", "vs_cap", "vs_placed"]);
    assert_eq!(entry_points(&[SHADOW_MASK]), ["vs_shadow_mask", "fs_in_shadow", "fs_lit"]);
}

#[test]
fn libraries_have_no_bindings_no_entry_points_and_one_prefix_each() {
    // Together, too: no name stands in two of them.
    validated(&[CONTOUR, LINE, NORMAL_FORMAT, FIN_PRINTED, HULL, SHADOW_VOLUME]);
    let libraries = [
        (CONTOUR, "outline_"),
        (LINE, "outline_"),
        (NORMAL_FORMAT, "normal_"),
        (FIN_PRINTED, "fin_printed_"),
        (HULL, "hull_"),
        (SHADOW_VOLUME, "outline_"),
    ];
    for (library, prefix) in libraries {
        let module = validated(&[library]);
        assert!(module.entry_points.is_empty() && module.global_variables.is_empty());
        assert!(!module.functions.is_empty());
        for (_, function) in module.functions.iter() {
            assert!(function.name.as_deref().unwrap().starts_with(prefix), "{:?}", function.name);
        }
    }
}

const TWINS: Twins<'_> = Twins {
    types: &[
        ("LineKind", "u32"),
        ("LineView", "OutlineView"),
        ("ScreenSegment", "OutlineSegment"),
        ("FinView", "FinPrintedView"),
        ("HullView", "HullView"),
    ],
    members: &[
        ("EdgePlanes", &[("plane0", "vec4<f32>"), ("plane1", "vec4<f32>")]),
        (
            "PrintedFin",
            &[
                ("position", "vec3<f32>"),
                ("smooth_normal", "vec3<f32>"),
                ("n_face0", "vec3<f32>"),
                ("n_face1", "vec3<f32>"),
            ],
        ),
    ],
    exceptions: &[
        ("outline_cross", Except::Missing, "DVec2::perp_dot"),
        ("outline_clip", Except::Result, "fractions, of which the first is above the second where Rust has None"),
        ("fin_printed_depth", Except::Parameters, "the view has what FinDepth has, as a flag and two numbers"),
    ],
};

#[test]
fn functions_have_the_signatures_of_the_rust_ones() {
    let files = [
        ("contour.wgsl", "contour.rs"),
        ("segment.wgsl", "segment.rs"),
        ("normal_format.wgsl", "normal_format.rs"),
        ("fin_printed.wgsl", "fin_printed.rs"),
        ("hull.wgsl", "hull.rs"),
        ("shadow_volume.wgsl", "shadow_volume.rs"),
    ];
    let source = |file: &str| std::fs::read_to_string(format!("{}/src/{file}", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let module = validated(&[CONTOUR, LINE, NORMAL_FORMAT, FIN_PRINTED, HULL, SHADOW_VOLUME]);
    let differences: Vec<_> =
        (files.iter()).flat_map(|(wgsl, rust)| TWINS.differences(&module, &source(wgsl), &source(rust))).collect();
    assert!(differences.is_empty(), "{}", differences.join("\n"));
    for (name, ..) in TWINS.exceptions {
        assert!(module.functions.iter().any(|(_, function)| function.name.as_deref() == Some(*name)), "{name}");
    }
}
