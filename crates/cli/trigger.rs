use dla::{Crossing, Event};
use scene::SceneSystem;
use serde_json::{Value, json};
use sleigh::SleighState;
use std::str::FromStr;

/// A quantity of the sleigh that is to cross a value.
#[derive(Debug, Clone)]
pub(crate) struct Trigger {
    /// As it was written.
    text: String,
    quantity: Quantity,
    value: f64,
}

type Quantity = fn(&SleighState) -> f64;

const QUANTITIES: [(&str, Quantity); 5] = [
    ("x", |state| state.x),
    ("y", |state| state.y),
    ("heading", |state| state.heading),
    ("speed", |state| state.speed),
    ("turn_rate", |state| state.turn_rate),
];

impl FromStr for Trigger {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let accepted = "accepted are x, y, heading, speed or turn_rate with a value, as in speed=0";
        let (name, value) = text.split_once('=').ok_or(accepted)?;
        let found = QUANTITIES.iter().find(|(known, _)| *known == name.trim());
        let (_, quantity) = found.ok_or_else(|| format!("no quantity `{}`; {accepted}", name.trim()))?;
        let number = value.trim().parse().ok().filter(|value: &f64| value.is_finite());
        let value = number.ok_or_else(|| format!("`{}` is not a number; {accepted}", value.trim()))?;
        Ok(Self { text: text.to_owned(), quantity: *quantity, value })
    }
}

impl Trigger {
    /// The event in a system.
    pub(crate) fn event<'a, Sys, const N: usize, const M: usize>(&'a self, system: &'a Sys) -> Event<'a, N>
    where
        Sys: SceneSystem<N, M>,
    {
        Event::new(self.text.clone(), move |_, state| {
            (self.quantity)(&system.sleigh_state(&state.unwrapped(), state.v())) - self.value
        })
    }
}

/// An event in the words of a scene, for `run --json`.
pub(crate) fn json<Sys, const N: usize, const M: usize>(
    system: &Sys,
    events: &[Event<'_, N>],
    crossing: &Crossing<N>,
) -> Value
where
    Sys: SceneSystem<N, M>,
{
    let state = system.sleigh_state(&crossing.state.unwrapped(), crossing.state.v());
    json!({
        "event": events.get(crossing.event).map(|event| &event.name),
        "t": crossing.t,
        "within": crossing.within,
        "rising": crossing.rising,
        "x": state.x,
        "y": state.y,
        "heading": state.heading,
        "speed": state.speed,
        "turn_rate": state.turn_rate,
    })
}

/// The same, for a person.
pub(crate) fn told<const N: usize>(events: &[Event<'_, N>], crossing: &Crossing<N>) -> String {
    let name = events.get(crossing.event).map_or("", |event| &event.name);
    let how = if crossing.rising { "rising" } else { "falling" };
    format!("event      {name}, {how}, at t = {} s\n", crate::table::number(crossing.t))
}
