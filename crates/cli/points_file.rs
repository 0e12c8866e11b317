use crate::error::CliError;
use crate::files::read_text;
use harness::precision::{Curve, Mark, PrecisionPoint, RungSetting};
use serde_json::Value;
use std::path::Path;

/// The largest file of points that is read (bytes).
const LARGEST: u64 = 1 << 26;

/// The points of another program, in the shape that `precision --json` prints, as curves: one for each method.
pub(crate) fn read(path: &Path, scene: &str) -> Result<(Vec<Curve>, Vec<String>), CliError> {
    let refused = |problem: String| CliError::Points { path: path.to_owned(), problem };
    let text = read_text(path, LARGEST).map_err(|error| refused(error.to_string()))?;
    let file: Value = serde_json::from_str(&text).map_err(|error| refused(error.to_string()))?;
    let points =
        file.get("points").and_then(Value::as_array).ok_or_else(|| refused("the file has no points".into()))?;
    let stem = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let source = file.get("program").and_then(Value::as_str).map_or(stem, str::to_owned);
    let mut methods: Vec<(String, Vec<PrecisionPoint>)> = Vec::new();
    for (k, entry) in points.iter().enumerate() {
        let point = point(entry, &source).map_err(|problem| refused(format!("points[{k}]: {problem}")))?;
        match methods.iter_mut().find(|(method, _)| *method == point.method) {
            Some((_, points)) => points.push(point),
            None => methods.push((point.method.clone(), vec![point])),
        }
    }
    let mut warnings = Vec::new();
    if let Some(other) = file.get("scene").and_then(Value::as_str)
        && other.replace('_', "-") != scene
    {
        warnings.push(format!("{}: the points belong to the scene {other:?}, not to {scene:?}", path.display()));
    }
    let curve = |(method, mut points): (String, Vec<PrecisionPoint>)| {
        // From coarse to fine, which takes longer.
        points.sort_by(|a, b| f64::total_cmp(&a.seconds().unwrap_or(0.0), &b.seconds().unwrap_or(0.0)));
        Curve::new(method, Some(source.clone()), None, points)
    };
    Ok((methods.into_iter().map(curve).collect(), warnings))
}

fn point(entry: &Value, source: &str) -> Result<PrecisionPoint, String> {
    let method = entry.get("method").and_then(Value::as_str).filter(|method| !method.trim().is_empty());
    let (step, tolerance) = (number(entry, "step")?, number(entry, "tolerance")?);
    let setting = step.map(RungSetting::Step).or(tolerance.map(RungSetting::Tolerance));
    let steps = match entry.get("steps") {
        None | Some(Value::Null) => None,
        Some(steps) => Some(steps.as_u64().ok_or("`steps` is not a whole number")?),
    };
    let failure = entry.get("failure").and_then(Value::as_str).map(|reason| Mark::Failed(reason.to_owned(), None));
    let plateau = entry.get("mark").and_then(Value::as_str).filter(|mark| *mark == "plateau").map(|_| Mark::Plateau);
    Ok(PrecisionPoint {
        method: method.ok_or("`method` is not a name")?.to_owned(),
        source: Some(source.to_owned()),
        setting,
        steps,
        error: number(entry, "error")?,
        wall_seconds: number(entry, "wall_seconds")?,
        cpu_seconds: number(entry, "cpu_seconds")?,
        spread: number(entry, "spread")?,
        mark: failure.or(plateau),
        pareto: false,
    })
}

/// A number that is not negative, or nothing.
fn number(entry: &Value, key: &str) -> Result<Option<f64>, String> {
    match entry.get(key) {
        None | Some(Value::Null) => Ok(None),
        Some(value) => match value.as_f64().filter(|number| *number >= 0.0) {
            Some(number) => Ok(Some(number)),
            None => Err(format!("`{key}` must be a number of 0 or more, and is {value}")),
        },
    }
}
