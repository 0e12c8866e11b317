use crate::coordinate::{Coordinate, name_and_value, names};
use crate::error::CliError;
use crate::table::number;
use dla::{Close, Event};
use harness::SavedCrossing;
use scene::Built;
use serde_json::{Value, json};
use std::str::FromStr;

/// A quantity by its name, and a value that it is to cross.
#[derive(Debug, Clone)]
pub(crate) struct Trigger {
    /// The text as the user wrote it.
    pub(crate) text: String,
    name: String,
    value: f64,
    /// True for a rising crossing, false for a falling one, `None` for both.
    rising: Option<bool>,
}

/// Prefix to the name of an angle; with it whole turns count.
const UNWRAPPED: &str = "unwrapped_";

impl FromStr for Trigger {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let accepted =
            "accepted is NAME=VALUE, for example speed=0, with :rising or :falling after it for one direction";
        let (quantity, rising) = match text.rsplit_once(':') {
            None => (text, None),
            Some((quantity, "rising")) => (quantity, Some(true)),
            Some((quantity, "falling")) => (quantity, Some(false)),
            Some((_, other)) => return Err(format!("`{}` is not a direction; {accepted}", other.escape_debug())),
        };
        let (name, value) = name_and_value(quantity, accepted)?;
        Ok(Self { text: text.to_owned(), name, value, rising })
    }
}

/// A trigger with the quantity that it names in a system, and a function that is zero at the crossing.
#[derive(Debug)]
pub(crate) struct WatchedTrigger<'a> {
    trigger: &'a Trigger,
    quantity: Coordinate,
    /// Whether values a turn apart are the same.
    turns: bool,
}

impl Trigger {
    /// Finds the quantity of a system that the trigger names. The prefix that counts turns applies to angles only.
    ///
    /// # Errors
    /// [`CliError::Request`] if the system has no such quantity.
    pub(crate) fn on(&self, system: &Built<'_>) -> Result<WatchedTrigger<'_>, CliError> {
        let find = |name: &str| Coordinate::of(system, name).ok();
        let unwrapped = || find(self.name.strip_prefix(UNWRAPPED)?).filter(|found| found.quantity.angle);
        let plain = find(&self.name).map(|found| (found.quantity.angle, found));
        let Some((turns, quantity)) = plain.or_else(|| unwrapped().map(|found| (false, found))) else {
            let known = system.quantities();
            let angle = known.iter().find(|quantity| quantity.angle);
            let turns = angle.map_or_else(String::new, |of| format!(", {UNWRAPPED}{}", of.name));
            let first = known.first().map_or_else(|| "x".to_owned(), |first| first.name.clone());
            return Err(CliError::Request(format!(
                "--event, --until: the scene has no quantity `{}`; accepted are {}{turns} with a value, for example \
                    {first}={:?}",
                self.name,
                names(known),
                self.value,
            )));
        };
        Ok(WatchedTrigger { trigger: self, quantity, turns })
    }
}

impl WatchedTrigger<'_> {
    /// The text as the user wrote it.
    pub(crate) fn text(&self) -> &str {
        &self.trigger.text
    }

    /// The distance from the value; of an angle, the sine of half of it, which has one zero in a turn (the sine of the whole distance has
    /// two), and whose sign changes from turn to turn.
    fn value(&self, system: &Built<'_>, t: f64, q: &[f64], v: &[f64]) -> f64 {
        let off = self.quantity.value(system, t, q, v) - self.trigger.value;
        if self.turns { (0.5 * off).sin() } else { off }
    }

    /// Whether the quantity rises, given whether the function does.
    fn rises(&self, system: &Built<'_>, t: f64, (q, v): (&[f64], &[f64]), function_rises: bool) -> bool {
        let off = || self.quantity.value(system, t, q, v) - self.trigger.value;
        if self.turns { function_rises == ((0.5 * off()).cos() > 0.0) } else { function_rises }
    }

    /// The event in a system.
    pub(crate) fn event<'a>(&'a self, system: &'a Built<'a>) -> Event<'a> {
        let event = Event::new(self.trigger.text.clone(), |t, q: &[f64], v: &[f64]| self.value(system, t, q, v));
        let Some(wanted) = self.trigger.rising else { return event };
        event.where_true(move |t, q, v, rising| self.rises(system, t, (q, v), rising) == wanted)
    }
}

/// The events of a run, for a program and for a person.
pub(crate) struct Events {
    values: Vec<Value>,
    pub(crate) told: Vec<(String, String)>,
    close: Option<Close>,
}

impl Events {
    /// The crossings of a run of a system, in the words of its scene.
    pub(crate) fn of(
        system: &Built<'_>,
        watched: &[WatchedTrigger<'_>],
        crossings: &[SavedCrossing],
        close: Option<Close>,
    ) -> Self {
        let (mut values, mut told) = (Vec::new(), Vec::new());
        for SavedCrossing { event, t, within, spacing, rising, q, v, .. } in crossings {
            let Some(watched) = watched.get(*event) else { continue };
            let (text, rising) = (watched.text(), watched.rises(system, *t, (q, v), *rising));
            let how = if rising { "rising" } else { "falling" };
            told.push(("event".to_owned(), format!("{text}, {how}, at t = {} s", number(*t))));
            let mut value = json!({"event": text, "t": t, "within": within, "spacing": spacing, "rising": rising});
            for (quantity, number) in system.state(*t, q, v) {
                value[quantity.name] = json!(number);
            }
            values.push(value);
        }
        Self { values, told, close }
    }

    /// Adds the events to the object of `run --json`.
    pub(crate) fn add_to(&self, object: &mut Value) {
        object["events"] = json!(self.values);
        object["events_in_doubt"] = json!(self.close.map_or(0, doubts));
    }

    /// Warns if events may have been missed.
    pub(crate) fn warn(&self) {
        if let Some(close) = self.close {
            let advice = "--event-samples N and a shorter --step sample more times";
            crate::terminal::say("warning", &format!("{}; {advice}", in_doubt(&close)));
        }
    }
}

/// The number of reasons to doubt that all crossings were found.
pub(crate) fn doubts(Close { count, incomplete, .. }: Close) -> u64 {
    count + incomplete
}

/// The message that crossings may have been missed, with the reasons.
pub(crate) fn in_doubt(Close { count, spacing, nearest, incomplete }: &Close) -> String {
    let mut reasons = Vec::new();
    if *count > 0 {
        let (follow, as_little) =
            if *count == 1 { ("crossing follows", "only") } else { ("crossings follow", "as little as") };
        reasons.push(format!(
            "{count} {follow} another by {as_little} {nearest:.2e} s, and samples are up to {spacing:.2e} s apart"
        ));
    }
    if *incomplete > 0 {
        let steps = if *incomplete == 1 { "step" } else { "steps" };
        reasons.push(format!(
            "in {incomplete} {steps} a quantity has no value at a sample, or changes more quickly than any samples show"
        ));
    }
    format!("{}, so other crossings may have been missed", reasons.join("; "))
}
