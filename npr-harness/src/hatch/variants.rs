//! The ways to lay strokes on a surface.

use super::{HatchEncoding, HatchShade};
use crate::shade::Shade;
use crate::style::Style;
use crate::variant::{Setup, Variant};
use npr_toon::normal::NormalUse;

/// Ways to lay strokes on a surface. The mapping is part of the look, so each variant keeps that of the style, and the
/// chart measures every mapping.
pub(crate) const VARIANTS: &[Variant] = &[
    Variant {
        name: "six tones",
        choices: &["HatchEncoding::SixTones"],
        historical: false,
        in_budget: true,
        apply: |setup| strokes(setup, HatchEncoding::SixTones, NormalUse::PerPixel),
    },
    Variant {
        name: "six tones, weights per vertex",
        choices: &["NormalUse::PerVertex"],
        historical: false,
        in_budget: true,
        apply: |setup| strokes(setup, HatchEncoding::SixTones, NormalUse::PerVertex),
    },
    Variant {
        name: "thresholds",
        choices: &["HatchEncoding::Thresholds"],
        historical: false,
        in_budget: true,
        apply: |setup| strokes(setup, HatchEncoding::Thresholds, NormalUse::PerPixel),
    },
    Variant {
        name: "thresholds, light per vertex",
        choices: &[],
        historical: false,
        in_budget: true,
        apply: |setup| strokes(setup, HatchEncoding::Thresholds, NormalUse::PerVertex),
    },
];

fn strokes(setup: &Setup, encoding: HatchEncoding, normals: NormalUse) -> Option<Setup> {
    let Shade::Hatch(hatch) = &setup.style.shade else { return None };
    // Six tones need a map of six.
    if encoding == HatchEncoding::SixTones && hatch.map.tones() != npr_hatch::HATCH_TONES {
        return None;
    }
    let shade = Shade::Hatch(HatchShade { encoding, ..hatch.clone() });
    Some(Setup { style: Style { shade, normals, ..setup.style.clone() }, ..*setup })
}
