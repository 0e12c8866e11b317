use crate::AnyState;
use std::fmt;

/// Which crossings of zero count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Direction {
    /// From below.
    Rising,
    /// From above.
    Falling,
    /// Both.
    #[default]
    Both,
}

/// A function of the time (s), the configuration with its full turns, and the velocity.
type EventFunction<'a> = Box<dyn Fn(f64, &[f64], &[f64]) -> f64 + 'a>;

/// A condition on these, and on whether the function rises.
type CrossingFilter<'a> = Box<dyn Fn(f64, &[f64], &[f64], bool) -> bool + 'a>;

/// A function of time and state whose crossings of zero are looked for.
///
/// A crossing changes the sign. A zero that is only touched is none, and a run that begins on one has not crossed it.
pub struct Event<'a> {
    /// The name of the event.
    pub name: String,
    /// Which crossings count, in the direction in which the run goes.
    pub direction: Direction,
    /// Whether the first crossing ends the run.
    pub terminal: bool,
    function: EventFunction<'a>,
    filter: Option<CrossingFilter<'a>>,
}

impl<'a> Event<'a> {
    /// The event `function(t, q, v) = 0`, in both directions, which ends nothing; angles of `q` have their full turns.
    pub fn new(name: impl Into<String>, function: impl Fn(f64, &[f64], &[f64]) -> f64 + 'a) -> Self {
        Self {
            name: name.into(),
            direction: Direction::Both,
            terminal: false,
            function: Box::new(function),
            filter: None,
        }
    }

    /// The same event, of which only crossings in one direction count.
    #[must_use]
    pub fn in_direction(self, direction: Direction) -> Self {
        Self { direction, ..self }
    }

    /// The same event, of which only those crossings count that `filter(t, q, v, rising)` says: of those that the
    /// [`direction`](Self::direction) leaves.
    #[must_use]
    pub fn where_true(self, filter: impl Fn(f64, &[f64], &[f64], bool) -> bool + 'a) -> Self {
        Self { filter: Some(Box::new(filter)), ..self }
    }

    /// The same event, ending the run.
    #[must_use]
    pub fn terminal(self) -> Self {
        Self { terminal: true, ..self }
    }

    /// The value of the function at the time `t` (s).
    #[must_use]
    pub fn value(&self, t: f64, state: &AnyState) -> f64 {
        self.value_at(t, &state.unwrapped(), state.v())
    }

    /// The value at a configuration and a velocity.
    pub(super) fn value_at(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        (self.function)(t, q, v)
    }

    pub(super) fn counts(&self, rising: bool) -> bool {
        match self.direction {
            Direction::Rising => rising,
            Direction::Falling => !rising,
            Direction::Both => true,
        }
    }

    /// Whether some crossings may not count, so that between two of them may be another.
    #[must_use]
    pub fn leaves_some_out(&self) -> bool {
        self.direction != Direction::Both || self.filter.is_some()
    }

    /// Whether a crossing that was found counts.
    pub(super) fn admits(&self, crossing: &Crossing) -> bool {
        let Crossing { t, rising, state, .. } = crossing;
        self.filter.as_ref().is_none_or(|filter| filter(*t, &state.unwrapped(), state.v(), *rising))
    }
}

impl fmt::Debug for Event<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, direction, terminal, .. } = self;
        f.debug_struct("Event")
            .field("name", name)
            .field("direction", direction)
            .field("terminal", terminal)
            .finish_non_exhaustive()
    }
}

/// An event that happened.
#[derive(Debug, Clone, PartialEq)]
pub struct Crossing {
    /// Which one, by its place in the list of events.
    pub event: usize,
    /// The node before it.
    pub k: u64,
    /// The time (s).
    pub t: f64,
    /// The interval of time that is known to hold the change of sign (s). The error of the method comes on top.
    pub within: f64,
    /// The spacing of the samples that found it (s); 0 if the velocity jumped over it.
    pub spacing: f64,
    /// Whether the function rises through zero.
    pub rising: bool,
    /// The state then: a step of the method, shortened to end there. Where a velocity jumps, the state after the jump.
    pub state: AnyState,
}
