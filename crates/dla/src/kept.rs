use crate::State;
use crate::derivatives::{COORDINATES, Derivatives, Row, counted, switch};
use crate::past::Past;

/// What a step of the general form remembers of those before it, with which the search of the next one begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Kept {
    /// Whether the next step may go on from the last.
    ready: bool,
    /// For how many steps it is not to be tried, and for how many where it fails again.
    pause: u32,
    next_pause: u32,
    /// Of `h D1 D2 L_d`, with the derivatives of the forces.
    pub(crate) block: Derivatives,
    /// Of the mass matrix.
    pub(crate) mass: Derivatives,
    /// The velocities at the last nodes.
    pub(crate) velocities: Past<COORDINATES>,
    /// Where the last step ended, and how fast.
    q: Row,
    v: Row,
}

impl Kept {
    /// Of no step.
    pub(crate) const NONE: Self = Self {
        ready: false,
        pause: 0,
        next_pause: 1,
        block: Derivatives::NONE,
        mass: Derivatives::NONE,
        velocities: Past::new(),
        q: [0.0; COORDINATES],
        v: [0.0; COORDINATES],
    };

    /// Forgets all unless the last step ended in this state: what begins anew is to be the same whatever was before.
    #[inline(always)]
    #[allow(clippy::float_cmp, reason = "only the very same state goes on")]
    pub(crate) fn follows<const N: usize>(&mut self, state: &State<N>) {
        let same = N <= COORDINATES && self.q[..N] == state.q()[..] && self.v[..N] == state.v()[..];
        if !same {
            (self.ready, self.pause, self.next_pause) = (false, 0, 1);
        }
    }

    /// Whether the next step may go on from the last.
    #[inline(always)]
    pub(crate) fn is_ready(&self) -> bool {
        self.ready
    }

    /// That a step of length `h` has ended in the state and did not go on from one before; the next may, where that is possible.
    #[inline(always)]
    pub(crate) fn begins<const N: usize, const M: usize>(&mut self, possible: bool, h: f64, state: &State<N>) {
        if N > COORDINATES || M > COORDINATES {
            return;
        }
        self.ready = possible && self.pause == 0;
        self.pause = self.pause.saturating_sub(1);
        self.block.forget();
        self.mass.forget();
        self.velocities.forget();
        self.ended(h, state);
    }

    /// That a step could not go on from the last.
    #[cold]
    pub(crate) fn fails(&mut self) {
        /// It is tried again after as many steps at most.
        const LONGEST: u32 = 64;
        (self.ready, self.pause) = (false, self.next_pause);
        self.next_pause = LONGEST.min(self.next_pause.saturating_mul(2));
    }

    /// That a step of length `h` that went on from the last has ended in the state.
    #[inline(always)]
    pub(crate) fn ended<const N: usize>(&mut self, h: f64, state: &State<N>) {
        self.q[..N].copy_from_slice(state.q());
        self.v[..N].copy_from_slice(state.v());
        self.velocities.push(h, &self.v);
    }

    /// That a step went on from the last.
    #[inline(always)]
    pub(crate) fn succeeds(&mut self) {
        self.next_pause = 1;
    }

    /// All of it as numbers; none of no step.
    pub(crate) fn save(&self) -> Vec<f64> {
        if *self == Self::NONE {
            return Vec::new();
        }
        let mut numbers = Vec::new();
        let mut copy = *self;
        copy.visit(|x| numbers.push(*x));
        numbers
    }

    /// From what [`save`](Self::save) gave; of no step from anything else.
    pub(crate) fn load(numbers: &[f64]) -> Self {
        let mut kept = Self::NONE;
        let (mut numbers, mut filled) = (numbers.iter(), true);
        kept.visit(|x| match numbers.next() {
            Some(number) => *x = *number,
            None => filled = false,
        });
        if filled { kept } else { Self::NONE }
    }

    /// Every number of it, in a fixed order.
    fn visit(&mut self, mut visit: impl FnMut(&mut f64)) {
        let Self { ready, pause, next_pause, block, mass, velocities, q, v } = self;
        for derivatives in [block, mass] {
            derivatives.visit(&mut visit);
        }
        for number in [pause, next_pause] {
            counted(number, &mut visit);
        }
        switch(ready, &mut visit);
        velocities.visit(&mut visit);
        for row in [q, v] {
            row.iter_mut().for_each(&mut visit);
        }
    }
}
