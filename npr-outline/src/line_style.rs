//! Line styles: width, colour and opacity.

use crate::{LineKind, OutlineError};

/// The style of lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineStyle {
    /// Width in px by [`LineKind`]; 0 draws none of that kind.
    pub width_px: [f32; 5],
    /// Display-referred colour and opacity, 0..=1.
    pub ink: [f32; 4],
}

impl LineStyle {
    /// Checks that widths are finite and not negative.
    ///
    /// # Errors
    /// [`OutlineError::Width`].
    pub fn validate(&self) -> Result<(), OutlineError> {
        match self.width_px.iter().find(|w| !(w.is_finite() && **w >= 0.0)) {
            Some(&width_px) => Err(OutlineError::Width { width_px }),
            None => Ok(()),
        }
    }
}

/// Widths in px, in the order of the kinds' numbers. Lines that the file draws are as wide as creases, or as boundaries
/// where creases are not drawn.
pub fn widths_px(silhouette: f32, boundary: f32, crease: f32, material_border: f32) -> [f32; 5] {
    let mut widths = [0.0; 5];
    widths[LineKind::Silhouette as usize] = silhouette;
    widths[LineKind::Boundary as usize] = boundary;
    widths[LineKind::Crease as usize] = crease;
    widths[LineKind::MaterialBorder as usize] = material_border;
    widths[LineKind::Authored as usize] = if crease > 0.0 { crease } else { boundary };
    widths
}
