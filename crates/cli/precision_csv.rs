//! The results of `noslip precision`, as CSV.

use crate::csv_text::quoted;
use crate::provenance::DescribedColumn;
use harness::precision::{Curve, PrecisionPoint, RungSetting, number};
use std::fmt::Write;

/// The columns, and the types of their fields.
const COLUMNS: [(&str, &str); 11] = [
    ("method", "string"),
    ("step [s]", "double"),
    ("tolerance", "double"),
    ("steps", "integer"),
    ("error [m or rad]", "double"),
    ("wall [s]", "double"),
    ("CPU [s]", "double"),
    ("spread", "double"),
    ("mark", "string"),
    ("pareto", "boolean"),
    ("source", "string"),
];

/// The columns, for the file of metadata.
pub(crate) fn described() -> impl Iterator<Item = DescribedColumn> {
    COLUMNS.iter().map(|(heading, datatype)| DescribedColumn::headed(heading, datatype))
}

/// The points, one on a line.
pub(crate) fn text(curves: &[Curve]) -> String {
    let mut text = COLUMNS.map(|(heading, _)| heading).join(",") + "\n";
    let some = |value: Option<f64>| value.map_or_else(String::new, number);
    for (_, point) in points(curves) {
        let [step, tolerance] = settings(point).map(some);
        let steps = point.steps.map_or_else(String::new, |steps| steps.to_string());
        let [error, wall, cpu, spread] = [point.error, point.wall_seconds, point.cpu_seconds, point.spread].map(some);
        let [method, mark, source] = [
            point.method.clone(),
            point.mark.as_ref().map_or_else(String::new, ToString::to_string),
            point.source.clone().unwrap_or_default(),
        ]
        .map(|text| quoted(&text));
        let pareto = point.pareto;
        let _ = writeln!(
            text,
            "{method},{step},{tolerance},{steps},{error},{wall},{cpu},{spread},{mark},{pareto},{source}"
        );
    }
    text
}

/// Step and tolerance, one of which a point has.
pub(crate) fn settings(point: &PrecisionPoint) -> [Option<f64>; 2] {
    match point.setting {
        Some(RungSetting::Step(step)) => [Some(step), None],
        Some(RungSetting::Tolerance(tolerance)) => [None, Some(tolerance)],
        None => [None, None],
    }
}

pub(crate) fn points(curves: &[Curve]) -> impl Iterator<Item = (&Curve, &PrecisionPoint)> {
    curves.iter().flat_map(|curve| curve.points.iter().map(move |point| (curve, point)))
}
