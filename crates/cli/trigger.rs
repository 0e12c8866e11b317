use assembly::parts::Train;
use dla::{Close, Crossing, Event};
use harness::{AssemblyCrossing, AssemblyEvent};
use scene::SceneSystem;
use serde_json::{Value, json};
use sleigh::SleighState;
use std::str::FromStr;

/// A quantity of the sleigh that is to cross a value.
#[derive(Debug, Clone)]
pub(crate) struct Trigger {
    /// As it was written.
    pub(crate) text: String,
    quantity: Quantity,
    value: f64,
}

#[derive(Debug, Clone, Copy)]
enum Quantity {
    Number(fn(&SleighState) -> f64),
    /// The heading, whose values a turn apart are the same.
    Heading,
}

const QUANTITIES: [(&str, Quantity); 6] = [
    ("x", Quantity::Number(|state| state.x)),
    ("y", Quantity::Number(|state| state.y)),
    ("heading", Quantity::Heading),
    ("unwrapped_heading", Quantity::Number(|state| state.heading)),
    ("speed", Quantity::Number(|state| state.speed)),
    ("turn_rate", Quantity::Number(|state| state.turn_rate)),
];

impl FromStr for Trigger {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let accepted = "accepted are x, y, heading, unwrapped_heading, speed or turn_rate with a value, as in speed=0";
        let (name, value) = text.split_once('=').ok_or(accepted)?;
        let found = QUANTITIES.iter().find(|(known, _)| *known == name.trim());
        let (_, quantity) = found.ok_or_else(|| format!("no quantity `{}`; {accepted}", name.trim()))?;
        let number = value.trim().parse().ok().filter(|value: &f64| value.is_finite());
        let value = number.ok_or_else(|| format!("`{}` is not a number; {accepted}", value.trim()))?;
        Ok(Self { text: text.to_owned(), quantity: *quantity, value })
    }
}

impl Trigger {
    /// The function that is zero where the quantity has the value. Of an angle it is the sine of half of what is missing: it has no
    /// other zero in a turn, where that of the whole has one half a turn away, and it has the other sign in the next turn.
    fn value(&self, state: &SleighState) -> f64 {
        match self.quantity {
            Quantity::Number(of) => of(state) - self.value,
            Quantity::Heading => (0.5 * (state.heading - self.value)).sin(),
        }
    }

    /// Whether the quantity rises where the function does, or falls.
    fn rises(&self, state: &SleighState, function_rises: bool) -> bool {
        match self.quantity {
            Quantity::Number(_) => function_rises,
            Quantity::Heading => function_rises == ((0.5 * (state.heading - self.value)).cos() > 0.0),
        }
    }

    /// The event in a system.
    pub(crate) fn event<'a, const N: usize, const M: usize>(
        &'a self,
        system: &'a dyn SceneSystem<N, M>,
    ) -> Event<'a, N> {
        Event::new(self.text.clone(), move |_, state| self.value(&system.sleigh_state(&state.unwrapped(), state.v())))
    }

    /// The event of the first blade of a train.
    pub(crate) fn of_train<'a>(&'a self, train: &'a Train, terminal: bool) -> AssemblyEvent<'a> {
        AssemblyEvent::new(self.text.clone(), terminal, move |_, state| self.value(&train.blade(state, 0)))
    }
}

/// An event that happened, the number of coordinates forgotten.
pub(crate) struct Happened<'a> {
    name: &'a str,
    t: f64,
    within: f64,
    spacing: f64,
    rising: bool,
    state: SleighState,
}

impl<'a> Happened<'a> {
    /// In a system.
    pub(crate) fn of<const N: usize, const M: usize>(
        system: &dyn SceneSystem<N, M>,
        triggers: &[&'a Trigger],
        crossing: &Crossing<N>,
    ) -> Option<Self> {
        let Crossing { event, t, within, spacing, rising, ref state, .. } = *crossing;
        let state = system.sleigh_state(&state.unwrapped(), state.v());
        triggers.get(event).map(|trigger| Self::new(trigger, [t, within, spacing], rising, state))
    }

    /// Of the first blade of a train.
    pub(crate) fn of_train(train: &Train, triggers: &[&'a Trigger], crossing: &AssemblyCrossing) -> Option<Self> {
        let AssemblyCrossing { event, t, within, spacing, rising, ref state, .. } = *crossing;
        let state = train.blade(state, 0);
        triggers.get(event).map(|trigger| Self::new(trigger, [t, within, spacing], rising, state))
    }

    fn new(trigger: &'a Trigger, [t, within, spacing]: [f64; 3], rising: bool, state: SleighState) -> Self {
        let rising = trigger.rises(&state, rising);
        Self { name: &trigger.text, t, within, spacing, rising, state }
    }

    /// In the words of a scene, for `run --json`.
    pub(crate) fn json(&self) -> Value {
        let Self { name, t, within, spacing, rising, state } = self;
        json!({
            "event": name,
            "t": t,
            "within": within,
            "spacing": spacing,
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

/// What happened, for a program and for a person.
pub(crate) struct Events {
    values: Vec<Value>,
    pub(crate) told: String,
    close: Option<Close>,
}

impl Events {
    pub(crate) fn new<'a>(happened: impl Iterator<Item = Happened<'a>>, close: Option<Close>) -> Self {
        let (values, told): (Vec<Value>, Vec<String>) = happened.map(|event| (event.json(), event.told())).unzip();
        Self { values, told: told.concat(), close }
    }

    /// Adds them to what `run --json` prints.
    pub(crate) fn add_to(&self, object: &mut Value) {
        object["events"] = json!(self.values);
        object["events_in_doubt"] = json!(self.close.map_or(0, |close| close.count));
    }

    /// Says where events may have been missed.
    pub(crate) fn warn(&self) {
        if let Some(close) = self.close {
            let advice = "--event-samples N looks at more places, a shorter --step too";
            crate::terminal::say("warning", &format!("{}; {advice}", in_doubt(&close)));
        }
    }
}

/// That crossings may have been missed, and why.
pub(crate) fn in_doubt(Close { count, spacing }: &Close) -> String {
    let follow = if *count == 1 { "crossing follows" } else { "crossings follow" };
    format!(
        "{count} {follow} another so closely, beside the {spacing:.2e} s between the places of a step that were looked at, that others may \
         have been missed"
    )
}
