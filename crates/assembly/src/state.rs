mod saved;

use crate::Assembly;
use dla::{AnyState, Checkpoint, Stateful};
use std::any::Any;

/// Configuration and velocity of an assembly.
///
/// Each coordinate is a [`dla::State`] of its own: compensated sums, angles within a turn and their turns apart, as in the
/// static integrators.
#[derive(Debug, Clone, PartialEq)]
pub struct AssemblyState {
    coordinates: Vec<dla::State<1>>,
    /// What each of them has of these.
    q: Vec<f64>,
    turns: Vec<f64>,
    v: Vec<f64>,
}

impl AssemblyState {
    /// A state at `q` with velocity `v`; missing numbers are zero.
    #[must_use]
    pub fn new(assembly: &Assembly, q: &[f64], v: &[f64]) -> Self {
        let number = |x: &[f64], i: usize| x.get(i).copied().unwrap_or(0.0);
        let one = |(i, angle): (usize, &bool)| dla::State::new([number(q, i)], [number(v, i)], [*angle]);
        Self::of(assembly.angles().iter().enumerate().map(one).collect())
    }

    fn of(coordinates: Vec<dla::State<1>>) -> Self {
        let of = |number: fn(&dla::State<1>) -> f64| coordinates.iter().map(number).collect();
        let (q, turns, v) = (of(|one| one.q()[0]), of(|one| one.turns()[0]), of(|one| one.v()[0]));
        Self { coordinates, q, turns, v }
    }

    /// Number of coordinates.
    #[must_use]
    pub fn len(&self) -> usize {
        self.coordinates.len()
    }

    /// Whether there is no coordinate.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.coordinates.is_empty()
    }

    /// The coordinates, angles within a turn: what elements are evaluated at.
    #[must_use]
    #[inline(always)]
    pub fn q(&self) -> &[f64] {
        &self.q
    }

    /// The coordinates, angles with their full turns.
    #[must_use]
    pub fn unwrapped(&self) -> Vec<f64> {
        self.coordinates.iter().map(|one| one.unwrapped()[0]).collect()
    }

    /// The velocities.
    #[must_use]
    #[inline(always)]
    pub fn v(&self) -> &[f64] {
        &self.v
    }

    /// The approximate acceleration of a coordinate, if the last step left it.
    #[inline(always)]
    pub(crate) fn acceleration(&self, i: usize) -> Option<f64> {
        self.coordinates[i].acceleration().map(|[a]| a)
    }

    /// The increment of a coordinate in a step of length `h` (s), extrapolated from the last steps; `None` if they had other lengths.
    #[inline(always)]
    pub(crate) fn expected(&self, i: usize, h: f64) -> Option<f64> {
        self.coordinates[i].expected(h).map(|[dq]| dq)
    }

    /// A coordinate at the end of a step with this increment, before the state has moved there.
    #[inline(always)]
    pub(crate) fn ahead(&self, i: usize, increment: f64) -> f64 {
        self.coordinates[i].ahead(&[increment])[0]
    }

    /// How far a coordinate has moved since `before`, with the digits that the sums keep.
    #[must_use]
    pub fn moved_since(&self, before: &Self, i: usize) -> f64 {
        self.coordinates[i].moved_since(&before.coordinates[i])[0]
    }

    /// The difference between a coordinate and another, `i` less `from`, with the digits that the sums keep.
    #[inline(always)]
    pub(crate) fn apart(&self, i: usize, from: usize) -> f64 {
        self.coordinates[i].moved_since(&self.coordinates[from])[0]
    }

    /// Moves a coordinate by a step of length `h` (s), and stores its approximate acceleration for the next step.
    #[inline(always)]
    pub(crate) fn advance(&mut self, h: f64, i: usize, increment: f64, v: f64, acceleration: f64) {
        self.coordinates[i].advance_with_acceleration(h, &[increment], [v], [acceleration]);
        self.show(i);
    }

    /// Changes the velocity of a coordinate in place, and discards the memory of earlier steps, which no longer holds.
    pub(crate) fn set_velocity(&mut self, i: usize, v: f64) {
        self.coordinates[i].advance(&[0.0], [v], None);
        self.show(i);
    }

    #[inline(always)]
    fn show(&mut self, i: usize) {
        let one = &self.coordinates[i];
        (self.q[i], self.turns[i], self.v[i]) = (one.q()[0], one.turns()[0], one.v()[0]);
    }

    /// The state with the opposite velocity.
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self::of(self.coordinates.iter().map(dla::State::reversed).collect())
    }

    /// Copies the other state. Nothing is allocated if both belong to one assembly.
    pub fn copy_from(&mut self, other: &Self) {
        self.coordinates.clone_from(&other.coordinates);
        self.q.clone_from(&other.q);
        self.turns.clone_from(&other.turns);
        self.v.clone_from(&other.v);
    }

    /// The largest distance between a coordinate of this state and the same coordinate of another (m or rad).
    #[must_use]
    pub fn distance(&self, other: &Self) -> f64 {
        let pairs = self.coordinates.iter().zip(&other.coordinates);
        pairs.fold(0.0, |most, (a, b)| lagrangian::linear::larger(most, a.moved_since(b)[0]))
    }
}

impl Stateful for AssemblyState {
    fn q(&self) -> &[f64] {
        &self.q
    }

    fn v(&self) -> &[f64] {
        &self.v
    }

    fn turns(&self) -> &[f64] {
        &self.turns
    }

    fn unwrap_into(&self, q: &mut [f64]) {
        q.iter_mut().zip(&self.coordinates).for_each(|(q, one)| *q = one.unwrapped()[0]);
    }

    fn move_into(&self, before: &dyn Any, moved: &mut [f64]) {
        let before = before.downcast_ref().map_or(&[][..], |before: &Self| &before.coordinates);
        moved.fill(0.0);
        let pairs = self.coordinates.iter().zip(before);
        moved.iter_mut().zip(pairs).for_each(|(moved, (now, before))| *moved = now.moved_since(before)[0]);
    }

    fn save(&self, checkpoint: &mut Checkpoint) {
        self.save(checkpoint);
    }

    fn reversed(&self) -> AnyState {
        self.reversed().into()
    }

    fn cloned(&self) -> AnyState {
        self.clone().into()
    }

    fn becomes(&mut self, other: &dyn Any) -> bool {
        other.downcast_ref().map(|other| self.copy_from(other)).is_some()
    }
}
