//! The parameters survive a round trip through JSON, and their names are in kebab case.
#![cfg(feature = "serde")]

use npr_hatch::{Placement, TamParameters};
use serde_json::json;

#[test]
fn parameters_survive_a_round_trip() {
    let parameters = TamParameters {
        tones: vec![0.75, 0.5],
        width_px: 2.0,
        length: [0.25, 0.5],
        cross_from: None,
        placement: Placement::BestOf { candidates: 16 },
        ..TamParameters::default()
    };
    let json = serde_json::to_value(&parameters).unwrap();
    for (name, value) in [
        ("tones", json!([0.75, 0.5])),
        ("width-px", json!(2.0)),
        ("length", json!([0.25, 0.5])),
        ("cross-from", json!(null)),
        ("placement", json!({ "best-of": { "candidates": 16 } })),
    ] {
        assert_eq!(json[name], value, "{name}");
    }
    assert_eq!(serde_json::from_value::<TamParameters>(json).unwrap(), parameters);
}

#[test]
fn missing_fields_have_the_defaults_and_unknown_fields_are_errors() {
    assert_eq!(serde_json::from_value::<TamParameters>(json!({})).unwrap(), TamParameters::default());
    assert!(serde_json::from_value::<TamParameters>(json!({ "width": 1.0 })).is_err());
}
