use crate::{State, StepError, stops};
use lagrangian::from_fn;
use std::sync::Arc;

/// Where a polynomial begins, and how long it holds.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Center<const N: usize> {
    pub(super) t: f64,
    pub(super) state: State<N>,
    /// The quasi-velocities, and the rounding of their sum.
    pub(super) xi: [[f64; N]; 2],
    /// The unit of time of its coefficients (s), a power of two.
    pub(super) unit: f64,
    /// How long it holds (s), and in which direction.
    pub(super) full: f64,
    pub(super) forward: bool,
    /// The sides of the corners.
    pub(super) sides: Arc<[f64]>,
    /// The sides after its end, if corners are there.
    pub(super) after: Option<Arc<[f64]>>,
    /// The sides before its beginning, if corners are there.
    pub(super) before: Option<Arc<[f64]>>,
}

impl<const N: usize> Center<N> {
    /// The time at which it ends (s).
    pub(super) fn end(&self) -> f64 {
        if self.forward { self.t + self.full } else { self.t - self.full }
    }

    /// The next time to go to (s) in an interval of this length (s) and with this end, and true if that is the end of the interval; else it is
    /// the end of the polynomial, after this number of tries.
    ///
    /// # Errors
    /// [`StepError::Tolerance`] if the polynomial leads nowhere, [`StepError::Stopped`] if the caller asked for that.
    pub(super) fn toward(&self, end: f64, h: f64, tries: u32) -> Result<(f64, bool), StepError> {
        if (end - self.t).abs() <= self.full {
            return Ok((end, true));
        }
        let to = self.end();
        if to.to_bits() == self.t.to_bits() || self.full <= f64::EPSILON * h.abs() {
            return Err(StepError::Tolerance { tries, step: self.full });
        }
        if stops() { Err(StepError::Stopped) } else { Ok((to, false)) }
    }

    /// The coordinates, and behind them the quasi-velocities, as many as there are unknowns.
    pub(super) fn unknowns(&self, coordinates: usize, unknowns: usize) -> Vec<f64> {
        let (places, velocities) = (&self.state.q()[..coordinates], &self.xi[0][..unknowns - coordinates]);
        [places, velocities].concat()
    }

    /// Everything, with the time (s) up to which it was used.
    pub(super) fn save(&self, reached: f64) -> Vec<f64> {
        let of = |sides: &Option<Arc<[f64]>>| f64::from(u8::from(sides.is_some()));
        let forward = f64::from(u8::from(self.forward));
        let mut all = vec![reached, self.t, self.unit, self.full, forward, of(&self.after), of(&self.before)];
        all.extend(self.xi.as_flattened());
        all.extend(self.state.numbers());
        for sides in [Some(&self.sides), self.after.as_ref(), self.before.as_ref()].into_iter().flatten() {
            all.extend(&**sides);
        }
        all
    }

    /// What [`save`](Self::save) gave, beside a state of the same system.
    pub(super) fn load(all: &[f64], beside: &State<N>) -> Option<(Self, f64)> {
        let (&[reached, t, unit, full, forward, after, before], rest) = all.split_first_chunk::<7>()?;
        let (xi, rest) = rest.split_at_checked(2 * N)?;
        let (numbers, rest) = rest.split_at_checked(3 * N)?;
        let lists = 1 + usize::from(after != 0.0) + usize::from(before != 0.0);
        if !rest.len().is_multiple_of(lists) {
            return None;
        }
        let corners = rest.len() / lists;
        let mut lists = rest.chunks(corners.max(1)).map(Arc::from);
        let mut list = |is_there: bool| is_there.then(|| lists.next().unwrap_or_default());
        let center = Self {
            t,
            state: beside.with_numbers(numbers),
            xi: [from_fn(|k| xi[k]), from_fn(|k| xi[N + k])],
            unit,
            full,
            forward: forward != 0.0,
            sides: list(true).unwrap_or_default(),
            after: list(after != 0.0),
            before: list(before != 0.0),
        };
        Some((center, reached))
    }
}
