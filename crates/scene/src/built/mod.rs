//! The system of a scene of either kind, in the words of its scene.

mod sleigh;
mod text;

use ::text::TextMechanics;
use dla::{FullMechanics, Mechanics, Node, OwnMethods, Stepper, Subject};
use std::fmt;
use std::ops::Deref;
use systems::{Column, SceneSystem};

pub use self::sleigh::{QUANTITIES, SleighQuantity};
pub use self::text::quantities as text_quantities;

/// The system of a scene: mechanics that can name what a state is.
///
/// It is what commands ask, so that none of them needs to know which kind a scene is of.
#[derive(Clone, Copy)]
pub enum Built<'a, const N: usize, const M: usize> {
    /// A sleigh, and what acts on it.
    Sleigh(&'a dyn SceneSystem<N, M>),
    /// A system of text.
    Text(&'a dyn TextMechanics<N, M>),
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
pub type StartPlace<const N: usize> = ([f64; N], [f64; N]);

impl<const N: usize, const M: usize> Built<'_, N, M> {
    /// All quantities, the first of which [tell a state](Self::in_state), in their order.
    #[must_use]
    pub fn quantities(&self) -> Vec<Quantity> {
        let mut quantities = match self {
            Self::Sleigh(system) => sleigh::quantities(*system),
            Self::Text(system) => text::quantities(system.model()),
        };
        quantities.push(Quantity { name: ENERGY.to_owned(), unit: "J".to_owned(), angle: false });
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
    pub fn value(&self, k: usize, t: f64, q: &[f64; N], v: &[f64; N]) -> f64 {
        let value = match self {
            Self::Sleigh(system) => sleigh::value(*system, k, t, q, v),
            Self::Text(system) => text::value(system.model(), k, t, q, v),
        };
        // The energy is the last.
        value.unwrap_or_else(|| self.smooth_piece(t).energy(t, q, v))
    }

    /// What tells a state, with its values.
    #[must_use]
    pub fn state(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Vec<(Quantity, f64)> {
        let quantities = self.quantities().into_iter().take(self.in_state());
        let values: Vec<f64> = match self {
            Self::Sleigh(_) => (0..self.in_state()).map(|k| self.value(k, t, q, v)).collect(),
            Self::Text(system) => text::values(system.model(), t, q, v),
        };
        quantities.zip(values).collect()
    }

    /// The columns of a trajectory that begins at this node.
    #[must_use]
    pub fn columns(&self, first: &Node<N, M>) -> Vec<Column> {
        match self {
            Self::Sleigh(system) => system.columns(first),
            Self::Text(system) => text::columns(system.model()),
        }
    }

    /// The numbers of a node, one for each of the [`columns`](Self::columns).
    #[must_use]
    pub fn row(&self, node: &Node<N, M>) -> Vec<f64> {
        match self {
            Self::Sleigh(system) => system.row(node),
            Self::Text(system) => text::row(system.model(), node),
        }
    }

    /// How far two configurations are apart (m or rad, whichever is larger): the places and headings of sleighs, or the coordinates of
    /// systems of text.
    #[must_use]
    pub fn distance(&self, a: &[f64; N], b: &[f64; N]) -> f64 {
        match self {
            Self::Sleigh(_) => sleigh::distance(a, b),
            Self::Text(_) => a.iter().zip(b).fold(0.0, |most, (a, b)| lagrangian::linear::larger(most, a - b)),
        }
    }

    /// The coordinates and the constraints of the system's own: those beyond fill up its shape.
    #[must_use]
    pub fn own(&self) -> (usize, usize) {
        match self {
            Self::Sleigh(_) => (N, M),
            Self::Text(system) => (system.model().coordinates().len(), system.model().constraints()),
        }
    }

    /// The start with a quantity that has another value, all else as nearly as the constraints admit; none where it has no such start, or no
    /// start is given by that quantity.
    ///
    /// Places change with their quasi-velocities as they are.
    #[must_use]
    pub fn with(&self, start: &StartPlace<N>, k: usize, value: f64) -> Option<StartPlace<N>> {
        match self {
            Self::Sleigh(system) => sleigh::with(*system, start, k, value),
            Self::Text(system) => text::with(*system, start, k, value),
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

    /// The sleigh that it is, where it is one.
    #[must_use]
    pub fn sleigh(&self) -> Option<&dyn SceneSystem<N, M>> {
        match self {
            Self::Sleigh(system) => Some(*system),
            Self::Text(_) => None,
        }
    }
}

impl<const N: usize, const M: usize> fmt::Debug for Built<'_, N, M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let system: &dyn Mechanics<N, M> = &**self;
        system.fmt(f)
    }
}

/// The quantity that every system has.
const ENERGY: &str = "energy";

impl<'a, const N: usize, const M: usize> Deref for Built<'a, N, M> {
    type Target = dyn FullMechanics<N, M> + 'a;

    fn deref(&self) -> &Self::Target {
        match self {
            Self::Sleigh(system) => *system,
            Self::Text(system) => *system,
        }
    }
}

/// A sleigh has integrators of its own.
impl<const N: usize, const M: usize> OwnMethods<N, M> for Built<'_, N, M> {
    fn closed_map<'a>(&'a self, t: f64, general: Stepper<'a, N, M>) -> Stepper<'a, N, M> {
        match self {
            Self::Sleigh(system) => system.closed_map(t, general),
            Self::Text(_) => general,
        }
    }

    fn series(&self, t: f64, tolerance: f64) -> Option<Stepper<'_, N, M>> {
        match self {
            Self::Sleigh(system) => system.series(t, tolerance),
            Self::Text(_) => None,
        }
    }
}

impl<'a, const N: usize, const M: usize> From<&'a Built<'a, N, M>> for Subject<'a, N, M> {
    fn from(system: &'a Built<'a, N, M>) -> Self {
        Self { system: &**system, own: system }
    }
}
