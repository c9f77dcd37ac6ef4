//! The types of the atlas.

use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::picture::Image;
use serde::{Deserialize, Serialize};

/// A sweep of the atlas.
#[derive(Clone, Copy)]
pub struct Sweep {
    /// The name, in kebab case: also that of its files.
    pub name: &'static str,
    /// The technique that it breaks, such as "lines from edges".
    pub technique: &'static str,
    /// What fails, and why, in a sentence or two.
    pub what: &'static str,
    /// Whether it needs an adapter; it is skipped, by name, where there is none.
    pub needs_adapter: bool,
    /// Measures it, within about a second on two cores.
    pub run: fn(&Executor) -> Result<Finding, HarnessError>,
}

/// What a sweep found.
#[derive(Clone, Debug)]
pub struct Finding {
    /// The parameter that is varied.
    pub parameter: Axis,
    /// The error that is measured.
    pub error: Axis,
    /// A curve for each method or format that is compared.
    pub curves: Vec<Curve>,
    /// Pictures at the breaking point, each with a caption. Small: up to about 320 × 240 px.
    pub pictures: Vec<(String, Image)>,
}

/// An axis of a diagram.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// The quantity.
    pub name: String,
    /// Its unit; empty for none.
    pub unit: String,
    /// Whether it is drawn on a logarithmic scale; values that are not positive are drawn at the border then.
    pub logarithmic: bool,
}

impl Axis {
    /// A linear axis.
    pub fn linear(name: &str, unit: &str) -> Self {
        Self { name: name.into(), unit: unit.into(), logarithmic: false }
    }

    /// A logarithmic axis.
    pub fn logarithmic(name: &str, unit: &str) -> Self {
        Self { logarithmic: true, ..Self::linear(name, unit) }
    }
}

/// The error of one method over the parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// The method.
    pub name: String,
    /// Parameter and error, by ascending parameter.
    pub points: Vec<(f64, f64)>,
    /// The limit of the method.
    pub limit: Limit,
}

/// Where a method stops working.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// What the number is, such as "largest angle to tangency at which an edge is misjudged, degrees". A value of the
    /// parameter is named by "at which" or "below which" and so on, an error without "which".
    pub what: String,
    /// The number that was measured.
    pub measured: f64,
    /// Whether the number is a value of the sweep's parameter, which diagrams mark on its axis; otherwise it is an error.
    pub is_of_parameter: bool,
    /// The number that a formula predicts, and the formula with its source.
    pub predicted: Option<(f64, String)>,
    /// The bound that a test holds it to.
    pub bound: Bound,
    /// Whether the method is to be mended so that the limit moves, and how; otherwise it lies in the method.
    pub to_be_mended: Option<String>,
}

impl Limit {
    /// With what a formula predicts.
    pub(super) fn predicted(self, value: f64, formula: &str) -> Self {
        Self { predicted: Some((value, formula.into())), ..self }
    }

    /// With how it is to be mended.
    pub(super) fn mend_by(self, how: &str) -> Self {
        Self { to_be_mended: Some(how.into()), ..self }
    }
}
