//! The system of a scene of either kind, in the words of its scene.

mod sleigh;
mod text;

use crate::systems::{Column, SceneSystem, Started};
use ::text::{TextMechanics, TextStart};
use assembly::parts::Train;
use dla::{Mechanism, Node, Size};
use std::fmt;

pub use self::sleigh::{QUANTITIES, SleighQuantity};
pub use self::text::quantities as text_quantities;

/// A system of a scene that was built, with its start.
pub struct BuiltScene {
    system: Owned,
    /// Configuration at the start, as long as the mechanism of the system has coordinates.
    pub q: Vec<f64>,
    /// Velocity at the start.
    pub v: Vec<f64>,
}

enum Owned {
    Sleigh(Box<dyn SceneSystem>),
    Text(TextMechanics),
}

impl BuiltScene {
    pub(crate) fn of_sleigh(Started { system, q, v }: Started) -> Self {
        Self { system: Owned::Sleigh(system), q, v }
    }

    pub(crate) fn of_text(system: TextMechanics, start: &TextStart) -> Self {
        let all = system.mechanism().size().n;
        let [q, v] = [&start.q, &start.v].map(|x| text::filled(x.clone(), all));
        Self { system: Owned::Text(system), q, v }
    }

    /// The system.
    #[must_use]
    pub fn system(&self) -> Built<'_> {
        match &self.system {
            Owned::Sleigh(system) => Built::Sleigh(&**system),
            Owned::Text(system) => Built::Text(system),
        }
    }
}

impl fmt::Debug for BuiltScene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { system: _, q, v } = self;
        f.debug_struct("BuiltScene").field("system", &self.system()).field("q", q).field("v", v).finish()
    }
}

/// The system of a scene: a mechanism, and what a state is in the words of the scene.
///
/// It is what commands ask, so that none of them needs to know which kind a scene is of. Configurations and velocities are as long as its
/// mechanism has coordinates.
#[derive(Clone, Copy)]
pub enum Built<'a> {
    /// A sleigh, and what acts on it.
    Sleigh(&'a dyn SceneSystem),
    /// A system of text.
    Text(&'a TextMechanics),
}

/// A number that a state has, by its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Quantity {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Whether values a turn apart are the same place.
    pub angle: bool,
}

impl Quantity {
    /// Its name and its unit, for an axis.
    #[must_use]
    pub fn label(&self) -> String {
        if self.unit.is_empty() { self.name.clone() } else { format!("{} [{}]", self.name, self.unit) }
    }

    /// Its column in a file.
    #[must_use]
    pub fn column(&self) -> Column {
        Column::new(self.name.as_str(), self.unit.as_str())
    }
}

/// Configuration and velocity of a start.
pub type StartPlace = (Vec<f64>, Vec<f64>);

