use crate::{Checkpoint, State};
use lagrangian::from_fn;
use std::any::Any;
use std::fmt;

/// Configuration and velocity of a system whose size is known at run time.
///
/// It holds the state that the methods of its system step; for a system of a shape a [`State`]. [`Mechanism::state`](crate::Mechanism::state)
/// makes it.
pub struct AnyState(Box<dyn Stateful>);

/// A state that an [`AnyState`] may hold.
pub trait Stateful: Any + Send + Sync {
    /// As [`AnyState::q`].
    fn q(&self) -> &[f64];
    /// As [`AnyState::v`].
    fn v(&self) -> &[f64];
    /// As [`AnyState::turns`].
    fn turns(&self) -> &[f64];
    /// As [`AnyState::unwrap_into`].
    fn unwrap_into(&self, q: &mut [f64]);
    /// The distance moved since a state of the same kind; zeros of another one.
    fn move_into(&self, before: &dyn Any, moved: &mut [f64]);
    /// As [`AnyState::save`].
    fn save(&self, checkpoint: &mut Checkpoint);
    /// As [`AnyState::reversed`].
    fn reversed(&self) -> AnyState;
    /// A copy.
    fn cloned(&self) -> AnyState;
    /// Copies the other state if it is of the same kind; returns false if it is not.
    fn becomes(&mut self, other: &dyn Any) -> bool;
}

impl<const N: usize> Stateful for State<N> {
    fn q(&self) -> &[f64] {
        self.q()
    }

    fn v(&self) -> &[f64] {
        self.v()
    }

    fn turns(&self) -> &[f64] {
        self.turns()
    }

    fn unwrap_into(&self, q: &mut [f64]) {
        q.iter_mut().zip(self.unwrapped()).for_each(|(q, x)| *q = x);
    }

    fn move_into(&self, before: &dyn Any, moved: &mut [f64]) {
        let way = before.downcast_ref().map_or([0.0; N], |before| self.moved_since(before));
        moved.iter_mut().zip(way).for_each(|(moved, x)| *moved = x);
    }

    fn save(&self, checkpoint: &mut Checkpoint) {
        self.save(checkpoint);
    }

    fn reversed(&self) -> AnyState {
        State::reversed(self).into()
    }

    fn cloned(&self) -> AnyState {
        (*self).into()
    }

    fn becomes(&mut self, other: &dyn Any) -> bool {
        other.downcast_ref().map(|other| *self = *other).is_some()
    }
}

impl<S: Stateful> From<S> for AnyState {
    fn from(state: S) -> Self {
        Self(Box::new(state))
    }
}

impl AnyState {
    /// Configuration, angles within a turn: what a system is evaluated at.
    #[must_use]
    pub fn q(&self) -> &[f64] {
        self.0.q()
    }

    /// Velocity.
    #[must_use]
    pub fn v(&self) -> &[f64] {
        self.0.v()
    }

    /// The full turns of every angle.
    #[must_use]
    pub fn turns(&self) -> &[f64] {
        self.0.turns()
    }

    /// Configuration, angles with their full turns: what a user wants to see.
    #[must_use]
    pub fn unwrapped(&self) -> Vec<f64> {
        let mut q = vec![0.0; self.q().len()];
        self.unwrap_into(&mut q);
        q
    }

    /// Writes [`unwrapped`](Self::unwrapped) into a slice of its length.
    pub fn unwrap_into(&self, q: &mut [f64]) {
        self.0.unwrap_into(q);
    }

    /// How far the configuration has moved since a state of the same system, with the digits that the sums keep; written into a slice.
    pub fn move_into(&self, before: &Self, moved: &mut [f64]) {
        self.0.move_into(&*before.0, moved);
    }

    /// As [`move_into`](Self::move_into), as a list.
    #[must_use]
    pub fn moved_since(&self, before: &Self) -> Vec<f64> {
        let mut moved = vec![0.0; self.q().len()];
        self.move_into(before, &mut moved);
        moved
    }

    /// The same place with the opposite velocity.
    #[must_use]
    pub fn reversed(&self) -> Self {
        self.0.reversed()
    }

    /// Writes every bit of the state to a checkpoint; all but which coordinates are angles, which the system knows.
    pub fn save(&self, checkpoint: &mut Checkpoint) {
        self.0.save(checkpoint);
    }

    /// The state as one of `N` coordinates; `None` if it has another shape.
    #[must_use]
    #[inline]
    pub fn typed<const N: usize>(&self) -> Option<&State<N>> {
        self.held()
    }

    /// As [`typed`](Self::typed), to be changed.
    #[inline]
    pub fn typed_mut<const N: usize>(&mut self) -> Option<&mut State<N>> {
        self.held_mut()
    }

    /// The state inside; `None` if it is of another kind.
    #[must_use]
    #[inline]
    pub fn held<S: Stateful>(&self) -> Option<&S> {
        let state: &dyn Any = &*self.0;
        state.downcast_ref()
    }

    /// As [`held`](Self::held), to be changed.
    #[inline]
    pub fn held_mut<S: Stateful>(&mut self) -> Option<&mut S> {
        let state: &mut dyn Any = &mut *self.0;
        state.downcast_mut()
    }
}

impl Clone for AnyState {
    fn clone(&self) -> Self {
        self.0.cloned()
    }

    /// Without an allocation if both are of one shape.
    fn clone_from(&mut self, source: &Self) {
        let other: &dyn Any = &*source.0;
        if !self.0.becomes(other) {
            *self = source.clone();
        }
    }
}

impl PartialEq for AnyState {
    /// Configurations with their turns, and velocities.
    fn eq(&self, other: &Self) -> bool {
        (self.q(), self.turns(), self.v()) == (other.q(), other.turns(), other.v())
    }
}

impl fmt::Debug for AnyState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("AnyState").field("q", &self.q()).field("turns", &self.turns()).field("v", &self.v()).finish()
    }
}

/// A list of numbers as a row of `N`, with not a number in the places that it lacks.
#[must_use]
pub fn row<const N: usize>(x: &[f64]) -> [f64; N] {
    match x.first_chunk() {
        Some(row) => *row,
        None => from_fn(|i| x.get(i).copied().unwrap_or(f64::NAN)),
    }
}
