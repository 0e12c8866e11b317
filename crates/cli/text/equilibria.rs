use super::told;
use crate::args::EquilibriaArguments;
use crate::error::CliError;
use crate::steady::{self, Stability};
use crate::table::number;
use crate::terminal;
use dla::{Schedule, State};
use harness::analysis::{DiscreteMap, EquilibriumError, differentiable, relative_equilibria};
use harness::{Method, integrate_pieces};
use scene::{StartedText, TextScene, with_text};
use serde_json::{Value, json};

/// A relative equilibrium: its rates by their names, and the coordinates on which the equations depend, with their values.
struct Row {
    rates: Vec<(String, f64)>,
    depends_on: Vec<(String, f64)>,
    stability: Stability,
}

/// `noslip equilibria` of a system of text.
pub(crate) fn equilibria(arguments: &EquilibriaArguments, scene: &TextScene) -> Result<(), CliError> {
    let method = Method::named(&scene.run.method, scene.run.alpha)?;
    if arguments.picture.is_some() {
        let problem = "--picture draws speed against turn rate of a sleigh, which a system of text does not have";
        return Err(CliError::Request(problem.to_owned()));
    }
    told::note_moves(scene);
    let rows = with_text!(super::system(scene)?, started => found(scene, &method, &started))?;
    if arguments.scene.json {
        terminal::print_json(&object(scene, &method, &rows))
    } else {
        terminal::print(&text(scene, &method, &rows))
    }
}

fn found<const N: usize, const M: usize>(
    scene: &TextScene,
    method: &Method,
    StartedText { system, q, v }: &StartedText<N, M>,
) -> Result<Vec<Row>, CliError> {
    let system = &**system;
    let Some(steps) = differentiable::<N, M>(method) else {
        return Err(CliError::NotDifferentiated { method: method.info().name });
    };
    let coordinates = scene.model.coordinates();
    let (n, m) = (coordinates.len(), scene.model.constraints());
    if n == m {
        return Err(EquilibriumError::NothingFree.into());
    }
    let equilibria = relative_equilibria(system, q, v)?;
    let mut step = |step: f64, start: &State<N>| {
        let (mut end, schedule) = (*start, Schedule { t0: 0.0, step, steps: 1 });
        integrate_pieces(system, method, &schedule, &mut end, &mut ()).ok().map(|_| end)
    };
    let mut map = DiscreteMap::new(system, &*steps, &mut step);
    let h = scene.run.actual_step();
    // Coordinates that fill up the shape, and that no constraint holds, go on at any rate: eigenvalues of theirs are no news.
    let filling = (N - M) - (n - m);
    let mut row = |e: &harness::analysis::Equilibrium<N>| Row {
        rates: coordinates.iter().zip(e.v).map(|(of, rate)| (format!("{}'", of.name), rate)).collect(),
        depends_on: e.shape.iter().filter_map(|&i| Some((coordinates.get(i)?.name.clone(), e.q[i]))).collect(),
        stability: Stability {
            family: e.family.saturating_sub(filling),
            stable: e.stable,
            map: map.spectrum(h, e).map(|values| without(values, [1.0, 0.0], filling)),
            limit: e.stable.then(|| map.limit(h, e)),
            flow: without(e.flow.clone(), [0.0, 0.0], filling),
        },
    };
    // Those that differ only in what fills up the shape are one.
    let own = |e: &harness::analysis::Equilibrium<N>| e.v[..n].iter().chain(&e.q[..n]).copied().collect::<Vec<_>>();
    let same =
        |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-8 * (1.0 + a.abs().max(b.abs())));
    let mut seen: Vec<Vec<f64>> = Vec::new();
    let mut rows = Vec::new();
    for e in &equilibria {
        let numbers = own(e);
        if !seen.iter().any(|other| same(other, &numbers)) {
            rows.push(row(e));
            seen.push(numbers);
        }
    }
    Ok(rows)
}

/// The eigenvalues without so many that are nearest to a known one.
fn without(mut values: Vec<[f64; 2]>, known: [f64; 2], count: usize) -> Vec<[f64; 2]> {
    for _ in 0..count.min(values.len()) {
        let far = |[re, im]: &[f64; 2]| f64::hypot(re - known[0], im - known[1]);
        let nearest = values.iter().enumerate().min_by(|(_, a), (_, b)| far(a).total_cmp(&far(b)));
        if let Some((k, _)) = nearest {
            values.remove(k);
        }
    }
    values
}

fn object(scene: &TextScene, method: &Method, rows: &[Row]) -> Value {
    let numbers =
        |of: &[(String, f64)]| -> Value { of.iter().map(|(name, value)| (name.clone(), json!(value))).collect() };
    let motion = |row: &Row| {
        let fields = [("rates", numbers(&row.rates)), ("depends_on", numbers(&row.depends_on))];
        row.stability.object(fields.into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
    };
    steady::object(&scene.name, method, scene.run.actual_step(), rows.iter().map(motion))
}

fn text(scene: &TextScene, method: &Method, rows: &[Row]) -> String {
    let numbers = |of: &[(String, f64)]| {
        of.iter().map(|(name, value)| format!("{name} = {}", number(*value))).collect::<Vec<_>>().join(", ")
    };
    let motion = |row: &Row| {
        let place = if row.depends_on.is_empty() { "any".to_owned() } else { numbers(&row.depends_on) };
        row.stability.lines(vec![("motion", numbers(&row.rates)), ("place", place)])
    };
    let heading = steady::heading((&scene.title, &scene.name), method, scene.run.actual_step());
    std::iter::once(heading).chain(rows.iter().map(motion)).collect()
}
