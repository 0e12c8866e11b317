//! The results of `noslip precision`: the same values as a table, as JSON and in the report.

use crate::format::quoted;
use crate::json::failure;
use crate::precision::Measurement;
use crate::provenance::{Provenance, headed};
use crate::table::{by_reason, indented, number, right_aligned};
use harness::precision::{Curve, LEVELS, Mark, PrecisionPoint, RungSetting, cheapest, seconds_to};
use report::{CostCurve, CostPoint, Numbers, Report, SceneReport, Table, file_stem};
use scene::AnyScene;
use serde_json::{Value, json};
use std::fmt::Write;

const POINTS: [&str; 8] = ["method", "step [s]", "tolerance", "steps", "error", "wall [s]", "CPU [s]", "spread"];
const METHODS: [&str; 8] = ["method", "order", "slope", "points", "to 1e-3 [s]", "to 1e-6", "to 1e-9", "to 1e-12"];

/// The meaning of the columns.
const INTRO: &str = "Each method runs with a ladder of steps, an adaptive method with a ladder of tolerances. \
    Error: distance of the end from the \
    reference, in metres or radians, whichever is larger. Wall, CPU: elapsed time and processor time of a whole run, medians \
        of batches of warm runs, with all methods in turn; spread: the interquartile range of the processor times \
        over their median. Pareto: no \
    other point is both faster and more exact. Plateau: the error is within ten times the error of the reference, or \
        no longer falls: \
        round-off. Slope: the exponent of the step (for an adaptive method of the tolerance) that the error follows, by least \
    squares over the longest row of points whose slopes from one to the next agree within a tenth, among errors from 0.01 down \
    to ten times the plateau; points: the number of points in that row. To 1e-3 ..: processor time to that error, \
        interpolated between the logarithms of two points.";

fn shown(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), number)
}

/// Step, tolerance, steps, error, times and spread of a point; `missing` stands for a number that the point does not have.
fn fields(point: &PrecisionPoint, missing: &str, number: fn(f64) -> String) -> [String; 7] {
    let shown = |value: Option<f64>| value.map_or_else(|| missing.to_owned(), number);
    let [step, tolerance] = match point.setting {
        Some(RungSetting::Step(step)) => [Some(step), None],
        Some(RungSetting::Tolerance(tolerance)) => [None, Some(tolerance)],
        None => [None, None],
    };
    let steps = point.steps.map_or_else(|| missing.to_owned(), |steps| steps.to_string());
    let [error, wall, cpu, spread] = [point.error, point.wall_seconds, point.cpu_seconds, point.spread].map(shown);
    [shown(step), shown(tolerance), steps, error, wall, cpu, spread]
}

/// A row of the table of points, and what follows it.
fn cells(curve: &Curve, point: &PrecisionPoint) -> (Vec<String>, String) {
    let cells = std::iter::once(curve.label()).chain(fields(point, "-", number)).collect();
    let mark = point.mark.as_ref().map(ToString::to_string);
    let notes: Vec<String> = point.pareto.then(|| "pareto".to_owned()).into_iter().chain(mark).collect();
    (cells, notes.join(", "))
}

/// A row of the table of methods, and what follows it.
fn summary(curve: &Curve) -> (Vec<String>, String) {
    let order = curve.order.map_or_else(|| "-".to_owned(), |order| order.to_string());
    let two = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.2}"));
    let slope = two(curve.slope.map(|slope| slope.value));
    let fitted = curve.slope.map_or_else(|| "-".to_owned(), |slope| slope.points.to_string());
    let times = LEVELS.map(|level| shown(seconds_to(&curve.points, level)));
    let cells = [curve.label(), order, slope, fitted].into_iter().chain(times).collect();
    let refused = curve.refusal.map(|reason| format!("refused: {reason}"));
    // A method none of whose runs reached the end has no numbers in its row.
    let failed = || match curve.points.last().map(|point| (point.error, &point.mark)) {
        Some((None, Some(mark))) if curve.points.iter().all(|point| point.error.is_none()) => Some(mark.to_string()),
        _ => None,
    };
    (cells, refused.or_else(failed).unwrap_or_default())
}

/// The best of each level, in words.
fn verdicts(curves: &[Curve]) -> String {
    let mut text = String::new();
    for level in cheapest(curves) {
        let (error, best, next) = (number(level.error), level.methods.first(), level.methods.get(1));
        let _ = match (best, next, level.factor()) {
            (Some((best, seconds)), Some((next, _)), Some(factor)) => {
                writeln!(text, "cheapest to {error}: {best}, {seconds:.1e} s; {next} takes {factor:.2} times as long")
            }
            (Some((best, seconds)), ..) => {
                writeln!(text, "cheapest to {error}: {best}, {seconds:.1e} s, and no other")
            }
            (None, ..) => writeln!(text, "no method reaches an error of {error}"),
        };
    }
    text
}

