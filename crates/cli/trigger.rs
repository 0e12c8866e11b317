use assembly::parts::Train;
use dla::{Crossing, Event};
use harness::{AssemblyCrossing, AssemblyEvent};
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

impl Trigger {
    /// The event of the first blade of a train.
    pub(crate) fn of_train<'a>(&'a self, train: &'a Train, terminal: bool) -> AssemblyEvent<'a> {
        AssemblyEvent::new(self.text.clone(), terminal, move |_, state| {
            (self.quantity)(&train.blade(state, 0)) - self.value
        })
    }
}

/// An event that happened, the number of coordinates forgotten.
pub(crate) struct Happened<'a> {
    name: &'a str,
    t: f64,
    within: f64,
    rising: bool,
    state: SleighState,
}

impl<'a> Happened<'a> {
    /// In a system.
    pub(crate) fn of<Sys, const N: usize, const M: usize>(
        system: &Sys,
        events: &'a [Event<'_, N>],
        crossing: &Crossing<N>,
    ) -> Self
    where
        Sys: SceneSystem<N, M>,
    {
        let Crossing { event, t, within, rising, ref state, .. } = *crossing;
        let name = events.get(event).map_or("", |event| &event.name);
        Self { name, t, within, rising, state: system.sleigh_state(&state.unwrapped(), state.v()) }
    }

    /// Of the first blade of a train.
    pub(crate) fn of_train(train: &Train, events: &'a [AssemblyEvent<'_>], crossing: &AssemblyCrossing) -> Self {
        let AssemblyCrossing { event, t, within, rising, ref state, .. } = *crossing;
        let name = events.get(event).map_or("", |event| &event.name);
        Self { name, t, within, rising, state: train.blade(state, 0) }
    }

    /// In the words of a scene, for `run --json`.
    pub(crate) fn json(&self) -> Value {
        let Self { name, t, within, rising, state } = self;
        json!({
            "event": name,
            "t": t,
            "within": within,
            "rising": rising,
            "x": state.x,
            "y": state.y,
            "heading": state.heading,
            "speed": state.speed,
            "turn_rate": state.turn_rate,
        })
    }

    /// For a person.
    pub(crate) fn told(&self) -> String {
        let how = if self.rising { "rising" } else { "falling" };
        format!("event      {}, {how}, at t = {} s\n", self.name, crate::table::number(self.t))
    }
}
