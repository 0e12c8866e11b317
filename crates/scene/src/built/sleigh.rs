//! Sleighs in the words of their scenes.

use super::{Quantity, StartPlace};
use crate::systems::SceneSystem;
use ::sleigh::SleighState;

/// Where a sleigh is, how it moves, and where its centre of mass is (m).
type Seen = (SleighState, [f64; 2]);

/// A quantity of a sleigh.
#[derive(Debug, Clone, Copy)]
pub struct SleighQuantity {
    /// Its name.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    value: fn(&Seen) -> f64,
}

impl SleighQuantity {
    /// The value of the quantity for a sleigh in this state with this centre of mass (m).
    #[must_use]
    pub fn value(&self, state: SleighState, centre: [f64; 2]) -> f64 {
        (self.value)(&(state, centre))
    }

    /// Whether values that differ by a turn are the same.
    #[must_use]
    pub fn is_angle(&self) -> bool {
        self.name == "heading"
    }
}

/// Number of leading [`QUANTITIES`] that make up a state.
pub(super) const IN_STATE: usize = 5;

/// The quantities that every sleigh has.
pub const QUANTITIES: [SleighQuantity; 9] = [
    SleighQuantity { name: "x", unit: "m", value: |(at, _)| at.x },
    SleighQuantity { name: "y", unit: "m", value: |(at, _)| at.y },
    SleighQuantity { name: "heading", unit: "rad", value: |(at, _)| at.heading },
    SleighQuantity { name: "speed", unit: "m/s", value: |(at, _)| at.speed },
    SleighQuantity { name: "turn_rate", unit: "rad/s", value: |(at, _)| at.turn_rate },
    SleighQuantity { name: "center_x", unit: "m", value: |(_, [x, _])| *x },
    SleighQuantity { name: "center_y", unit: "m", value: |(_, [_, y])| *y },
    SleighQuantity { name: "along", unit: "m", value: |seen| turned(seen)[0] },
    SleighQuantity { name: "across", unit: "m", value: |seen| turned(seen)[1] },
];

/// The quantities of a rotor, with units.
const ROTOR: [(&str, &str); 2] = [("rotor_angle", "rad"), ("rotor_rate", "rad/s")];

/// The force of the blade, positive to the left: name and unit of its column.
const FORCE: (&str, &str) = ("constraint_force", "N");

/// The centre of mass in the body's axes: its components along the blade and across it, from the origin (m).
fn turned((at, [x, y]): &Seen) -> [f64; 2] {
    let (sin, cos) = at.heading.sin_cos();
    [x * cos + y * sin, y * cos - x * sin]
}

pub(super) fn quantities(system: &dyn SceneSystem) -> Vec<Quantity> {
    let of = |name: &str, unit: &str, angle| Quantity { name: name.to_owned(), unit: unit.to_owned(), angle };
    let own = QUANTITIES.iter().map(|known| of(known.name, known.unit, known.is_angle()));
    let rotor = system.rotor(&[], &[]).map_or(&[][..], |_| &ROTOR);
    own.chain(rotor.iter().chain([&FORCE]).map(|(name, unit)| of(name, unit, false))).collect()
}

/// The value of quantity `k` of a sleigh, its rotor or its blade; `None` beyond these.
pub(super) fn value(system: &dyn SceneSystem, k: usize, t: f64, q: &[f64], v: &[f64]) -> Option<f64> {
    if let Some(quantity) = QUANTITIES.get(k) {
        let centre = if k < IN_STATE { [0.0; 2] } else { system.centre(q) };
        return Some((quantity.value)(&(system.sleigh_state(q, v), centre)));
    }
    let rotor = system.rotor(q, v);
    let rotor = rotor.as_ref().map_or(&[][..], |rotor| rotor);
    let k = k - QUANTITIES.len();
    // The first constraint is that of the blade.
    let force = || system.scene_piece(t).mechanism().motion(t, q, v).ok()?[1].first().copied();
    rotor.get(k).copied().or_else(|| (k == rotor.len()).then(|| force().unwrap_or(f64::NAN)))
}

/// The larger of the distances in position (m) and in heading (rad).
pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    let [[ax, ay, a], [bx, by, b]] = [a, b].map(|q| std::array::from_fn(|i| q.get(i).copied().unwrap_or(0.0)));
    let (place, turn) = (f64::hypot(ax - bx, ay - by), (a - b).abs());
    if place > turn || place.is_nan() { place } else { turn }
}

pub(super) fn with(system: &dyn SceneSystem, (q, v): &StartPlace, k: usize, value: f64) -> Option<StartPlace> {
    let mut state = system.sleigh_state(q, v);
    let SleighState { x, y, heading, speed, turn_rate } = &mut state;
    **[x, y, heading, speed, turn_rate].get_mut(k)? = value;
    let (place, velocity) = state.to_coordinates();
    let with = |x: &[f64], first: &[f64]| [first, x.get(first.len()..).unwrap_or_default()].concat();
    let (q, v) = (with(q, &place), with(v, &velocity));
    let mechanism = system.mechanism();
    let xi = mechanism.quasi_velocities(0.0, &q, &v).ok()?;
    let v = mechanism.velocity_of(0.0, &q, &xi).ok()?;
    Some((q, v))
}
