//! What an assembly says of a state.

use crate::element::{Element, with_room};
use crate::{Assembly, AssemblyState};
use dla::{AssemblyFault, NotANumber, StepError};
use lagrangian::linear::larger;

impl Assembly {
    /// Evaluates each element at its coordinates and velocities; `apart` is the difference of two coordinates.
    fn say<T>(
        &self,
        (q_of, v_of): (impl Fn(usize) -> f64, impl Fn(usize) -> f64),
        apart: impl Fn(usize, usize) -> f64,
        mut of: impl FnMut(&dyn Element, &[f64], &[f64]) -> T,
        mut with: impl FnMut(T),
    ) {
        for placed in self.placed() {
            let n = placed.at.len();
            with(with_room(n, |q| {
                placed.gather(&q_of, q);
                for (k, origin) in placed.origins.iter().flatten().enumerate() {
                    q[k] = origin.map_or(q[k], |origin| apart(placed.at[k], placed.at[origin]));
                }
                with_room(n, |v| {
                    placed.gather(&v_of, v);
                    of(placed.element.as_ref(), q, v)
                })
            }));
        }
    }

    /// Evaluates each element at a state, with all digits of differences.
    fn say_of_state<T>(
        &self,
        state: &AssemblyState,
        of: impl FnMut(&dyn Element, &[f64], &[f64]) -> T,
        with: impl FnMut(T),
    ) {
        self.say((|i| state.q()[i], |i| state.v()[i]), |i, from| state.apart(i, from), of, with);
    }

    /// Evaluates each element at a configuration and a velocity.
    fn say_at<T>(
        &self,
        (q, v): (&[f64], &[f64]),
        of: impl FnMut(&dyn Element, &[f64], &[f64]) -> T,
        with: impl FnMut(T),
    ) {
        let (q, v) = (number_of(q), number_of(v));
        self.say((&q, v), |i, from| q(i) - q(from), of, with);
    }

    /// The first element with a function that is not finite a `part` of a step ahead of a state, or has no finite derivative there;
    /// coordinates and rows in the numbers of the assembly.
    #[cold]
    fn not_a_number(
        &self,
        (t, h): (f64, f64),
        part: f64,
        state: &AssemblyState,
    ) -> Option<(usize, &'static str, NotANumber)> {
        let (mut places, mut found) = (self.placed().iter().enumerate(), None);
        let ahead = |i: usize| part * h * state.v()[i];
        self.say(
            (|i| state.ahead(i, ahead(i)), |i| state.v()[i]),
            |i, from| state.apart(i, from) + (ahead(i) - ahead(from)),
            |element, q, v| element.not_a_number(t + part * h, q, v),
            |missing| {
                let placed = places.next();
                if let (None, Some((element, placed)), Some(missing)) = (found, placed, missing) {
                    let missing = missing.renumbered(|i| placed.at.get(i).copied().unwrap_or(i), placed.row);
                    found = Some((element, placed.name, NotANumber { at_node: part == 0.0, ..missing }));
                }
            },
        );
        found
    }

    /// The error of a step from `state` of this time and length (s), with the function named that is not finite at its beginning, in its
    /// middle or at its end, if it may have failed by that.
    #[must_use]
    #[cold]
    pub fn named(&self, error: StepError, step: (f64, f64), state: &AssemblyState) -> StepError {
        let lost = matches!(
            error,
            StepError::NotFinite | StepError::Newton { .. } | StepError::Assembly(AssemblyFault::Singular { .. })
        );
        let found = || [0.0, 0.5, 1.0].into_iter().find_map(|part| self.not_a_number(step, part, state));
        let found = if lost { found() } else { None };
        found.map_or(error, |(element, name, source)| AssemblyFault::NotANumber { element, name, source }.into())
    }

    /// The energy (J).
    #[must_use]
    pub fn energy(&self, t: f64, state: &AssemblyState) -> f64 {
        self.energy_at(t, state.q(), state.v())
    }

    pub(crate) fn energy_at(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        let mut total = 0.0;
        self.say_at((q, v), |element, q, v| element.energy(t, q, v), |energy| total += energy);
        total
    }

    /// The largest residual `|A v + b|` of all constraints (m/s).
    pub(crate) fn largest_residual(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        let mut most = 0.0;
        self.say_at((q, v), |element, q, v| element.misses(t, q, v)[0], |miss| most = larger(most, miss));
        most
    }

    /// The largest residual `|A v + b|` of all constraints (m/s), and the largest `|g|` of those on positions (m).
    #[must_use]
    pub fn misses(&self, t: f64, state: &AssemblyState) -> [f64; 2] {
        let mut most = [0.0; 2];
        let each = |miss: [f64; 2]| most = [larger(most[0], miss[0]), larger(most[1], miss[1])];
        self.say_of_state(state, |element, q, v| element.misses(t, q, v), each);
        most
    }
}

/// The numbers of a list by their place; NaN beyond its end.
fn number_of(x: &[f64]) -> impl Fn(usize) -> f64 {
    |i| x.get(i).copied().unwrap_or(f64::NAN)
}
