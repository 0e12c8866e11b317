//! States of systems of text, in the words of their scenes.

use crate::table::number;
use crate::terminal;
use crate::trajectory_file::Columns;
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

/// A trajectory: time, coordinates, rates, energy, work, constraint, outputs.
pub(crate) fn columns<const N: usize, const M: usize>(
    system: &dyn TextMechanics<N, M>,
    nodes: &[dla::Node<N, M>],
) -> Columns {
    let model = system.model();
    let own = 2 * model.coordinates().len();
    let named = |name: &str, unit: &str| Column::new(name, unit);
    let mut header = vec![named("t", "s")];
    let states: Vec<_> = nodes.iter().map(|node| state(model, node.t, &node.q, &node.v)).collect();
    let names = states.first().cloned().unwrap_or_default();
    header.extend(names[..own.min(names.len())].iter().map(|(name, unit, _)| named(name, unit)));
    header.extend([named("energy", "J"), named("work", "J"), named("constraint", "")]);
    header.extend(names.iter().skip(own).map(|(name, unit, _)| named(name, unit)));
    let row = |(node, state): (&dla::Node<N, M>, &Vec<(String, String, f64)>)| {
        let mut row = vec![node.t];
        row.extend(state[..own].iter().map(|(.., x)| *x));
        row.extend([node.energy, node.work, node.constraint]);
        row.extend(state[own..].iter().map(|(.., x)| *x));
        row
    };
    Columns::new(header, nodes.iter().zip(&states).map(row).collect())
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
