use scene::{Built, Quantity};
use std::f64::consts::{PI, TAU};
use std::fmt;
use std::str::FromStr;

/// A quantity of a system, found by its name: for planes, axes and events.
#[derive(Debug, Clone)]
pub(crate) struct Coordinate {
    /// Its place in the list of the system's quantities.
    k: usize,
    pub(crate) quantity: Quantity,
}

impl Coordinate {
    /// The quantity of a system with the name `name`.
    ///
    /// # Errors
    /// The message about a wrong name, with the names that there are.
    pub(crate) fn of(system: &Built<'_>, name: &str) -> Result<Self, String> {
        let mut quantities = system.quantities();
        match system.named(name.trim()) {
            Some(k) => Ok(Self { k, quantity: quantities.swap_remove(k) }),
            None => Err(format!("the scene has no quantity `{}`; accepted are {}", name.trim(), names(quantities))),
        }
    }

    /// Its value at a state, as it is: an angle with its turns.
    pub(crate) fn value(&self, system: &Built<'_>, t: f64, q: &[f64], v: &[f64]) -> f64 {
        system.value(self.k, t, q, v)
    }

    /// The value, with an angle within half a turn of zero.
    pub(crate) fn shown(&self, system: &Built<'_>, t: f64, q: &[f64], v: &[f64]) -> f64 {
        let value = self.value(system, t, q, v);
        if self.quantity.angle { within_a_turn(value) } else { value }
    }
}

/// The names of quantities, for a message.
pub(crate) fn names(quantities: Vec<Quantity>) -> String {
    quantities.into_iter().map(|quantity| quantity.name).collect::<Vec<_>>().join(", ")
}

/// The angle within half a turn of zero.
fn within_a_turn(angle: f64) -> f64 {
    let within = angle - TAU * (angle / TAU).round();
    if within <= -PI { within + TAU } else { within }
}

/// A name and a number, as in `speed=0`.
pub(crate) fn name_and_value(text: &str, accepted: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or(accepted)?;
    let number = value.trim().parse().ok().filter(|value: &f64| value.is_finite());
    let value = number.ok_or_else(|| format!("`{}` is not a number; {accepted}", value.trim()))?;
    Ok((name.trim().to_owned(), value))
}

/// A range of starts: a quantity by its name, the two ends, and the number of cells.
#[derive(Debug, Clone)]
pub(crate) struct Range {
    pub(crate) name: String,
    pub(crate) ends: [f64; 2],
    pub(crate) cells: usize,
}

impl Range {
    /// The middle of a cell.
    pub(crate) fn value(&self, cell: usize) -> f64 {
        let [from, to] = self.ends;
        from + (to - from) * (cell as f64 + 0.5) / self.cells as f64
    }

    /// The quantity by which starts of a system are given.
    ///
    /// # Errors
    /// The message about a wrong name, with the names that are accepted.
    pub(crate) fn on(&self, system: &Built<'_>) -> Result<usize, String> {
        let starts = system.quantities().into_iter().enumerate().filter(|(k, _)| system.gives_start(*k));
        let accepted = || format!("{RANGE}; NAME is one of {}", names(starts.map(|(_, quantity)| quantity).collect()));
        match system.named(&self.name) {
            Some(k) if system.gives_start(k) => Ok(k),
            Some(_) => Err(format!("`{}` is not a quantity that a start has; {}", self.name, accepted())),
            None => Err(format!("the scene has no quantity `{}`; {}", self.name, accepted())),
        }
    }
}

/// As it is written on the command line, with all digits.
impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [from, to] = self.ends;
        write!(f, "{}={from:?}:{to:?}:{}", self.name, self.cells)
    }
}

const RANGE: &str = "accepted is NAME=FROM:TO:CELLS, for example speed=-1:1:40";

/// The most cells along an axis.
const MOST: usize = 2000;

impl FromStr for Range {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, range) = text.split_once('=').ok_or(RANGE)?;
        let parts: Vec<&str> = range.split(':').map(str::trim).collect();
        let [from, to, cells] = parts[..] else { return Err(RANGE.to_owned()) };
        let number = |text: &str| text.parse().ok().filter(|x: &f64| x.is_finite());
        let ends = number(from).zip(number(to)).filter(|(from, to)| from < to);
        let (from, to) = ends.ok_or_else(|| format!("`{range}` is not a range with FROM less than TO; {RANGE}"))?;
        let cells = cells.parse().ok().filter(|cells| (1..=MOST).contains(cells));
        let cells = cells.ok_or_else(|| format!("CELLS must be a whole number from 1 to {MOST}; {RANGE}"))?;
        Ok(Self { name: name.trim().to_owned(), ends: [from, to], cells })
    }
}
