use sleigh::SleighState;
use std::f64::consts::{PI, TAU};
use std::str::FromStr;

/// A quantity of the sleigh by its name, for planes and axes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coordinate {
    pub(crate) name: &'static str,
    unit: &'static str,
    value: fn(&Place) -> f64,
    /// Where a start is given by it: how.
    set: Option<fn(&mut SleighState, f64)>,
}

/// Where the sleigh is, and its centre of mass.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    pub(crate) state: SleighState,
    pub(crate) centre: [f64; 2],
}

impl Place {
    /// The centre of mass, as the body sees it: its place along the blade and across it, from the origin.
    fn turned(&self) -> [f64; 2] {
        let (sin, cos) = self.state.heading.sin_cos();
        let [x, y] = self.centre;
        [x * cos + y * sin, y * cos - x * sin]
    }
}

pub(crate) const COORDINATES: [Coordinate; 9] = [
    Coordinate { name: "x", unit: "m", value: |at| at.state.x, set: Some(|state, value| state.x = value) },
    Coordinate { name: "y", unit: "m", value: |at| at.state.y, set: Some(|state, value| state.y = value) },
    Coordinate {
        name: "heading",
        unit: "rad",
        value: |at| within_a_turn(at.state.heading),
        set: Some(|state, value| state.heading = value),
    },
    Coordinate {
        name: "speed",
        unit: "m/s",
        value: |at| at.state.speed,
        set: Some(|state, value| state.speed = value),
    },
    Coordinate {
        name: "turn_rate",
        unit: "rad/s",
        value: |at| at.state.turn_rate,
        set: Some(|state, value| state.turn_rate = value),
    },
    Coordinate { name: "center_x", unit: "m", value: |at| at.centre[0], set: None },
    Coordinate { name: "center_y", unit: "m", value: |at| at.centre[1], set: None },
    Coordinate { name: "along", unit: "m", value: |at| at.turned()[0], set: None },
    Coordinate { name: "across", unit: "m", value: |at| at.turned()[1], set: None },
];

/// The angle within half a turn of zero.
fn within_a_turn(angle: f64) -> f64 {
    let within = angle - TAU * (angle / TAU).round();
    if within <= -PI { within + TAU } else { within }
}

impl Coordinate {
    pub(crate) fn at(&self, place: &Place) -> f64 {
        (self.value)(place)
    }

    pub(crate) fn is_angle(&self) -> bool {
        self.name == "heading"
    }

    /// Its name and unit, for an axis.
    pub(crate) fn label(&self) -> String {
        format!("{} [{}]", self.name, self.unit)
    }
}

impl FromStr for Coordinate {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = COORDINATES.iter().find(|known| known.name == text.trim());
        found.copied().ok_or_else(|| {
            let names: Vec<&str> = COORDINATES.iter().map(|known| known.name).collect();
            format!("no quantity `{}`; accepted are {}", text.trim(), names.join(", "))
        })
    }
}

/// A range of starts: a quantity, from where to where, in how many cells.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Range {
    pub(crate) coordinate: Coordinate,
    set: fn(&mut SleighState, f64),
    pub(crate) ends: [f64; 2],
    pub(crate) cells: usize,
}

impl Range {
    /// The middle of a cell.
    pub(crate) fn value(&self, cell: usize) -> f64 {
        let [from, to] = self.ends;
        from + (to - from) * (cell as f64 + 0.5) / self.cells as f64
    }

    pub(crate) fn apply(&self, state: &mut SleighState, cell: usize) {
        (self.set)(state, self.value(cell));
    }
}

/// The most cells along an axis.
const MOST: usize = 2000;

impl FromStr for Range {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let accepted = "accepted is NAME=FROM:TO:CELLS as in speed=-1:1:40, of x, y, heading, speed, turn_rate";
        let (name, range) = text.split_once('=').ok_or(accepted)?;
        let coordinate: Coordinate = name.parse().map_err(|_| format!("no start has `{}`; {accepted}", name.trim()))?;
        let set = coordinate.set.ok_or_else(|| format!("no start is given by `{}`; {accepted}", name.trim()))?;
        let parts: Vec<&str> = range.split(':').map(str::trim).collect();
        let [from, to, cells] = parts[..] else { return Err(accepted.to_owned()) };
        let number = |text: &str| text.parse().ok().filter(|x: &f64| x.is_finite());
        let ends = number(from).zip(number(to)).filter(|(from, to)| from < to);
        let (from, to) = ends.ok_or_else(|| format!("`{range}` is no range; {accepted}"))?;
        let cells = cells.parse().ok().filter(|cells| (1..=MOST).contains(cells));
        let cells = cells.ok_or_else(|| format!("from 1 to {MOST} cells; {accepted}"))?;
        Ok(Self { coordinate, set, ends: [from, to], cells })
    }
}
