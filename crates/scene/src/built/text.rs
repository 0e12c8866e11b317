//! Systems of text in the words of their scenes.

use super::{Quantity, StartPlace};
use crate::systems::Column;
use ::text::{Coordinate, TextMechanics, TextModel, Unit};
use dla::{Node, Size};

/// The quantities of a system of text: coordinates, rates and outputs.
#[must_use]
pub fn quantities(model: &TextModel) -> Vec<Quantity> {
    let coordinates = model.coordinates();
    let of = |name: String, unit: String, angle| Quantity { name, unit, angle };
    let place = |c: &Coordinate| of(c.name.clone(), c.unit.name().to_owned(), c.unit == Unit::Angle);
    let rate_unit = |c: &Coordinate| match c.unit.name() {
        "" => "1/s".to_owned(),
        unit => format!("{unit}/s"),
    };
    let rate = |c: &Coordinate| of(format!("{}'", c.name), rate_unit(c), false);
    let outputs = model.outputs().iter().zip(model.output_units());
    let outputs = outputs.map(|(name, unit)| of(name.clone(), unit.clone(), false));
    coordinates.iter().map(place).chain(coordinates.iter().map(rate)).chain(outputs).collect()
}

pub(super) fn in_state(model: &TextModel) -> usize {
    2 * model.coordinates().len() + model.outputs().len()
}

/// The multipliers of the constraints, which tell no state.
pub(super) fn multipliers(model: &TextModel) -> impl Iterator<Item = Quantity> {
    model.multiplier_names().iter().map(|name| Quantity { name: name.clone(), unit: String::new(), angle: false })
}

/// The value of quantity `k`: coordinates, then rates, outputs and multipliers; `None` beyond these.
pub(super) fn value(model: &TextModel, k: usize, t: f64, q: &[f64], v: &[f64]) -> Option<f64> {
    let n = model.coordinates().len();
    match k.checked_sub(n) {
        None => q.get(k).copied(),
        Some(k) if k < n => v.get(k).copied(),
        Some(k) => {
            let (k, q, v) = (k - n, q.get(..n)?, v.get(..n)?);
            let multiplier = k.checked_sub(model.outputs().len());
            multiplier.map_or_else(|| model.output(k, t, q, v), |k| model.multipliers(t, q, v).get(k).copied())
        }
    }
}

/// The values of all quantities, in their order.
pub(super) fn values(model: &TextModel, t: f64, q: &[f64], v: &[f64]) -> Vec<f64> {
    let n = model.coordinates().len();
    let (Some(q), Some(v)) = (q.get(..n), v.get(..n)) else { return Vec::new() };
    q.iter().chain(v).copied().chain(model.told(t, q, v)).collect()
}

/// Time, coordinates, rates, energy, work, constraint, outputs.
pub(super) fn columns(model: &TextModel) -> Vec<Column> {
    let names = quantities(model).into_iter().map(|quantity| Column::new(quantity.name, quantity.unit));
    between(names.collect(), 2 * model.coordinates().len(), Column::new("t", "s"), || {
        [("energy", "J"), ("work", "J"), ("constraint", "")].map(|(name, unit)| Column::new(name, unit))
    })
}

/// The numbers of a node in these columns.
pub(super) fn row(model: &TextModel, node: &Node) -> Vec<f64> {
    let numbers = values(model, node.t, &node.q, &node.v);
    let first = 2 * model.coordinates().len();
    between(numbers, first, node.t, || [node.energy, node.work, node.constraint])
}

/// The time, the first `first` numbers of a state, the three numbers of `told`, and the rest of the state.
fn between<T>(mut state: Vec<T>, first: usize, time: T, told: impl Fn() -> [T; 3]) -> Vec<T> {
    let rest = state.split_off(first.min(state.len()));
    std::iter::once(time).chain(state).chain(told()).chain(rest).collect()
}

/// The start with quantity `k` set to `value`. A changed coordinate keeps the quasi-velocities; a changed rate moves the other rates as
/// little as the constraints admit. Returns `None` if the constraints do not admit the value.
pub(super) fn with(system: &TextMechanics, (q, v): &StartPlace, k: usize, value: f64) -> Option<StartPlace> {
    let (model, mechanism) = (system.model(), system.mechanism());
    let Size { n: all, .. } = mechanism.size();
    let n = model.coordinates().len();
    if k >= n {
        return Some((q.clone(), filled(model.with_rate(q.get(..n)?, v.get(..n)?, k - n, value)?, all)));
    }
    let xi = mechanism.quasi_velocities(0.0, q, v).ok()?;
    let mut q = q.clone();
    *q.get_mut(k)? = value;
    let v = mechanism.velocity_of(0.0, &q, &xi).ok()?;
    // Constraints on positions may ask for another place.
    let given = |x: &[f64]| -> Vec<Option<f64>> { x.iter().take(n).copied().map(Some).collect() };
    let start = model.start(&given(&q), &given(&v)).ok()?;
    let off = (start.q.get(k)? - value).abs();
    off.le(&(1e-9 * value.abs().max(1.0))).then(|| (filled(start.q, all), filled(start.v, all)))
}

/// The numbers of a start, with zeros for the coordinates that pad the system to its shape.
pub(super) fn filled(mut x: Vec<f64>, all: usize) -> Vec<f64> {
    x.resize(all, 0.0);
    x
}