impl<'a> Built<'a> {
    /// The system for runs, with its own integrators: a sleigh has some.
    #[must_use]
    pub fn mechanism(&self) -> Box<dyn Mechanism + 'a> {
        match *self {
            Self::Sleigh(system) => system.mechanism(),
            Self::Text(system) => system.mechanism(),
        }
    }

    /// Whether velocities are imposed, so that the motion is not the system's own.
    #[must_use]
    pub fn imposes_velocities(&self) -> bool {
        self.sleigh().is_some_and(SceneSystem::imposes_velocities)
    }

    /// All quantities, the first of which [tell a state](Self::in_state), in their order.
    #[must_use]
    pub fn quantities(&self) -> Vec<Quantity> {
        let mut quantities = match self {
            Self::Sleigh(system) => sleigh::quantities(*system),
            Self::Text(system) => {
                let model = system.model();
                text::quantities(model).into_iter().chain(text::multipliers(model)).collect()
            }
        };
        if self.train().is_some() {
            // The quantities of a train are those of its first blade.
            quantities.truncate(sleigh::IN_STATE);
        } else {
            quantities.push(Quantity { name: ENERGY.to_owned(), unit: "J".to_owned(), angle: false });
        }
        quantities
    }

    /// How many of the quantities tell a state: places, rates, and the outputs of a text.
    #[must_use]
    pub fn in_state(&self) -> usize {
        match self {
            Self::Sleigh(_) => sleigh::IN_STATE,
            Self::Text(system) => text::in_state(system.model()),
        }
    }

    /// Which quantity has that name; a rate is `x'` or `x_dot`.
    #[must_use]
    pub fn named(&self, name: &str) -> Option<usize> {
        let quantities = self.quantities();
        let at = |name: &str| quantities.iter().position(|quantity| quantity.name == name);
        at(name).or_else(|| at(&format!("{}'", name.strip_suffix("_dot")?)))
    }

    /// The value of a quantity, by its place in their list.
    #[must_use]
    pub fn value(&self, k: usize, t: f64, q: &[f64], v: &[f64]) -> f64 {
        let value = match self {
            Self::Sleigh(system) => sleigh::value(*system, k, t, q, v),
            Self::Text(system) => text::value(system.model(), k, t, q, v),
        };
        // The energy is the last.
        value.unwrap_or_else(|| self.mechanism().smooth_piece(t).energy(t, q, v))
    }

    /// What tells a state, with its values.
    #[must_use]
    pub fn state(&self, t: f64, q: &[f64], v: &[f64]) -> Vec<(Quantity, f64)> {
        let quantities = self.quantities().into_iter().take(self.in_state());
        let values: Vec<f64> = match self {
            Self::Sleigh(_) => (0..self.in_state()).map(|k| self.value(k, t, q, v)).collect(),
            Self::Text(system) => text::values(system.model(), t, q, v),
        };
        quantities.zip(values).collect()
    }

    /// The columns of a trajectory that begins at this node.
    #[must_use]
    pub fn columns(&self, first: &Node) -> Vec<Column> {
        match self {
            Self::Sleigh(system) => system.columns(first),
            Self::Text(system) => text::columns(system.model()),
        }
    }

    /// The numbers of a node, one for each of the [`columns`](Self::columns).
    #[must_use]
    pub fn row(&self, node: &Node) -> Vec<f64> {
        match self {
            Self::Sleigh(system) => system.row(node),
            Self::Text(system) => text::row(system.model(), node),
        }
    }

    /// The distance between two configurations (m or rad, whichever is larger): over places and headings for sleighs, over the
    /// coordinates for systems of text.
    #[must_use]
    pub fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        match self {
            Self::Sleigh(_) => sleigh::distance(a, b),
            Self::Text(_) => a.iter().zip(b).fold(0.0, |most, (a, b)| lagrangian::linear::larger(most, a - b)),
        }
    }

    /// The numbers of coordinates and constraints of the system itself, without those that pad it to a shape.
    #[must_use]
    pub fn own(&self) -> (usize, usize) {
        match self {
            Self::Sleigh(system) => {
                let Size { n, m } = system.mechanism().size();
                (n, m)
            }
            Self::Text(system) => (system.model().coordinates().len(), system.model().constraints()),
        }
    }

    /// The start with quantity `k` set to `value`, all else as near to `start` as the constraints admit. Returns `None` if there is no
    /// such start, or if starts are not given by this quantity.
    ///
    /// A changed coordinate keeps the quasi-velocities.
    #[must_use]
    pub fn with(&self, start: &StartPlace, k: usize, value: f64) -> Option<StartPlace> {
        match self {
            Self::Sleigh(system) => sleigh::with(*system, start, k, value),
            Self::Text(system) => text::with(system, start, k, value),
        }
    }

    /// The time in which formulas have been derived so far (s); zero where none are.
    #[must_use]
    pub fn derivation_seconds(&self) -> f64 {
        match self {
            Self::Sleigh(_) => 0.0,
            Self::Text(system) => system.model().derivation_seconds(),
        }
    }

    /// Whether a start is given by that quantity.
    #[must_use]
    pub fn gives_start(&self, k: usize) -> bool {
        match self {
            Self::Sleigh(_) => k < sleigh::IN_STATE,
            Self::Text(system) => k < 2 * system.model().coordinates().len(),
        }
    }

    /// The sleigh, if the system is one.
    #[must_use]
    pub fn sleigh(&self) -> Option<&'a dyn SceneSystem> {
        match *self {
            Self::Sleigh(system) => Some(system),
            Self::Text(_) => None,
        }
    }

    /// Whether the system has the methods of assemblies only: a train, or a text with more coordinates than any shape.
    #[must_use]
    pub fn is_assembly(&self) -> bool {
        match self {
            Self::Sleigh(system) => system.train().is_some(),
            Self::Text(system) => system.model().is_assembly(),
        }
    }

    /// The train, if blades follow a sleigh.
    #[must_use]
    pub fn train(&self) -> Option<&'a Train> {
        self.sleigh()?.train()
    }
}

impl fmt::Debug for Built<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.mechanism().fmt(f)
    }
}

/// The quantity that every system has.
const ENERGY: &str = "energy";
