use super::lanes::StageSlopes;
use crate::State;

/// Larger systems keep no memory.
const COORDINATES: usize = 12;

/// The predictor of the stages: the slopes of the last step, whose polynomial is continued to the nodes of the next.
///
/// It changes the result in the last bit at most; so it belongs to a checkpoint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct GaussMemory {
    /// Whether there was a step.
    known: bool,
    velocity: [[f64; 8]; COORDINATES],
    acceleration: [[f64; 8]; COORDINATES],
    /// The step (s), and its length in quarter octaves if it is a whole number of them.
    h: f64,
    pub(super) quarters: i32,
    /// The number of iterations of the last step.
    iterations: u32,
    /// The state at its end.
    q: [f64; COORDINATES],
    v: [f64; COORDINATES],
}

impl GaussMemory {
    /// Before the first step.
    pub(super) const NONE: Self = Self {
        known: false,
        velocity: [[0.0; 8]; COORDINATES],
        acceleration: [[0.0; 8]; COORDINATES],
        h: 0.0,
        quarters: 0,
        iterations: 0,
        q: [0.0; COORDINATES],
        v: [0.0; COORDINATES],
    };

    /// Remembers a step of length `h` that took `iterations` iterations and ended in `state`.
    #[inline(always)]
    pub(super) fn keep<const N: usize>(
        &mut self,
        slopes: &StageSlopes<N>,
        iterations: u32,
        (h, quarters): (f64, i32),
        state: &State<N>,
    ) {
        self.known = N <= COORDINATES;
        if self.known {
            self.velocity[..N].copy_from_slice(&slopes.velocity);
            self.acceleration[..N].copy_from_slice(&slopes.acceleration);
            self.q[..N].copy_from_slice(state.q());
            self.v[..N].copy_from_slice(state.v());
            (self.h, self.quarters, self.iterations) = (h, quarters, iterations);
        }
    }

    /// The slopes of the last step; `None` unless it ended in `state`.
    #[inline(always)]
    pub(super) fn rows<const N: usize>(&self, state: &State<N>) -> Option<[&[[f64; 8]; N]; 2]> {
        if !self.known || self.q.first_chunk::<N>() != Some(state.q()) || self.v.first_chunk::<N>() != Some(state.v()) {
            return None;
        }
        Some([self.velocity.first_chunk()?, self.acceleration.first_chunk()?])
    }

    /// The number of iterations of the next step that are made without a convergence test, which takes a third of their time. The step will
    /// take about as many iterations as the last one, and the tests of the last few show the rate of contraction.
    #[inline(always)]
    pub(super) fn untested(&self) -> u32 {
        self.iterations.saturating_sub(4)
    }

    /// Whether the last step had the length `h`.
    #[inline(always)]
    pub(super) fn is_of_length(&self, h: f64) -> bool {
        self.h.to_bits() == h.to_bits()
    }

    /// All of it as numbers; an empty list before the first step.
    pub(super) fn save(&self) -> Vec<f64> {
        if !self.known {
            return Vec::new();
        }
        let rows = self.velocity.iter().chain(&self.acceleration).flatten();
        let rest = [self.h, f64::from(self.quarters), f64::from(self.iterations)];
        rows.chain(&rest).chain(&self.q).chain(&self.v).copied().collect()
    }

    /// Restores the numbers of [`save`](Self::save); any other list gives the memory before the first step.
    pub(super) fn load(numbers: &[f64]) -> Self {
        let mut memory = Self { known: true, ..Self::NONE };
        let mut length = [0.0; 3];
        let Self { velocity, acceleration, q, v, .. } = &mut memory;
        let mut numbers = numbers.iter().copied();
        let mut filled = true;
        for places in [velocity.as_flattened_mut(), acceleration.as_flattened_mut(), &mut length, q, v] {
            for place in places {
                match numbers.next() {
                    Some(number) => *place = number,
                    None => filled = false,
                }
            }
        }
        let [h, quarters, iterations] = length;
        if filled { Self { h, quarters: quarters as i32, iterations: iterations as u32, ..memory } } else { Self::NONE }
    }
}
