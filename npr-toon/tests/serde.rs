//! Style types survive a round trip through JSON, and their names are in kebab case.
#![cfg(feature = "serde")]

use npr_toon::half_lambert::HalfLambert;
use npr_toon::normal::NormalUse;
use npr_toon::ramp::{Ramp, RampBlend, RampStop};
use npr_toon::row::TexelFilter;
use npr_toon::source::{Light, LightKind};
use npr_toon::table::{Corner, Ramp2d};
use npr_toon::{Bands, Highlight};
use serde::de::DeserializeOwned;
use serde_json::json;

use glam::Vec3;

fn assert_round_trip<T: serde::Serialize + DeserializeOwned + PartialEq + std::fmt::Debug>(
    value: T,
    json: serde_json::Value,
) {
    assert_eq!(serde_json::to_value(&value).unwrap(), json);
    assert_eq!(serde_json::from_value::<T>(json).unwrap(), value);
}

#[test]
fn styles_survive_a_round_trip() {
    let color = Vec3::new(0.5, 0.25, 1.0);
    let highlight = Highlight { threshold: 0.5, color, strength: 1.0, lit_only: true };
    let highlight_json = json!({ "threshold": 0.5, "color": [0.5, 0.25, 1.0], "strength": 1.0, "lit-only": true });
    assert_round_trip(
        Bands {
            thresholds: vec![0.5],
            tones: vec![Vec3::ZERO, color],
            highlight: Some(highlight),
            antialias: true,
            absolute: true,
        },
        json!({
            "thresholds": [0.5], "tones": [[0.0, 0.0, 0.0], [0.5, 0.25, 1.0]], "highlight": highlight_json,
            "antialias": true, "absolute": true,
        }),
    );
    let ramp = Ramp { stops: vec![RampStop { at: 0.5, color }], blend: RampBlend::Smooth };
    let ramp_json = json!({ "stops": [{ "at": 0.5, "color": [0.5, 0.25, 1.0] }], "blend": "smooth" });
    assert_round_trip(
        Ramp2d { a: ramp.clone(), b: ramp, corner: Some(Corner { threshold: 1.0, color }) },
        json!({
            "a": ramp_json, "b": ramp_json, "corner": { "threshold": 1.0, "color": [0.5, 0.25, 1.0] },
        }),
    );
    assert_round_trip(HalfLambert::SOURCE, json!({ "scale": 0.5, "bias": 0.5, "squared": true }));
    assert_round_trip(
        [Light::directional(Vec3::Y), Light::positional(color)],
        json!([
            { "place": { "directional": { "to-light": [0.0, 1.0, 0.0] } }, "color": [1.0, 1.0, 1.0], "brightness": 1.0 },
            { "place": { "positional": { "position": [0.5, 0.25, 1.0] } }, "color": [1.0, 1.0, 1.0], "brightness": 1.0 },
        ]),
    );
    assert_round_trip((NormalUse::PerPixel, TexelFilter::Linear), json!(["per-pixel", "linear"]));
    assert_round_trip(
        [NormalUse::PerFace, NormalUse::PerSubdividedFace(6)],
        json!(["per-face", { "per-subdivided-face": 6 }]),
    );
}

#[test]
fn missing_fields_have_the_defaults_and_unknown_fields_are_errors() {
    assert_eq!(serde_json::from_value::<Bands>(json!({})).unwrap(), Bands::default());
    assert_eq!(serde_json::from_value::<HalfLambert>(json!({})).unwrap(), HalfLambert::default());
    assert_eq!(serde_json::from_value::<Ramp>(json!({ "stops": [] })).unwrap().blend, RampBlend::Hard);
    assert!(serde_json::from_value::<Bands>(json!({ "tone": [] })).is_err());
    assert!(serde_json::from_value::<LightKind>(json!({ "directional": { "direction": [0, 1, 0] } })).is_err());
}
