//! Edge lines as a way to draw lines.

use crate::style::Lines;
use crate::variant::{RequestedLines, Variant};
use npr_outline::LineKind;
use npr_outline::line_style::{LineStyle, widths_px};

/// Ways to draw lines. Which executor finds them depends on capabilities.
pub(crate) const VARIANTS: &[Variant] = &[Variant {
    name: "edges",
    choices: &["EdgeLineMethod::OnCpu", "EdgeLineMethod::OnDevice", "LineSource::Records", "LineSource::OnDevice"],
    historical: false,
    in_budget: true,
    apply: |setup| {
        RequestedLines::drawn(setup, |asked| {
            let RequestedLines { width_px, crease_px, border_px, color, opacity } = *asked;
            let mut width_px = widths_px(width_px, width_px, crease_px, border_px);
            if let Some(own) = &setup.style.lines.edges {
                width_px[LineKind::Authored as usize] = own.width_px[LineKind::Authored as usize];
            }
            Some(Lines::edges(LineStyle { width_px, ink: color.extend(opacity).to_array() }))
        })
    },
}];
