//! The ways to light a surface.

use super::Shade;
use crate::style::Style;
use crate::variant::{Setup, Variant};
use npr_toon::Bands;
use npr_toon::normal::NormalUse;

/// Ways to light a surface. Light of whole faces is another look, which no plan chooses by itself.
pub(crate) const VARIANTS: &[Variant] = &[
    Variant {
        name: "per pixel",
        choices: &["NormalUse::PerPixel"],
        historical: false,
        in_budget: true,
        apply: |setup| lit(setup, NormalUse::PerPixel),
    },
    Variant {
        name: "interpolated normals",
        choices: &["NormalUse::Interpolated"],
        historical: false,
        in_budget: true,
        apply: |setup| lit(setup, NormalUse::Interpolated),
    },
    Variant {
        name: "per vertex",
        choices: &["NormalUse::PerVertex"],
        historical: false,
        in_budget: true,
        apply: |setup| lit(setup, NormalUse::PerVertex),
    },
    Variant {
        name: "per subdivided face",
        choices: &["NormalUse::PerSubdividedFace"],
        historical: false,
        in_budget: false,
        apply: |setup| lit(setup, NormalUse::PerSubdividedFace(4)),
    },
    Variant {
        name: "per face",
        choices: &["NormalUse::PerFace"],
        historical: false,
        in_budget: false,
        apply: |setup| lit(setup, NormalUse::PerFace),
    },
    Variant {
        name: "per pixel, hard borders",
        choices: &[],
        historical: false,
        in_budget: true,
        apply: |setup| {
            let Shade::Toon(bands) = &setup.style.shade else { return None };
            let shade = Shade::Toon(Bands { antialias: false, ..bands.clone() });
            lit(&Setup { style: Style { shade, ..setup.style.clone() }, ..*setup }, NormalUse::PerPixel)
        },
    },
];

/// Strokes have variants of their own, and normals as colours are not lit.
fn lit(setup: &Setup, normals: NormalUse) -> Option<Setup> {
    let is_lit = !matches!(setup.style.shade, Shade::Paper | Shade::Normals | Shade::Hatch(_));
    is_lit.then(|| Setup { style: Style { normals, ..setup.style.clone() }, ..*setup })
}