/// The reference of the errors, in words.
pub(crate) fn reference(measured: &Measurement) -> String {
    let known = &measured.reference;
    let (steps, error) = (known.steps, number(known.error));
    if known.closed {
        format!("closed form; gauss16 with {steps} steps ends {error} away")
    } else {
        let other = if known.by == "gauss16" { " and gauss14" } else { "" };
        format!("{} with {steps} steps, in error by at most {error}, from finer runs{other}", known.by)
    }
}

/// How times were taken, in words.
fn clock(measured: &Measurement) -> String {
    let clock = measured.clock;
    let time = if clock.thread { "processor time of the thread" } else { "elapsed time" };
    let place = if clock.pinned { "pinned to a core" } else { "not pinned to a core" };
    format!("{time}, {place}, {} rounds", clock.rounds)
}

/// The text for a terminal: the cheapest method at each error, a table of the methods, and, if the text may be `wide`, every point.
pub(crate) fn text(scene: &AnyScene, measured: &Measurement, wide: bool) -> String {
    let mut text = format!("{} ({}), {} s\n", scene.title(), scene.name(), number(measured.duration));
    text += &indented(&format!("reference: {}", reference(measured)));
    text += &format!("times: {}\n\n", clock(measured));
    text += &verdicts(&measured.curves);
    text.push('\n');
    if wide {
        text += &noted(&METHODS, measured.curves.iter().map(summary).collect());
        text.push('\n');
        text += &noted(&POINTS, points(&measured.curves).map(|(curve, point)| cells(curve, point)).collect());
        text.push('\n');
        return text;
    }
    let (mut rows, mut left) = (Vec::new(), Vec::new());
    for curve in &measured.curves {
        let (cells, note) = summary(curve);
        if note.is_empty() {
            let times = LEVELS.map(|level| {
                seconds_to(&curve.points, level).map_or_else(|| "-".to_owned(), |seconds| format!("{seconds:.1e}"))
            });
            rows.push([vec![cells[0].clone(), cells[2].clone()], times.to_vec()].concat());
        } else {
            left.push((curve.label(), note));
        }
    }
    text += &right_aligned(&["method", "slope", "to 1e-3 [s]", "to 1e-6", "to 1e-9", "to 1e-12"], &rows);
    text + &by_reason(&left)
}

/// A table with remarks after its rows.
fn noted(columns: &[&str], rows: Vec<(Vec<String>, String)>) -> String {
    let (cells, notes): (Vec<_>, Vec<_>) = rows.into_iter().unzip();
    let notes = std::iter::once(String::new()).chain(notes);
    let mut text = String::new();
    for (line, note) in right_aligned(columns, &cells).lines().zip(notes) {
        let _ = writeln!(text, "{}", format!("{line}  {note}").trim_end());
    }
    text
}

/// The object that `precision --json` prints.
pub(crate) fn json(scene: &AnyScene, measured: &Measurement) -> Value {
    let (known, curves) = (&measured.reference, &measured.curves);
    let cheapest: Vec<Value> = cheapest(curves)
        .iter()
        .map(|level| {
            let named = |entry: Option<&(String, f64)>| {
                entry.map(|(method, seconds)| json!({"method": method, "seconds": seconds}))
            };
            let (best, next) = (level.methods.first(), level.methods.get(1));
            json!({
                "error": level.error,
                "method": best.map(|(method, _)| method),
                "seconds": best.map(|(_, seconds)| seconds),
                "next": named(next),
                "factor": level.factor(),
            })
        })
        .collect();
    json!({
        "scene": scene.name(),
        "duration": measured.duration,
        "reference": {
            "kind": if known.closed { "closed form" } else { known.by },
            "steps": known.steps,
            "error": known.error,
            "text": reference(measured),
        },
        "clock": {
            "time": if measured.clock.thread { "cpu" } else { "wall" },
            "pinned": measured.clock.pinned,
            "rounds": measured.clock.rounds,
        },
        "points": points(curves).map(|(_, point)| json_point(point)).collect::<Vec<_>>(),
        "methods": curves.iter().map(json_method).collect::<Vec<_>>(),
        "cheapest": cheapest,
    })
}

fn json_point(point: &PrecisionPoint) -> Value {
    let mut object = json!({"method": point.method});
    match point.setting {
        Some(RungSetting::Step(step)) => object["step"] = json!(step),
        Some(RungSetting::Tolerance(tolerance)) => object["tolerance"] = json!(tolerance),
        None => object["step"] = Value::Null,
    }
    object["steps"] = json!(point.steps);
    object["error"] = json!(point.error);
    object["wall_seconds"] = json!(point.wall_seconds);
    object["cpu_seconds"] = json!(point.cpu_seconds);
    object["spread"] = json!(point.spread);
    object["pareto"] = json!(point.pareto);
    match &point.mark {
        Some(Mark::Plateau) => object["mark"] = json!("plateau"),
        Some(Mark::Failed(reason, run)) => {
            (object["mark"], object["failure"]) = (json!("failed"), json!(reason));
            // `failure` is a text here; `run` and `compare` have this object there.
            if let Some(run) = run {
                object["failed_at"] = failure(run);
            }
        }
        None => {}
    }
    if let Some(source) = &point.source {
        object["source"] = json!(source);
    }
    object
}

