//! States of systems of text, in the words of their scenes.

use crate::table::number;
use crate::terminal;
use scene::{Column, Model, TextMechanics, TextScene};
use serde_json::{Map, Value, json};

/// What a state of a system of text is: coordinates, rates and outputs, each with its name, unit and value.
pub(crate) fn state(model: &Model, t: f64, q: &[f64], v: &[f64]) -> Vec<(String, String, f64)> {
    let coordinates = model.coordinates();
    let unit = |of: &scene::Coordinate| of.unit.name().to_owned();
    let rate_unit = |of: &scene::Coordinate| match of.unit.name() {
        "" => "1/s".to_owned(),
        unit => format!("{unit}/s"),
    };
    let places = coordinates.iter().zip(q).map(|(of, x)| (of.name.clone(), unit(of), *x));
    let rates = coordinates.iter().zip(v).map(|(of, x)| (format!("{}'", of.name), rate_unit(of), *x));
    let outputs = model.outputs().iter().zip(model.told(t, &q[..coordinates.len()], &v[..coordinates.len()]));
    places.chain(rates).chain(outputs.map(|(name, x)| (name.clone(), String::new(), x))).collect()
}

/// The state as `run --json` has it at the end.
pub(crate) fn json(model: &Model, t: f64, q: &[f64], v: &[f64]) -> Value {
    let mut end = Map::new();
    end.insert("t".to_owned(), json!(t));
    end.extend(state(model, t, q, v).into_iter().map(|(name, _, x)| (name, json!(x))));
    Value::Object(end)
}

/// The state, a line for each number.
pub(crate) fn lines(model: &Model, t: f64, q: &[f64], v: &[f64]) -> Vec<(String, String)> {
    let line = |(name, unit, x)| (name, format!("{} {unit}", number(x)).trim_end().to_owned());
    state(model, t, q, v).into_iter().map(line).collect()
}

/// The columns of a trajectory: time, coordinates, rates, energy, work, constraint, outputs.
pub(crate) fn columns<const N: usize, const M: usize>(
    system: &dyn TextMechanics<N, M>,
    t: f64,
    (q, v): (&[f64; N], &[f64; N]),
) -> Vec<Column> {
    let model = system.model();
    let names = state(model, t, q, v).into_iter().map(|(name, unit, _)| Column::new(name, unit));
    between(names.collect(), 2 * model.coordinates().len(), Column::new("t", "s"), || {
        [("energy", "J"), ("work", "J"), ("constraint", "")].map(|(name, unit)| Column::new(name, unit))
    })
}

/// The numbers of a node in these columns.
pub(crate) fn row<const N: usize, const M: usize>(
    system: &dyn TextMechanics<N, M>,
    node: &dla::Node<N, M>,
) -> Vec<f64> {
    let model = system.model();
    let numbers = state(model, node.t, &node.q, &node.v).into_iter().map(|(.., x)| x);
    between(numbers.collect(), 2 * model.coordinates().len(), node.t, || [node.energy, node.work, node.constraint])
}

/// The time, what is first of a state, what is told of the motion, and the rest of the state.
fn between<T>(mut state: Vec<T>, first: usize, time: T, told: impl Fn() -> [T; 3]) -> Vec<T> {
    let rest = state.split_off(first.min(state.len()));
    std::iter::once(time).chain(state).chain(told()).chain(rest).collect()
}

/// Says which numbers of the start the constraints do not admit.
pub(crate) fn note_moves(scene: &TextScene) {
    for moved in &scene.start.moved {
        let (from, to) = (number(moved.from), number(moved.to));
        terminal::say(
            "note",
            &format!("the constraints do not admit {} = {from} at the start; it is {to}", moved.name),
        );
    }
}
