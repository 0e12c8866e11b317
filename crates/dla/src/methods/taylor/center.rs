use crate::State;
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
    /// The corner at which it ends.
    pub(super) corner: Option<usize>,
    /// The corner at which it begins.
    pub(super) turned: Option<usize>,
}

impl<const N: usize> Center<N> {
    /// The time at which it ends (s).
    pub(super) fn end(&self) -> f64 {
        if self.forward { self.t + self.full } else { self.t - self.full }
    }

    /// Everything, with the time (s) up to which it was used.
    pub(super) fn save(&self, reached: f64) -> Vec<f64> {
        let number = |corner: Option<usize>| corner.map_or(-1.0, |k| k as f64);
        let mut all = vec![reached, self.t, self.unit, self.full, f64::from(u8::from(self.forward))];
        all.extend([number(self.corner), number(self.turned)]);
        all.extend(self.xi.as_flattened());
        all.extend(self.state.numbers());
        all.extend(&*self.sides);
        all
    }

    /// What [`save`](Self::save) gave, beside a state of the same system.
    pub(super) fn load(all: &[f64], beside: &State<N>) -> Option<(Self, f64)> {
        let (&[reached, t, unit, full, forward, ended, begun], rest) = all.split_first_chunk::<7>()?;
        let (xi, rest) = rest.split_at_checked(2 * N)?;
        let (numbers, sides) = rest.split_at_checked(3 * N)?;
        // A number from a file may be anything.
        let corner = |k: f64| (0.0 <= k && k < sides.len() as f64).then_some(k as usize);
        let center = Self {
            t,
            state: beside.with_numbers(numbers),
            xi: [from_fn(|k| xi[k]), from_fn(|k| xi[N + k])],
            unit,
            full,
            forward: forward != 0.0,
            sides: sides.into(),
            corner: corner(ended),
            turned: corner(begun),
        };
        Some((center, reached))
    }
}
