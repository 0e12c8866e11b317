//! What an assembly says of a state.

use crate::element::Element;
use crate::local::WIDEST;
use crate::{Assembly, AssemblyError, AssemblyState};
use dla::{NewtonError, NotANumber};
use lagrangian::linear::larger;

impl Assembly {
    /// What each element says of a state, from its coordinates and velocities.
    pub(crate) fn say<T>(
        &self,
        state: &AssemblyState,
        mut of: impl FnMut(&dyn Element, &[f64], &[f64]) -> T,
        mut with: impl FnMut(T),
    ) {
        let (mut q, mut v) = ([0.0; WIDEST], [0.0; WIDEST]);
        for placed in self.placed() {
            let n = placed.gather(|i| state.q(i), &mut q);
            for (k, origin) in placed.origins.iter().flatten().enumerate() {
                q[k] = origin.map_or(q[k], |origin| state.apart(placed.at[k], placed.at[origin]));
            }
            placed.gather(|i| state.v(i), &mut v);
            with(of(placed.element.as_ref(), &q[..n], &v[..n]));
        }
    }

    /// The first element with a function that is not finite at a state, or has no finite derivative there; coordinates and rows in the
    /// numbers of the assembly.
    #[must_use]
    #[cold]
    pub fn not_a_number(&self, t: f64, state: &AssemblyState) -> Option<(usize, &'static str, NotANumber)> {
        let (mut places, mut found) = (self.placed().iter().enumerate(), None);
        self.say(
            state,
            |element, q, v| element.not_a_number(t, q, v),
            |missing| {
                let placed = places.next();
                if let (None, Some((element, placed)), Some(missing)) = (found, placed, missing) {
                    let missing = missing.renumbered(|i| placed.at.get(i).copied().unwrap_or(i), placed.row);
                    found = Some((element, placed.name, missing));
                }
            },
        );
        found
    }

    /// The energy (J).
    #[must_use]
    pub fn energy(&self, t: f64, state: &AssemblyState) -> f64 {
        let mut total = 0.0;
        self.say(state, |element, q, v| element.energy(t, q, v), |energy| total += energy);
        total
    }

    /// The power of all forces and of time (W).
    #[must_use]
    pub fn power(&self, t: f64, state: &AssemblyState) -> f64 {
        let mut total = 0.0;
        self.say(state, |element, q, v| element.power(t, q, v), |power| total += power);
        total
    }

    /// The largest residual `|A v + b|` of all constraints (m/s), and the largest `|g|` of those on positions (m).
    #[must_use]
    pub fn misses(&self, t: f64, state: &AssemblyState) -> [f64; 2] {
        let mut most = [0.0; 2];
        let each = |miss: [f64; 2]| most = [larger(most[0], miss[0]), larger(most[1], miss[1])];
        self.say(state, |element, q, v| element.misses(t, q, v), each);
        most
    }
}

impl AssemblyError {
    /// The error of a step from `state` at `t` (s), with the function named that is not finite there, if it may have failed by that.
    #[must_use]
    #[cold]
    pub fn named(self, assembly: &Assembly, t: f64, state: &AssemblyState) -> Self {
        let lost = match &self {
            Self::NotFinite | Self::Singular { .. } => true,
            Self::Newton { source, .. } => matches!(source, NewtonError::NotFinite { .. }),
            _ => false,
        };
        let found = if lost { assembly.not_a_number(t, state) } else { None };
        found.map_or(self, |(element, name, source)| Self::NotANumber { element, name, source })
    }
}