fn json_method(curve: &Curve) -> Value {
    let seconds: Vec<Value> =
        LEVELS.iter().map(|level| json!({"error": level, "seconds": seconds_to(&curve.points, *level)})).collect();
    let mut object = json!({
        "method": curve.method,
        "order": curve.order,
        "slope": curve.slope.map(|slope| slope.value),
        "slope_points": curve.slope.map_or(0, |slope| slope.points),
        "seconds_to": seconds,
    });
    if let Some(reason) = curve.refusal {
        (object["refused"], object["failure"]) = (json!(true), json!(reason));
    }
    if let Some(source) = &curve.source {
        object["source"] = json!(source);
    }
    object
}

/// The columns, and the types of their fields.
const FILE: [(&str, &str); 11] = [
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
pub(crate) fn described() -> Vec<Value> {
    FILE.iter().map(|(heading, datatype)| headed(heading, datatype)).collect()
}

/// The points, one on a line, with all digits.
pub(crate) fn csv(curves: &[Curve]) -> String {
    let mut text = FILE.map(|(heading, _)| heading).join(",") + "\n";
    for (_, point) in points(curves) {
        let mark = point.mark.as_ref().map_or_else(String::new, ToString::to_string);
        let source = point.source.as_deref().unwrap_or_default();
        let numbers = fields(point, "", harness::precision::number).join(",");
        let (method, mark, pareto) = (quoted(&point.method), quoted(&mark), point.pareto);
        let _ = writeln!(text, "{method},{numbers},{mark},{pareto},{}", quoted(source));
    }
    text
}

fn points(curves: &[Curve]) -> impl Iterator<Item = (&Curve, &PrecisionPoint)> {
    curves.iter().flat_map(|curve| curve.points.iter().map(move |point| (curve, point)))
}

/// The curve of a method in the diagrams.
fn drawn(curve: &Curve) -> CostCurve {
    let label = curve.label();
    let point = |point: &PrecisionPoint| {
        let [error, seconds] = point.measured()?;
        let step = match point.setting {
            Some(RungSetting::Step(step)) if step > 0.0 => Some(step),
            _ => None,
        };
        let numbers =
            [("error", point.error, ""), ("wall", point.wall_seconds, " s"), ("CPU", point.cpu_seconds, " s")];
        let numbers = numbers.into_iter().filter_map(|(name, x, unit)| Some(format!("{name} {}{unit}", number(x?))));
        let [setting, mark] = [point.setting.map(|x| x.to_string()), point.mark.as_ref().map(ToString::to_string)];
        let text: Vec<String> = [label.clone()].into_iter().chain(setting).chain(numbers).chain(mark).collect();
        let plateau = point.mark == Some(Mark::Plateau);
        Some(CostPoint { error, seconds, step, plateau, pareto: point.pareto, text: text.join(", ") })
    };
    CostCurve { points: curve.points.iter().filter_map(point).collect(), label }
}

/// The report.
pub(crate) fn report(scene: &AnyScene, measured: &Measurement, provenance: &Provenance) -> Report {
    let mut facts = measured.facts.clone();
    let duration = format!("{} s", number(measured.duration));
    for (name, value) in [("duration", duration), ("reference", reference(measured)), ("times", clock(measured))] {
        facts.push((name.to_owned(), value));
    }
    let table = |title: &str, columns: &[&str], rows: Vec<(Vec<String>, String)>| Table {
        title: title.to_owned(),
        columns: columns.iter().map(|column| (*column).to_owned()).chain([String::new()]).collect(),
        rows: rows
            .into_iter()
            .map(|(mut cells, note)| {
                cells.push(note);
                cells
            })
            .collect(),
    };
    let rows = points(&measured.curves).map(|(curve, point)| cells(curve, point)).collect();
    let file = format!("{}.csv", file_stem(scene.name()));
    let shown = SceneReport {
        name: scene.name().to_owned(),
        title: scene.title().to_owned(),
        facts,
        costs: Some(measured.curves.iter().map(drawn).collect()),
        numbers: vec![
            Numbers { ending: "csv", text: csv(&measured.curves) },
            Numbers { ending: "csv-metadata.json", text: provenance.document(&file, &described()) },
            Numbers { ending: "json", text: format!("{:#}\n", json(scene, measured)) },
        ],
        ..SceneReport::default()
    };
    Report {
        title: format!("noslip precision {}", scene.name()),
        intro: format!("{INTRO}\n\n{}", verdicts(&measured.curves)),
        scenes: vec![shown],
        tables: vec![
            table("Time to an error", &METHODS, measured.curves.iter().map(summary).collect()),
            table("Every point", &POINTS, rows),
        ],
        ..Report::default()
    }
}
