//! Inverted hulls as a way to draw lines.

use super::HullLines;
use crate::style::Lines;
use crate::variant::{RequestedLines, Setup, Variant};
use npr_outline::hull::HullNormals;

/// Ways to draw lines.
pub(crate) const VARIANTS: &[Variant] = &[
    Variant {
        name: "hull, welded normals",
        choices: &["HullNormals::Welded"],
        historical: false,
        in_budget: true,
        apply: |setup| hull(setup, HullNormals::Welded),
    },
    Variant {
        name: "hull, normals of vertices",
        choices: &["HullNormals::Vertices"],
        historical: false,
        in_budget: true,
        apply: |setup| hull(setup, HullNormals::Vertices),
    },
];

fn hull(setup: &Setup, normals: HullNormals) -> Option<Setup> {
    RequestedLines::drawn(setup, |asked| {
        let RequestedLines { width_px, color, opacity, .. } = *asked;
        (opacity == 1.0).then(|| Lines::hull(HullLines { width_px, ink: color, normals }))
    })
}
