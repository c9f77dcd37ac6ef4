//! The diagrams of charts and of the atlas.

use super::{ChartContent, Found};
use crate::chart::front::front;
use crate::plot::{Axis, Curve, Curves, Point, Scatter};
use crate::stability;

/// The diagram of a chart.
pub fn chart_diagram(chart: &ChartContent) -> Scatter {
    let point = |point: &crate::chart::table::Point| Point {
        label: point.variant.clone(),
        group: point.executor.clone(),
        x: point.relative.median,
        x_low: point.relative.low,
        x_high: point.relative.high,
        y: point.error(),
        historical: point.historical,
    };
    Scatter {
        title: String::new(),
        x: Axis { title: "time of a frame relative to a plain pass (log scale)".into(), logarithmic: true },
        y: Axis { title: format!("{} (log scale)", chart.error), logarithmic: true },
        groups: chart.executors.clone(),
        points: chart.points.iter().map(point).collect(),
        front: front(&chart.points),
    }
}

/// The diagram of a sweep.
pub fn atlas_diagram(found: &Found) -> Curves {
    let axis = |axis: &stability::Axis| {
        let unit = if axis.unit.is_empty() { String::new() } else { format!(", {}", axis.unit) };
        let scale = if axis.logarithmic { " (log scale)" } else { "" };
        Axis { title: format!("{}{unit}{scale}", axis.name), logarithmic: axis.logarithmic }
    };
    // Limits that are errors have no place on the axis of the parameter.
    let curve = |curve: &stability::Curve| {
        let limit = Some(&curve.limit).filter(|limit| limit.is_of_parameter);
        Curve {
            name: curve.name.clone(),
            points: curve.points.clone(),
            measured: limit.map(|limit| limit.measured),
            predicted: limit.and_then(|limit| limit.predicted.as_ref()).map(|(value, _)| *value),
        }
    };
    Curves {
        title: String::new(),
        x: axis(&found.parameter),
        y: axis(&found.error),
        curves: found.curves.iter().map(curve).collect(),
    }
}
