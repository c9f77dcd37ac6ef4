//! The style survives a round trip through JSON, and its names are in kebab case.
#![cfg(feature = "serde")]

use npr_gooch::Gooch;
use serde_json::json;

#[test]
fn a_style_survives_a_round_trip() {
    let json = json!({
        "blue": [0.0, 0.0, 0.5], "yellow": [0.25, 0.25, 0.0], "alpha": 0.25, "beta": 0.5, "tones": "equation",
        "highlight": { "color": [1.0, 1.0, 1.0], "strength": 1.0, "exponent": 32.0 },
    });
    let model = Gooch::from_numbers(0.5, 0.25, 0.25, 0.5);
    assert_eq!(serde_json::to_value(model).unwrap(), json);
    assert_eq!(serde_json::from_value::<Gooch>(json).unwrap(), model);
}

#[test]
fn missing_fields_have_the_defaults_and_unknown_fields_are_errors() {
    assert_eq!(serde_json::from_value::<Gooch>(json!({})).unwrap(), Gooch::default());
    assert!(serde_json::from_value::<Gooch>(json!({ "gamma": 1.0 })).is_err());
}
