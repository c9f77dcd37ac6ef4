//! The ways to find shadows on a device. The CPU executor follows rays, whatever the method.

use super::{ShadowMethod, ShadowStyle};
use crate::style::Style;
use crate::variant::{Setup, Variant};

/// Ways to find shadows.
pub(crate) const VARIANTS: &[Variant] = &[
    Variant {
        name: "volumes",
        choices: &["ShadowMethod::Volumes", "ShadowTechnique::Volumes", "ShadowTechnique::Rays"],
        historical: false,
        in_budget: true,
        apply: |setup| shadows(setup, ShadowMethod::Volumes),
    },
    Variant {
        name: "map of 512",
        choices: &["ShadowMethod::Map", "ShadowTechnique::Map"],
        historical: false,
        in_budget: true,
        apply: |setup| map(setup, 512),
    },
    Variant { name: "map of 1024", choices: &[], historical: false, in_budget: true, apply: |setup| map(setup, 1024) },
    Variant { name: "map of 2048", choices: &[], historical: false, in_budget: true, apply: |setup| map(setup, 2048) },
    Variant { name: "map of 4096", choices: &[], historical: false, in_budget: true, apply: |setup| map(setup, 4096) },
];

fn map(setup: &Setup, side: u32) -> Option<Setup> {
    shadows(setup, ShadowMethod::Map { side })
}

fn shadows(setup: &Setup, method: ShadowMethod) -> Option<Setup> {
    let shadow = Some(ShadowStyle { method, ..setup.style.shadow? });
    Some(Setup { style: Style { shadow, ..setup.style.clone() }, ..*setup })
}
